#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program that writes raw volumes: types, byte orders, header, pipe, and what it refuses.

    TestPrograms.py TURBULENT_CHANNEL FOLDER
"""
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy

PROGRAM, FOLDER = sys.argv[1:3]
SIZES = ["70", "12", "9"]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, cwd=FOLDER)


def write(name, *options):
    result = run(*SIZES, name + ".mhd", *options)
    assert result.returncode == 0, result.stderr
    header = dict(line.split(" = ") for line in open(f"{FOLDER}/{name}.mhd").read().splitlines())
    order = ">" if header["BinaryDataByteOrderMSB"] == "True" else "<"
    kind = {"MET_FLOAT": "f4", "MET_DOUBLE": "f8"}[header["ElementType"]]
    raw = numpy.fromfile(f"{FOLDER}/{header['ElementDataFile']}", order + kind)
    return header, raw


def refuses(expected, *arguments, status=2):
    before = sorted(os.listdir(FOLDER))
    result = run(*arguments)
    assert result.returncode == status, (arguments, result.returncode, result.stderr)
    assert expected in result.stderr.decode(), (expected, result.stderr)
    assert result.stdout == b"", "voxels of what was refused"
    assert sorted(os.listdir(FOLDER)) == before, "something was left behind"


shutil.rmtree(FOLDER, ignore_errors=True)
os.makedirs(FOLDER)

header, little = write("little", "--type", "float64")
assert header["DimSize"].split() == SIZES, header
spacing = [float(text) for text in header["ElementSpacing"].split()]
assert numpy.allclose(spacing, numpy.array([8 * numpy.pi, 3 * numpy.pi, 2]) / [70, 12, 9], rtol=1e-15)
assert numpy.allclose([float(t) for t in header["Offset"].split()], numpy.array(spacing) / 2)
assert little.size == 70 * 12 * 9 and numpy.ptp(little) > 0.5, "no field"

header, big = write("big", "--type", "float64", "--endian", "big")
assert header["BinaryDataByteOrderMSB"] == "True"
assert numpy.array_equal(big.astype("<f8"), little)
assert big.tobytes() != little.tobytes()

header, single = write("single")
assert header["ElementType"] == "MET_FLOAT"
assert numpy.array_equal(single, little.astype("f4"))

_, other = write("other", "--type", "float64", "--seed", "2")
assert not numpy.array_equal(other, little)

piped = run(*SIZES, "-", "--type", "float64")
assert piped.returncode == 0 and piped.stdout == little.tobytes()

refuses("room", "100000", "100000", "100000", "huge.mhd", status=1)
refuses("no size", "0", "1", "1", "none.mhd")
refuses("no number", "1x", "1", "1", "none.mhd")
refuses(".mhd", *SIZES, "name.raw")
refuses("neither", *SIZES, "none.mhd", "--type", "int8")
refuses("--colour", *SIZES, "none.mhd", "--colour", "red")
refuses("octaves", *SIZES, "none.mhd", "--octaves", "9")
refuses("cannot write", *SIZES, "missing/none.mhd", status=1)
refuses("sizes", "1", "1", "none.mhd")

# A signal leaves nothing either.
before = sorted(os.listdir(FOLDER))
with subprocess.Popen([PROGRAM, "4096", "1024", "64", "stopped.mhd"], cwd=FOLDER,
                      stderr=subprocess.PIPE) as writing:
    deadline = time.monotonic() + 30
    while sorted(os.listdir(FOLDER)) == before and time.monotonic() < deadline:
        time.sleep(0.002)
    writing.send_signal(signal.SIGTERM)
    message = writing.stderr.read().decode()
assert writing.returncode == 1 and "stopped" in message, (writing.returncode, message)
assert sorted(os.listdir(FOLDER)) == before, "a stopped program left something behind"

# The disk fills up although there seemed to be room.
limited = subprocess.run(["bash", "-c", f"ulimit -f 100; trap '' XFSZ; '{PROGRAM}' 256 64 64 full.mhd"],
                         cwd=FOLDER, capture_output=True)
assert limited.returncode == 1 and b"cannot write" in limited.stderr, limited
assert sorted(os.listdir(FOLDER)) == before, "a full disk left something behind"
