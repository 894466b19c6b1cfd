# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C during a long training ends it with KeyboardInterrupt and leaves no file behind."""
import os
import signal
import subprocess
import sys
import tempfile
import time

TRAINING = """
import sys
from inrvolume import vtkINRWriter
from vtkmodules.vtkCommonDataModel import vtkImageData
image = vtkImageData()
image.SetDimensions(40, 40, 40)
image.AllocateScalars(11, 1)
scalars = image.GetPointData().GetScalars()
for index in range(40**3):
    scalars.SetTuple1(index, index * 7919 % 1000)
writer = vtkINRWriter()
writer.SetInputData(image)
writer.SetFileName(sys.argv[1])

def announce(caller, event):
    # Once only: an observer that meets the interrupt makes VTK end the program.
    if caller.GetProgressText():
        caller.RemoveObservers("ProgressEvent")
        print("training", flush=True)

writer.AddObserver("ProgressEvent", announce)
try:
    writer.Write()
    for _ in range(1000):  # Python delivers the signal between two of its instructions
        pass
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""

with tempfile.TemporaryDirectory() as folder:
    program = [sys.executable, "-c", TRAINING, os.path.join(folder, "never.inr")]
    process = subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "training\n", process.communicate()
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    seconds = time.monotonic() - start
    assert out.splitlines()[-1] == "interrupted", (out, err)
    assert process.returncode == 0, process.returncode
    assert "stopped" in err, err
    assert os.listdir(folder) == [], os.listdir(folder)
    assert seconds < 20, seconds
