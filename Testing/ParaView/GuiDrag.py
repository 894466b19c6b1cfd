# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window, while GuiDrag.xml turns the volume by the mouse, edits, undoes and redoes,
and opens and deletes a second volume before its picture is complete: interactive pictures follow the
mouse, nothing is reported, and what is left is the turned volume, complete."""
import time

import numpy as np
from paraview import simple
from guisteps import SIZE, begin, follow
from pvtest import MODEL, Messages, check, check_baseline, picture, psnr

view = begin()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.ScalarOpacityUnitDistance = 1
display.BrickSize = 20
display.StillTimeLimit = 0.02
simple.ResetCamera(view)
simple.Render(view)
window = view.GetRenderWindow()
interactor = window.GetInteractor()
rates = []
window.AddObserver("EndEvent", lambda *_: rates.append(window.GetDesiredUpdateRate()))
start = np.array(view.GetActiveCamera().GetPosition())
messages = Messages()
messages.__enter__()


def sources():
    return len(simple.GetSources())


def is_converged():
    display.UpdatePropertyInformation()
    return display.GetPropertyValue("Converged") == 1


def until(condition, what):
    deadline = time.time() + 40
    while not condition():
        check(time.time() < deadline, "waited in vain until", what)
        yield


def turned():
    return np.linalg.norm(np.array(view.GetActiveCamera().GetPosition()) - start) > 20


def watch():
    """Yields between two looks at the window."""
    yield from until(turned, "the mouse turns the volume")
    yield from until(lambda: sources() == 2, "there is a second volume")
    print(sum(rate > 0.1 for rate in rates), "interactive pictures of", len(rates))
    check(sum(rate > 0.1 for rate in rates) >= 3, "no interactive pictures while the mouse moved")
    yield from until(lambda: sources() == 1, "the second volume is deleted")
    check(display.Representation == "INR Volume", "undone to", display.Representation)
    yield from until(is_converged, "the picture is complete")
    left = picture(view, "gui-drag", SIZE)
    camera = view.GetActiveCamera()
    camera.Azimuth(90)
    other = picture(view, "gui-drag-elsewhere", SIZE)
    camera.Azimuth(-90)
    again = picture(view, "gui-drag-again", SIZE)
    check(left.std() > 0.05, "the volume is gone:", left.std())
    check(psnr(left, again) > 60, "the complete picture was not complete:", psnr(left, again))
    check(psnr(left, other) < 40, "pictures cannot be told apart:", psnr(left, other))
    check_baseline(left, "GuiDrag")
    messages.__exit__()
    check(messages.errors() == 0, "reported:", messages.text)


follow(watch(), interactor)
