# SPDX-License-Identifier: BSD-3-Clause
"""Renders a model file with VTK alone, no ParaView.

    PYTHONPATH=build/lib/python /usr/bin/python3 Examples/vtk-python/view.py MODEL.inr PICTURE.png

With Debian's Python, which the modules are built for. Without a display put
Testing/with-display.sh in front of it.
"""
import sys

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from inrvolume import vtkINRReader, vtkINRVolumeMapper
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow,
                                         vtkVolume, vtkWindowToImageFilter)

if len(sys.argv) != 3:
    sys.exit(f"usage: {sys.argv[0]} MODEL.inr PICTURE.png")
model_file, picture_file = sys.argv[1:]

reader = vtkINRReader()
reader.SetFileName(model_file)
reader.Update()
if reader.GetOutput().GetNumberOfPoints() == 0:
    sys.exit(f"{model_file} cannot be shown; the message above says why.")
low, high = reader.GetOutput().GetScalarRange()
if not low < high:
    sys.exit(f"{model_file} shows nothing: its values span {low} to {high}")

mapper = vtkINRVolumeMapper()
mapper.SetInputConnection(reader.GetOutputPort())

volume = vtkVolume()
volume.SetMapper(mapper)
colors = vtkColorTransferFunction()
colors.AddRGBPoint(low, 0.1, 0.2, 0.6)
colors.AddRGBPoint(high, 1.0, 0.7, 0.3)
opacity = vtkPiecewiseFunction()
opacity.AddPoint(low, 0.0)
opacity.AddPoint(high, 0.5)
volume.GetProperty().SetColor(colors)
volume.GetProperty().SetScalarOpacity(opacity)
volume.GetProperty().SetScalarOpacityUnitDistance(reader.GetOutput().GetLength() / 100)

renderer = vtkRenderer()
renderer.AddVolume(volume)
renderer.ResetCamera()
renderer.GetActiveCamera().Azimuth(30)
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(600, 600)
window.AddRenderer(renderer)
window.Render()
if not mapper.GetBackendInUse():
    sys.exit("nothing was drawn; the mapper has said why")

capture = vtkWindowToImageFilter()
capture.SetInput(window)
writer = vtkPNGWriter()
writer.SetInputConnection(capture.GetOutputPort())
writer.SetFileName(picture_file)
writer.Write()
if writer.GetErrorCode():
    sys.exit(f"{picture_file} was not written: is there such a folder?")
print(f"{picture_file}: {mapper.GetFrameTime():.2f} s on {mapper.GetBackendInUse()}")
