# SPDX-License-Identifier: BSD-3-Clause
"""Makes the guide's figure of what the settings of quality do to a picture and to its time.

    PYTHONPATH=build/lib/python pvpython Examples/gallery/make_knobs.py MODELS PICTURES

Each crop is a view of its own, of as many pixels, of rm_mixing with about a voxel to a pixel. Under it:
the setting and the PSNR of what is seen of the volume, 8 bits a channel, against the same with everything
exact (of paths: four times as many); the processor time of a frame from the cache, and of the first
complete picture, over those by default beside it.
scene.py says where models come from. Needs a display and Pillow.
"""
import math
import os
import statistics
import sys
import time

import numpy as np
from PIL import Image, ImageDraw
from vtk_scene import BACKGROUND, captured, font, make_volume, make_window

CROP = 160
ZOOM = 1.7  # of the whole view, so that a voxel is about a pixel
TURNS = 8
PATHS = 64
EXACT = {"LevelOfDetailScale": 0, "SampleDistance": 1 / 16, "CachePrecision": 0, "AdaptiveSampling": 0}
# Row: property, what the figure says, and (value, how it is called) of each crop.
ROWS = (
    ("LevelOfDetailScale", ((0, "0"), (1, "1 (default)"), (2, "2"), (4, "4"))),
    ("SampleDistance", ((0.25, "0.25"), (0.5, "0.5 (default)"), (1, "1"), (4, "4"))),
    ("ErrorTolerance", ((0, "0"), (4, "4"), (16, "16"))),
    ("CachePrecision", ((0, "Float"), (1, "16 bit (default)"), (2, "8 bit"))),
    ("SamplesPerPixel", ((1, "1"), (4, "4"), (16, "16"), (64, "64 (default)"))),
)
models, pictures = sys.argv[1:]


class Look:
    """A window on the volume, everything set as by default."""

    def __init__(self, traced):
        self.volume = make_volume(models)
        self.mapper = self.volume.GetMapper()
        self.mapper.SetRenderMode(int(traced))
        self.mapper.SetSamplesPerPixel(PATHS)
        self.window = make_window(self.volume, CROP)
        self.window.SetOffScreenRendering(True)
        self.camera = self.window.GetRenderers().GetFirstRenderer().GetActiveCamera()
        self.camera.Zoom(ZOOM)

    def set(self, settings):
        for name, value in settings.items():
            getattr(self.mapper, "Set" + name)(value)

    def frame(self):
        """A picture, and the processor's seconds for it."""
        start = time.process_time()
        self.window.Render()
        return captured(self.window), time.process_time() - start

    def turned(self, degrees):
        """A picture from elsewhere, and the processor's seconds for it."""
        self.camera.Azimuth(degrees)
        return self.frame()


def psnr(picture, exact):
    """Over the pixels in which either shows something."""
    a, b = np.asarray(picture, float), np.asarray(exact, float)
    empty = np.round(255 * np.array(BACKGROUND))
    seen = (np.abs(a - empty) > 1).any(axis=2) | (np.abs(b - empty) > 1).any(axis=2)
    error = np.mean((a[seen] - b[seen]) ** 2)
    return 10 * math.log10(255**2 / error) if error else math.inf


def measure(name, settings):
    """(two lines of text, picture) of each crop of a row."""
    traced = name == "SamplesPerPixel"
    turns = 1 if traced else TURNS
    exact = Look(traced)
    exact.set({"SamplesPerPixel": 4 * PATHS, "Seed": 1} if traced else EXACT)
    truth, _ = exact.frame()
    crops = []
    for value, called in settings:
        usual, look = Look(traced), Look(traced)
        look.set({name: value})
        _, usual_first = usual.frame()
        _, first = look.frame()
        ratios = []
        for degrees in (0.01, -0.01) * turns:  # in turn, as the machine may not be as fast all the time
            _, before = usual.turned(degrees)
            picture, seconds = look.turned(degrees)
            ratios.append(seconds / before)
        quality = psnr(picture, truth)
        text = (f"{called}: {quality:.0f} dB",
                f"frame {statistics.median(ratios):.2f}, first {first / usual_first:.2f}")
        crops.append((text, picture))
        print(name, *text, f"({seconds:.3f} s, {first:.3f} s)", flush=True)
    return crops


def draw(rows):
    gap, text, side = 6, 34, 130
    columns = max(len(crops) for crops in rows.values())
    size = side + columns * (CROP + gap), len(rows) * (CROP + text + gap)
    figure = Image.new("RGB", size, "white")
    pen = ImageDraw.Draw(figure)
    for row, (name, crops) in enumerate(rows.items()):
        top = row * (CROP + text + gap)
        pen.text((2, top + CROP / 2), name, fill="black", font=font(13), anchor="lm")
        for column, (lines, picture) in enumerate(crops):
            left = side + gap + column * (CROP + gap)
            figure.paste(picture, (left, top))
            for line, words in enumerate(lines):
                pen.text((left, top + CROP + 2 + 15 * line), words, fill="black", font=font(12))
    return figure


rows = {name: measure(name, settings) for name, settings in ROWS}
draw(rows).quantize(256).save(os.path.join(pictures, "knobs.png"), optimize=True)
os._exit(0)
