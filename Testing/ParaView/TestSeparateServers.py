# SPDX-License-Identifier: BSD-3-Clause
"""A data server has the file and a render server draws what this process draws of it, or this process
does so itself. Arguments: the ports of both."""
import os
import sys

import numpy as np
from pvtest import Messages, check, connect, load_plugin, picture, show_ball, show_model


def show_scene():
    view, display = show_model((160, 120))
    show_ball(view, [20, 30, 70], 16)
    return view, display


def pictures(view, display, where):
    result = {}
    for mode in "Maximum Intensity", "Composite":
        display.INRBlendMode = mode
        result[mode] = picture(view, f"separate-servers-{where}-{mode}")
    return result


load_plugin()
expected = pictures(*show_scene(), "here")
check(all(image.std() > 0.03 for image in expected.values()), "nothing is shown")

connect(*sys.argv[1:])
view, display = show_scene()
for where, threshold in ("server", 0), ("client", 1000):
    view.RemoteRenderThreshold = threshold
    with Messages() as messages:
        found = pictures(view, display, where)
    check(messages.errors() == 0, where, "reported", messages.text)
    for mode, image in expected.items():
        difference = 255 * np.abs(found[mode] - image)
        print(f"{mode} by the {where}: largest {difference.max():.0f} of 255")
        check(difference.max() < 1.5, mode, "by the", where, "differs")
    display.UpdatePropertyInformation()
    check(display.GetPropertyValue("Converged") == 1, "not converged by the", where)
    check(display.GetPropertyValue("BackendInUse").startswith("CPU "), "drawn by nobody:", where)
os._exit(0)
