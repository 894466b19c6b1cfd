#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_kernels and writes kernels.json (inference) and, when nothing else runs on the machine,
training.json with --training: training is timed by the wall clock, the rest by processor time.

    cmake --preset dev -DCMAKE_BUILD_TYPE=Release && cmake --build --preset dev --target bench_kernels
    Testing/Benchmarks/kernels.py build-dev/Testing/Benchmarks/bench_kernels [--training] [TRAINED.inr]
"""
import json
import os
import subprocess
import sys

import results_file

MODEL = "brick of 4096^3, default model"
SETS = {"AVX512": "avx512", "AVX2": "avx2"}
TARGETS = {"brick AVX512": 3.5, "brick AVX2": 1.5, "brick vs scattered AVX512": 2,
           "brick vs scattered AVX2": 1.3, "scattered AVX512 of ceiling": 0.6,
           "scattered AVX2 of ceiling": 0.6, "brick two cores vs one AVX512": 1.8,
           "brick two cores vs one AVX2": 1.8, "brick AVX512 bfloat16": 6,
           "brick AMX": 12, "brick vs scattered AMX": 4, "brick two cores vs one AMX": 1.8}
RUNS = 7
WEIGHTS = 4 * 64 * 64 + 64  # products per sample of the default model


def rates(program, pattern, model=None):
    """Name -> M items/s, the best of some runs each, all of them in random order: what others do on
    the machine for a while does not hit all runs of one. Runs timed by processor time count all
    threads' together."""
    environment = dict(os.environ, **({"INR_MODEL": model} if model else {}))
    output = subprocess.run([program, "--benchmark_format=json", f"--benchmark_repetitions={RUNS}",
                             "--benchmark_enable_random_interleaving=true",
                             "--benchmark_min_time=0.2", f"--benchmark_filter={pattern}"],
                            check=True, capture_output=True, env=environment).stdout
    found = {}
    for run in json.loads(output)["benchmarks"]:
        if run["run_type"] == "aggregate":
            continue
        name, _, clock = run["name"].partition("/")
        threads = run["threads_used"] if "process" in clock else 1
        found[name] = max(found.get(name, 0), run["items_per_second"] * threads / 1e6)
    return dict(sorted(found.items()))


def unit_of(name):
    if "ceiling, arithmetic" in name:
        return "M/s"
    voxels = name.startswith(("brick of", "slice of")) or "trained" in name
    return "M voxels/s" if voxels else "M samples/s"


def plain(rate, model=None):
    """`model`: the file of the trained one."""
    trained = f"; a file of {os.path.getsize(model) / 1e6:.2g} MB" if model else ""
    return [results_file.result(name, round(value, 3), unit_of(name), "higher",
                                f"best of {RUNS} runs" + (trained if "trained" in name else ""))
            for name, value in rate.items()]


def derived(rate):
    """The figures that have a target: value, unit, what they are a ratio to, note."""
    loads = rate["ceiling, loads, default model"]
    for label, kernel in SETS.items():
        if f"{MODEL}, {kernel}, 1 thread" not in rate:
            continue
        brick = rate[f"{MODEL}, {kernel}, 1 thread"]
        scattered = rate[f"inference, default model, {kernel}, 1 thread"]
        arithmetic = rate[f"ceiling, arithmetic, {kernel}"] / WEIGHTS
        bound = min(loads, arithmetic)
        yield (f"brick {label}", brick, "M voxels/s", None, "random parameters; one core")
        yield (f"brick {label} of ceiling", brick / arithmetic, "", "arithmetic of all weights",
               f"{arithmetic:.2f} M samples/s; products with what ReLU made zero are left out")
        yield (f"brick vs scattered {label}", brick / scattered, "", "inference, default model", "")
        yield (f"scattered {label} of ceiling", scattered / bound, "", "loads or arithmetic",
               f"{loads:.2f} M samples/s by loads, {arithmetic:.2f} by arithmetic")
        yield (f"brick two cores vs one {label}",
               rate[f"{MODEL}, {kernel}, all threads"] / brick, "", f"brick {label}",
               "by processor time")
    rounded = f"{MODEL}, avx512 bfloat16, 1 thread"
    if rounded in rate:
        yield ("brick AVX512 bfloat16", rate[rounded], "M voxels/s", None,
               "random parameters; one core")
        yield ("brick bfloat16 vs float32", rate[rounded] / rate[f"{MODEL}, avx512, 1 thread"], "",
               "brick AVX512", "")
    yield from with_tiles(rate, rounded)


def with_tiles(rate, rounded):
    """The same of tile registers, where there are such."""
    tiles = f"{MODEL}, amx bfloat16, 1 thread"
    if tiles not in rate:
        return
    yield ("brick AMX", rate[tiles], "M voxels/s", None, "random parameters; one core")
    yield ("brick vs scattered AMX",
           rate[tiles] / rate["inference, default model, amx bfloat16, 1 thread"], "",
           "inference, default model", "")
    yield ("brick two cores vs one AMX", rate[f"{MODEL}, amx bfloat16, all threads"] / rate[tiles],
           "", "brick AMX", "by processor time")
    yield ("brick AMX vs AVX512 bfloat16", rate[tiles] / rate[rounded], "",
           "brick AVX512 bfloat16", "")
    split = f"{MODEL}, amx split bfloat16, 1 thread"
    yield ("brick AMX split bfloat16", rate[split], "M voxels/s", None,
           "random parameters; one core")
    for name, model in (("", MODEL), (", trained model", "brick, trained model")):
        if f"{model}, avx512, 1 thread" in rate:
            yield (f"brick AMX split bfloat16 vs float32{name}",
                   rate[f"{model}, amx split bfloat16, 1 thread"] / rate[f"{model}, avx512, 1 thread"],
                   "", f"{model}, avx512, 1 thread", "")


def main():
    program, *rest = [argument for argument in sys.argv[1:] if argument != "--training"]
    if "--training" in sys.argv:
        results_file.write("training", plain(rates(program, "^training")))
        return
    model = rest[0] if rest else None
    rate = rates(program, "-^training", model)
    results = [results_file.result(name, round(value, 3), unit, "higher", note,
                                   **({"target": TARGETS[name]} if name in TARGETS else {}),
                                   **({"baseline": baseline} if baseline else {}))
               for name, value, unit, baseline, note in derived(rate)] + plain(rate, model)
    for result in results:
        print(f"{result['name']}: {result['value']} {result['unit']}")
    results_file.write("kernels", results)


if __name__ == "__main__":
    main()
