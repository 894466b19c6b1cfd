#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recomputes what TestFlip.cpp expects with the package of the paper's authors. By hand:

    python3 -m venv VENV && VENV/bin/pip install flip-evaluator==1.7 numpy
    VENV/bin/python Testing/Core/Image/flip_reference.py
"""
import flip_evaluator
import numpy

MASK = (1 << 64) - 1


def mixed(x):
    x = (x + 0x9E3779B97F4A7C15) & MASK
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & MASK
    return x ^ (x >> 31)


def random_unit(seed, counter):
    """RandomUnit of Core/Random.h."""
    return (mixed(mixed(seed) ^ (counter * 0xD1342543DE82EF95 & MASK)) >> 40) * 2.0**-24


def noise(seed, width=37, height=29):
    """RandomImage of RandomImage.h; as all images here [y, x, channel]."""
    values = [random_unit(seed, k) for k in range(width * height * 3)]
    return numpy.array(values, numpy.float32).reshape(height, width, 3)


def waves(shift, width=48, height=40):
    y, x = numpy.mgrid[0:height, 0:width].astype(float)
    return numpy.stack([0.5 + 0.5 * numpy.sin(0.21 * x + 0.05 * y + shift),
                        0.5 + 0.5 * numpy.cos(0.13 * y - 0.02 * x),
                        (x + y) / (width + height)], axis=-1).astype(numpy.float32)


def disc(colour, radius=9.5, width=40, height=36):
    y, x = numpy.mgrid[0:height, 0:width].astype(float)
    inside = (x - 18)**2 + (y - 20)**2 < radius**2
    return (inside[..., None] * numpy.array(colour)).astype(numpy.float32)


PAIRS = {
    "noise": (noise(1), 0.75 * noise(1) + 0.25 * noise(2), 67.020643276582255),
    "other noise": (noise(1), noise(2), 67.020643276582255),
    "waves": (waves(0), waves(0.3), 67.020643276582255),
    "waves, near": (waves(0), waves(0.3), 20),
    "waves, far": (waves(0), waves(0.3), 150),
    "colours": (disc((1, 0, 0)), disc((0, 0, 1)), 67.020643276582255),
    "sizes": (disc((0.2, 0.9, 0.4)), disc((0.2, 0.9, 0.4), 10.5), 67.020643276582255),
}

for name, (reference, test, ppd) in PAIRS.items():
    errors, mean, _ = flip_evaluator.evaluate(reference.astype(numpy.float32),
                                              test.astype(numpy.float32), "LDR", applyMagma=False,
                                              parameters={"ppd": ppd})
    print(f'{{"{name}", ..., {ppd:.6g}, {errors.astype(float).mean():.7f}, '
          f'{{{errors[0, 0, 0]:.6f}, {errors[20, 11, 0]:.6f}, {errors[28, 36, 0]:.6f}}}}}')
