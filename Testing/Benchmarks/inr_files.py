# SPDX-License-Identifier: BSD-3-Clause
"""Model files for the comparisons, trained by bench_train."""
import json
import subprocess


class Writer:
    """Saves one volume (the arguments from volumes.raw_file) to `path` after so many steps."""

    def __init__(self, program, steps, volume, path):
        self.program, self.steps, self.volume, self.path = program, steps, volume, path

    def save(self, ratio=0):
        """What Train.cpp says of the file, and a note; ratio 0 lets the volume's size decide."""
        command = [self.program, *self.volume, str(self.steps), str(ratio), self.path]
        output = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
        file = json.loads(output.replace(b"nan", b"NaN"))
        file["note"] = (f"file ratio {file['ratio']:.1f}, {file['parameters']:,} parameters, "
                        f"{self.steps} steps, {file['seconds']:.1f} s of training")
        return file
