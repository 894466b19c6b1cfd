# SPDX-License-Identifier: BSD-3-Clause
"""Processes of pvbatch that hold a piece of the volume each draw what one draws. The first argument is
"write" in several processes, "check" in one."""
import os
import sys

from glass_scenes import check_parallel, path_of, pictures
from pvtest import load_plugin, output_file, read_png

load_plugin()
if sys.argv[1] == "write":
    pictures("batch")
else:
    expected = pictures("alone")[2]
    found = {name: read_png(output_file(path_of("batch", name) + ".png")) for name in expected}
    check_parallel(found, expected)
    os._exit(0)
