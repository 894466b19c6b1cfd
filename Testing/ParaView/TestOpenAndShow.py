# SPDX-License-Identifier: BSD-3-Clause
"""Open and Show: the volume appears coloured at once, and looks as ParaView's own volume rendering
of the same voxels does."""
import math
import shutil

import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, Messages, check, check_baseline, load_plugin, look_at
from pvtest import output_file, picture, psnr, show_view

load_plugin()
view = show_view()

with Messages() as messages:
    reader = simple.OpenDataFile(MODEL)
    display = simple.Show(reader, view)
    look_at(view)
    ours = picture(view, "open-and-show")
check(messages.errors() == 0, "showing reported", messages.text)

check(display.Representation == "INR Volume", "shown as", display.Representation)
check(display.ColorArrayName[1] == ARRAY, "coloured by", display.ColorArrayName)
table = simple.GetColorTransferFunction(ARRAY)
low, high = reader.PointData[ARRAY].GetRange()
check((table.RGBPoints[0], table.RGBPoints[-4]) == (low, high), "colours span", table.RGBPoints)
check(np.mean(np.any(ours < 0.99, axis=2)) > 0.2, "the picture is nearly empty")

display.UpdatePropertyInformation()
check(display.GetPropertyValue("FrameTime") > 0, "no frame time")
check(display.GetPropertyValue("BackendInUse").startswith("CPU"), "no backend")
check_baseline(ours, "open-and-show")

# The same voxels as an ordinary array; its name leads to the same two transfer functions.
simple.Hide(reader, view)
decoded = simple.INRDecode(Input=reader)
stock = simple.Show(decoded, view)
stock.SetRepresentationType("Volume")
simple.ColorBy(stock, ("POINTS", ARRAY))
for function in (table, simple.GetOpacityTransferFunction(ARRAY)):
    function.RescaleTransferFunction(low, high)  # ColorBy took the range of the decoded voxels
stock.ScalarOpacityUnitDistance = display.ScalarOpacityUnitDistance
stock.SetScalarBarVisibility(view, False)
theirs = picture(view, "open-and-show-stock")
agreement = psnr(ours, theirs)
print(f"PSNR with ParaView's own volume rendering: {agreement:.2f} dB")
check(agreement >= 40, "PSNR with the stock picture is", agreement)

# Every type of numbers that a model may have had can be chosen.
types = decoded.GetProperty("ScalarType").Available
check(len(types) == 11, "types to decode to:", types)
small = simple.INRDecode(Input=reader, Level=4)
for name in types:
    small.ScalarType = name
    small.UpdatePipeline()
    found = small.PointData[ARRAY].GetDataTypeAsString() if "original" not in name else name
    check(found == name, name, "gives", found)

# Upstream's files are found by the end of their name.
renamed = output_file("les_params.json")
shutil.copy(MODEL, renamed)
check(simple.OpenDataFile(renamed).GetXMLName() == "INRReader", "no reader for", renamed)

# The opacity scale is the volume's, not that of the grid that filters see.
coarse = simple.INRReader(FileName=MODEL, MaximumGridPoints=1000)
coarse_display = simple.Show(coarse, view)
check(coarse.GetDataInformation().GetNumberOfPoints() <= 1000, "the grid is not bounded")
check(
    math.isclose(
        coarse_display.ScalarOpacityUnitDistance, display.ScalarOpacityUnitDistance, rel_tol=1e-6
    ),
    "unit distance follows the grid:", coarse_display.ScalarOpacityUnitDistance,
)
simple.Hide(decoded, view)
same = picture(view, "open-and-show-coarse")
check(psnr(same, ours) > 60, "a coarser presented grid changes the picture", psnr(same, ours))
