# SPDX-License-Identifier: BSD-3-Clause
"""A source that fails, or has something else, in one process of several that write a model of it: all
say so, none waits for ever, and there is no file. Where only the first process has nothing, there is one.
The first argument is "write" in processes that each run all of this, "check" in one."""
import os
import sys

from pvtest import Messages, check, load_plugin, output_file
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersParallelDIY2 import vtkPResampleToImage
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SMALL = (-12, 13, -11, 12, -9, 10)
LARGE = (0, 99, 0, 99, 0, 99)  # 4 MiB: more than is held of it where MemoryLimit is 1
FAILED = "process 1: the source failed"
# What the first process says where the second one fails, or has an array of its own.
NAME = "process 1: the array to be saved is 'another' here and 'RTData' in the first process"
STEPS = "process 1: there are 2 time steps to save here and 3 in the first process"
TOLD = {"nothing": None, "information": FAILED, "extent": "leave gaps", "data": FAILED, "name": NAME,
        "name in pieces": NAME, "steps": STEPS, "first without": None, "resampled": None}


def path_of(request):
    return output_file(f"parallel-failure-{request}.inr")


class Source(VTKPythonAlgorithmBase):
    """Fails when the second process makes the request."""

    def __init__(self, request):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self.request = request if rank == 1 else ""
        self.extent = LARGE if request == "name in pieces" else SMALL
        self.last_has_all = request == "first without"
        self.steps = (3, 2)[rank] if request == "steps" else 0

    def RequestInformation(self, request, inputs, outputs):
        if self.request != "extent":
            info = outputs.GetInformationObject(0)
            info.Set(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT(), self.extent, 6)
            info.Set(self.CAN_PRODUCE_SUB_EXTENT(), 1)
            for step in range(self.steps):
                info.Append(vtkStreamingDemandDrivenPipeline.TIME_STEPS(), float(step))
        return int(self.request != "information")

    def RequestData(self, request, inputs, outputs):
        info = outputs.GetInformationObject(0)
        if self.last_has_all and rank == 0:
            return 1
        wavelet = vtkRTAnalyticSource()
        wavelet.SetWholeExtent(*self.extent)
        asked = info.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT())
        wavelet.UpdateExtent(self.extent if self.last_has_all else asked)
        vtkImageData.GetData(outputs).ShallowCopy(wavelet.GetOutput())
        if self.request.startswith("name"):
            vtkImageData.GetData(outputs).GetPointData().GetScalars().SetName("another")
        return int(self.request != "data")


def resampled():
    """What is resampled in all processes at once, or in none."""
    filter = vtkPResampleToImage()
    wavelet = vtkRTAnalyticSource()
    wavelet.SetWholeExtent(*SMALL)
    filter.SetInputConnection(wavelet.GetOutputPort())
    filter.SetSamplingDimensions(100, 100, 100)
    return filter


load_plugin()
from inrvolume import vtkINRWriter  # noqa: E402  ParaView's Python then knows the writer

if sys.argv[1] == "write":
    controller = vtkMultiProcessController.GetGlobalController()
    rank = controller.GetLocalProcessId()
    for request, told in TOLD.items():
        path = path_of(request)
        if rank == 0 and os.path.exists(path):
            os.remove(path)
        controller.Barrier()
        source = resampled() if request == "resampled" else Source(request)
        writer = vtkINRWriter()
        writer.SetInputConnection(source.GetOutputPort())
        writer.SetFileName(path)
        writer.SetMaximumSteps(5)
        writer.SetMemoryLimit(1 if request in ("name in pieces", "resampled") else 0)
        writer.SetWriteTimeSteps(request == "steps")
        with Messages() as messages:
            wrote = writer.Write()
        check(wrote == int(told is None), rank, "returned", wrote, "for", request)
        if rank == 0:
            check(messages.errors() == 1 - wrote, "told of", request, messages.text)
            check(wrote or told in messages.text, "told of", request, messages.text)
else:
    for request, told in TOLD.items():
        check(os.path.exists(path_of(request)) == (told is None), "the file of", request)
