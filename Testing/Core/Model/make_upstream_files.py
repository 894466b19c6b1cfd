#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes model files as instantvnr and cINR do, byte by byte, without the library; and compact files
of our own from what FORMAT.md says of them.

    make_upstream_files.py OUTPUT_DIR

For every case NAME.inr_upstream, and NAME.expected: one JSON with what a reader has to find in it.
"""
import json
import math
import random
import struct
import sys
import zlib
from pathlib import Path

DIMS = (40, 30, 20)


def element(key, value):
    name = key.encode() + b"\0"
    if isinstance(value, bool):
        return b"\x08" + name + struct.pack("<?", value)
    if isinstance(value, int):
        small = -2 ** 31 <= value < 2 ** 31
        return (b"\x10" if small else b"\x12") + name + struct.pack("<i" if small else "<q", value)
    if isinstance(value, float):
        return b"\x01" + name + struct.pack("<d", value)
    if isinstance(value, str):
        text = value.encode() + b"\0"
        return b"\x02" + name + struct.pack("<i", len(text)) + text
    if isinstance(value, bytes):
        return b"\x05" + name + struct.pack("<iB", len(value), 0) + value
    if isinstance(value, dict):
        return b"\x03" + name + document(value)
    if isinstance(value, list):
        return b"\x04" + name + document({str(k): member for k, member in enumerate(value)})
    raise TypeError(type(value))


def document(members):
    body = b"".join(element(key, members[key]) for key in sorted(members)) + b"\0"
    return struct.pack("<i", len(body) + 4) + body


def round_up(value, multiple):
    return -(-value // multiple) * multiple


def parameter_count(encoding, network, alignment):
    features = encoding["n_features_per_level"]
    entries = 0
    for level in range(int(encoding["n_levels"])):
        scale = float(encoding.get("per_level_scale", 2)) ** level * encoding["base_resolution"] - 1
        count = round_up((math.ceil(scale) + 1) ** 3, 8)
        entries += min(count, 2 ** int(encoding["log2_hashmap_size"]))
    neurons, hidden = network["n_neurons"], network["n_hidden_layers"]
    inputs = round_up(int(encoding["n_levels"]) * features, math.lcm(alignment, features))
    weights = neurons * inputs + (hidden - 1) * neurons * neurons + round_up(1, alignment) * neurons
    return weights + entries * features


def parameters(count, seed):
    """Values that half precision holds exactly."""
    numbers = random.Random(seed)
    return [numbers.randrange(-1024, 1025) / 512 for _ in range(count)]


def pack(values, kind):
    return struct.pack(f"<{len(values)}{'e' if kind == '__half' else 'f'}", *values)


def cell_table(encoding):
    """3 x 2 x 2 cells: the first never touched, the others with exact ranges."""
    ranges = [None] + [(k / 16, k / 16 + 0.25) for k in range(11)]
    stored = b""
    for cell in ranges:
        if encoding == "offset":
            stored += struct.pack("<2f", *((0, 0) if cell is None else (cell[0] - 1, cell[1] + 1)))
        else:
            stored += struct.pack("<2f", *((0, 1) if cell is None else cell))
    expected = [[1, -1] if cell is None and encoding == "offset" else list(cell or (0, 1))
                for cell in ranges]
    return stored, expected


def model(**change):
    """A model file's root object and what a reader has to find."""
    encoding = dict(otype="HashGrid", n_levels=3, n_features_per_level=2, log2_hashmap_size=8,
                    base_resolution=4)
    network = dict(otype="FullyFusedMLP", n_neurons=16, n_hidden_layers=2, activation="ReLU",
                   output_activation="None")
    encoding.update(change.get("encoding", {}))
    network.update(change.get("network", {}))
    for key in change.get("without", ()):
        encoding.pop(key, None)
        network.pop(key, None)
    alignment, kind = change.get("alignment", 16), change.get("kind", "__half")
    layout_encoding = {**encoding, **change.get("layout", {})}
    count = parameter_count(layout_encoding, network, alignment)
    values = parameters(count, change.get("seed", 1))
    cells, ranges = cell_table(change.get("cells", "offset"))
    section = dict(n_params=count, params_binary=pack(values, kind))
    if change.get("params_type", True):
        section["params_type"] = kind
    root = dict(
        macrocell=dict(data=cells, dims=dict(x=3, y=2, z=2), groundtruth=True,
                       spacings=dict(x=16 / 40, y=16 / 30, z=16 / 20)),
        model=dict(encoding=encoding, loss=dict(otype="L1"), network=network),
        parameters=section,
        volume=dict(dims=dict(zip("xyz", DIMS))))
    expected = dict(dims=DIMS, parameters=values, ranges=ranges, half=kind == "__half",
                    alignment=alignment)
    return root, expected


def frame(content):
    """A zstd frame (RFC 8878) of one block that is not compressed."""
    header = struct.pack("<IBI", 0xFD2FB528, 0xA0, len(content))  # one segment, size in 4 bytes
    return header + struct.pack("<I", len(content) << 3 | 1)[:3] + content


def compact_model():
    root, expected = model()
    count = root["parameters"]["n_params"]
    network = root["model"]["network"]["n_neurons"]
    weights = network * 16 + network * network + 16 * network
    groups = [network * 16, network * network, 16 * network] + [2 * n for n in (64, 256, 256)]
    assert sum(groups) == count and sum(groups[:3]) == weights
    steps = [2.0 ** -(k + 3) for k in range(len(groups))]
    numbers = random.Random(2)
    multiples = [numbers.choice((numbers.randrange(-40, 40), numbers.randrange(-32768, 32768)))
                 for _ in range(count)]
    codes = [2 * m if m >= 0 else -2 * m - 1 for m in multiples]
    step_of = [step for step, size in zip(steps, groups) for _ in range(size)]
    order, first = list(range(sum(groups[:3]))), sum(groups[:3])
    for size in groups[3:]:  # a level's first feature of all entries, then the second
        order += [*range(first, first + size, 2), *range(first + 1, first + size, 2)]
        first += size
    packed = frame(bytes(codes[k] & 255 for k in order) + bytes(codes[k] >> 8 for k in order))
    root["parameters"] = dict(n_params=count, params_type="quantised", steps=steps,
                              params_binary=packed)
    lows = [255] + [20 * k for k in range(11)]
    highs = [0] + [20 * k + 10 for k in range(11)]
    root["macrocell"]["data"] = frame(bytes(lows) + bytes(highs))
    checksum = zlib.crc32(root["macrocell"]["data"], zlib.crc32(packed))
    axes = dict(x=1.0, y=1.0, z=1.0)
    root["inr"] = dict(
        format_version=2, checksum=f"crc32:{checksum:08x}", dims=dict(zip("xyz", DIMS)),
        spacing=axes, origin=axes, direction=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        array_name="a", array_type="float32", data_range=dict(low=0.0, high=1.0),
        transform="linear", hash_rule="wrapping", macrocell_provenance="file")
    ranges = [[1, -1]] + [[low / 255, high / 255] for low, high in zip(lows[1:], highs[1:])]
    return root, {**expected, "half": False, "ranges": ranges,
                  "parameters": [m * step for m, step in zip(multiples, step_of)]}


def cases():
    yield "cinr", model()
    yield "instantvnr", model(params_type=False)
    yield "float", model(kind="float")
    yield "float_untyped", model(kind="float", params_type=False)
    yield "raw_cells", model(cells="raw")
    yield "cutlass_8", model(network=dict(otype="CutlassMLP"), alignment=8, params_type=False)
    yield "cutlass_16", model(network=dict(otype="CutlassMLP"))
    yield "megakernel", model(network=dict(otype="MegakernelMLP"))
    yield "doubles", model(encoding=dict(n_levels=3.0, log2_hashmap_size=8.0, per_level_scale=2.0))
    yield "plain_grid", model(encoding=dict(otype="Grid", type="Hash"))
    root, expected = model()
    del root["macrocell"]
    yield "no_cells", (root, {**expected, "ranges": []})
    root, expected = model()
    root["remark"] = {"deep": {"deeper": "text"}}  # unknown keys are ignored
    yield "extra_keys", (root, expected)
    root, expected = model()
    root.update(root.pop("parameters"))
    yield "old_root_layout", (root, expected)
    yield "compact", compact_model()
    # Trained out of core: 1,024 is not to be believed where the cells tell better.
    for name, stored, told, dims in (
        ("clamped", 1024, 1024, (1024, 30, 20)),
        ("clamped_with_true_cells", 1024, 3000, (3000, 30, 20)),
        ("corrected_by_hand", 3000, 1024, (3000, 30, 20)),
    ):
        root, expected = model()
        cells = -(-told // 16)
        ranges = [[k % 7 / 16, k % 7 / 16 + 0.25] for k in range(cells * 4)]
        spacing = struct.unpack("<f", struct.pack("<f", 16 / told))[0]
        root["volume"]["dims"] = dict(x=stored, y=30, z=20)
        root["macrocell"].update(
            dims=dict(x=cells, y=2, z=2), spacings=dict(x=spacing, y=16 / 30, z=16 / 20),
            data=b"".join(struct.pack("<2f", low - 1, high + 1) for low, high in ranges))
        yield name, (root, {**expected, "dims": dims, "ranges": ranges})


def as_text(root):
    """Text JSON: nlohmann's dump of a binary is an object with its bytes."""
    def convert(value):
        if isinstance(value, dict):
            return {key: convert(member) for key, member in value.items()}
        return dict(bytes=list(value), subtype=None) if isinstance(value, bytes) else value
    return json.dumps(convert(root)).encode()


def main():
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    files = {name: (document(root), expected) for name, (root, expected) in cases()}
    root, expected = model()
    files["text"] = (as_text(root), expected)
    root, expected = compact_model()
    files["compact_text"] = (as_text(root), expected)
    for name, (content, expected) in files.items():
        (target / f"{name}.upstream").write_bytes(content)
        (target / f"{name}.expected").write_text(json.dumps(expected))
    root, _ = model()
    del root["volume"]
    (target / "no_volume.broken").write_bytes(document(root))
    (target / "cases.txt").write_text("".join(f"{name}\n" for name in files))


if __name__ == "__main__":
    main()
