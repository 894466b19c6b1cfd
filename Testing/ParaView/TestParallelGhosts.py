# SPDX-License-Identifier: BSD-3-Clause
"""What processes of pvbatch find and draw of the pieces that they have of a volume is what one finds and
draws, also after a filter has asked for pieces with ghost cells. The first argument is "write" in several
processes, "check" in one."""
import json
import os
import sys

from paraview import servermanager, simple
from pvtest import (ARRAY, MODEL, check, check_same, load_plugin, output_file, picture, read_png,
                    show_balls, show_model)

FOUND = output_file("parallel-ghosts.json")
PICTURE = "parallel-ghosts-{}"


def integrals(source, size):
    data = servermanager.Fetch(simple.IntegrateVariables(Input=source))
    arrays = data.GetCellData().GetArray(size), data.GetPointData().GetArray(ARRAY)
    return [array.GetValue(0) for array in arrays]


def numbers(source):
    """By name, what adds up or counts."""
    contour = simple.Contour(Input=source, ContourBy=["POINTS", ARRAY], Isosurfaces=[60.0],
                             ComputeNormals=0)
    histogram = simple.Histogram(Input=source, SelectInputArray=["POINTS", ARRAY])
    bins = servermanager.Fetch(histogram).GetRowData().GetArray("bin_values")
    volume, integral = integrals(source, "Volume")
    area, integral_on_it = integrals(contour, "Area")
    return {"volume": volume, "integral": integral, "area": area, "integral on it": integral_on_it,
            "histogram": [bins.GetValue(k) for k in range(bins.GetNumberOfTuples())]}


def cells(source):
    """Of the first process' piece, with ghost cells."""
    return source.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells()


def find():
    """The numbers before and after a filter has asked for ghost cells, and how many came."""
    reader = simple.OpenDataFile(MODEL)
    reader.UpdatePipeline()
    own = cells(reader)
    before = numbers(reader)
    simple.Gradient(Input=reader, ScalarArray=["POINTS", ARRAY]).UpdatePipeline()
    return before, numbers(reader), cells(reader) - own


def draw(where):
    """Among surfaces, one of them translucent, which are shared out among the pieces."""
    view, display = show_model((160, 130))
    show_balls(view)[0].Opacity = 0.5
    simple.Gradient(Input=display.Input, ScalarArray=["POINTS", ARRAY]).UpdatePipeline()
    return picture(view, PICTURE.format(where))


def near(a, b):
    return abs(a - b) <= 1e-9 * abs(b)


load_plugin()
if sys.argv[1] == "write":
    with open(FOUND, "w") as file:
        json.dump(find(), file)
    draw("batch")
else:
    with open(FOUND) as file:
        before, after, ghosts = json.load(file)
    check(ghosts > 0, "the processes had no ghost cells")
    truth = find()[0]
    # Points where pieces meet belong to both, in VTK's histograms as well.
    check(before["histogram"] == after["histogram"], "histograms", before, after)
    for name in ("volume", "integral", "area", "integral on it"):
        print(name, before[name], after[name], truth[name])
        check(near(before[name], truth[name]), name, before[name], truth[name])
        check(near(after[name], truth[name]), name, after[name], truth[name])
    expected = draw("alone")
    check(expected.std() > 0.03, "the picture shows nothing")
    found = read_png(output_file(PICTURE.format("batch") + ".png"))
    check_same({"picture": found}, {"picture": expected}, ["picture"])
    os._exit(0)
