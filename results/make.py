#!/usr/bin/env python3
"""Rebuilds the contents of this folder, part by part.

    results/make.py PART ...    these parts (or groups of them, or `all`), and the tables
    results/make.py tables      the tables alone
    results/make.py             what parts there are, how long they take and what they need

Builds `target/release/tilebind` (`--program FILE`: takes that) and runs it in a folder of its own,
prints every command, how long each part took and which files changed. Of a part that fails nothing
is replaced. The tables of README.md are written from the files of this folder, and the block of
../README.md that shows what the program prints from paper-tile/summary.txt. Figures in sentences
are written by hand.

Parts that time the program (growth, scale, bench) ask for a machine that does nothing else; all
other files but those of tile sets grown, which are drawn at random, are the same every time.
"""

import argparse
import csv
import hashlib
import json
import math
import os
import pathlib
import random
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from typing import Callable

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
PROGRAM = ROOT / "target/release/tilebind"
READMES = [HERE / "README.md", HERE / "validation/README.md", ROOT / "README.md"]

DESIGNS = sorted(it.stem for it in (ROOT / "shapes").glob("*.toml"))
# The files kept of an analysis. Not every design has every picture: a caged one does not dock.
TABLES = ["states.csv", "barriers.csv"]
PICTURES = ["map.png", "docking.png", "profiles.svg", "disconnectivity.svg"]

STUDY = ["triangle-teeth-10mm", "square-teeth-10mm", "sine-teeth-10mm", "tab-10mm", "arc-20mm"]
YIELDS = {"hexagon": 2, "paper-tile": 1, "alternating": 0.6, "tab-20mm": 0.2, "arc-20mm": 0.3}  # minutes
MAGNETS = [4, 6, 8, 10]
SHAPES = ["none", "shared", "polar"]
GAPS = [0.25, 0.5, 0.75]
CROWDS = ["one-face", "tab-20mm", "arc-20mm", "sine-teeth-20mm", "triangle-teeth-20mm"]


class Failed(Exception):
    """A command that failed, or a missing requirement."""


class Skipped(Exception):
    """A script that reports a missing requirement."""


class Work:
    """A folder for a part, with the designs beside it as commands name them."""

    def __init__(self, program, folder):
        self.program, self.folder = str(program), pathlib.Path(folder)
        (self.folder / "shapes").symlink_to(ROOT / "shapes")
        self.kept = {}

    def run(self, *command, cwd=None):
        """Standard output of a command; `tilebind` is the program."""
        print("  $", shlex.join(command), flush=True)
        command = [self.program if it == "tilebind" else it for it in command]
        # Scripts leave no files next to themselves.
        environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(command, cwd=cwd or self.folder, env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            raise Failed(f"exit status {done.returncode}: {done.stderr.strip()[-2000:]}")
        return done.stdout

    def json(self, *command):
        return json.loads(self.run(*command, "--json"))

    def script(self, name, *arguments):
        """Runs a script of the tests."""
        said = self.run(sys.executable, f"tests/{name}", *arguments, cwd=ROOT)
        if "skipped" in said:
            raise Skipped(said.strip())

    def keep(self, name, content):
        """Replaces a file of this folder when the part is done: by another file, text or none."""
        if isinstance(content, pathlib.Path):
            if not content.exists():
                raise Failed(f"{content.relative_to(self.folder)}, to be kept as {name}, was not written")
            content = content.read_bytes()
        self.kept[name] = content.encode() if isinstance(content, str) else content

    def keep_rows(self, name, rows):
        self.keep(name, "".join(",".join("" if it is None else str(it) for it in row) + "\n" for row in rows))

    def keep_row(self, name, columns, row, order):
        """Replaces the row of a table with the same first value."""
        old = table(name) if (HERE / name).exists() else []
        rows = {it[columns[0]]: [it.get(column, "") for column in columns] for it in old}
        rows[row[0]] = row
        self.keep_rows(name, [columns, *(rows[it] for it in order if it in rows)])

    def finish(self):
        for name, content in self.kept.items():
            if content is None:
                (HERE / name).unlink(missing_ok=True)
            else:
                (HERE / name).parent.mkdir(exist_ok=True)
                (HERE / name).write_bytes(content)


@dataclass
class Part:
    name: str
    group: str
    minutes: float  # about, on two cores
    files: list[str]
    make: Callable[[Work], None]
    needs: str = ""


def table(name):
    """Rows of a table of this folder."""
    return list(csv.DictReader((HERE / name).read_text().splitlines()))


# The shipped designs

DESIGN_COLUMNS = ["design", "bond_J", "captured", "trap_kinds", "trap_J", "trap_escape_J", "unbinding_J",
                  "unbinding_lower_J", "unbinding_upper_J", "caged", "list", "open_share"]


def analyse(name):
    def make(work):
        out = f"target/{name}"
        work.keep(f"{name}/summary.txt", work.run("tilebind", "analyse", f"shapes/{name}.toml", "--out", out))
        out = work.folder / out
        for file in TABLES:
            work.keep(f"{name}/{file}", out / file)
        for file in pictures(name):
            path = out / "pictures" / file
            work.keep(f"{name}/{file}", path.read_bytes() if path.exists() else None)
        row = design_row(name, json.loads((out / "report.json").read_text()))
        work.keep_row("designs.csv", DESIGN_COLUMNS, row, DESIGNS)
        work.keep_row("verified.csv", VERIFIED_COLUMNS, verified(work, name), DESIGNS)

    return make


# What `tilebind verify` counts together.
VERIFIED = {
    "states": ["energies of states", "energies as blocks"],
    "clearances": ["clearances"],
    "pathway_points": ["energies on pathways"],
    "upper_bounds": ["upper bounds"],
    "lower_bounds": ["lower bounds"],
    "others": ["ends of pathways", "saddles", "heights of barriers", "lengths and work", "captures", "lists of states"],
}
VERIFIED_COLUMNS = ["design", *VERIFIED, "undecided", "contradicted"]


def verified(work, name):
    """What the second reader confirms of the results of a design. A contradiction is a failure."""
    checks = {it["check"]: it for it in work.json("tilebind", "verify", f"target/{name}")["checks"]}
    counts = [sum(checks[it]["confirmed"] for it in those) for those in VERIFIED.values()]
    of = [sum(it[key] for it in checks.values()) for key in ("undecided", "contradicted")]
    return [name, *counts, *of]


def pictures(name):
    return PICTURES + (["models.svg"] if name == "paper-tile" else [])


def design_row(name, report):
    states, bond = report["states"], report["bound"]
    bonds = [it for it in states if bond["state"] is not None and it["class"] == states[bond["state"]]["class"]]
    traps = [it for it in states if it["kind"] != "bound"]
    deepest = min(traps, key=lambda it: it["energy_J"], default=None)
    escape = deepest and deepest["escape"]
    out = next((it for it in report["barriers"] if it["from"] == bond["state"] and it["to"] == "free"), None)
    found = report["inventory"]
    known = "sampled" if found["unproved"] else "proved" if found["complete"] else "open"
    bounds = [None, None]
    if out and out["lower_J"] is not None:
        bounds = [out[it] - states[bond["state"]]["energy_J"] for it in ("lower_J", "upper_J")]
    return [name, bond["energy_J"], sum(it["capture"]["share"] for it in bonds), len({it["class"] for it in traps}),
            deepest and deepest["energy_J"], escape and escape["forward_J"], out and out["forward_J"], *bounds,
            bool(out and out["caged"]), known, found["share"]]


# The study of shapes

def study(model, depths):
    def make(work):
        designs = [f"shapes/{name}.toml" for name in STUDY]
        varied = [f"--vary=potential.model={model}"] if model != "dipole" else []
        work.run("tilebind", "sweep", *designs, "--vary=magnet.inset=0.003", *varied,
                 f"--vary=fixed.faces.east.profile.depth=0:0.05:{depths}", "--dynamics=200", "--out", "target/study")
        out = work.folder / "target/study"
        work.keep(f"study/{model}.csv", out / "sweep.csv")
        if model == "dipole":
            work.keep("study/dipole.png", out / "pictures/curves-3-mm.png")

    return make


# Searches

DEPTH, WIDTH = (f"fixed.faces.east.profile.{key}" for key in ("depth", "width"))
AIMS = {"selectivity": "captured > 0.4", "captured": "selectivity > 3"}
SEARCH = ["--milestones=300", "--far-starts=100", "--certify-cells=0", "--complete-cells=0", "--threads=1"]


def figure(one, key):
    """A figure of an assessed point; without a trap selectivity is infinite."""
    found = one[key]["value"] if isinstance(one[key], dict) else one[key]
    return math.inf if key == "selectivity" and found is None else found


def best_of(points, by, condition):
    """The best figure of the assessed points that satisfy a condition; 0 if none does."""
    key, least = condition.split(" > ")
    known = [it["quantities"] for it in points if it.get("quantities") and it["quantities"]["bond_depth_J"]]
    fit = [it for it in known if figure(it, "captured") > 0 and figure(it, key) > float(least)]
    return max((figure(it, by) for it in fit), default=0)


def by_chance(points, count, by, condition):
    """The median of the best of as many points of a grid, drawn a thousand and one times."""
    chance = random.Random(1)
    return sorted(best_of(chance.sample(points, count), by, condition) for _ in range(1001))[500]


SEEDS = range(1, 11)
SHAPES = ["triangle-teeth-10mm", "square-teeth-10mm", "sine-teeth-10mm", "tab-10mm", "arc-20mm"]


def sought(work, given, aim, condition, points, out):
    """The best of each of ten searches, with the seeds 1 to 10."""
    for seed in SEEDS:
        work.run("tilebind", "sweep", *given, f"--maximise={aim}", f"--subject={condition}", f"--points={points}",
                 f"--seed={seed}", "--out", f"{out}-{seed}", "--quiet")
        yield json.loads((work.folder / f"{out}-{seed}/report.json").read_text())["best"]


def grid_of(work, given, out):
    """The assessed points of a grid."""
    work.run("tilebind", "sweep", *given, "--out", out, "--quiet")
    points = json.loads((work.folder / out / "report.json").read_text())["points"]
    return [it for it in points if it["status"] == "done"]


def spread_of(values):
    """The median of figures, their least and their largest."""
    values = list(values)
    return [f"{it:.4g}" for it in (statistics.median(values), min(values), max(values))]


def shapes_searched(work):
    """A grid over depth and width of five shapes, against ten searches with a tenth of the analyses, and chance."""
    rows = [["aim", "condition", "grid_analyses", "grid_best", "chance_median", "search_analyses", "search_median",
             "search_least", "search_largest", "best"]]
    given = [*(f"shapes/{shape}.toml" for shape in SHAPES), "--vary=magnet.inset=0.003", *SEARCH]
    grid = grid_of(work, [*given, f"--vary={DEPTH}=0.005:0.05:11", f"--vary={WIDTH}=0.1:0.4:11"], "target/grid-width")
    ranges = [f"--vary={DEPTH}=0.005:0.05", f"--vary={WIDTH}=0.1:0.4"]
    for aim, condition in AIMS.items():
        found = list(sought(work, [*given, *ranges], aim, condition, 60, f"target/search-width-{aim}"))
        best = max(found, key=lambda it: figure(it["figures"], aim))
        values = [f"{name.rsplit('.', 1)[1]} {1e3 * value:.4g} mm" for name, value in best["values"].items()][1:]
        known = best_of(grid, aim, condition), by_chance(grid, 60, aim, condition)
        rows.append([aim, condition, len(grid), *(f"{it:.4g}" for it in known), 60,
                     *spread_of(figure(it["figures"], aim) for it in found), "; ".join([best["design"], *values])])
    work.keep("search/history.png", work.folder / "target/search-width-captured-1/pictures/history.png")
    work.keep_rows("search/shapes.csv", rows)


DISCS = """name = "discs-60mm"
table = { size = [0.4, 0.4] }
magnet = { shape = "disc", diameter = 0.006, height = 0.003, remanence = 1.2, pitch = 0.012, inset = 0.0 }
target = { fixed = "east", moving = "west" }
fixed = { side = 0.06, thickness = 0.008, mass = 0.02, faces = { east = { code = "NNNS" } } }
moving = { side = 0.06, thickness = 0.008, mass = 0.02, faces = { west = { mates = "east" } } }
"""


def discs_searched(work):
    """The pitch and inset of discs with the best selectivity of bonds that are so deep: a grid, chance, ten searches."""
    (work.folder / "discs.toml").write_text(DISCS)
    rows = [["least_bond_J", "grid_analyses", "grid_best", "chance_median", "search_analyses", "search_median",
             "search_least", "search_largest", "pitch_m", "inset_m", "bond_J", "end"]]
    given = ["discs.toml", "--milestones=200", "--far-starts=30", *SEARCH[2:]]
    grid = grid_of(work, [*given, "--vary=magnet.pitch=0.007:0.016:11", "--vary=magnet.inset=0:0.003:11"],
                   "target/grid-discs")
    ranges = ["--vary=magnet.pitch=0.007:0.016", "--vary=magnet.inset=0:0.003"]
    for least in (0.02, 0.03):
        condition = f"bond_depth_J > {least}"
        # Chance also knows, by energies alone, which bonds are deep enough.
        deep = [it for it in grid if best_of([it], "bond_depth_J", condition)]
        found = list(sought(work, [*given, *ranges], "selectivity", f"bond_depth >= {least}", 16,
                            f"target/discs-{least}"))
        best = max(found, key=lambda it: figure(it["figures"], "selectivity"))
        ends = [it["key"].rsplit(".", 1)[1] for it in best["sensitivity"] if it["at_lower_end"] or it["at_upper_end"]]
        known = best_of(deep, "selectivity", condition), by_chance(deep, min(16, len(deep)), "selectivity", condition)
        rows.append([least, len(grid), *(f"{it:.4g}" for it in known), 16,
                     *spread_of(figure(it["figures"], "selectivity") for it in found), *best["values"].values(),
                     f"{best['figures']['bond_depth_J']['value']:.4g}", " ".join(ends)])
    work.keep_rows("search/discs.csv", rows)


# Magnets as blocks, over the gap

def magnets(work):
    tile, row = ((ROOT / f"shapes/{name}.toml").read_text() for name in ("paper-tile", "halbach"))

    def changed(text, pattern, by):
        text, count = re.subn(pattern, by, text)
        if count == 0:
            raise Failed(f"no {pattern} in the design")
        return text

    def sized(along, across):
        return changed(tile, r"size = \[0\.010, 0\.010, 0\.003\]", f"size = [{along}, {across}, 0.003]")

    def straight(poles):
        poles = iter(poles)
        return changed(row, r'pole = "[NS]", axis = [-\d.]+', lambda _: f'pole = "{next(poles)}", axis = 0.0')

    designs = {
        "paper tile, 10 x 10 x 3 mm": tile,
        "the same volume, 5 x 20 x 3 mm (wide pole face, magnetised through 5 mm)": sized(0.005, 0.020),
        "the same volume, 20 x 5 x 3 mm (long axis)": sized(0.020, 0.005),
        "Halbach row (`shapes/halbach.toml`), one face": row,
        "the same six magnets, N S N S N S": straight("NSNSNS"),
        "the same six magnets, all N": straight("NNNNNN"),
    }
    gaps = [0.0, 0.001, 0.005, 0.02, 0.05]
    rows = [["magnets", *(f"energy_J_at_{gap:g}_m" for gap in gaps)]]
    for name, text in designs.items():
        (work.folder / "magnets.toml").write_text(text)
        poses = [f"--pose={0.43 + gap:g},0,0" for gap in gaps]
        found = json.loads(work.run("tilebind", "energy", "magnets.toml", "--model", "cuboid", *poses))
        rows.append([f'"{name}"', *(it["energy_J"] for it in found)])
    work.keep_rows("magnets.csv", rows)


# Words

def words(work, *options):
    return work.json("tilebind", "words", *options, "--seconds", "20")


def rounded(value, digits, unit=1):
    return None if value is None else f"{unit * value:.{digits}g}"


def uniform(work):
    rows = [["magnets", "places", "pitch_m", "shape", "gap", "words", "at_most", "proved", "bond_J", "gap_reached",
             "words_beyond_tie", "gap_beyond_tie"]]
    for k in MAGNETS:
        for shape in SHAPES:
            for gap in GAPS:
                found = words(work, "--length", f"{k}", "--gap", f"{gap}", "--shape", shape)
                beyond = found["beyond_tie"] or {"count": None, "gap": None}
                rows.append([k, k, 0.04, shape, gap, found["count"], found["upper_bound"], found["proved"],
                             found["bond_J"], found["gap"], beyond["count"], beyond["gap"]])
    work.keep_rows("words/uniform.csv", rows)


def spaced(work):
    rows = [["places", "pitch_mm", "magnets", "gap", "words", "at_most", "proved", "gap_reached", "bond_mJ"]]
    for k in MAGNETS:
        for gap in GAPS:
            found = words(work, "--slots", "28", "--magnets", f"{k}", "--pitch", "0.015", "--gap", f"{gap}")
            rows.append([28, 15, k, gap, found["count"], found["upper_bound"], found["proved"],
                         rounded(found["gap"], 4), rounded(found["bond_J"], 5, 1e3)])
    work.keep_rows("words/spaced.csv", rows)


def mismatches(work):
    rows = [["magnets", "gap", "mismatches", "words", "at_most", "proved"]]
    for k in MAGNETS:
        for gap in GAPS:
            contacts = int((1 - gap) * k)
            aligned = -(-(k - contacts) // 2)
            least = f"{aligned},{aligned},{k - contacts}"
            found = words(work, "--length", f"{k}", "--gap", "0", "--min-mismatch", least)
            rows.append([k, gap, f'"{least}"', found["count"], found["upper_bound"], found["proved"]])
    work.keep_rows("words/mismatches.csv", rows)


# Magnets (m; along their axis, along the face, through the thickness) of the same remanence.
ELONGATED = {"the paper's": [0.01, 0.01, 0.003], "twice as long": [0.02, 0.01, 0.003],
             "four times as long": [0.04, 0.01, 0.003], "half as wide": [0.01, 0.005, 0.003]}
# The iron of shapes/shielded-backs.toml.
IRON = "[shield]\nattenuation = 0.8\nlength = 0.03\nwidth = 0.3\nfront_gain = 1.1\n\n"


def carrier(size, pitch, codes=("NNNS", "NSSS"), shield=""):
    """Two squares of 43 cm whose east and west faces meet, with blocks."""
    tiles = "".join(f'[{tile}]\nside = 0.43\nthickness = 0.013\nmass = 0.1\n[{tile}.faces]\n{face} = {{ code = "{code}" }}\n'
                    for tile, face, code in zip(("fixed", "moving"), ("east", "west"), codes))
    return (f'name = "carrier"\n[table]\nsize = [2, 2]\n[magnet]\nsize = {size}\nremanence = 1.2\npitch = {pitch}\n'
            f'{shield}{tiles}[target]\nfixed = "east"\nmoving = "west"\n[potential]\nmodel = "cuboid"\n')


def elongated(work):
    """The number of words of eight magnets; and the gap of five of them, also with iron behind every face, which
    `words` does not search: energies of every two faces at every slide."""
    design = work.folder / "carrier.toml"

    def energies(size, pitch, codes, shield):
        design.write_text(carrier(size, pitch, codes, shield))
        slides = range(-7, 8)
        poses = [it for k in slides for it in ("--pose", f"0.43,{k * pitch!r},0")]
        return {k: it["energy_J"] for k, it in zip(slides, json.loads(work.run("tilebind", "energy", design.name, *poses)))}

    def gap(size, pitch, codes, shield):
        mate = {it: it[::-1].translate(str.maketrans("NS", "SN")) for it in codes}
        faces = [*codes, *mate.values()]
        bonds, wrong = [], []
        for i, first in enumerate(faces):
            for second in faces[i:]:
                for slide, energy in energies(size, pitch, (first, second), shield).items():
                    is_bond = slide == 0 and mate.get(first) == second
                    (bonds if is_bond else wrong).append(-energy)
        return 1 - max(*wrong, 0) / min(bonds)

    rows = [["magnets", "pitch_m", "words_gap_0.5", "words_gap_0.45", "proved", "gap_of_5", "gap_of_5_with_iron"]]
    for name, size in ELONGATED.items():
        for pitch in (0.04, 0.02):
            design.write_text(carrier(size, pitch))
            found = [words(work, design.name, "--length", "8", *option)
                     for option in (["--gap", "0.5"], ["--gap", "0.45"], ["--count", "5"])]
            five = found[2]["words"]
            plain, shielded = (gap(size, pitch, five, it) for it in ("", IRON))
            if abs(plain - found[2]["gap"]) > 1e-6:
                raise Failed(f"the gap of {five} is {plain} by `energy` and {found[2]['gap']} by `words`")
            rows.append([name, pitch, found[0]["count"], found[1]["count"], all(it["proved"] for it in found),
                         rounded(plain, 4), rounded(shielded, 4)])
    work.keep_rows("words/elongated.csv", rows)


# Tile sets

def assembly(part):
    """A part of the study of tile sets, computed from the start; it reads the tables of other parts."""
    def make(work):
        out = work.folder / "assembly"
        shutil.copytree(HERE / "assembly", out)
        files = [it.removeprefix("assembly/") for it in ASSEMBLY[part]]
        for file in files:
            (out / file).unlink(missing_ok=True)
        work.script("assembly/study.py", work.program, str(out), part)
        for file in files:
            work.keep(f"assembly/{file}", out / file)

    return make


def assembly_table(name):
    def make(work):
        work.script(f"assembly/{name}.py", work.program, str(work.folder / "table.csv"))
        work.keep(f"assembly/{name}.csv", work.folder / "table.csv")

    return make


ASSEMBLY = {
    **{name: [f"assembly/{name}.csv"] for name in ("builds", "smallest", "shaking", "blocks", "proofreading")},
    "pictures": [f"assembly/{name}.png" for name in ("grown", "shaking", "proofreading")],
}


# Motion

SHARE_COLUMNS = ["kT_J", "bound", "low", "high", "trapped"]


def shaken(name):
    def make(work):
        out = work.folder / "target/yield"
        work.run("tilebind", "yield", f"shapes/{name}.toml", "--tiles", "20", "--time", "600",
                 "--kt", "1e-3,2e-3,3e-3,4e-3,6e-3", "--runs", "2000", "--duration", "8", "--drag", "0.5",
                 "--simulations", "500", "--out", "target/yield")
        work.keep(f"yield/{name}.csv", out / "yield.csv")
        if name == "paper-tile":
            work.keep(f"yield/{name}.svg", out / "pictures/shaking.svg")
        report = json.loads((out / "report.json").read_text())
        rows = [[it["kT_J"], it["yield"], *(it["yield_interval"] or [None, None]), it["trapped"]] for it in report["settings"]]
        work.keep_rows(f"yield/{name}-bound.csv", [SHARE_COLUMNS, *rows])

    return make


def rates(work):
    columns = ["kT_J", "exit_times_D_m2", "error", "bound_first"]
    rows = [columns]
    for kt in ("3.037e-3", "1.9e-3", "0.76e-3"):
        found = work.json("tilebind", "rates", "shapes/paper-tile.toml", "--kt", kt, "--start", "0.43,-0.04,0",
                          "--basin-energy", "-0.03", "--free-at", "0.75")
        time = found["mean_exit_s"] * found["diffusion_m2_s"]
        rows.append([float(kt), f"{time:.6g}", f"{found['mean_exit_error']:.3g}", f"{found['exits']['bound']:.6g}"])
    work.keep_rows("rates.csv", rows)


def docking(work):
    work.run("tilebind", "dock", "shapes/paper-tile.toml", "--runs", "12000", "--out", "target/dock")
    out = work.folder / "target/dock"
    report = json.loads((out / "report.json").read_text())
    del report["timing"]
    work.keep("paper-tile-docking/report.json", json.dumps(report, indent=2) + "\n")
    work.keep("paper-tile-docking/map.csv", out / "map.csv")
    work.keep("paper-tile-docking/chances.svg", out / "pictures/chances.svg")


# Published measurements

VALIDATION = ["sets.csv", "points.csv", "forces.svg", "tables.json"]
MEASURED = sorted(f"validation/measured/{it.name}" for it in (HERE / "validation/measured").glob("*.csv"))


def validation(work):
    out = work.folder / "validation"
    work.run(sys.executable, str(HERE / "validation.py"), work.program, str(out))
    for name in VALIDATION:
        work.keep(f"validation/{name}", out / name)


PREDICTIONS = ["rings.csv", "panels.csv", "predictions.svg", "predictions.json"]


def predictions(work):
    out = work.folder / "validation"
    work.run(sys.executable, str(HERE / "predictions.py"), work.program, str(out))
    for name in PREDICTIONS:
        work.keep(f"validation/{name}", out / name)


def validation_table(name, file="tables"):
    return lambda: json.loads((HERE / f"validation/{file}.json").read_text())[name]


# Many tiles on a table

CROWD_COLUMNS = ["drive", "coverage", "contact", "bonds", "bonds_low", "bonds_high", "traps", "traps_low", "traps_high",
                 "kinetic_kT"]
SHAKEN = ["--shaking", "3e-3"]
DRIVES = {
    "3 mJ": SHAKEN,
    "6 mJ": ["--shaking", "6e-3"],
    "orbital": ["--orbital", "0.1,0.5"],
    "3 mJ and fan": [*SHAKEN, "--fan=0,0,0.02,0.8,1,0.2"],
}
CONTACTS = {"paper": (0.01, 0.3), "rubber": (0.5, 0.9), "wood": (0.5, 0.4), "steel": (0.7, 0.2)}  # restitution, friction
CROWD_SETTINGS = [*((drive, 0.3, "paper") for drive in DRIVES),
                  *(("3 mJ", coverage, "paper") for coverage in (0.15, 0.5)),
                  *(("3 mJ", 0.3, contact) for contact in list(CONTACTS)[1:])]


def crowd(name):
    """12 tiles of either kind, with magnets 3 mm behind the surface, on tables that they cover by different shares."""
    def make(work):
        rows = [CROWD_COLUMNS]
        for drive, coverage, contact in CROWD_SETTINGS:
            side = math.sqrt(24 * 0.43**2 / coverage)
            text = (ROOT / f"shapes/{name}.toml").read_text()
            text = re.sub(r"(?m)^inset = .*$", "inset = 0.003", text)
            design = work.folder / f"{name}.toml"
            design.write_text(text.replace("size = [2.0, 2.0]", f"size = [{side:.3f}, {side:.3f}]"))
            restitution, friction = CONTACTS[contact]
            work.run("tilebind", "table", design.name, "--count", "12,12", "--time", "240", "--runs", "8", *DRIVES[drive],
                     "--drag", "0.5", "--restitution", f"{restitution}", "--friction", f"{friction}", "--out", "table",
                     cwd=work.folder)
            report = json.loads((work.folder / "table/report.json").read_text())
            ends = (report[it][end] for it in ("bonds", "traps") for end in ("mean", "low", "high"))
            rows.append([drive, coverage, contact, *ends, report["kinetic_kT"]])
        work.keep_rows(f"table/{name}.csv", rows)

    return make


# Times

def growth(work):
    path = work.folder / "growth.csv"
    work.script("growth/growth.py", work.program, str(path), "--limit", "150")
    blocks = work.folder / "growth-blocks.csv"
    work.script("growth/growth.py", work.program, str(blocks), "--limit", "1000", "--model", "cuboid", "--only", "magnets")
    for kept in (path, blocks):
        work.keep(kept.name, kept)
        work.keep(f"{kept.stem}.svg", kept.with_suffix(".svg"))


def scale(work):
    bench = ["cargo", "bench", "--quiet", "--bench", "roadmap", "--"]
    usual = work.run(*bench, "--scale", "1e4,3e4,1e5,3e5,1e6", cwd=ROOT)
    few = work.run(*bench, "--scale", "1e4,1e5,1e6,1e7", "--neighbours", "12", cwd=ROOT)
    path = work.folder / "scale.csv"
    path.write_text(usual + few.split("\n", 1)[1])
    work.run(*bench, "--draw", str(path), cwd=ROOT)
    work.keep("scale.csv", path)
    work.keep("scale.svg", path.with_suffix(".svg"))


def bench(work):
    """Adds a row to the history."""
    path = work.folder / "bench.csv"
    shutil.copy(HERE / "bench.csv", path)
    work.script("bench/history.py", str(path))
    work.keep("bench.csv", path)


GROWN = "rgrow, NumPy and Matplotlib, in this Python or to be installed from PyPI"

PARTS = [
    *(Part(name, "designs", 1.2 if name.startswith("square") else 0.05,
           [f"{name}/{file}" for file in ["summary.txt", *TABLES, *pictures(name)]] + ["designs.csv", "verified.csv"], analyse(name))
      for name in DESIGNS),
    Part("study-dipole", "study", 3.5, ["study/dipole.csv", "study/dipole.png"], study("dipole", 11)),
    Part("study-cuboid", "study", 1.3, ["study/cuboid.csv"], study("cuboid", 6)),
    Part("search-shapes", "search", 30, ["search/shapes.csv", "search/history.png"], shapes_searched),
    Part("search-discs", "search", 15, ["search/discs.csv"], discs_searched),
    Part("magnets", "magnets", 0.02, ["magnets.csv"], magnets),
    Part("words-uniform", "words", 1.4, ["words/uniform.csv"], uniform),
    Part("words-spaced", "words", 4, ["words/spaced.csv"], spaced),
    Part("words-mismatches", "words", 0.25, ["words/mismatches.csv"], mismatches),
    Part("words-elongated", "words", 1, ["words/elongated.csv"], elongated),
    *(Part(f"yield-{name}", "yield", minutes,
           [f"yield/{name}.csv", f"yield/{name}-bound.csv"] + (["yield/paper-tile.svg"] if name == "paper-tile" else []),
           shaken(name)) for name, minutes in YIELDS.items()),
    Part("rates", "rates", 0.2, ["rates.csv"], rates),
    Part("docking", "docking", 0.3,
         [f"paper-tile-docking/{file}" for file in ("report.json", "map.csv", "chances.svg")], docking),
    Part("validation", "validation", 0.2, [f"validation/{name}" for name in VALIDATION], validation,
         "NumPy, SciPy and Matplotlib"),
    Part("predictions", "validation", 15, [f"validation/{name}" for name in PREDICTIONS], predictions,
         "NumPy, SciPy and Matplotlib"),
    Part("assembly-lattice", "assembly", 2, ["assembly/lattice.csv"], assembly_table("lattice")),
    Part("assembly-repulsion", "grown", 10, ["assembly/repulsion.csv"], assembly_table("repulsion"),
         f"{GROWN}; git, cc and libX11's headers for xgrow"),
    *(Part(f"assembly-{part}", "grown", 60, files, assembly(part), GROWN) for part, files in ASSEMBLY.items()),
    *(Part(f"table-{name}", "table", 15, [f"table/{name}.csv"], crowd(name)) for name in CROWDS),
    Part("growth", "times", 30, ["growth.csv", "growth.svg", "growth-blocks.csv", "growth-blocks.svg"], growth),
    Part("scale", "times", 8, ["scale.csv", "scale.svg"], scale, "6 GB of memory"),
    Part("bench", "times", 5, ["bench.csv"], bench),
]
OWN = ["README.md", "make.py", "figure6.py", "validation.py", "predictions.py", "validation/README.md", *MEASURED]


# Tables of the READMEs, each made only from files of this folder.

def markdown(head, rows):
    lines = ["| " + " | ".join(map(str, row)) + " |\n" for row in (head, *rows)]
    return "".join([lines[0], "|" + "---|" * len(head) + "\n", *lines[1:]])


def milli(value):
    return f"{1e3 * float(value):.4g}" if value else "-"


def designs_table():
    def row(it):
        out = milli(it["unbinding_J"])
        if it["unbinding_lower_J"]:
            out += f" in [{milli(it['unbinding_lower_J'])}, {milli(it['unbinding_upper_J'])}]"
        known = it["list"] if it["list"] != "open" else f"{float(it['open_share']):.1g} of the space open"
        return [f"`{it['design']}`", milli(it["bond_J"]), f"{100 * float(it['captured']):.0f} %", it["trap_kinds"],
                milli(it["trap_J"]), milli(it["trap_escape_J"]), "caged" if it["caged"] == "True" else out, known]

    head = ["design", "bond", "captured", "kinds of trap", "deepest trap", "its escape", "out of the bond", "list of states"]
    return markdown(head, [row(it) for it in table("designs.csv")])


def search_shapes_table():
    def shown(it, of):
        value = float(it[of])
        return "no trap" if math.isinf(value) else f"{100 * value:.0f} %" if it["aim"] == "captured" else f"{value:.4g}"

    rows = [[f"{it['aim']}, {it['condition']}", f"{shown(it, 'grid_best')} ({it['grid_analyses']})",
             shown(it, "chance_median"), f"{shown(it, 'search_median')} ({shown(it, 'search_least')} to "
             f"{shown(it, 'search_largest')})", it["best"]] for it in table("search/shapes.csv")]
    return markdown(["largest", "grid (analyses)", "60 by chance", "60 by a search", "the best of all searches"], rows)


def search_discs_table():
    rows = [[f"{milli(it['least_bond_J'])} mJ", f"{it['grid_best']} ({it['grid_analyses']})", it["chance_median"],
             f"{it['search_median']} ({it['search_least']} to {it['search_largest']})", f"{milli(it['pitch_m'])} mm",
             f"{milli(it['inset_m'])} mm", f"{milli(it['bond_J'])} mJ", it["end"] or "-"]
            for it in table("search/discs.csv")]
    return markdown(["bond at least", "grid (analyses)", "16 by chance", "16 by a search", "pitch", "inset", "bond",
                     "at the end of its range"], rows)


def verified_table():
    found = table("verified.csv")
    rows = [[f"`{it['design']}`", *list(it.values())[1:]] for it in found]
    sums = [sum(int(it[key]) for it in found) for key in VERIFIED_COLUMNS[1:]]
    head = ["design", "energies of states", "clearances", "points of pathways", "upper bounds", "lower bounds", "others",
            "undecided", "contradicted"]
    return markdown(head, [*rows, ["all", *sums]])


def magnets_table():
    rows = [[it.pop("magnets"), *(milli(value) for value in it.values())] for it in table("magnets.csv")]
    return markdown(["magnets", "in contact", "1 mm", "5 mm", "20 mm", "50 mm"], rows)


def word_cell(it):
    """The number of words, with its upper bound if not proved, and the number beyond the tie."""
    words = it["words"] if it["proved"] == "True" else f"{it['words']} to {it['at_most']}"
    beyond = it["words_beyond_tie"]
    return f"{words} ({beyond})" if beyond and int(beyond) > int(it["words"]) else words


def uniform_table():
    cells = {(it["magnets"], it["shape"], it["gap"]): word_cell(it) for it in table("words/uniform.csv")}
    rows = [[k, shape, *(cells[f"{k}", shape, f"{gap}"] for gap in GAPS)] for k in MAGNETS for shape in SHAPES]
    return markdown(["magnets", "shape", *(f"gap {gap}" for gap in GAPS)], rows)


def spaced_table():
    cells = {(it["magnets"], it["gap"]): it["words"] for it in table("words/spaced.csv")}
    rows = [[k, *(cells[f"{k}", f"{gap}"] for gap in GAPS)] for k in MAGNETS]
    return markdown(["magnets", *(f"gap {gap}" for gap in GAPS)], rows)


def mismatches_table():
    energies = {(it["magnets"], it["gap"]): word_cell(it) for it in table("words/uniform.csv") if it["shape"] == "none"}
    rows = []
    for it in table("words/mismatches.csv"):
        words = it["words"] if it["proved"] == "True" else f"{it['words']} to {it['at_most']}"
        rows.append([it["magnets"], it["gap"], it["mismatches"], words, energies[it["magnets"], it["gap"]]])
    return markdown(["magnets", "gap", "`--min-mismatch`", "words", "by energies"], rows)


def elongated_table():
    rows = [[it["magnets"], f"{1e3 * float(it['pitch_m']):.0f} mm", it["words_gap_0.5"], it["words_gap_0.45"], it["gap_of_5"],
             it["gap_of_5_with_iron"]] for it in table("words/elongated.csv")]
    return markdown(["magnets", "pitch", "words, gap 0.5", "words, gap 0.45", "widest gap of 5 words", "of these with iron"], rows)


def builds_table():
    rows = {}
    for it in table("assembly/builds.csv"):
        gap = f"{float(it['gap']):.3g}" + ("!" if it["wider_gap"] == "none wider, proved" else "")
        cell = {"found": gap, "none, proved": "no", "open": "?"}[it["words"]]
        rows.setdefault((f"{it['set']} ({it['words_needed']})", it["shape"]), []).append(cell)
    head = [f"{k} {how}" for how in ("even", "spaced") for k in (4, 8, 16)]
    return markdown(["set (words)", "shape", *head], [[*key, *cells] for key, cells in rows.items()])


def blocks_table():
    cells = {}
    for it in table("assembly/blocks.csv"):
        errors, spread, speed = (float(it[name]) for name in ("errors_a_block", "standard_error", "blocks_a_docking_time"))
        digits = max(0, -math.floor(math.log10(spread))) if errors else 0
        told = f"{errors:.{digits}f} ± {spread:.{digits}f}" if errors else "0"
        cells[it["Gse"], it["wrong_strength"], it["block"]] = f"{told} at {speed:.2g}"
    rows = [[f"{float(gse):g}", f"{float(wrong):g}", *(cells[gse, wrong, k] for k in "123")]
            for gse in ("8.0", "10.0", "13.0") for wrong in ("0.0", "0.25", "0.5")]
    return markdown(["Gse", "wrong contacts bind", "single tiles", "2 x 2", "3 x 3"], rows)


def share(value):
    value = 100 * float(value)
    return f"{value:.0f}" if value >= 1 else f"{value:.2f}".rstrip("0").rstrip(".")


def yields_table():
    rows, settings = [], []
    for name in YIELDS:
        found = table(f"yield/{name}-bound.csv")
        settings = [f"{milli(it['kT_J'])} mJ" for it in found]
        cells = []
        for it in found:
            if not it["bound"]:
                cells.append("-")
                continue
            cell = f"{share(it['bound'])} %"
            if it["low"] and share(it["low"]) != share(it["high"]):
                cell += f" ({share(it['low'])}-{share(it['high'])})"
            if float(it["trapped"]) >= 0.1:
                cell += f", {share(it['trapped'])} % trapped"
            cells.append(cell)
        rows.append([f"`{name}`", *cells])
    return markdown(["design", *settings], rows)


def rates_table():
    rows = []
    for it in table("rates.csv"):
        rows.append([f"{milli(it['kT_J'])} mJ", f"{float(it['exit_times_D_m2']):.4g} m²", f"{100 * float(it['error']):.1f} %",
                     f"{100 * float(it['bound_first']):.1f} %"])
    return markdown(["kT", "mean exit time times D", "estimated error", "bound first"], rows)


def crowds_table():
    """Bonds and, after the stroke, traps; each with half its interval."""
    def cell(it):
        return " / ".join(f"{float(it[of]):.1f} ± {float(it[f'{of}_high']) - float(it[of]):.1f}" for of in ("bonds", "traps"))

    found = {name: table(f"table/{name}.csv") for name in CROWDS}
    rows = []
    for k, (drive, coverage, contact) in enumerate(CROWD_SETTINGS):
        rows.append([f"{drive}, {coverage}, {contact}", *(cell(found[name][k]) for name in CROWDS)])
    return markdown(["drive, coverage, contact", *(f"`{name}`" for name in CROWDS)], rows)


def growth_table():
    """Seconds and, in brackets, as a multiple of the family's first."""
    sizes = [2**power for power in range(9)]
    rows = {}
    for name, model in (("growth", ""), ("growth-blocks", ", blocks")):
        for it in table(f"{name}.csv"):
            rows.setdefault((it["family"] + model, it["asked"]), {})[int(it["size"])] = it["processor_s"]

    def cells(family, asked):
        found, first = rows[family, asked], next(iter(rows[family, "usual"].values()))
        for size in sizes:
            seconds = found.get(size)
            yield "" if seconds is None else f"{float(seconds):.3g} ({float(seconds) / float(first):.2g})" if seconds else "-"

    named = {"usual": "", "less": ", reduced effort"}
    return markdown(["", *sizes], [[family.replace(" a ", " per ") + named[asked], *cells(family, asked)] for family, asked in rows])


def screen():
    return "```text\n" + (HERE / "paper-tile/summary.txt").read_text() + "```\n"


SHOWN = {"designs": designs_table, "search-shapes": search_shapes_table, "search-discs": search_discs_table,
         "verified": verified_table,
         "magnets": magnets_table, "words-uniform": uniform_table, "words-spaced": spaced_table,
         "words-mismatches": mismatches_table, "words-elongated": elongated_table,
         "assembly-builds": builds_table, "assembly-blocks": blocks_table,
         "yield": yields_table, "rates": rates_table, "table": crowds_table, "growth": growth_table, "paper-tile": screen,
         **{f"validation-{name}": validation_table(name) for name in ("sets", "field", "pulls", "barcodes", "blocks")},
         **{f"predicted-{name}": validation_table(name, "predictions") for name in ("rings", "panels", "matters", "assumed")}}


def write_tables():
    """Replaces the text below `<!-- results/make.py: NAME -->`: a block of text, or to the next empty line."""
    missing = []
    for path in READMES:
        def shown(found):
            try:
                return found[1] + SHOWN[found[2]]()
            except (FileNotFoundError, KeyError) as error:
                lacking = getattr(error, "filename", None) or error
                missing.append(f"{path.relative_to(ROOT)}: the table {found[2]} stays as it was, for its files lack {lacking}")
                return found[0]

        text = path.read_text()
        new = re.sub(r"(<!-- results/make\.py: (\S+) -->\n)(?:```(?:.*\n)*?```\n|(?:.+\n)*)", shown, text)
        if new != text:
            path.write_text(new)
    return missing


# The script

def sums():
    paths = [*(it for it in HERE.rglob("*") if it.is_file()), *READMES]
    return {it.relative_to(ROOT).as_posix(): hashlib.sha256(it.read_bytes()).hexdigest() for it in paths}


def told(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


def listed():
    print(__doc__)
    for group in dict.fromkeys(it.group for it in PARTS):
        parts = [it for it in PARTS if it.group == group]
        print(f"{group} ({told(60 * sum(it.minutes for it in parts))})")
        for part in parts:
            needs = f"; needs {part.needs}" if part.needs else ""
            print(f"    {part.name} ({told(60 * part.minutes)}{needs})")


def main():
    options = argparse.ArgumentParser(add_help=False)
    options.add_argument("--program", type=pathlib.Path)
    options.add_argument("parts", nargs="*")
    given = options.parse_args()
    asked, known = set(given.parts), {"all", "tables", *(it.name for it in PARTS), *(it.group for it in PARTS)}
    if not asked:
        return listed()
    if asked - known:
        sys.exit(f"no such part: {' '.join(sorted(asked - known))}")
    parts = [it for it in PARTS if {"all", it.name, it.group} & asked]
    before, begun, troubles = sums(), time.monotonic(), []
    program = (given.program or PROGRAM).resolve()
    if parts and not given.program:
        subprocess.run(["cargo", "build", "--release", "--bin", "tilebind"], cwd=ROOT, check=True)
        print(f"build: {told(time.monotonic() - begun)}", flush=True)
    for part in parts:
        start = time.monotonic()
        print(part.name, flush=True)
        try:
            with tempfile.TemporaryDirectory() as folder:
                work = Work(program, folder)
                part.make(work)
                work.finish()
        except Skipped as skipped:
            print(f"  nothing replaced: {skipped}")
        except Failed as failed:
            troubles.append(f"{part.name}: nothing replaced; {failed}")
        print(f"{part.name}: {told(time.monotonic() - start)}", flush=True)
    troubles += write_tables()
    after = sums()
    print(f"in all: {told(time.monotonic() - begun)}")
    for name in sorted(before.keys() | after.keys()):
        if before.get(name) != after.get(name):
            print("new:" if name not in before else "gone:" if name not in after else "changed:", name)
    made = {*OWN, *(file for part in PARTS for file in part.files)}
    strange = [it for it in after if it.startswith("results/") and it.removeprefix("results/") not in made]
    troubles += [f"{it}: no part makes it" for it in strange]
    sys.exit("\n".join(troubles) or 0)


if __name__ == "__main__":
    main()
