# SPDX-License-Identifier: BSD-3-Clause
"""The table of VTK versions in Documentation/Wheel.md is true: of this build, of the wheel's, and of the
last run of Testing/Wheel/run.sh; and only VTKCompat.h asks for VTK's version.

    check_versions.py VERSION      that of the VTK that this build is against
"""
import json
import re
import sys
from pathlib import Path

version = sys.argv[1]
sources = Path(__file__).resolve().parents[2]

wheel_page = (sources / "Documentation/Wheel.md").read_text()
table = wheel_page.split("| VTK | where it comes from | tested by |\n")[1].split("\n\n")[0]
rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[1:]]
tested = {row[0]: row for row in rows if row[2] != "not tested"}
print("\n".join(" | ".join(row) for row in rows))
assert len(rows) == 4 and len(tested) == 3, rows

short = ".".join(version.split(".")[:2])
assert short in tested, f"this build's VTK {version} is not among {list(tested)}"

# Every difference is in one file, which says of what.
compat = (sources / "Readers/Common/VTKCompat.h").read_text()
about = compat[compat.index("// Every difference"):].split("\n\n")[0]
for name in tested:
    assert re.search(rf"\b{re.escape(name)}\b", about), f"VTKCompat.h does not speak of {name}"
for folder in ("Core", "CUDA", "Readers", "Representations", "Plugin"):
    for path in (sources / folder).rglob("*"):
        if path.suffix in (".h", ".cxx", ".cpp", ".cu") and path.name != "VTKCompat.h":
            assert not re.search(r"\b(VTK|PARAVIEW)_(MAJOR_|MINOR_)?VERSION", path.read_text()), path

# The wheel is built against one version and asks for the same when it is installed.
project = (sources / "pyproject.toml").read_text()
built, asked = re.search(r'"cvista-sdk==([\d.]+)"', project), re.search(r'"cvista\[all\]==([\d.]+)"', project)
assert built and asked and built[1] == asked[1], (built, asked)
wheel = next(row for row in tested.values() if "cvista" in row[1])
assert f"cvista {built[1]}" in wheel[1], wheel
results = list((sources / "Testing/Benchmarks/results").glob("*/wheel.json"))
assert results, "Testing/Wheel/run.sh has not run"
for path in results:
    context = json.loads(path.read_text())["context"]
    assert context["cvista"] == built[1], (path, context)
    assert context["vtk"].startswith(wheel[0] + "."), (path, context)
