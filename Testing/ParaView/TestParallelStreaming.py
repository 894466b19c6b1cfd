# SPDX-License-Identifier: BSD-3-Clause
"""Processes of pvbatch that train one model of a file of which they hold no piece: "write" in several
processes, "check" in one."""
import glob
import os
import resource
import sys

import numpy as np
from paraview import servermanager, simple
from pvtest import Messages, check, load_plugin, output_file

LIMIT = 340  # MiB, of all processes
DIMS = (400, 320, 360)  # 176 MiB as floats
STEPS = 40
MODEL = """{"encoding": {"otype": "HashGrid", "n_levels": 4, "n_features_per_level": 4,
"log2_hashmap_size": 12, "base_resolution": 6, "per_level_scale": 1.6},
"network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 2,
"activation": "ReLU", "output_activation": "None"}}"""
MODEL_FILE = output_file("parallel-streamed.inr")


def peak():
    """MiB, of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def write_raw(path):
    x, y, z = (np.linspace(0, 1, n, dtype=np.float32) for n in DIMS)
    waves = np.sin(7 * x)[None, :] * np.cos(5 * y)[:, None]
    with open(path, "wb") as file:
        for layer in z:
            file.write((20 + 10 * waves * np.cos(3 * layer) + layer).astype("<f4").tobytes())


def save(path):
    extent = [number for n in DIMS for number in (0, n - 1)]
    source = simple.ImageReader(FileNames=[raw], DataScalarType="float", DataExtent=extent,
                                DataByteOrder="LittleEndian", FileDimensionality=3,
                                DataSpacing=[1, 2, 3])
    writer = servermanager.writers.INRWriter(Input=source, FileName=path, MemoryLimit=LIMIT,
                                             MaximumSteps=STEPS, TimeLimit=0, ModelConfig=MODEL,
                                             CheckpointInterval=1e-3, ReadableByInstantVNR=1)
    kept = set()
    writer.SMProxy.GetClientSideObject().AddObserver(
        "ProgressEvent", lambda *_: kept.update(glob.glob(path + ".checkpoint.rank?")))
    before = peak()
    with Messages() as messages:
        writer.UpdatePipeline()
    check(messages.errors() == 0, "saving reported", messages.text)
    check(len(kept) == 2, "of what the processes had read, these were kept:", kept)
    check(glob.glob(path + ".*") == [], "files are left", glob.glob(path + ".*"))
    return peak() - before


load_plugin()
if sys.argv[1] == "write":
    raw = output_file("parallel-streamed.raw")
    write_raw(raw)
    if os.path.exists(MODEL_FILE):
        os.remove(MODEL_FILE)
    took = save(MODEL_FILE)
    print(f"{took:.0f} MiB")
    check(os.path.exists(MODEL_FILE), "no file")
    # Its half of the volume alone would be 88 MiB, on top of 40 for the rest.
    check(took < 80, "a process took", took, "MiB")
    os.remove(raw)
else:
    reader = simple.OpenDataFile(MODEL_FILE)
    reader.UpdatePipeline()
    psnr = reader.FieldData["INRPSNR"].GetRange(0)[0]
    bounds = reader.GetDataInformation().GetBounds()
    wanted = tuple(end for n, step in zip(DIMS, (1, 2, 3)) for end in (0, step * (n - 1)))
    check(bounds == wanted, "bounds", bounds, wanted)
    low, high = reader.PointData[0].GetRange()
    check(abs(low - 10) < 0.2 and abs(high - 31) < 1.2, "range", low, high)
    check(psnr > 20, "quality", psnr)
    os._exit(0)
