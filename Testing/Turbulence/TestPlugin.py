# SPDX-License-Identifier: BSD-3-Clause
"""The field as a source in pvpython: a volume of 0.96 TB of which nothing is computed but what is
asked for, and the same bits that the program writes.

    pvpython TestPlugin.py TurbulentChannel.so TURBULENT_CHANNEL FOLDER
"""
import os
import subprocess
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

plugin, program, folder = sys.argv[1:4]
simple.LoadPlugin(plugin, remote=False, ns=globals())


def values(proxy):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPointData().GetArray("velocity"))


huge = TurbulentChannel(Dimensions=[10240, 7680, 1536], OutputScalarType="double")
huge.UpdatePipelineInformation()
part = simple.ExtractSubset(Input=huge, VOI=[0, 99, 7000, 7009, 1535, 1535])
part.UpdatePipeline()
huge.UpdatePropertyInformation()
largest = huge.GetPropertyValue("LargestRequest")
assert largest == 100 * 10 * 8, largest
assert huge.GetPropertyValue("NumberOfRequests") == 1
assert values(part).shape == (1000,) and values(part).dtype == numpy.float64

path = os.path.join(folder, "plugin-test.mhd")
sizes = [60, 20, 15]
subprocess.run([program, *map(str, sizes), path, "--endian", "big", "--seed", "3"], check=True)
small = TurbulentChannel(Dimensions=sizes, Seed=3)
small.UpdatePipeline()
file = simple.OpenDataFile(path)
file.UpdatePipeline()
assert file.GetDataInformation().GetBounds() == small.GetDataInformation().GetBounds()
image = servermanager.Fetch(file)
read = vtk_to_numpy(image.GetPointData().GetArray(0))
assert numpy.array_equal(read, values(small)), "the program and the source differ"

steps = TurbulentChannel(Dimensions=[20, 10, 8], NumberOfTimeSteps=3, TimeStepSize=0.1)
steps.UpdatePipelineInformation()
assert list(steps.TimestepValues) == [0, 0.1, 0.2], steps.TimestepValues
first = values(steps).copy()
steps.UpdatePipeline(0.2)
assert not numpy.array_equal(first, values(steps))
