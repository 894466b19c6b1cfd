# SPDX-License-Identifier: BSD-3-Clause
"""Files larger than MemoryLimit, saved without ever being read as a whole."""
import os
import resource

import numpy as np
from paraview import servermanager, simple
from pvtest import Messages, check, load_plugin, output_file

load_plugin()

LIMIT = 150  # MiB
DIMS = (384, 300, 360)  # 158 MiB as floats
MODEL = """{"encoding": {"otype": "HashGrid", "n_levels": 4, "n_features_per_level": 4,
"log2_hashmap_size": 12, "base_resolution": 6, "per_level_scale": 1.6},
"network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 2,
"activation": "ReLU", "output_activation": "None"}}"""


def peak():
    """MiB, of the process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def field():
    x, y, z = (np.linspace(0, 1, n, dtype=np.float32) for n in DIMS)
    waves = np.sin(7 * x)[None, None, :] * np.cos(5 * y)[None, :, None]
    for layer in range(DIMS[2]):
        yield (20 + 10 * waves[0] * np.cos(3 * z[layer]) + z[layer]).astype(np.float32)


def write_raw(path, kind):
    with open(path, "wb") as file:
        for layer in field():
            file.write(layer.astype(kind).tobytes())


def save(source, name, limit=LIMIT):
    """Trains from the source, which nothing has updated."""
    path = output_file(name)
    if os.path.exists(path):
        os.remove(path)
    before = peak()
    with Messages() as messages:
        writer = servermanager.writers.INRWriter(Input=source, FileName=path, MemoryLimit=limit,
                                                 MaximumSteps=150, TimeLimit=0, ModelConfig=MODEL)
        writer.UpdatePipeline()
    check(messages.errors() == 0, "saving reported", messages.text)
    check(peak() - before < limit, name, "took", peak() - before, "MiB")
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    psnr = reader.FieldData["INRPSNR"].GetRange(0)[0]
    check(psnr > 30, name, "has", psnr, "dB")
    bounds = reader.GetDataInformation().GetBounds()
    check(bounds == (0, DIMS[0] - 1, 0, 2 * (DIMS[1] - 1), 0, 3 * (DIMS[2] - 1)), "bounds", bounds)
    print(f"{name}: {psnr:.1f} dB, {peak() - before:.0f} MiB more than before")
    return reader


raw = output_file("streamed.raw")
write_raw(raw, ">f4")
source = simple.ImageReader(FileNames=[raw], DataScalarType="float", DataByteOrder="BigEndian",
                            FileDimensionality=3,
                            DataExtent=[0, DIMS[0] - 1, 0, DIMS[1] - 1, 0, DIMS[2] - 1],
                            DataSpacing=[1, 2, 3])
reader = save(source, "streamed-raw.inr")
low, high = reader.GetDataInformation().GetPointDataInformation().GetArrayInformation(0) \
    .GetComponentRange(0)
check(abs(low - 10) < 0.2 and abs(high - 31) < 1.2, "range", low, high)

# A filter that keeps what it got for a time, of whatever extent that was: in pieces, and where a
# voxel is asked for before the whole.
save(simple.ForceTime(Input=source), "streamed-forced.inr")
save(simple.ForceTime(Input=source), "forced.inr", limit=640)

header = output_file("streamed.mhd")
with open(header, "w") as file:
    file.write("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\n"
               f"DimSize = {DIMS[0]} {DIMS[1]} {DIMS[2]}\nElementSpacing = 1 2 3\n"
               "ElementType = MET_FLOAT\nElementDataFile = streamed.raw\n")
# VTK's reader of MetaImages would write the whole file into the memory of a part.
with Messages() as messages:
    servermanager.writers.INRWriter(
        Input=simple.OpenDataFile(header), FileName=output_file("streamed-mhd.inr"),
        MemoryLimit=LIMIT, MaximumSteps=2, TimeLimit=0, ModelConfig=MODEL).UpdatePipeline()
check("vtkMetaImageReader" in messages.text and messages.errors() == 0, messages.text)
check(os.path.exists(output_file("streamed-mhd.inr")), "no file of a MetaImage")

# ParaView's reader would try for ever to read from before the beginning of a file that is too short.
layers = np.arange(4 * 50 * 50, dtype=np.float32).reshape(4, 50, 50)
whole, cut = output_file("whole.raw"), output_file("cut.raw")
layers.tofile(whole)
layers.tofile(cut)
os.truncate(cut, layers.nbytes - 4)


def save_cut(files, shown, time=None, **properties):
    """Of all steps, or one. What is said, and which files there are then."""
    series = simple.ImageReader(FileNames=files, DataScalarType="float", FileDimensionality=3,
                                DataExtent=[0, 49, 0, 49, 0, 3])
    if shown:
        series.UpdatePipeline()
    names = [output_file(name) for name in ("cut.inr", "cut_0.inr", "cut_1.inr", "cut_2.inr")]
    for name in names:
        if os.path.exists(name):
            os.remove(name)
    with Messages() as messages:
        writer = servermanager.writers.INRWriter(
            Input=series, FileName=names[0], MaximumSteps=2, TimeLimit=0, ModelConfig=MODEL,
            Writetimestepsasfileseries=int(time is None), **properties)
        writer.UpdatePipeline() if time is None else writer.UpdatePipeline(time)
    return messages, [os.path.basename(name) for name in names if os.path.exists(name)]


for files, shown, time, limit in [([cut], False, None, LIMIT), ([cut], False, None, 0),
                                  ([whole, cut], False, None, LIMIT), ([whole, cut], True, None, 0),
                                  ([whole, cut], False, 1.0, 0), ([whole, cut], True, 1.0, 0)]:
    messages, found = save_cut(files, shown, time, MemoryLimit=limit)
    check(f"'{cut}' has 39996 bytes" in messages.text, "short:", messages.text)
    check(messages.errors() == 1 and not found, "short:", messages.text, found)
# Those that are not asked for may still be being written.
for files, chosen, expected in [([whole, cut], {"Lasttimestep": 0}, ["cut_0.inr"]),
                                ([whole, cut, whole], {"Timestepstride": 2},
                                 ["cut_0.inr", "cut_2.inr"])]:
    messages, found = save_cut(files, False, **chosen)
    check(messages.errors() == 0 and found == expected, "chosen:", messages.text, found)
os.remove(raw)
