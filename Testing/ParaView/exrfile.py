# SPDX-License-Identifier: BSD-3-Clause
"""Reads OpenEXR files of the kind that INRVolume writes: one part, floats, compressed by ZIP."""
import struct
import zlib

import numpy as np
from pvtest import check


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def header(data):
    """The attributes of a one-part file as bytes by name, and where they end."""
    check(data[:8] == b"\x76\x2f\x31\x01\x02\0\0\0", "not a plain OpenEXR file")
    found, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def unpacked(packed, size):
    """Undoes OpenEXR's ZIP: deflate of byte differences of even bytes, then odd ones."""
    if len(packed) == size:
        return packed
    steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    steps[1:] -= 128
    halves = np.cumsum(steps).astype(np.uint8)
    whole = np.empty(size, np.uint8)
    whole[0::2], whole[1::2] = np.split(halves, [(size + 1) // 2])
    return whole.tobytes()


def read_exr(path):
    """Float channels by name, (h, w), row 0 at the top; after the format's description."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header(data)
    names, place = [], 0
    while attributes["channels"][place]:
        name, place = text(attributes["channels"], place)
        check(attributes["channels"][place] == 2, name, "is no float")
        names.append(name)
        place += 16
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    pixels = np.empty((height, len(names), width), np.float32)
    check(attributes["compression"] == b"\3", "compression", attributes["compression"])
    for offset in struct.unpack_from(f"<{-(-height // 16)}Q", data, at):
        row, size = struct.unpack_from("<2i", data, offset)
        rows = min(16, height - row)
        block = unpacked(data[offset + 8:offset + 8 + size], rows * len(names) * width * 4)
        pixels[row:row + rows] = np.frombuffer(block, "<f4").reshape(rows, len(names), width)
    return {name: pixels[:, k] for k, name in enumerate(names)}
