# SPDX-License-Identifier: BSD-3-Clause
"""Save, open and decode a volume with the Python package, and see it in NumPy."""
import os
import tempfile

import inrvolume
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

x, y, z = numpy.meshgrid(*(numpy.linspace(0, 1, n) for n in (18, 20, 22)), indexing="ij")
truth = (10 * x * x + 3 * y - 2 * z).astype(numpy.float32)

image = vtkImageData()
image.SetDimensions(truth.shape)
image.SetSpacing(1, 2, 3)
array = numpy_to_vtk(truth.ravel(order="F"), deep=True)
array.SetName("field")
image.GetPointData().SetScalars(array)

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "field.inr")
    writer = inrvolume.vtkINRWriter()
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.SetMaximumSteps(100)
    writer.SetTargetRatio(1)
    assert writer.Write() == 1
    assert writer.GetPSNR() > 30, writer.GetPSNR()

    reader = inrvolume.vtkINRReader()
    assert reader.CanReadFile(path) and not reader.CanReadFile(__file__)
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetNativeDimensions() == truth.shape, reader.GetNativeDimensions()
    assert reader.GetNativeSpacing() == (1, 2, 3)
    assert reader.GetPSNR() == writer.GetPSNR()
    assert reader.GetRatio() == writer.GetRatio()
    virtual = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())

    decode = inrvolume.vtkINRDecode()
    decode.SetInputConnection(reader.GetOutputPort())
    decode.Update()
    voxels = vtk_to_numpy(decode.GetOutput().GetPointData().GetScalars())

# NumPy's own measure of what the file promises.
error = voxels.astype(float) - truth.ravel(order="F")
psnr = 10 * numpy.log10(float(numpy.ptp(truth)) ** 2 / numpy.mean(error**2))
assert abs(psnr - writer.GetPSNR()) < 0.01, (psnr, writer.GetPSNR())
assert abs(abs(error).max() - writer.GetMaximumError()) < 1e-4 * numpy.ptp(truth)
assert numpy.allclose(virtual, voxels, atol=1e-4)
