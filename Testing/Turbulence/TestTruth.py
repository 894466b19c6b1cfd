#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program that compares a model with the field: what it prints, and what it refuses.

    TestTruth.py CHANNEL_TRUTH MODEL.inr
"""
import json
import math
import subprocess
import sys

PROGRAM, MODEL = sys.argv[1:3]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)


def measure(*options):
    result = run(MODEL, "--voxels", "20000", *options)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


one = measure()
assert one["voxels"] == 20000
peak = one["model_range"][1] - one["model_range"][0]
assert abs(one["psnr"] - 20 * math.log10(peak / one["rms_error"])) < 1e-9
assert one["rms_error"] < one["max_error"], one
assert -0.5 < one["field_range"][0] < 0.5 and 1.2 < one["field_range"][1] < 2, one
assert measure("--threads", "1") == one
assert measure("--draw", "2")["psnr"] != one["psnr"]
assert measure("--seed", "2")["psnr"] != one["psnr"]
assert measure("--intensity", "0")["field_range"][1] <= 1

for arguments, status, expected in (
    (["missing.inr"], 1, "missing.inr"),
    ([MODEL, "--voxels", "0"], 2, "at least one"),
    ([MODEL, "--threads"], 2, "lacks its value"),
    ([], 2, "usage"),
):
    result = run(*arguments)
    assert result.returncode == status and expected in result.stderr, (arguments, result)
