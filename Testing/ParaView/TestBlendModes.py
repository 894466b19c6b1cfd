# SPDX-License-Identifier: BSD-3-Clause
"""Blend modes by the panel's properties and by the stock ones, through the cache and by the network
alone, and in a state file."""
import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, check_baseline, load_plugin, look_at, picture
from pvtest import psnr, save_and_load, show_view

load_plugin()
view = show_view((200, 200))
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)
low, high = reader.PointData[0].GetRange()
SURFACES = [low + 0.2 * (high - low), low + 0.45 * (high - low)]
MODES = ["Composite", "Maximum Intensity", "Minimum Intensity", "Average Intensity", "Additive"]
MODES.append("Isosurface")

pictures = {}
with Messages() as messages:
    for number, mode in enumerate(MODES):
        display.INRBlendMode = mode
        display.INRIsosurfaceValues = SURFACES
        display.Shade = int(mode == "Isosurface")
        check(display.GetProperty("BlendMode").SMProperty.GetElement(0) == number, "not passed on")
        check(list(display.IsosurfaceValues) == SURFACES, "values not passed on")
        display.CacheMode = "Cache and network"
        pictures[mode] = picture(view, f"blend-{number}")
        display.UpdatePropertyInformation()
        check(display.GetPropertyValue("Converged") == 1, mode, "has not converged")
        display.CacheMode = "Network only"
        exact = picture(view, f"blend-{number}-exact")
        noise = psnr(pictures[mode], exact)
        print(f"{mode}: {noise:.1f} dB from the network")
        check(noise > 22, mode, "is not what the network has")
        for other in MODES[:number]:
            apart = np.abs(pictures[mode] - pictures[other]).max()
            check(apart > 0.1, mode, "looks like", other)
check(messages.errors() == 0, "drawing reported", messages.text)
display.CacheMode = "Cache and network"
check_baseline(pictures["Isosurface"], "blend-isosurface")
check_baseline(pictures["Maximum Intensity"], "blend-maximum")

# Projections are grey but for extremes, and opaque only where the volume is.
for mode in "Average Intensity", "Additive":
    seen = pictures[mode][np.any(pictures[mode] < 1, axis=2)]
    check(np.ptp(seen, axis=1).max() < 0.01, mode, "has colours")

# The stock names, as scripts for other volumes have them.
display.BlendMode = "Isosurface"
display.IsosurfaceValues = SURFACES[1:]
check(display.INRBlendMode == "Isosurface", "the mode does not come back")
check(list(display.INRIsosurfaceValues) == SURFACES[1:], "the values do not come back")
fewer = picture(view, "blend-one-surface")
check(np.abs(fewer - pictures["Isosurface"]).max() > 0.1, "a surface is left that was taken away")

# Cropped to a box: what the bounds are scaled and moved to.
def columns(image):
    return np.flatnonzero(np.any(image < 0.98, axis=(0, 2)))


display.INRBlendMode = "Maximum Intensity"
display.INRCroppingScale = [0.5, 1, 1]
display.INRUseCropping = 1
check((display.UseCropping, list(display.CroppingScale)) == (1, [0.5, 1, 1]), "not passed on")
left = picture(view, "blend-cropped")
display.CroppingOrigin = [45, 0, 0]
check(list(display.INRCroppingOrigin) == [45, 0, 0], "the origin does not come back")
right = picture(view, "blend-cropped-other-half")
whole = columns(pictures["Maximum Intensity"])
for half in left, right:
    check(0.4 < len(columns(half)) / len(whole) < 0.95, "is no half", columns(half))
check(np.abs(left - right).max() > 0.1, "both halves are the same")
check_baseline(left, "blend-cropped")
display.UseCropping = 0
check(display.INRUseCropping == 0, "cropping does not come back")
check(np.abs(picture(view, "blend-whole") - pictures["Maximum Intensity"]).max() < 1e-6, "cropped")

# What is not supported says so once.
for refused in (dict(BlendMode="Slice"), dict(RenderMode="Path Tracing")):
    display.RenderMode, display.BlendMode = "Ray Marching", "Isosurface"
    simple.Render(view)
    for name, value in refused.items():
        setattr(display, name, value)
    with Messages() as messages:
        simple.Render(view)
        simple.Render(view)
    check(messages.errors() == 1, refused, "reported", messages.text)
display.RenderMode = "Ray Marching"

view, reader, display = save_and_load("blend.pvsm")
check((display.BlendMode, display.INRBlendMode) == ("Isosurface",) * 2, "the mode is lost")
again = picture(view, "blend-state")
check(np.abs(again - fewer).max() < 1e-6, "the state shows something else")
