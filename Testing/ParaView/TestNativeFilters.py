# SPDX-License-Identifier: BSD-3-Clause
"""INRSlice and INRContour beside the volume that they are of, and against stock filters on all its
voxels."""
from paraview import servermanager, simple
from pvtest import ARRAY, MODEL, Messages, check, check_baseline, load_plugin, look_at, picture
from pvtest import show_view
from vtkmodules.util.numpy_support import vtk_to_numpy

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
simple.Show(reader, view)
low, high = reader.PointData[ARRAY].GetRange()
bounds = reader.GetDataInformation().GetBounds()


def fetched(filter):
    filter.UpdatePipeline()
    return servermanager.Fetch(filter)


# What a user meets: the plane through the middle, an isovalue in the middle of the range.
with Messages() as messages:
    cut = simple.INRSlice(Input=reader)
    contour = simple.INRContour(Input=reader)
    middle = [(a + b) / 2 for a, b in zip(bounds[0::2], bounds[1::2])]
    check(list(cut.SliceType.Origin) == middle, "the plane starts at", cut.SliceType.Origin)
    check(abs(contour.Isosurfaces[0] - (low + high) / 2) < 1e-3, "offered", contour.Isosurfaces)
    check(fetched(cut).GetNumberOfPoints() == 91 * 91, "points of the default slice")
    check(fetched(contour).GetNumberOfCells() > 0, "the default isosurface is empty")
check(messages.errors() == 0, "the defaults report", messages.text)

# The same surface out of all voxels.
voxels = simple.INRDecode(Input=reader, ScalarType="double")
stock = simple.Contour(Input=voxels, ContourBy=["POINTS", ARRAY])
for isovalues in ([low + 0.3 * (high - low)], [low + 0.2 * (high - low), low + 0.6 * (high - low)]):
    contour.Isosurfaces = stock.Isosurfaces = isovalues
    ours, theirs = fetched(contour), fetched(stock)
    print("triangles:", ours.GetNumberOfCells())
    check(ours.GetNumberOfCells() == theirs.GetNumberOfCells(), "not as many triangles")
    check(ours.GetNumberOfPoints() == theirs.GetNumberOfPoints(), "not as many points")
    found = vtk_to_numpy(ours.GetPointData().GetArray(ARRAY))
    check(sorted(set(found)) == isovalues, "the surfaces' values are", set(found))
contour.SMProxy.UpdatePropertyInformation()
level = contour.SMProxy.GetProperty("LevelInUse").GetElement(0)
check(level == 0, "a small volume is contoured at level", level)

# All in one picture: the slice behind, the surface within the volume.
cut.SliceType.Normal = [0.3, 0.2, 1]
cut.SliceType.Origin = [middle[0], middle[1], bounds[4] + 0.25 * (bounds[5] - bounds[4])]
contour.Isosurfaces = [low + 0.4 * (high - low)]
simple.Show(cut, view)
surface = simple.Show(contour, view)
simple.ColorBy(surface, None)
surface.DiffuseColor = [0.2, 0.7, 0.2]
simple.GetColorTransferFunction(ARRAY).RescaleTransferFunction(low, high)
simple.GetOpacityTransferFunction(ARRAY).RescaleTransferFunction(low, high)
look_at(view)
check_baseline(picture(view, "native-filters"), "native-filters")

with Messages() as messages:
    wavelet = simple.Wavelet()
    simple.INRSlice(Input=wavelet).UpdatePipeline()
check(messages.errors() == 1 and "INRReader" in messages.text, "a slice of a wavelet says", messages.text)
