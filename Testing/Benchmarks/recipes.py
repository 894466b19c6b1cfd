#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Quality of our training against upstream's recipe, on volumes; writes recipes.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_recipes
    Testing/Benchmarks/recipes.py build-core/Testing/Benchmarks/bench_recipes STEPS VOLUME.vti...

Both see STEPS x 65,536 samples and are stored in half precision. Upstream's recipe is the better
one of its two examples: 8 levels of 8 features from 16^3 on with a network of 64 x 4, which is its
default, and 8 of 4 from 4^3 on with 32 x 4; each level twice as fine as the one before, a table of
the size that gives at least as many parameters as ours (up to twice as many), trained as
UpstreamRecipe.h says.
"""
import json
import subprocess
import sys

import results_file
import volumes


def train(program, samples, path):
    """What the program found: {"ours": outcome, "upstream": {model: outcome}}."""
    with volumes.raw_file(volumes.read(path)) as volume:
        output = subprocess.run([program, *volume, str(samples)], stdout=subprocess.PIPE,
                                check=True).stdout
    return json.loads(output)


def results_of(name, found, steps):
    ours, upstream = found["ours"], found["upstream"]
    theirs = max(outcome["psnr"] for outcome in upstream.values())
    note = (f"{steps} x 65,536 samples, {ours['parameters']:,} parameters; upstream's " +
            " and ".join(f"{outcome['psnr']:.2f} dB with {outcome['parameters']:,} ({model})"
                         for model, outcome in upstream.items()))
    baseline = f"upstream recipe PSNR, {name}"
    yield results_file.result(f"PSNR, {name}", round(ours["psnr"], 3), "dB", "higher", note)
    yield results_file.result(baseline, round(theirs, 3), "dB", "higher", note)
    yield results_file.result(f"vs upstream recipe PSNR, {name}", round(ours["psnr"] - theirs, 3),
                              "dB", "higher", note, baseline=baseline, target=0)


def main():
    program, steps, *paths = sys.argv[1:]
    results = []
    for path in paths:
        found = train(program, 65536 * int(steps), path)
        for result in results_of(volumes.name_of(path), found, steps):
            results.append(result)
            print(f"{result['name']}: {result['value']} dB ({result['note']})", flush=True)
        results_file.write("recipes", results)  # a long run may end early


if __name__ == "__main__":
    main()
