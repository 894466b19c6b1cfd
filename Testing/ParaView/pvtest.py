# SPDX-License-Identifier: BSD-3-Clause
"""What the pvpython tests share. Places come from the environment that CMakeLists.txt sets:
INR_PLUGIN (the plugin's .so), INR_DATA (Testing/Data), INR_BASELINES (Testing/Baselines) and
INR_OUTPUT (a folder for what a test writes)."""
import os
import sys

import numpy as np
from paraview import simple
from similarity import BASELINE_FLOOR, ssim
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

OUTPUT = os.environ["INR_OUTPUT"]
# Trained by TestSaveData.py, used by the tests that follow it.
MODEL = os.path.join(OUTPUT, "les_wmag91.inr")
ARRAY = "wmag"


def load_plugin():
    simple.LoadPlugin(os.environ["INR_PLUGIN"], remote=False, ns=vars(simple))
    simple._DisableFirstRenderCameraReset()


def data_file(name):
    return os.path.join(os.environ["INR_DATA"], name)


def output_file(name):
    return os.path.join(OUTPUT, name)


class Messages:
    """Collects what VTK and ParaView report while the block runs."""

    def __enter__(self):
        self.window = vtkStringOutputWindow()
        self.previous = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *unused):
        self.text = self.window.GetOutput() or ""
        vtkOutputWindow.SetInstance(self.previous)
        sys.stdout.write(self.text)

    def errors(self):
        return self.text.count("ERROR: ")


def show_view(size=(300, 300)):
    """A render view without decoration, white like paper."""
    view = simple.CreateView("RenderView")
    without_decoration(view, size)
    simple.SetActiveView(view)
    return view


def without_decoration(view, size=(300, 300)):
    view.ViewSize = list(size)
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]


def show_model(size=(300, 300)):
    """The trained model alone in a view that smooths no edges, seen by look_at(): view and display. A
    connected server draws it."""
    view = show_view(size)
    view.UseFXAA = 0
    view.RemoteRenderThreshold = 0
    display = simple.Show(simple.OpenDataFile(MODEL), view)
    display.SetScalarBarVisibility(view, False)
    look_at(view)
    return view, display


def show_ball(view, center, radius):
    """A smooth one, opaque; its display."""
    ball = simple.Sphere(Center=center, Radius=radius, ThetaResolution=40, PhiResolution=40)
    return simple.Show(ball, view)


def show_balls(view):
    """Around and in the model, some of each in one process' piece and some in another's; displays."""
    balls = []
    for center, radius in (([20, 30, 70], 16), ([45, 45, 20], 12), ([75, 60, 50], 20)):
        balls.append(show_ball(view, center, radius))
        balls[-1].DiffuseColor = [0.2, 0.6, 0.9]
    return balls


def connect(*place):
    """To the servers at port `place`, or of data and of rendering at two, with the plugin there, too."""
    simple.Connect(*(item for port in place for item in ("localhost", int(port))))
    simple.LoadPlugin(os.environ["INR_PLUGIN"], remote=True, ns=vars(simple))
    load_plugin()


def save_and_load(name):
    """Ends the session and brings it back from a state file of that name. The view, the reader and its
    display, of each of which there is one."""
    path = output_file(name)
    simple.SaveState(path)
    simple.ResetSession()
    simple.LoadState(path)
    view = simple.GetActiveView()
    (reader,) = simple.GetSources().values()
    return view, reader, simple.GetDisplayProperties(reader, view)


def look_at(view):
    """One slanted camera for all pictures."""
    view.ResetActiveCameraToPositiveX()
    view.ResetCamera()
    camera = view.GetActiveCamera()
    camera.Azimuth(35)
    camera.Elevation(25)
    camera.OrthogonalizeViewUp()
    view.ResetCamera()


def check_interactive(view, display):
    """Pictures come while the mouse moves, too."""
    for step in range(5):
        view.GetActiveCamera().Azimuth(4)
        view.SMProxy.InteractiveRender()
    display.UpdatePropertyInformation()
    check(display.GetPropertyValue("FrameTime") > 0, "no picture while the mouse moves")


def picture(view, name, size=None):
    """Renders, at the view's size or (width, height), saves `name`.png beside the other outputs and
    returns RGB in [0, 1], (h, w, 3)."""
    path = output_file(name + ".png")
    simple.SaveScreenshot(path, view, ImageResolution=list(size or view.ViewSize))
    return read_png(path)


def read_png(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[..., :3] / 255.0


def psnr(a, b):
    """dB, peak 1, over the pixels where either picture shows something other than white; of nothing, NaN."""
    seen = np.any((a < 1) | (b < 1), axis=2)
    return -10 * np.log10(max(np.mean((a[seen] - b[seen]) ** 2), 1e-12))


def check(condition, *told):
    if not condition:
        sys.stdout.flush()
        # Not to sys.stderr, which is among the messages while these are collected.
        os.write(2, ("FAILED: " + " ".join(str(item) for item in told) + "\n").encode())
        os._exit(1)  # sys.exit() crashes ParaView 5.11 once it has a window


def check_same(found, expected, composed, part=1e-3):
    """What a server has drawn is what this process has, name by name. Those `composed` of pieces, each
    in 8 bits, may be off by 4 of 255, this part of them by more than 2."""
    for name, image in expected.items():
        difference = 255 * np.abs(found[name] - image)
        print(f"{name}: largest {difference.max():.0f} of 255, mean {difference.mean():.3f},",
              f"{np.sum(difference > 2.5)} above 2")
    for name, image in expected.items():
        difference = 255 * np.abs(found[name] - image)
        few = part if name in composed else 0
        check(difference.max() < (4.5 if few else 2.5), name, "differs")
        check(np.mean(difference > 2.5) <= few, name, "differs")


def check_baseline(image, name):
    """The picture resembles the committed one."""
    path = os.path.join(os.environ["INR_BASELINES"], "ParaView", name + ".png")
    check(os.path.exists(path), "no baseline", path)
    baseline = read_png(path)
    check(baseline.shape == image.shape, "sizes differ", baseline.shape, image.shape)
    similarity = ssim(image, baseline)
    print(f"{name}: SSIM with baseline {similarity:.4f}")
    check(similarity >= BASELINE_FLOOR, name, "has SSIM", similarity, "with its baseline")
