#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_tolerance and writes tolerance.json: volumes of ours and one of thin wires in fog.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_train bench_tolerance
    Testing/Benchmarks/tolerance.py build-core/Testing/Benchmarks VOLUME.vti...

With --small before these, of a small model in small pictures, for a look, and nothing is written.
Models have the writer's default size and 4,000 steps; the wires are shown with twice as many voxels
along every axis, as thin things are lost where voxels are small, and once in few pixels.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import results_file  # first: it answers --help without the packages that follow

import numpy

import volumes


def wires(size=256, count=24, seed=1):
    """Smooth fog and, of a higher value, curved wires a voxel or so thick."""
    random = numpy.random.default_rng(seed)
    z, y, x = numpy.meshgrid(*[(numpy.arange(size) + 0.5) / size] * 3, indexing="ij")
    fog = 0.25 + 0.2 * numpy.sin(5 * x + 2 * numpy.sin(3 * z)) * numpy.cos(4 * y - 2 * z)
    wire = numpy.zeros_like(fog)
    for number in range(count):
        along, u, v = [(x, y, z), (y, x, z), (z, x, y)][number % 3]
        a, b = random.uniform(0.1, 0.9, 2)
        p, q = random.uniform(0, 2 * numpy.pi, 2)
        distance = ((u - a - 0.05 * numpy.sin(6 * along + p)) ** 2
                    + (v - b - 0.05 * numpy.sin(5 * along + q)) ** 2)
        wire = numpy.maximum(wire, numpy.exp(-distance * size * size / 2))
    return (fog * (1 - wire) + wire).astype(numpy.float32)


def rounded(value):
    """All numbers of a line, to four digits."""
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    if isinstance(value, list):
        return [rounded(one) for one in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


def run(folder, name, voxels, times, pixels=512, steps=4000):
    with volumes.raw_file(voxels) as raw, tempfile.TemporaryDirectory() as scratch:
        model = Path(scratch) / "model.inr"
        subprocess.run([folder / "bench_train", *raw, str(steps), "0", model], check=True)
        done = subprocess.run([folder / "bench_tolerance", model, name, str(times),
                               str(pixels)],
                              stdout=subprocess.PIPE, text=True, check=True)
    for line in done.stdout.splitlines():
        result = json.loads(line)
        result = rounded(result)
        result.setdefault("note", f"{pixels}x{pixels}, 2 threads; milliseconds of processor time")
        spread = f" ({result['low']} to {result['high']})" if "low" in result else ""
        print(f"{result['name']}: {result['value']}{spread} {result['unit']}", flush=True)
        yield result


def main():
    if sys.argv[1] == "--small":
        list(run(Path(sys.argv[2]), "small wires x2", wires(96, 8), 2, 128, 600))
        return
    folder = Path(sys.argv[1])
    results = list(run(folder, "wires x2", wires(), 2))
    results += run(folder, "wires x2 from far", wires(), 2, 192)
    for path in sys.argv[2:]:
        results += run(folder, volumes.name_of(path), volumes.read(path), 1)
    results_file.write("tolerance", results)


if __name__ == "__main__":
    main()
