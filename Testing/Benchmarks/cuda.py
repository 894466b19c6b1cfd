#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_cuda, bench_cuda_frames and bench_cuda_training on this machine's GPU and writes cuda.json; see
Testing/run_cuda.sh.

    Testing/Benchmarks/cuda.py build-cuda/Testing/CUDA [FAILED_CONFORMANCE_TESTS]

When one of them fails, or takes more than INR_TIME_LIMIT seconds (1800), what there is is written all the
same, and the status is not 0.
"""
import json
import os
import subprocess
import sys
import time

import results_file

HALF = "cuda half"
LIMIT = os.environ.get("INR_TIME_LIMIT", "1800")  # seconds for each


def floor_rate(floors, ceilings):
    """Samples a second that neither bytes nor products of the network allow to exceed, and which."""
    bounds = {what: ceilings[what] / floors[what] for what in ("bytes", "products")}
    what = min(bounds, key=bounds.get)
    return bounds[what], what


def inference(lines):
    """What bench_cuda prints but for the device: ceilings first, then results."""
    ceilings = None
    for measured in lines:
        if "ceilings" in measured:
            ceilings = measured["ceilings"]
            yield results_file.result("ceiling, tensor cores", round(ceilings["products"] / 1e12, 2),
                                      "T products/s", "higher", "16 x 16 tiles from registers")
            yield results_file.result("ceiling, memory", round(ceilings["bytes"] / 1e9, 1), "GB/s",
                                      "higher", "bytes read and written by a copy of 1 GiB")
        elif "name" in measured:
            yield from inference_result(measured, ceilings)


def inference_result(run, ceilings):
    rate = run["samples"] / run["seconds"]
    yield results_file.result(run["name"], round(rate / 1e6, 2), "M samples/s", "higher",
                              "default model, random parameters that halves hold; median of 15")
    if "floors" in run and HALF in run["name"]:
        bound, what = floor_rate(run["floors"], ceilings)
        more = {"target": 0.5} if run["name"] == f"bricks of level 0, {HALF}" else {}
        yield results_file.result(f"{run['name']} of floor", round(rate / bound, 4), "",
                                  "higher", f"{bound / 1e6:.1f} M samples/s by {what}",
                                  baseline=f"ceiling, {what}", **more)


FRAMES = "768 x 768, default model, as 256^3 voxels unless said otherwise; the CPU draws with all cores"
TRAINING = "256^3 floats, the writer's model for 256^3 bytes, float32; the CPU's with all of its cores"


def noted(lines, note):
    """What bench_cuda_frames and bench_cuda_training print."""
    for measured in lines:
        yield {**measured, "value": float(f"{measured['value']:.4g}"), "note": note}


def run(folder, program, problems):
    """The JSON objects that a benchmark prints, one a line. What keeps it from its end is added to
    `problems`; what it had printed by then counts."""
    found = []
    begun = time.monotonic()
    try:
        with subprocess.Popen(["timeout", "--foreground", "--kill-after=10", LIMIT,
                               os.path.join(folder, program)],
                              stdout=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                try:
                    found.append(json.loads(line))
                except ValueError:
                    problems.append(f"{program} printed what is no JSON: {line.strip()[:80]}")
                else:
                    print(f"{program}: {line.strip()}", flush=True)
        if process.returncode != 0:
            late = time.monotonic() - begun >= int(LIMIT)
            problems.append(f"{program} was not at its end after {LIMIT} s" if late else
                            f"{program} ended with status {process.returncode}")
    except OSError as error:
        problems.append(f"{program} could not be run: {error}")
    return found


def main():
    folder, *failed = sys.argv[1:]
    problems = []
    measured = run(folder, "bench_cuda", problems)
    devices = [line["device"] for line in measured if "device" in line]
    if not devices:  # whose results would it be
        sys.exit(f"no results are written: {'; '.join(problems) or 'bench_cuda names no device'}")
    results = [results_file.result("conformance failed", int(count), "", "lower", "tests", target=0)
               for count in failed]
    results += inference(measured)
    results += noted(run(folder, "bench_cuda_frames", problems), FRAMES)
    results += noted(run(folder, "bench_cuda_training", problems), TRAINING)
    device = devices[0]
    path = results_file.write("cuda", results, gpu=device["name"],
                              compute_capability=device["compute_capability"],
                              cuda=device["runtime"])
    if problems:
        sys.exit(f"{path.name} lacks results: {'; '.join(problems)}. What they said is above.")


if __name__ == "__main__":
    main()
