# SPDX-License-Identifier: BSD-3-Clause
"""Reads a model file (Core/Model/FORMAT.md) of plain parameters into Python, far enough to evaluate
it elsewhere: the configuration, and the parameters as float32."""
import math
import struct
from pathlib import Path

import numpy


def read_document(data, at=0):
    """The BSON document at byte `at` of `data` as a dictionary; blobs are bytes."""
    end = at + struct.unpack_from("<i", data, at)[0] - 1
    at += 4
    found = {}
    while at < end:
        tag = data[at]
        name_end = data.index(b"\0", at + 1)
        name = data[at + 1:name_end].decode()
        found[name], at = read_value(data, tag, name_end + 1)
    return found


def read_value(data, tag, at):
    """The value of kind `tag` at byte `at`, and the byte after it."""
    numbers = {0x01: ("<d", 8), 0x08: ("<?", 1), 0x10: ("<i", 4), 0x12: ("<q", 8)}
    if tag in numbers:
        form, size = numbers[tag]
        return struct.unpack_from(form, data, at)[0], at + size
    if tag == 0x0A:
        return None, at
    size = struct.unpack_from("<i", data, at)[0]
    if tag in (0x03, 0x04):
        return read_document(data, at), at + size
    if tag == 0x02:
        return data[at + 4:at + 3 + size].decode(), at + 4 + size
    if tag == 0x05:
        return data[at + 5:at + 5 + size], at + 5 + size
    raise ValueError(f"byte {at}: values of kind {tag} do not occur in model files")


def layout(configuration):
    """Levels of the grid as (scale, resolution, entries, first entry, hashed), and the shapes of
    the network's matrices."""
    grid, network = configuration["encoding"], configuration["network"]
    levels, first = [], 0
    growth = numpy.log2(numpy.float32(grid.get("per_level_scale", 2)))
    for level in range(grid["n_levels"]):
        scale = numpy.exp2(numpy.float32(level) * growth) * numpy.float32(
            grid["base_resolution"]) - numpy.float32(1)
        resolution = math.ceil(scale) + 1
        dense = -(-resolution ** 3 // 8) * 8
        entries = min(dense, 1 << grid["log2_hashmap_size"])
        levels.append((float(scale), resolution, entries, first, dense > entries))
        first += entries
    inputs = -(-grid["n_levels"] * grid["n_features_per_level"] // 16) * 16
    width, depth = network["n_neurons"], network["n_hidden_layers"]
    return levels, [(width, inputs)] + [(width, width)] * (depth - 1) + [(16, width)]


class ModelFile:
    """`levels` and `shapes` as of `layout`; `features` per entry; `parameters` in one array."""

    def __init__(self, path):
        document = read_document(Path(path).read_bytes())
        self.levels, self.shapes = layout(document["model"])
        self.features = document["model"]["encoding"]["n_features_per_level"]
        stored = document["parameters"]
        kind = {"float": "<f4", "__half": "<f2"}[stored["params_type"]]
        self.parameters = numpy.frombuffer(stored["params_binary"], kind).astype(numpy.float32)

    def split(self, parameters):
        """(matrices, table of entries x features), views of `parameters`."""
        matrices, at = [], 0
        for rows, columns in self.shapes:
            matrices.append(parameters[at:at + rows * columns].reshape(rows, columns))
            at += rows * columns
        return matrices, parameters[at:].reshape(-1, self.features)
