#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program that draws the field and compares a picture with it: what it writes, and what it
refuses.

    TestPicture.py CHANNEL_PICTURE FOLDER
"""
import json
import os
import subprocess
import sys

PROGRAM, FOLDER = sys.argv[1:3]
os.makedirs(FOLDER, exist_ok=True)
SCENE = {"dims": [80, 60, 24], "size": [24, 20], "position": [12, -20, 12], "focal_point": [12, 5, 1],
         "view_up": [0, 0, 1], "view_angle": 40, "clipping_range": [1, 100], "sample_distance": 1,
         "unit_distance": 1, "seed": 0,
         "colors": [[0.2, 0, 0, 1, 0], [0.8, 1, 1, 1, 0.2], [1.2, 1, 0, 0, 0.8]]}


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, cwd=FOLDER)


def draw(name, *options, **changes):
    with open(os.path.join(FOLDER, name + ".json"), "w") as file:
        json.dump({**SCENE, **changes}, file)
    result = run(name + ".json", name + ".exr", *options)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


one = draw("one")
assert one["samples"] > 1000 and "psnr" not in one, one
same = draw("same", "--compare", "one.exr", "--beside", "same.ppm")
assert same["samples"] == one["samples"] and same["max_error"] == 0, same
assert same["ssim"] > 0.9999 and same["flip"] == 0, same
other = draw("other", "--compare", "one.exr", "--seed", "2", "--beside", "other.ppm")
assert 5 < other["psnr"] < 60 and other["flip"] > 0 and other["ssim"] < 1, other
moved = draw("moved", "--compare", "one.exr", position=[12, -20, 14])
assert moved["flip"] > other["flip"], (moved, other)

header, pixels = open(os.path.join(FOLDER, "same.ppm"), "rb").read().split(b"\n255\n", 1)
assert header == b"P6\n48 20" and len(pixels) == 48 * 20 * 3, header
rows = [pixels[k:k + 144] for k in range(0, len(pixels), 144)]
assert all(row[:72] == row[72:] for row in rows), "equal pictures differ beside each other"
assert max(pixels) > 50 and rows[0][:3] == b"\0\0\0", "nothing is seen, or no background"

for arguments, status, expected in (
    (["missing.json", "new.exr"], 1, "missing.json"),
    (["one.json"], 2, "usage"),
    (["one.exr", "new.exr"], 2, "scene"),
    (["one.json", "new.exr", "--compare", "missing.exr"], 1, "missing.exr"),
    (["one.json", "new.exr", "--colour", "1"], 2, "--colour"),
):
    result = run(*arguments)
    assert result.returncode == status and expected in result.stderr, (arguments, result)
