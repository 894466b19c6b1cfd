# SPDX-License-Identifier: BSD-3-Clause
"""The text in the corner, which one of a server's processes writes about all of them: over the picture and
beside it, from all sides, several below each other, and nothing else of the picture changes. Arguments:
the server's port and its number of processes."""
import os
import sys

import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, connect, picture, show_ball, show_model
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter

connect(sys.argv[1])
WIDTH, HEIGHT = 420, 240


def blocks(with_text, without, name):
    """Blocks of rows, counted from the top, that differ: about the corner, and nowhere else."""
    differs = np.any(np.abs(with_text - without)[::-1] > 2.5 / 255, axis=2)
    check(not differs[:, 400:].any(), name, "is changed far from the corner")
    rows = differs.any(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], rows.astype(int), [0]))))
    return edges.reshape(-1, 2)


local = vtkRenderWindow()
local.SetOffScreenRendering(1)
local.SetSize(WIDTH, HEIGHT)
local.AddRenderer(vtkRenderer())
words = vtkTextActor()
words.GetTextProperty().SetFontFamilyToCourier()
words.GetTextProperty().SetFontSize(14)
words.GetTextProperty().SetColor(1, 1, 1)
words.GetTextProperty().SetVerticalJustificationToTop()
words.SetPosition(8, HEIGHT - 8)
local.GetRenderers().GetFirstRenderer().AddActor(words)


def letters(text):
    """How much ink the text has in the corner: (rows from the top, columns), 0 to 1."""
    words.SetInput(text)
    local.Render()
    capture = vtkWindowToImageFilter()
    capture.SetInput(local)
    capture.Update()
    pixels = vtk_to_numpy(capture.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(HEIGHT, WIDTH, -1)[::-1, :, 0] / 255.0


def reads(image, bare, text):
    """Whether the picture begins with the text in its corner, `bare` is the one without it."""
    ink = letters(text)
    ground = bare[::-1] / 2  # darkened by half
    seen = ((image[::-1] - ground) / (1 - ground)).mean(axis=2)
    lines, columns = (np.flatnonzero(ink.any(axis=axis)) for axis in (1, 0))
    part = np.ix_(lines, np.arange(columns[0], columns[-1] + 1))
    return np.abs(seen[part] - ink[part]).max() < 0.1


with Messages() as messages:
    view, display = show_model((WIDTH, HEIGHT))
    show_ball(view, [20, 30, 70], 16)
    camera = view.GetActiveCamera()
    camera.Dolly(0.7)  # the volume is far from the corner
    view.GetRenderer().ResetCameraClippingRange()
    for side in range(4):  # another process is the foremost
        name = f"server-status-{side}"
        display.ShowStatus = 0
        bare = picture(view, name + "-off")
        check(bare.std() > 0.02, "nothing is shown")
        display.ShowStatus = 1
        shown = picture(view, name)
        found = blocks(shown, bare, name)
        print(name, found.tolist())
        check(len(found) == 1, name, "has", len(found), "texts")
        check(found[0][0] < 10 and 20 < found[0][1] - found[0][0] < 60, "a text in rows", found)
        check(reads(shown, bare, "wmag: level 0, 100 % there"), name, "has another text")
        check(not reads(shown, bare, "wmag: level 1, 100 % there"), name, "cannot be read")
        display.UpdatePropertyInformation()
        used = display.GetPropertyValue("CacheUsed")  # by the first process
        read = [n for n in range(60) if reads(shown, bare, f"\ncache {n} MiB, {sys.argv[2]} x CPU ")]
        print("caches of", read, "MiB, of one", used)
        check(len(read) == 1 and read[0] > used + 0.5, "caches of", read, "MiB, of one", used)
        camera.Zoom(12)
        display.ShowStatus = 0
        bare = picture(view, name + "-near-off")
        check(bare[-30:, :100].mean() < 0.95, "nothing is behind the text")
        display.ShowStatus = 1
        check(reads(picture(view, name + "-near"), bare, "wmag: level 0, 100 % there"), name, "is covered")
        camera.Zoom(1 / 12)
        camera.Azimuth((90, 90, 90, 0)[side])
        camera.Elevation((0, 60, -60, 0)[side])
        camera.OrthogonalizeViewUp()

    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 2
    display.ShowStatus = 0
    bare = picture(view, "server-status-paths-off")
    display.ShowStatus = 1
    shown = picture(view, "server-status-paths")
    check(len(blocks(shown, bare, "of paths")) == 1, "no text of paths")
    check(reads(shown, bare, "wmag: level 0, 100 % there, 2 of 2 paths"), "paths are not counted")
    display.RenderMode = "Ray Marching"

    second = simple.Show(simple.INRReader(FileName=MODEL), view)
    second.SetScalarBarVisibility(view, False)
    second.Position = [100, 0, 0]
    display.ShowStatus = 0
    bare = picture(view, "server-status-two-off")
    display.ShowStatus = second.ShowStatus = 1
    found = blocks(picture(view, "server-status-two"), bare, "of two")
    check(len(found) == 2 and found[0][1] < found[1][0], "two texts are in rows", found)
    second.Visibility = 0
    hidden = picture(view, "server-status-hidden")
    display.ShowStatus = 0
    found = blocks(hidden, picture(view, "server-status-none"), "of a hidden one")
    check(len(found) == 1, "a hidden volume's text stays", found)
check(messages.errors() == 0, "drawing reported", messages.text)
os._exit(0)
