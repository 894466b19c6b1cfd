#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks perceptual.py: where there is no package lpips, that it says so; where there is, everything
but AlexNet's own weights, in place of which it makes random ones in a folder of its own.

    python3 -m venv VENV && VENV/bin/pip install lpips numpy
    VENV/bin/python Testing/Benchmarks/check_perceptual.py
"""
import os
import struct
import sys
import tempfile
from pathlib import Path

import perceptual


def expect(condition, words):
    if not condition:
        sys.exit(f"failed: {words}")


def expect_absent(words, **how):
    try:
        perceptual.Lpips(**how)
    except perceptual.Absent as why:
        expect(words in str(why), f"'{words}' in '{why}'")
    else:
        sys.exit(f"failed: was there, instead of: {words}")


def save_random_weights():
    import torch
    from torchvision import models
    torch.manual_seed(1)
    path = perceptual.weights_file()
    path.parent.mkdir(parents=True)
    path.write_bytes(b"no weights")
    expect_absent("does not hold AlexNet's weights")
    torch.save(models.alexnet(weights=None).state_dict(), path)
    expect_absent("does not hold AlexNet's weights")


def check_distances(folder):
    import numpy as np
    metric = perceptual.Lpips(genuine=False)
    random = np.random.default_rng(1)
    picture = random.random((64, 80, 3))
    near = np.clip(picture + 0.01 * random.standard_normal(picture.shape), 0, 1)
    far = random.random(picture.shape)
    expect(metric.distance(picture, picture) == 0, "0 for equal pictures")
    distances = [metric.distance(picture, other) for other in (near, far)]
    expect(0 < distances[0] < distances[1], f"more for what differs more, of {distances}")
    # What bench_tradeoff writes: two pictures of 64 rows, whose alpha is not looked at.
    pair = np.zeros((2, 64, 80, 4), np.float32)
    pair[0, ::-1, :, :3], pair[1, ::-1, :, :3], pair[1, ..., 3] = picture, far, 1
    path = Path(folder) / "pair"
    path.write_bytes(struct.pack("<ii", 80, 64) + pair.tobytes())
    expect(abs(metric.of_file(path) - distances[1]) < 1e-6, "the same from a file")
    print(metric.about, distances)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.environ["TORCH_HOME"] = folder
        metric, about = perceptual.load()
        expect(metric is None and about.startswith("absent: "), about)
        if "cannot be imported" in about:
            print(about)
            return
        expect(folder in about, f"the missing file's name in '{about}'")
        save_random_weights()
        check_distances(folder)


if __name__ == "__main__":
    main()
