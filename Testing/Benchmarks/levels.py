#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_levels for one or more models and writes levels.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_levels
    Testing/Benchmarks/levels.py build-core/Testing/Benchmarks NAME=MODEL.inr...
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
    run = subprocess.run([folder / "bench_levels", model, name], stdout=subprocess.PIPE, text=True,
                         check=True)
    for line in run.stdout.splitlines():
        result = json.loads(line)
        result["value"] = float(f"{result['value']:.4g}")
        if "places a voxel" in result["name"]:
            result["note"] = "linear between voxels, against the model, at 200,000 places"
        else:
            result["note"] = ("2 threads, 512x512, nothing decoded before; against the full "
                              "resolution; time: of the processor")
        results.append(result)
        print(f"{result['name']}: {result['value']} {result['unit']}", flush=True)
results_file.write("levels", results)
