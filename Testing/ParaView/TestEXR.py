# SPDX-License-Identifier: BSD-3-Clause
"""Save Screenshot as OpenEXR: the mapper's own floats, which agree with the screenshot in 8 bits; whole
files or none, and a message where there is none."""
import os

import numpy as np
from exrfile import read_exr
from paraview import servermanager, simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, output_file, picture, show_view

load_plugin()
import inrvolume  # noqa: E402  ParaView's Python then knows the mapper


def save(path, shown=None, **options):
    """What is reported while the view, or another one, is saved."""
    with Messages() as messages:
        simple.SaveScreenshot(path, shown or view, **options)
    return messages


view = show_view((160, 120))
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.SetScalarBarVisibility(view, False)
look_at(view)
ball = simple.Show(simple.Sphere(Center=[45, 45, 45], Radius=15), view)
path = output_file("screenshot.exr")
if os.path.exists(path):
    os.remove(path)
check(save(path).errors() == 0, "saving reported something")
exact = read_exr(path)
check(sorted(exact) == ["A", "B", "G", "R", "Z"], "channels", sorted(exact))
check(all(np.isfinite(channel).all() for channel in exact.values()), "not finite")

# Over the view without the volume it is the view with the volume.
seen = picture(view, "exr-with")[::-1]
simple.Hide(reader, view)
without = picture(view, "exr-without")[::-1]
simple.Show(reader, view)
for k, name in enumerate("RGB"):
    blended = exact[name] + (1 - exact["A"]) * without[..., k]
    check(np.abs(blended - seen[..., k]).max() < 1.5 / 255, name, "is not what the window shows")
covered = exact["A"] > 0.5
check(0.05 < covered.mean() < 0.9, "half hidden", covered.mean())
check((exact["Z"][covered] < 1).all() and (exact["Z"][~covered] == 1).all(), "depth")

# To the bit what the mapper has.
simple.Render(view)
volumes = view.GetRenderer().GetVolumes()
mappers = [volumes.GetItemAsObject(k).GetMapper() for k in range(volumes.GetNumberOfItems())]
(mapper,) = [item for item in mappers if isinstance(item, inrvolume.vtkINRVolumeMapper)]
check(mapper.WriteEXR(output_file("mapper.exr")), "the mapper writes none")
own = read_exr(output_file("mapper.exr"))
check(all(np.array_equal(exact[name], own[name]) for name in exact), "not the mapper's floats")

# How the picture came about, when asked for.
display.SampleChannels = 1
display.LevelOfDetailScale = 4
check(save(path).errors() == 0, "counting samples reported something")
counted = read_exr(path)
check(sorted(counted) == ["A", "B", "G", "R", "Z", "level", "samples"], sorted(counted))
hit = counted["samples"] > 0
check((counted["A"][~hit] == 0).all() and (counted["A"][hit] > 0).mean() > 0.9, "samples")
check((counted["level"][~hit] == -1).all() and (counted["level"][hit] > 0.5).all(), "level")
display.SampleChannels = 0
display.LevelOfDetailScale = 1

# A smaller picture than the view's is drawn in that size.
check(save(path, ImageResolution=[80, 60]).errors() == 0, "a small picture reported something")
check(read_exr(path)["A"].shape == (60, 80), "size", read_exr(path)["A"].shape)

# Of a volume that is out of sight there is nothing, whatever was drawn before.
camera = view.GetActiveCamera()
camera.Yaw(180)
check(save(path).errors() == 0, "a volume behind the camera reported something")
empty = read_exr(path)
check(all((empty[name] == 0).all() for name in "RGBA") and (empty["Z"] == 1).all(), "is not empty")
check(empty["A"].shape == (120, 160), "size", empty["A"].shape)
camera.Yaw(180)

# Each eye by itself, also right after the other one of another kind of file.
eyes = {}
for eye in "Left", "Right":
    check(save(path, StereoMode=f"{eye} Eye Only").errors() == 0, eye, "eye reported something")
    eyes[eye] = read_exr(path)["A"]
    simple.SaveScreenshot(output_file("left.png"), view, StereoMode="Left Eye Only")
check(np.abs(eyes["Left"] - eyes["Right"]).max() > 0.01, "both eyes see the same")
save(path)  # VTK's own camera is off in the first picture after one in stereo

# No file, or the one before, and one message.
other = simple.CreateRenderView(ViewSize=[160, 120])
simple.Show(simple.Sphere(), other)
before = open(path, "rb").read()
second = simple.INRReader(FileName=MODEL)
for what, wanted, prepare in (
    ("tiles", "parts", lambda: {"ImageResolution": [320, 240]}),
    ("another view", "0 INR volumes", lambda: {"shown": other}),
    ("interlaced eyes", "one eye", lambda: {"StereoMode": "Interlaced"}),
    ("two volumes", "2 INR volumes", lambda: simple.Show(second, view) and {}),
    ("none", "0 INR volumes", lambda: simple.Hide(reader, view) or simple.Hide(second, view) or {}),
):
    messages = save(path, **prepare())
    check(messages.errors() == 1 and wanted in messages.text, what, "reported", messages.text)
    check(open(path, "rb").read() == before, what, "changed the file")
simple.Show(reader, view)
display.Scale = [1, 1, 0]
messages = save(path)
check("not in the picture. " in messages.text and "server" not in messages.text, "flat", messages.text)
check(open(path, "rb").read() == before, "a flat volume changed the file")
display.Scale = [1, 1, 1]
messages = save(output_file("eyes.exr"), StereoMode="Both Eyes")
check(messages.errors() > 0 and "one eye" in messages.text, "both eyes reported", messages.text)
check(not os.path.exists(output_file("eyes_left.exr")), "both eyes made a file")
os.makedirs(output_file("folder.exr"), exist_ok=True)
for bad in output_file("no-such-folder/picture.exr"), output_file("folder.exr"):
    messages = save(bad)
    check(messages.errors() == 1 and bad in messages.text, bad, "reported", messages.text)
    check(not os.path.isfile(bad), bad, "exists")

# Of a view that nobody has registered, too, as of low-level scripts.
save(path)
unknown = servermanager.CreateRenderView()
unknown.ViewSize = [160, 120]
simple.Show(reader, unknown)
look_at(unknown)
unknown.GetActiveCamera().Azimuth(30)
check(save(output_file("unknown.exr"), unknown).errors() == 0, "an unregistered view reported something")
seen = read_exr(output_file("unknown.exr"))["A"]
check(0.05 < (seen > 0.5).mean() and np.abs(seen - read_exr(path)["A"]).max() > 0.1, "another view's")

# Unless nobody knows of its representation either.
hidden = servermanager.CreateRenderView()
hidden.ViewSize = [160, 120]
hidden.Representations = [servermanager.CreateRepresentation(reader, hidden)]
hidden.Representations[0].SetRepresentationType("INR Volume")
messages = save(path, hidden)
check(messages.errors() == 1 and "register" in messages.text, "a hidden view reported", messages.text)
save(path)

# Nor of several in one.
several = simple.CreateView("ComparativeRenderView")
several.ViewSize = [160, 120]
simple.Show(reader, several)
messages = save(output_file("several.exr"), several)
check(messages.errors() == 1 and "comparative" in messages.text, "several reported", messages.text)
simple.Delete(several)

# A layout of two views is no picture of one, whichever is drawn last.
layout = simple.CreateLayout("two")
for shown in simple.CreateView("RenderView"), simple.CreateView("RenderView"):
    simple.AssignViewToLayout(view=shown, layout=layout)
    simple.Show(reader if layout.GetViewLocation(shown) == 1 else simple.Sphere(), shown)
layout.SplitHorizontal(0, 0.5)
messages = save(output_file("layout.exr"), layout)
check(messages.errors() == 1 and "parts" in messages.text, "a layout reported", messages.text)
left = [name for name in os.listdir(os.path.dirname(path)) if ".exr." in name]
check(not left, "half-written files stay:", left)
