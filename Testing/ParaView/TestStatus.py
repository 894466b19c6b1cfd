# SPDX-License-Identifier: BSD-3-Clause
"""The text in the view's corner: off by default, about the picture it stands in, and several volumes'
texts below each other."""
import re
import struct

import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, check, data_file, load_plugin, look_at, output_file, picture, show_view

load_plugin()
view = show_view((400, 300))
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)
LINES = re.compile(
    r"(\w+): levels? (\d+)(?: to (\d+))?, (\d+) % there(?:, (\d+) of (\d+) paths)?"
    r"(?:, 1 of (?:4|16|64|256|1024|4096) pixels)?( \.\.\.)?\n"
    r"(?:(\d+\.\d\d) % moved into range, )?cache (\d+) MiB, CPU [\w ]+, \d+ threads?, \d+ ms$"
)


def actors():
    props = view.GetRenderer().GetViewProps()
    found = [props.GetItemAsObject(k) for k in range(props.GetNumberOfItems())]
    return [prop for prop in found if prop.IsA("vtkINRStatusActor") and prop.GetVisibility()]


def status():
    """The parts of the only text shown: array, finest and coarsest level, percent, paths, of how
    many, whether there is more to come, MiB."""
    (actor,) = actors()
    parts = LINES.match(actor.GetInput())
    check(parts, "not a status:", actor.GetInput())
    print(actor.GetInput().replace("\n", "; "))
    return parts.groups()


def file_with_false_ranges(path):
    """As instantvnr would write it, with macro-cells that claim to hold one value only."""
    volume = simple.XMLImageDataReader(FileName=data_file("les_wmag91.vti"))
    simple.SaveData(path, volume, Scalars=["POINTS", ARRAY], ReadableByInstantVNR=1, MaximumSteps=50)
    with open(path, "rb") as file:
        data = file.read()
    at = data.index(b"data\0", data.index(b"macrocell\0")) + 5
    (size,) = struct.unpack_from("<i", data, at)
    ranges = np.frombuffer(data, "<f4", size // 4, at + 5).reshape(-1, 2).copy()
    ranges[:] = 0.5
    data = data[:at + 5] + ranges.tobytes() + data[at + 5 + size:]
    with open(path, "wb") as file:
        file.write(data.replace(b"\x03inr\0", b"\x03was\0", 1))  # nor what only ours say
    return path


def rows_of_text(with_text, without):
    """Blocks of rows, counted from the top, that differ in the left half of the picture."""
    differs = np.any(with_text[::-1, :200] != without[::-1, :200], axis=(1, 2))
    edges = np.flatnonzero(np.diff(np.concatenate(([0], differs.astype(int), [0]))))
    return edges.reshape(-1, 2)


def ends_in(with_text, without):
    """The last column of the text; it is not cut off."""
    last = np.flatnonzero(np.any(with_text[-60:] != without[-60:], axis=(0, 2)))[-1]
    width = with_text.shape[1]
    check(last < width - 4, "the text leaves a view of", width, "pixels at", last)
    return last


bare = picture(view, "status-off")
check(not actors(), "there is a status that nobody asked for")
display.ShowStatus = 1
shown = picture(view, "status-on")
array, finest, coarsest, percent, paths, _, more, moved, used = status()
check((array, percent, paths, more, moved) == (ARRAY, "100", None, None, None), "a complete picture's")
check(0 < int(used) < 1000, "cache of", used)
(block,) = rows_of_text(shown, bare)
check(block[0] < 10 and 20 < block[1] - block[0] < 60, "the text is in rows", block)

# Of a larger screenshot each part would have a status of its own.
large = picture(view, "status-in-parts", (800, 600))
display.ShowStatus = 0
check((large == picture(view, "status-in-parts-off", (800, 600))).all(), "parts have a status each")
display.ShowStatus = 1
check((picture(view, "status-on-again") != bare).any(), "no status after a larger screenshot")

# What an interactive picture lacks; coarser levels from further away.
display.BrickSize = 10
display.LevelOfDetailScale = 0
display.MaximumRequests = 1
display.Deterministic = 1
view.SMProxy.InteractiveRender()
_, finest, coarsest, percent, _, _, more, _, _ = status()
check(int(percent) < 100 and more, "an unfinished picture's")
(actor,) = actors()
check(", 1 of 16 pixels ..." in actor.GetInput(), "it has a sixteenth of the pixels:", actor.GetInput())
check(int(finest) > 0, "level 0 was never loaded")
picture(view, "status-still")
_, finest, coarsest, percent, _, _, more, _, _ = status()
check((finest, coarsest, percent, more) == ("0", None, "100", None), "all of level 0")
check("pixels" not in actor.GetInput(), "it has all pixels:", actor.GetInput())
display.LevelOfDetailScale = 8
picture(view, "status-still")
check(int(status()[1]) > 0, "level 0 where coarser ones do")

# Paths; and what no cache has a part in.
display.RenderMode = "Path Tracing"
display.SamplesPerPixel = 2
picture(view, "status-still")
check(status()[4:6] == ("2", "2"), "paths")
display.RenderMode = "Ray Marching"
display.CacheMode = "Network only"
display.SampleDistance = 4
picture(view, "status-still")
(actor,) = actors()
check("straight from the network" in actor.GetInput(), "without a cache:", actor.GetInput())
check("moved" not in actor.GetInput(), "values between voxels are said to be moved:", actor.GetInput())

opacities = simple.GetOpacityTransferFunction(ARRAY)
before = list(opacities.Points)
opacities.Points = [0, 0, 0.5, 0, 300, 0, 0.5, 0]
picture(view, "status-still")
check("nothing visible" in actor.GetInput(), "of nothing:", actor.GetInput())
opacities.Points = before

# Two volumes, three texts high when one more comes, and none for a hidden one.
display.CacheMode = "Cache and network"
second = simple.INRReader(FileName=MODEL)
other = simple.Show(second, view)
other.Position = [100, 0, 0]
display.ShowStatus = 0
alone = picture(view, "status-two-off")
display.ShowStatus = other.ShowStatus = 1
first, last = rows_of_text(picture(view, "status-two-on"), alone)
check(first[1] < last[0], "the texts overlap in rows", first, last)
check(first[1] - first[0] == last[1] - last[0], "texts of different height", first, last)
simple.Hide(reader, view)
hidden = picture(view, "status-hidden")
(actor,) = actors()
other.ShowStatus = 0
check(len(rows_of_text(hidden, picture(view, "status-none"))) == 1, "a hidden volume's text stays")
check(not actors(), "a text stays")

# Small views have smaller letters, down to those that can just be read.
simple.Show(reader, view)
simple.Hide(second, view)
display.RenderMode = "Path Tracing"
for width in 260, 400:
    view.ViewSize = [width, 300]
    display.ShowStatus = 0
    without = picture(view, f"status-{width}-off")
    display.ShowStatus = 1
    with_text = picture(view, f"status-{width}-on")
    last = ends_in(with_text, without)
    check(last > 0.7 * width, "the text ends at", last, "of", width)


def converged():
    display.UpdatePropertyInformation()
    rate, seconds = display.GetPropertyValue("CacheHitRate"), display.GetPropertyValue("FrameTime")
    check((rate > 0) == (seconds > 0), "a hit rate of", rate, "after", seconds, "s")
    return display.GetPropertyValue("Converged") == 1 and rate == 1


# What is out of sight, the renderer does not draw; there is nothing to wait for.
check(converged(), "a complete picture is not said to be one")
view.GetActiveCamera().Yaw(180)
picture(view, "status-away")
(actor,) = actors()
check(actor.GetInput() == ARRAY + ": out of sight", "out of sight it says", actor.GetInput())
display.UpdatePropertyInformation()
found = [display.GetPropertyValue(name) for name in ("Converged", "CacheHitRate", "FrameTime")]
check(found == [1, 1, 0], "of what is out of sight it is told", found)
view.GetActiveCamera().Yaw(180)
picture(view, "status-back")

# Nothing is said of a picture that is not shown any more.
check(converged() and actors(), "a complete picture is not said to be one")
simple.ColorBy(display, None)  # which no volume can be drawn in
picture(view, "status-solid")
check(not actors() and not converged(), "a volume that is not drawn has converged")
simple.ColorBy(display, ("POINTS", ARRAY))
picture(view, "status-again")
check(converged() and actors(), "a volume that is drawn again has not converged")
simple.Hide(reader, view)
picture(view, "status-gone")
check(not actors() and not converged(), "a volume that is hidden has converged")

# How many samples are not what the model says, because its file's ranges do not hold.
false = simple.OpenDataFile(file_with_false_ranges(output_file("false-ranges.inr")))
other = simple.Show(false, view)
without = picture(view, "status-not-moved")
other.ShowStatus = 1
ends_in(picture(view, "status-moved"), without)
(actor,) = actors()
print(actor.GetInput().replace("\n", "; "))
moved = LINES.match(actor.GetInput()).group(8)
check(moved and 50 < float(moved) <= 100, "samples moved in", actor.GetInput())
