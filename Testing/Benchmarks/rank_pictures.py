# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a turbulent channel's model by one, two and four processes of pvbatch. For terascale.py."""
import json
import os
import subprocess

import results_file

# In pvbatch, or pvpython; arguments as JSON.
TRAIN = """
import json, sys
from paraview import servermanager, simple
given = json.loads(sys.argv[-1])
for name in ("INRVolume", "TurbulentChannel"):
    simple.LoadPlugin(f"{given['plugins']}/{name}/{name}.so", remote=False, ns=vars(simple))
source = simple.TurbulentChannel(Dimensions=given["dims"], OutputScalarType="double")
servermanager.writers.INRWriter(Input=source, FileName=given["model"], TimeLimit=0,
                                MaximumSteps=2000).UpdatePipeline()
"""
DRAW = """
import json, sys
from paraview import simple
given = json.loads(sys.argv[-1])
simple.LoadPlugin(f"{given['plugins']}/INRVolume/INRVolume.so", remote=False, ns=vars(simple))
model = simple.INRReader(FileName=given["model"])
view = simple.CreateView("RenderView", ViewSize=[512, 384], OrientationAxesVisibility=0,
                         UseColorPaletteForBackground=0, Background=[1, 1, 1], UseFXAA=0)
display = simple.Show(model, view)
display.SetScalarBarVisibility(view, False)
display.StillTimeLimit = -1
array = display.ColorArrayName[1]
low, high = model.PointData[array].GetRange(0)
simple.GetOpacityTransferFunction(array).Points = [
    low, 0, 0.5, 0, low + 0.55 * (high - low), 0, 0.5, 0, high, 0.7, 0.5, 0]
display.ScalarOpacityUnitDistance /= 4
bounds = model.GetDataInformation().GetBounds()
middle = [(bounds[k] + bounds[k + 1]) / 2 for k in (0, 2, 4)]
length = bounds[1] - bounds[0]
view.CameraFocalPoint, view.CameraViewUp = middle, [0, 0, 1]
for name, away in given["looks"].items():
    view.CameraPosition = [c + length * d for c, d in zip(middle, away)]
    for shade in (0, 1):
        display.Shade = shade
        simple.SaveScreenshot(f"{given['pictures']}-{name}-{shade}.png", view)
"""
COMPARE = """
import json, sys
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
def read(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
one, other = (read(path) for path in json.loads(sys.argv[-1]))
differing = np.abs(one - other)
print(json.dumps({"largest": int(differing.max()), "spread": float(one.std(axis=0).max()),
                  "same": float((differing.max(axis=1) == 0).mean()),
                  "above": int((differing > 2).sum()), "values": differing.size}))
"""
DIMS = [320, 240, 96]
LOOKS = {"far": [0.6, -1.3, 0.7], "near": [0.2, -0.35, 0.25], "inside": [0.02, -0.12, 0.1]}
RANKS = (2, 4)


class Pictures:
    def __init__(self, build, folder):
        self.folder = folder / "rank-pictures"
        self.folder.mkdir(exist_ok=True)
        self.given = {"plugins": str(next((build / "lib").glob("paraview-*")) / "plugins"),
                      "dims": DIMS, "model": str(self.folder / "channel.inr"), "looks": LOOKS}

    def run(self, launcher, script, argument):
        path = self.folder / "script.py"
        path.write_text(script)
        # mpirun for root, too
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        return subprocess.run([*launcher, str(path), json.dumps(argument)], check=True,
                              stdout=subprocess.PIPE, text=True, env=environment).stdout

    def draw(self, count):
        launcher = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(count), "pvbatch"]
        pictures = str(self.folder / f"by-{count}")
        self.run(launcher, DRAW, {**self.given, "pictures": pictures})
        return [f"{pictures}-{name}-{shade}.png" for name in LOOKS for shade in (0, 1)]

    def compare(self, *paths):
        return json.loads(self.run(["pvpython"], COMPARE, paths).strip().splitlines()[-1])


def results(build, folder):
    pictures = Pictures(build, folder)
    pictures.run(["pvpython"], TRAIN, pictures.given)
    alone = pictures.draw(1)
    for count in RANKS:
        found = [pictures.compare(*pair) for pair in zip(alone, pictures.draw(count))]
        assert all(each["spread"] > 5 for each in found), "a picture shows nothing"
        yield results_file.result(
            f"largest difference of pictures by {count} processes", max(x["largest"] for x in found),
            "of 255", "lower", f"{len(found)} of 512 x 384: far, near and inside, flat and shaded; at "
            f"least {min(x['same'] for x in found):.3f} of the pixels are the same, and "
            f"{sum(x['above'] for x in found)} of {sum(x['values'] for x in found)} values are off by "
            "more than 2; each process draws a part of them",
            baseline="one process", target=2)
