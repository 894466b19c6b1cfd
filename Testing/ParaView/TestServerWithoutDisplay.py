# SPDX-License-Identifier: BSD-3-Clause
"""A server that has no display is asked to draw, and does not die of it: this process draws instead.
Arguments: the server's port and more."""
import sys

from pvtest import check, connect, load_plugin, picture, show_model, ssim
from paraview import simple

load_plugin()
view, display = show_model()
expected = picture(view, "no-display-here")
check(expected.std() > 0.05, "nothing is shown")
connect(sys.argv[1])
view, display = show_model()
found = picture(view, "no-display-there")
similarity = ssim(found, expected)
print(f"SSIM with this process' picture {similarity:.4f}")
check(similarity > 0.99, "another picture", similarity)
# It goes on.
display.RenderMode = "Path Tracing"
display.SamplesPerPixel = 2
check(picture(view, "no-display-paths").std() > 0.05, "no paths are shown")
wavelet = simple.Wavelet()
wavelet.UpdatePipeline()
check(wavelet.GetDataInformation().GetNumberOfPoints() == 21**3, "the server is gone")
simple.Disconnect()
