#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt, or one of the
renderer's folders a header of a later one.

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

# See Core/Render/README.md; what lies in none of them may include all.
LAYERS = ["Scene", "Rays", "Tiles", "MacroCells", "Marching", "Bricks", "Tolerance", "Paths"]
INCLUDE = re.compile(r'^\s*#\s*include\s*"Core/Render/(?:(\w+)/)?\w+\.h"')


def is_later(folder, line):
    found = INCLUDE.match(line)
    return found and (found[1] not in LAYERS or LAYERS.index(found[1]) > LAYERS.index(folder))


layered = [path for folder in LAYERS for path in Path(sys.argv[1], "Core/Render", folder).iterdir()
           if path.suffix in {".h", ".cpp"}]
offenders += [f"{path}:{number}: {line.strip()}" for path in layered
              for number, line in enumerate(path.read_text().splitlines(), 1)
              if is_later(path.parent.name, line)]
print("\n".join(offenders) or f"{len(files)} files, none sees VTK, ParaView or Qt, and none of the "
      f"renderer's {len(layered)} in folders one of a later folder")
sys.exit(bool(offenders) or not files or not layered)
