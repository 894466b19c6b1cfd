# SPDX-License-Identifier: BSD-3-Clause
"""With Deterministic on, a script that never waits for a finished picture makes the same pictures,
to the last bit, in every process."""
import os
import subprocess
import sys

import numpy as np
from paraview import simple
from pvtest import MODEL, check, load_plugin, look_at, output_file, show_view
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter


def shown(view):
    """What is in the window, without rendering again."""
    capture = vtkWindowToImageFilter()
    capture.SetInput(view.GetRenderWindow())
    capture.ReadFrontBufferOff()
    capture.ShouldRerenderOff()
    capture.Update()
    return vtk_to_numpy(capture.GetOutput().GetPointData().GetScalars()).copy()


def fly(threads, path):
    """Unfinished pictures from a camera that moves."""
    load_plugin()
    view = show_view((160, 120))
    display = simple.Show(simple.OpenDataFile(MODEL), view)
    display.Deterministic = 1
    display.NumberOfThreads = threads
    display.BrickSize = 12
    display.MaximumRequests = 4
    display.LevelOfDetailScale = 0
    display.SamplesPerPixel = 3
    look_at(view)
    pictures, converged = [], []
    for mode in ("Ray Marching", "Path Tracing"):
        for cache in (64, 1):
            display.RenderMode = mode
            display.CacheSize = cache
            for k in range(8):
                if k % 3 == 2:
                    view.GetActiveCamera().Azimuth(7)
                view.SMProxy.InteractiveRender()
                pictures.append(shown(view))
                display.UpdatePropertyInformation()
                converged.append(display.GetPropertyValue("Converged"))
    np.savez(path, pictures=pictures, converged=converged)
    simple.SaveScreenshot(path.replace(".npz", ".png"), view)


def run(threads):
    path = output_file(f"deterministic-{threads}.npz")
    command = [os.environ["INR_PVPYTHON"], __file__, str(threads), path]
    check(subprocess.run(command, check=False).returncode == 0, "a run has failed", command)
    return np.load(path)


if len(sys.argv) > 1:
    fly(int(sys.argv[1]), sys.argv[2])
    sys.stdout.flush()
    os._exit(0)  # leaving in the ordinary way may crash ParaView 5.11 once it has a window

one, two = run(1), run(2)
check(not one["converged"].all(), "nothing is unfinished")
check(one["pictures"].std() > 5, "nothing is shown")
distinct = {picture.tobytes() for picture in one["pictures"]}
print(len(distinct), "pictures,", int((one["converged"] == 0).sum()), "unfinished")
check(len(distinct) > 16, "only", len(distinct), "pictures differ")
for k, (a, b) in enumerate(zip(one["pictures"], two["pictures"])):
    check(np.array_equal(a, b), "picture", k, "differs in", np.count_nonzero(a != b), "numbers")
check(np.array_equal(one["converged"], two["converged"]), "what is finished differs")
