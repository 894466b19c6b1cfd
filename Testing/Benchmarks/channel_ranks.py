# SPDX-License-Identifier: BSD-3-Clause
"""Trainings of a turbulent channel by several processes of pvbatch, and beside them by as many that
have nothing to do with each other. For terascale.py."""
import json
import os
import statistics
import subprocess
import sys

import results_file

# In every process; arguments as JSON, the answer as a line.
SCRIPT = """
import json, sys
from paraview import servermanager, simple
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkParallelCore import vtkMultiProcessController
given = json.loads(sys.argv[-1])
for name in ("INRVolume", "TurbulentChannel"):
    simple.LoadPlugin(f"{given['plugins']}/{name}/{name}.so", remote=False, ns=vars(simple))
import inrvolume
controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId() if controller else 0
dims = given["dims"]
source = simple.TurbulentChannel(Dimensions=dims, OutputScalarType="double")
def train(properties):
    writer = servermanager.writers.INRWriter(Input=source, TimeLimit=0, CheckpointInterval=0,
                                             ReadableByInstantVNR=1, **properties)
    writer.UpdatePipeline()
    return writer.GetClientSideObject()
def train_on_first(properties):
    # The first process has all of the data.
    field = source.GetClientSideObject()
    if rank == 0:
        field.UpdateWholeExtent()
    producer = vtkTrivialProducer()
    producer.SetOutput(field.GetOutputDataObject(0) if rank == 0 else vtkImageData())
    producer.SetWholeExtent(0, dims[0] - 1, 0, dims[1] - 1, 0, dims[2] - 1)
    writer = inrvolume.vtkINRWriter()
    writer.SetInputConnection(producer.GetOutputPort())
    for name, value in {"TimeLimit": 0, "CheckpointInterval": 0, "ReadableByInstantVNR": True,
                        **properties}.items():
        getattr(writer, "Set" + name)(value)
    writer.Write()
    return writer
for properties in given["trainings"]:
    trained = (train_on_first if given["on_first"] else train)(properties)
    sys.stdout.write(json.dumps({
        "rank": rank, "steps": trained.GetSteps(), "seconds": trained.GetTrainingSeconds(),
        "exchange": trained.GetExchangeSeconds(), "waiting": trained.GetWaitingSeconds(),
        "psnr": trained.GetPSNR()}) + "\\n")
    sys.stdout.flush()
"""
BATCH = 1 << 14
DIMS = [160, 120, 48]
ROUNDS = 3
RANKS = (1, 2, 4)


class Trainings:
    def __init__(self, build, folder, models):
        """`models`: ModelConfig and number of steps of each."""
        self.folder = folder / "ranks"
        self.folder.mkdir(exist_ok=True)
        self.plugins = str(next((build / "lib").glob("paraview-*")) / "plugins")
        self.script = self.folder / "train.py"
        self.script.write_text(SCRIPT)
        self.models = models
        # mpirun for root, too
        self.environment = {**os.environ, "PYTHONPATH": str(build / "lib/python"),
                            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

    def path(self, name, which):
        return self.folder / f"{name}-{which}.inr"

    def arguments(self, name, on_first=False):
        trainings = [{"FileName": str(self.path(name, k)), "ModelConfig": config,
                      "MaximumSteps": steps} for k, (config, steps) in enumerate(self.models)]
        return [str(self.script), json.dumps({"plugins": self.plugins, "dims": DIMS,
                                              "trainings": trainings, "on_first": on_first})]

    def together(self, count, name, on_first=False):
        """For each model, what each of so many ranks says."""
        output = subprocess.run(
            ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(count), "pvbatch",
             "--symmetric", *self.arguments(name, on_first)],
            check=True, stdout=subprocess.PIPE, text=True, env=self.environment).stdout
        return self.answers([output], count)

    def apart(self, count):
        """So many trainings at the same time, each on one core."""
        cores = sorted(os.sched_getaffinity(0))
        running = [subprocess.Popen(["taskset", "-c", str(cores[k % len(cores)]), "pvpython",
                                     *self.arguments(f"apart-{k}")],
                                    stdout=subprocess.PIPE, text=True, env=self.environment)
                   for k in range(count)]
        return self.answers([process.communicate()[0] for process in running], count)

    def answers(self, outputs, count):
        """By model; each process answers in the order of models."""
        found = [[] for _ in self.models]
        for output in outputs:
            given = {}
            for line in output.splitlines():
                if line.startswith('{"rank"'):
                    answer = json.loads(line)
                    mine = given.setdefault(answer["rank"], [])
                    found[len(mine)].append(answer)
                    mine.append(answer)
        assert all(len(of_model) == count for of_model in found), outputs
        return found


def speed(answers):
    """Samples per second of the slowest."""
    return min(answer["steps"] * BATCH / answer["seconds"] for answer in answers)


def share(answers, what):
    return statistics.mean(answer[what] / answer["seconds"] for answer in answers)


def parameters(path):
    import model_file  # the other parts do without NumPy
    return model_file.read_document(path.read_bytes())["parameters"]["params_binary"]


def about_speed(rounds, count, which, name):
    """Of the model with that name, in all rounds."""
    result = results_file.result
    ours = [each[count, "together"][which] for each in rounds]
    of_one = [each[1, "together"][which] for each in rounds]
    cores = len(os.sched_getaffinity(0))
    what = f", {count} rank{'s' * (count > 1)}, {name}"
    yield result("samples per second per rank" + what,
                 round(statistics.median(speed(each) for each in ours)), "1/s", "higher",
                 f"{cores} cores in all; others used the machine")
    if count == 1:
        return
    theirs = [each[count, "apart"][which] for each in rounds]
    ratios = [speed(a) / speed(b) for a, b in zip(ours, theirs)]
    gains = [count * speed(a) / speed(b) for a, b in zip(ours, of_one)]

    def listed(values):
        return ", ".join(f"{value:.2f}" for value in values)
    yield result("speed of a rank" + what, round(statistics.median(ratios), 3), "", "higher",
                 f"rounds {listed(ratios)}",
                 baseline=f"{count} trainings of one core each that run at the same time")
    yield result("speed-up" + what, round(statistics.median(gains), 3), "", "higher",
                 f"samples per second of all; rounds {listed(gains)}; {cores} cores, all of which "
                 "one rank takes", baseline="one rank")
    for key, about in (("exchange", "part of the time that gradients are exchanged"),
                       ("waiting", "part of the time that a rank waits for others' gradients")):
        yield result(about + what,
                     round(statistics.median(share(each, key) for each in ours), 3), "", "lower",
                     "wall time, mean of the ranks")


def model_name(path):
    return f"{len(parameters(path)) / 2e6:.1f} M parameters"  # of two bytes each


def about_equality(trainings, count, names):
    result = results_file.result
    answers = trainings.together(count, f"{count}-ranks")
    trainings.together(count, f"{count}-again")
    whole = trainings.together(count, f"{count}-whole", on_first=True)
    for k, name in enumerate(names):
        one, other = (parameters(trainings.path(f"{count}-{run}", k)) for run in ("ranks", "again"))
        yield result(f"bytes that differ between two runs of {count} ranks, {name}",
                     sum(a != b for a, b in zip(one, other)) + abs(len(one) - len(other)), "",
                     "lower", f"of {len(one)} of parameters", target=0)
        yield result(f"PSNR of {count} ranks minus that of one, {count} times the batch, {name}",
                     round(answers[k][0]["psnr"] - whole[k][0]["psnr"], 3) + 0.0, "dB", "higher",
                     f"{answers[k][0]['psnr']:.2f} dB after {answers[k][0]['steps']} steps")


def results(build, folder, model):
    trainings = Trainings(build, folder, [("", 300), (model, 60)])
    rounds = []
    for _ in range(ROUNDS):
        runs = {(count, "together"): trainings.together(count, f"{count}-ranks") for count in RANKS}
        runs.update({(count, "apart"): trainings.apart(count) for count in RANKS if count > 1})
        rounds.append(runs)
        print({key: [round(speed(of_model)) for of_model in run] for key, run in runs.items()},
              file=sys.stderr, flush=True)
    names = [model_name(trainings.path("1-ranks", k)) for k in range(len(trainings.models))]
    for count in RANKS:
        for which, name in enumerate(names):
            yield from about_speed(rounds, count, which, name)
    for count in RANKS[1:]:
        yield from about_equality(trainings, count, names)
