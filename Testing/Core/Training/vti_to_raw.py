#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Unpacks the only array of a .vti in VTK XML's inline, zlib-compressed binary form.

    vti_to_raw.py IN.vti OUT.raw
"""
import base64
import re
import struct
import sys
import zlib
from pathlib import Path

source, target = map(Path, sys.argv[1:])
text = source.read_text()
body = re.search(r'format="binary"[^>]*>\s*([A-Za-z0-9+/=]+)', text)[1]
word = "Q" if 'header_type="UInt64"' in text else "I"
size = struct.calcsize(word)


def encoded_length(byte_count):
    return (byte_count + 2) // 3 * 4


blocks = struct.unpack_from(word, base64.b64decode(body[:encoded_length(size)]))[0]
header_length = encoded_length((3 + blocks) * size)
header = struct.unpack(f"<{3 + blocks}{word}", base64.b64decode(body[:header_length])[:(3 + blocks) * size])
data = base64.b64decode(body[header_length:])
pieces, first = [], 0
for length in header[3:]:
    pieces.append(zlib.decompress(data[first:first + length]))
    first += length
target.parent.mkdir(parents=True, exist_ok=True)
target.write_bytes(b"".join(pieces))
