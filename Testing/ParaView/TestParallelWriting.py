# SPDX-License-Identifier: BSD-3-Clause
"""Processes of pvbatch that hold a piece of the data each train one model of all of it. What the
file says of its quality is checked by the first argument's other run: "write" in several processes,
"check" in one."""
import os
import sys

import numpy as np
from paraview import servermanager, simple
from pvtest import Messages, check, load_plugin, output_file
from vtkmodules.util.numpy_support import vtk_to_numpy

STEPS = 60
EXTENT = [-12, 13, -11, 12, -9, 10]
NAMES = ["parallel-1.inr", "parallel-2.inr"]
DIRECT = "parallel-3.inr"


def wavelet():
    return simple.Wavelet(WholeExtent=EXTENT)


def values(proxy):
    data = servermanager.Fetch(proxy)
    return data, vtk_to_numpy(data.GetPointData().GetScalars()).astype(float)


load_plugin()
import inrvolume  # noqa: E402  ParaView's Python then knows the writer

if sys.argv[1] == "write":
    source = wavelet()
    if os.path.exists(output_file(DIRECT)):
        os.remove(output_file(DIRECT))
    for name in NAMES:  # the second time the source has been updated
        if os.path.exists(output_file(name)):
            os.remove(output_file(name))
        with Messages() as messages:
            simple.SaveData(output_file(name), source, Scalars=["POINTS", "RTData"], TimeLimit=0,
                            MaximumSteps=STEPS)
        check(messages.errors() == 0, "saving reported", messages.text)
        check(os.path.exists(output_file(name)), "no file", name)
    # Without SaveData, which has updated the source by then.
    with Messages() as messages:
        writer = servermanager.writers.INRWriter(Input=wavelet(), FileName=output_file(DIRECT),
                                                 TimeLimit=0, MaximumSteps=STEPS)
        writer.UpdatePipeline()
    check(messages.errors() == 0, "the writer reported", messages.text)
    told = writer.GetClientSideObject()
    check(isinstance(told, inrvolume.vtkINRWriter), "written by", told)
    took = told.GetTrainingSeconds(), told.GetExchangeSeconds(), told.GetWaitingSeconds()
    check(took[1] > 0 and took[2] > 0 and sum(took[1:]) < took[0], "times", took)
    # What fails in one, fails in all, and nobody waits for ever.
    with Messages() as messages:
        try:
            simple.SaveData("/no/such/folder/model.inr", source, MaximumSteps=STEPS)
        except RuntimeError:
            pass
    check("No such file" in messages.text, "the error is not told:", messages.text)
else:
    image, truth = values(wavelet())
    models = []
    for name in [*NAMES, DIRECT]:
        reader = simple.OpenDataFile(output_file(name))
        decoded, found = values(simple.INRDecode(Input=reader))
        check(decoded.GetBounds() == image.GetBounds(), decoded.GetBounds(), image.GetBounds())
        told = servermanager.Fetch(reader).GetFieldData()
        psnr = -10 * np.log10(np.mean((found - truth) ** 2) / np.ptp(truth) ** 2)
        quality = told.GetArray("INRPSNR").GetValue(0)
        print(name, "has", psnr, "dB and says", quality)
        check(abs(psnr - quality) < 0.01, "quality", psnr, quality)
        check(psnr > 20, "quality", psnr)
        models.append(found)
    for other in models[1:]:
        check(np.array_equal(models[0], other), "the same training gave two models")
    os._exit(0)
