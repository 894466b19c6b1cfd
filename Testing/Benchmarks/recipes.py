#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Quality of our training against upstream's recipe, on volumes; writes recipes.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_recipes
    Testing/Benchmarks/recipes.py build-core/Testing/Benchmarks/bench_recipes VOLUME.vti...

Both see 200 x 65,536 samples and are stored in half precision. Upstream's recipe is its default
configuration (8 levels from 16^3 on, each twice as fine as the one before, 64 x 4), trained as
UpstreamRecipe.h says. Its table has the size that gives at least as many parameters as ours, up to
twice as many, and what counts is the better one of 8 features a level, its default, and 2, whose
larger tables suit small models.
"""
import json
import subprocess
import sys

import results_file
import volumes

SAMPLES = 200 * 65536


def train(program, path):
    """What the program found: {"ours": outcome, "upstream": {features: outcome}}."""
    with volumes.raw_file(volumes.read(path)) as volume:
        output = subprocess.run([program, *volume, str(SAMPLES)], stdout=subprocess.PIPE,
                                check=True).stdout
    return json.loads(output)


def results_of(name, found):
    ours, upstream = found["ours"], found["upstream"]
    theirs = max(outcome["psnr"] for outcome in upstream.values())
    note = f"{ours['parameters']:,} parameters; upstream's " + " and ".join(
        f"{outcome['psnr']:.2f} dB with {outcome['parameters']:,}, {features} features a level"
        for features, outcome in upstream.items())
    baseline = f"upstream recipe PSNR, {name}"
    yield results_file.result(f"PSNR, {name}", round(ours["psnr"], 3), "dB", "higher", note)
    yield results_file.result(baseline, round(theirs, 3), "dB", "higher", note)
    yield results_file.result(f"vs upstream recipe PSNR, {name}", round(ours["psnr"] - theirs, 3),
                              "dB", "higher", note, baseline=baseline, target=0)


def main():
    results = []
    for path in sys.argv[2:]:
        for result in results_of(volumes.name_of(path), train(sys.argv[1], path)):
            results.append(result)
            print(f"{result['name']}: {result['value']} dB ({result['note']})", flush=True)
        results_file.write("recipes", results)  # a long run may end early


if __name__ == "__main__":
    main()
