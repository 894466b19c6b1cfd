# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window, a picture goes on being refined when GuiSelection.xml has selected some of it
by mouse: of that, ParaView tells the beginning as of an interaction, and no end."""
from guisteps import Refinement, begin, follow

refinement = Refinement(begin())


def watch():
    """Yields between two looks at the window."""
    while not refinement.is_selected():
        yield
    yield from refinement.wait_for_pictures("after a selection by mouse")
    refinement.clear_selection()
    yield from refinement.wait_for_pictures("after its end")
    yield from refinement.converges_and_stops()


refinement.show_endless()
follow(watch(), refinement.view.GetRenderWindow().GetInteractor())
