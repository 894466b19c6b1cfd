# SPDX-License-Identifier: BSD-3-Clause
"""A training that is killed at random times goes on from its checkpoint to the model it would have
given, and leaves nothing else behind."""
import os
import tempfile

from killing import Training, kill_often

with tempfile.TemporaryDirectory() as folder:
    training = Training(os.path.join(folder, "model.inr"), edge=40, steps=600, interval=0.02)
    good, resumed, differing = kill_often(training, kills=3, longest=1.0)
    print(f"{good} of 3 went on, {resumed} from a checkpoint, {differing} bytes differ")
    assert good == 3 and differing == 0
    assert os.listdir(folder) == [], os.listdir(folder)
