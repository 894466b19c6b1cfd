# SPDX-License-Identifier: BSD-3-Clause
"""Compresses a volume into an INR, opens the file, renders both. Run by quickstart.sh:

    pvpython quickstart.py PLUGIN VOLUME.vti OUTPUT_DIR SECONDS
"""
import json
import os
import sys
import time

import inrvolume  # lets Python see our classes' own methods
import numpy as np
from paraview.simple import *  # ParaView's own idiom
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkImageAppend
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter

plugin, volume_file, output, seconds = sys.argv[1:5]
os.makedirs(output, exist_ok=True)
LoadPlugin(os.path.abspath(plugin), remote=False, ns=globals())


def path(name):
    return os.path.join(output, name)


def train(volume):
    """Save Data as .inr; shows the writer's progress and returns the writer with its figures."""
    writer = CreateWriter(path("model.inr"), volume, TimeLimit=float(seconds))
    trainer = writer.SMProxy.GetClientSideObject()
    shown = [0.0]

    def show(*_event):
        text = trainer.GetProgressText()  # none at the very beginning
        if text and time.time() - shown[0] > 1:
            shown[0] = time.time()
            print(f"   {text}: {100 * trainer.GetProgress():3.0f} %", flush=True)

    trainer.AddObserver("ProgressEvent", show)
    writer.UpdatePipeline()
    if trainer.GetErrorCode():
        sys.exit(f"{path('model.inr')} was not written; the message above says why.")
    return trainer


def look_at(view):
    view.ViewSize = [768, 768]
    view.OrientationAxesVisibility = 0
    camera = view.GetActiveCamera()
    camera.SetPosition(540, 380, -420)
    camera.SetFocalPoint(127.5, 127.5, 127.5)
    camera.SetViewUp(0, 1, 0)
    view.ResetCamera()


def colour(array):
    """The mixing fluids transparent, the layer between them as thin coloured shells."""
    GetColorTransferFunction(array).RGBPoints = [
        3, 0.02, 0.05, 0.25, 60, 0.1, 0.45, 0.8, 117, 0.85, 0.85, 0.8,
        174, 0.95, 0.55, 0.15, 230, 0.5, 0.03, 0.05]
    GetOpacityTransferFunction(array).Points = [
        3, 0, 0.5, 0, 40, 0, 0.5, 0, 75, 0.06, 0.5, 0, 120, 0.01, 0.5, 0,
        165, 0.12, 0.5, 0, 205, 0.02, 0.5, 0, 225, 0, 0.5, 0, 230, 0, 0.5, 0]


def render(source, representation, name):
    view = CreateRenderView()
    shown = Show(source, view)
    shown.SetRepresentationType(representation)
    array = source.PointData[0].Name
    ColorBy(shown, ("POINTS", array))
    colour(array)
    for distance in ("ScalarOpacityUnitDistance", "INRUnitDistance"):
        if distance in shown.ListProperties():
            setattr(shown, distance, 2.0)
    shown.SetScalarBarVisibility(view, False)
    look_at(view)
    SaveScreenshot(path(name), view, TransparentBackground=1)
    Delete(view)


def read_png(name):
    reader = vtkPNGReader()
    reader.SetFileName(path(name))
    reader.Update()
    return reader.GetOutput()


def premultiplied(name):
    """Linear premultiplied RGBA in [0, 1]; ParaView's PNGs hold straight colours."""
    rgba = vtk_to_numpy(read_png(name).GetPointData().GetScalars()) / 255.0
    rgba[:, :3] *= rgba[:, 3:]
    return rgba


def image_psnr(a, b):
    """In dB, peak 1, over the pixels that either picture covers."""
    covered = (a[:, 3] > 0) | (b[:, 3] > 0)
    return float(-10 * np.log10(np.mean((a[covered] - b[covered]) ** 2)))


def side_by_side(left, right, name):
    append = vtkImageAppend()
    append.SetAppendAxis(0)
    for part in (left, right):
        append.AddInputData(read_png(part))
    writer = vtkPNGWriter()
    writer.SetInputConnection(append.GetOutputPort())
    writer.SetFileName(path(name))
    writer.Write()


volume = OpenDataFile(volume_file)
volume.UpdatePipeline()
low, high = volume.PointData[0].GetRange()
print(f"   {volume_file}: {volume.GetDataInformation().GetNumberOfPoints():,} voxels")
trainer = train(volume)

model = OpenDataFile(path("model.inr"))
model.UpdatePipeline()
print("   Rendering the original and the model")
render(volume, "Volume", "original.png")
render(model, "INR Volume", "inr.png")
side_by_side("original.png", "inr.png", "side-by-side.png")

report = {
    "psnr": trainer.GetPSNR(),
    "ssim": trainer.GetSSIM(),
    "max_error": trainer.GetMaximumError(),
    "ratio": trainer.GetRatio(),
    "train_seconds": trainer.GetTrainingSeconds(),
    "image_psnr": image_psnr(premultiplied("original.png"), premultiplied("inr.png")),
}
with open(path("report.json"), "w") as file:
    json.dump(report, file, indent=2)

print(f"""
The model file is {report['ratio']:.0f} times smaller than the volume, after {report['train_seconds']:.0f} s of training.
   volume:  PSNR {report['psnr']:.1f} dB, SSIM {report['ssim']:.4f}, largest error {report['max_error']:.0f} of {high - low:.0f}
   picture: PSNR {report['image_psnr']:.1f} dB against ParaView's rendering of the original
Look at {path('side-by-side.png')} (original left, model right); the figures are in {path('report.json')}.
Next: open {path('model.inr')} in ParaView's window, see README.md.""")
