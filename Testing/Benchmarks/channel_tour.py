# SPDX-License-Identifier: BSD-3-Clause
"""For pvpython: opens a model of a turbulent channel, flies through it and takes pictures at three
distances. Arguments as JSON, the answer as the last line.

    pvpython channel_tour.py '{"plugin": ..., "model": ..., "dims": [...], "frames": 4000,
                               "cache": 2048, "folder": ...}'

For each picture the folder receives NAME.exr and NAME.json, the scene for channel_picture.
"""
import json
import math
import os
import sys
import time

from paraview import simple

SIZE = [8 * math.pi, 3 * math.pi, 2]  # half-heights of the channel
PIXELS = [384, 256]
# Value, red, green, blue, opacity: slow fluid from the walls, and what is fastest in the middle.
COLORS = [[0.0, 0.0, 0.1, 0.4, 0], [0.5, 0.0, 0.2, 0.7, 0], [0.7, 0.2, 0.6, 0.9, 0.35],
          [0.85, 0.8, 0.9, 0.9, 0.03], [1.0, 0.9, 0.9, 0.7, 0], [1.08, 1.0, 0.7, 0.2, 0.05],
          [1.2, 0.9, 0.1, 0.0, 0.6], [1.4, 0.5, 0.0, 0.0, 0.6]]
UNIT = 0.1  # half-heights that the opacities are for
# Camera, focal point and vertical angle of view.
VIEWS = {
    "far": ([12.57, -20.0, 15.0], [12.57, 4.7, 0.6], 40),
    "middle": ([5.0, 1.0, 3.2], [8.5, 4.5, 0.9], 45),
    "near": ([12.0, 4.0, 0.3], [12.25, 4.2, 0.0], 50),
}


def memory(field):
    """MiB: VmRSS is what is resident, VmHWM the most that ever was."""
    with open("/proc/self/status") as status:
        line = next(line for line in status if line.startswith(field))
    return int(line.split()[1]) / 1024


def processor_seconds():
    """Of the machine and of this process."""
    with open("/proc/stat") as status:
        user, nice, system = (int(number) for number in status.readline().split()[1:4])
    return (user + nice + system) / os.sysconf("SC_CLK_TCK"), time.process_time()


def place(part):
    """From outside through the middle of the channel and round: as bench_flight does."""
    angle = 2 * math.pi * part
    way = (0.9 * math.cos(angle), 0.25 * math.sin(3 * angle), 0.45 * math.sin(2 * angle))
    return [size * (0.5 + there) for size, there in zip(SIZE, way)]


def look(position, focus, angle):
    camera = view.GetActiveCamera()
    camera.SetPosition(position)
    camera.SetFocalPoint(focus)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(angle)
    return camera


def show(model):
    reader = simple.OpenDataFile(model)
    shown = simple.Show(reader, view)
    name = shown.ColorArrayName[1]
    table = simple.GetColorTransferFunction(name)
    table.ColorSpace = "RGB"
    table.RGBPoints = [number for node in COLORS for number in node[:4]]
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = [number for node in COLORS for number in (node[0], node[4], 0.5, 0)]
    shown.SetScalarBarVisibility(view, False)
    shown.ScalarOpacityUnitDistance = UNIT
    shown.CacheSize = given["cache"]
    shown.SampleChannels = 1
    return shown


def fly(frames):
    """What each frame was like, the memory at the end, and how busy others kept the machine."""
    seconds, mapper, hits, used = [], [], [], []
    warm = 0
    all_before, own_before = processor_seconds()
    for k in range(frames):
        part = k / frames
        ahead = place(part + 0.05)
        look(place(part), [0.3 * size + 0.4 * there for size, there in zip(SIZE, ahead)], 60)
        start = time.perf_counter()
        view.SMProxy.InteractiveRender()
        seconds.append(time.perf_counter() - start)
        display.UpdatePropertyInformation()
        mapper.append(display.GetPropertyValue("FrameTime"))
        hits.append(display.GetPropertyValue("CacheHitRate"))
        used.append(display.GetPropertyValue("CacheUsed"))
        if k == frames // 4:
            warm = memory("VmHWM")
    all_after, own_after = processor_seconds()
    others = (all_after - all_before) / (own_after - own_before) - 1
    return {"seconds": seconds, "mapper": mapper, "hits": hits, "cache": max(used),
            "others": others, "peak": memory("VmHWM") - idle, "growth": memory("VmHWM") - warm}


def take(name):
    """A complete still picture, and the scene for channel_picture."""
    position, focus, angle = VIEWS[name]
    camera = look(position, focus, angle)
    path = os.path.join(given["folder"], name)
    start = time.perf_counter()
    simple.SaveScreenshot(path + ".exr", view)
    seconds = time.perf_counter() - start
    display.UpdatePropertyInformation()
    # The field's finest structures are 40 voxels of 10,240 wide.
    scene = {"dims": given["dims"], "size": PIXELS, "position": position, "focal_point": focus,
             "view_up": [0, 0, 1], "view_angle": angle, "unit_distance": UNIT, "colors": COLORS,
             "clipping_range": list(camera.GetClippingRange()), "seed": 0,
             "sample_distance": 8 * given["dims"][0] / 10240}
    with open(path + ".json", "w") as file:
        json.dump(scene, file)
    return {"seconds": seconds, "converged": display.GetPropertyValue("Converged"),
            "cache": display.GetPropertyValue("CacheUsed")}


given = json.loads(sys.argv[1])
simple.LoadPlugin(given["plugin"], remote=False, ns=vars(simple))
simple._DisableFirstRenderCameraReset()
view = simple.CreateView("RenderView")
view.ViewSize = PIXELS
view.OrientationAxesVisibility = 0
simple.Render(view)
idle = memory("VmRSS")
start = time.perf_counter()
display = show(given["model"])
look(*VIEWS["far"])
view.SMProxy.InteractiveRender()
answer = {"opening": time.perf_counter() - start}
answer["flight"] = fly(given["frames"])
answer["views"] = {name: take(name) for name in VIEWS}
answer["peak"] = memory("VmHWM") - idle
print(json.dumps(answer), flush=True)
os._exit(0)  # sys.exit() crashes ParaView 5.11 once it has a window
