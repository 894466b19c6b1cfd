#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt, or any file a
header in a folder that is above its own.

    check_includes.py SOURCE_DIR
"""
import re
import sys
from pathlib import Path

# From below: each folder may include itself and those before it. For the reasons see the README.md
# of some; what lies in a room itself, not in a folder of it, is what the room is entered by.
FLOORS = """
Core
Core/Image
Core/Model
Core/Inference
Core/Cache
Core/Training/Volume
Core/Training/Runtime
Core/Training/Samples
Core/Training/Quality
Core/Training/Descent
Core/Training/Checkpoint
Core/Training
Core/Training/Parallel
Core/Training/Streaming
Core/Render/Scene
Core/Render/Rays
Core/Render/Tiles
Core/Render/MacroCells
Core/Render/Marching
Core/Render/Bricks
Core/Render/Blending
Core/Render/Tolerance
Core/Render/Paths
Core/Render/Acceleration
Core/Render
CUDA/Device
CUDA/Inference
CUDA/Cache
CUDA/Render
CUDA/Training
CUDA
Readers/Common
Readers/Grid
Readers/Contour
Readers/Training
Readers
Representations/Mapper/Scene
Representations/Mapper/Window
Representations/Mapper/Selection
Representations/Mapper/Pictures
Representations/Mapper
Representations/ParaView
Plugin
""".split()
# Beside each other: neither may include the other.
APART = [("Core/Training", "Core/Render"), ("CUDA/Training", "CUDA/Render"),
         ("Readers/Contour", "Readers/Training")]
# Public headers lie in their room, for those outside; what is on this floor may use them, too.
AS_IF_IN = {"vtkINRDataArray.h": "Readers/Grid", "vtkINRTypedArray.h": "Readers/Grid",
            "vtkINRVolumeMapper.h": "Representations/Mapper/Scene"}
WITHOUT_VTK = ("Core", "CUDA")
FOREIGN = re.compile(r'(?:\S*/)?(?:vtk|pq|Q[A-Z]|Qt)')
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SUFFIXES = {".h", ".cpp", ".cu", ".cuh", ".cxx", ".in"}

root = Path(sys.argv[1])
files = [path for room in sorted({floor.split("/")[0] for floor in FLOORS})
         for path in (root / room).rglob("*") if path.suffix in SUFFIXES]


def floor_of(path):
    """Of a file of the tree: its folder's, or that of the nearest one around it that has one."""
    if path.name in AS_IF_IN:
        return AS_IF_IN[path.name]
    for folder in path.relative_to(root).parents:
        if folder.as_posix() in FLOORS:
            return folder.as_posix()
    return None


def included(path, name):
    """The file of the tree that an include names; None when it is of none."""
    for folder in (root, path.parent, root / "Readers", root / "Representations/Mapper",
                   root / "Representations/ParaView"):
        found = (folder / name).resolve()
        if found.is_file() and root.resolve() in found.parents:
            return root / found.relative_to(root.resolve())
    return None


def are_apart(one, other):
    def lies_in(floor, room):
        return f"{floor}/".startswith(f"{room}/")
    return any(lies_in(one, a) and lies_in(other, b) or lies_in(one, b) and lies_in(other, a)
               for a, b in APART)


def why_not(path, name):
    """What is wrong with an include; empty when nothing is."""
    floor = floor_of(path)
    if floor.split("/")[0] in WITHOUT_VTK and FOREIGN.match(name):
        return "sees VTK, ParaView or Qt"
    target = included(path, name)
    if target is None:
        return ""
    other = floor_of(target)
    if other is None or FLOORS.index(other) > FLOORS.index(floor):
        return f"{floor} is below {other}"
    return f"{floor} and {other} are apart" if are_apart(floor, other) else ""


offenders = []
for path in files:
    if floor_of(path) is None:
        offenders.append(f"{path}: in a folder that {Path(__file__).name} does not know")
        continue
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = INCLUDE.match(line)
        problem = why_not(path, found[1]) if found else ""
        if problem:
            offenders.append(f"{path}:{number}: {line.strip()}: {problem}")
print("\n".join(offenders) or f"{len(files)} files in {len(FLOORS)} folders, none includes what is "
      "above it")
sys.exit(bool(offenders) or not files)
