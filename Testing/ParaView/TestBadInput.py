# SPDX-License-Identifier: BSD-3-Clause
"""Whatever it is given, the plugin says once what is wrong with what, and ParaView goes on."""
import os

from paraview import servermanager, simple
from pvtest import ARRAY, MODEL, Messages, check, load_plugin, output_file

load_plugin()
with open(MODEL, "rb") as file:
    whole = file.read()


def damaged(name, content):
    path = output_file(name)
    with open(path, "wb") as file:
        file.write(content)
    return path


def refused(what, messages, *words):
    check(messages.errors() == 1, what, "gave", messages.errors(), "messages:", messages.text)
    for word in words:
        check(word in messages.text, what, "does not mention", word, "in:", messages.text)


# Files that are no model files, given to the reader itself.
for name, content in {
    "missing.inr": None,
    "empty.inr": b"",
    "text.inr": b"#INRIMAGE-4#{\nXDIM=4\n" + b" " * 300,
    "zeros.inr": bytes(1000),
    "truncated.inr": whole[: len(whole) // 2],
    "header-only.inr": whole[:40],
    "claims-too-much.inr": b"\xff\xff\xff\x7f" + whole[4:],
}.items():
    path = damaged(name, content) if content is not None else output_file(name)
    with Messages() as messages:
        reader = simple.INRReader(FileName=path)
        reader.UpdatePipeline()
    refused(name, messages, name)
    check(reader.GetDataInformation().GetNumberOfPoints() == 0, name, "gave points")
    simple.Delete(reader)

# File > Open asks the content, not the name: an INRIA image is none of ours.
try:
    opened = simple.OpenDataFile(output_file("text.inr"))
except RuntimeError as error:
    check("text.inr" in str(error), "unclear:", error)
else:
    check(opened.GetXMLName() != "INRReader", "an INRIA image opens as an INR")


def cannot_save(what, source, path, *words, **properties):
    with Messages() as messages:
        writer = servermanager.writers.INRWriter(Input=source, FileName=path)
        for key, value in properties.items():
            writer.SetPropertyWithName(key, value)
        writer.UpdatePipeline()
    refused(what, messages, *words)
    folder, name = os.path.split(path)  # the file itself or a temporary one
    left = [other for other in os.listdir(folder) if name in other] if os.path.isdir(folder) else []
    check(not left, what, "left", left)


wavelet = simple.Wavelet(WholeExtent=[-4, 4, -4, 4, -4, 4])
wavelet.UpdatePipeline()
brief = {"TimeLimit": 1, "Scalars": ["POINTS", "RTData"]}
nowhere = output_file("no/such/folder/a.inr")
cannot_save("unwritable target", wavelet, nowhere, nowhere, **brief)
gradient = simple.Gradient(Input=wavelet)
gradient.UpdatePipeline()
vector = dict(brief, Scalars=["POINTS", "Gradient"])
cannot_save("vector array", gradient, output_file("vector.inr"), "Gradient", "component", **vector)
absent = dict(brief, Scalars=["POINTS", "absent"])
cannot_save("absent array", wavelet, output_file("none.inr"), "point array", **absent)
config = dict(brief, ModelConfig="{ this is not JSON")
cannot_save("broken model", wavelet, output_file("config.inr"), "JSON", **config)
sphere = simple.Sphere()
sphere.UpdatePipeline()
cannot_save("polygons", sphere, output_file("polygons.inr"), "vtkPolyData", TimeLimit=1)

with Messages() as messages:
    simple.INRDecode(Input=wavelet).UpdatePipeline()
refused("decoding ordinary data", messages, "INRReader")

# The stock code shows a volume that it cannot colour as nothing, without a word.
view = simple.CreateView("RenderView")
display = simple.Show(simple.OpenDataFile(MODEL), view)
simple.Render(view)
for what, colouring, word in (
    ("a missing array", ["POINTS", "absent"], "'absent'"),
    ("a cell array", ["CELLS", ARRAY], ARRAY),
    ("a solid colour", [None, ""], "solid colour"),
):
    with Messages() as messages:
        display.ColorArrayName = colouring
        simple.Render(view)
        simple.Render(view)
    refused(what, messages, word, "colour by")
with Messages() as messages:
    display.ColorArrayName = ["POINTS", ARRAY]
    simple.Render(view)
check(messages.errors() == 0, "coloured again", messages.text)

# The session goes on.
with Messages() as messages:
    reader = simple.OpenDataFile(MODEL)
    reader.UpdatePipeline()
check(messages.errors() == 0, "afterwards", messages.text)
check(reader.PointData[ARRAY].GetNumberOfComponents() == 1, "the model does not open afterwards")
