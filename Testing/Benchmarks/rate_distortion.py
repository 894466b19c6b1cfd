# SPDX-License-Identifier: BSD-3-Clause
"""Quality over file size for volumes, each trained for the same number of steps.

    PYTHONPATH=build/lib/python pvpython Testing/Benchmarks/rate_distortion.py STEPS VOLUME.vti...

Every volume is saved at the default size and at four times that size's ratio; results go to
rate-distortion.json.
"""
import math
import os
import sys
import tempfile

import inrvolume
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import results_file  # noqa: E402


def save(reader, folder, steps, ratio):
    writer = inrvolume.vtkINRWriter()
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(os.path.join(folder, "model.inr"))
    writer.SetMaximumSteps(steps)
    writer.SetTimeLimit(0)
    writer.SetTargetRatio(ratio)
    writer.Write()
    return writer


def measure(path, folder, steps):
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path)
    reader.Update()
    low, high = reader.GetOutput().GetScalarRange()
    name = os.path.basename(path)[:-len(".vti")]
    results, ratio = [], 0.0
    for size in ("default", "small"):
        writer = save(reader, folder, steps, ratio)
        note = (f"file ratio {writer.GetRatio():.1f}, {steps} steps, "
                f"{writer.GetTrainingSeconds():.1f} s of training")
        figures = (("PSNR", writer.GetPSNR(), "dB", "higher"), ("SSIM", writer.GetSSIM(), "", "higher"),
                   ("maximum error", writer.GetMaximumError() / (high - low), "of the range", "lower"),
                   ("ratio", writer.GetRatio(), "", "higher"))
        for what, value, unit, better in figures:
            if not math.isnan(value):
                results.append(results_file.result(f"{name} {size} {what}", round(value, 5), unit,
                                                   better, note))
        print(f"{name} {size}: PSNR {writer.GetPSNR():.2f} dB, SSIM {writer.GetSSIM():.4f}, {note}",
              flush=True)
        ratio = 4.0 * writer.GetRatio()
    return results


def main():
    steps, volumes = int(sys.argv[1]), sys.argv[2:]
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for path in volumes:
            results += measure(path, folder, steps)
    results_file.write("rate-distortion", results)


main()
