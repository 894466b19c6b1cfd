# SPDX-License-Identifier: BSD-3-Clause
"""A server draws what this process draws: in one process, or in several, a part of the picture each. And
this process draws what the server has. Arguments: the server's port and its number of processes."""
import os
import sys

import numpy as np
from pvtest import check, check_same, connect, load_plugin, picture, show_model

PORT, PROCESSES = int(sys.argv[1]), int(sys.argv[2])


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
check(expected["plain"].std() > 0.05, "nothing is shown")

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
