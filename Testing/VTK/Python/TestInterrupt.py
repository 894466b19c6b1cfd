# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C during a long training, decoding or contouring ends it with KeyboardInterrupt; a training
leaves its checkpoint behind, or, when told to keep none, nothing."""
import os
import signal
import subprocess
import sys
import tempfile
import time

COMMON = """
import sys
from inrvolume import vtkINRContour, vtkINRDecode, vtkINRReader, vtkINRWriter
from vtkmodules.vtkCommonDataModel import vtkImageData

def train(path, steps, interval=0):
    image = vtkImageData()
    image.SetDimensions(40, 40, 40)
    image.AllocateScalars(11, 1)
    scalars = image.GetPointData().GetScalars()
    for index in range(40**3):
        scalars.SetTuple1(index, index % 40 * 25)
    writer = vtkINRWriter()
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.SetMaximumSteps(steps)
    writer.SetCheckpointInterval(interval)
    return writer

def interrupt(algorithm, start):
    def announce(caller, event):
        # Once only: an observer that meets the interrupt makes VTK end the program.
        if 0 < caller.GetProgress() < 1:
            caller.RemoveObservers("ProgressEvent")
            print("at it", flush=True)

    algorithm.AddObserver("ProgressEvent", announce)
    try:
        start()
        for _ in range(1000):  # Python delivers the signal between two of its instructions
            pass
    except KeyboardInterrupt:
        print("interrupted", flush=True)

def read_large(path):
    train(path, 100).Write()
    reader = vtkINRReader()
    reader.SetFileName(path)
    reader.SetDimensions(1000, 1000, 1000)
    return reader
"""

TRAINING = """
writer = train(sys.argv[1], 0)
interrupt(writer, writer.Write)
"""

TRAINING_WITH_CHECKPOINT = TRAINING.replace("0)", "0, 60)")

DECODING = """
reader = read_large(sys.argv[1])
decode = vtkINRDecode()
decode.SetScalarType(3)
decode.SetInputConnection(reader.GetOutputPort())
interrupt(decode, decode.Update)
assert decode.GetOutput().GetNumberOfPoints() == 0
"""

CONTOURING = """
reader = read_large(sys.argv[1])
contour = vtkINRContour()
contour.SetValue(0, 500)
contour.SetLevel(0)
contour.SetMemoryLimit(100000)
contour.SetInputConnection(reader.GetOutputPort())
interrupt(contour, contour.Update)
assert contour.GetOutput().GetNumberOfPoints() == 0
"""

# A writer that reads through a filter: both are asked to stop, and the inner one must not keep the signal.
TRAINING_OF_DECODED = """
train(sys.argv[1] + ".source.inr", 100).Write()
reader = vtkINRReader()
reader.SetFileName(sys.argv[1] + ".source.inr")
reader.SetDimensions(500, 500, 500)
decode = vtkINRDecode()
decode.SetInputConnection(reader.GetOutputPort())
writer = vtkINRWriter()
writer.SetInputConnection(decode.GetOutputPort())
writer.SetFileName(sys.argv[1])
writer.SetMaximumSteps(100)
writer.SetMemoryLimit(200)
writer.SetCheckpointInterval(0)
interrupt(writer, writer.Write)
"""


def interrupted(what, folder):
    program = [sys.executable, "-c", COMMON + what, os.path.join(folder, "model.inr")]
    process = subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "at it\n", process.communicate()
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    seconds = time.monotonic() - start
    assert out == "interrupted\n", (out, err)
    assert process.returncode == 0, (process.returncode, err)
    assert seconds < 20, seconds
    return err


with tempfile.TemporaryDirectory() as folder:
    assert "stopped" in interrupted(TRAINING, folder)
    assert os.listdir(folder) == [], os.listdir(folder)
    for expected in ("steps are kept in", "goes on after"):  # the second goes on from the first
        assert expected in interrupted(TRAINING_WITH_CHECKPOINT, folder)
        assert os.listdir(folder) == ["model.inr.checkpoint"], os.listdir(folder)
    for what in (DECODING, CONTOURING):
        interrupted(what, folder)
    os.remove(os.path.join(folder, "model.inr"))
    said = interrupted(TRAINING_OF_DECODED, folder)
    assert "stopped" in said, said
    assert not os.path.exists(os.path.join(folder, "model.inr"))
