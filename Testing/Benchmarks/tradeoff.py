#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What each setting buys and costs: trains models, runs bench_tradeoff, writes tradeoff.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_train bench_tradeoff
    Testing/Benchmarks/tradeoff.py build-core/Testing/Benchmarks WORK VOLUMES [PART...]
    Testing/Benchmarks/plots.py Testing/Benchmarks/results/MACHINE

VOLUMES is the folder of the .vti files. What was trained and measured stays in the folder WORK, and
a PART ("knobs", "loading", ...: those whose name has it) measures anew just that; without one, all is
measured. Of what no run has measured in WORK, the result file keeps what this machine's has; every line
names its commit. Times are of the processor, beside those of the default settings in turn. Where the
package lpips of PyPI and its network's weights are on this machine, pictures are compared by that, too
(see perceptual.py); where not, the result file says why.
"""
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import perceptual
import results_file
import volumes
from inr_files import Writer

STEPS = 4000
SIZES = {"default": 0, "small": 4, "large": 1 / 4}  # ratio of volume and file, over the default's
VOLUMES = ("rm_mixing", "heptane_fire", "les_vorticity")
# Volume, model, what is measured, view.
PARTS = ([(volume, size, "volume", "whole") for volume in VOLUMES for size in SIZES]
         + [("rm_mixing", "default", "knobs+loading", "whole"),
            ("rm_mixing", "default", "grid", "whole"), ("les_vorticity", "default", "grid", "whole"),
            ("heptane_fire", "default", "knobs", "whole"),
            ("les_vorticity", "default", "knobs", "whole"),
            ("rm_mixing", "default", "knobs", "near"), ("rm_mixing", "default", "knobs", "far"),
            ("rm_mixing", "default", "knobs", "paper"), ("rm_mixing", "default", "tolerance", "paper")]
         + [("les_vorticity", "default", "tolerance", "whole"),
            ("rm_mixing", "default", "tolerance", "far"),
            ("rm_mixing", "default", "tolerance", "whole"),
            ("heptane_fire", "default", "tolerance", "whole"),
            ("rm_mixing", "default", "tolerance", "near")]
         + [(volume, "default", "inference", "whole") for volume in VOLUMES]
         + [(volume, size, "memory", "whole") for volume in ("rm_mixing", "heptane_fire")
            for size in ("default", "small")]
         + [(volume, size, "model", "whole") for volume in ("rm_mixing", "les_vorticity")
            for size in ("small", "large")]
         + [("rm_mixing", "default", "paths", "whole")])


class Bench:
    def __init__(self, programs, work, data):
        self.programs, self.work, self.data = Path(programs), Path(work), Path(data)
        self.work.mkdir(parents=True, exist_ok=True)
        self.lpips, self.about_lpips = perceptual.load()

    def model(self, volume, size, raw):
        """The path of a model, trained if there is none yet; its JSON is what bench_train said."""
        path = self.work / f"{volume}-{size}.inr"
        about = Path(f"{path}.json")
        if not about.exists():
            ratio = 0
            if SIZES[size]:
                ratio = SIZES[size] * self.ratio(self.model(volume, "default", raw))
            about.write_text(json.dumps(
                Writer(self.programs / "bench_train", STEPS, raw, path).save(ratio)))
        return path

    @staticmethod
    def ratio(path):
        return json.loads(Path(f"{path}.json").read_text())["ratio"]

    def measure(self, volume, size, what, view):
        with volumes.raw_file(volumes.read(self.data / f"{volume}.vti")) as raw:
            model = self.model(volume, size, raw)
            usual = [self.model(volume, "default", raw)] if what == "model" else []
            lines = self.run(self.programs / "bench_tradeoff", model, volume, *raw, what, view,
                             *usual)
        for line in lines:
            line["ratio"] = round(self.ratio(model), 1)
            if what in ("volume", "memory") or (what == "model" and "knob" not in line):
                line["name"] += f", {size} model"
            elif what == "model":
                line["parameters"], line["setting"] = int(line["setting"]), size
                line["knob"] = line["knob"].replace("parameters", "model size")
                line["name"] = f"{line['scene']}, {line['knob']} {size}"
        self.file(volume, size, what, view).write_text(
            json.dumps({"commit": results_file.commit(), "lines": lines}))

    def run(self, *command):
        with tempfile.TemporaryDirectory() as folder:
            pictures = {"INR_PICTURES": folder} if self.lpips else {}
            run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True,
                                 env={**os.environ, **pictures})
            return [self.with_lpips(json.loads(line)) for line in run.stdout.splitlines()]

    def with_lpips(self, line):
        for key in [key for key in line if key.startswith("pictures_")]:
            line[key.replace("pictures", "lpips")] = self.lpips.of_file(line.pop(key))
        return line

    def file(self, *part):
        return self.work / f"{'-'.join(part)}.json"

    def measured(self, parts):
        references = set()
        for part in parts:
            if self.file(*part).exists():
                stored = json.loads(self.file(*part).read_text())
                for line in stored["lines"]:
                    if "part" in line or line["name"] not in references:  # which two parts may have
                        references.add(line["name"])
                        yield {**line, "commit": stored["commit"]}


def rounded(figures):
    return {key: float(f"{value:.4g}") if isinstance(value, float) else value
            for key, value in figures.items()}


def result_of(line):
    """A line of bench_tradeoff as a result: what it is about first."""
    line = dict(line)
    name = line.pop("name").rstrip()
    if "bricks_mib" in line:
        return results_file.result(name, sum(part for key, part in line.items() if "_mib" in key and
                                             key != "tolerance_mib"), "MiB", "lower",
                                   "by part; with a tolerance, tolerance_mib more", **line)
    for key, what in (("psnr", "decoded against original voxels"),
                      ("psnr_float", "against those in float32"),
                      ("psnr_a_c", "the decoded voxels' picture against the data's"),
                      ("psnr_a_without_cache", "the decoded voxels' with and without a cache")):
        if key in line:
            return results_file.result(f"{name}, PSNR", line.pop(key), "dB", "higher", what, **line)
    return results_file.result(
        f"{name}, time", line["cpu_ms"] / line["default_cpu_ms"], "of the default's", "lower",
        "processor time, 2 threads, 256x256; from far 128x128, of paths 64x64", **line)


def summaries(lines):
    """Over all scenes: what a setting buys and costs."""
    points = {}
    for line in lines:
        if line.get("part") in ("knobs", "tolerance", "loading", "model", "paths"):
            key = (line["part"] == "paths", line["knob"], line["setting"])
            points.setdefault(key, []).append(line)
    for (paths, knob, setting), same in points.items():
        ratios = [line["cpu_ms"] / line["default_cpu_ms"] for line in same]
        first = [line["first_cpu_ms"] / line["default_first_cpu_ms"] for line in same
                 if "first_cpu_ms" in line]
        more = {"first_picture": geometric_mean(first)} if first else {}
        for look in ("sparse", "dense"):
            more.update(errors([line for line in same if look in line["scene"]], look))
        more["least_psnr_default"] = min(line["psnr_default"] for line in same)
        name = f"{'paths, ' if paths else ''}{knob} {setting}".strip()
        yield results_file.result(f"{name}, time in the mean", geometric_mean(ratios),
                                  "of the default's", "lower",
                                  f"geometric mean over {len(same)} scenes; the median error", **more)


def errors(lines, look):
    """Medians over scenes, against every reference."""
    keys = [f"{key}_{reference}" for reference in "abc"
            for key in ("psnr", "ssim", "flip", "max", "lpips")]
    return {f"{look}_{key}": statistics.median(line[key] for line in lines)
            for key in keys if all(key in line for line in lines)}


def geometric_mean(values):
    return math.exp(statistics.fmean(map(math.log, values)))


def main():
    programs, work, data, *wanted = sys.argv[1:]
    bench = Bench(programs, work, data)
    for part in PARTS:
        if not wanted or any(name in "-".join(part) for name in wanted):
            print("-".join(part), flush=True)
            bench.measure(*part)
    results = [result for result in results_file.last("tradeoff") if "commit" in result]
    results = {result["name"]: result for result in results}
    for result in map(result_of, bench.measured(PARTS)):
        results[result["name"]] = result
    results = [*summaries(results.values()), *results.values()]
    results_file.write("tradeoff", [rounded(result) for result in results],
                       lpips=bench.about_lpips)


if __name__ == "__main__":
    main()
