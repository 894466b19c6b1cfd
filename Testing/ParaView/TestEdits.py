# SPDX-License-Identifier: BSD-3-Clause
"""Random edits while bricks load: nothing is reported, nothing is lost, and what is shown depends on
the last settings only, to the last bit. INR_EDITS is how many (150; thousands when run by hand)."""
import os
import random

import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, output_file, picture, psnr
from pvtest import show_view

load_plugin()
import inrvolume  # noqa: E402  ParaView's Python then knows the mapper

EDITS = int(os.environ.get("INR_EDITS", "150"))
EVERY = max(10, EDITS // 150)  # edits between comparisons: some 250 views are all that an X server can show
dice = random.Random(7)

# What is drawn and how, and what only decides when and where it is computed.
SETTINGS = {
    "RenderMode": ["Ray Marching"] * 4 + ["Path Tracing"],
    "INRBlendMode": ["Composite"] * 6
    + ["Maximum Intensity", "Minimum Intensity", "Average Intensity", "Additive", "Isosurface"],
    "IsosurfaceValues": [[], [60], [40, 120, 120.5]],
    "Shade": [0, 0, 1],
    "Ambient": [0, 0.2],
    "Specular": [0, 0.5],
    "SpecularPower": [1, 30],
    "ScalarOpacityUnitDistance": [0.3, 1, 20],
    "UseCropping": [0, 0, 1],
    "CroppingOrigin": [[0, 0, 0], [10, 5, 20]],
    "CroppingScale": [[1, 1, 1], [0.5, 0.7, 0.1]],
    "ScatteringAlbedo": [0, 0.9],
    "ScatteringAnisotropy": [-0.5, 0, 0.8],
    "MaximumBounces": [0, 1, 40],
    "AmbientLight": [[0, 0, 0], [1, 0.5, 0.2]],
    "SamplesPerPixel": [1, 2, 5],
    "LevelOfDetailScale": [0, 0.5, 1, 2, 4],
    "ErrorTolerance": [-1, -1, 0, 2, 20],
    "SampleDistance": [0.5, 1, 2],
    "AdaptiveSampling": [0, 1],
    "PreIntegration": [0, 1],
    "Seed": [0, 5],
    "InferencePrecision": ["Automatic", "Float", "bfloat16"],
    "CachePrecision": ["Float", "16 bit", "8 bit"],
    "BrickSize": [12, 24, 40],
    "CacheMode": ["Cache and network"] * 4 + ["Cache only", "Network only"],
    "Backend": ["Auto", "CPU"],
    "CacheSize": [4, 8, 64],
    "MaximumRequests": [1, 40],
    "PriorityRanking": [0, 1],
    "Preloading": [0, 1],
    "StillTimeLimit": [0, 0.05],
    "NumberOfThreads": [0, 1, 3],
    "Deterministic": [0, 0, 1],
    "ShowStatus": [0, 0, 1],
}


def new_scene():
    view = show_view((120, 90))
    reader = simple.OpenDataFile(MODEL)
    display = simple.Show(reader, view)
    display.SamplesPerPixel = 2
    look_at(view)
    return view, reader, display


def set_one(display):
    name = dice.choice(sorted(SETTINGS))
    setattr(display, name, dice.choice(SETTINGS[name]))
    if display.RenderMode == "Path Tracing" and display.INRBlendMode != "Composite":  # refused
        other = "RenderMode" if name == "INRBlendMode" else "INRBlendMode"
        setattr(display, other, "Ray Marching" if other == "RenderMode" else "Composite")


def turn(view):
    camera = view.GetActiveCamera()
    camera.Azimuth(dice.uniform(-90, 90))
    camera.Dolly(dice.uniform(0.7, 1.4))
    view.GetRenderer().ResetCameraClippingRange()


def recolour(display):
    opacity = display.ScalarOpacityFunction
    low, high = opacity.Points[0], opacity.Points[-4]
    middle = dice.uniform(low, high)
    opacity.Points = [low, 0, 0.5, 0, middle, dice.random(), 0.5, 0, high, dice.random(), 0.5, 0]


def edit(view, reader, display):
    kind = dice.randrange(10)
    if kind < 5:
        set_one(display)
    elif kind < 7:
        turn(view)
    elif kind < 9:
        recolour(display)
    else:
        view.ViewSize = [dice.randrange(20, 160), dice.randrange(20, 120)]
    # As while the mouse moves: a frame in a limited time, more bricks to come.
    view.SMProxy.InteractiveRender()
    if kind == 9:
        simple.Hide(reader, view) if dice.random() < 0.3 else simple.Show(reader, view)


def exact(view):
    """The file that the view's mapper writes of its latest picture: floats, not rounded."""
    path = output_file("edits.exr")
    volumes = view.GetRenderer().GetVolumes()
    mappers = [volumes.GetItemAsObject(k).GetMapper() for k in range(volumes.GetNumberOfItems())]
    writers = [mapper for mapper in mappers if isinstance(mapper, inrvolume.vtkINRVolumeMapper)]
    check(len(writers) == 1 and writers[0].WriteEXR(path), "cannot write the exact picture")
    with open(path, "rb") as file:
        return file.read()


def compare(view, reader, display):
    """What is shown is what a new scene shows with the same settings; returns that."""
    simple.Show(reader, view)
    view.ViewSize = [120, 90]
    display.ShowStatus = 0  # tells of times
    if display.CacheMode == "Cache only":  # what a small cache then has depends on what it had
        display.CacheMode = "Cache and network"
    edited = picture(view, "edits-last")
    edited_exactly = exact(view)
    settings = {name: getattr(display, name) for name in SETTINGS}
    points = list(display.ScalarOpacityFunction.Points)
    place = [list(view.CameraPosition), list(view.CameraFocalPoint), list(view.CameraViewUp)]
    simple.Delete(reader)
    simple.Delete(view)
    view, reader, display = new_scene()
    for name, value in settings.items():
        setattr(display, name, value)
    display.ScalarOpacityFunction.Points = points
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = place
    simple.Render(view)
    anew = picture(view, "edits-anew")
    check(np.isfinite(edited).all(), "not a picture")
    same = np.array_equal(edited, anew)  # also where both show nothing
    check(same or psnr(edited, anew) > 50, "the way to a picture shows in it:", psnr(edited, anew), "dB")
    check(edited_exactly == exact(view), "the way to a picture shows in its floats", settings)
    return view, reader, display, anew.std()


contrasts = []
with Messages() as messages:
    view, reader, display = new_scene()
    for k in range(EDITS):
        edit(view, reader, display)
        if k % (5 * EVERY) == 24:  # while bricks load
            # So that it can be told where a long run ended; prints are held back until then.
            os.write(1, f"{k} edits\n".encode())
            simple.Delete(reader)
            simple.Delete(view)
            view, reader, display = new_scene()
        elif k % EVERY == EVERY - 1:
            view, reader, display, contrast = compare(view, reader, display)
            contrasts.append(contrast)
check(messages.errors() == 0, "reported:", messages.text)
check(contrasts, "nothing was compared")
print(len(contrasts), "pictures compared, of contrast", min(contrasts), "to", max(contrasts))
check(np.mean(np.array(contrasts) > 0.01) > 0.5, "nothing is shown")
