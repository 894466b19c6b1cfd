# SPDX-License-Identifier: BSD-3-Clause
"""State files: a saved scene comes back as it was, with what the user changed."""
from paraview import simple, smstate
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, look_at, output_file, picture, psnr
from pvtest import show_view

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.SampleDistance = 0.75
display.Backend = "CPU"
display.ScalarOpacityUnitDistance = 3
table = simple.GetColorTransferFunction(ARRAY)
table.RescaleTransferFunction(20, 120)
simple.GetOpacityTransferFunction(ARRAY).RescaleTransferFunction(20, 120)
look_at(view)
before = picture(view, "state-before")
simple.SaveState(output_file("state.pvsm"))

simple.ResetSession()
with Messages() as messages:
    simple.LoadState(output_file("state.pvsm"))
    view = simple.GetActiveView()
    check(len(simple.GetSources()) == 1, "sources:", simple.GetSources())
    (reader,) = simple.GetSources().values()
    display = simple.GetDisplayProperties(reader, view)
    after = picture(view, "state-after")
check(messages.errors() == 0, "loading reported", messages.text)
check(display.Representation == "INR Volume", "came back as", display.Representation)
check(display.SampleDistance == 0.75, "sample distance", display.SampleDistance)
check(display.Backend == "CPU", "backend", display.Backend)
check(display.ScalarOpacityUnitDistance == 3, "unit distance", display.ScalarOpacityUnitDistance)
points = simple.GetColorTransferFunction(ARRAY).RGBPoints
check((points[0], points[-4]) == (20, 120), "colours span", points)
check(psnr(before, after) > 50, "the picture changed:", psnr(before, after))

# A state in Python leaves out what is as the XML says it is by default, and the display's first look
# is not that.
for unit in 1, 4:
    simple.ResetSession()
    view = show_view()
    display = simple.Show(simple.OpenDataFile(MODEL), view)
    display.ScalarOpacityUnitDistance = unit
    text = smstate.get_state()
    simple.ResetSession()
    exec(text, {})
    (reader,) = simple.GetSources().values()
    display = simple.GetDisplayProperties(reader, simple.GetActiveView())
    found = display.ScalarOpacityUnitDistance
    check(found == unit, "a unit distance of", unit, "came back from Python as", found)
