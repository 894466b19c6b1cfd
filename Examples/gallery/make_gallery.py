# SPDX-License-Identifier: BSD-3-Clause
"""Makes the README's pictures from the two volumes of Testing/Data.

    pvpython Examples/gallery/make_gallery.py MODELS PICTURES

scene.py says where models and plugin come from.
"""
import os
import sys

from paraview import simple
from scene import FLAME, MIXING, WIND, make_view, open_model, show

SIZE = 400
models, pictures = sys.argv[1:]
os.makedirs(pictures, exist_ok=True)


def save(view, name):
    path = os.path.join(pictures, name + ".png")
    simple.SaveScreenshot(path, view, ImageResolution=[SIZE, SIZE])


def lit_and_traced():
    model = open_model(models, "rm_mixing")
    view = make_view(35, 25, SIZE)
    display = show(model, view, FLAME, MIXING)
    display.Shade = 1
    save(view, "lit")
    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 128
    display.AmbientLight = [0.9, 0.95, 1.0]
    save(view, "traced")


def among_surfaces():
    model = open_model(models, "les_wmag91")
    view = make_view(35, 25, SIZE)
    show(model, view, FLAME, WIND)
    cut = simple.INRSlice(Input=model)
    plane = simple.Show(cut, view)
    plane.Opacity = 0.5
    save(view, "slice")
    simple.Delete(cut)


def surfaces():
    model = open_model(models, "les_wmag91")
    view = make_view(35, 25, SIZE)
    display = show(model, view, FLAME, [(0, 0.6), (1, 1)])
    display.BlendMode = "Isosurface"
    display.IsosurfaceValues = [80.0, 150.0]
    display.Shade = 1
    save(view, "isosurfaces")


lit_and_traced()
among_surfaces()
surfaces()
os._exit(0)
