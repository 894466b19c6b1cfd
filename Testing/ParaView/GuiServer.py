# SPDX-License-Identifier: BSD-3-Clause
"""The same as GuiRefinement.py of what a server draws, whose processes have a part of the volume each:
nobody waits for what is not complete, and pictures go on until all parts are; those of a screenshot are
complete, and what is not shown does not go on."""
import os
import time

from paraview import simple
from guisteps import Refinement, begin, follow
from pvtest import check, output_file

simple.LoadPlugin(os.environ["INR_PLUGIN"], remote=True, ns=vars(simple))
view = begin()
view.RemoteRenderThreshold = 0
refinement = Refinement(view)
display = refinement.display


def shoots_what_is_complete():
    display.SamplesPerPixel = 2
    simple.SaveScreenshot(output_file("gui-server.png"), view)
    check(refinement.is_converged(), "the picture of a screenshot is not complete")


def rests_while_hidden():
    display.Visibility = 0
    simple.Render(view)
    yield from refinement.rests(time.time() + 0.1, "refined what is hidden")
    display.Visibility = 1
    simple.Render(view)


def goes_on_for_either_process():
    """Each of the two draws half of the picture, the upper or the lower one; only there is anything left
    to draw."""
    view.ResetActiveCameraToPositiveX()
    view.ResetCamera()
    display.UseCropping = 1
    display.CroppingScale = [1, 1, 0.4]
    for begin, brick_size in ((0, 22), (54, 24)):
        display.CroppingOrigin = [0, 0, begin]
        yield from refinement.converges(brick_size)


def watch():
    """Yields between two looks at the window."""
    yield from refinement.wait_for_pictures("at first")
    yield from rests_while_hidden()
    yield from refinement.wait_for_pictures("when shown again")
    refinement.selects()
    yield from refinement.wait_for_pictures("after a selection")
    refinement.pauses_while_an_animation_plays()
    yield from refinement.wait_for_pictures("after the animation")
    shoots_what_is_complete()
    yield from refinement.converges_and_stops()
    yield from goes_on_for_either_process()


refinement.show_endless()
follow(watch(), view.GetRenderWindow().GetInteractor())
