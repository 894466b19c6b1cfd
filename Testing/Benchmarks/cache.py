#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs bench_majorants, bench_cache, bench_paths, and where they were built bench_against_vtk and
bench_interaction; writes cache.json.

    cmake --preset vtk -DINR_BUILD_BENCHMARKS=ON && cmake --build --preset vtk
    Testing/with-display.sh Testing/Benchmarks/cache.py build-vtk/Testing/Benchmarks \\
        NAME=MODEL.inr [NAME=MODEL.inr:frames...]

":frames" leaves out what takes minutes.
"""
import json
import subprocess
import sys
from pathlib import Path

import results_file


def majorants(program):
    """From a change of transfer function to all levels' majorants, and rays through next to
    nothing."""
    output = subprocess.run([program, "--benchmark_format=json"], check=True, capture_output=True)
    for run in json.loads(output.stdout)["benchmarks"]:
        given = dict(part.split(":") for part in run["name"].split("/") if ":" in part)
        cells = f"{int(given['edge'])**3 / 1e6:.3g} M cells"
        rate = float(f"{run['items_per_second'] / 1e6:.4g}")
        if "threads" in given:
            name, unit = f"majorants of {cells}, threads: {given['threads']}", "M cells/s"
            note = "4.17 M cells are the largest default table"
        else:
            name, unit, note = f"rays through {cells}, empty", "M rays/s", "one thread"
        print(f"{name}: {rate} {unit} ({note})", flush=True)
        yield results_file.result(name, rate, unit, "higher", note)


folder = Path(sys.argv[1])
results = list(majorants(folder / "bench_majorants"))
for argument in sys.argv[2:]:
    name, model = argument.split("=", 1)
    model, _, part = model.partition(":")
    for program, more in (("bench_against_vtk", []), ("bench_cache", [part] if part else []),
                          ("bench_paths", []), ("bench_interaction", [])):
        if not (folder / program).exists():
            continue
        process = subprocess.Popen([folder / program, model, name, *more], stdout=subprocess.PIPE,
                                   text=True)
        for line in process.stdout:
            if line.startswith("{"):
                result = json.loads(line)
                result["value"] = float(f"{result['value']:.4g}")
                result.setdefault("note", "512x512, 2 threads")
                results.append(result)
                print(f"{result['name']}: {result['value']} {result['unit']}", flush=True)
        if process.wait() != 0:
            sys.exit(f"{program} failed")
    results_file.write("cache", results)  # a long run may end early
