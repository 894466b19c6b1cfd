# SPDX-License-Identifier: BSD-3-Clause
"""What the gallery's scripts share: the models of Testing/Data's volumes, colours and views.

Models that are not in the folder given are trained first (4,000 steps each, about a minute).
The plugin is looked for in build/; the environment variable INR_PLUGIN names another one.
"""
import os

from paraview import simple

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PLUGIN = os.environ.get("INR_PLUGIN") or os.path.join(
    ROOT, "build/lib/paraview-5.11/plugins/INRVolume/INRVolume.so"
)
simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))

# Colours and opacities: (part of the value range, ...) each.
FLAME = [(0, 0.1, 0.15, 0.4), (0.35, 0.2, 0.5, 0.8), (0.6, 0.95, 0.75, 0.4), (1, 1, 0.95, 0.85)]
MIXING = [(0, 0), (0.2, 0), (0.4, 0.5), (0.55, 0.05), (0.7, 0.8), (0.8, 0), (1, 0)]
WIND = [(0, 0), (0.1, 0), (0.3, 0.3), (0.6, 0.9), (1, 1)]


def model_file(models, name):
    path = os.path.join(models, name + ".inr")
    if not os.path.exists(path):
        os.makedirs(models, exist_ok=True)
        volume = simple.OpenDataFile(os.path.join(ROOT, "Testing", "Data", name + ".vti"))
        simple.SaveData(path, proxy=volume, MaximumSteps=4000, TimeLimit=0)
    return path


def open_model(models, name):
    return simple.OpenDataFile(model_file(models, name))


def make_view(azimuth, elevation, size):
    view = simple.CreateView("RenderView")
    view.ViewSize = [size, size]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.06, 0.07, 0.1]
    view.ResetActiveCameraToPositiveX()
    camera = view.GetActiveCamera()
    camera.Azimuth(azimuth)
    camera.Elevation(elevation)
    camera.OrthogonalizeViewUp()
    return view


def show(model, view, colours, opacities):
    display = simple.Show(model, view)
    name = display.ColorArrayName[1]
    low, high = model.PointData[name].GetRange()
    at = lambda part: low + part * (high - low)
    table = simple.GetColorTransferFunction(name)
    table.ColorSpace = "Lab"
    table.RGBPoints = [value for part, *rgb in colours for value in (at(part), *rgb)]
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = [value for part, alpha in opacities for value in (at(part), alpha, 0.5, 0)]
    display.SetScalarBarVisibility(view, False)
    view.ResetCamera()
    view.GetActiveCamera().Zoom(1.15)
    return display
