# SPDX-License-Identifier: BSD-3-Clause
"""Translucent surfaces in front of, inside and behind the volume, as ParaView peels them. Truth:
pictures of the parts laid over each other by hand, and stock volume rendering of the voxels."""
import numpy as np
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
display.ScalarOpacityUnitDistance = 4  # as a mist, to see what is behind
look_at(view)
camera = view.GetActiveCamera()
middle = np.array(view.CameraFocalPoint)
towards = np.array(camera.GetViewPlaneNormal())
eye = [list(view.CameraPosition), list(view.CameraFocalPoint), list(view.CameraViewUp)]
sphere = simple.Sphere(ThetaResolution=64, PhiResolution=64)
glass = simple.Show(sphere, view)
glass.SetRepresentationType("Surface")
glass.AmbientColor = glass.DiffuseColor = [0, 0.6, 0]
glass.Opacity = 0.5


def place(distance, radius):
    sphere.Center, sphere.Radius = list(middle + distance * towards), radius
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = eye


def rgba(name, *shown):
    """What is shown alone, premultiplied, from pictures before black and white."""
    for source in (reader, sphere):
        simple.Show(source, view) if source in shown else simple.Hide(source, view)
    pictures = []
    for grey in (0, 1):
        view.Background = [grey] * 3
        pictures.append(picture(view, f"translucent-{name}-{grey}"))
    alpha = 1 - np.mean(pictures[1] - pictures[0], axis=2, keepdims=True)
    return np.concatenate([pictures[0], alpha], axis=2)


def over(front, back):
    return front + (1 - front[..., 3:]) * back


def compare(name, shown, truth):
    difference = np.abs(shown - truth)
    print(f"{name}: largest difference {255 * difference.max():.1f}/255, mean "
          f"{255 * difference.mean():.2f}/255")
    check(difference.mean() < 1 / 255, name, "differs from its parts by", difference.mean())
    worst = np.quantile(difference, 0.99)  # the rest are edges, which ParaView smooths
    check(worst < 4 / 255, name, "differs from its parts by", worst)


with Messages() as messages:
    volume = rgba("volume", reader)
    for name, distance in (("in-front", 130), ("behind", -130)):
        place(distance, 35)
        surface = rgba(name + "-surface", sphere)
        check(surface[..., 3].max() > 0.7, "both sides of the sphere do not show")
        truth = over(surface, volume) if distance > 0 else over(volume, surface)
        together = rgba(name, reader, sphere)
        compare(name, together, truth)
        wrong = over(volume, surface) if distance > 0 else over(surface, volume)
        distances = np.abs(together - truth).mean(), np.abs(together - wrong).mean()
        check(distances[1] > 5 * distances[0], name, "is", distances, "from either order")

    # Inside.
    place(0, 30)
    view.Background = [1, 1, 1]
    simple.Show(reader, view)
    simple.Show(sphere, view)
    inside = picture(view, "translucent-inside")
    view.SMProxy.InteractiveRender()
    again = picture(view, "translucent-inside-again")
    check(np.array_equal(inside, again), "an interactive picture changes the next still one")
    # It does not depend on whether ParaView peels volumes.
    settings = simple.GetSettingsProxy("RenderViewSettings")
    if "DepthPeelingForVolumes" in settings.ListProperties():
        settings.DepthPeelingForVolumes = 0
        likeness = psnr(inside, picture(view, "translucent-inside-unpeeled"))
        check(likeness > 50, "without peeling volumes:", likeness, "dB")
        settings.DepthPeelingForVolumes = 1

    # That is what stock volume rendering of the same voxels shows, which takes part in the peeling.
    voxels = simple.INRDecode(Input=reader)
    stock = simple.Show(voxels, view)
    stock.SetRepresentationType("Volume")
    stock.ScalarOpacityUnitDistance = display.ScalarOpacityUnitDistance
    simple.ColorBy(stock, ("POINTS", display.ColorArrayName[1]))
    simple.Hide(reader, view)
    truth = picture(view, "translucent-inside-stock")
    simple.Hide(voxels, view)
    simple.Show(reader, view)
    likeness = psnr(picture(view, "translucent-inside"), truth)
    print(f"inside: {likeness:.1f} dB from stock volume rendering")
    check(likeness > 35, "inside is", likeness, "dB from stock volume rendering")

    # Paths are seen through it, too.
    place(130, 35)
    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 16
    traced = over(rgba("paths-surface", sphere), rgba("paths", reader))
    compare("in front of paths", rgba("paths-together", reader, sphere), traced)
check(messages.errors() == 0, "reported:", messages.text)
