#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates INRs in float64 with NumPy, straight from the published formulas.

    truth.py OUTPUT_DIR

writes, for every case of CASES, NAME.json (the configuration), NAME.params (float32, tiny-cuda-nn's
layout), NAME.xyz (float32 positions) and NAME.truth (float64 values). It shares no code with the
library: the tests hold the library's kernels against these files.
"""
import json
import math
import sys
from pathlib import Path

import numpy as np

POINTS = 1000


def grid(otype="HashGrid", levels=4, features=2, log2=10, base=8, scale=2.0, **more):
    return dict(otype=otype, n_levels=levels, n_features_per_level=features, log2_hashmap_size=log2,
                base_resolution=base, per_level_scale=scale, **more)


def network(neurons=32, hidden=2, activation="ReLU", output="None", otype="FullyFusedMLP"):
    return dict(otype=otype, n_neurons=neurons, n_hidden_layers=hidden, activation=activation,
                output_activation=output)


CASES = {
    "default_small": (grid(levels=8, features=8, log2=14, base=16), network(64, 4)),
    "features1": (grid(features=1), network(16, 1)),
    "features2": (grid(features=2), network()),
    "features4": (grid(features=4, levels=5), network(128, 2)),
    "dense": (grid("DenseGrid", levels=3, features=4, base=5, scale=1.5), network()),
    "tiled": (grid("TiledGrid", levels=4, features=2, base=7), network()),
    "smoothstep": (grid(interpolation="Smoothstep"), network()),
    "nearest": (grid(interpolation="Nearest"), network()),
    "fractional_scale": (grid(levels=9, features=2, scale=1.38), network()),
    "fine": (grid(levels=9, features=2, log2=12, base=16), network()),
    "wrapping": (grid(levels=14, features=2, log2=16, base=16), network()),
    "prime": (grid(hash="Prime"), network()),
    "reversed_prime": (grid(hash="ReversedPrime"), network()),
    "rng": (grid(hash="Rng"), network()),
    "no_hidden_layer": (grid(), network(32, 0, otype="CutlassMLP")),
    "odd_width": (grid(), network(21, 3, otype="CutlassMLP")),
    **{f"activation_{name.lower()}": (grid(), network(32, 2, name, output))
       for name, output in (("None", "Sigmoid"), ("LeakyReLU", "None"), ("Exponential", "None"),
                            ("Sigmoid", "None"), ("Sine", "None"), ("Squareplus", "None"),
                            ("Softplus", "None"), ("Tanh", "Tanh"))},
}

ACTIVATIONS = {
    "None": lambda x: x,
    "ReLU": lambda x: np.maximum(x, 0),
    "LeakyReLU": lambda x: np.where(x > 0, x, 0.01 * x),
    "Exponential": np.exp,
    "Sigmoid": lambda x: 1 / (1 + np.exp(-x)),
    "Sine": np.sin,
    "Squareplus": lambda x: (10 * x + np.sqrt(100 * x * x + 4)) / 20,
    "Softplus": lambda x: np.logaddexp(10 * x, 0) / 10,
    "Tanh": np.tanh,
}

PRIMES = {"CoherentPrime": (1, 2654435761, 805459861), "Prime": (1958374283, 2654435761, 805459861),
          "ReversedPrime": (2165219737, 1434869437, 2097192037)}


def round_up(value, multiple):
    return -(-value // multiple) * multiple


def grid_levels(g):
    """(scale, resolution, entries) per level; each operation rounded to float32 as in tiny-cuda-nn."""
    log2_scale = np.float32(math.log2(np.float32(g["per_level_scale"])))
    for level in range(g["n_levels"]):
        growth = np.float32(2.0 ** float(np.float32(level) * log2_scale))
        scale = growth * np.float32(g["base_resolution"]) - np.float32(1)
        resolution = math.ceil(scale) + 1
        entries = round_up(min(resolution ** 3, 2 ** 31 - 1), 8)
        if g["otype"] == "HashGrid":
            entries = min(entries, 2 ** g["log2_hashmap_size"])
        elif g["otype"] == "TiledGrid":
            entries = min(entries, g["base_resolution"] ** 3)
        yield float(scale), resolution, entries


def pcg32_at(step):
    """The step-th output of pcg32 seeded with 1337, by walking there in big integers."""
    modulus, multiplier, increment = 2 ** 64, 6364136223846793005, 3
    state = ((0 * multiplier + increment + 1337) * multiplier + increment) % modulus
    # x -> a x + c, composed with itself `step` times by squaring.
    a, c, power_a, power_c = 1, 0, multiplier, increment
    while step:
        if step & 1:
            a, c = a * power_a % modulus, (c * power_a + power_c) % modulus
        power_a, power_c = power_a * power_a % modulus, (power_c * power_a + power_c) % modulus
        step >>= 1
    state = (state * a + c) % modulus
    shifted = (((state >> 18) ^ state) >> 27) & 0xFFFFFFFF
    rotation = state >> 59
    return ((shifted >> rotation) | (shifted << (-rotation & 31))) & 0xFFFFFFFF


def corner_index(g, corner, resolution, entries):
    """corner: three uint64 arrays."""
    stride, index = 1, np.zeros(corner[0].shape, np.uint64)
    for axis in range(3):
        if stride > entries:
            break
        index = (index + corner[axis] * np.uint64(stride)) & np.uint64(0xFFFFFFFF)
        stride = stride * resolution % 2 ** 32
    if g["otype"] == "HashGrid" and stride > entries:
        name = g.get("hash", "CoherentPrime")
        if name == "Rng":
            index = np.array([pcg32_at(int(x) ^ (int(y) << 21) ^ (int(z) << 42))
                              for x, y, z in zip(*corner)], np.uint64)
        else:
            index = np.zeros_like(index)
            for axis in range(3):
                index ^= corner[axis] * np.uint64(PRIMES[name][axis]) & np.uint64(0xFFFFFFFF)
    return (index % np.uint64(entries)).astype(np.int64)


def encode(g, features, xyz):
    """features: the grid's part of the parameter vector; returns points x (levels * F)."""
    columns, offset, count = [], 0, g["n_features_per_level"]
    for scale, resolution, entries in grid_levels(g):
        table = features[offset * count:(offset + entries) * count].reshape(entries, count)
        offset += entries
        position = xyz.astype(np.float64) * scale + 0.5
        cell = np.floor(position)
        weight = position - cell
        if g.get("interpolation") == "Smoothstep":
            weight = weight * weight * (3 - 2 * weight)
        elif g.get("interpolation") == "Nearest":
            weight = np.zeros_like(weight)
        total = np.zeros((len(xyz), count))
        for c in range(8):
            bits = [(c >> axis) & 1 for axis in range(3)]
            corner = [(cell[:, axis] + bits[axis]).astype(np.uint64) for axis in range(3)]
            factor = np.prod([weight[:, a] if bits[a] else 1 - weight[:, a] for a in range(3)], axis=0)
            total += factor[:, None] * table[corner_index(g, corner, resolution, entries)]
        columns.append(total)
    return np.concatenate(columns, axis=1)


def layer_shapes(g, n):
    width = g["n_levels"] * g["n_features_per_level"]
    inputs = round_up(width, math.lcm(16, g["n_features_per_level"]))
    if n["n_hidden_layers"] == 0:
        return [(16, inputs)]
    hidden = [(n["n_neurons"], n["n_neurons"])] * (n["n_hidden_layers"] - 1)
    return [(n["n_neurons"], inputs)] + hidden + [(16, n["n_neurons"])]


def evaluate(g, n, parameters, xyz):
    shapes = layer_shapes(g, n)
    weights = sum(rows * columns for rows, columns in shapes)
    value = encode(g, parameters[weights:], xyz).T
    value = np.pad(value, ((0, shapes[0][1] - value.shape[0]), (0, 0)))
    first = 0
    for k, (rows, columns) in enumerate(shapes):
        matrix = parameters[first:first + rows * columns].reshape(rows, columns)
        first += rows * columns
        last = k + 1 == len(shapes)
        value = ACTIVATIONS[n["output_activation" if last else "activation"]](matrix @ value)
    return value[0]


def random_parameters(g, n, random):
    shapes = layer_shapes(g, n)
    layers = [random.uniform(-1, 1, rows * columns) * math.sqrt(6 / (rows + columns))
              for rows, columns in shapes]
    entries = sum(level[2] for level in grid_levels(g))
    features = random.uniform(-1, 1, entries * g["n_features_per_level"])
    return np.concatenate(layers + [features]).astype(np.float32)


def positions(g, random):
    """Random points and the cube's corners; for Nearest, none that rounding could move to a neighbour."""
    xyz = random.uniform(0, 1, (4 * POINTS, 3)).astype(np.float32)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
    if g.get("interpolation") == "Nearest":
        for scale, _, _ in grid_levels(g):
            fraction = (xyz.astype(np.float64) * scale + 0.5) % 1
            xyz = xyz[np.all((fraction > 1e-3) & (fraction < 1 - 1e-3), axis=1)]
        return xyz[:POINTS]
    return np.concatenate([xyz[:POINTS], corners])


def main():
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    for seed, (name, (g, n)) in enumerate(CASES.items()):
        random = np.random.default_rng(seed)
        parameters = random_parameters(g, n, random)
        xyz = positions(g, random)
        (target / f"{name}.json").write_text(json.dumps({"encoding": g, "network": n}))
        parameters.tofile(target / f"{name}.params")
        xyz.tofile(target / f"{name}.xyz")
        evaluate(g, n, parameters.astype(np.float64), xyz).tofile(target / f"{name}.truth")
    (target / "cases.txt").write_text("".join(f"{name}\n" for name in CASES))


if __name__ == "__main__":
    main()
