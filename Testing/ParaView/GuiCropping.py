# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window: the box that GuiCropping.xml moves by the mouse crops the volume, in the panel's
properties, in those of scripts and in the picture."""
import time

import numpy as np
from paraview import simple
from guisteps import begin, follow
from pvtest import MODEL, check, check_baseline, picture

view = begin()
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.SetScalarBarVisibility(view, False)
display.ScalarOpacityUnitDistance = 1
# Along z, so that the volume takes the middle half of the view's height: its upper face is at 1/4.
bounds = np.array(reader.GetDataInformation().GetBounds()).reshape(3, 2)
middle, height = bounds.mean(axis=1), bounds[1, 1] - bounds[1, 0]
view.CameraParallelProjection = 1
view.CameraFocalPoint = list(middle)
view.CameraPosition = list(middle + [0, 0, 5 * height])
view.CameraViewUp = [0, 1, 0]
view.CameraParallelScale = height
simple.Render(view)
WANTED = bounds.copy()
WANTED[1, 1] = middle[1] + 0.1 * 2 * height  # the mouse lets go at 0.4 from above


def box():
    """The ends of the cropped box, as scripts see it."""
    scale, origin = np.array(display.CroppingScale), np.array(display.CroppingOrigin)
    return bounds * scale[:, None] + origin[:, None]


def watch():
    """Yields between two looks at the window."""
    deadline = time.time() + 120
    while not display.UseCropping or abs(box() - WANTED).max() > 0.02 * height:
        check(time.time() < deadline, "cropping", display.UseCropping, "to", box(), "not", WANTED)
        yield
    check(display.INRUseCropping == 1, "not in the panel")
    check(list(display.INRCroppingScale) == list(display.CroppingScale), "another scale in the panel")
    check(list(display.INRCroppingOrigin) == list(display.CroppingOrigin), "another origin")
    image = picture(view, "gui-cropping", (400, 400))
    shown = (image[::-1] < 0.95).any(axis=2).mean(axis=1)  # part of each row, from above
    print("box", box().tolist(), "rows from", np.flatnonzero(shown > 0.2)[[0, -1]])
    # Of the box, whose handles stay, no more than one stands out.
    check(shown[:150].max() < 0.05, "there is something above the box", shown[:150].max())
    check(shown[170:290].min() > 0.3, "the volume is gone", shown[170:290].min())
    check_baseline(image, "GuiCropping")


follow(watch(), view.GetRenderWindow().GetInteractor())
