# SPDX-License-Identifier: BSD-3-Clause
"""Renders a model file in ParaView without a window.

    pvpython Examples/pvpython/view.py MODEL.inr PICTURE.png

The plugin is looked for in build/; the environment variable INR_PLUGIN names another one.
Without a display put Testing/with-display.sh in front of it.
"""
import glob
import math
import os
import sys

from paraview.simple import *  # ParaView's own idiom

if len(sys.argv) != 3:
    sys.exit(f"usage: pvpython {sys.argv[0]} MODEL.inr PICTURE.png")
model_file, picture_file = sys.argv[1:]

found = glob.glob("build/lib/paraview-*/plugins/INRVolume/INRVolume.so")
plugin = os.environ.get("INR_PLUGIN") or (found and os.path.abspath(found[0]))
if not plugin:
    sys.exit("There is no plugin in build/; build it, or set INR_PLUGIN.")
LoadPlugin(plugin, remote=False, ns=globals())

model = INRReader(FileName=model_file)
model.UpdatePipeline()
if model.GetDataInformation().GetNumberOfPoints() == 0:
    sys.exit(f"{model_file} cannot be shown; the message above says why.")

view = CreateView("RenderView")
view.ViewSize = [600, 600]
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0, 0, 0]
shown = Show(model, view)  # as "INR Volume", coloured by its array
name = shown.ColorArrayName[1]
low, high = model.PointData[name].GetRange()
colours = GetColorTransferFunction(name)
colours.ColorSpace = "RGB"
colours.RGBPoints = [low, 0.1, 0.2, 0.6, high, 1.0, 0.7, 0.3]
GetOpacityTransferFunction(name).Points = [low, 0.0, 0.5, 0.0, high, 0.5, 0.5, 0.0]
bounds = model.GetDataInformation().GetBounds()
shown.ScalarOpacityUnitDistance = math.dist(bounds[0::2], bounds[1::2]) / 100
shown.SetScalarBarVisibility(view, False)

ResetCamera(view)
view.GetActiveCamera().Azimuth(30)
if not SaveScreenshot(picture_file, view) or not os.path.isfile(picture_file):
    sys.exit(f"{picture_file} was not written: is there such a folder, and a format of that name?")
shown.UpdatePropertyInformation()  # else it tells what was before
backend = shown.GetPropertyValue("BackendInUse")
if not backend:
    sys.exit(f"{picture_file} shows nothing of the model; what is above says why")
print(f"{picture_file}: drawn on {backend}")
