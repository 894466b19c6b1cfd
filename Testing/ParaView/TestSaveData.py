# SPDX-License-Identifier: BSD-3-Clause
"""Save Data through the writer proxy: limits, progress, and the file that the other tests open."""
import os

from paraview import simple, vtk
from pvtest import ARRAY, MODEL, Messages, check, data_file, load_plugin, output_file

load_plugin()


def save(source, path, **properties):
    """Saves as the Save Data dialog does; returns the writer's progress events, 0 to 1."""
    seen = []
    if os.path.exists(path):
        os.remove(path)
    writer = simple.CreateWriter(path, source, **properties)
    check(writer.GetXMLName() == "INRWriter", "written by", writer.GetXMLName())
    trainer = writer.GetClientSideObject()
    trainer.AddObserver("ProgressEvent", lambda *unused: seen.append(trainer.GetProgress()))
    with Messages() as messages:
        writer.UpdatePipeline()
    check(messages.errors() == 0, "saving reported", messages.text)
    check(os.path.exists(path), "no file", path)
    return seen


def same_points(file, source):
    """The reader's output has the bounds, array and range of what was saved."""
    reader = simple.OpenDataFile(file)
    check(reader.GetXMLName() == "INRReader", "opened by", reader.GetXMLName())
    reader.UpdatePipeline()
    info, truth = reader.GetDataInformation(), source.GetDataInformation()
    check(info.GetBounds() == truth.GetBounds(), info.GetBounds(), truth.GetBounds())
    return reader


# Real data, enough steps for a recognisable picture.
volume = simple.XMLImageDataReader(FileName=data_file("les_wmag91.vti"))
volume.UpdatePipeline()
seen = save(volume, MODEL, Scalars=["POINTS", ARRAY], MaximumSteps=400, TimeLimit=0)
check(len(seen) >= 3, "progress events:", seen)
check(seen == sorted(seen) and seen[-1] > 0.5, "progress does not rise:", seen)
reader = same_points(MODEL, volume)
low, high = reader.PointData[ARRAY].GetRange()
truth = volume.PointData[ARRAY].GetRange()
check((low, high) == truth, "range", (low, high), "of", truth)

# A stock source, stopped by the clock.
wavelet = simple.Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
wavelet.UpdatePipeline()
simple.SaveData(output_file("wavelet.inr"), wavelet, Scalars=["POINTS", "RTData"], TimeLimit=2)
same_points(output_file("wavelet.inr"), wavelet)

# Of arrays none of which is active, ParaView would choose the first: a mask, if a filter left one.
masked = vtk.vtkImageData()
masked.SetDimensions(9, 8, 7)
for name, type in (("vtkValidPointMask", vtk.VTK_CHAR), ("vtkGhostType", vtk.VTK_UNSIGNED_CHAR),
                   ("zeta", vtk.VTK_FLOAT)):
    array = vtk.vtkDataArray.CreateDataArray(type)
    array.SetName(name)
    array.SetNumberOfTuples(masked.GetNumberOfPoints())
    array.Fill(0)
    masked.GetPointData().AddArray(array)
producer = simple.TrivialProducer()
producer.GetClientSideObject().SetOutput(masked)
producer.UpdatePipeline()
for chosen, saved in (({}, "zeta"), ({"Scalars": ["POINTS", "vtkGhostType"]}, "vtkGhostType")):
    save(producer, output_file("masked.inr"), MaximumSteps=2, **chosen)
    reader = same_points(output_file("masked.inr"), producer)
    check(reader.PointData.keys() == [saved], reader.PointData.keys(), "instead of", saved)
    simple.Delete(reader)
