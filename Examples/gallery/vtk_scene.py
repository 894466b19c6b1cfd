# SPDX-License-Identifier: BSD-3-Clause
"""What the gallery's scripts that use VTK directly share: the volume rm_mixing, its camera, and
pictures with captions. Needs Pillow and, as PYTHONPATH, build/lib/python."""
import numpy as np
from inrvolume import vtkINRReader, vtkINRVolumeMapper
from PIL import Image, ImageFont
from scene import FLAME, MIXING, model_file
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow,
                                         vtkVolume, vtkWindowToImageFilter)

BACKGROUND = (0.06, 0.07, 0.1)


def font(size):
    return ImageFont.truetype("DejaVuSans.ttf", size)


def make_volume(models, scale=1):
    """The volume, `scale` times its voxels along each axis, as its mapper draws it by default."""
    reader = vtkINRReader()
    reader.SetScaleFactor(scale)
    reader.SetFileName(model_file(models, "rm_mixing"))
    reader.Update()
    low, high = reader.GetOutput().GetScalarRange()
    bounds = reader.GetOutput().GetBounds()
    mapper = vtkINRVolumeMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    mapper.SetAmbientLight(0.9, 0.95, 1.0)
    colours, opacities = vtkColorTransferFunction(), vtkPiecewiseFunction()
    colours.SetColorSpaceToLab()
    for part, *rgb in FLAME:
        colours.AddRGBPoint(low + part * (high - low), *rgb)
    for part, alpha in MIXING:
        opacities.AddPoint(low + part * (high - low), alpha)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(colours)
    volume.GetProperty().SetScalarOpacity(opacities)
    volume.GetProperty().SetScalarOpacityUnitDistance((bounds[1] - bounds[0]) / 50)
    return volume


def make_window(volume, size):
    renderer = vtkRenderer()
    renderer.SetBackground(*BACKGROUND)
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(-1, 0, 0)
    camera.SetViewUp(0, 0, 1)
    camera.Azimuth(35)
    camera.Elevation(25)
    camera.OrthogonalizeViewUp()
    renderer.ResetCamera()
    camera.Zoom(1.25)
    window = vtkRenderWindow()
    window.SetSize(size, size)
    window.AddRenderer(renderer)
    return window


def captured(window):
    """What the window shows, top row first."""
    capture = vtkWindowToImageFilter()
    capture.SetInput(window)
    capture.ReadFrontBufferOff()
    capture.ShouldRerenderOff()
    capture.Update()
    width, height = window.GetSize()
    rows = vtk_to_numpy(capture.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)
    return Image.fromarray(np.ascontiguousarray(rows[::-1]))
