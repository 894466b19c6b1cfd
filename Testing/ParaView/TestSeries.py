# SPDX-License-Identifier: BSD-3-Clause
"""A series of files is the time steps of a volume: opened, played, warm the second time, written,
changed on disk, broken in the middle."""
import json
import os
import shutil

import numpy as np
from paraview import simple
from pvtest import Messages, check, load_plugin, look_at, output_file, picture, psnr, read_png
from pvtest import show_view

load_plugin()
folder = output_file("series")
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
files = [os.path.join(folder, f"model_{k}.inr") for k in range(3)]


def save(path, k, steps=60):
    """Steps differ in size, bounds and range."""
    wave = simple.Wavelet(WholeExtent=[-8, 8 + 2 * k, -8, 8, -8, 8 + k], Maximum=255 + 40 * k,
                          XFreq=60 + 20 * k)
    wave.UpdatePipeline()
    simple.SaveData(path, wave, Scalars=["POINTS", "RTData"], MaximumSteps=steps, TimeLimit=0)
    simple.Delete(wave)


for number, file in enumerate(files):
    save(file, number)

view = show_view((160, 120))
with Messages() as messages:
    reader = simple.OpenDataFile(files)
    check(reader.GetXMLName() == "INRReader", "opened by", reader.GetXMLName())
    check(list(reader.TimestepValues) == [0, 1, 2], "times", reader.TimestepValues)
    display = simple.Show(reader, view)
check(messages.errors() == 0, "opening reported", messages.text)
check(display.Representation == "INR Volume", "shown as", display.Representation)
settings = {"BrickSize": 4, "MaximumRequests": 2, "LevelOfDetailScale": 0, "Deterministic": 1,
            "CacheSize": 64, "ScalarOpacityUnitDistance": 2}
for key, setting in settings.items():
    setattr(display, key, setting)
look_at(view)


def value(name):
    display.UpdatePropertyInformation()
    return display.GetPropertyValue(name)


def single(path):
    """The picture of a file that is opened alone, from the same place."""
    other = show_view(view.ViewSize)
    volume = simple.OpenDataFile(path)
    check(len(volume.TimestepValues) == 0, "a single file has times:", volume.TimestepValues)
    shown = simple.Show(volume, other)
    for key, setting in settings.items():
        setattr(shown, key, setting)
    for key in ("CameraPosition", "CameraFocalPoint", "CameraViewUp", "CameraViewAngle"):
        setattr(other, key, getattr(view, key))
    pixels = picture(other, "series-single")
    bounds = volume.GetDataInformation().GetBounds()
    simple.Delete(volume)
    simple.Delete(other)
    simple.SetActiveView(view)
    return pixels, bounds


def show(time):
    view.ViewTime = time
    return picture(view, f"series-{time}")


# No picture depends on what was shown before it.
for function in (simple.GetColorTransferFunction, simple.GetOpacityTransferFunction):
    function("RTData").RescaleTransferFunction(0, 500)

# Every step is shown as if its file had been opened alone, in whatever order.
alone = [single(path) for path in files]
check(psnr(alone[0][0], alone[1][0]) < 40, "the steps look alike")
for time in (0, 1, 2, 1, 0, 1.5):
    pixels = show(time)
    truth, bounds = alone[int(time)]
    check(np.array_equal(pixels, truth), "step", time, "differs by", psnr(pixels, truth), "dB")
    found = reader.GetDataInformation().GetBounds()
    check(np.allclose(found, bounds), "bounds", found, "of", bounds, "at", time)

# All time steps without drawing any.
display.RescaleTransferFunctionToDataRangeOverTime()
points = simple.GetColorTransferFunction("RTData").RGBPoints
ranges = []
for path in files:
    volume = simple.INRReader(FileName=path)
    volume.UpdatePipeline()
    ranges.append(volume.PointData["RTData"].GetRange())
    simple.Delete(volume)
check(points[0] == min(low for low, high in ranges), "colours from", points[0], ranges)
check(points[-4] == max(high for low, high in ranges), "colours to", points[-4], ranges)


def play(rounds, seek):
    """Hit rates of the first interactive picture of every step."""
    rates = []
    for time in list(range(3)) * rounds:
        seek(time)
        view.SMProxy.Update()
        view.SMProxy.InteractiveRender()
        rates.append((value("CacheHitRate"), value("Converged")))
        for _ in range(200):  # its pixels are not those of a still picture
            if value("Converged") == 1:
                break
            view.SMProxy.InteractiveRender()
    return rates


def by_view(time):
    view.ViewTime = time


# The first round infers, the second one nothing.
simple.Delete(reader)
reader = simple.INRReader(FileName=files)
display = simple.Show(reader, view)
for key, setting in settings.items():
    setattr(display, key, setting)
rates = play(2, by_view)
check(all(rate < 1 for rate, _ in rates[:3]), "bricks from nowhere:", rates)
check(all(rate == (1, 1) for rate in rates[3:]), "a step that was seen is cold:", rates)
used = value("CacheUsed")

# ParaView keeps the geometry of animations; the volume is not to stay behind.
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
general = simple.GetSettingsProxy("GeneralSettings")
general.CacheGeometryForAnimation = 1


def by_scene(time):
    scene.AnimationTime = time


warm = [show(time) for time in range(3)]
scene.PlayMode = "Snap To TimeSteps"
for _ in range(2):
    scene.Play()
    for time in (1, 2, 0):
        by_scene(time)
        pixels = picture(view, "series-played")
        check(np.array_equal(pixels, warm[time]), "step", time, "is played wrong")
rates = play(1, by_scene)
check(all(rate == (1, 1) for rate in rates), "played cold:", rates)
for name in ("first", "second"):
    simple.SaveAnimation(output_file(f"series-{name}.png"), view, FrameWindow=[0, 2])
    for time in range(3):
        frame = read_png(output_file(f"series-{name}.{time:04d}.png"))
        check(np.array_equal(frame, warm[time]), name, "film is wrong at", time)
general.CacheGeometryForAnimation = 0

# Too small a budget: the same pictures, colder.
display.BrickSize = 12
display.CacheSize = 1
check(value("CacheUsed") <= 1, "the cache takes", value("CacheUsed"))
for time in (0, 1, 2, 0, 1, 2):
    pixels = show(time)
    check(psnr(pixels, warm[time]) > 40, "a small cache shows at", time, psnr(pixels, warm[time]))
    check(value("CacheUsed") <= 1, "the cache takes", value("CacheUsed"), "at", time)
display.BrickSize = 4
display.CacheSize = 64

# Save Data of all time steps: their times come back, and each went on from the one before.
shifted = simple.TemporalShiftScale(Input=reader, Scale=0.5, PostShift=3)
sampled = simple.ResampleToImage(Input=shifted, SamplingDimensions=[9, 8, 7])
written = os.path.join(folder, "written.inr")
with Messages() as messages:
    simple.SaveData(written, sampled, Scalars=["POINTS", "RTData"], MaximumSteps=200,
                    TimeLimit=0, Writetimestepsasfileseries=1, Firsttimestep=1,
                    Filenamesuffix="_%.3d")
check(messages.errors() == 0, "saving reported", messages.text)
names = sorted(name for name in os.listdir(folder) if name.startswith("written"))
check(names == ["written_001.inr", "written_002.inr"], "files:", names)
again = simple.OpenDataFile([os.path.join(folder, name) for name in names])
check(list(again.TimestepValues) == [3.5, 4], "times", again.TimestepValues)
for time in (3.5, 4):
    again.UpdatePipeline(time)
    sampled.UpdatePipeline(time)
    for data in (again, sampled):
        check(data.GetDataInformation().GetNumberOfPoints() == 9 * 8 * 7, "points at", time)
    found, truth = again.GetDataInformation().GetBounds(), sampled.GetDataInformation().GetBounds()
    check(np.allclose(found, truth), "bounds", found, "of", truth, "at", time)
with open(os.path.join(folder, names[1]), "rb") as file:
    check(b"earlier_steps" in file.read(), "the second step started anew")
for proxy in (again, sampled, shifted):
    simple.Delete(proxy)

# A file that changes is read anew; the others stay.
view.ViewTime = 0
save(files[1], 1, steps=90)
pixels = show(1)
changed, _ = single(files[1])
check(not np.array_equal(changed, alone[1][0]), "the file is the same")

# In the middle of a series a file is broken, then gone: one message, and the others work.
before = [show(time) for time in range(3)]
with open(files[1], "r+b") as file:
    file.truncate(1000)
for what in ("broken", "missing"):
    with Messages() as messages:
        show(0)
        show(1)
        check(np.array_equal(show(2), before[2]), "the step after the", what, "one")
        check(np.array_equal(show(0), before[0]), "the step before the", what, "one")
    check(messages.errors() == 1, what, "gave", messages.errors(), "messages", messages.text)
    check("model_1.inr" in messages.text, "which file is", what, messages.text)
    with Messages() as messages:
        opened = simple.OpenDataFile(files)
        opened.UpdatePipeline(2)
    check(messages.errors() == 0, "opening reported", messages.text)
    check(list(opened.TimestepValues) == [0, 1, 2], "times", opened.TimestepValues)
    simple.Delete(opened)
    if what == "broken":
        os.remove(files[1])
with Messages() as messages:  # the first one
    opened = simple.INRReader(FileName=[files[1], files[0], files[2]])
    opened.UpdatePipeline(0)
    check(opened.GetDataInformation().GetNumberOfPoints() == 0, "a missing step has points")
    opened.UpdatePipeline(2)
    found = opened.GetDataInformation().GetBounds()
check(np.allclose(found, alone[2][1]), "bounds after a missing first step", found)
check(messages.errors() == 1, "gave", messages.errors(), "messages", messages.text)
simple.Delete(opened)

# ParaView's own list of files, with times.
listed = os.path.join(folder, "model.inr.series")
with open(listed, "w") as file:
    json.dump({"file-series-version": "1.0",
               "files": [{"name": "model_0.inr", "time": 0.25},
                         {"name": "model_2.inr", "time": 4}]}, file)
opened = simple.OpenDataFile(listed)
check(opened.GetXMLName() == "INRReader", "opened by", opened.GetXMLName())
check(list(opened.TimestepValues) == [0.25, 4], "times", opened.TimestepValues)
opened.UpdatePipeline(4)
check(np.allclose(opened.GetDataInformation().GetBounds(), alone[2][1]), "the second of the list")

# State files keep the series.
simple.SaveState(output_file("series.pvsm"))
simple.ResetSession()
with Messages() as messages:
    simple.LoadState(output_file("series.pvsm"))
    lists = sorted(len(each.FileName) for each in simple.GetSources().values())
check(lists == [1, 3], "files in the state", lists)
