# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView is like with a model of the turbulent channel: a flight through it, and pictures
beside those of the field itself. For terascale.py."""
import json
import struct
import subprocess
import zlib
from pathlib import Path

import results_file

HERE = Path(__file__).resolve().parent
FRAMES = 4000
CACHE = 2048  # MiB


def run(*command):
    output = subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE,
                            text=True).stdout
    return output.strip()


def part_of(values, part):
    return sorted(values)[min(int(part * len(values)), len(values) - 1)]


def read_ppm(path):
    """Width and the rows of 8-bit RGB."""
    header, pixels = path.read_bytes().split(b"\n255\n", 1)
    width, _ = (int(number) for number in header.split()[1:])
    return width, [pixels[at:at + 3 * width] for at in range(0, len(pixels), 3 * width)]


def write_png(path, width, rows):
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data
                + struct.pack(">I", zlib.crc32(name + data)))
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n"
                     + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def about_flight(flight, opening):
    result = results_file.result
    frames = len(flight["seconds"])
    busy = f"others took {flight['others']:.1f} times as much processor time meanwhile"
    where = f", flight of {frames} frames"
    yield result("time to the first picture", round(opening, 2), "s", "lower")
    yield result("peak memory MiB" + where, round(flight["peak"]), "MiB", "lower",
                 f"resident, above ParaView with an empty view; the cache may take {CACHE}")
    yield result("growth of peak memory after a quarter" + where, round(flight["growth"]), "MiB",
                 "lower")
    yield result("cache in use at most" + where, round(flight["cache"]), "MiB", "lower",
                 target=CACHE)
    yield result("mean hit rate" + where, round(sum(flight["hits"]) / frames, 4), "", "higher",
                 "samples from the level that they asked for")
    yield result("median frame" + where, round(1000 * part_of(flight["seconds"], 0.5), 1), "ms",
                 "lower", "ParaView's interactive rendering, 384x256; in the mapper "
                 f"{1000 * part_of(flight['mapper'], 0.5):.1f} ms; {busy}")
    yield result("99 of 100 frames" + where, round(1000 * part_of(flight["seconds"], 0.99), 1),
                 "ms", "lower", f"in the mapper {1000 * part_of(flight['mapper'], 0.99):.1f} ms")
    yield result("slowest frame" + where, round(1000 * max(flight["seconds"]), 1), "ms", "lower")
    yield result("frames per second" + where, round(frames / sum(flight["seconds"]), 1), "1/s",
                 "higher")


def about_view(name, view, error, coarser):
    result = results_file.result
    what = (f"complete after {view['seconds']:.0f} s; levels {error['mean_level']:.1f} in the mean, "
            f"{error['mean_samples']:.0f} samples a ray; the field: {error['samples'] / 1e6:.0f} M "
            f"samples, and with half of them {coarser:.1f} dB from that")
    assert view["converged"] == 1, f"the picture {name} is not complete"
    yield result(f"image PSNR, {name}", round(error["psnr"], 2), "dB", "higher", what)
    yield result(f"image SSIM, {name}", round(error["ssim"], 4), "", "higher")
    yield result(f"image FLIP, {name}", round(error["flip"], 4), "", "lower")


def results(build, work, model, dims):
    """Flies and compares; leaves the pictures in the folder `work`, all together as beside.png."""
    work.mkdir(exist_ok=True)
    plugins = next((build / "lib").glob("paraview-*")) / "plugins"
    given = {"plugin": str(plugins / "INRVolume/INRVolume.so"), "model": str(model), "dims": dims,
             "frames": FRAMES, "cache": CACHE, "folder": str(work)}
    tour = json.loads(run("pvpython", HERE / "channel_tour.py", json.dumps(given)).splitlines()[-1])
    found = list(about_flight(tour["flight"], tour["opening"]))
    rows = []
    program = build / "Testing/Turbulence/channel_picture"
    for view in tour["views"]:
        scene = work / f"{view}.json"
        error = json.loads(run(program, scene, work / f"{view}-field.exr", "--compare",
                               work / f"{view}.exr", "--beside", work / f"{view}.ppm"))
        coarser = work / f"{view}-coarser.json"
        text = json.loads(scene.read_text())
        coarser.write_text(json.dumps({**text, "sample_distance": 2 * text["sample_distance"]}))
        change = json.loads(run(program, coarser, work / f"{view}-coarser.exr", "--compare",
                                work / f"{view}-field.exr"))
        found += about_view(view, tour["views"][view], error, change["psnr"])
        width, beside = read_ppm(work / f"{view}.ppm")
        rows += beside
    found.append(results_file.result("peak memory MiB, with still pictures", round(tour["peak"]),
                                     "MiB", "lower", "at the end of all"))
    for one in found:
        print(one["name"], one["value"], one["unit"], one["note"], flush=True)
    write_png(work / "beside.png", width, rows)
    return found
