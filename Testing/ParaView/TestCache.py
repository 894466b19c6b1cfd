# SPDX-License-Identifier: BSD-3-Clause
"""The cache's properties in ParaView: what they may and what they must not change in a picture."""
import pathlib

import numpy as np
from paraview import simple
from pvtest import MODEL, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()
view = show_view()
display = simple.Show(simple.OpenDataFile(MODEL), view)
look_at(view)


def value(name):
    return display.GetPropertyValue(name)


def shown(name, **properties):
    """The picture with some properties set and what the mapper says about it."""
    for key, value in properties.items():
        setattr(display, key, value)
    pixels = picture(view, "cache-" + name)
    display.UpdatePropertyInformation()
    return pixels


cached = shown("default")
check(value("Converged") == 1, "a still picture is not converged")
check(value("CacheHitRate") == 1, "a still picture has misses", value("CacheHitRate"))
check(value("CacheUsed") > 0, "no cache in use")

# Memory is a promise, and no part of the picture.
small = shown("small", CacheSize=1, BrickSize=12)
check(value("CacheUsed") <= 1, "the cache takes more than it may:", value("CacheUsed"))
check(value("Converged") == 1, "a small cache does not converge")
large = shown("large", CacheSize=256, BrickSize=12)
check(np.array_equal(small, large), "the size of the cache shows in the picture")

# From the cache only, too little of it makes a coarser picture, and enough the same.
fitting = shown("only-small", CacheMode="Cache only", CacheSize=1, LevelOfDetailScale=0)
check(value("Converged") == 1, "the cache only does not converge")
check(0 < value("CacheHitRate") < 1, "all in a cache that is too small:", value("CacheHitRate"))
check(value("CacheUsed") <= 1, "the cache takes more than it may:", value("CacheUsed"))
traced = shown("only-traced", RenderMode="Path Tracing", SamplesPerPixel=2)
check(value("Converged") == 1 and value("CacheHitRate") < 1, "paths:", value("CacheHitRate"))
display.RenderMode = "Ray Marching"
whole = shown("only-large", CacheSize=256)
check(value("CacheHitRate") == 1, "misses where all fits:", value("CacheHitRate"))
check(np.array_equal(whole, shown("both", CacheMode="Cache and network")), "the mode shows")
print(f"a cache that is too small: {psnr(fitting, whole):.1f} dB")
check(20 < psnr(fitting, whole) < 60, "coarser places cost", psnr(fitting, whole), "dB")
check(traced.std() > 0.05, "no paths are shown")
display.LevelOfDetailScale = 1

# Storage and interpolation cost little, levels of detail a little more.
exact = shown("float", CachePrecision="Float", BrickSize=40, LevelOfDetailScale=0)
check(psnr(shown("bits16", CachePrecision="16 bit"), exact) > 50, "16 bit")
check(psnr(shown("bits8", CachePrecision="8 bit"), exact) > 40, "8 bit")

# Rounded numbers in the network show where the processor has them, and no tolerance allows them.
can_round = "avx512_bf16" in pathlib.Path("/proc/cpuinfo").read_text()
rounded = shown("rounded", CachePrecision="Float", InferencePrecision="bfloat16")
check(("bfloat16" in value("BackendInUse")) == can_round, "drawn by", value("BackendInUse"))
check(np.array_equal(rounded, exact) != can_round, "bfloat16 shows, or not")
check(psnr(rounded, exact) > 40, "bfloat16 costs", psnr(rounded, exact))
strict = shown("strict", ErrorTolerance=0)
check("bfloat16" not in value("BackendInUse"), "rounds within a tolerance")
check(np.array_equal(strict, shown("float again", InferencePrecision="Float")), "no tolerance")
display.ErrorTolerance = -1

network = shown("network", CacheMode="Network only")
check(value("CacheUsed") == 0, "a cache without use:", value("CacheUsed"))
error = psnr(exact, network)
print(f"cache against network: {error:.1f} dB")
check(error > 38, "interpolation costs", error, "dB")
coarse = shown("coarse", CacheMode="Cache and network", LevelOfDetailScale=8)
check(25 < psnr(coarse, exact) < error + 20, "coarse levels", psnr(coarse, exact))

# Interactive pictures come at once and lead to the still one.
display.LevelOfDetailScale = 1
display.CacheSize = 64
proxy = view.SMProxy
proxy.InteractiveRender()
for _ in range(50):
    proxy.InteractiveRender()
    display.UpdatePropertyInformation()
    if value("Converged") == 1:
        break
check(value("Converged") == 1, "interactive pictures do not converge:", value("CacheHitRate"))

# Another view of the volume takes no more memory; another volume and its own take what there is.
display.BrickSize = 12
display.CacheSize = 16
simple.SetActiveView(view)
first = shown("first")
used = value("CacheUsed")
check(0 < used <= 16, "one view takes", used)
views = [view]
displays = [display]


def add(source, name):
    """Shows `source` in a view of its own with the same settings and camera."""
    views.append(show_view())
    displays.append(simple.Show(source, views[-1]))
    for key in ("BrickSize", "CacheSize", "CachePrecision", "LevelOfDetailScale"):
        setattr(displays[-1], key, getattr(display, key))
    look_at(views[-1])
    pixels = picture(views[-1], "cache-" + name)
    for each in displays:
        each.UpdatePropertyInformation()
    check(displays[-1].GetPropertyValue("Converged") == 1, name, "does not converge")
    totals = [each.GetPropertyValue("CacheUsed") for each in displays]
    check(len(set(totals)) == 1, "the views do not agree in what is in use:", totals)
    return pixels


second = add(simple.GetActiveSource(), "second")
check(np.array_equal(first, second), "two views of a volume differ")
check(value("CacheUsed") == used, "a second view of a volume takes more:", value("CacheUsed"))
third = add(simple.OpenDataFile(MODEL), "third")
check(np.array_equal(first, third), "two volumes of a file differ")
check(used < value("CacheUsed") <= 16, "a second volume:", value("CacheUsed"), "after", used)

# All in a budget that is too small for one, in turns.
for each in displays:
    each.CacheSize = 1
for k in range(2):
    for each, name in zip(views, ("first", "second", "third")):
        check(np.array_equal(picture(each, "cache-" + name + "-small"), first), "small", name, k)
        display.UpdatePropertyInformation()
        # The first round still has views that may take 16 MiB.
        check(value("CacheUsed") <= (1 if k else 16), "in turns:", value("CacheUsed"))
simple.Delete(displays.pop())
simple.Delete(views.pop())
check(np.array_equal(picture(view, "cache-last"), first), "a view changes when another is deleted")
