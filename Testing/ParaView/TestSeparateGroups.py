# SPDX-License-Identifier: BSD-3-Clause
"""A data server of several processes has the file, and of as many of a render server one draws what this
process draws of it, and nobody anything else. Arguments: the ports of both."""
import os
import sys

import numpy as np
from pvtest import check, connect, load_plugin, picture, show_model


def show(where):
    view, _ = show_model((160, 120))
    view.UseColorPaletteForBackground = 0
    view.Background = [0.05, 0.05, 0.1]  # on which an outline of a part would be seen
    return picture(view, f"separate-groups-{where}")


load_plugin()
expected = show("here")
check(expected.std() > 0.03, "nothing is shown")
connect(*sys.argv[1:])
difference = 255 * np.abs(show("servers") - expected)
print(f"largest {difference.max():.0f} of 255")
check(difference.max() < 1.5, "the servers' picture differs")
os._exit(0)
