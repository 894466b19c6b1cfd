#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt, or one of its
folders a header of a later one or of what is not below it.

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

# Folders, each of which may include those before it and what is below them all; what lies in none
# of them may include all. For the reasons see the rooms' README.md.
BELOW = {"Core", "Core/Model", "Core/Inference", "Core/Cache", "Core/Image"}
LAYERS = {
    "Core/Render": ("Scene", "Rays", "Tiles", "MacroCells", "Marching", "Bricks", "Tolerance",
                    "Paths", "Acceleration"),
    "Core/Training": ("Volume", "Runtime", "Samples", "Quality", "Descent", "Checkpoint"),
    "CUDA": ("Device", "Inference", "Cache", "Render"),
}
INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:Core|CUDA)(?:/\w+)*)/\w+\.\w+"')


def offences(folder, is_allowed):
    for path in (path for path in files if Path(sys.argv[1], folder) in path.parents):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found = INCLUDE.match(line)
            if found and not is_allowed(found[1]):
                yield f"{path}:{number}: {line.strip()}"


def is_below(room, folder):
    return folder in BELOW or (room == "CUDA" and folder.startswith("Core/"))


for room in BELOW - {"Core"}:
    offenders += offences(room, lambda folder: folder in BELOW)
for room, names in LAYERS.items():
    for place, name in enumerate(names):
        allowed = tuple(f"{room}/{earlier}/" for earlier in names[:place + 1])
        offenders += offences(f"{room}/{name}", lambda folder: is_below(room, folder)
                              or f"{folder}/".startswith(allowed))
print("\n".join(offenders) or f"{len(files)} files, none sees VTK, ParaView or Qt, nor a "
      "folder a later one")
sys.exit(bool(offenders) or not files)
