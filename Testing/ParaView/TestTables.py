# SPDX-License-Identifier: BSD-3-Clause
"""What goes through a volume's values one by one, as tables, statistics and writers of text do, of a small
volume and of one of 4096^3 voxels."""
import os
import shutil

import numpy as np
from paraview import servermanager, simple
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, output_file
from vtkmodules.util.numpy_support import vtk_to_numpy

load_plugin()


def values(source):
    source.UpdatePipeline()
    return vtk_to_numpy(servermanager.Fetch(source).GetPointData().GetArray(ARRAY)).astype(float)


def saved(source, name, **options):
    path = output_file(name)
    if os.path.exists(path):
        os.remove(path)
    simple.SaveData(path, proxy=source, **options)
    return path


def statistics(kind, source):
    """The rows of the model that a filter makes of the values."""
    filter = getattr(simple, kind)(Input=source, ModelInput=None)
    filter.VariablesofInterest = [ARRAY]
    filter.UpdatePipeline()
    blocks = servermanager.Fetch(filter)
    simple.Delete(filter)
    return blocks.GetBlock(0)


def check_tables(name, source):
    truth = values(source)
    step = 1e-5 * (truth.max() - truth.min())
    path = saved(source, f"table-{name}.csv", Precision=7)
    with open(path) as file:
        column = file.readline().replace('"', "").strip().split(",").index(ARRAY)
        rows = np.array([float(line.split(",")[column]) for line in file])
    check(rows.shape == truth.shape and np.abs(rows - truth).max() < step, name, "as csv differs")
    again = simple.OpenDataFile(saved(source, f"table-{name}.vti", DataMode="Ascii"))
    check(np.abs(values(again) - truth).max() < step, name, "as text in a .vti differs")
    primary = statistics("DescriptiveStatistics", source)
    mean = primary.GetColumnByName("Mean").GetValue(0)
    check(abs(mean - truth.mean()) < step, name, "has the mean", mean, "not", truth.mean())
    for kind in ("KMeans", "PrincipalComponentAnalysis", "MulticorrelativeStatistics"):
        check(statistics(kind, source).GetNumberOfRows() > 0, kind, "of", name, "is empty")


def check_over_time():
    again = output_file("table-again.inr")
    shutil.copy(MODEL, again)
    steps = simple.INRReader(FileName=[MODEL, again], MaximumGridPoints=9000)
    over_time = simple.PlotDataOverTime(Input=steps)
    over_time.UpdatePipeline()
    rows = servermanager.Fetch(over_time).GetBlock(0)
    mean = rows.GetColumnByName(f"avg({ARRAY})")
    truth = values(steps).mean()
    check(rows.GetNumberOfRows() == 2, rows.GetNumberOfRows(), "time steps")
    check(np.allclose([mean.GetValue(k) for k in range(2)], truth, rtol=1e-5), "means over time differ")


with Messages() as messages:
    check_tables("small", simple.INRReader(FileName=MODEL, MaximumGridPoints=9000))
    check_tables("large", simple.INRReader(FileName=MODEL, Dimensions=[4096] * 3, MaximumGridPoints=9000))
    check_over_time()
check(messages.errors() == 0, "reported", messages.text)
os._exit(0)
