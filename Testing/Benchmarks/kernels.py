#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_kernels and writes kernels.json.

    cmake --preset dev -DCMAKE_BUILD_TYPE=Release && cmake --build --preset dev --target bench_kernels
    Testing/Benchmarks/kernels.py build-dev/Testing/Benchmarks/bench_kernels
"""
import json
import subprocess
import sys

import results_file

output = subprocess.run([sys.argv[1], "--benchmark_format=json"], check=True, capture_output=True)
results = []
for run in json.loads(output.stdout)["benchmarks"]:
    name = run["name"].removesuffix("/real_time")
    results.append(results_file.result(name, round(run["items_per_second"] / 1e6, 3), "M samples/s",
                                       "higher", f"{run['iterations']} iterations"))
    print(f"{name}: {results[-1]['value']} M samples/s")
results_file.write("kernels", results)
