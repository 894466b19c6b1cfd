#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Quality over file size for volumes, each trained for the same number of steps, and what zfp (and
TTHRESH and SZ3, whose figures are given) makes of some of them.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_train
    Testing/Benchmarks/rate_distortion.py build-core/Testing/Benchmarks/bench_train STEPS \\
        VOLUME.vti...
    Testing/Benchmarks/plots.py Testing/Benchmarks/results/MACHINE

Every volume is saved at the default size and at four times that size's ratio, those that
other_compressors.py has figures of at more ratios; results go to rate-distortion.json. Needs zfp's
Python module (Debian: python3-zfpy).
"""
import math
import os
import sys
import tempfile

import results_file  # first: it answers --help without the packages that follow

import other_compressors
import volumes
from inr_files import Writer

RATIOS = (8, 16, 32, 64, 128, 256, 400)


def figures_of(file, name):
    """Every figure of one file."""
    for what, key, unit, better in (
            ("PSNR", "psnr", "dB", "higher"), ("SSIM", "ssim", "", "higher"),
            ("maximum error", "error", "of the range", "lower"), ("ratio", "ratio", "", "higher")):
        if not math.isnan(file[key]):
            yield results_file.result(f"{name} {what}", round(file[key], 5), unit, better,
                                      file["note"])


def point(name, method, ratio, psnr, note):
    """A point of the plot."""
    return results_file.result(f"{name}, {method}, PSNR at {ratio:.3g}", round(psnr, 3), "dB",
                               "higher", note, ratio=round(ratio, 2))


def two_sizes(name, writer):
    default = writer.save()
    yield from figures_of(default, f"{name} default")
    yield from figures_of(writer.save(4 * default["ratio"]), f"{name} small")


def curves(name, voxels, writer):
    for ratio in RATIOS:
        file = writer.save(ratio)
        yield point(name, "INR", file["ratio"], file["psnr"], file["note"])
    for method, ratio, psnr in other_compressors.zfp(voxels):
        yield point(name, method, ratio, psnr, "")
    for method, ratio, psnr in other_compressors.GIVEN[name]:
        yield point(name, method, ratio, psnr, "given, not measured in this run")


def measure(program, steps, path):
    name, voxels = volumes.name_of(path), volumes.read(path)
    with volumes.raw_file(voxels) as volume, tempfile.TemporaryDirectory() as folder:
        writer = Writer(program, steps, volume, os.path.join(folder, "model.inr"))
        yield from two_sizes(name, writer)
        if name in other_compressors.GIVEN:
            yield from curves(name, voxels, writer)


def main():
    program, steps, *paths = sys.argv[1:]
    results = []
    for path in paths:
        for result in measure(program, int(steps), path):
            results.append(result)
            print(f"{result['name']}: {result['value']} {result['unit']} ({result['note']})",
                  flush=True)
        results_file.write("rate-distortion", results)  # a long run may end early


if __name__ == "__main__":
    main()
