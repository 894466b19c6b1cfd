# SPDX-License-Identifier: BSD-3-Clause
"""One client after another of a server that lets several in: each sees the same. Arguments: the server's
port and more."""
import sys
import time

from pvtest import check, connect, load_plugin, picture, show_model
from paraview import simple

pictures = []
for client in range(2):
    if client == 0:
        connect(sys.argv[1])
    else:  # the server has the plugin already
        simple.Connect("localhost", int(sys.argv[1]))
        load_plugin()
    view, display = show_model()
    check(display.ScalarOpacityUnitDistance == display.INRUnitDistance, "two distances")
    pictures.append((display.INRUnitDistance, picture(view, f"server-client-{client}")))
    simple.Disconnect()
    time.sleep(0.5)
(first, shown), (second, again) = pictures
check(first == second, "the distance over which opacity applies is", first, "and then", second)
check(shown.std() > 0.05 and abs(shown - again).max() < 2.5 / 255, "the second client sees something else")
