# SPDX-License-Identifier: BSD-3-Clause
"""The first look at a volume is the same in processes that are each their own client and know a piece
of it: the unit distance is a twentieth of the whole volume's longest side. Where one of them has another
model, each of them says so, nothing is drawn, and none waits for ever. The first argument is "write" in
processes that each run all of this, "check" in one."""
import math
import sys

from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, output_file, picture, show_view
from vtkmodules.vtkParallelCore import vtkMultiProcessController

# Cut across the longest side: pieces are shorter.
SIZE = (16, 20, 80)
PATH = output_file("parallel-look.inr")

load_plugin()
if sys.argv[1] == "write":
    wavelet = simple.Wavelet(WholeExtent=[end for last in SIZE for end in (0, last)])
    simple.SaveData(PATH, proxy=wavelet, MaximumSteps=20, TimeLimit=0)
reader = simple.OpenDataFile(PATH)
display = simple.Show(reader, simple.CreateRenderView())
check(display.Representation == "INR Volume", "shown as", display.Representation)
bounds = reader.GetDataInformation().GetBounds()
print("unit distance", display.INRUnitDistance, "of a piece within", bounds)
for name in "INRUnitDistance", "ScalarOpacityUnitDistance":
    distance = display.GetPropertyValue(name)
    check(math.isclose(distance, max(SIZE) / 20, rel_tol=1e-9), name, "is", distance)

if sys.argv[1] == "write":
    view = show_view()
    is_first = vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0
    display = simple.Show(simple.OpenDataFile(PATH if is_first else MODEL), view)
    display.SetScalarBarVisibility(view, False)
    with Messages() as messages:
        image = picture(view, "parallel-look")
    check(messages.errors() == 1 and "have different models" in messages.text, "told", messages.text)
    check(image.std() == 0 or not is_first, "something was drawn:", image.std())
