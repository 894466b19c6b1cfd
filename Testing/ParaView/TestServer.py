# SPDX-License-Identifier: BSD-3-Clause
"""Connected to a server, the panel shows what the server's mapper says, for it is the one that draws.
The argument is the server's port."""
import os
import shutil
import sys

from inrvolume import vtkINRContour, vtkINRReader
from paraview import simple
from pvtest import ARRAY, MODEL, Messages, check, connect, look_at, output_file, picture, show_model

connect(sys.argv[1])
view, display = show_model()


def value(name):
    display.UpdatePropertyInformation()
    return display.GetPropertyValue(name)


check(value("Converged") == 0, "converged before the first picture")
check(picture(view, "server").std() > 0.05, "nothing is shown")
check(value("Converged") == 1, "a still picture is not converged")
check(value("CacheHitRate") == 1, "a still picture has misses:", value("CacheHitRate"))
check(value("CacheUsed") > 0, "no cache in use")
check(value("FrameTime") > 0, "no time taken")
check(value("BackendInUse").startswith("CPU "), "drawn by", value("BackendInUse"))

# Cells have the same numbers in all pieces: each is selected in its own process alone.
simple.SetActiveSource(display.Input)
simple.SelectSurfaceCells(Rectangle=[110, 80, 170, 130], View=view)
selection = display.Input.GetSelectionInput(0)
chosen = simple.ExtractSelection(Input=display.Input, Selection=selection)
chosen.UpdatePipeline()
selected, extracted = len(selection.Input[0].IDs) // 2, chosen.GetDataInformation().GetNumberOfCells()
check(selected == extracted > 300, selected, "cells are selected, but", extracted, "extracted")
simple.Delete(chosen)
simple.ClearSelection(display.Input)

# Away and back: where several processes have pieces, some volume has to say where these are.
before = picture(view, "server")
simple.ColorBy(display, None)  # which no volume can be drawn in
simple.Render(view)
check(value("Converged") == 0, "what is not drawn has converged")
simple.ColorBy(display, ("POINTS", ARRAY))
display.SetScalarBarVisibility(view, False)
check(abs(picture(view, "server-again") - before).max() < 2.5 / 255, "another picture than before")

# An array with another name, and a file that comes later, whoever draws.
for threshold in (0, 1e6):
    late = output_file("late.inr")
    if os.path.exists(late):
        os.remove(late)
    other, shown = show_model()
    other.RemoteRenderThreshold = threshold
    expected = picture(other, f"server-named-{threshold}")
    shown.Input.ArrayName = "renamed"
    again = picture(other, f"server-renamed-{threshold}")
    check(shown.ColorArrayName[1] == "renamed", "coloured by", shown.ColorArrayName[1])
    check(abs(again - expected).max() < 2.5 / 255, "an array's other name shows", abs(again - expected).max())
    shown.Visibility = 0
    reader = simple.INRReader(FileName=[late])
    coming = simple.Show(reader, other)
    coming.SetRepresentationType("INR Volume")
    with Messages():
        simple.Render(other)  # of nothing, and that is said
    shutil.copy(MODEL, late)
    simple.ReloadFiles(reader)
    simple.Render(other)
    coming.SetScalarBarVisibility(other, False)
    look_at(other)
    again = picture(other, f"server-late-{threshold}")
    check(abs(again - expected).max() < 2.5 / 255, "a file that comes late shows", abs(again - expected).max())

# What is no INR is refused in the same words, whoever draws, and so is a group.
for threshold in (0, 1e6):
    other = simple.CreateRenderView(ViewSize=[64, 64], RemoteRenderThreshold=threshold)
    for source, words in ((simple.Wavelet(), "'RTData' is not an INR"),
                          (simple.GroupDatasets(Input=[simple.Wavelet(), simple.Wavelet()]),
                           "A group of data sets cannot be drawn")):
        plain = simple.Show(source, other)
        with Messages() as messages:
            plain.SetRepresentationType("INR Volume")
            simple.Render(other)
            simple.Render(other)
        check(messages.text.count(words) == 1, "of what cannot be drawn", threshold, messages.text)
        simple.Delete(source)
    simple.Delete(other)
simple.SetActiveView(view)

# A new cache, and a picture in a limited time: so many bricks, however fast they come.
display.BrickSize = 12
display.LevelOfDetailScale = 0
display.Deterministic = 1
view.SMProxy.InteractiveRender()
check(value("Converged") == 0, "all bricks came in one interactive picture")
check(value("CacheHitRate") < 1, "nothing is missing in an interactive picture")

# A view's first picture comes in its time, too.
view, display = show_model()
display.RenderMode = "Path Tracing"
display.SamplesPerPixel = 100
display.StillTimeLimit = 0.05
simple.Render(view)
check(value("Converged") == 0, "a view's first picture took all the time that it wanted")

# Processes share an isosurface and a slice out among them: together all is there, once.
alone = vtkINRReader()
alone.SetFileName(MODEL)
whole = vtkINRContour()
whole.SetInputConnection(alone.GetOutputPort())
whole.SetValue(0, 80)
whole.Update()
reader = simple.OpenDataFile(MODEL)
shared = simple.INRContour(Input=reader, Isosurfaces=[80])
cut = simple.INRSlice(Input=reader)
for filter in (shared, cut):
    filter.UpdatePipeline()
triangles = shared.GetDataInformation().GetNumberOfCells()
check(triangles == whole.GetOutput().GetNumberOfCells() > 10000, triangles, "triangles")
check(cut.GetDataInformation().GetNumberOfCells() == 90 * 90, "cells of the slice are missing")
simple.Disconnect()
os._exit(0)
