# SPDX-License-Identifier: BSD-3-Clause
"""What the Information panel shows of a file: how large the volume was, how much smaller the file is and
how good, as measured when it was written; and Python's help knows the proxies."""
import math
import os
import pydoc

from paraview import servermanager, simple
from pvtest import MODEL, check, data_file, load_plugin, output_file

load_plugin()


def shown(reader):
    """The panel's rows of field data: names and what stands under "Ranges"."""
    reader.UpdatePipeline()
    fields = reader.GetDataInformation().DataInformation.GetFieldDataInformation()
    arrays = [fields.GetArrayInformation(k) for k in range(fields.GetNumberOfArrays())]
    return {array.GetName(): array.GetRangesAsString() for array in arrays}


# As the writer reports it.
source = simple.OpenDataFile(data_file("les_wmag91.vti"))
path = output_file("information.inr")
source.UpdatePipeline()
simple.SaveData(path, proxy=source, MaximumSteps=20)
rows = shown(simple.INRReader(FileName=path))
print(rows)
ratio = 4 * 91**3 / os.path.getsize(path)
check(rows["INRNativeDimensions"] == "[91, 91], [91, 91], [91, 91]", rows["INRNativeDimensions"])


def value(name):
    low, high = rows[name].strip("[]").split(", ")
    check(low == high, name, "is a range", rows[name])
    return float(low)


check(math.isclose(value("INRRatio"), ratio, rel_tol=1e-4), "ratio", value("INRRatio"), ratio)
check(10 < value("INRPSNR") < 60, "PSNR", value("INRPSNR"))
check(0 < value("INRSSIM") < 1, "SSIM", value("INRSSIM"))
check(0 < value("INRMaximumError") < 300, "largest error", value("INRMaximumError"))
wanted = "91 x 91 x 91 voxels, %.4g:1, PSNR %.4g dB, SSIM %.4g, largest error %.4g" % (
    ratio, value("INRPSNR"), value("INRSSIM"), value("INRMaximumError"))
check(rows["INRSummary"] == wanted, rows["INRSummary"], "not", wanted)

# Native is native, whatever grid is presented and however the volume is scaled.
rows = shown(simple.INRReader(FileName=MODEL, MaximumGridPoints=1000, ScaleFactor=2))
check(rows["INRNativeDimensions"] == "[91, 91], [91, 91], [91, 91]", rows["INRNativeDimensions"])
check(rows["INRScaledDimensions"].startswith("[182, 182]"), rows["INRScaledDimensions"])
check(rows["INRSummary"].startswith("91 x 91 x 91 voxels, "), rows["INRSummary"])

# help(INRReader) says what it is; that of an object, what its properties are, too.
display = simple.Show(simple.INRReader(FileName=MODEL), simple.CreateView("RenderView"))
for proxy, words in (
    (simple.INRReader, ("implicit neural representation", ".inr")),
    (simple.INRDecode, ("output of INRReader", "ordinary array")),
    (servermanager.sources.INRReader, ("implicit neural", "ScaleFactor", "times as many voxels")),
    (servermanager.writers.INRWriter, ("Trains an implicit", "TargetPSNR", "signal-to-noise")),
    (display, ("LevelOfDetailScale", "as large as a pixel", "INRUnitDistance", "longest side")),
):
    text = pydoc.plain(pydoc.render_doc(proxy))
    for word in words:
        check(word in " ".join(text.split()), "the help on", proxy, "does not say", word)
