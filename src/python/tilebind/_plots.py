"""Figures in matplotlib, in its current style."""

from __future__ import annotations

import numpy as np


def _axes(ax):
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.gca()


def plot_map(analysis, ax=None, **style):
    """Lowest energy over the orientation, with the states on it."""
    from matplotlib.colors import SymLogNorm

    ax = _axes(ax)
    found = analysis.landscape_map()
    energy = 1e3 * found.energy
    most = np.nanmax(np.abs(energy))
    # Blue attracts and red repels, colour-blind safe; small energies are distinguishable.
    norm = SymLogNorm(linthresh=1e-2 * most, linscale=0.5, vmin=-most, vmax=most, base=10)
    mesh = ax.pcolormesh(
        found.x, found.y, energy, **{"cmap": "RdBu_r", "norm": norm, "rasterized": True, **style}
    )
    states = analysis.states
    for kind, mark, label in (("bound", "o", "bond"), ("misbound", "^", "trap")):
        these = states[states["kind"] == kind]
        if len(these):
            dots = {"marker": mark, "s": 24, "c": "w", "edgecolors": "k", "linewidths": 0.8}
            ax.scatter(these["x_m"], these["y_m"], label=label, zorder=3, **dots)
    ax.fill(*analysis.design.outline("fixed").T, fc="0.85", ec="k", lw=0.8)
    ax.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
    if len(states):
        ax.legend(loc="upper right")
    decades = [10.0**k for k in range(-12, 12) if 2e-2 * most < 10.0**k < most]
    ticks = [-level for level in reversed(decades)] + [0.0] + decades
    bar = ax.figure.colorbar(mesh, ax=ax, ticks=ticks, label="lowest energy (mJ)")
    bar.ax.set_yticklabels([f"{tick:g}" for tick in ticks])
    return ax


def plot_profile(analysis, start=None, end=None, ax=None, **style):
    """Energy along a pathway, its highest point marked."""
    start = 0 if start is None else start
    end = "free" if end is None else end
    path = analysis.pathway(start, end)
    ax = _axes(ax)
    names = analysis.states["name"]
    called = [names[p] if isinstance(p, (int, np.integer)) and p >= 0 else p for p in (start, end)]
    called = ["free" if isinstance(p, (int, np.integer)) else p for p in called]
    style.setdefault("label", f"{called[0]} to {called[1]}")
    (line,) = ax.plot(path["s_m"], 1e3 * path["energy_J"], **style)
    top = path[np.argmax(path["energy_J"])]
    ax.plot(top["s_m"], 1e3 * top["energy_J"], "o", ms=5, mfc="w", mec=line.get_color())
    ax.set(xlabel="length of the path (m)", ylabel="energy (mJ)")
    ax.legend()
    return ax


def plot_disconnectivity(analysis, ax=None, **style):
    """The energies at which kinds of states merge."""
    ax = _axes(ax)
    style = {"color": "k", "lw": 1.2, **style}
    lines = analysis.disconnectivity()
    held = [line["states"].split() for line in lines]
    leaves = [names[0] for names in held if len(names) == 1]
    place = {name: number for number, name in enumerate(leaves)}
    middle = lambda names: np.mean([place[name] for name in names])
    tops = 1e3 * lines["joins_at_J"]
    lowest, highest = 1e3 * lines["energy_J"].min(), np.nanmax(np.append(tops, 0.0))
    above = highest + 0.05 * (highest - lowest)
    for line, names, top in zip(lines, held, tops):
        x, foot = middle(names), 1e3 * line["energy_J"]
        ax.plot([x, x], [foot, above if np.isnan(top) else top], **style)
        if len(names) == 1:
            copies = f" ×{line['copies']:.0f}" if line["copies"] > 1 else ""
            note = {"xytext": (0, -3), "textcoords": "offset points", "ha": "center", "va": "top"}
            ax.annotate(f"{names[0]}{copies}", (x, foot), **note)
    # States that merge at one level are joined by a horizontal line.
    middles = np.array([middle(names) for names in held])
    for level in np.unique(tops[~np.isnan(tops)]):
        joined = middles[tops == level]
        ax.plot([joined.min(), joined.max()], [level, level], **style)
    ax.set(xticks=[], ylabel="energy (mJ)", xlim=(-0.7, len(leaves) - 0.3))
    ax.margins(y=0.12)
    return ax

