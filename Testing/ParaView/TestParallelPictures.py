# SPDX-License-Identifier: BSD-3-Clause
"""Processes of pvbatch that hold a piece of the volume each draw what one draws. The first argument is
"write" in several processes, "check" in one."""
import os
import re
import sys

from glass_scenes import check_parallel, path_of, pictures
from paraview import servermanager, simple
from pvtest import check, load_plugin, output_file, read_png

load_plugin()
if sys.argv[1] == "write":
    pictures("batch")
    # They share the memory of the machine, too.
    processes = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") >> 20
    for volume in simple.GetActiveView().GetRenderer().GetVolumes():
        for size in re.findall(r" CacheSize: (\d+)", str(volume.GetMapper())):
            check(processes > 1 and 0 < int(size) <= memory / 4 / processes, "CacheSize", size)
else:
    expected = pictures("alone")[2]
    found = {name: read_png(output_file(path_of("batch", name) + ".png")) for name in expected}
    check_parallel(found, expected)
    os._exit(0)
