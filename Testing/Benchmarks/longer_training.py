#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a training ten times as long would still gain; writes longer-training.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_train
    Testing/Benchmarks/longer_training.py build-core/Testing/Benchmarks/bench_train STEPS RATIO \\
        VOLUME.vti...

Every volume is saved at RATIO after STEPS and after ten times STEPS, as the writer does but for
its time limit; the learning rate falls over all steps of either. Qualities are of counts of steps,
so other load on the machine changes the seconds only.
"""
import os
import sys
import tempfile

import results_file
import volumes
from inr_files import Writer

TIMES = 10
MOST_SECONDS = 180
MOST_GAIN = 0.5


def measure(program, steps, ratio, path):
    name = volumes.name_of(path)
    with volumes.raw_file(volumes.read(path)) as volume, tempfile.TemporaryDirectory() as folder:
        short, long = (Writer(program, count, volume, os.path.join(folder, "model.inr")).save(ratio)
                       for count in (steps, TIMES * steps))
    at = f"{name} at {ratio:g}:1"
    for file, count in ((short, steps), (long, TIMES * steps)):
        yield results_file.result(f"PSNR after {count} steps, {at}", round(file["psnr"], 3), "dB",
                                  "higher", file["note"])
    yield results_file.result(f"training time, {at}", round(short["seconds"], 1), "s", "lower",
                              f"{steps} steps", target=MOST_SECONDS)
    yield results_file.result(f"gain of ten times the training, {at}",
                              round(long["psnr"] - short["psnr"], 3), "dB", "lower",
                              f"{TIMES * steps} against {steps} steps", target=MOST_GAIN)


def main():
    program, steps, ratio, *paths = sys.argv[1:]
    results = []
    for path in paths:
        for result in measure(program, int(steps), float(ratio), path):
            results.append(result)
            print(f"{result['name']}: {result['value']} {result['unit']} ({result['note']})",
                  flush=True)
    results_file.write("longer-training", results)


if __name__ == "__main__":
    main()
