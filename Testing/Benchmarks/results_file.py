# SPDX-License-Identifier: BSD-3-Clause
"""Result files: results/<machine>/<topic>.json, with the context they were measured in."""
import datetime
import json
import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import __main__

if {"-h", "--help"} & set(sys.argv[1:]):  # of any script that has results
    print((__main__.__doc__ or "").strip())
    sys.exit()

FOLDER = Path(__file__).resolve().parent / "results"


def cpu_name():
    """The processor's model, with what tells apart machines that hide it behind a family name."""
    text = Path("/proc/cpuinfo").read_text()
    name, family, model = (re.search(rf"^{key}\s*: (.*)$", text, re.M)
                           for key in ("model name", "cpu family", "model"))
    if not (name and family and model):  # only x86 is told in these words
        return platform.machine()
    sets = [known for known in ("avx2", "avx512f", "amx_bf16") if re.search(rf"\b{known}\b", text)]
    return f"{name[1]} (family {family[1]}, model {model[1]}; {' '.join(sets)})"


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True,
                          cwd=FOLDER.parent).stdout.strip()


def commit():
    """What was measured; "-dirty" where anything but these files differs from the commit. A copy of
    the sources without their history has it from INR_COMMIT."""
    if "INR_COMMIT" in os.environ:
        return os.environ["INR_COMMIT"]
    try:
        changes = output("git", "status", "--porcelain", "--untracked-files=no", "--", ":/",
                         ":(exclude)results")
        return output("git", "rev-parse", "--short", "HEAD") + ("-dirty" if changes else "")
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"git does not say what is measured; set INR_COMMIT to it: "
                 f"{getattr(error, 'stderr', None) or error}")


def compiler():
    """What built the programs: this machine's, or for those built elsewhere INR_COMPILER."""
    return os.environ.get("INR_COMPILER") or output("c++", "--version").splitlines()[0]


def context():
    return {
        "cpu": cpu_name(),
        "cores": len(os.sched_getaffinity(0)),
        "compiler": compiler(),
        "commit": commit(),
        "date": datetime.date.today().isoformat(),
    }


# Asked for before anything is measured: what cannot be told would lose the results at the end.
CONTEXT = context()


def result(name, value, unit, better, note="", **more):
    return {"name": name, "value": value, "unit": unit, "better": better, "note": note, **more}


def path_of(topic, about):
    """In the folder of the machine that a context is `about`: its GPU, or its CPU and number of cores."""
    name = about.get("gpu") or f"{about['cpu']} {about['cores']} cores"
    machine = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
    return FOLDER / machine / f"{topic}.json"


def last(topic):
    """The results that this machine's file has, none where there is no file."""
    path = path_of(topic, CONTEXT)
    return json.loads(path.read_text())["results"] if path.exists() else []


def write(topic, results, **more):
    """Writes and returns the path; see path_of. `more` for the context may name a `gpu`. Ends the
    script when there is nothing to write, and leaves what is there."""
    if not results:
        sys.exit(f"nothing was measured, and no {topic}.json is written: what of? The script says at its top how it is run.")
    about = {**CONTEXT, **more}
    path = path_of(topic, about)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"context": about, "results": results}, indent=1) + "\n")
    print(f"{path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path}")
    return path
