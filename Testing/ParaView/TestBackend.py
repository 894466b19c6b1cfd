# SPDX-License-Identifier: BSD-3-Clause
"""What decodes the volume can be chosen, what did is said, and a GPU that is not there is reported
once and done without."""
from paraview import simple
from pvtest import MODEL, Messages, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()
view = show_view()
reader = simple.OpenDataFile(MODEL)
display = simple.Show(reader, view)
look_at(view)
check(display.Backend == "Auto", "the default is", display.Backend)


def shown(name):
    image = picture(view, "backend-" + name)
    display.UpdatePropertyInformation()
    return image, display.GetPropertyValue("BackendInUse")


display.Backend = "CPU"
truth, used = shown("cpu")
check(used.startswith("CPU ") and "CUDA" not in used, "the CPU is", used)

with Messages() as messages:
    display.Backend = "Auto"
    auto, used = shown("auto")
check(messages.text == "", "Auto is not silent:", messages.text)
check(psnr(auto, truth) >= 50, "Auto is", psnr(auto, truth), "dB from the CPU")

with Messages() as messages:
    display.Backend = "CUDA"
    cuda, used = shown("cuda")
    view.GetActiveCamera().Azimuth(10)
    simple.Render(view)
check(psnr(cuda, truth) >= 50, "CUDA is", psnr(cuda, truth), "dB from the CPU")
check(messages.errors() == 0, "an error:", messages.text)
reports = messages.text.count("There is no GPU for Backend CUDA (")
check(reports == (0 if "CUDA" in used else 1), used, "and", reports, "reports", messages.text)
