#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when a file of Core/ or CUDA/ includes a header of VTK, ParaView or Qt.

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
print("\n".join(offenders) or f"{len(files)} files, none sees VTK, ParaView or Qt")
sys.exit(bool(offenders) or not files)
