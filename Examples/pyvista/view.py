# SPDX-License-Identifier: BSD-3-Clause
"""Renders a model file with PyVista and the wheel of INRVolume.

    python3 Examples/pyvista/view.py MODEL.inr PICTURE.png
"""
import sys

import pyvista
from inrvolume import vtkINRReader, vtkINRVolumeMapper

if len(sys.argv) != 3:
    sys.exit(f"usage: {sys.argv[0]} MODEL.inr PICTURE.png")
model_file, picture_file = sys.argv[1:]

reader = vtkINRReader()
reader.SetFileName(model_file)
reader.Update()
image = reader.GetOutput()
if image.GetNumberOfPoints() == 0:
    sys.exit(f"{model_file} cannot be shown; the message above says why.")

volume = pyvista.Volume()
volume.mapper = vtkINRVolumeMapper()
volume.mapper.SetInputConnection(reader.GetOutputPort())
table = pyvista.LookupTable("viridis", scalar_range=image.GetScalarRange())
table.apply_opacity("linear")
volume.prop = pyvista.VolumeProperty(lookup_table=table)
volume.prop.opacity_unit_distance = image.GetLength() / 100

plotter = pyvista.Plotter(off_screen=True, window_size=(600, 600))
plotter.add_actor(volume)
try:
    plotter.screenshot(picture_file)
except OSError as error:
    sys.exit(f"{picture_file} was not written: {error}")
print(f"{picture_file}: {volume.mapper.GetFrameTime():.2f} s on {volume.mapper.GetBackendInUse()}")
