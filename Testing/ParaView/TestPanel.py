# SPDX-License-Identifier: BSD-3-Clause
"""The first look and the panel: the opacity's length follows the bounds whatever the grid, what the
panel shows under a name of its own is the stock property, and colouring reads no voxels."""
import math

from paraview import servermanager, simple, smstate
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, look_at, output_file, picture
from pvtest import save_and_load, show_view

load_plugin()
view = show_view()


def same(display, distance):
    """The stock property and the panel's have this value."""
    values = display.ScalarOpacityUnitDistance, display.INRUnitDistance
    check(all(math.isclose(v, distance, rel_tol=1e-9) for v in values), values, "not", distance)


def cover(image):
    """How dark the volume is: the mean over its picture of what it hides of the white."""
    seen = (image < 0.98).any(axis=2)
    return float(1 - image[seen].min(axis=1).mean()), float(seen.mean())


# A twentieth of the longest side, for the file as it is and as one that claims far more voxels.
DNS = [10240, 7680, 1536]
for dimensions, grid in ([0, 0, 0], 0), (DNS, 0), ([0, 0, 0], 1000), (DNS, 1000):
    reader = simple.INRReader(FileName=MODEL, Dimensions=dimensions)
    if grid:
        reader.MaximumGridPoints = grid
    display = simple.Show(reader, view)
    bounds = reader.GetDataInformation().GetBounds()
    longest = max(high - low for low, high in zip(bounds[0::2], bounds[1::2]))
    check(longest == max(dimensions[0] - 1, 90), "bounds", bounds)
    same(display, longest / 20)
    if not grid:
        simple.Render(view)
        look_at(view)
        display.LevelOfDetailScale = 4
        darkness, area = cover(picture(view, f"panel-first-look-{dimensions[0]}"))
        print(f"{dimensions}: {area:.2f} of the picture, of which {darkness:.2f} is hidden")
        check(area > 0.1, "the first look is nearly empty")
        check(darkness < 0.8, "the first look is an opaque block", darkness)
    simple.Delete(reader)

# Either name sets the other.
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.INRUnitDistance = 4
same(display, 4)
display.ScalarOpacityUnitDistance = 7
same(display, 7)
display.INRShade = 1
check(display.Shade == 1, "shading is not passed on")
display.Shade = 0
check(display.INRShade == 0, "shading does not come back")
display.INRAmbient, display.INRSpecularPower = 0.25, 20
check((display.Ambient, display.SpecularPower) == (0.25, 20), "light is not passed on")
display.Diffuse, display.Specular = 0.5, 0.125
check((display.INRDiffuse, display.INRSpecular) == (0.5, 0.125), "light does not come back")

# So it does not matter in which order a state file sets them.
display.INRUnitDistance = 3
display.INRShade = 1
script = smstate.get_state()
view, reader, display = save_and_load("panel.pvsm")
same(display, 3)
check((display.Shade, display.INRShade) == (1, 1), "shading is lost")
simple.ResetSession()
exec(script, {})
(reader,) = simple.GetSources().values()
view = simple.GetActiveView()
display = simple.GetDisplayProperties(reader, view)
same(display, 3)
check((display.Shade, display.INRShade) == (1, 1), "shading is lost in a Python state")

# Nobody knows the bounds before there is a file, or in proxies made by hand; volumes are drawn.
reader = simple.INRReader(FileName=output_file("not-there.inr"))
with Messages():
    display = simple.Show(reader, view)
    simple.Render(view)
reader.FileName = MODEL
display.SetRepresentationType("INR Volume")
simple.Render(view)
same(display, 4.5)
simple.Delete(reader)
reader = simple.INRReader(FileName=MODEL)
with Messages() as messages:
    display = servermanager.CreateRepresentation(reader, view)
    display.Representation = "INR Volume"
    simple.Render(view)
check("unit distance" not in messages.text, "made by hand:", messages.text)
simple.Delete(reader)

# A length set before the type of representation stays; ordinary data keep ParaView's default.
for name in "ScalarOpacityUnitDistance", "INRUnitDistance":
    reader = simple.INRReader(FileName=MODEL)
    display = simple.Show(reader, view, "UniformGridRepresentation")
    display.SetRepresentationType("Outline")
    setattr(display, name, 2.5)
    display.SetRepresentationType("INR Volume")
    same(display, 2.5)
    simple.Delete(reader)
wavelet = simple.Wavelet()
stock = simple.Show(wavelet, view)
before = stock.ScalarOpacityUnitDistance
stock.SetRepresentationType("Volume")
check(stock.ScalarOpacityUnitDistance == before, "the plugin changes stock volume rendering")
check(before < 3, "the plugin changes ParaView's default", before)
simple.Delete(wavelet)

# "Restore defaults" gives it ParaView's default and another type of representation. That default is no
# choice, though the grid changes before the volume is shown again.
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
chosen = display.INRUnitDistance
display.SetRepresentationType("Outline")
display.SMProxy.GetProperty("ScalarOpacityUnitDistance").ResetToDomainDefaults()
check(display.INRUnitDistance < chosen / 2, "ParaView's default is", display.INRUnitDistance, "not a cell's")
reader.MaximumGridPoints = 1000
reader.UpdatePipeline()
display.SetRepresentationType("INR Volume")
same(display, chosen)
simple.Delete(reader)

# Nor is it one where a volume is shown as something else at first.
reader = simple.INRReader(FileName=MODEL)
passed = simple.PassArrays(Input=reader, PointDataArrays=[ARRAY])
display = simple.Show(passed, view)
check(display.Representation != "INR Volume", "a filter's output begins as", display.Representation)
reader.MaximumGridPoints = 1000
passed.UpdatePipeline()
display.SetRepresentationType("INR Volume")
same(display, chosen)
simple.Delete(passed)
simple.Delete(reader)

# Nor when a state brings it back.
simple.ResetSession()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.SetRepresentationType("Outline")
display.SMProxy.GetProperty("ScalarOpacityUnitDistance").ResetToDomainDefaults()
view, reader, display = save_and_load("panel-defaults.pvsm")
simple.Render(view)
reader.MaximumGridPoints = 1000
simple.Render(view)
display.SetRepresentationType("INR Volume")
same(display, chosen)
simple.Delete(reader)

# What the panel's names were set to while something else was shown counts when the volume is.
reader = simple.INRReader(FileName=MODEL)
display = simple.Show(reader, view)
display.SetRepresentationType("Surface")
display.INRShade = display.INRUseCropping = 1
display.INRCroppingScale = [0.5, 0.6, 0.7]
display.INRBlendMode = "Isosurface"
display.INRIsosurfaceValues = [50]
display.SetRepresentationType("INR Volume")
found = display.Shade, display.UseCropping, list(display.CroppingScale), list(display.IsosurfaceValues)
check(found == (1, 1, [0.5, 0.6, 0.7], [50]) and display.BlendMode == "Isosurface", "set before:", found,
      display.BlendMode)
simple.Delete(reader)

# Blend modes that the other kind of volume does not offer are not left to it.
reader = simple.INRReader(FileName=MODEL)
display = simple.Show(reader, view)
MAXIMUM, ISOSURFACE, SLICE = 1, 5, 6
for first, then, mode, left in [("INR Volume", "Volume", MAXIMUM, 0),
                                ("INR Volume", "Volume", ISOSURFACE, ISOSURFACE),
                                ("Volume", "INR Volume", SLICE, 0),
                                ("Volume", "INR Volume", ISOSURFACE, ISOSURFACE),
                                ("INR Volume", "Outline", MAXIMUM, MAXIMUM),
                                ("Outline", "INR Volume", MAXIMUM, MAXIMUM)]:
    display.SetRepresentationType(first)
    display.BlendMode = mode
    display.SetRepresentationType(then)
    modes = [servermanager.vtkSMPropertyHelper(display.SMProxy, name).GetAsInt()
             for name in ("BlendMode", "INRBlendMode")]
    check(modes == [left, left], "from", first, "to", then, mode, "becomes", modes)
simple.Delete(reader)

# It is coloured by the array that there is, whatever its name has become.
simple.ResetSession()
view = show_view()
reader = simple.INRReader(FileName=MODEL)
display = simple.Show(reader, view)
simple.Render(view)
look_at(view)
display.SetScalarBarVisibility(view, True)
with Messages() as messages:
    for name in "other", "":
        display.UseSeparateOpacityArray = 1  # of which ParaView dies where it is not there
        reader.ArrayName = name
        shown = picture(view, "panel-array-" + (name or "own"))
        check(tuple(display.ColorArrayName) == ("POINTS", name or ARRAY), display.ColorArrayName)
        check((shown < 0.98).any(axis=2).mean() > 0.1, "nothing is seen of", name)
        bars = [bar.Title for bar in view.Representations
                if bar.GetXMLName() == "ScalarBarWidgetRepresentation" and bar.Visibility]
        check(bars == [name or ARRAY], "legends of", bars)
check(messages.errors() == 0, "another name:", messages.text)
display.SetRepresentationType("Outline")
simple.ColorBy(display, None)
reader.ArrayName = "last"
display.SetRepresentationType("INR Volume")
simple.Render(view)
check(tuple(display.ColorArrayName) == ("POINTS", "last"), "at first:", display.ColorArrayName)
simple.Delete(reader)


def kilobytes(reader):
    """Of decoded values that filters have asked the reader's array for."""
    array = reader.GetClientSideObject().GetOutputDataObject(0).GetPointData().GetArray(0)
    return array.GetActualMemorySize()


# Colours, their range, presets and legend come from the header; the histogram of the colour map
# editor takes its values from the grid that filters see.
simple.ResetSession()
view = show_view()
reader = simple.INRReader(FileName=MODEL, MaximumGridPoints=8000)
display = simple.Show(reader, view)
with Messages() as messages:
    table = simple.GetColorTransferFunction(ARRAY)
    table.RescaleTransferFunction(0, 1)
    display.RescaleTransferFunctionToDataRange()
    low, high = reader.PointData[ARRAY].GetRange()
    check((table.RGBPoints[0], table.RGBPoints[-4]) == (low, high), "range", table.RGBPoints)
    check(table.ApplyPreset("Viridis (matplotlib)", True), "no preset")
    check(table.RGBPoints[-4] == high, "the preset moves the range", table.RGBPoints)
    display.SetScalarBarVisibility(view, True)
    look_at(view)
    simple.Render(view)
    check(kilobytes(reader) <= 1, "colouring has read", kilobytes(reader), "KiB of values")
    histogram = table.SMProxy.ComputeDataHistogramTable(64)
check(messages.errors() == 0, "colouring reported", messages.text)
values = histogram.GetColumnByName("bin_values")
total = sum(values.GetTuple1(k) for k in range(64))
check(histogram.GetNumberOfRows() == 64, "a histogram of", histogram.GetNumberOfRows())
check(0 < total == reader.GetDataInformation().GetNumberOfPoints() <= 8000, "counts", total)

# A setting that volumes of voxels have, and models cannot: one warning, and the same picture.
plain = picture(view, "panel-plain")
with Messages() as messages:
    display.UseSeparateOpacityArray = 1
    same_picture = picture(view, "panel-opacity-array")
check(messages.text.count("separate opacity array") == 1, "not said once:", messages.text)
check((plain == same_picture).all(), "an opacity array changes the picture")
