# SPDX-License-Identifier: BSD-3-Clause
"""Frame times at 512x512: the uncached INR beside ParaView's own volume rendering of its voxels.

    PYTHONPATH=build/lib/python Testing/with-display.sh pvpython Testing/Benchmarks/frames.py \\
        PLUGIN MODEL.inr

Both pictures come from one run, with the same camera, transfer functions and unit distance; the
results go to frames.json. ParaView's side is its "Smart" volume mapper, which on a machine without
a GPU is a software OpenGL's.
"""
import os
import statistics
import sys
import time

from paraview.simple import *

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import results_file  # noqa: E402

FRAMES = 7
# Opacity over the range's fractions: thin shells, or something almost everywhere.
OPACITIES = {"sparse": [(0, 0), (0.55, 0), (0.65, 0.3), (0.75, 0), (1, 0)],
             "dense": [(0, 0.02), (0.5, 0.1), (1, 0.3)]}


def frame_times(view, representation):
    """Seconds of each of FRAMES pictures, the camera turning by a little."""
    times = []
    for _ in range(FRAMES + 1):
        view.GetActiveCamera().Azimuth(0.5)
        start = time.perf_counter()
        Render(view)
        times.append(time.perf_counter() - start)
        if representation is not None:
            representation.UpdatePropertyInformation()
    return times[1:]


def measure(source, representation_type, opacity):
    view = CreateRenderView()
    view.ViewSize = [512, 512]
    shown = Show(source, view)
    shown.SetRepresentationType(representation_type)
    array = source.PointData[0].Name
    ColorBy(shown, ("POINTS", array))
    low, high = source.PointData[0].GetRange()
    points = [value for x, a in OPACITIES[opacity]
              for value in (low + x * (high - low), a, 0.5, 0.0)]
    GetOpacityTransferFunction(array).Points = points
    shown.ScalarOpacityUnitDistance = 2.0
    view.ResetCamera()
    view.GetActiveCamera().Azimuth(30)
    view.GetActiveCamera().Elevation(20)
    seconds = statistics.median(frame_times(view, None))
    Delete(view)
    return seconds


def main():
    plugin, file = sys.argv[1:3]
    LoadPlugin(os.path.abspath(plugin), remote=False, ns=globals())
    model = OpenDataFile(os.path.abspath(file))
    model.UpdatePipeline()
    voxels = INRDecode(Input=model)
    voxels.UpdatePipeline()
    results = []
    for opacity in OPACITIES:
        inr = measure(model, "INR Volume", opacity)
        stock = measure(voxels, "Volume", opacity)
        note = "512x512, median of 7 frames, sample distance 1 voxel"
        results.append(results_file.result(f"uncached frame {opacity}", round(1000 * inr, 1), "ms",
                                           "lower", note))
        results.append(results_file.result(f"ParaView volume frame {opacity}", round(1000 * stock, 1),
                                           "ms", "lower", note))
        results.append(results_file.result(f"uncached vs ParaView {opacity}", round(inr / stock, 2),
                                           "", "lower", note,
                                           baseline=f"ParaView volume frame {opacity}"))
        print(f"{opacity}: INR {1000 * inr:.0f} ms, ParaView {1000 * stock:.0f} ms", flush=True)
    results_file.write("frames", results)


main()
