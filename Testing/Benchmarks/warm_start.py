#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What it saves to train a time step from the one before; writes warm-start.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_warm_start
    Testing/Benchmarks/warm_start.py build-core/Testing/Benchmarks/bench_warm_start VOLUME.vti...

Step k of the series is the volume warped by up to k voxels (WarmStart.cpp). Step 0 is trained for
2,000 steps from random numbers, step 1 for each number below from random numbers and from step 0;
"after three" is step 3, each of whose predecessors was trained for as many. These are counts, no
times: other load on the machine does not change them.
"""
import json
import math
import subprocess
import sys

import results_file
import volumes

VOXELS = 1
BEFORE = 2000
STEPS = [100, 300, 1000]


def measure(program, path):
    with volumes.raw_file(volumes.read(path)) as volume:
        command = [program, *volume, *map(str, (VOXELS, BEFORE, *STEPS))]
        output = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
    return json.loads(output)


def steps_to_reach(psnr, curve):
    """Of the cold training, between the measured ones in the logarithm; None where none does."""
    for (steps, low), (more, high) in zip(curve, curve[1:]):
        if low <= psnr <= high:
            return steps * math.exp(math.log(more / steps) * (psnr - low) / (high - low))
    return None


def results_of(name, found):
    curve = [(entry["steps"], entry["cold"]) for entry in found["after"]]
    before = f"warped by up to {VOXELS} voxel per time step; step 0 has {found['before']:.2f} dB"
    for entry in found["after"]:
        steps = entry["steps"]
        cold = f"PSNR after {steps} steps, {name}"
        yield results_file.result(cold, round(entry["cold"], 3), "dB", "higher", before)
        for key, kind in (("warm", "from the step before"), ("chain", "after three such steps")):
            yield results_file.result(f"PSNR after {steps} steps {kind}, {name}",
                                      round(entry[key], 3), "dB", "higher", before, baseline=cold)
        needed = steps_to_reach(entry["warm"], curve)
        if needed:
            yield results_file.result(f"steps saved by {steps} from the step before, {name}",
                                      round(needed / steps, 2), "times", "higher",
                                      f"{needed:.0f} steps from random numbers are as good",
                                      baseline=cold)


def main():
    program, *paths = sys.argv[1:]
    results = []
    for path in paths:
        for result in results_of(volumes.name_of(path), measure(program, path)):
            results.append(result)
            print(f"{result['name']}: {result['value']} {result['unit']}", flush=True)
        results_file.write("warm-start", results)  # a long run may end early


if __name__ == "__main__":
    main()
