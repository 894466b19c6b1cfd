# SPDX-License-Identifier: BSD-3-Clause
"""A server draws what this process draws: in one process, or in several, a part of the picture each. And
this process draws what the server has. Arguments: the server's port and its number of processes."""
import os
import sys

import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, check, check_same, connect, load_plugin, picture, show_model

PORT, PROCESSES = int(sys.argv[1]), int(sys.argv[2])


# What is shown of a volume that filters have moved, and whose scalars are others now.
MOVE = """
image = self.GetImageDataOutput()
image.ShallowCopy(self.GetInputDataObject(0, 0))
image.SetOrigin(20, -30, 10)
image.SetSpacing([0.6 * step for step in image.GetSpacing()])
"""


def show_moved(view):
    source = simple.Elevation(Input=simple.OpenDataFile(MODEL))
    display = simple.Show(simple.ProgrammableFilter(Input=source, Script=MOVE), view)
    display.SetRepresentationType("INR Volume")
    simple.ColorBy(display, ("POINTS", ARRAY))
    display.SetScalarBarVisibility(view, False)
    display.ScalarOpacityUnitDistance = 1
    return display


def show_scene():
    view, display = show_model((200, 200))
    display.SamplesPerPixel = 64
    display.MaximumBounces = 2
    return view, display


def pictures(view, display, where):
    """By name: the kinds of still pictures."""
    result = {}

    def take(name):
        result[name] = picture(view, f"server-{PROCESSES}-{where}-{name}")

    take("plain")
    display.Shade = 1
    take("shaded")
    display.Shade = 0
    display.INRUseCropping = 1
    display.INRCroppingScale = [0.6, 1, 0.5]
    display.INRCroppingOrigin = [10, 0, 5]
    take("cropped")
    display.INRUseCropping = 0
    display.RenderMode = "Path Tracing"
    take("paths")
    display.RenderMode = "Ray Marching"
    display.Visibility = 0
    moved = show_moved(view)
    take("moved")
    moved.Visibility, display.Visibility = 0, 1
    return result


def compare(found, expected):
    noise = found.pop("paths") - expected["paths"]  # differs
    blocks = np.abs(noise.reshape(10, 20, 10, 20, 3).mean(axis=(1, 3))).max()
    print(f"paths: largest difference of 20x20 pixels: {255 * blocks:.2f} of 255")
    check(blocks < 0.01, "paths are brighter or darker somewhere")
    rays = {name: image for name, image in expected.items() if name != "paths"}
    check_same(found, rays, composed=[])
    for name, image in rays.items():
        check(abs((found[name] - image).mean()) < 1e-4, name, "is brighter or darker")


load_plugin()
expected = pictures(*show_scene(), "here")
for name in ("plain", "moved"):
    check(expected[name].std() > 0.05, name, "shows nothing", expected[name].std())

connect(PORT)
view, display = show_scene()
compare(pictures(view, display, "there"), expected)
display.UpdatePropertyInformation()
print("drawn by", display.GetPropertyValue("BackendInUse"))

view.RemoteRenderThreshold = 1000
compare(pictures(view, display, "delivered"), expected)
display.UpdatePropertyInformation()
check(display.GetPropertyValue("CacheUsed") > 0, "the client has drawn nothing")
os._exit(0)
