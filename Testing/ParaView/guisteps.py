# SPDX-License-Identifier: BSD-3-Clause
"""A test's own steps while ParaView's window goes on."""
import os
import sys

from paraview import simple
from pvtest import check, load_plugin

SIZE = (300, 300)  # of pictures, whatever the window's


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
