# SPDX-License-Identifier: BSD-3-Clause
"""Runs Examples/catalyst and compares its model files with the same steps computed here.

    pvpython check_catalyst.py pipeline.py FOLDER [LAUNCHER...] PROGRAM
"""
import os
import shutil
import subprocess
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

SCRIPT, FOLDER, *COMMAND = sys.argv[1:]
SIZE, EVERY, STEPS = 32, 5, 10


def run(*arguments, **environment):
    return subprocess.run([*COMMAND, *arguments], env={**os.environ, **environment},
                          capture_output=True, text=True, timeout=100)


def laplacian(field):
    return sum(numpy.roll(field, shift, axis) for axis in range(3) for shift in (-1, 1)) - 6 * field


def truth(steps):
    """Array [z, y, x] of the second substance."""
    z, y, x = numpy.mgrid[:SIZE, :SIZE, :SIZE] / SIZE
    u, v = numpy.ones_like(x), numpy.zeros_like(x)
    for a, b, c in ((0.5, 0.5, 0.5), (0.3, 0.4, 0.6), (0.7, 0.55, 0.35)):
        ball = (x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2 < 0.08**2
        u[ball], v[ball] = 0.25, 0.33
    for _ in range(steps):
        reaction = u * v * v
        u, v = (u + 0.9 * (0.16 * laplacian(u) - reaction + 0.03 * (1 - u)),
                v + 0.9 * (0.08 * laplacian(v) + reaction - 0.09 * v))
    return v


def decoded(path):
    """The voxels of a file as [z, y, x], and its time."""
    reader = simple.OpenDataFile(path)
    reader.UpdatePipelineInformation()
    image = servermanager.Fetch(simple.INRDecode(Input=reader))
    shape = image.GetDimensions()[::-1]
    voxels = vtk_to_numpy(image.GetPointData().GetArray("V")).reshape(shape)
    return voxels, list(reader.TimestepValues)


simple.LoadPlugin(os.environ["INR_PLUGIN"], remote=False, ns=vars(simple))
shutil.rmtree(FOLDER, ignore_errors=True)
os.makedirs(FOLDER)
result = run(SCRIPT, str(SIZE), str(STEPS), INR_EVERY=str(EVERY), INR_STEPS="100", INR_OUTPUT=FOLDER)
assert result.returncode == 0, result.stdout + result.stderr

for step in (EVERY, STEPS):
    expected = truth(step)
    voxels, times = decoded(f"{FOLDER}/grid_{step:06d}.inr")
    assert times in ([], [step]), times
    errors = abs(voxels - expected) / numpy.ptp(expected)
    psnr = -20 * numpy.log10(numpy.sqrt(numpy.mean(errors**2)))
    print(f"step {step}: {psnr:.1f} dB, largest error {errors.max():.3f}")
    assert psnr > 38, (step, psnr)
    assert errors.max() < 0.15, errors.max()
files = sorted(os.listdir(FOLDER))
assert files == ["grid_000005.inr", "grid_000010.inr"], files

# A file where the folder should be: the models are lost, which only the writer notices.
blocked = os.path.join(FOLDER, files[0], "folder")
result = run(SCRIPT, str(SIZE), str(EVERY), INR_EVERY=str(EVERY), INR_STEPS="1", INR_OUTPUT=blocked)
assert result.returncode != 0 and "failed in 1 step" in result.stderr, result.stderr

wrong = ((["missing.py"], "missing.py"), ([SCRIPT, "4"], "usage"), ([], "usage"))
for arguments, told in wrong if len(COMMAND) == 1 else ():
    result = run(*arguments)
    assert result.returncode != 0 and told in result.stderr, (arguments, result.stderr)
