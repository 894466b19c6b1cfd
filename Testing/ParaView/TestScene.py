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

# A click selects what is seen first.
width, height = view.ViewSize
check(view.SMProxy.Pick(width // 2, height // 2) is not None, "the middle cannot be picked")
simple.Hide(sphere, view)
simple.Render(view)
picked = view.SMProxy.Pick(width // 2, height // 2)
check(picked is not None and picked == display.SMProxy, "the volume cannot be picked:", picked)
check(view.SMProxy.Pick(2, 2) is None, "the volume is picked beside itself")
simple.Show(sphere, view)
check_baseline(picture(view, "scene-after-picking"), "scene-opaque-inside")

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

# However it is scaled: the opacity's unit distance is one of the data.
display.Shade = stock.Shade = 0
for scale in [0.01, 0.01, 0.01], [100, 100, 100], [1, 1, 4]:
    for item, shown, hidden in (display, reader, voxels), (stock, voxels, reader):
        item.Scale = scale
        simple.Hide(hidden, view)
        simple.Show(shown, view)
        if shown is reader:  # of stock volumes the view finds the bounds later
            look_at(view)
        pictures[shown] = picture(view, f"scene-scaled-{shown is voxels}")
    same = psnr(pictures[reader], pictures[voxels])
    check(same > 35, "scaled by", scale, "the volume is", same, "dB from its voxels")
for item in display, stock:
    item.Scale = [1, 1, 1]


# What is selected on its surface are the cells that are seen there; nobody sees points of a volume.
def selected_cells(select):
    simple.ClearSelection(reader)
    x, y = (size // 2 for size in view.ViewSize)
    select(Rectangle=[x, y, x, y], View=view)
    selection = reader.SMProxy.GetSelectionInput(0)
    if selection is None:
        return []
    source = selection.GetProperty("Input").GetProxy(0).GetProperty("IDs")
    return [source.GetElement(k) for k in range(1, source.GetNumberOfElements(), 2)]


simple.Hide(voxels, view)
simple.Show(reader, view)
opacity = simple.GetOpacityTransferFunction(display.ColorArrayName[1])
faint = list(opacity.Points)
opacity.Points = [value if k % 4 != 1 else 1 for k, value in enumerate(faint)]
view.CameraParallelProjection = 1
for direction, name, first in ([1, 0, 0], "front", 0), ([-1, 0, 0], "back", 89):
    view.CameraFocalPoint = [45.5, 45.5, 45.5]
    view.CameraPosition = [45.5 - 200 * direction[0], 45.5, 45.5]
    view.CameraViewUp = [0, 0, 1]
    view.CameraParallelScale = 30
    simple.Render(view)
    cells = selected_cells(simple.SelectSurfaceCells)
    places = [(cell % 90, cell // 90 % 90, cell // 8100) for cell in cells]
    check(len(places) == 1 and places[0][0] == first, name, "selects", places)
    check(all(44 <= place <= 46 for place in places[0][1:]), name, "selects", places)
    check(selected_cells(simple.SelectSurfacePoints) == [], "points are selected")
opacity.Points = faint
view.CameraParallelProjection = 0
simple.ClearSelection(reader)

# Groups: a message of what to do, and voxels.
simple.Hide(voxels, view)
group = simple.GroupDatasets(Input=[reader])
grouped = simple.Show(group, view)
with Messages() as messages:
    grouped.SetRepresentationType("INR Volume")
    simple.Render(view)
    simple.Render(view)
check(messages.errors() == 1 and "show the reader" in messages.text, "of a group:", messages.text)
with Messages() as messages:
    decoded = simple.INRDecode(Input=group)
    decoded.UpdatePipeline()
points = [source.GetDataInformation().GetNumberOfPoints() for source in (decoded, voxels)]
check(points[0] == points[1], "a group is decoded to", points, "points")
check("not an implicit" not in messages.text, "decoding a group reported", messages.text)
