# SPDX-License-Identifier: BSD-3-Clause
"""A scaled volume has what it shows in the same place and, but for detail, the same looks."""
import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, picture, show_view, ssim

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)


def silhouette(pixels):
    """First and last column and row with something in them."""
    seen = np.any(pixels < 0.98, axis=2)
    columns, rows = np.flatnonzero(seen.any(axis=0)), np.flatnonzero(seen.any(axis=1))
    return np.array([columns[0], columns[-1], rows[0], rows[-1]])


def shown(factor):
    reader.ScaleFactor = factor
    pixels = picture(view, f"scale-{factor}")
    display.UpdatePropertyInformation()
    check(display.GetPropertyValue("Converged") == 1, "not converged at", factor)
    return pixels


native = shown(1)
bounds = reader.GetDataInformation().GetBounds()
for factor, floor in ((0.25, 0.9), (4, 0.97)):
    pixels = shown(factor)
    voxels = reader.FieldData["INRScaledDimensions"].GetRange(0)[0]
    check(voxels == round(91 * factor), factor, "times the voxels are", voxels)
    for axis in range(3):
        # Points are half a voxel inside of the box of all voxels, which stays.
        low, high = bounds[2 * axis:2 * axis + 2]
        inside = 0.5 * (high - low) / 90 * (91 / voxels - 1)
        ours = reader.GetDataInformation().GetBounds()[2 * axis:2 * axis + 2]
        check(np.allclose(ours, (low + inside, high - inside), rtol=1e-9), "bounds at", factor, ours)
    edge = np.abs(silhouette(pixels) - silhouette(native)).max()
    per_voxel = np.ptp(silhouette(native)[:2]) / 90
    moved = abs(edge - abs(91 / voxels - 1) / 2 * per_voxel)
    similarity = ssim(pixels, native)
    print(f"factor {factor}: silhouette moves by {edge} pixels, {moved:.1f} too many, SSIM {similarity:.4f}")
    check(moved <= 3, "the silhouette moves by", moved, "pixels too many at", factor)
    check(similarity >= floor, "SSIM is", similarity, "at", factor)
check(np.array_equal(shown(1), native), "no way back to the native voxels")

with Messages() as messages:
    reader.ScaleFactor = 7
    reader.UpdatePipeline()
check(messages.errors() == 1 and "ScaleFactor" in messages.text, "for a factor of 7", messages.text)
check(reader.GetDataInformation().GetNumberOfPoints() == 0, "a factor of 7 shows something")
