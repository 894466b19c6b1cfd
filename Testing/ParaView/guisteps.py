# SPDX-License-Identifier: BSD-3-Clause
"""A test's own steps while ParaView's window goes on."""
import os
import sys
import time

from paraview import simple
from pvtest import MODEL, check, check_baseline, load_plugin, picture

SIZE = (300, 300)  # of pictures, whatever the window's
SHORT = 0.05  # seconds for a still picture, so that the window has several to show


def begin():
    """The window's view, with the plugin; what is printed goes to the terminal, not to the window's
    Python shell."""
    sys.stdout = os.fdopen(1, "w", buffering=1, closefd=False)
    sys.stderr = os.fdopen(2, "w", closefd=False)
    load_plugin()
    return simple.GetActiveViewOrCreate("RenderView")


def follow(steps, interactor):
    """Goes on with the generator `steps` by a timer of the window, every 50 ms, and ends the program
    with them: well where they end, badly where one raises."""

    def look(*_):
        if steps.gi_running:
            return  # a step waits for the window (an animation plays), in which timers go on
        try:
            next(steps)
        except StopIteration:
            os._exit(0)
        except BaseException as problem:
            check(False, problem)

    interactor.AddObserver("TimerEvent", look)
    interactor.CreateRepeatingTimer(50)


class Refinement:
    """A volume in a window that counts its pictures; steps that wait for these."""

    def __init__(self, view):
        self.view = view
        self.display = simple.Show(simple.OpenDataFile(MODEL), view)
        simple.ResetCamera(view)
        self.display.StillTimeLimit = SHORT
        self.display.SampleDistance = 4
        self.display.MaximumBounces = 1
        self.pictures = []
        view.GetRenderWindow().AddObserver("EndEvent", lambda *_: self.pictures.append(time.time()))

    def pictures_since(self, start):
        return sum(picture > start for picture in self.pictures)

    def is_converged(self):
        self.display.UpdatePropertyInformation()
        return self.display.GetPropertyValue("Converged") == 1

    def show_endless(self):
        """Never done: as long as this is shown, only the window's being busy stops pictures."""
        self.display.RenderMode = "Path Tracing"
        self.display.SamplesPerPixel = 1000000
        simple.Render(self.view)
        check(not self.is_converged(), "a picture that cannot be done has converged")

    def wait_for_pictures(self, occasion):
        start = time.time()
        while self.pictures_since(start) < 3:
            check(time.time() < start + 20, "not refined", occasion)
            yield

    def converges(self, brick_size):
        """From an empty cache on, for bricks of a new size."""
        self.display.RenderMode = "Ray Marching"
        self.display.BrickSize = brick_size
        self.display.StillTimeLimit = 1e-6  # too short for all bricks on any machine
        simple.Render(self.view)
        start = time.time()
        check(not self.is_converged(), "a short look is enough for all bricks")
        self.display.StillTimeLimit = SHORT
        while not self.is_converged():
            check(time.time() < start + 60, "does not converge")
            yield
        print("converged after", self.pictures_since(start), "more pictures")
        check(self.pictures_since(start) > 0, "nothing was refined")

    def converges_and_stops(self):
        yield from self.converges(20)
        converged = time.time() + 0.1
        yield from self.rests(converged, "refined what has converged")
        check_baseline(picture(self.view, "gui-refinement", SIZE), "GuiRefinement")

    def rests(self, start, problem):
        """No picture from `start` on, for a while."""
        while time.time() < start + 1.5:
            yield
        check(self.pictures_since(start) == 0, problem)

    def selects(self):
        """Of a picture that is never done: a selection does not wait for it."""
        x, y = (size // 2 for size in self.view.GetRenderWindow().GetSize())
        simple.SelectSurfaceCells(Rectangle=[x - 9, y - 9, x + 9, y + 9], View=self.view)
        check(self.is_selected(), "nothing is selected")
        check(not self.is_converged(), "a picture that cannot be done has converged")
        self.clear_selection()

    def is_selected(self):
        source = self.display.Input
        return source.SMProxy.GetSelectionInput(source.Port) is not None

    def clear_selection(self):
        simple.ClearSelection(self.display.Input)

    def pauses_while_an_animation_plays(self):
        scene = simple.GetAnimationScene()
        scene.NumberOfFrames = 10
        start = time.time()
        scene.Play()
        # The first time, ParaView shows some frames twice.
        print(self.pictures_since(start), "pictures in an animation of 10")
        check(10 <= self.pictures_since(start) <= 14, "refined while playing:", self.pictures_since(start))
