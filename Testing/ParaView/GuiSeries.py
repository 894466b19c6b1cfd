# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window: what GuiSeries.xml saves of a source with time steps are the files of these
steps, and what it opens by the file dialog's group of them are the same steps again."""
import glob
import os
import shutil
import time

from paraview import simple
from guisteps import SIZE, begin, follow
from pvtest import check, check_baseline, output_file, picture

view = begin()
TIMES = [0.5, 2.0, 3.0]
folder = output_file("gui-series")
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)  # where the file dialog begins
wave = simple.ProgrammableSource(OutputDataSetType="vtkImageData")
wave.ScriptRequestInformation = f"""
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
information.Set(executive.WHOLE_EXTENT(), 0, 15, 0, 15, 0, 15)
information.Set(executive.TIME_STEPS(), {TIMES}, {len(TIMES)})
information.Set(executive.TIME_RANGE(), [{TIMES[0]}, {TIMES[-1]}], 2)
"""
wave.Script = """
import numpy as np
information = self.GetExecutive().GetOutputInformation(0)
key = self.GetExecutive().UPDATE_TIME_STEP()
now = information.Get(key) if information.Has(key) else 0.0
output.SetDimensions(16, 16, 16)
axis = np.linspace(0, 1, 16)
field = now + axis[:, None, None] * axis[None, :, None] + axis
output.PointData.append(field.ravel(), "wave")
"""
simple.Show(wave, view)
simple.SetActiveSource(wave)
simple.Render(view)


def readers():
    return [source for source in simple.GetSources().values() if source.GetXMLName() == "INRReader"]


def watch():
    """Yields between two looks at the window."""
    deadline = time.time() + 120
    while not readers() or not readers()[0].GetDataInformation().GetNumberOfPoints():
        check(time.time() < deadline, "nothing is opened; there are", os.listdir(folder))
        yield
    files = sorted(glob.glob(os.path.join(folder, "*")))
    names = [os.path.basename(file) for file in files]
    check(names == ["wave_000.inr", "wave_001.inr", "wave_002.inr"], "written are", names)
    (reader,) = readers()
    check(list(reader.FileName) == files, "opened are", reader.FileName)
    check(list(reader.TimestepValues) == TIMES, "times", reader.TimestepValues)
    for now in TIMES:
        reader.UpdatePipeline(now)
        low, high = reader.PointData["wave"].GetRange()
        check((low, high) == (now, now + 2), "at", now, "values from", low, "to", high)
    simple.Hide(wave, view)
    view.ViewTime = TIMES[-1]
    simple.GetDisplayProperties(reader, view).RescaleTransferFunctionToDataRange(False, True)
    simple.ResetCamera(view)
    view.GetActiveCamera().Azimuth(30)
    view.GetActiveCamera().Elevation(20)
    check_baseline(picture(view, "gui-series", SIZE), "GuiSeries")
    print("saved and opened", names)


follow(watch(), view.GetRenderWindow().GetInteractor())
