# SPDX-License-Identifier: BSD-3-Clause
"""A thin peak of the opacity: samples that have the colours in between show it without grain."""
import numpy as np
from paraview import simple
from pvtest import ARRAY, MODEL, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()
view = show_view()
display = simple.Show(simple.OpenDataFile(MODEL), view)
look_at(view)
display.LevelOfDetailScale = 0
opacity = simple.GetOpacityTransferFunction(ARRAY)
low, high = opacity.Points[0], opacity.Points[-4]
peak = [(low + (high - low) * at, height) for at, height in ((0.2, 0), (0.22, 0.9), (0.24, 0))]
opacity.Points = [number for at, height in [(low, 0), *peak, (high, 0)]
                  for number in (at, height, 0.5, 0)]


def shown(name, distance, integrates):
    display.SampleDistance = distance
    display.PreIntegration = integrates
    return picture(view, f"pre-integration-{name}")


check(display.PreIntegration == 0, "is on without being asked for")
truth = shown("truth", 0.03, 0)
check(truth.std() > 0.02, "nothing is shown")
plain = psnr(shown("plain", 1, 0), truth)
integrated = shown("integrated", 1, 1)
print(f"a sample per voxel: {plain:.1f} dB plain, {psnr(integrated, truth):.1f} dB integrated")
check(psnr(integrated, truth) > plain + 5, plain, psnr(integrated, truth))

# It goes with light, and gives way to a tolerance; a state keeps it.
display.INRShade = 1
lit = psnr(shown("lit", 1, 1), shown("lit-truth", 0.03, 0))
check(lit > psnr(shown("lit-plain", 1, 0), shown("lit-truth", 0.03, 0)) + 3, "lit:", lit)
display.INRShade = 0
display.ErrorTolerance = 0
strict = shown("strict", 1, 1)
check(np.array_equal(strict, shown("strict-plain", 1, 0)), "it counts within a tolerance")
display.ErrorTolerance = -1
check(np.array_equal(shown("again", 1, 1), integrated), "another picture than before")
