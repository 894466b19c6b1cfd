#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what the result files hold: protocol.json, frame time and hit rate over frames from an
empty cache on; rate-distortion.json, PSNR over the ratio of volume and file; tradeoff.json, error
over time.

    Testing/Benchmarks/plots.py Testing/Benchmarks/results/MACHINE

Needs matplotlib (Debian: python3-matplotlib).
"""
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

import tradeoff_plots  # noqa: E402


def results_in(folder, topic):
    path = folder / f"{topic}.json"
    return json.loads(path.read_text())["results"] if path.exists() else []


def save(figure, folder, topic):
    figure.tight_layout()
    figure.savefig(folder / f"{topic}.png", dpi=100)
    print(folder / f"{topic}.png")


def frame_curves(results):
    """Scene -> kind -> variant -> series; names are "mean of the last frames, VARIANT, SCENE" and
    "hit rate at the end, VARIANT, SCENE"."""
    curves = {}
    for result in results:
        kind, variant, scene = result["name"].split(", ", 2)
        if len(result["series"]) > 1:
            curves.setdefault(scene, {}).setdefault(kind, {})[variant] = result["series"]
    return curves


def draw_protocol(folder, curves):
    figure, axes = pyplot.subplots(2, len(curves), figsize=(4 * len(curves), 5.5), squeeze=False,
                                   sharex=True)
    for column, (scene, kinds) in enumerate(sorted(curves.items())):
        for row, (kind, label) in enumerate((("mean of the last frames", "ms to march"),
                                             ("hit rate at the end", "samples at their level"))):
            plot = axes[row][column]
            for variant, series in kinds[kind].items():
                plot.plot(range(1, len(series) + 1), series, label=variant, linewidth=1.2)
            plot.set_ylim(bottom=0)
            plot.grid(alpha=0.3)
            if column == 0:
                plot.set_ylabel(label)
        axes[0][column].set_title(scene, fontsize=9)
        axes[1][column].set_xlabel("frame (loading ends at 0.1 s)")
    axes[1][0].legend(fontsize=8)
    save(figure, folder, "protocol")


def rate_curves(results):
    """Volume -> method -> points (ratio, PSNR), of the results that are points."""
    curves = {}
    for result in results:
        if "ratio" in result:
            volume, method = result["name"].rsplit(", PSNR at", 1)[0].split(", ", 1)
            curves.setdefault(volume, {}).setdefault(method, []).append(
                (result["ratio"], result["value"]))
    return curves


def draw_rates(folder, curves):
    figure, axes = pyplot.subplots(1, len(curves), figsize=(4 * len(curves), 3.6), squeeze=False)
    for plot, (volume, methods) in zip(axes[0], sorted(curves.items())):
        for method, points in methods.items():
            ratios, psnr = zip(*sorted(points))
            plot.plot(ratios, psnr, marker="o", markersize=3, label=method,
                      linewidth=2.2 if method == "INR" else 1.2)
        plot.set_xscale("log")
        plot.set_xlim(4, 2000)
        plot.set_ylim(25, 60)
        plot.grid(alpha=0.3, which="both")
        plot.set_title(volume, fontsize=9)
        plot.set_xlabel("volume bytes / file bytes")
    axes[0][0].set_ylabel("PSNR, dB")
    axes[0][0].legend(fontsize=8)
    save(figure, folder, "rate-distortion")


def main():
    folder = Path(sys.argv[1])
    for topic, curves_of, draw in (("protocol", frame_curves, draw_protocol),
                                   ("rate-distortion", rate_curves, draw_rates)):
        curves = curves_of(results_in(folder, topic))
        if curves:
            draw(folder, curves)
    tradeoff = results_in(folder, "tradeoff")
    if any(result.get("part") == "knobs" for result in tradeoff):
        tradeoff_plots.draw(folder, tradeoff)


if __name__ == "__main__":
    main()
