# SPDX-License-Identifier: BSD-3-Clause
"""A scene that programs with different versions of VTK draw, in plain numbers."""
import numpy as np

SIZE = (280, 240)
BACKGROUND = (0.9, 0.93, 1.0)
# At the lowest value, in the middle and at the highest one; opacities are 255ths, per UNIT.
COLORS = ("#203080", "#20b090", "#f0c040")
OPACITIES = (0, 100, 240)
UNIT = 3.0
POSITION = (75.0, -35.0, 50.0)
FOCUS = (20.0, 21.0, 14.0)
UP = (0.0, 0.0, 1.0)

SPACING = (1.0, 1.2, 0.9)
STEPS = 400


def field():
    """Of 40 x 36 x 32 points, by x, y and z: a ring that leans, and a ball beside its middle. Nothing
    about it is symmetric, so that a picture shows a volume that is mirrored or turned."""
    x, y, z = np.meshgrid(*(np.linspace(-1, 1, n) for n in (40, 36, 32)), indexing="ij")
    ring = (np.hypot(x, y) - 0.62) ** 2 + (z - 0.4 * x) ** 2
    ball = (x - 0.25) ** 2 + (y + 0.3) ** 2 + (z - 0.6) ** 2
    return (np.exp(-ring / 0.04) + 0.6 * np.exp(-ball / 0.05)).astype(np.float32)


def rgb(color):
    return tuple(int(color[i:i + 2], 16) / 255 for i in (1, 3, 5))


def train(writer, image, path):
    """Writes the model, the same one every time but for how a processor rounds."""
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.SetMaximumSteps(STEPS)
    assert writer.Write() == 1, "no model"
    assert writer.GetPSNR() > 35, writer.GetPSNR()
