# SPDX-License-Identifier: BSD-3-Clause
"""A server draws what this process draws: in one process, or in several that have a piece each. And
this process draws what the server has. Arguments: the server's port and its number of processes."""
import os
import sys

import numpy as np
from pvtest import check, connect, load_plugin, picture, psnr, show_model

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
    for name, picture_here in expected.items():
        difference = 255 * np.abs(found[name] - picture_here)
        decibels = psnr(found[name], picture_here)
        print(f"{name}: largest {difference.max():.0f} of 255, mean {difference.mean():.3f},",
              f"PSNR {decibels:.1f} dB")
        if name == "paths":  # whose noise differs
            blocks = (found[name] - picture_here).reshape(10, 20, 10, 20, 3).mean(axis=(1, 3))
            print(f"largest difference of 20x20 pixels: {255 * np.abs(blocks).max():.2f} of 255")
            check(np.abs(blocks).max() < 0.01, name, "are brighter or darker somewhere")
        else:  # but for the 8 bits in which processes hand over their parts
            check(difference.max() < 4.5, name, "differs")
            check(np.mean(difference > 2.5) < 1e-4, name, "differs")
            check(abs((found[name] - picture_here).mean()) < 1e-4, name, "is brighter or darker")


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
