#!/usr/bin/env python3
"""Predicts two published experiments whose inputs are not all known, and writes the folder `validation`.

    results/predictions.py PROGRAM FOLDER

Rings of eight sectors on an orbital shaker, and the accelerations at which barcoded panels come apart.
What the sources do not state is drawn from ranges (a Latin hypercube of a fixed seed), each draw is
computed or simulated, and the spread of the results is the prediction. Needs NumPy, SciPy and Matplotlib.
"""

import csv
import json
import math
import os
import pathlib
import sys
import tempfile
from multiprocessing.pool import ThreadPool

import numpy

from validation import Program

GRAVITY = 9.80665  # m/s2
MAGNET = 7500  # kg/m3

# Rings: stated are the radius of 25 mm, the thickness of 8 mm, magnets of radius 1.5 mm (N48), the round
# container of 125 mm radius and 300 revolutions a minute. Assumed are these ranges.
RINGS = {
    "magnet_length_mm": (2.0, 3.5),
    "inset_mm": (0.2, 0.8),
    "orbit_radius_mm": (5.0, 20.0),
    "table_friction": (0.1, 0.4),
    "tile_friction": (0.1, 0.5),
    "restitution": (0.2, 0.7),
    "inner_radius_mm": (3.0, 10.0),
    "density_kg_m3": (950.0, 1150.0),
}
RING_DRAWS, PARTS, SECONDS = 24, 16, 12
# Panels: stated are 2 x 2 magnets on each and the measured accelerations. Assumed are these ranges.
PANELS = {
    "side_mm": (15.0, 40.0),
    "thickness_mm": (3.0, 8.0),
    "magnet_mm": (2.0, 4.0),
    "remanence_T": (1.15, 1.40),
    "inset_mm": (0.0, 1.0),
    "density_kg_m3": (1000.0, 1300.0),
    "frequency_Hz": (8.0, 30.0),
    "table_friction": (0.1, 0.5),
    "restitution": (0.1, 0.7),
}
PANEL_DRAWS, SHAKEN = 60, 6
CHAINS = (2, 3, 5)
SIMULATED = (2, 3)
# Accelerations tried, over pull-off force by mass, and seconds of each.
LEVELS = [2.0**k for k in range(-6, 3)]
SHAKING = 1.0


def drawn(ranges, count, seed):
    """A Latin hypercube: each range is divided evenly, and each part has one draw."""
    generator = numpy.random.default_rng(seed)
    columns = {}
    for name, (low, high) in ranges.items():
        places = (generator.permutation(count) + generator.random(count)) / count
        columns[name] = low + (high - low) * places
    return [{name: float(f"{columns[name][k]:.4g}") for name in ranges} for k in range(count)]


# Rings

def sector(it):
    """A sector of 45 degrees with a disc behind the middle of each cut: north on one, south on the other."""
    inner, outer, half = 1e-3 * it["inner_radius_mm"], 25e-3, math.pi / 8
    corner = lambda r, turn: f"[{r * math.cos(turn):.12f}, {r * math.sin(turn):.12f}]"
    corners = ", ".join([corner(inner, -half), corner(outer, -half), corner(outer, half), corner(inner, half)])
    area = (outer**2 - inner**2) * math.sin(half) * math.cos(half)
    length = 1e-3 * it["magnet_length_mm"]
    magnets = 2 * math.pi * 1.5e-3**2 * length
    mass = it["density_kg_m3"] * (area * 8e-3 - magnets) + MAGNET * magnets
    return (f'name = "sector"\n[table]\nshape = "disc"\ndiameter = 0.25\n[magnet]\nshape = "disc"\ndiameter = 0.003\n'
            f'height = {length:.6f}\ngrade = "N48"\npitch = 0.01\ninset = {1e-3 * it["inset_mm"]:.6f}\n'
            f'[tile]\nvertices = [{corners}]\nthickness = 0.008\nmass = {mass:.7f}\n'
            f'[tile.faces]\n0 = {{ code = "N" }}\n2 = {{ code = "S" }}\n[target]\nfaces = ["0", "2"]\n'), mass


def ring_run(program, number, it):
    """One draw: the closed rings, bonds and wrong contacts at the end of one run."""
    text, mass = sector(it)
    design = program.file(f"sector-{number}.toml", text)
    force = program.json("show", design, "--json")["pull_off_N"]
    report = program.json(
        "table", design, "--count", PARTS, "--time", SECONDS, "--seed", number + 1, "--target", "ring:8", "--drag", 0,
        "--orbital", f"{it['orbit_radius_mm']:g} mm,300 rpm", "--table-friction", it["table_friction"],
        "--friction", it["tile_friction"], "--restitution", it["restitution"], "--threads", 1, "--json")
    sizes = [(row["kind"], row["size"], row["mean"]) for row in report["structures"]]
    in_rings = sum(size * mean for kind, size, mean in sizes if kind == "ring")
    longest = max([size for kind, size, _ in sizes if kind in ("ring", "chain")], default=1)
    print(f"rings, draw {number + 1} of {RING_DRAWS}: {in_rings:.0f} tiles in rings", flush=True)
    return {**it, "mass_g": 1e3 * mass, "bond_pull_N": force, "bonds": report["bonds"]["mean"],
            "traps": report["traps"]["mean"], "in_rings": in_rings / PARTS, "longest": longest}


def rings(program):
    with ThreadPool(os.cpu_count()) as pool:
        return pool.starmap(lambda number, it: ring_run(program, number, it), enumerate(drawn(RINGS, RING_DRAWS, 1)), chunksize=1)


# Panels

def panel(it, table):
    side, edge = 1e-3 * it["side_mm"], 1e-3 * it["magnet_mm"]
    magnets = 4 * edge**3
    mass = it["density_kg_m3"] * (side**2 * 1e-3 * it["thickness_mm"] - magnets) + MAGNET * magnets
    return (f'name = "panel"\n[table]\nsize = [{table:.6f}, {table:.6f}]\n[magnet]\nsize = [{edge}, {edge}, {edge}]\n'
            f'remanence = {it["remanence_T"]}\npitch = {0.6 * side:.6f}\ninset = {1e-3 * it["inset_mm"]:.6f}\n'
            f'[tile]\nside = {side:.6f}\nthickness = {max(1e-3 * it["thickness_mm"], 1.1 * edge):.6f}\nmass = {mass:.7f}\n'
            f'[tile.faces]\neast = {{ code = "NN" }}\nwest = {{ mates = "east" }}\n[target]\nfaces = ["east", "west"]\n'), mass


def keeps(program, it, count, acceleration):
    """Whether a chain in a box two tiles longer keeps all its bonds while it is shaken along its length."""
    side = 1e-3 * it["side_mm"]
    design = program.file("panel.toml", panel(it, (count + 2) * side)[0])
    places = "".join(f"{k},{(k - (count - 1) / 2) * side:.9f},0,0,0,0,0\n" for k in range(count))
    start = program.file("start.csv", "tile,x,y,theta,vx,vy,omega\n" + places)
    amplitude = acceleration / (2 * math.pi * it["frequency_Hz"]) ** 2
    report = program.json(
        "table", design, "--start", start, "--time", SHAKING, "--drag", 0, "--linear",
        f"{amplitude:.9g},{it['frequency_Hz']:g},0", "--table-friction", it["table_friction"], "--friction", 0.3,
        "--restitution", it["restitution"], "--threads", 1, "--json")
    whole = sum(row["mean"] for row in report["structures"] if row["kind"] == "chain" and row["size"] == count)
    return whole > 0


def panels(program):
    found = []
    for number, it in enumerate(drawn(PANELS, PANEL_DRAWS, 2)):
        text, mass = panel(it, 12e-3 * it["side_mm"])
        force = program.json("show", program.file("panel.toml", text), "--json")["pull_off_N"]
        row = {**it, "mass_g": 1e3 * mass, "bond_pull_N": force, "held_g": force / mass / GRAVITY}
        for count in CHAINS:
            row[f"shaken_{count}_g"] = None
            if number < SHAKEN and count in SIMULATED:
                # The highest level at which the chain is whole: levels are halved.
                low, high = -1, len(LEVELS)
                while high - low > 1:
                    middle = (low + high) // 2
                    whole = keeps(program, it, count, LEVELS[middle] * force / mass)
                    low, high = (middle, high) if whole else (low, middle)
                between = [LEVELS[k] if 0 <= k < len(LEVELS) else None for k in (low, high)]
                if None not in between:
                    row[f"shaken_{count}_g"] = math.sqrt(between[0] * between[1]) * row["held_g"]
        if number < SHAKEN:
            print(row, flush=True)
        found.append(row)
    return found


# The page

def spread(values):
    """Least, median and largest of the middle nine tenths."""
    return [float(numpy.quantile(values, part)) for part in (0.05, 0.5, 0.95)]


def ranks(rows, ranges, of):
    """Spearman's rank correlation of each assumed quantity with a result, the largest first."""
    from scipy.stats import spearmanr
    values = [row[of] for row in rows]
    if len(set(values)) < 2:
        return []
    all_of = [(name, float(spearmanr([row[name] for row in rows], values)[0])) for name in ranges]
    return sorted(all_of, key=lambda it: -abs(it[1]))


def markdown(head, lines):
    return "\n".join("| " + " | ".join(map(str, it)) + " |" for it in (head, ["---"] * len(head), *lines)) + "\n"


def named(name):
    name, _, unit = name.rpartition("_")
    units = {"mm": "mm", "m3": "kg/m3", "T": "T", "Hz": "Hz"}
    if unit in units:
        return f"{name.removesuffix('_kg').replace('_', ' ')} ({units[unit]})"
    return f"{name}_{unit}".strip("_").replace("_", " ")


def draw(ring_rows, panel_rows, path):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "tilebind"
    from matplotlib import pyplot
    blue, orange = "#0072b2", "#d55e00"
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4), layout="constrained")
    accelerations = [(2 * math.pi * 5) ** 2 * 1e-3 * row["orbit_radius_mm"] / GRAVITY for row in ring_rows]
    for key, colour, label in (("bonds", blue, "bonds"), ("traps", orange, "wrong contacts")):
        left.plot(accelerations, [row[key] for row in ring_rows], "o" if key == "bonds" else "s", color=colour, label=label)
    left.set(title=f"{PARTS} sectors after {SECONDS} s", xlabel="acceleration of the table (g)", ylabel="number")
    left.legend(frameon=False)
    held = sorted(row["held_g"] for row in panel_rows)
    share = [(k + 0.5) / len(held) for k in range(len(held))]
    for count, style in zip(CHAINS, ("-", "--", ":")):
        right.plot([value / (count - 1) for value in held], share, style, color=blue, label=f"chain of {count}, held at one end")
    for value, name in ((6.5, "dimers"), (3.9, "trimers"), (3.0, "chains")):
        right.axvline(value, color=orange, lw=0.8)
        right.annotate(name, (value, 0.02), rotation=90, color=orange, ha="right")
    right.set(title="panels come apart", xlabel="acceleration (g)", ylabel="share of draws below", xscale="log", ylim=(0, 1))
    right.legend(frameon=False)
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def kept(rows, path):
    with open(path, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(rows[0])
        for row in rows:
            table.writerow(["" if value is None else f"{value:.5g}" for value in row.values()])


def main(program, out):
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        program = Program(program, folder)
        panel_rows = panels(program)
        ring_rows = rings(program)
    kept(ring_rows, out / "rings.csv")
    kept(panel_rows, out / "panels.csv")
    draw(ring_rows, panel_rows, out / "predictions.svg")
    plain = lambda value: f"{float(f'{value:.2g}'):g}"
    low_high = lambda values: "{1} ({0} to {2})".format(*map(plain, spread(values)))
    ring_lines = [[name, low_high([row[key] for row in ring_rows])] for name, key in (
        ("bonds of 16 sectors (16 close two rings)", "bonds"), ("wrong contacts", "traps"),
        ("share of sectors in closed rings", "in_rings"), ("sectors in the longest chain or ring", "longest"),
        ("pull that opens a bond (N)", "bond_pull_N"))]
    panel_lines = []
    for count in CHAINS:
        shaken = [row[f"shaken_{count}_g"] for row in panel_rows if row[f"shaken_{count}_g"]]
        of = f"{len(shaken)} of {SHAKEN}"
        simulated = f"{plain(min(shaken))} to {plain(max(shaken))} ({of})" if shaken else "not simulated"
        panel_lines.append([f"chain of {count}", low_high([row["held_g"] / (count - 1) for row in panel_rows]), simulated])
    matters = []
    for name, rows, ranges, of in (("panels: acceleration that opens a bond", panel_rows, PANELS, "held_g"),
                                   ("rings: bonds", ring_rows, RINGS, "bonds"),
                                   ("rings: wrong contacts", ring_rows, RINGS, "traps")):
        first = ranks(rows, ranges, of)[:3]
        matters.append([name, "; ".join(f"{named(key)} {value:+.2f}" for key, value in first)])
    assumed = [[which, named(name), f"{low:g} to {high:g}"] for which, ranges in (("rings", RINGS), ("panels", PANELS))
               for name, (low, high) in ranges.items()]
    tables = {
        "rings": markdown(["rings", "median (5 % to 95 % of the draws)"], ring_lines),
        "panels": markdown(["panels come apart at", "held at one end (g)", "shaken in a box, simulated (g)"], panel_lines),
        "matters": markdown(["result", "rank correlation with what is assumed, largest first"], matters),
        "assumed": markdown(["of", "assumed", "range"], assumed),
    }
    (out / "predictions.json").write_text(json.dumps(tables, indent=1) + "\n")
    for name, text in tables.items():
        print(f"## {name}\n\n{text}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]))
