# SPDX-License-Identifier: BSD-3-Clause
"""Where addresses are limited (ulimit -v), filters that get none say so, and the process lives on."""
import ctypes
import os
import resource
import tempfile

# Threads that come late would have no room for a stack.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import numpy as np  # noqa: E402
from inrvolume import (vtkINRContour, vtkINRDecode, vtkINRReader, vtkINRSlice,  # noqa: E402
                       vtkINRWriter)
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: E402

EDGE = 40
M_MMAP_THRESHOLD = -3
# What is freed is no longer there: else the allocator keeps it, and needs no addresses.
assert ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, 65536) == 1


def train(path):
    axis = np.linspace(-1, 1, EDGE)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    image = vtkImageData()
    image.SetDimensions(EDGE, EDGE, EDGE)
    image.GetPointData().SetScalars(numpy_to_vtk(np.sqrt(x * x + y * y + z * z).ravel(), deep=True))
    writer = vtkINRWriter()
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.SetMaximumSteps(50)
    writer.Write()


def addresses():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")


class Limited:
    """So many bytes more than there are."""

    def __init__(self, more):
        self.more = more

    def __enter__(self):
        self.before = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (addresses() + self.more, self.before[1]))

    def __exit__(self, *problem):
        resource.setrlimit(resource.RLIMIT_AS, self.before)


def update(algorithm):
    problems = []
    tag = algorithm.AddObserver("ErrorEvent", lambda *_: problems.append(1))
    algorithm.Update()
    algorithm.RemoveObserver(tag)
    return algorithm.GetOutput().GetNumberOfPoints(), len(problems)


with tempfile.TemporaryDirectory() as folder:
    file = os.path.join(folder, "model.inr")
    train(file)
    reader = vtkINRReader()
    reader.SetFileName(file)
    reader.SetScaleFactor(4)
    for create in (vtkINRDecode, vtkINRContour, vtkINRSlice):
        algorithm = create()
        algorithm.SetInputConnection(reader.GetOutputPort())
        if create is vtkINRContour:
            algorithm.SetValue(0, 0.7)
            algorithm.SetLevel(0)
        points, problems = update(algorithm)  # its threads, and what VTK keeps, are there from now on
        assert points > 0 and problems == 0, (create, points, problems)
        refused = 0
        for mebibytes in (0, 1, 2, 4, 8, 16):
            algorithm.Modified()
            algorithm.GetOutput().Initialize()
            with Limited(mebibytes << 20):
                some, problems = update(algorithm)
            assert (some, problems) in ((0, 1), (points, 0)), (create, mebibytes, some, problems)
            refused += problems
        print(create.__name__, points, "points, refused", refused, "times")
        assert refused > 0 or create is vtkINRSlice, create
        algorithm.Modified()
        assert update(algorithm) == (points, 0), create
