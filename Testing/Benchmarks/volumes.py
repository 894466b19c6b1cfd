# SPDX-License-Identifier: BSD-3-Clause
"""Volumes for the comparisons: the first point array of a .vti file of one piece, read without VTK,
whose reader a security update of expat broke for "appended" data."""
import base64
import contextlib
import re
import struct
import tempfile
import zlib
from pathlib import Path

import numpy


def name_of(path):
    return Path(path).stem


def read(path):
    """Voxels as [z, y, x], in their own type."""
    data = Path(path).read_bytes()
    header = data[:data.index(b"</PointData>")].decode("latin-1")
    extent = [int(number) for number in attribute(header, "Piece", "Extent").split()]
    shape = [extent[2 * axis + 1] - extent[2 * axis] + 1 for axis in (2, 1, 0)]
    array = re.search(r"<DataArray[^>]*>", header)
    if 'format="appended"' in array[0]:
        start = data.index(b"_", data.index(b"<AppendedData")) + 1
        stored = data[start + int(attribute(header, "DataArray", "offset")):]
    else:
        stored = decoded(data[array.end():data.index(b"<", array.end())].strip())
    kind = attribute(header, "DataArray", "type").lower()
    return numpy.frombuffer(inflated(stored), kind).reshape(shape)


def attribute(header, element, name):
    return re.search(rf'<{element}[^>]*\b{name}="([^"]*)"', header)[1]


def decoded(text):
    """Base64 of the table of blocks and of the blocks, each padded for itself."""
    count = struct.unpack_from("<I", base64.b64decode(text[:8]))[0]
    table = (4 * (3 + count) + 2) // 3 * 4
    return base64.b64decode(text[:table]) + base64.b64decode(text[table:])


def inflated(stored):
    """The bytes of zlib blocks: number of blocks, size, size of the last one, compressed sizes."""
    count = struct.unpack_from("<I", stored)[0]
    sizes = struct.unpack_from(f"<{count}I", stored, 12)
    blocks, at = [], 4 * (3 + count)
    for size in sizes:
        blocks.append(zlib.decompress(stored[at:at + size]))
        at += size
    return b"".join(blocks)


@contextlib.contextmanager
def raw_file(voxels):
    """What programs with a RawVolume take: a file of the voxels alone, type and sizes."""
    with tempfile.NamedTemporaryFile() as file:
        voxels.tofile(file.name)
        yield [file.name, voxels.dtype.name, *map(str, voxels.shape[::-1])]
