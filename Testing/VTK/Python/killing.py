# SPDX-License-Identifier: BSD-3-Clause
"""Kills trainings (kill -9) at random times and lets them go on from their checkpoint. Needs
PYTHONPATH for the package `inrvolume`."""
import json
import os
import random
import re
import signal
import struct
import subprocess
import sys
import time
from dataclasses import dataclass

PROGRAM = """
import sys
import numpy
from inrvolume import vtkINRWriter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData

path, edge, steps, interval = sys.argv[1], *map(float, sys.argv[2:])
x, y, z = numpy.meshgrid(*3 * [numpy.arange(int(edge)) / 9], indexing="ij")
values = numpy.sin(x + numpy.sin(2 * y)) * numpy.cos(y * 1.3 + z) + 0.3 * numpy.sin(5 * x + 4 * z)
image = vtkImageData()
image.SetDimensions(values.shape)
array = numpy_to_vtk(values.astype(numpy.float32).ravel(order="F"), deep=True)
array.SetName("field")
image.GetPointData().SetScalars(array)

def announce(caller, event):
    if 0 < caller.GetProgress() < 1:
        caller.RemoveObservers("ProgressEvent")
        print("at it", flush=True)

writer = vtkINRWriter()
writer.SetInputData(image)
writer.SetFileName(path)
writer.SetMaximumSteps(int(steps))
writer.SetTimeLimit(0)
writer.SetCheckpointInterval(interval)
writer.AddObserver("ProgressEvent", announce)
done = writer.Write()
print("done", done, writer.GetSteps(), writer.GetPSNR(), flush=True)
"""

DECODE = """
import sys
from inrvolume import vtkINRDecode, vtkINRReader
from vtkmodules.util.numpy_support import vtk_to_numpy

reader = vtkINRReader()
reader.SetFileName(sys.argv[1])
decode = vtkINRDecode()
decode.SetInputConnection(reader.GetOutputPort())
decode.Update()
sys.stdout.buffer.write(vtk_to_numpy(decode.GetOutput().GetPointData().GetScalars()).tobytes())
"""


@dataclass
class Training:
    """What to train: voxels per axis, steps, seconds between checkpoints, and where."""
    path: str
    edge: int
    steps: int
    interval: float

    def start(self):
        command = [sys.executable, "-c", PROGRAM, self.path, str(self.edge), str(self.steps),
                   str(self.interval)]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    @property
    def checkpoint(self):
        return self.path + ".checkpoint"

    def decoded(self):
        return subprocess.run([sys.executable, "-c", DECODE, self.path], stdout=subprocess.PIPE,
                              check=True).stdout

    def finish(self):
        """Lets it run to its end; returns what it says."""
        out, err = self.start().communicate(timeout=600)
        assert f"done 1 {self.steps} " in out, (out, err)
        assert not os.path.exists(self.checkpoint), "the checkpoint is left"
        return err


def steps_in(checkpoint):
    """What the header tells; -1 = there is no file."""
    if not os.path.exists(checkpoint):
        return -1
    with open(checkpoint, "rb") as file:
        magic, version, length = struct.unpack("<8sII", file.read(16))
        assert (magic, version) == (b"INRtrain", 1), (magic, version)
        return json.loads(file.read(length))["steps"]


def steps_gone_on_from(messages):
    """-1 where the training began anew for want of a checkpoint; one that is there must be of use."""
    assert "begins anew" not in messages and "WARN" not in messages, messages
    found = re.search(r"goes on after (\d+) steps", messages)
    return int(found[1]) if found else -1


def writes_now(training):
    folder, name = os.path.split(training.checkpoint)
    return any(entry.startswith(name + ".") for entry in os.listdir(folder))


def live_and_die(training, longest, chance):
    """One life of the training, of `longest` seconds at most: half of them end at any time, half
    while a checkpoint is written. Returns whether it was killed, not done before; and its messages."""
    process = training.start()
    assert process.stdout.readline() == "at it\n", process.communicate()
    end = time.monotonic() + longest * chance.random()
    if chance.random() < 0.5:
        end = time.monotonic() + longest
        while time.monotonic() < end and not writes_now(training) and process.poll() is None:
            time.sleep(0.001)
    else:
        time.sleep(max(0, end - time.monotonic()))
    process.send_signal(signal.SIGKILL)
    out, err = process.communicate(timeout=60)
    return "done" not in out and process.returncode == -signal.SIGKILL, err


def kill_often(training, kills, longest, seed=1):
    """Kills it so many times; a training that is done before begins again. Returns the number of
    kills after which it went on from all that the checkpoint had, or anew where none was written
    yet; the number of those that had one; and the largest difference of a finished model from one
    that was never killed, in bytes that differ."""
    chance = random.Random(seed)
    training.finish()
    expected = training.decoded()
    os.remove(training.path)
    good, resumed, killed, kept, differing = 0, 0, 0, -1, 0

    def compare():
        nonlocal differing
        differing = max(differing, sum(a != b for a, b in zip(training.decoded(), expected)))
        os.remove(training.path)

    while True:
        done = killed == kills
        dead, messages = (False, training.finish()) if done else live_and_die(training, longest, chance)
        if killed and kept != "finished":
            good += steps_gone_on_from(messages) == kept
            resumed += kept >= 0
        if done:
            compare()
            return good, resumed, differing
        if not dead:
            compare()
            kept = "finished"
            continue
        assert not os.path.exists(training.path), "a half-written model under the final name"
        killed += 1
        kept = steps_in(training.checkpoint)
