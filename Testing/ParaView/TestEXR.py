# SPDX-License-Identifier: BSD-3-Clause
"""Save Screenshot as OpenEXR: the mapper's own floats, which agree with the screenshot in 8 bits; whole
files or none, and a message where there is none."""
import os
import struct
import zlib

import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, output_file, picture, show_view

load_plugin()
import inrvolume  # noqa: E402  ParaView's Python then knows the mapper


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def header(data):
    """The attributes of a one-part file as bytes by name, and where they end."""
    check(data[:8] == b"\x76\x2f\x31\x01\x02\0\0\0", "not a plain OpenEXR file")
    found, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def unpacked(packed, size):
    """Undoes OpenEXR's ZIP: deflate of byte differences of even bytes, then odd ones."""
    if len(packed) == size:
        return packed
    steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    steps[1:] -= 128
    halves = np.cumsum(steps).astype(np.uint8)
    whole = np.empty(size, np.uint8)
    whole[0::2], whole[1::2] = np.split(halves, [(size + 1) // 2])
    return whole.tobytes()


def read_exr(path):
    """Float channels by name, (h, w), row 0 at the top; after the format's description."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header(data)
    names, place = [], 0
    while attributes["channels"][place]:
        name, place = text(attributes["channels"], place)
        check(attributes["channels"][place] == 2, name, "is no float")
        names.append(name)
        place += 16
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    pixels = np.empty((height, len(names), width), np.float32)
    check(attributes["compression"] == b"\3", "compression", attributes["compression"])
    for offset in struct.unpack_from(f"<{-(-height // 16)}Q", data, at):
        row, size = struct.unpack_from("<2i", data, offset)
        rows = min(16, height - row)
        block = unpacked(data[offset + 8:offset + 8 + size], rows * len(names) * width * 4)
        pixels[row:row + rows] = np.frombuffer(block, "<f4").reshape(rows, len(names), width)
    return {name: pixels[:, k] for k, name in enumerate(names)}


def save(path, **options):
    """What is reported while the view is saved."""
    with Messages() as messages:
        simple.SaveScreenshot(path, view, **options)
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

# No file, or the one before, and one message.
before = open(path, "rb").read()
second = simple.INRReader(FileName=MODEL)
for what, wanted, prepare in (
    ("tiles", "parts", lambda: {"ImageResolution": [320, 240]}),
    ("two volumes", "2 INR volumes", lambda: simple.Show(second, view) and {}),
    ("none", "0 INR volumes", lambda: simple.Hide(reader, view) or simple.Hide(second, view) or {}),
):
    messages = save(path, **prepare())
    check(messages.errors() == 1 and wanted in messages.text, what, "reported", messages.text)
    check(open(path, "rb").read() == before, what, "changed the file")
simple.Show(reader, view)
os.makedirs(output_file("folder.exr"), exist_ok=True)
for bad in output_file("no-such-folder/picture.exr"), output_file("folder.exr"):
    messages = save(bad)
    check(messages.errors() == 1 and bad in messages.text, bad, "reported", messages.text)
    check(not os.path.isfile(bad), bad, "exists")
left = [name for name in os.listdir(os.path.dirname(path)) if ".exr." in name]
check(not left, "half-written files stay:", left)
