# SPDX-License-Identifier: BSD-3-Clause
"""Whatever is clicked in whatever order: at most one message for each thing that is wrong, no crash,
no hang, and the volume is back when it is put right."""
import os
import shutil

from paraview import servermanager, simple
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, look_at, output_file, picture, psnr
from pvtest import show_view

load_plugin()
NAN, INF = float("nan"), float("inf")
view = show_view((200, 150))
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)
good = picture(view, "bad-use-good")
colours = simple.GetColorTransferFunction(ARRAY)
opacity = simple.GetOpacityTransferFunction(ARRAY)


def values(item, names):
    held = {name: item.GetPropertyValue(name) for name in names}
    return {name: list(v) if hasattr(v, "__len__") and not isinstance(v, str) else v
            for name, v in held.items()}


def abuse(what, item, wanted, **properties):
    """Renders with bad properties, at rest, in motion and at rest, and puts them back; `wanted` is
    how many messages there are to be."""
    before = values(item, properties)
    with Messages() as messages:
        for name, value in properties.items():
            setattr(item, name, value)
        simple.Render(view)
        view.SMProxy.InteractiveRender()
        simple.Render(view)
        for name, value in before.items():
            setattr(item, name, value)
        simple.Render(view)
    print(f"{what}: {messages.errors()} messages", flush=True)
    check(messages.errors() == wanted, what, "gave", messages.errors(), "messages:", messages.text)


def check_restored(what):
    again = picture(view, "bad-use-again")
    check(psnr(again, good) > 50, what, "leave their mark:", psnr(again, good), "dB")


# Transfer functions.
points = list(opacity.Points)
rgb = list(colours.RGBPoints)
low, high = points[0], points[-4]
abuse("an opacity of one point", opacity, 0, Points=[50, 0.5, 0.5, 0])
abuse("an opacity of one place", opacity, 0, Points=[50, 0, 0.5, 0, 50, 1, 0.5, 0])
abuse("no opacity", opacity, 0, Points=[])
abuse("an opacity of NaN", opacity, 1, Points=points[:4] + [50, NAN, 0.5, 0] + points[4:])
abuse("an opacity at NaN", opacity, 1, Points=points[:4] + [NAN, 0.5, 0.5, 0] + points[4:])
abuse("an opacity at infinity", opacity, 0, Points=points[:4] + [INF, 0.5, 0.5, 0])
abuse("opacities out of range", opacity, 0, Points=[low, -3, 0.5, 0, high, 7, 0.5, 0])
abuse("a colour of one point", colours, 0, RGBPoints=[50, 1, 0, 0])
abuse("a colour of NaN", colours, 1, RGBPoints=[low, 0, 0, NAN, high, 1, 1, 1])
abuse("a colour at NaN", colours, 1, RGBPoints=[low, 0, 0, 0, NAN, 1, 0, 0, high, 1, 1, 1])
abuse("colours of a range of zero width", colours, 0, RGBPoints=[50, 0, 0, 1, 50, 1, 0, 0])
with Messages() as messages:
    colours.RescaleTransferFunction(50, 50)
    opacity.RescaleTransferFunction(50, 50)
    simple.Render(view)
    colours.RescaleTransferFunction(low, high)
    opacity.RescaleTransferFunction(low, high)
    colours.RGBPoints, opacity.Points = rgb, points
    simple.Render(view)
check(messages.errors() == 0, "a range of zero width gave", messages.text)
check_restored("transfer functions")

# Transforms.
abuse("scaled to a sheet", display, 1, Scale=[1, 1, 0])
abuse("scaled to nothing", display, 1, Scale=[0, 0, 0])
abuse("scaled to a speck", display, 0, Scale=[1e-30] * 3)
abuse("scaled by NaN", display, 1, Scale=[NAN, 1, 1])
abuse("placed at NaN", display, 1, Position=[NAN, 0, 0])
abuse("placed far away", display, 0, Position=[1e30, 0, 0])
abuse("turned by NaN", display, 1, Orientation=[0, NAN, 0])
abuse("mirrored", display, 0, Scale=[-1, 1, 1])

check_restored("transforms")

# The display's own numbers: what is out of range is moved into it, what is no number is refused.
for name, clamped, refused in (
    ("ScalarOpacityUnitDistance", (1e-300, 1e300, -1), (0, NAN)),  # below 0: not known
    ("SampleDistance", (0, -1, 1e9), (NAN,)),
    ("LevelOfDetailScale", (-1, INF), (NAN,)),
    ("ErrorTolerance", (-7, 0, 8, INF), (NAN,)),
    ("StillTimeLimit", (INF, NAN), ()),
    ("SamplesPerPixel", (0, -5), ()),
    ("CacheSize", (-1, 1), ()),
    ("BrickSize", (0, 3), ()),
    ("NumberOfThreads", (-2,), ()),
):
    for value in clamped + refused:
        abuse(f"{name} = {value}", display, int(value in refused), **{name: value})
check_restored("numbers")

# Cameras.
camera = values(view, ["CameraPosition", "CameraFocalPoint", "CameraViewUp"])
middle = list(camera["CameraFocalPoint"])
view.CameraPosition = [middle[0] + 5, middle[1], middle[2]]
check(picture(view, "bad-use-inside").std() > 0.01, "nothing is seen from inside")
view.CameraPosition = camera["CameraPosition"]
abuse("a camera at its focus", view, 1, CameraPosition=middle)
abuse("a camera at NaN", view, 1, CameraPosition=[NAN, 0, 0])
abuse("no way up", view, 0, CameraViewUp=[0, 0, 0])
abuse("an angle of nothing", view, 0, CameraViewAngle=0)
abuse("a parallel scale of nothing", view, 1, CameraParallelProjection=1, CameraParallelScale=0)
check_restored("cameras")

# Windows.
for size in ([1, 1], [1, 150], [200, 1], [3, 3]):
    with Messages() as messages:
        view.ViewSize = size
        simple.Render(view)
        view.SMProxy.InteractiveRender()
        view.ViewSize = [200, 150]
        simple.Render(view)
    check(messages.errors() == 0, "a window of", size, "gave", messages.text)
with Messages() as messages:  # a view that a splitter leaves nothing of
    for edge in ([0.5, 0.5, 0.5, 0.5], [0, 0, 0, 1], [0, 0, 1, 0]):
        view.GetRenderer().SetViewport(edge)
        simple.Render(view)
        view.SMProxy.InteractiveRender()
    view.GetRenderer().SetViewport(0, 0, 1, 1)
check(messages.errors() == 0, "a view without pixels gave", messages.text)
check(psnr(picture(view, "bad-use-resized"), good) > 50, "small windows leave their mark")

# The file changes while its bricks load.
copy = output_file("bad-use.inr")
shutil.copy(MODEL, copy)
with Messages() as messages:
    other = simple.OpenDataFile(copy)
    shown = simple.Show(other, view)
    shown.BrickSize = 12
    view.SMProxy.InteractiveRender()
    other.FileName = MODEL
    view.SMProxy.InteractiveRender()
    other.FileName = copy
    view.SMProxy.InteractiveRender()
    with open(copy, "r+b") as file:
        file.truncate(1000)
    view.SMProxy.InteractiveRender()
    simple.Render(view)
check(messages.errors() == 0, "a file that changes under a load gave", messages.text)
os.remove(copy)
simple.Delete(other)

# Everything goes while something else is shown, hidden or on its way.
with Messages() as messages:
    for k in range(4):
        source = simple.OpenDataFile(MODEL)
        item = simple.Show(source, view)
        item.BrickSize = 12
        view.SMProxy.InteractiveRender()
        if k == 1:
            item.SetRepresentationType("Outline")
        if k == 2:
            simple.Hide(source, view)
        if k == 3:
            item.RenderMode = "Path Tracing"
            view.SMProxy.InteractiveRender()
        simple.Delete(source)
        simple.Render(view)
check(messages.errors() == 0, "deleting under a load gave", messages.text)

# While a file is being trained, observers of its progress do what users might.
wavelet = simple.Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
wavelet.UpdatePipeline()
steps = []


def meddle(*_):
    steps.append(1)
    if len(steps) == 3:
        simple.Render(view)
    if len(steps) == 5:
        simple.Delete(reader)
    if len(steps) == 7:
        wavelet.WholeExtent = [-9, 9, -8, 8, -8, 8]
    if len(steps) == 9:
        writer.GetClientSideObject().SetAbortExecute(1)


target = output_file("bad-use-training.inr")
with Messages() as messages:
    writer = servermanager.writers.INRWriter(Input=wavelet, FileName=target)
    writer.SetPropertyWithName("TimeLimit", 20)
    writer.SetPropertyWithName("MaximumSteps", 4000)
    writer.GetClientSideObject().AddObserver("ProgressEvent", meddle)
    writer.UpdatePipeline()
print(len(steps), "reports of progress", flush=True)
check(len(steps) >= 9, "training reports no progress:", len(steps))
check(messages.errors() <= 1, "meddling with training gave", messages.text)
left = [name for name in os.listdir(os.path.dirname(target)) if name.startswith(
    "bad-use-training.inr.")]
check(left in ([], ["bad-use-training.inr.checkpoint"]), "a temporary file is left:", left)
for path in (target, target + ".checkpoint"):
    if os.path.exists(path):
        os.remove(path)

# The session goes on.
with Messages() as messages:
    simple.Delete(wavelet)
    reader = simple.OpenDataFile(MODEL)
    display = simple.Show(reader, view)
    simple.Render(view)
check(messages.errors() == 0, "afterwards", messages.text)
check(psnr(picture(view, "bad-use-after"), good) > 50, "the volume does not come back")
