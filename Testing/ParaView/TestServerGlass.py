# SPDX-License-Identifier: BSD-3-Clause
"""The processes of a server draw what this process draws where their pieces have no order. Arguments: the
server's port and its number of processes."""
import os
import sys

from glass_scenes import check_parallel, pictures
from pvtest import Messages, check, check_interactive, check_same, connect, load_plugin, picture

PORT = int(sys.argv[1])

def surfaces_alone(view, display, where):
    """With a volume that is flat, which cannot be drawn, and is said so."""
    display.Scale = [1, 0, 1]
    flat = picture(view, f"server-glass-{where}-flat")
    display.Scale = [1, 1, 1]
    return {"flat": flat}


load_plugin()
view, display, expected = pictures("here")
alone = surfaces_alone(view, display, "here")
connect(PORT)
with Messages() as messages:
    view, display, found = pictures("there")
check(messages.errors() == 0, "drawing reported", messages.text)
check_parallel(found, expected)
check_same(surfaces_alone(view, display, "there"), alone, composed=["flat"])

# While the mouse moves, too: paths of a picture that has fewer pixels than the window, among glass.
display.RenderMode = "Path Tracing"
check_interactive(view, display)
os._exit(0)
