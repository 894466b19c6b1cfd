# SPDX-License-Identifier: BSD-3-Clause
"""An INR among other things: opaque and translucent geometry, and data that is no INR."""
import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, check_baseline, load_plugin, look_at, picture, psnr
from pvtest import show_view

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)
alone = picture(view, "scene-alone")
display.UpdatePropertyInformation()

# An opaque sphere in the middle of the volume.
sphere = simple.Sphere(Center=[45, 45, 45], Radius=22, ThetaResolution=48, PhiResolution=48)
ball = simple.Show(sphere, view)
ball.SetRepresentationType("Surface")
ball.AmbientColor = ball.DiffuseColor = [0, 0.6, 0]
inside = picture(view, "scene-opaque-inside")
check_baseline(inside, "scene-opaque-inside")

# In front of the volume it hides it, behind the volume it shows through no more than the white did.
eye, focus = np.array(view.CameraPosition), np.array(view.CameraFocalPoint)
towards = (eye - focus) / np.linalg.norm(eye - focus)
middle = tuple(size // 2 for size in alone.shape[:2])
sphere.Center = list(focus + 110 * towards)
front = picture(view, "scene-opaque-in-front")[middle]
sphere.Center = list(focus - 110 * towards)
behind = picture(view, "scene-opaque-behind")[middle]
simple.Hide(reader, view)
bare = picture(view, "scene-opaque-bare")[middle]
simple.Show(reader, view)
check(np.all(np.abs(front[1] - bare[1]) < 0.25) and front[1] > front[0], "not in front:", front)
check(np.abs(behind - bare).max() > 0.2, "the volume does not cover the sphere:", behind, bare)

# A translucent sphere: ParaView peels it, and the volume has to come out as before.
sphere.Center = [45, 45, 45]
ball.Opacity = 0.6
with Messages() as messages:
    glass = picture(view, "scene-translucent")
check(messages.errors() == 0, "peeling reported", messages.text)
outside = np.all(np.abs(inside - alone) < 1e-6, axis=2)
check(outside.mean() > 0.3, "the sphere covers everything")
check(psnr(glass[outside][None], alone[outside][None]) > 40, "the volume changed beside the sphere")
check(np.abs(glass - alone).max() > 0.02, "the translucent sphere is not there")
check_baseline(glass, "scene-translucent")
simple.Delete(sphere)

# Moved, stretched and turned: the camera finds it, and it still fills its outline.
outline = simple.Outline(Input=reader)
box = simple.Show(outline, view)
box.AmbientColor = box.DiffuseColor = [0, 0, 0]
for item in (display, box):
    item.Position, item.Scale, item.Orientation = [500, 0, 0], [1, 2, 1], [0, 0, 30]
simple.Render(view)
view.ResetCamera()
check_baseline(picture(view, "scene-transformed"), "scene-transformed")
display.Position, display.Scale, display.Orientation = [0, 0, 0], [1, 1, 1], [0, 0, 0]
simple.Delete(outline)
simple.Render(view)
look_at(view)

# Ordinary voxels: one message, and nothing is drawn.
simple.Hide(reader, view)
wavelet = simple.Wavelet()
plain = simple.Show(wavelet, view)
with Messages() as messages:
    plain.SetRepresentationType("INR Volume")
    simple.Render(view)
    simple.Render(view)
check(messages.errors() == 1, "wanted one message, got", messages.errors())
check("RTData" in messages.text and "not an INR" in messages.text, "unclear:", messages.text)
plain.SetRepresentationType("Outline")
simple.Hide(wavelet, view)

# The session goes on.
simple.Show(reader, view)
check(psnr(picture(view, "scene-again"), alone) > 60, "the volume does not come back")

# Shaded by the view's headlight, as stock volume rendering shades the same voxels.
voxels = simple.INRDecode(Input=reader)
stock = simple.Show(voxels, view)
stock.SetRepresentationType("Volume")
simple.ColorBy(stock, ("POINTS", display.ColorArrayName[1]))
stock.ScalarOpacityUnitDistance = display.ScalarOpacityUnitDistance
pictures = {}
for shade in (0, 1):
    display.Shade = stock.Shade = shade
    simple.Hide(voxels, view)
    simple.Show(reader, view)
    pictures[shade] = picture(view, f"scene-shade-{shade}")
    simple.Hide(reader, view)
    simple.Show(voxels, view)
    other = picture(view, f"scene-shade-{shade}-stock")
    check(psnr(pictures[shade], other) > 35, "shade", shade, psnr(pictures[shade], other), "dB")
check(psnr(pictures[0], pictures[1]) < 30, "shading changes nothing", psnr(*pictures.values()))
