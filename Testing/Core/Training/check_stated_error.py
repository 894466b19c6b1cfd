#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds what model files say of their own error against the data, with arithmetic of its own.

    check_stated_error.py PROGRAM FOLDER

runs PROGRAM FOLDER (write_extremes), reads its files by what FORMAT.md says of them, evaluates the
networks in float64 and takes the differences in extended precision, which holds every integer of 64
bits and every difference of two neighbouring doubles.
"""
import math
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "Inference"), str(HERE.parents[1] / "Benchmarks")]
from model_file import read_document  # noqa: E402
from truth import evaluate  # noqa: E402

Real = np.longdouble
# The kernels compute in single precision: so much of the range may their values be beside ours.
KERNEL_ERROR = 2e-5


def told(value):
    return {"infinity": math.inf, "-infinity": -math.inf, "nan": math.nan}.get(value, value)


def decoded(document, size):
    """The normalised values at all voxels, x fastest."""
    axes = [(np.arange(n) + 0.5) / n for n in size]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    places = np.stack([x.ravel(), y.ravel(), z.ravel()], 1).astype(np.float32)
    parameters = np.frombuffer(document["parameters"]["params_binary"], "<f4").astype(np.float64)
    encoding = {"per_level_scale": 2.0, **document["model"]["encoding"]}
    values = evaluate(encoding, document["model"]["network"], parameters, places)
    return np.clip(values, 0, 1).astype(Real)


def check(path):
    document = read_document(path.read_bytes())
    ours = document["inr"]
    data = np.frombuffer(path.with_suffix(".raw").read_bytes(), ours["array_type"]).astype(Real)
    low, high = (ours["data_range"][end] for end in ("low", "high"))
    stated = {name: told(value) for name, value in ours["quality"].items()}
    faults = []
    # Of integers that no double is, the next one beyond.
    next_low, last_high = np.nextafter(low, np.inf), np.nextafter(high, -np.inf)
    if not (low <= data.min() < next_low and last_high < data.max() <= high):
        faults.append(f"range {low!r} to {high!r}, data {data.min()!r} to {data.max()!r}")
    width = Real(high) - Real(low)
    size = [ours["dims"][axis] for axis in "xyz"]
    errors = np.abs(width * decoded(document, size) - (data - Real(low)))
    slack = KERNEL_ERROR * width
    if not errors.max() - slack <= stated["max_error"] <= errors.max() * Real(1.001) + slack:
        faults.append(f"largest error {stated['max_error']!r} stated, {errors.max()!r} found")
    mean = np.mean((errors / width) ** 2) if width > 0 else Real(0 if errors.max() == 0 else math.nan)
    psnr = -10 * np.log10(mean) if mean > 0 else Real(math.inf if mean == 0 else math.nan)
    same = math.isnan(psnr) and math.isnan(stated["psnr"])
    if not (same or psnr == stated["psnr"] or abs(psnr - stated["psnr"]) < 0.02):
        faults.append(f"PSNR {stated['psnr']} stated, {psnr} found")
    print(f"{path.stem:20} {stated['psnr']:8.3f} dB, largest error {stated['max_error']:.6g}", *faults,
          sep="\n    " if faults else " ")
    return not faults


def main():
    program, folder = sys.argv[1:]
    subprocess.run([program, folder], check=True)
    files = sorted(Path(folder).glob("*.inr"))
    right = [check(path) for path in files]
    sys.exit(0 if len(right) >= 20 and all(right) else 1)


if __name__ == "__main__":
    main()
