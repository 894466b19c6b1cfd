# SPDX-License-Identifier: BSD-3-Clause
"""The processes of a server, which have a piece each, draw the projections and isosurfaces that this
process draws: from all sides, cropped, and with opaque things and another volume among them. Arguments:
the server's port and its number of processes."""
import os
import sys

import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, Messages, check, check_interactive, check_same, connect, load_plugin
from pvtest import look_at, output_file, picture, show_balls, show_model

PORT = int(sys.argv[1])
PROJECTIONS = ["Maximum Intensity", "Minimum Intensity", "Average Intensity", "Additive"]
COMPOSED = ["over glass", "composite over glass"]
FEW = output_file("few-voxels.inr")


def pictures(where):
    """By name."""
    result = {}
    view, display = show_model((160, 130))
    balls = show_balls(view)

    def take(name):
        result[name] = picture(view, f"server-blending-{where}-{name}")

    opacity = simple.GetOpacityTransferFunction(ARRAY)
    usual = list(opacity.Points)
    for mode, even in zip(PROJECTIONS, (None, None, 1, 0.2)):
        display.INRBlendMode = mode
        opacity.Points = [usual[0], even, 0.5, 0, usual[-4], even, 0.5, 0] if even else usual
        take(mode)
    opacity.Points = usual
    display.INRBlendMode = "Maximum Intensity"
    camera = view.GetActiveCamera()
    for side in range(3):  # each process is the foremost once, and the hindmost
        camera.Azimuth(110)
        camera.Elevation((50, -100, 30)[side])
        camera.OrthogonalizeViewUp()
        take(f"side {side}")
    look_at(view)
    display.INRUseCropping = 1
    display.INRCroppingScale = [0.6, 1, 0.5]
    display.INRCroppingOrigin = [10, 0, 5]
    take("cropped")
    display.INRUseCropping = 0
    opacity.Points = [usual[0], 0, 0.5, 0, usual[-4] / 2, 1, 0.5, 0]
    camera.SetPosition(10, 70, 30)  # in the volume, which is before, between and behind the balls
    camera.SetFocalPoint(80, 20, 70)
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(70)
    view.GetRenderer().ResetCameraClippingRange()
    take("inside")
    camera.SetPosition(45, 45, 88)  # so that some of the volume is beside the eye
    camera.SetFocalPoint(45, 45, 0)
    camera.SetViewAngle(110)
    view.GetRenderer().ResetCameraClippingRange()
    take("from a face")
    opacity.Points = usual
    camera.SetViewAngle(30)
    look_at(view)
    second = simple.Show(simple.INRReader(FileName=MODEL), view)
    second.Position = [60, 0, 0]
    take("composite beside it")
    second.INRBlendMode = "Minimum Intensity"
    take("two projections")
    balls[0].Opacity = 0.5  # which one process peels
    take("over glass")
    balls[0].Opacity = 1
    display.INRBlendMode = second.INRBlendMode = "Composite"
    second.Position = [20, -95, 30]  # not as the pieces are
    take("two volumes")
    for side in range(2):
        camera.Azimuth(130)
        take(f"two volumes {side}")
    second.Visibility = 0
    look_at(view)
    balls[0].Opacity = 0.5
    take("composite over glass")
    display.Position, display.Scale = [0, 40, 20], [1, 0.7, 1.2]  # the surfaces are in other pieces then
    take("moved")
    display.Position, display.Scale = [0, 0, 0], [1, 1, 1]
    display.INRBlendMode = "Maximum Intensity"
    for ball in balls:
        ball.Visibility = 0
    take("alone")
    display.INRBlendMode = "Isosurface"
    display.INRIsosurfaceValues = [20, 45, 80, 120]
    take("isosurfaces")
    display.Shade = 1
    take("shaded isosurfaces")
    display.LevelOfDetailScale = 3
    take("coarse isosurfaces")
    display.Visibility = 0
    few = simple.Show(simple.INRReader(FileName=FEW), view)
    few.SetScalarBarVisibility(view, False)
    few.INRBlendMode = "Maximum Intensity"
    view.ResetCamera()
    take("of one process")
    display.Visibility, display.INRBlendMode = 1, "Maximum Intensity"
    few.Scale, few.Position = [40, 40, 40], [120, 20, 20]
    look_at(view)
    for side in range(2):  # in front of what all draw together, and behind it
        camera.Azimuth(100)
        take(f"of one process beside it {side}")
        camera.Azimuth(80)
    few.Visibility = 0
    look_at(view)
    return view, display, result


load_plugin()
# Too few voxels for every process to have some.
simple.SaveData(FEW, proxy=simple.Wavelet(WholeExtent=[0, 1, 0, 1, 0, 1]), MaximumSteps=50)
expected = pictures("here")[2]
for name, image in expected.items():
    check(image.std() > 0.03, name, "shows nothing", image.std())

connect(PORT)
with Messages() as messages:
    view, display, found = pictures("there")
check(messages.errors() == 0, "drawing reported", messages.text)
check_same(found, expected, COMPOSED)

# While the mouse moves, too: parts of a picture that has fewer pixels than the window.
display.INRBlendMode = "Maximum Intensity"
check_interactive(view, display)
os._exit(0)
