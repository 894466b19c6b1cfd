# SPDX-License-Identifier: BSD-3-Clause
"""The wheel in a clean virtual environment with PyVista: Testing/Wheel/run.sh starts it there.

    TestWheel.py VERSION FOLDER

VERSION is the project's; pictures and a model land in FOLDER. Writes the result file `wheel`.
"""
import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

version, folder = sys.argv[1], Path(sys.argv[2])
sources = Path(__file__).resolve().parents[2]
sys.path += [str(sources / "Testing" / name) for name in ("Python", "VTK/Python", "Benchmarks")]

import inrvolume  # noqa: E402
import numpy as np  # noqa: E402
import pyvista  # noqa: E402
import results_file  # noqa: E402
import torus_scene as scene  # noqa: E402
from PIL import Image  # noqa: E402
from similarity import ssim  # noqa: E402

model_file = folder / "model.inr"
picture_file = folder / "pyvista.png"
baseline_file = sources / "Testing/Baselines/PyVista.png"


def check(name, condition, *told):
    print("ok" if condition else "FAILED", name, *told, flush=True)
    if not condition:
        sys.exit(1)


def run(*command):
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True,
                          timeout=300)
    return done.returncode, done.stdout + done.stderr


def make_volume():
    """The scene's, as somebody with PyVista writes it down."""
    reader = inrvolume.vtkINRReader()
    reader.SetFileName(str(model_file))
    reader.Update()
    table = pyvista.LookupTable(list(scene.COLORS), scalar_range=reader.GetOutput().GetScalarRange())
    table.apply_opacity(scene.OPACITIES)
    volume = pyvista.Volume()
    volume.mapper = inrvolume.vtkINRVolumeMapper()
    volume.mapper.SetInputConnection(reader.GetOutputPort())
    volume.prop = pyvista.VolumeProperty(lookup_table=table, interpolation_type="linear")
    volume.prop.opacity_unit_distance = scene.UNIT
    return volume


def draw(path, *volumes):
    """The volumes, each in a part of its own, side by side; the picture, (h, w, 3)."""
    width, height = scene.SIZE
    plotter = pyvista.Plotter(off_screen=True, shape=(1, len(volumes)), border=False,
                              window_size=(len(volumes) * width, height))
    for column, volume in enumerate(volumes):
        plotter.subplot(0, column)
        plotter.background_color = scene.BACKGROUND
        plotter.add_actor(volume)
        plotter.camera_position = [scene.POSITION, scene.FOCUS, scene.UP]
        plotter.reset_camera_clipping_range()
    plotter.screenshot(path)
    plotter.close()
    return np.asarray(Image.open(path).convert("RGB"))


def brought_libraries():
    """The names of those that are loaded from the wheel, not VTK's and not our own. (Mesa and Pillow
    load some of the same names from elsewhere.)"""
    loaded = {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines()}
    return {re.match(r"lib\w+", Path(path).name)[0] for path in loaded if "/inrvolume.libs/" in path}


check("version", importlib.metadata.version("inrvolume") == version, version)
check("in the virtual environment", Path(inrvolume.__file__).is_relative_to(sys.prefix))
again = "import inrvolume, sys; del sys.modules['inrvolume']; import inrvolume; inrvolume.vtkINRReader()"
check("imported twice", run("-c", again) == (0, ""), run("-c", again))

image = pyvista.ImageData(dimensions=scene.field().shape, spacing=scene.SPACING)
image["field"] = scene.field().ravel(order="F")
writer = inrvolume.vtkINRWriter()
scene.train(writer, image, str(model_file))
check("a model", model_file.stat().st_size > 1000, f"{writer.GetPSNR():.1f} dB")

volume = make_volume()
drawn = draw(picture_file, volume)
check("its own libraries", brought_libraries() >= {"libtbb", "libOpenEXR", "libImath", "libzstd"},
      *sorted(brought_libraries()))
baseline = np.asarray(Image.open(baseline_file).convert("RGB"))
similarity = ssim(drawn, baseline)
empty = ssim(np.broadcast_to(drawn[0, 0], drawn.shape), baseline)
check("PyVista's picture", similarity > 0.99 > empty, f"SSIM {similarity:.4f}; nothing drawn: {empty:.4f}")

again = draw(folder / "again.png", volume)
check("another plotter", np.array_equal(again, drawn), np.abs(again.astype(int) - drawn).max())
halves = np.split(draw(folder / "halves.png", volume, make_volume()), 2, axis=1)
for half in halves:
    check("side by side", np.abs(half.astype(int) - drawn).max() <= 1, np.abs(half.astype(int) - drawn).max())

status, told = run("-c", f"import inrvolume; r = inrvolume.vtkINRReader(); r.SetFileName({__file__!r}); r.Update()")
check("what is no model", status == 0 and "this is not a model file" in told, told.strip())
status, told = run(sources / "Testing/check_example.py", model_file, folder / "example.png",
                   sys.executable, sources / "Examples/pyvista/view.py")
check("the example", status == 0, told.strip())
example = sources / "Examples/pyvista/view.py"
for model in (__file__, folder / "missing.inr", folder):
    status, told = run(example, model, folder / "nothing.png")
    check("the example of no model", status == 1 and f"{model} cannot be shown" in told, told.strip())
    check("nothing is drawn", not (folder / "nothing.png").exists())
status, told = run(example)
check("the example of nothing", status == 1 and "usage" in told, told.strip())

packages = {name: importlib.metadata.version(name) for name in ("cvista", "pyvista")}
results_file.write("wheel", [results_file.result(
    "SSIM of PyVista's picture with that of VTK 9.1", round(float(similarity), 4), "", "higher",
    f"a model trained with the wheel; off screen, Mesa; with nothing drawn {empty:.4f}")],
    vtk=".".join(map(str, pyvista.vtk_version_info)), python=sys.version.split()[0], **packages)
