# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window, nobody clicking: pictures are refined until they have converged, but not
while an animation plays, a modal dialog is open or a mouse button is down. GuiRefinement.xml opens
the dialog."""
import ctypes
import time

from paraview import simple
from guisteps import SIZE, begin, follow
from pvtest import MODEL, check, check_baseline, picture

view = begin()
process = ctypes.CDLL(None)
modal_window = process._ZN15QGuiApplication11modalWindowEv
modal_window.restype = ctypes.c_void_p
close = process._ZN7QWindow5closeEv
close.argtypes = [ctypes.c_void_p]
display = simple.Show(simple.OpenDataFile(MODEL), view)
simple.ResetCamera(view)
window = view.GetRenderWindow()
interactor = window.GetInteractor()
pictures = []
window.AddObserver("EndEvent", lambda *_: pictures.append(time.time()))


def pictures_since(start):
    return sum(picture > start for picture in pictures)


def is_converged():
    display.UpdatePropertyInformation()
    return display.GetPropertyValue("Converged") == 1


def show_endless():
    """Never done: as long as this is shown, only the window's being busy stops pictures."""
    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 1000000
    simple.Render(view)
    check(not is_converged(), "a picture that cannot be done has converged")


def refines(occasion):
    start = time.time()
    while pictures_since(start) < 3:
        check(time.time() < start + 20, "not refined", occasion)
        yield


def pauses_under_a_dialog():
    while not modal_window():
        yield
    opened = time.time() + 0.5  # what was on its way
    looks = 0
    while time.time() < opened + 2.5:
        looks += 1
        yield
    print(pictures_since(opened), "pictures under a dialog that was looked at", looks, "times")
    check(modal_window() and looks > 10, "the dialog was not there, or blocked the window")
    # The window may be drawn once more for having been covered; refinement is many pictures a second.
    check(pictures_since(opened) <= 1, "refined under a dialog")
    close(modal_window())
    while modal_window():
        yield


def pauses_while_a_button_is_down():
    interactor.InvokeEvent("StartInteractionEvent")
    start = time.time()
    while time.time() < start + 1.5:
        yield
    check(pictures_since(start) == 0, "refined while a button is down")
    interactor.InvokeEvent("EndInteractionEvent")


def converges_and_stops():
    display.RenderMode = "Ray Marching"
    display.BrickSize = 20
    simple.Render(view)
    start = time.time()
    check(not is_converged(), "a short look is enough for all bricks")
    while not is_converged():
        check(time.time() < start + 60, "does not converge")
        yield
    print("converged after", pictures_since(start), "more pictures")
    check(pictures_since(start) > 0, "nothing was refined")
    converged = time.time() + 0.1
    while time.time() < converged + 1.5:
        yield
    check(pictures_since(converged) == 0, "refined what has converged")
    check_baseline(picture(view, "gui-refinement", SIZE), "GuiRefinement")


def pauses_while_an_animation_plays():
    scene = simple.GetAnimationScene()
    scene.NumberOfFrames = 10
    start = time.time()
    scene.Play()
    # The first time, ParaView shows some frames twice.
    print(pictures_since(start), "pictures in an animation of 10")
    check(10 <= pictures_since(start) <= 14, "refined while playing:", pictures_since(start))


def watch():
    """Yields between two looks at the window."""
    yield from pauses_under_a_dialog()
    yield from refines("after the dialog")
    yield from pauses_while_a_button_is_down()
    yield from refines("after a click")
    yield from converges_and_stops()
    show_endless()
    pauses_while_an_animation_plays()
    yield from refines("after the animation")


display.StillTimeLimit = 0.05
display.SampleDistance = 4
display.MaximumBounces = 1
show_endless()
follow(watch(), interactor)
