#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far the worst pixel of 1,200 pictures that are made at random to be hard to keep to a tolerance
is off: writes hard-tolerances.json.

    cmake --preset core && cmake --build --preset core --target test_random_tolerances
    Testing/Benchmarks/hard_tolerances.py build-core/Testing/Core/Render/test_random_tolerances [SEED]
"""
import json
import os
import subprocess
import sys

import results_file


def main():
    seed = sys.argv[2] if len(sys.argv) > 2 else "1"
    run = subprocess.run([sys.argv[1], "--gtest_filter=RandomTolerances.AreKept"], text=True,
                         stdout=subprocess.PIPE, check=True,
                         env={**os.environ, "INR_HARD_SCENES": "300", "INR_HARD_SEED": seed})
    found = json.loads(next(line for line in run.stdout.splitlines() if line.startswith("{")))
    note = (f"{found['pictures']} pictures that show something, of 300 scenes of seed {seed}, with "
            "1/255, 4/255, 12/255 and 36/255")
    print(found)
    results_file.write("hard-tolerances", [
        results_file.result("worst pixel of all, in tolerances", found["worst"], "", "lower",
                            f"{note}; in {found['where']}", target=1),
        results_file.result("pictures with a pixel that is off by half of the tolerance or more",
                            found["half_used"], "", "higher", note),
        results_file.result("samples as part of the exact pictures'", found["samples"], "", "lower",
                            note)])


if __name__ == "__main__":
    main()
