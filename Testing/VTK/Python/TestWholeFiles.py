# SPDX-License-Identifier: BSD-3-Clause
"""Readers of VTK that say that they give parts of their files, and do not, are asked for whole files."""
import array
import gzip
import os
import struct
import tempfile

from inrvolume import vtkINRReader, vtkINRWriter
from vtkmodules.vtkIOImage import vtkDICOMImageReader, vtkNrrdReader

EDGE, LAYERS = 128, 6  # 192 KiB: of what may be so much more, a voxel is asked for first
MODEL = """{"encoding": {"otype": "HashGrid", "n_levels": 2, "n_features_per_level": 2,
"log2_hashmap_size": 10, "base_resolution": 4, "per_level_scale": 2.0},
"network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 1,
"activation": "ReLU", "output_activation": "None"}}"""


def layer(z):
    return array.array("h", (x + 2 * y + 100 * z for y in range(EDGE) for x in range(EDGE)))


RANGE = (0, 127 + 2 * 127 + 100 * (LAYERS - 1))


def element(group, number, kind, value):
    """Of a DICOM file, explicit little endian."""
    value = value.encode() if isinstance(value, str) else value
    value += b"\0" * (len(value) % 2) if kind in ("UI", "OB") else b" " * (len(value) % 2)
    length = struct.pack("<HI", 0, len(value)) if kind in ("OB", "OW") else struct.pack("<H", len(value))
    return struct.pack("<HH", group, number) + kind.encode() + length + value


def write_dicom(path, z):
    def number(value):
        return struct.pack("<H", value)

    meta = (element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2")
            + element(2, 3, "UI", f"1.2.3.{z}") + element(2, 0x10, "UI", "1.2.840.10008.1.2.1"))
    data = (element(0x20, 0xE, "UI", "1.2.3.9") + element(0x20, 0x13, "IS", str(z))
            + element(0x20, 0x32, "DS", f"0\\0\\{z}") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
            + element(0x28, 2, "US", number(1)) + element(0x28, 4, "CS", "MONOCHROME2")
            + element(0x28, 0x10, "US", number(EDGE)) + element(0x28, 0x11, "US", number(EDGE))
            + element(0x28, 0x30, "DS", "1\\1") + element(0x28, 0x100, "US", number(16))
            + element(0x28, 0x101, "US", number(16)) + element(0x28, 0x102, "US", number(15))
            + element(0x28, 0x103, "US", number(1)) + element(0x28, 0x1052, "DS", "0")
            + element(0x28, 0x1053, "DS", "1") + element(0x7FE0, 0x10, "OW", layer(z).tobytes()))
    with open(path, "wb") as file:
        file.write(b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data)


def dicom(folder):
    for z in range(LAYERS):
        write_dicom(os.path.join(folder, f"{z}.dcm"), z)
    reader = vtkDICOMImageReader()
    reader.SetDirectoryName(folder)
    return reader


def nrrd(folder, encoding, encode):
    """The values stand in a file of their own: VTK reads no text behind a header."""
    path = os.path.join(folder, "field.nhdr")
    with open(path, "w") as file:
        file.write(f"NRRD0004\ntype: short\ndimension: 3\nsizes: {EDGE} {EDGE} {LAYERS}\nendian: little\n"
                   f"encoding: {encoding}\ndata file: field.values\n")
    with open(os.path.join(folder, "field.values"), "wb") as file:
        file.write(encode(b"".join(layer(z).tobytes() for z in range(LAYERS))))
    reader = vtkNrrdReader()
    reader.SetFileName(path)
    return reader


def text(data):
    return " ".join(str(value) for value in array.array("h", data)).encode()


def check_saved(name, source, folder):
    path = os.path.join(folder, "saved.inr")
    writer = vtkINRWriter()
    writer.SetInputConnection(source.GetOutputPort())
    writer.SetFileName(path)
    writer.SetModelConfig(MODEL)
    writer.SetMaximumSteps(300)
    writer.SetMemoryLimit(1)
    assert writer.Write() == 1 and writer.GetErrorCode() == 0, (name, writer.GetErrorCode())
    reader = vtkINRReader()
    reader.SetFileName(path)
    reader.Update()
    found = reader.GetOutput().GetPointData().GetScalars().GetRange()
    print(name, found, writer.GetPSNR())
    assert writer.GetPSNR() > 25 and all(abs(a - b) < 50 for a, b in zip(found, RANGE)), name
    os.remove(path)


for name, make in [("DICOM", dicom), ("raw", lambda folder: nrrd(folder, "raw", bytes)),
                   ("gzip", lambda folder: nrrd(folder, "gzip", gzip.compress)),
                   ("text", lambda folder: nrrd(folder, "ascii", text))]:
    with tempfile.TemporaryDirectory() as scratch, tempfile.TemporaryDirectory() as target:
        check_saved(name, make(scratch), target)
