"""Pictures of grown sets for the study."""

import csv
import re

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from check import Grown, at_growth, kept_words  # noqa: E402
from study import EXCESS, ORDER, blocks_of, ideal, whole  # noqa: E402


def show(axis, grown, text, title):
    """A canvas in the colours of its tiles; tiles with permanent errors have a cross."""
    lines = [it for it in text.splitlines() if it.startswith("- {name:") and "edges:" in it]
    colours = [re.search(r'color: "(#\w{6})"', line) for line in lines]
    colours = [it[1] if it else "#888888" for it in colours]
    palette = np.array([(1.0, 1.0, 1.0), *(matplotlib.colors.to_rgb(it) for it in colours)])
    rows, columns = np.nonzero(grown.canvas)
    low, high = (rows.min(), columns.min()), (rows.max() + 1, columns.max() + 1)
    inside = grown.canvas[low[0] : high[0], low[1] : high[1]]
    axis.imshow(palette[inside], interpolation="nearest")
    wrong = np.array(grown.settled).reshape(-1, 2) - low
    axis.plot(wrong[:, 1], wrong[:, 0], "kx", markersize=4, markeredgewidth=1)
    axis.set_title(title, fontsize=9)
    axis.set_axis_off()


def errors(grown):
    return "1 error" if len(grown.settled) == 1 else f"{len(grown.settled)} errors"


def save(figure, path):
    figure.savefig(path, dpi=110, bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)


# By Okabe and Ito, and a mark each.
LOOKS = ["#0072B2 o", "#999999 s", "#009E73 ^", "#D55E00 v", "#CC79A7 D", "#E69F00 P"]


def shaking(out):
    """Speed and errors over shaking, of magnets (drawn through) and of ideal glues (dashed)."""
    with open(out / "shaking.csv") as file:
        rows = list(csv.DictReader(file))
    figure, (speed, wrong) = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for name, look in zip(ORDER, LOOKS):
        colour, mark = look.split()
        mine = sorted((it for it in rows if it["set"] == name), key=lambda it: float(it["kt_J"]))
        if not mine:
            continue
        for axis, column in ((speed, "tiles_a_docking_time"), (wrong, "errors_a_tile")):
            for ending, line in (("", "-"), ("_ideal", "--")):
                points = [it for it in mine if it[column + ending]]
                place = [float(it["kt_J"]) / float(it["window_high_J"]) for it in points]
                label = name if ending == "" else None
                # No observed error is drawn at the bottom.
                values = [max(float(it[column + ending]), 1e-5) for it in points]
                axis.plot(place, values, line, color=colour, marker=mark, markersize=4, linewidth=1, label=label)
    for axis, title in ((speed, "tiles a docking time"), (wrong, "errors a tile (1e-5: none seen)")):
        axis.set_yscale("log")
        axis.set_xlabel("kT, as a share of the window's upper end")
        axis.set_title(title, fontsize=10)
        axis.grid(alpha=0.3)
    speed.legend(fontsize=8)
    save(figure, out / "shaking.png")


def draw(program, folder, out):
    shaking(out)
    figure, axes = plt.subplots(2, 3, figsize=(11, 7), constrained_layout=True)
    for axis, name in zip(axes.flat, ORDER):
        report = at_growth(program, folder / name, kept_words(program, name), EXCESS)
        path = folder / name / "assembly.yaml"
        grown = Grown(path, size=whole(report))
        show(axis, grown, path.read_text(), f"{name}: {grown.count} tiles, {errors(grown)}")
    save(figure, out / "grown.png")
    figure, axes = plt.subplots(2, 2, figsize=(7.5, 7.5), constrained_layout=True)
    for row, wrong in zip(axes, (0.0, 0.5)):
        for axis, k in zip(row, (1, 2)):
            text = blocks_of(program, folder, k)
            path = ideal(folder, text, 8.0, 16.0 - EXCESS, wrong)
            grown = Grown(path, size=400 * k * k, plain=True)
            title = f"wrong {wrong}, blocks {k} x {k}: {errors(grown)}"
            show(axis, grown, text, title)
    save(figure, out / "proofreading.png")
