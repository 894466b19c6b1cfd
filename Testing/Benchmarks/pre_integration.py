#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_pre_integration for one or more models and writes pre-integration.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_pre_integration
    Testing/Benchmarks/pre_integration.py build-core/Testing/Benchmarks NAME=MODEL.inr...
"""
import json
import subprocess
import sys
from pathlib import Path

import results_file

folder = Path(sys.argv[1])
results = []
for argument in sys.argv[2:]:
    name, model = argument.split("=", 1)
    run = subprocess.run([folder / "bench_pre_integration", model, name], stdout=subprocess.PIPE,
                         text=True, check=True)
    for line in run.stdout.splitlines():
        result = {key: float(f"{value:.4g}") if isinstance(value, float) else value
                  for key, value in json.loads(line).items()}
        result["note"] = ("2 threads; time, and its quartiles: of the processor, as a part of a "
                          "plain frame's at a distance of 0.5")
        results.append(result)
        print(f"{result['name']}: {result['value']} dB in {result['time']}", flush=True)
results_file.write("pre-integration", results)
