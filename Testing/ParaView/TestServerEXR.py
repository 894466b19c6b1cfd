# SPDX-License-Identifier: BSD-3-Clause
"""Save Screenshot as OpenEXR of a view that a server draws: the floats that this process draws of the same
file, in front of what the server's surfaces hide. Arguments: the server's port and its number of
processes."""
import os
import sys

import numpy as np
from exrfile import read_exr
from paraview import simple
from pvtest import Messages, check, connect, load_plugin, output_file, picture, show_ball, show_model

PORT, PROCESSES = int(sys.argv[1]), int(sys.argv[2])


def show_scene():
    view, display = show_model((160, 120))
    show_ball(view, [30, 45, 60], 25)
    return view, display


def save(view, name, **options):
    """The channels, and what was reported."""
    path = output_file(f"server-{PROCESSES}-{name}.exr")
    if os.path.exists(path):
        os.remove(path)
    with Messages() as messages:
        simple.SaveScreenshot(path, view, **options)
    return read_exr(path) if os.path.exists(path) else None, messages


def pictures(view, display):
    result = {"plain": save(view, "plain")}
    display.SampleChannels = 1
    result["small"] = save(view, "small", ImageResolution=[80, 60])
    display.SampleChannels = 0
    display.INRBlendMode = "Maximum Intensity"
    result["maximum"] = save(view, "maximum")
    display.INRBlendMode = "Isosurface"
    display.INRIsosurfaceValues = [30, 80]
    display.Shade = 1
    result["isosurfaces"] = save(view, "isosurfaces")
    for name, (channels, messages) in result.items():
        check(messages.errors() == 0 and channels, name, "reported", messages.text)
    return {name: channels for name, (channels, messages) in result.items()}


load_plugin()
expected = pictures(*show_scene())
check((expected["plain"]["Z"] < 1).mean() > 0.05, "nothing is shown")

connect(PORT)
view, display = show_scene()
before = picture(view, f"server-{PROCESSES}-exr-before")
found = pictures(view, display)
for name, channels in expected.items():
    check(sorted(found[name]) == sorted(channels), name, "has channels", sorted(found[name]))
    for channel, pixels in channels.items():
        # Geometry comes as ParaView sends it, the grid with fewer points: rounding, here and there.
        difference = np.abs(found[name][channel] - pixels)
        print(name, channel, "largest difference", difference.max())
        check(found[name][channel].shape == pixels.shape, name, "has another size")
        check(np.mean(difference > 1e-3) < 2e-3, name, channel, "differs")

# Afterwards it is the server again that draws.
check(view.RemoteRenderThreshold == 0, "the threshold stays changed")
display.INRBlendMode, display.Shade = "Composite", 0
after = picture(view, f"server-{PROCESSES}-exr-after")
check(np.abs(after - before).max() < 1e-6, "the view has changed")
display.LevelOfDetailScale = 0  # new work, for whoever draws
simple.Render(view)
client = [prop for prop in view.GetRenderer().GetVolumes() if "INRLODVolume" in prop.GetClassName()]
check(len(client) == 1 and client[0].GetEnableLOD() == 1, "the client draws")

# What only the server can draw.
simple.Show(simple.Wavelet(), view).SetRepresentationType("Volume")
channels, messages = save(view, "refused")
wanted = messages.errors() == 1 and "hide" in messages.text and channels is None
check(wanted, "with a stock volume reported", messages.text)
os._exit(0)
