"""Pictures of grown sets for the study."""

import re

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from check import SETS, Grown, at_growth, with_words  # noqa: E402
from study import EXCESS, NAMES, TREE, blocks_of, ideal, whole  # noqa: E402


def show(axis, grown, text, title):
    """A canvas in the colours of its tiles; tiles with errors that are there to stay have a cross."""
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


def draw(program, folder, out):
    figure, axes = plt.subplots(1, 5, figsize=(13, 3), constrained_layout=True)
    for axis, name in zip(axes.flat, ["sierpinski", *(it for it in NAMES if it != TREE)]):
        arguments = [str(SETS / f"{name}.yaml"), "--length", "16", "--shape", "shared", "--seconds", "4"]
        given, _ = with_words(program, folder / "drawn", arguments)
        report = at_growth(program, folder / "drawn", given, EXCESS)
        path = folder / "drawn" / "assembly.yaml"
        grown = Grown(path, size=whole(report))
        title = f"{name}: {grown.count} tiles,\n{errors(grown)}"
        show(axis, grown, path.read_text(), title)
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
