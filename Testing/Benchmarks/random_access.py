#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How soon a compressed volume gives a part of its voxels, and a picture: a model file against a
zfp stream of about the same PSNR. Writes random-access.json.

    cmake --preset core -DINR_BUILD_BENCHMARKS=ON
    cmake --build --preset core --target bench_train bench_random_access
    Testing/Benchmarks/random_access.py build-core/Testing/Benchmarks STEPS VOLUME.vti...

A model gives any voxel for itself. zfp's stream with a bound on the error is decompressed whole
(one at a fixed rate could be in parts, but takes several times the bytes for the same PSNR, see
rate_distortion.py), and so are TTHRESH's and SZ3's; what a picture takes comes on top of that. Two
threads, and one for zfp, which never takes more to decompress. Needs zfp's Python module (Debian:
python3-zfpy).
"""
import json
import os
import subprocess
import sys
import tempfile
import time

import results_file  # first: it answers --help without the packages that follow

import zfpy

import other_compressors
import volumes
from inr_files import Writer

SIDE = 64
REPETITIONS = 5


def nearest_stream(voxels, psnr):
    """zfp's stream whose PSNR is nearest, and that PSNR."""
    span = float(voxels.max()) - float(voxels.min())
    candidates = []
    for tolerance in other_compressors.TOLERANCES:
        stream = other_compressors.zfp_stream(voxels, tolerance=span * tolerance)
        reached = other_compressors.psnr(voxels, zfpy.decompress_numpy(stream))
        candidates.append((abs(reached - psnr), reached, stream))
    _, reached, stream = min(candidates, key=lambda candidate: candidate[0])
    return stream, reached


def decompression_seconds(stream):
    """Wall and processor seconds, the best of a few runs."""
    runs = []
    for _ in range(REPETITIONS):
        wall, processor = time.perf_counter(), time.process_time()
        zfpy.decompress_numpy(stream)
        runs.append((time.perf_counter() - wall, time.process_time() - processor))
    return [min(run[clock] for run in runs) for clock in (0, 1)]


def results_of(name, times, zfp, note):
    """Entries in milliseconds, by both clocks."""
    for clock, after in ((0, ""), (1, ", by processor time")):
        baseline = f"all voxels from zfp, {name}{after}"
        yield results_file.result(baseline, round(1e3 * zfp[clock], 3), "ms", "lower", note)
        for what, label in (("part", f"{SIDE}^3 voxels"), ("first picture", "first picture"),
                            ("complete picture", "complete picture")):
            yield results_file.result(f"{label}, {name}{after}",
                                      round(1e3 * times[what][clock], 3), "ms", "lower", note)
        yield results_file.result(f"{SIDE}^3 voxels vs zfp, {name}{after}",
                                  round(zfp[clock] / times["part"][clock], 3), "", "higher", note,
                                  baseline=baseline)


def measure(folder, steps, path):
    name, voxels = volumes.name_of(path), volumes.read(path)
    with volumes.raw_file(voxels) as volume, tempfile.TemporaryDirectory() as place:
        writer = Writer(os.path.join(folder, "bench_train"), steps, volume,
                        os.path.join(place, "model.inr"))
        file = writer.save()
        stream, reached = nearest_stream(voxels, file["psnr"])
        program = os.path.join(folder, "bench_random_access")
        times = json.loads(subprocess.run([program, writer.path, str(SIDE)], check=True,
                                          stdout=subprocess.PIPE).stdout)
    note = (f"INR {file['psnr']:.1f} dB at {file['ratio']:.1f}:1, zfp {reached:.1f} dB at "
            f"{voxels.nbytes / len(stream):.1f}:1; load average {os.getloadavg()[0]:.1f}")
    yield from results_of(name, times, decompression_seconds(stream), note)


def main():
    folder, steps, *paths = sys.argv[1:]
    results = []
    for path in paths:
        for result in measure(folder, int(steps), path):
            results.append(result)
            print(f"{result['name']}: {result['value']} {result['unit']} ({result['note']})",
                  flush=True)
        results_file.write("random-access", results)  # a long run may end early


if __name__ == "__main__":
    main()
