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



def looks_alike(view, name, expected):
    """What the first process saves; the others take part. The sphere's pieces meet in some pixels."""
    others = (abs(picture(view, name) - expected) > 0.02).mean()
    check(not IS_FIRST or others < 1e-3, name, "differs in a part of", others)


def told_of(path, view, sphere):
    """A stale copy, as it were, in all processes but the first: of another size, or of the same."""
    reader = simple.OpenDataFile(PATH if IS_FIRST else path)
    display = simple.Show(reader, view)
    display.SetScalarBarVisibility(view, False)
    with Messages() as messages:
        looks_alike(view, "parallel-look", sphere)
    check(messages.errors() == 1 and "have different models" in messages.text, "told", messages.text)
    return reader


if sys.argv[1] == "write":
    IS_FIRST = vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0
    OTHER = output_file("parallel-look-stale.inr")
    simple.SaveData(OTHER, proxy=wavelet, MaximumSteps=21, TimeLimit=0)
    view = show_view()
    view.UseFXAA = 0
    ball = simple.Show(simple.Sphere(Center=[8, 10, 40], Radius=12), view)
    ball.Opacity = 0.5
    simple.ResetCamera(view)
    sphere = picture(view, "parallel-look-sphere")
    check(not IS_FIRST or sphere.std() > 0.05, "there is no sphere")
    for path in MODEL, OTHER:
        simple.Delete(told_of(path, view, sphere))
    simple.Show(simple.OpenDataFile(PATH), view).SetScalarBarVisibility(view, False)
    same = picture(view, "parallel-look-same")
    check(not IS_FIRST or abs(same - sphere).max() > 0.1, "nothing is drawn of what is the same")
