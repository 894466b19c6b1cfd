# SPDX-License-Identifier: BSD-3-Clause
"""The processes of a server show the time steps of a series as this process shows them, in any order, and
so does the next server that this process connects to when the first one is gone. Arguments: the server's
port, its number of processes and the command that starts another."""
import os
import subprocess
import sys

from paraview import simple
from pvtest import Messages, check, check_same, connect, load_plugin, look_at, output_file, picture, show_view

PORT, COMMAND = int(sys.argv[1]), sys.argv[3:]
FILES = [output_file(f"server-series-{k}.inr") for k in range(3)]
TIMES = (0, 2, 1, 0)


def save(path, k):
    """Steps differ in size, bounds and range."""
    wave = simple.Wavelet(WholeExtent=[-8, 8 + 4 * k, -8, 8, -8, 8 + k], Maximum=255 + 40 * k,
                          XFreq=60 + 20 * k)
    simple.SaveData(path, wave, Scalars=["POINTS", "RTData"], MaximumSteps=60, TimeLimit=0)
    simple.Delete(wave)


def pictures(where):
    result = {}
    view = show_view((160, 120))
    view.UseFXAA = 0
    view.RemoteRenderThreshold = 0
    reader = simple.OpenDataFile(FILES)
    check(list(reader.TimestepValues) == [0, 1, 2], "times", reader.TimestepValues)
    display = simple.Show(reader, view)
    display.SetScalarBarVisibility(view, False)
    display.ScalarOpacityUnitDistance = 2
    view.ViewTime = 1
    for function in (simple.GetColorTransferFunction, simple.GetOpacityTransferFunction):
        function("RTData").RescaleTransferFunction(0, 500)
    look_at(view)
    for mode in ("Composite", "Maximum Intensity"):
        display.INRBlendMode = mode
        for number, time in enumerate(TIMES):
            view.ViewTime = time
            name = f"{mode} {number} at {time}"
            result[name] = picture(view, f"server-series-{where}-{name}")
    return result


load_plugin()
for k, file in enumerate(FILES):
    save(file, k)
expected = pictures("here")
for mode in ("Composite", "Maximum Intensity"):
    moved = [abs(expected[f"{mode} {k} at {TIMES[k]}"] - expected[f"{mode} 0 at 0"]).max() for k in (1, 2)]
    check(min(moved) > 0.1, mode, "shows the steps alike", moved)
for server in range(2):
    if server > 0:
        simple.Disconnect()
        # Without what MPI tells processes of this one's.
        own = {key: text for key, text in os.environ.items()
               if not key.startswith(("PMIX_", "OMPI_MCA_", "OMPI_COMM_", "ORTE_"))}
        another = subprocess.Popen([*COMMAND, f"--server-port={PORT + 1}"], env=own, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        told = []
        for line in another.stdout:
            told.append(line)
            if "Accepting connection" in line:
                break
        check(told and "Accepting connection" in told[-1], "there is no other server:", *told)
    connect(PORT + server)
    with Messages() as messages:
        found = pictures(f"there-{server}")
    check(messages.errors() == 0, "drawing reported", messages.text)
    check_same(found, expected, composed=[])
another.terminate()
another.wait(30)
os._exit(0)
