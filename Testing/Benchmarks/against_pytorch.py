#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Inference and training against PyTorch: same model, same positions, two threads each, in turns.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_against_pytorch
    /usr/bin/python3 -m venv venv && venv/bin/pip install numpy torch
    venv/bin/python Testing/Benchmarks/against_pytorch.py \\
        build-core/Testing/Benchmarks/bench_against_pytorch

PyTorch's compiler takes the C++ compiler of the path and Python's headers (Debian: python3-dev).
Both sides' values are compared first. Writes pytorch.json: rates by processor time, of all threads
together, which other programs disturb little, and by wall clock, which takes an idle machine. What
PyTorch runs, hash_grid.py says; its fastest way is what the ratios are to, and its plain one is
given beside it.
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# A thread that waits by spinning would take processor time from the other side.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import results_file  # first: it answers --help without the packages that follow

import numpy
import torch

from hash_grid import HashGrid, Trainer
from model_file import ModelFile

THREADS = 2
ROUNDS = 5
BRICK = 40
CHUNKS = (2048, 8192, 65536)
SIDES = (("fastest", "PyTorch"), ("plain", "plain PyTorch"))
MODELS = {"default": "default model", "chosen": "256^3 model"}
TARGETS = {"scattered": {"default": 8}, "bricks": {"default": 50},
           "training": {"default": 8, "chosen": 20}}


class Ours:
    """The program that times our side; see AgainstPyTorch.cpp."""

    def __init__(self, program, which, folder):
        self.process = subprocess.Popen([program, which, str(THREADS), folder], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.about = json.loads(self.process.stdout.readline())

    def time(self, what):
        """Samples per second of wall clock, and of processor time."""
        print(what, file=self.process.stdin, flush=True)
        done, wall, processor = map(float, self.process.stdout.readline().split())
        return done / wall, done / processor

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def timed(work, samples):
    """Like Ours.time, for a function that handles `samples`."""
    start, processor, wall, done = time.perf_counter(), time.process_time(), 0.0, 0
    while wall < 0.5:
        work()
        done += samples
        wall = time.perf_counter() - start
    return done / wall, done / (time.process_time() - processor)


def numbers(folder, name, columns):
    return torch.from_numpy(numpy.fromfile(Path(folder, name), "<f4").reshape(-1, columns))


def by_chunks(function, positions, chunk):
    return torch.cat([function(some) for some in positions.split(chunk)])


def lattices(positions):
    """The axes of each brick of BRICK^3 positions."""
    for brick in positions.view(-1, BRICK, BRICK, BRICK, 3):
        yield brick[0, 0, :, 0], brick[0, :, 0, 1], brick[:, 0, 0, 2]


def inference_ways(grid, positions, bricks):
    """Name of a way -> function giving all values."""
    ways = {"plain": lambda: grid.network(grid.encode_plain(positions))}
    for chunk in CHUNKS:
        chunk = -(-len(positions) // -(-len(positions) // chunk))  # of equal size, or nearly
        ways[f"fused, {chunk} at a time"] = lambda chunk=chunk: by_chunks(
            lambda some: grid.network(grid.encode_fused(some)), positions, chunk)
    if bricks:
        for chunk in CHUNKS:
            ways[f"lattice, {chunk} at a time"] = lambda chunk=chunk: torch.cat(
                [grid.evaluate_lattice(axes, chunk) for axes in lattices(positions)])
    return ways


def require_equal(values, truth, what):
    difference = float((values - truth).abs().max())
    print(f"  {what}: largest difference {difference:.2g}", flush=True)
    if not difference < 1e-3:
        sys.exit(f"{what}: PyTorch's values differ from ours by {difference}")


def training_ways(folder, file, about):
    """Name of a way -> function of one step. Each starts at our initial parameters and must do our
    first step."""
    initial = numpy.fromfile(Path(folder, "initial.parameters"), "<f4")
    updated = numpy.fromfile(Path(folder, "updated.parameters"), "<f4")
    positions = numbers(folder, "batch.xyz", 3)
    targets = positions[:, :1].contiguous()
    ways = {}
    for chunk in ("plain", *CHUNKS):
        grid = HashGrid(file, initial)
        trainer = Trainer(grid, about["learning_rate"], CHUNKS[0] if chunk == "plain" else chunk)
        step = trainer.step_plain if chunk == "plain" else trainer.step
        name = chunk if chunk == "plain" else f"fused, {chunk} at a time"
        ways[name] = lambda step=step: step(positions, targets)
        require_same_step(ways[name](), grid, about, HashGrid(file, updated), name)
    return ways


def require_same_step(loss, grid, about, expected, name):
    """Adam's first step goes as far whatever the gradient's size, so that the tiniest gradients,
    whose sign is a matter of rounding, may go the other way."""
    near = about["learning_rate"] / 10
    same = torch.cat([((a - b).abs() < near).flatten() for a, b in
                      zip([*grid.matrices, grid.table], [*expected.matrices, expected.table])])
    share = float(same.float().mean())
    print(f"  training, {name}: loss {loss:.6f} and {about['loss']:.6f}, "
          f"{100 * share:.3f} % of the parameters agree", flush=True)
    if abs(loss - about["loss"]) > 1e-4 * about["loss"] or share < 0.999:
        sys.exit(f"training, {name}: PyTorch's first step differs from ours")


def best(rates):
    """The best round by each clock."""
    return tuple(max(rate[clock] for rate in rates) for clock in (0, 1))


def compare(ours, what, ways, samples):
    """Rates of ours and of the fastest of PyTorch's ways, after rounds in turn; and of the plain
    way."""
    grad = torch.enable_grad() if what == "training" else torch.no_grad()
    with grad:
        trial = {name: best([timed(way, samples) for _ in range(2)]) for name, way in ways.items()}
        for name, (wall, processor) in trial.items():
            print(f"  PyTorch {what}, {name}: {wall / 1e6:.3f} M/s, "
                  f"{processor / 1e6:.3f} M/s and core", flush=True)
        fastest = max(trial, key=lambda name: trial[name][1])
        rounds = [(ours.time(what), timed(ways[fastest], samples)) for _ in range(ROUNDS)]
    mine, theirs = (best(side) for side in zip(*rounds))
    return {"ours": mine, "fastest": theirs, "plain": trial["plain"], "way": fastest}


def results_of(what, which, found):
    """Result entries of one comparison: M samples/s (a core's, by processor time), and ratios."""
    kind = "training" if what == "training" else "inference"
    where = MODELS[which] if what == "training" else f"{what}, {MODELS[which]}"
    target = TARGETS[what].get(which)
    load = f"load average {os.getloadavg()[0]:.1f}"
    for clock, note in ((1, "by processor time"), (0, "by wall clock")):
        after = ", by wall clock" if clock == 0 else ""
        for side, label in (("ours", "INRVolume"), *SIDES):
            yield results_file.result(f"{label} {kind}, {where}{after}",
                                      float(f"{found[side][clock] / 1e6:.4g}"), "M samples/s",
                                      "higher", found["way"] if side == "fastest" else "")
        for side, label in SIDES:
            more = {"target": target} if target and side == "fastest" else {}
            yield results_file.result(
                f"vs {label} {kind}, {where}{after}",
                float(f"{found['ours'][clock] / found[side][clock]:.4g}"), "", "higher",
                f"{note}, {THREADS} threads each, {load}",
                baseline=f"{label} {kind}, {where}{after}", **more)


def measure(program, which):
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(program, which, folder)
        file = ModelFile(Path(folder, "model.inr"))
        grid = HashGrid(file, file.parameters)
        print(f"{MODELS[which]}, our kernel: {ours.about['kernel']}")
        for what in ("scattered", "bricks"):
            positions = numbers(folder, what + ".xyz", 3)
            truth = numbers(folder, what + ".values", 1)
            ways = inference_ways(grid, positions, what == "bricks")
            with torch.no_grad():
                for name, way in ways.items():
                    values = way() if what == "scattered" else way().clamp(0, 1)
                    require_equal(values, truth, f"{what}, {name}")
            yield from results_of(what, which, compare(ours, what, ways, len(positions)))
        ways = training_ways(folder, file, ours.about)
        yield from results_of("training", which,
                              compare(ours, "training", ways, len(numbers(folder, "batch.xyz", 3))))
        ours.close()


def main():
    torch.set_num_threads(THREADS)
    results = []
    for which in MODELS:
        for result in measure(sys.argv[1], which):
            results.append(result)
            print(f"{result['name']}: {result['value']} {result['unit']}", flush=True)
    results_file.write("pytorch", results)


if __name__ == "__main__":
    main()
