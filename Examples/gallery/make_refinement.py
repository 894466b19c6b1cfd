# SPDX-License-Identifier: BSD-3-Clause
"""Makes the README's strip of a picture that refines itself, as in a window that nobody touches.

    PYTHONPATH=build/lib/python pvpython Examples/gallery/make_refinement.py MODELS PICTURES

Marched rays above, traced paths below; each picture says after how many seconds of the processor
it was shown, and what it shows. scene.py says where models come from. Needs a display and Pillow.
"""
import math
import os
import sys
import time

from PIL import Image, ImageDraw
from vtk_scene import captured, font, make_volume, make_window
from vtkmodules.vtkRenderingCore import vtkRenderWindowInteractor

SCALE = 2  # 256^3 voxels are there before there is much to see of it
WINDOW = 384
SHOWN = 232  # pixels of a picture in the strip
COLUMNS = 5
PATHS = 64
models, pictures = sys.argv[1:]
interactors = []


def watch(traced):
    """All pictures until the last: (processor's seconds, share of samples there, levels, paths, picture)."""
    volume = make_volume(models, SCALE)
    mapper = volume.GetMapper()
    mapper.SetRenderMode(int(traced))
    mapper.SetSamplesPerPixel(PATHS)
    window = make_window(volume, WINDOW)
    interactor = vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    volume.VisibilityOff()
    window.Render()  # the window itself takes its time to come
    interactor.Initialize()
    seen = []

    def look(*_):
        seconds = time.process_time() - start
        levels = mapper.GetFinestLevel(), mapper.GetCoarsestLevel()
        seen.append((seconds, mapper.GetCacheHitRate(), levels, mapper.GetNumberOfPaths(),
                     captured(window)))

    volume.VisibilityOn()
    window.AddObserver("EndEvent", look)
    start = time.process_time()
    window.Render()
    while not mapper.GetConverged():
        interactor.ProcessEvents()
        time.sleep(0.001)
    window.Finalize()
    interactors.append(interactor)  # VTK 9.2 goes on asking it for events
    return seen


def chosen(seen, measure):
    """COLUMNS of the pictures: first and last, and those nearest to equal steps of `measure`."""
    first, last = measure(seen[0]), measure(seen[-1])
    wanted = [first + (last - first) * k / (COLUMNS - 1) for k in range(COLUMNS)]
    picks = [min(seen, key=lambda one: abs(measure(one) - value)) for value in wanted]
    return [seen[0], *picks[1:-1], seen[-1]]


def caption(one):
    seconds, there, (finest, coarsest), paths, _ = one
    if paths:
        return f"{seconds:.1f} s: {paths} path{'s' if paths > 1 else ''}"
    levels = f"level {finest}" if finest == coarsest else f"levels {finest} to {coarsest}"
    return f"{seconds:.1f} s: {levels}, {100 * there:.0f} %"


def draw(rows):
    face = font(13)
    high, gap = SHOWN + 22, 4
    strip = Image.new("RGB", (COLUMNS * (SHOWN + gap) - gap, len(rows) * high), "white")
    pen = ImageDraw.Draw(strip)
    for row, ones in enumerate(rows):
        for column, one in enumerate(ones):
            left, top = column * (SHOWN + gap), row * high
            strip.paste(one[-1].resize((SHOWN, SHOWN), Image.LANCZOS), (left, top))
            pen.text((left + 2, top + SHOWN + 3), caption(one), fill="black", font=face)
    return strip


marched = watch(traced=False)
traced = watch(traced=True)
print(len(marched), "and", len(traced), "pictures")
for ones in marched, traced:
    print("\n".join(f"{one[0]:.2f} s, {one[1]:.3f}, levels {one[2]}, {one[3]} paths" for one in ones))
rows = chosen(marched, lambda one: one[1]), chosen(traced, lambda one: math.log(max(one[3], 1)))
draw(rows).quantize(256).save(os.path.join(pictures, "refinement.png"), optimize=True)
os._exit(0)
