# SPDX-License-Identifier: BSD-3-Clause
"""State files and traces show the same in a new ParaView. Started with a file, this is the new one:
it loads the plugin and the file, and saves what the active view then shows."""
import os
import subprocess
import sys

from paraview import simple, smstate, smtrace
from pvtest import ARRAY, MODEL, check, load_plugin, look_at, output_file, picture, psnr, read_png
from pvtest import show_view, without_decoration


def replay(path):
    """In the new process."""
    load_plugin()
    if path.endswith(".pvsm"):
        simple.LoadState(path)
    else:
        with open(path) as file:
            exec(compile(file.read(), path, "exec"), {"__name__": "__main__"})
    view = simple.GetActiveView()
    display = simple.GetDisplayProperties(list(simple.GetSources().values())[0], view)
    check(display.Representation == "INR Volume", "came back as", display.Representation)
    if os.path.basename(path) == "trace.py":  # views' own changes are not traced
        without_decoration(view)
    picture(view, "replayed-" + os.path.basename(path))


def make_scene():
    view = show_view()
    reader = simple.OpenDataFile(MODEL)
    display = simple.Show(reader, view)
    edit = smtrace._create_trace_item_internal("PropertiesModified", kwargs={"proxy": display})
    display.SampleDistance = 0.75
    display.LevelOfDetailScale = 0.5
    display.ScalarOpacityUnitDistance = 3
    display.RenderMode = "Path Tracing"
    display.SamplesPerPixel = 4
    display.Scale = [1, 1.3, 1]
    if edit is not None:  # as the panel does; scripts' own changes are not traced
        edit.finalize()
    del edit  # nothing is traced within an edit
    simple.GetColorTransferFunction(ARRAY).RescaleTransferFunction(20, 120)
    simple.GetOpacityTransferFunction(ARRAY).RescaleTransferFunction(20, 120)
    look_at(view)
    return view


def check_replay(path, truth):
    run = subprocess.run([os.environ["INR_PVPYTHON"], os.path.abspath(__file__), path],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    told = run.stdout.decode(errors="replace")
    check(run.returncode == 0 and "ERR|" not in told, path, "gave", run.returncode, told)
    shown = read_png(output_file("replayed-" + os.path.basename(path) + ".png"))
    likeness = psnr(shown, truth)
    print(f"{os.path.basename(path)}: {likeness:.1f} dB in a new process")
    check(likeness > 50, path, "shows something else:", likeness, "dB")


def main():
    load_plugin()
    smtrace.start_trace()
    view = make_scene()
    traced = smtrace.stop_trace()
    check("INRReader" in traced or "OpenDataFile" in traced, "the trace does not open:", traced)
    check("SamplesPerPixel = 4" in traced, "the trace does not have what was set:", traced)
    with open(output_file("trace.py"), "w") as file:
        file.write(traced)
    truth = picture(view, "replay-truth")
    simple.SaveState(output_file("replay.pvsm"))
    with open(output_file("replay-state.py"), "w") as file:
        file.write(smstate.get_state())
    check_replay(output_file("replay.pvsm"), truth)
    check_replay(output_file("replay-state.py"), truth)
    check_replay(output_file("trace.py"), truth)


if len(sys.argv) > 1:
    replay(sys.argv[1])
else:
    main()
sys.stdout.flush()
os._exit(0)
