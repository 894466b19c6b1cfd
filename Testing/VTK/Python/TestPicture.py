# SPDX-License-Identifier: BSD-3-Clause
"""The picture that PyVista is compared with (Testing/Wheel) is the one that VTK draws here.

    TestPicture.py BASELINE FOLDER
"""
import os
import sys

import numpy as np
import torus_scene as scene
from similarity import ssim
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from inrvolume import vtkINRReader, vtkINRVolumeMapper, vtkINRWriter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow,
                                         vtkVolume, vtkWindowToImageFilter)

baseline_file, folder = sys.argv[1:]


def pixels(image):
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)


image = vtkImageData()
image.SetDimensions(scene.field().shape)
image.SetSpacing(scene.SPACING)
image.GetPointData().SetScalars(numpy_to_vtk(scene.field().ravel(order="F"), deep=True))
model_file = os.path.join(folder, "picture.inr")
scene.train(vtkINRWriter(), image, model_file)

reader = vtkINRReader()
reader.SetFileName(model_file)
reader.Update()
mapper = vtkINRVolumeMapper()
mapper.SetInputConnection(reader.GetOutputPort())

volume = vtkVolume()
volume.SetMapper(mapper)
colors = vtkColorTransferFunction()
opacities = vtkPiecewiseFunction()
values = np.linspace(*reader.GetOutput().GetScalarRange(), len(scene.COLORS))
for value, color, opacity in zip(values, scene.COLORS, scene.OPACITIES):
    colors.AddRGBPoint(value, *scene.rgb(color))
    opacities.AddPoint(value, opacity / 255)
volume.GetProperty().SetColor(colors)
volume.GetProperty().SetScalarOpacity(opacities)
volume.GetProperty().SetScalarOpacityUnitDistance(scene.UNIT)
volume.GetProperty().SetInterpolationTypeToLinear()

renderer = vtkRenderer()
renderer.SetBackground(scene.BACKGROUND)
renderer.AddVolume(volume)
camera = renderer.GetActiveCamera()
camera.SetPosition(scene.POSITION)
camera.SetFocalPoint(scene.FOCUS)
camera.SetViewUp(scene.UP)
renderer.ResetCameraClippingRange()
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(scene.SIZE)
window.AddRenderer(renderer)
window.Render()
capture = vtkWindowToImageFilter()
capture.SetInput(window)
writer = vtkPNGWriter()
writer.SetInputConnection(capture.GetOutputPort())
writer.SetFileName(os.path.join(folder, "picture.png"))
writer.Write()

reference = vtkPNGReader()
reference.SetFileName(baseline_file)
reference.Update()
similarity = ssim(pixels(capture.GetOutput()), pixels(reference.GetOutput()))
print(f"SSIM with {baseline_file}: {similarity:.4f}")
assert similarity > 0.99, similarity
