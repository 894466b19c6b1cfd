# SPDX-License-Identifier: BSD-3-Clause
"""Processes of pvbatch that hold a piece of the volume each draw what one draws. The first argument is
"write" in several processes, "check" in one."""
import os
import re
import sys

import numpy as np
from glass_scenes import check_parallel, path_of, pictures
from paraview import servermanager, simple
from pvtest import Messages, check, load_plugin, output_file, picture, read_png, show_model

# One of each kind; the processes of a server draw all of them.
CHOSEN = ["paths", "paths over glass", "isosurfaces over glass", "turned over glass 0", "two traced", "lit",
          "two over glass", "the other elsewhere"]

load_plugin()


def check_text():
    """What ShowStatus adds is in a corner, and no camera wants to see all that it might be in."""
    view, display = show_model()
    bare = picture(view, "batch-status-off")
    camera = list(view.CameraPosition)
    display.ShowStatus = 1
    simple.Render(view)
    view.ResetCamera()
    check(np.allclose(camera, view.CameraPosition), "the camera goes from", camera, view.CameraPosition)
    differs = np.any(np.abs(picture(view, "batch-status") - bare) > 2.5 / 255, axis=2)
    check(differs[-60:].any(), "there is no text")
    check(not differs[:-60].any(), "more than the text is drawn")


def check_behind():
    """Nothing is wrong with a camera that has turned away."""
    view, _ = show_model()
    simple.Render(view)
    view.CameraPosition, view.CameraFocalPoint = [500, 500, 500], [1000, 1000, 1000]
    with Messages() as messages:
        behind = picture(view, "batch-behind")
    check(messages.errors() == 0, "it reported", messages.text)
    check(behind.std() < 1e-6, "something is shown")


if sys.argv[1] == "write":
    pictures("batch", CHOSEN)
    # They share the memory of the machine, too.
    processes = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") >> 20
    for volume in simple.GetActiveView().GetRenderer().GetVolumes():
        for size in re.findall(r" CacheSize: (\d+)", str(volume.GetMapper())):
            check(processes > 1 and 0 < int(size) <= memory / 4 / processes, "CacheSize", size)
    check_text()
    check_behind()
else:
    expected = pictures("alone", CHOSEN)[2]
    found = {name: read_png(output_file(path_of("batch", name) + ".png")) for name in expected}
    check_parallel(found, expected)
    os._exit(0)
