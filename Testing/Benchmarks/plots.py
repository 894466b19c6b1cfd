#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what protocol.json holds: frame time and hit rate over frames from an empty cache on.

    Testing/Benchmarks/plots.py Testing/Benchmarks/results/MACHINE

Needs matplotlib (Debian: python3-matplotlib).
"""
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

folder = Path(sys.argv[1])
results = json.loads((folder / "protocol.json").read_text())["results"]

# "mean of the last frames, VARIANT, SCENE" and "hit rate at the end, VARIANT, SCENE"
curves = {}
for result in results:
    kind, variant, scene = result["name"].split(", ", 2)
    if len(result["series"]) > 1:
        curves.setdefault(scene, {}).setdefault(kind, {})[variant] = result["series"]

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
figure.tight_layout()
figure.savefig(folder / "protocol.png", dpi=100)
print(folder / "protocol.png")
