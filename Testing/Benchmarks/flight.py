#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_flight for one or more models and writes flight.json or protocol.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON && cmake --build --preset core
    Testing/Benchmarks/flight.py build-core/Testing/Benchmarks flight|protocol FRAMES NAME=MODEL.inr...
"""
import json
import subprocess
import sys
from pathlib import Path

import results_file

folder, mode, frames = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
results = []
for argument in sys.argv[4:]:
    name, model = argument.split("=", 1)
    run = subprocess.run([folder / "bench_flight", model, name, mode, frames],
                         stdout=subprocess.PIPE, text=True, check=True)
    for line in run.stdout.splitlines():
        result = json.loads(line)
        result["value"] = float(f"{result['value']:.4g}")
        result["note"] = "2 threads, " + ("512x512" if mode == "protocol" else "192x192")
        results.append(result)
        print(f"{result['name']}: {result['value']} {result['unit']}", flush=True)
results_file.write(mode, results)
