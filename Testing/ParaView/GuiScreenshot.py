# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window: the OpenEXR file that GuiScreenshot.xml saves by the dialog is the volume's own
picture, in the size asked for."""
import os
import time

import numpy as np
from exrfile import read_exr
from guisteps import begin, follow
from pvtest import check, check_baseline, output_file

view = begin()
path = output_file("saved-in-window.exr")
if os.path.exists(path):
    os.remove(path)


def watch():
    """Yields between two looks at the window."""
    deadline = time.time() + 120
    while not os.path.exists(path):  # which is never there in parts
        check(time.time() < deadline, "nothing was saved")
        yield
    exact = read_exr(path)
    check(sorted(exact) == ["A", "B", "G", "R", "Z"], "channels", sorted(exact))
    check(exact["A"].shape == (300, 300), "size", exact["A"].shape)
    on_white = np.dstack([exact[name] + 1 - exact["A"] for name in "RGB"])
    check_baseline(on_white[::-1].astype(float), "GuiScreenshot")


follow(watch(), view.GetRenderWindow().GetInteractor())
