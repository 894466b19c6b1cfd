# SPDX-License-Identifier: BSD-3-Clause
"""What compact files save and cost: every volume trained once for each kind of file.

    PYTHONPATH=build/lib/python pvpython Testing/Benchmarks/quantised.py STEPS VOLUME.vti...

The seed and the steps are the same, and so are the parameters before they are stored. Whole files are
compared, with macro-cells and header; results go to quantised.json.
"""
import os
import sys
import tempfile

import inrvolume
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import results_file  # noqa: E402


def save(reader, path, steps, plain):
    """Returns size in bytes and PSNR in dB."""
    writer = inrvolume.vtkINRWriter()
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(path)
    writer.SetMaximumSteps(steps)
    writer.SetTimeLimit(0)
    writer.SetReadableByInstantVNR(plain)
    if writer.Write() != 1 or writer.GetSteps() != steps:
        sys.exit(f"{path} was not written")
    return os.path.getsize(path), writer.GetPSNR()


def measure(path, folder, steps):
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path)
    reader.Update()
    name = os.path.basename(path)[:-len(".vti")]
    plain, plain_psnr = save(reader, os.path.join(folder, "plain.inr"), steps, True)
    compact, psnr = save(reader, os.path.join(folder, "compact.inr"), steps, False)
    note = (f"{steps} steps; {plain} bytes and {plain_psnr:.3f} dB in halves, "
            f"{compact} bytes and {psnr:.3f} dB compact")
    print(f"{name}: ratio {plain / compact:.2f}, loss {plain_psnr - psnr:.3f} dB, {note}", flush=True)
    return [
        results_file.result(f"{name} quantised size ratio", round(plain / compact, 3), "", "higher",
                            note, target=2, baseline="the same parameters in half precision"),
        results_file.result(f"{name} quantised PSNR loss", round(plain_psnr - psnr, 4), "dB", "lower",
                            note, target=0.2, baseline="the same parameters in half precision"),
    ]


def main():
    steps, volumes = int(sys.argv[1]), sys.argv[2:]
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for path in volumes:
            results += measure(path, folder, steps)
    size = min(r["value"] for r in results if r["name"].endswith("ratio"))
    loss = max(r["value"] for r in results if r["name"].endswith("loss"))
    note = f"the worst of {len(volumes)} volumes"
    results = [
        results_file.result("quantised size ratio", size, "", "higher", note, target=2,
                            baseline="the same parameters in half precision"),
        results_file.result("quantised PSNR loss", loss, "dB", "lower", note, target=0.2,
                            baseline="the same parameters in half precision"),
    ] + results
    results_file.write("quantised", results)


main()
