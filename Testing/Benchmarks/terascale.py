#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains volumes that fit no memory, from a raw file and from a source that stores nothing; writes
terascale-PART.json for each part.

    cmake --preset release && cmake --build --preset release
    Testing/with-display.sh Testing/Benchmarks/terascale.py build FOLDER [PART...]

"raw": 2048^3 floats, 32 GiB that must be free in FOLDER, within MemoryLimit 1024, and beside it every
fourth voxel trained from memory. "channel": 10240 x 7680 x 1536 doubles, 0.97 TB that are computed
where they are asked for; "half-channel": half as many along every axis. Models are compared with
the field itself on 10^8 random voxels. "channel-flight", after "channel" in the same FOLDER, opens
its model in ParaView with a cache of 2 GiB, flies through it, and compares pictures at three
distances with pictures of the field itself; "half-channel-flight" likewise. "ranks": trainings by
1, 2 and 4 processes of pvbatch; wants a python3 with NumPy. "rank-pictures": the pictures that as many
draw. "resumed": 1024^3 floats from a file, by
a process that is killed soon after its first checkpoint and one that goes on.
"""
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import channel_flight
import channel_ranks
import rank_pictures
import results_file

# In pvpython; arguments as JSON, the answer as the last line.
CHILD = """
import json, resource, sys, time
from paraview import servermanager, simple
given = json.loads(sys.argv[1])
for name in ("INRVolume", "TurbulentChannel"):
    simple.LoadPlugin(f"{given['plugins']}/{name}/{name}.so", remote=False, ns=vars(simple))
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
def read():
    return int(open("/proc/self/io").read().split()[1])
source = getattr(simple, given["source"])(**given["properties"])
idle, before, start = peak(), read(), time.time()
writer = servermanager.writers.INRWriter(Input=source, FileName=given["model"], **given["writer"])
trainer = writer.GetClientSideObject()
phases = {}
def note(*unused):
    phases[(trainer.GetProgressText() or "").split(",")[0]] = time.time() - start
trainer.AddObserver("ProgressEvent", note)
writer.UpdatePipeline()
print(json.dumps({"peak": peak() - idle, "read": read() - before, "seconds": time.time() - start,
                  "until": phases}))
"""

MODEL = json.dumps({
    "encoding": {"otype": "HashGrid", "n_levels": 16, "n_features_per_level": 4,
                 "log2_hashmap_size": 17, "base_resolution": 8, "per_level_scale": 1.4},
    "network": {"otype": "FullyFusedMLP", "n_neurons": 64, "n_hidden_layers": 2,
                "activation": "ReLU", "output_activation": "None"}})
STEPS = 6000
CHANNEL = [10240, 7680, 1536]

build = Path(sys.argv[1]).resolve()
folder = Path(sys.argv[2]).resolve()


def command(model, source, properties, **writer):
    given = {"plugins": str(next((build / "lib").glob("paraview-*")) / "plugins"), "source": source,
             "properties": properties, "model": str(model), "writer": writer}
    return ["pvpython", "-c", CHILD, json.dumps(given)]


def train(model, *source, **writer):
    output = subprocess.run(command(model, *source, **writer), check=True, stdout=subprocess.PIPE,
                            text=True).stdout
    answer = json.loads(output.strip().splitlines()[-1])
    print(model.name, answer, flush=True)
    return answer


def truth(model):
    output = subprocess.run([build / "Testing/Turbulence/channel_truth", model], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    answer = json.loads(output)
    print(model.name, answer, flush=True)
    return answer


def phases(run):
    return ", ".join(f"{name} until {seconds:.0f} s" for name, seconds in run["until"].items() if name)


def cube(edge):
    """A raw file of the field, and what ImageReader has to know of it."""
    header, data = folder / f"channel{edge}.mhd", folder / f"channel{edge}.raw"
    if not data.exists():
        subprocess.run([build / "Testing/Turbulence/turbulent_channel", *[str(edge)] * 3, header],
                       check=True)
    return data, {"FileNames": [str(data)], "DataScalarType": "float", "FileDimensionality": 3,
                  "DataByteOrder": "LittleEndian", "DataExtent": [0, edge - 1] * 3}


def raw_file():
    data, reader = cube(2048)
    model = folder / "raw.inr"
    run = train(model, "ImageReader", reader, MemoryLimit=1024, MaximumSteps=STEPS, TimeLimit=0,
                ModelConfig=MODEL)
    streamed = truth(model)
    sample = folder / "sample.inr"
    train(sample, "TurbulentChannel", {"Dimensions": [512] * 3, "OutputScalarType": "float"},
          MaximumSteps=STEPS, TimeLimit=0, ModelConfig=MODEL)
    memory = truth(sample)
    size = data.stat().st_size
    about = f"{size / 2**30:.0f} GiB raw, MemoryLimit 1024, {STEPS} steps, {phases(run)}"
    yield results_file.result("peak memory MiB", round(run["peak"]), "MiB", "lower",
                              about + "; above the idle process", target=1024)
    yield results_file.result("file bytes read ratio", round(run["read"] / size, 3), "", "lower",
                              "all the process read, over the file", target=3)
    yield results_file.result("PSNR of 2048^3 from pieces", round(streamed["psnr"], 2), "dB",
                              "higher", f"10^8 random voxels; ratio {streamed['ratio']:.0f}")
    yield results_file.result("PSNR of pieces minus PSNR from memory",
                              round(streamed["psnr"] - memory["psnr"], 2), "dB", "higher",
                              "from memory: every fourth voxel (512^3), same model and steps, "
                              f"{memory['psnr']:.2f} dB on voxels of its own", target=-0.3)


def killed(model, source, **writer):
    """Bytes that a training has read when a kill ends it, half a minute after its first checkpoint."""
    process = subprocess.Popen(command(model, *source, **writer))
    checkpoint = Path(f"{model}.checkpoint")
    while not checkpoint.exists() and process.poll() is None:
        time.sleep(0.1)
    time.sleep(30)
    read = int(Path(f"/proc/{process.pid}/io").read_text().split()[1])
    process.kill()
    process.wait()
    if model.exists():
        raise RuntimeError(f"{model} was ready before the kill")
    return read


def resumed():
    data, reader = cube(1024)
    model = folder / "resumed.inr"
    model.unlink(missing_ok=True)
    source = ("ImageReader", reader)
    settings = {"MemoryLimit": 1024, "MaximumSteps": STEPS, "TimeLimit": 0, "ModelConfig": MODEL,
                "CheckpointInterval": 10}
    first = killed(model, source, **settings)
    run = train(model, *source, **settings)
    size = data.stat().st_size
    parts = f"{first / size:.2f} before a kill -9, {run['read'] / size:.2f} after it"
    yield results_file.result("file bytes read ratio of a resumed training",
                              round((first + run["read"]) / size, 3), "", "lower",
                              f"{size / 2**30:.0f} GiB raw, {STEPS} steps, {parts}", target=3)
    yield results_file.result("PSNR of a resumed training", round(truth(model)["psnr"], 2), "dB",
                              "higher", "10^8 random voxels")


def channel(name, divisor):
    dims = [voxels // divisor for voxels in CHANNEL]
    model = folder / f"{name.replace(' ', '-')}.inr"
    run = train(model, "TurbulentChannel", {"Dimensions": dims, "OutputScalarType": "double"},
                MemoryLimit=4096, TimeLimit=300, ModelConfig=MODEL.replace(": 17", ": 20"))
    good = truth(model)
    about = (f"{dims[0]} x {dims[1]} x {dims[2]} doubles, {phases(run)}, peak {run['peak']:.0f} MiB "
             "above the idle process of MemoryLimit 4096")
    yield results_file.result(f"{name} model MB", round(good["file_bytes"] / 1e6, 1), "MB", "lower",
                              about, target=150)
    yield results_file.result(f"{name} PSNR", round(good["psnr"], 2), "dB", "higher",
                              f"10^8 random voxels; largest error {good['max_error']:.3g} of a range "
                              f"of {good['field_range'][1] - good['field_range'][0]:.3g}; ratio "
                              f"{good['ratio']:.0f}", target=35)


def flight(name, divisor):
    """With the picture that belongs to them."""
    dims = [voxels // divisor for voxels in CHANNEL]
    model = folder / f"{name.replace(' ', '-')}.inr"
    return channel_flight.results(build, folder / "pictures", model, dims)


PARTS = {"raw": raw_file, "resumed": resumed, "half-channel": lambda: channel("half channel", 2),
         "half-channel-flight": lambda: flight("half channel", 2),
         "channel": lambda: channel("channel", 1),
         "channel-flight": lambda: flight("channel", 1),
         "ranks": lambda: channel_ranks.results(build, folder, MODEL),
         "rank-pictures": lambda: rank_pictures.results(build, folder)}
parts = sys.argv[3:] or list(PARTS)
folder.mkdir(parents=True, exist_ok=True)
for part in parts:
    path = results_file.write(f"terascale-{part}", list(PARTS[part]()))
    picture = folder / "pictures" / "beside.png"
    if part.endswith("flight"):
        path.with_suffix(".png").write_bytes(picture.read_bytes())
