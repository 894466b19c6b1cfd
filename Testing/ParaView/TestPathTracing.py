# SPDX-License-Identifier: BSD-3-Clause
"""Path tracing in ParaView: the medium is ray marching's, the light is the view's."""
import re

import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()
view = show_view((120, 120))
view.UseLight = 0
display = simple.Show(simple.OpenDataFile(MODEL), view)
look_at(view)
colors = simple.GetColorTransferFunction(ARRAY)


def paint(grey):
    """One colour for all values."""
    low, high = colors.RGBPoints[0], colors.RGBPoints[-4]
    colors.RGBPoints = [low, grey, grey, grey, high, grey, grey, grey]


def shown(name, **properties):
    for key, value in properties.items():
        setattr(display, key, value)
    pixels = picture(view, "paths-" + name)
    display.UpdatePropertyInformation()
    print(f"{name}: {display.GetPropertyValue('FrameTime'):.2f} s")
    check(display.GetPropertyValue("Converged") == 1, name, "is not converged")
    return pixels


def check_same(traced, marched, name, floor):
    """Noise has no direction: it is in the pixels, hardly in their mean."""
    error = traced - marched
    print(f"{name}: PSNR {psnr(traced, marched):.1f} dB, mean {error.mean():.5f}")
    check(np.abs(marched - marched[0, 0]).max() > 0.3, name, "shows nothing")
    check(abs(error.mean()) < 0.004, name, "is off by", error.mean())
    check(psnr(traced, marched) > floor, name, "is noisy:", psnr(traced, marched))


check(display.RenderMode == "Ray Marching", "the default is", display.RenderMode)
rainbow = list(colors.RGBPoints)

# Soot in front of white paper, with a ball inside: what marching black makes.
ball = simple.Show(simple.Sphere(Center=[45, 45, 45], Radius=22), view)
ball.AmbientColor = ball.DiffuseColor = [0, 0.8, 0]
ball.Ambient = 1
paint(0)
marched = shown("marched-soot", SampleDistance=0.2)
paint(1)
settings = dict(RenderMode="Path Tracing", SamplesPerPixel=64)
soot = shown("soot", ScatteringAlbedo=0, AmbientLight=[1, 1, 1], **settings)
check_same(soot, marched, "soot", 25)
simple.Delete(ball)

# White in a white furnace: what marching white makes.
view.Background = [0, 0, 0]
furnace = shown("furnace", ScatteringAlbedo=1, MaximumBounces=100000)
coarse = shown("furnace-coarse", SamplesPerPixel=8)
marched = shown("marched-white", RenderMode="Ray Marching")
check_same(furnace, marched, "furnace", 25)
check(psnr(coarse, marched) < psnr(furnace, marched) - 5, "more samples do not help")

# Lights: none, one, the same at half, from the other side, the view's own.
colors.RGBPoints = rainbow
dark = shown("dark", AmbientLight=[0, 0, 0], MaximumBounces=16, SamplesPerPixel=32, **{
    "RenderMode": "Path Tracing"})
check(dark.max() == 0, "light from nowhere:", dark.max())
light = simple.AddLight(view)
light.Coords, light.Type = "Scene", "Directional"
light.Position, light.FocalPoint = [500, 45, 45], [45, 45, 45]
light.Intensity = 1
right = shown("right")
check(right.max() > 0.1, "no light:", right.max())
light.Intensity = 0.5
check(abs(shown("half").mean() / right.mean() - 0.5) < 0.05, "half the light is not half")
light.Intensity = 1
light.Position = [-400, 45, 45]
left = shown("left")
check(psnr(left, right) < 30, "the sides do not differ")
check(psnr(shown("forward", ScatteringAnisotropy=0.8), left) < 35, "anisotropy does not show")
display.VolumeAnisotropy = -0.5  # that of ParaView's own volumes
simple.Render(view)
mappers = " ".join(str(volume.GetMapper()) for volume in view.GetRenderer().GetVolumes())
found = re.findall(r" Anisotropy: (\S+)", mappers)
check(found == ["0.8"], "another anisotropy:", found)
display.ScatteringAnisotropy = 0
light.Enable = 0
check(shown("off").max() == 0, "a light that is off")
view.UseLight = 1
kit = shown("light-kit", SamplesPerPixel=128)
check(kit.max() > 0.1, "the light kit does not light")
with_ambient = shown("default", AmbientLight=[0.5, 0.5, 0.5])
check(with_ambient.mean() > kit.mean(), "ambient light does not light")

# Interactive pictures come at once and lead to the still one.
display.SamplesPerPixel = 4
proxy = view.SMProxy
for _ in range(100):
    proxy.InteractiveRender()
    display.UpdatePropertyInformation()
    if display.GetPropertyValue("Converged") == 1:
        break
check(display.GetPropertyValue("Converged") == 1, "interactive pictures do not converge")
