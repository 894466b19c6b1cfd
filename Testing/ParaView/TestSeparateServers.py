# SPDX-License-Identifier: BSD-3-Clause
"""A data server has the file and a render server draws what this process draws of it, or this process
does so itself. Arguments: the ports of both."""
import os
import sys

import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, picture, show_view


def show_scene():
    view = show_view((160, 120))
    view.UseFXAA = 0
    view.RemoteRenderThreshold = 0
    display = simple.Show(simple.OpenDataFile(MODEL), view)
    display.SetScalarBarVisibility(view, False)
    look_at(view)
    ball = simple.Sphere(Center=[20, 30, 70], Radius=16, ThetaResolution=40, PhiResolution=40)
    simple.Show(ball, view)
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

simple.Connect("localhost", int(sys.argv[1]), "localhost", int(sys.argv[2]))
simple.LoadPlugin(os.environ["INR_PLUGIN"], remote=True, ns=vars(simple))
load_plugin()
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
