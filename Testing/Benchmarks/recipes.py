#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Quality of our training against upstream's recipe, on volumes; writes recipes.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_recipes
    Testing/Benchmarks/recipes.py build-core/Testing/Benchmarks/bench_recipes VOLUME.vti...

Both see 200 x 65,536 samples and are stored in half precision. Upstream's recipe is its default
configuration (8 levels of 8 features from 16^3 on, each twice as fine as the one before, 64 x 4)
with another size of table, trained as UpstreamRecipe.h says. As sizes of tables are powers of two, its
quality at our number of parameters is interpolated between the next smaller and the next larger
model, over the logarithm of the number.
"""
import json
import math
import subprocess
import sys

import results_file
import volumes

SAMPLES = 200 * 65536


def train(program, path):
    """What the program found: {"ours": ..., "upstream": [smaller, larger]}."""
    with volumes.raw_file(volumes.read(path)) as volume:
        output = subprocess.run([program, *volume, str(SAMPLES)], stdout=subprocess.PIPE,
                                check=True).stdout
    return json.loads(output)


def upstream_psnr(smaller, larger, parameters):
    sizes = [math.log(some["parameters"]) for some in (smaller, larger)]
    share = (math.log(parameters) - sizes[0]) / (sizes[1] - sizes[0])
    return smaller["psnr"] + share * (larger["psnr"] - smaller["psnr"])


def results_of(name, found):
    ours, (smaller, larger) = found["ours"], found["upstream"]
    theirs = upstream_psnr(smaller, larger, ours["parameters"])
    note = (f"{ours['parameters']:,} parameters; upstream's {smaller['psnr']:.2f} dB with "
            f"{smaller['parameters']:,} and {larger['psnr']:.2f} dB with {larger['parameters']:,}")
    yield results_file.result(f"PSNR, {name}", round(ours["psnr"], 3), "dB", "higher", note)
    yield results_file.result(f"upstream recipe PSNR, {name}", round(theirs, 3), "dB", "higher",
                              note)
    yield results_file.result(f"vs upstream recipe PSNR, {name}", round(ours["psnr"] - theirs, 3),
                              "dB", "higher", note, baseline=f"upstream recipe PSNR, {name}",
                              target=0)


def main():
    results = []
    for path in sys.argv[2:]:
        for result in results_of(volumes.name_of(path), train(sys.argv[1], path)):
            results.append(result)
            print(f"{result['name']}: {result['value']} dB ({result['note']})", flush=True)
    results_file.write("recipes", results)


if __name__ == "__main__":
    main()
