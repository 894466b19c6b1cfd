# SPDX-License-Identifier: BSD-3-Clause
"""Makes the README's pictures from the two volumes of Testing/Data.

    pvpython Examples/gallery/make_gallery.py MODELS PICTURES

Models that are not in the folder MODELS are trained first (4,000 steps each, about a minute).
The plugin is looked for in build/; the environment variable INR_PLUGIN names another one.
"""
import os
import sys

from paraview import simple

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PLUGIN = os.environ.get("INR_PLUGIN") or os.path.join(
    ROOT, "build/lib/paraview-5.11/plugins/INRVolume/INRVolume.so"
)
SIZE = 400
models, pictures = sys.argv[1:]
simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))


def open_model(name):
    path = os.path.join(models, name + ".inr")
    if not os.path.exists(path):
        volume = simple.OpenDataFile(os.path.join(ROOT, "Testing", "Data", name + ".vti"))
        simple.SaveData(path, proxy=volume, MaximumSteps=4000, TimeLimit=0)
    return simple.OpenDataFile(path)


def make_view(azimuth, elevation):
    view = simple.CreateView("RenderView")
    view.ViewSize = [SIZE, SIZE]
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
    """`colours` and `opacities`: (part of the value range, ...) each."""
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


def save(view, name):
    path = os.path.join(pictures, name + ".png")
    simple.SaveScreenshot(path, view, ImageResolution=[SIZE, SIZE])


FLAME = [(0, 0.1, 0.15, 0.4), (0.35, 0.2, 0.5, 0.8), (0.6, 0.95, 0.75, 0.4), (1, 1, 0.95, 0.85)]
MIXING = [(0, 0), (0.2, 0), (0.4, 0.5), (0.55, 0.05), (0.7, 0.8), (0.8, 0), (1, 0)]
WIND = [(0, 0), (0.1, 0), (0.3, 0.3), (0.6, 0.9), (1, 1)]


def lit_and_traced():
    model = open_model("rm_mixing")
    view = make_view(35, 25)
    display = show(model, view, FLAME, MIXING)
    display.Shade = 1
    save(view, "lit")
    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 128
    display.AmbientLight = [0.9, 0.95, 1.0]
    save(view, "traced")


def among_surfaces():
    model = open_model("les_wmag91")
    view = make_view(35, 25)
    show(model, view, FLAME, WIND)
    cut = simple.INRSlice(Input=model)
    plane = simple.Show(cut, view)
    plane.Opacity = 0.5
    save(view, "slice")
    simple.Delete(cut)


def surfaces():
    model = open_model("les_wmag91")
    view = make_view(35, 25)
    display = show(model, view, FLAME, [(0, 0.6), (1, 1)])
    display.BlendMode = "Isosurface"
    display.IsosurfaceValues = [80.0, 150.0]
    display.Shade = 1
    save(view, "isosurfaces")


lit_and_traced()
among_surfaces()
surfaces()
os._exit(0)
