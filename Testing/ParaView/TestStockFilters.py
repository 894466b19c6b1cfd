# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's own filters and representations on what INRReader presents, of a small volume and of
one of 4096^3 voxels: no errors, the values of the model, and at most 2 GiB beyond what ParaView
takes with an empty view."""
import numpy as np
from paraview import servermanager, simple
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, picture, show_view
from vtkmodules.util.numpy_support import vtk_to_numpy

LIMIT = 2048  # MiB


def status(key):
    """In MiB, from the kernel's account of this process."""
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith(key))


def forget_peak():
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")


class Volume:
    """A volume, with one of its voxels that the presented grid has a point at."""

    def __init__(self, voxels, voxel, point, **properties):
        self.reader = simple.INRReader(FileName=MODEL, Dimensions=[voxels] * 3, **properties)
        self.reader.UpdatePipeline()
        self.voxels, self.voxel, self.point = voxels, voxel, point
        self.information = self.reader.GetDataInformation()
        self.points = round(self.information.GetNumberOfPoints() ** (1 / 3))
        self.bounds = self.information.GetBounds()
        spacing = (self.bounds[1] - self.bounds[0]) / (voxels - 1)
        self.place = [low + index * spacing for low, index in zip(self.bounds[0::2], voxel)]
        self.low, self.high = self.reader.PointData[ARRAY].GetRange()

    def decoded(self, voxel):
        limits = [limit for index in voxel for limit in (index, index)]
        decode = simple.INRDecode(Input=self.reader, VolumeOfInterest=limits)
        value = values(decode)[0]
        simple.Delete(decode)
        return value


def values(filter, array=ARRAY):
    filter.UpdatePipeline()
    return vtk_to_numpy(servermanager.Fetch(filter).GetPointData().GetArray(array))


def close(volume, value, expected):
    return abs(value - expected) < 1e-4 * (volume.high - volume.low)


def delete(*proxies):
    for proxy in proxies:
        simple.Delete(proxy)


def probe(volume, source, array=ARRAY):
    found = simple.ProbeLocation(Input=source, ProbeType="Fixed Radius Point Source")
    found.ProbeType.Center, found.ProbeType.NumberOfPoints = volume.place, 1
    found.ProbeType.Radius = 0
    value = values(found, array)[0]
    delete(found)
    return value


def check_probe(volume):
    value = probe(volume, volume.reader)
    check(close(volume, value, volume.decoded(volume.voxel)), "probe gives", value)


def check_slice(volume):
    cut = simple.Slice(Input=volume.reader)
    cut.SliceType.Origin, cut.SliceType.Normal = volume.place, [0, 1, 0]
    value = probe(volume, cut)
    check(close(volume, value, volume.decoded(volume.voxel)), "slice gives", value)
    delete(cut)


def check_clip(volume):
    clip = simple.Clip(Input=volume.reader, ClipType="Plane")
    clip.ClipType.Origin, clip.ClipType.Normal = volume.place, [1, 0, 0]
    clip.UpdatePipeline()
    cells = clip.GetDataInformation().GetNumberOfCells()
    kept = volume.points - 1 - volume.point[0] if clip.Invert == 0 else volume.point[0]
    check(cells == kept * (volume.points - 1) ** 2, "clip leaves", cells, "cells")
    delete(clip)


def check_contour(volume):
    contour = simple.Contour(Input=volume.reader, ContourBy=["POINTS", ARRAY])
    contour.Isosurfaces = [volume.decoded(volume.voxel)]
    contour.UpdatePipeline()
    check(contour.GetDataInformation().GetNumberOfCells() > 1000, "hardly any isosurface")
    surface = servermanager.Fetch(contour)
    place = surface.GetPoint(surface.FindPoint(volume.place))
    distance = max(abs(a - b) for a, b in zip(place, volume.place))
    step = (volume.bounds[1] - volume.bounds[0]) / (volume.points - 1)
    check(distance < 0.01 * step, "the isosurface misses its voxel by", distance)
    delete(contour)


def check_line(volume):
    line = simple.PlotOverLine(Input=volume.reader)
    line.Point1, line.Point2 = volume.bounds[0::2], volume.bounds[1::2]
    found = values(line)
    last = volume.voxels - 1
    check(close(volume, found[0], volume.decoded([0, 0, 0])), "the line begins with", found[0])
    check(close(volume, found[-1], volume.decoded([last] * 3)), "the line ends with", found[-1])
    delete(line)


def check_resampling(volume):
    resampled = simple.ResampleToImage(Input=volume.reader, SamplingDimensions=[20, 20, 20])
    first = values(resampled)[0]
    check(close(volume, first, volume.decoded([0, 0, 0])), "resampling begins with", first)
    delete(resampled)


def check_subset(volume):
    subset = simple.ExtractSubset(Input=volume.reader)
    subset.VOI = [limit for index in volume.point for limit in (index, index + 9)]
    first = values(subset)[0]
    check(close(volume, first, volume.decoded(volume.voxel)), "the subset begins with", first)
    delete(subset)


def check_histogram(volume):
    histogram = simple.Histogram(Input=volume.reader, SelectInputArray=["POINTS", ARRAY])
    histogram.UpdatePipeline()
    counts = servermanager.Fetch(histogram).GetRowData().GetArray("bin_values")
    check(vtk_to_numpy(counts).sum() == volume.points**3, "histogram misses points")
    delete(histogram)


def check_calculator(volume):
    calculator = simple.Calculator(Input=volume.reader, Function=f"2*{ARRAY}")
    value = probe(volume, calculator, "Result")
    check(close(volume, value, 2 * volume.decoded(volume.voxel)), "calculator gives", value)
    delete(calculator)


def check_spreadsheet(volume):
    table = simple.CreateView("SpreadSheetView")
    display = simple.Show(volume.reader, table)
    simple.Render(table)
    delete(display, table)


def check_representation(kind):
    def look(volume):
        view = show_view((200, 200))
        display = simple.Show(volume.reader, view)
        display.SetRepresentationType(kind)
        simple.ColorBy(display, ("POINTS", ARRAY))
        view.ResetCamera()
        seen = np.mean(np.any(picture(view, f"stock-{kind}-{volume.voxels}") < 0.98, axis=2))
        check(seen > 0.2, kind, "fills", seen, "of the picture")
        delete(display, view)

    return look


def check_native(volume):
    """The filters for the native field stay within the limit, too."""
    cut = simple.INRSlice(Input=volume.reader)
    cut.SliceType.Origin, cut.SliceType.Normal = volume.place, [1, 1, 1]
    contour = simple.INRContour(Input=volume.reader, Isosurfaces=[volume.decoded(volume.voxel)])
    for native in (cut, contour):
        native.UpdatePipeline()
        check(native.GetDataInformation().GetNumberOfCells() > 1000, native, "gives nothing")
    delete(cut, contour)


LIGHT = {
    "Probe": check_probe,
    "Slice": check_slice,
    "Contour": check_contour,
    "ResampleToImage": check_resampling,
    "ExtractSubset": check_subset,
    "Histogram": check_histogram,
    "Calculator": check_calculator,
    "SpreadSheet": check_spreadsheet,
    "Surface": check_representation("Surface"),
    "Volume": check_representation("Volume"),
    "INRSlice and INRContour": check_native,
}
HEAVY = {"PlotOverLine": check_line, "Clip": check_clip}


def run(checks, volume, before, limit=LIMIT):
    for name, look in checks.items():
        forget_peak()
        with Messages() as messages:
            look(volume)
        peak = status("VmHWM") - before
        print(f"{name} of {volume.voxels}^3 shown as {volume.points}^3: {peak:.0f} MiB", flush=True)
        check(messages.errors() == 0, name, "reports", messages.text)
        check(peak < limit, name, "takes", peak, "MiB")


load_plugin()
empty = show_view()
simple.Render(empty)
idle = status("VmRSS")
forget_peak()
check(status("VmHWM") < idle + 50, "the peak cannot be measured here")

run({**LIGHT, **HEAVY}, Volume(91, [30, 45, 60], [30, 45, 60]), idle)
# 4095 native steps are 255 of the presented grid: 273 are 17.
huge = Volume(4096, [1365, 1911, 2730], [85, 119, 170])
check(huge.points == 256, "presented are", huge.points)
run(LIGHT, huge, idle)
# What these take grows as the number of points does: with fewer of them, the limit is lower.
coarse = Volume(4096, [1365, 1890, 2730], [52, 72, 104], MaximumGridPoints=157**3)
run(HEAVY, coarse, status("VmRSS"), LIMIT * 157**3 / 2**24)
