# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window, nobody clicking: pictures are refined until they have converged, but not
while an animation plays, a modal dialog is open, a mouse button is down or another view is turned.
GuiRefinement.xml opens the dialog."""
import ctypes
import time

from guisteps import Refinement, begin, follow
from paraview import simple
from pvtest import check

view = begin()
process = ctypes.CDLL(None)
modal_window = process._ZN15QGuiApplication11modalWindowEv
modal_window.restype = ctypes.c_void_p
close = process._ZN7QWindow5closeEv
close.argtypes = [ctypes.c_void_p]
refinement = Refinement(view)
interactor = view.GetRenderWindow().GetInteractor()


def pauses_under_a_dialog():
    while not modal_window():
        yield
    opened = time.time() + 0.5  # what was on its way
    looks = 0
    while time.time() < opened + 2.5:
        looks += 1
        yield
    pictures = refinement.pictures_since(opened)
    print(pictures, "pictures under a dialog that was looked at", looks, "times")
    check(modal_window() and looks > 10, "the dialog was not there, or blocked the window")
    # The window may be drawn once more for having been covered; refinement is many pictures a second.
    check(pictures <= 1, "refined under a dialog")
    close(modal_window())
    while modal_window():
        yield


def pauses_while_a_button_is_down():
    interactor.InvokeEvent("StartInteractionEvent")
    yield from refinement.rests(time.time(), "refined while a button is down")
    interactor.InvokeEvent("EndInteractionEvent")


def pauses_while_another_view_is_turned(name):
    other = simple.CreateView(name)
    simple.AssignViewToLayout(view=other, layout=simple.GetLayout(view))
    simple.Show(simple.Sphere(), other)
    simple.Render(other)
    turned = other.SMProxy.GetRootView() if "Comparative" in name else other.SMProxy
    yield from refinement.wait_for_pictures("beside " + name)
    turned.InteractiveRender()
    start = time.time()
    while time.time() < start + 1.5:
        turned.InteractiveRender()
        yield
    pictures = refinement.pictures_since(start)
    check(pictures == 0, "refined while another view is turned,", name, pictures)
    yield from refinement.wait_for_pictures("after another view was turned")
    simple.Delete(other)
    simple.SetActiveView(view)


def watch():
    """Yields between two looks at the window."""
    yield from pauses_under_a_dialog()
    yield from refinement.wait_for_pictures("after the dialog")
    yield from pauses_while_a_button_is_down()
    yield from refinement.wait_for_pictures("after a click")
    yield from pauses_while_another_view_is_turned("RenderView")
    yield from pauses_while_another_view_is_turned("ComparativeRenderView")
    refinement.selects()
    yield from refinement.wait_for_pictures("after a selection")
    yield from refinement.converges_and_stops()
    refinement.show_endless()
    refinement.pauses_while_an_animation_plays()
    yield from refinement.wait_for_pictures("after the animation")


refinement.show_endless()
follow(watch(), interactor)
