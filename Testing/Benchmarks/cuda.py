#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_cuda, bench_cuda_frames and bench_cuda_training on this machine's GPU and writes cuda.json; see
Testing/run_cuda.sh.

    Testing/Benchmarks/cuda.py build-cuda/Testing/CUDA FAILED_CONFORMANCE_TESTS
"""
import json
import os
import subprocess
import sys

import results_file

HALF = "cuda half"


def floor_rate(floors, ceilings):
    """Samples a second that neither bytes nor products of the network allow to exceed, and which."""
    bounds = {what: ceilings[what] / floors[what] for what in ("bytes", "products")}
    what = min(bounds, key=bounds.get)
    return bounds[what], what


def results_of(measured, failed):
    ceilings = measured["ceilings"]
    yield results_file.result("conformance failed", failed, "", "lower", "tests", target=0)
    yield results_file.result("ceiling, tensor cores", round(ceilings["products"] / 1e12, 2),
                              "T products/s", "higher", "16 x 16 tiles from registers")
    yield results_file.result("ceiling, memory", round(ceilings["bytes"] / 1e9, 1), "GB/s", "higher",
                              "bytes read and written by a copy of 1 GiB")
    for run in measured["results"]:
        rate = run["samples"] / run["seconds"]
        yield results_file.result(run["name"], round(rate / 1e6, 2), "M samples/s", "higher",
                                  "default model, random parameters; median of 15")
        if "floors" in run and HALF in run["name"]:
            bound, what = floor_rate(run["floors"], ceilings)
            more = {"target": 0.5} if run["name"] == f"bricks of level 0, {HALF}" else {}
            yield results_file.result(f"{run['name']} of floor", round(rate / bound, 4), "",
                                      "higher", f"{bound / 1e6:.1f} M samples/s by {what}",
                                      baseline=f"ceiling, {what}", **more)


FRAMES = "768 x 768, default model, as 256^3 voxels unless said otherwise; the CPU draws with all cores"
TRAINING = "256^3 floats, the writer's model for 256^3 bytes, float32; the CPU's with all of its cores"


def lines_of(lines, note):
    """What bench_cuda_frames and bench_cuda_training print."""
    for line in lines.splitlines():
        measured = json.loads(line)
        yield {**measured, "value": float(f"{measured['value']:.4g}"), "note": note}


def run(folder, program):
    return subprocess.run([os.path.join(folder, program)], check=True, stdout=subprocess.PIPE).stdout


def main():
    folder, failed = sys.argv[1:]
    measured = json.loads(run(folder, "bench_cuda"))
    results = list(results_of(measured, int(failed)))
    results += lines_of(run(folder, "bench_cuda_frames"), FRAMES)
    results += lines_of(run(folder, "bench_cuda_training"), TRAINING)
    for result in results:
        print(f"{result['name']}: {result['value']} {result['unit']}")
    device = measured["device"]
    results_file.write("cuda", results, gpu=device["name"],
                       compute_capability=device["compute_capability"], cuda=device["runtime"])


if __name__ == "__main__":
    main()
