#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills trainings twenty times and lets them go on from their checkpoint; writes kill-resume.json.

    PYTHONPATH=build/lib/python /usr/bin/python3 Testing/Benchmarks/kill_resume.py

A kill -9 comes at a random time of the training, or, every second time, while a checkpoint is
written. It is counted when the next process goes on after as many steps as the file told (or anew,
where none was written yet), and only if all models come out bit for bit as those of a training that
was never killed. These are counts, no times: other load on the machine does not change them.
"""
import os
import sys
import tempfile
from pathlib import Path

import results_file

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "VTK" / "Python"))
from killing import Training, kill_often  # noqa: E402

KILLS = 20


def main():
    with tempfile.TemporaryDirectory() as folder:
        training = Training(os.path.join(folder, "model.inr"), edge=96, steps=4000, interval=0.1)
        good, resumed, differing = kill_often(training, KILLS, longest=3.0)
        left = os.listdir(folder)
    note = (f"of {KILLS} kills of trainings of 96^3 voxels, {training.steps} steps, by MaximumSteps; "
            f"{resumed} when there was a checkpoint, {differing} bytes of the finished models' "
            f"voxels differ, {len(left)} files are left")
    good = good if differing == 0 and not left else 0
    results_file.write("kill-resume", [results_file.result(
        "kill resume OK", good, "kills", "higher", note, target=KILLS)])


if __name__ == "__main__":
    main()
