# SPDX-License-Identifier: BSD-3-Clause
"""What tradeoff.json holds, drawn: the error of pictures over the time that they take."""
from matplotlib import pyplot

SCENES = ("rm_mixing sparse", "rm_mixing dense", "heptane_fire sparse", "heptane_fire dense",
          "les_vorticity sparse", "les_vorticity dense")
# Knob: colour, marker. The same in every panel.
KNOBS = {"LevelOfDetailScale": ("#2a78d6", "o"), "SampleDistance": ("#eb6834", "s"),
         "CachePrecision": ("#1baf7a", "^"), "ErrorTolerance": ("#4a3aa7", "v"),
         "network only": ("#e34948", "D")}


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    print(path)


def points_of(results, *parts):
    """Scene -> knob -> results."""
    scenes = {}
    for result in results:
        if result.get("part") in parts:
            knob = result["knob"]
            if result["setting"] == "network only":
                knob = "network only"
            scenes.setdefault(result["scene"], {}).setdefault(knob, []).append(result)
    return scenes


def front(points):
    """Of points (time, quality), those that no other is both faster and better than."""
    best, kept = float("-inf"), []
    for time, quality in sorted(points, key=lambda point: (point[0], -point[1])):
        if quality > best:
            best = quality
            kept.append((time, quality))
    return kept


def draw_curve(plot, knob, points, usual):
    colour, marker = KNOBS[knob]
    curve = sorted(points + ([usual] if knob in ("LevelOfDetailScale", "SampleDistance") else []),
                   key=lambda point: setting_of(point, knob))
    plot.plot([point["value"] for point in curve], [point["psnr_a"] for point in curve],
              color=colour, marker=marker, markersize=5, linewidth=1.4 if len(curve) > 2 else 0,
              label=knob)
    for point in curve:
        if point is not usual and knob in ("LevelOfDetailScale", "SampleDistance"):
            if knob == "LevelOfDetailScale" and point["setting"] == "0":
                continue  # hardly to be told from 0.5
            left = knob == "LevelOfDetailScale"
            plot.annotate(point["setting"], (point["value"], point["psnr_a"]), fontsize=7,
                          color=colour, ha="right" if left else "left",
                          xytext=(-5 if left else 5, 2), textcoords="offset points")


def setting_of(point, knob):
    """The number that a knob is set to, by default one."""
    if point["knob"] == "defaults":
        return 0.5 if knob == "SampleDistance" else 1.0
    try:
        return float(point["setting"].split()[0])
    except ValueError:
        return 0.0


def draw_pareto(folder, results):
    single, grid = points_of(results, "knobs", "tolerance"), points_of(results, "grid")
    figure, axes = pyplot.subplots(2, 3, figsize=(13, 7.5), squeeze=False)
    for index, scene in enumerate(SCENES):
        plot = axes[index % 2][index // 2]
        knobs = single.get(scene, {})
        usual = knobs["defaults"][0]
        others = grid.get(scene, {}).get("grid", [])
        if others:
            plot.plot([point["value"] for point in others], [point["psnr_a"] for point in others],
                      marker=".", linewidth=0, color="#b8b6ae", label="three knobs at once")
        for knob in KNOBS:
            if knob in knobs:
                draw_curve(plot, knob, knobs[knob], usual)
        everything = [usual] + others + [point for points in knobs.values() for point in points]
        best = front([(point["value"], point["psnr_a"]) for point in everything])
        plot.step(*zip(*best), where="post", color="#52514e", linewidth=0.8, linestyle=":",
                  label="best")
        plot.plot(usual["value"], usual["psnr_a"], marker="*", markersize=13, color="black",
                  linewidth=0, label="defaults")
        plot.set_xscale("log")
        plot.set_xticks([0.5, 1, 2, 5, 10])
        plot.set_xticklabels(["0.5", "1", "2", "5", "10"])
        plot.minorticks_off()
        plot.set_title(scene, fontsize=10)
        plot.grid(alpha=0.25)
    for row in axes:
        row[0].set_ylabel("PSNR against the decoded voxels, dB")
    for plot in axes[-1]:
        plot.set_xlabel("time of a frame, 1: defaults")
    axes[0][2].legend(fontsize=7, loc="upper right", framealpha=1)
    save(figure, folder / "tradeoff.png")


def draw_levels(folder, results):
    """The paper's figure for our system: what coarser levels buy and cost."""
    single = points_of(results, "knobs")
    rows = (("psnr_a", "PSNR against decoded voxels, dB"), ("flip_a", "mean FLIP"),
            ("first_cpu_ms", "first picture, processor ms"), ("cache_mib", "cache, MiB"))
    figure, axes = pyplot.subplots(1, 4, figsize=(14, 3.6))
    for scene, colour in (("rm_mixing sparse", "#2a78d6"), ("rm_mixing far sparse", "#86b6ef"),
                          ("rm_mixing dense", "#eb6834"), ("heptane_fire sparse", "#1baf7a"),
                          ("heptane_fire dense", "#4a3aa7")):
        knobs = single[scene]
        points = sorted(knobs["LevelOfDetailScale"] + knobs["defaults"],
                        key=lambda point: setting_of(point, "LevelOfDetailScale"))
        for plot, (key, label) in zip(axes, rows):
            plot.plot([setting_of(point, "LevelOfDetailScale") for point in points],
                      [point[key] for point in points], marker="o", markersize=4, color=colour,
                      linewidth=1.4, label=scene)
            plot.set_title(label, fontsize=9)
            plot.set_xlabel("LevelOfDetailScale")
            plot.grid(alpha=0.25)
    for plot in axes[1:]:
        plot.set_ylim(bottom=0)
    axes[0].legend(fontsize=7)
    save(figure, folder / "tradeoff-levels.png")


def draw(folder, results):
    draw_pareto(folder, results)
    draw_levels(folder, results)
