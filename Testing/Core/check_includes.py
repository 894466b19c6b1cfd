#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt, or one of the
renderer's folders a header of a later one or of what is not below it.

    check_includes.py SOURCE_DIR
"""
import re
import sys
from pathlib import Path

FOREIGN = re.compile(r'^\s*#\s*include\s*[<"](?:\S*/)?(?:vtk|pq|Q[A-Z]|Qt)')
files = [path for room in ("Core", "CUDA") for path in Path(sys.argv[1], room).rglob("*")
         if path.suffix in {".h", ".cpp", ".cu", ".cuh", ".in"}]
offenders = [f"{path}:{number}: {line.strip()}" for path in files
             for number, line in enumerate(path.read_text().splitlines(), 1) if FOREIGN.match(line)]

# See Core/Render/README.md; what lies in none of these folders may include all.
LAYERS = [f"Core/Render/{name}" for name in
          ("Scene", "Rays", "Tiles", "MacroCells", "Marching", "Bricks", "Tolerance", "Paths",
           "Acceleration")]
BELOW = ["Core", "Core/Model", "Core/Inference", "Core/Cache", "Core/Image"]
INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:Core|CUDA)(?:/\w+)*)/\w+\.\w+"')


def offences(folder, allowed):
    for path in Path(sys.argv[1], folder).iterdir():
        for number, line in enumerate(path.read_text().splitlines() if path.is_file() else [], 1):
            found = INCLUDE.match(line)
            if found and found[1] not in allowed:
                yield f"{path}:{number}: {line.strip()}"


for room in BELOW[1:]:
    offenders += offences(room, BELOW)
for place, folder in enumerate(LAYERS):
    offenders += offences(folder, BELOW + LAYERS[:place + 1])
print("\n".join(offenders) or f"{len(files)} files, none sees VTK, ParaView or Qt, nor one of the "
      "renderer's folders a later one")
sys.exit(bool(offenders) or not files)
