#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt, or one in a folder
of a room a header of a later one or of what is not below it.

    check_includes.py SOURCE_DIR
"""
import re
import sys
from pathlib import Path

FOREIGN = re.compile(r'^\s*#\s*include\s*[<"](?:\S*/)?(?:vtk|pq|Q[A-Z]|Qt)')
SUFFIXES = {".h", ".cpp", ".cu", ".cuh", ".cxx", ".in"}


def files_of(room):
    return (path for path in Path(sys.argv[1], room).rglob("*") if path.suffix in SUFFIXES)


def lines_of(room):
    """Each line, with where it is before it."""
    for path in files_of(room):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            yield f"{path}:{number}: {line.strip()}", line


offenders = [where for room in ("Core", "CUDA") for where, line in lines_of(room)
             if FOREIGN.match(line)]

# Folders, each of which may include those before it and what is below them all; what lies in none
# of them may include all. For the reasons see the README.md of some.
BELOW = {"Core", "Core/Model", "Core/Inference", "Core/Cache", "Core/Image"}
LAYERS = {
    "Core/Render": ("Scene", "Rays", "Tiles", "MacroCells", "Marching", "Bricks", "Tolerance",
                    "Paths", "Acceleration"),
    "Core/Training": ("Volume", "Runtime", "Samples", "Quality", "Descent", "Checkpoint"),
    "CUDA": ("Device", "Inference", "Cache", "Render"),
    "Readers": ("Common", "Grid", "Contour", "Training"),
    "Representations/Mapper": ("Scene", "Window", "Selection", "Pictures"),
}
ROOMS = ("Core", "CUDA", "Readers", "Representations")  # each is below the next
INCLUDE = re.compile(rf'^\s*#\s*include\s*"((?:{"|".join(ROOMS)})(?:/\w+)*)/\w+\.\w+"')


def offences(folder, is_allowed):
    for where, line in lines_of(folder):
        found = INCLUDE.match(line)
        if found and not is_allowed(found[1]):
            yield where


def is_below(room, folder):
    root = room.split("/")[0]
    return folder in BELOW or folder.split("/")[0] in ROOMS[:ROOMS.index(root)]


for room in BELOW - {"Core"}:
    offenders += offences(room, lambda folder: folder in BELOW)
for room, names in LAYERS.items():
    for place, name in enumerate(names):
        allowed = tuple(f"{room}/{earlier}/" for earlier in names[:place + 1])
        offenders += offences(f"{room}/{name}", lambda folder: is_below(room, folder)
                              or f"{folder}/".startswith(allowed))
count = sum(1 for room in ROOMS for _ in files_of(room))
print("\n".join(offenders) or f"{count} files: none of Core/ and CUDA/ sees VTK, ParaView or Qt, "
      "nor a folder a later one")
sys.exit(bool(offenders) or count == 0)
