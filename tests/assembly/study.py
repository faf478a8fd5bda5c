#!/usr/bin/env python3
"""The study of results/assembly: tables and pictures of sets built of magnets and grown in rgrow.

    tests/assembly/study.py target/release/tilebind results/assembly [PART ...]

Parts are builds, smallest, shaking, blocks, proofreading and pictures; without one, all, which takes
some hours. It goes on where it was left: rows to be made anew are deleted before. Words are the same
every time, what grows is drawn at random. See check.py for what an error is.
"""

import csv
import math
import pathlib
import re
import sys
import tempfile

from check import SETS, Grown, Refused, assemble, at_growth, kept_words, mean, with_words
from check import whole as of_size

NAMES = ["unary-square", "binary-tree", "binary-counter", "beaver-square", "spiral"]
ORDER = ["sierpinski", *NAMES]
EXCESS = 1.0
# tau Gse - Gmc of the study of shaking, the most informative first.
EXCESSES = (1.0, 8.0, 24.0, 4.0, 16.0, 32.0, 2.0, 0.3, -0.5)
# Largest number of an engine's events.
EVENTS = 20_000_000
# Blocks of a run by tiles along their edge, and runs.
BLOCKS = {1: 1000, 2: 500, 3: 200}
RUNS = {1: 10, 2: 5, 3: 3}
SPACED = ["--pitch", "0.015"]
FACES = [
    *((k, "uniform", k, 0.040, ["--length", str(k)]) for k in (4, 8, 16)),
    *((k, "spaced", 28, 0.015, ["--length", "28", "--magnets", str(k), *SPACED]) for k in (4, 8, 16)),
]
SHAPES = ["none", "shared"]
LONGEST = 48


class Table:
    """A table that is written whole after each row, and goes on where it was left; what is to be made
    anew is deleted from it before."""

    def __init__(self, path, header):
        self.path, self.header, self.rows = path, header, []
        if path.exists():
            head, *rows = csv.reader(path.read_text().splitlines())
            self.rows = rows if head == header else []

    def has(self, *key):
        """Whether there is a row with this beginning."""
        key = ["" if it is None else str(it) for it in key]
        return any(row[: len(key)] == key for row in self.rows)

    def add(self, row):
        self.rows.append(["" if it is None else str(it) for it in row])
        # Sets in their order, whichever was made first.
        self.rows.sort(key=lambda row: ORDER.index(row[0]) if row[0] in ORDER else 0)
        with open(self.path, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([self.header, *self.rows])
        print(self.path.stem, *row, flush=True)


def figure(value, digits=3):
    return None if value is None else f"{value:.{digits}g}"


# A spiral grows at one place only: less of it is grown, and of it and of the beaver square, of whose
# 101 tiles one fits, fewer.
SIZES = {"spiral": 500}
SLOW = {"spiral": 2, "beaver-square": 2}


def whole(report):
    """Tiles to grow."""
    return of_size(report, SIZES.get(report["tile_set"]["name"], 2000))


def times(name, often):
    """Runs of a set."""
    return -(-often // SLOW.get(name, 1))


GREW = ["errors_a_tile", "standard_error", "tiles_a_docking_time", "grown"]


def measured(path, gmc, size, often, plain=False, side=1, events=EVENTS):
    """Of `often` runs: errors that are there to stay and their standard error, for a tile with three
    neighbours or for a block of `side` x `side` of them, tiles or blocks a docking time, and the share
    that grew."""
    runs = [Grown(path, size=size, plain=plain, events=events) for _ in range(often)]
    done = [it for it in runs if it.count >= size]
    share = figure(len(done) / often) if often else None
    if not done:
        return [None, None, None, share]
    errors, spread = mean(wrong_share(it, path, side) for it in done)
    # The engine's rate of docking at no cost is 10^6 a second.
    speed, _ = mean(it.count / side**2 / (it.time * 1e6 * math.exp(-gmc)) for it in done)
    return [figure(errors), figure(spread), figure(speed), share]


def wrong_share(grown, path, side):
    row, column = re.search(r"seed: \[(\d+), (\d+),", pathlib.Path(path).with_suffix(".yaml").read_text()).groups()
    block = lambda i, j: ((i - int(row) - 1) // side, (j - int(column)) // side)
    wrong = {block(i, j) for i, j in grown.settled}
    return len(wrong) * side**2 / max(int(grown.inner.sum()), 1)


def ideal(folder, tiles, gse, gmc, wrong=0.0):
    """A file of abstract glues, where different ones of strength 1 bind with `wrong`."""
    text = tiles
    if wrong:
        weak = re.findall(r"- \{name: (.*), strength: 1(?:\.0)?\}", text)
        links = [f"- [{a}, {b}, {wrong}]" for i, a in enumerate(weak) for b in weak[:i]]
        text += "\n" + "\n".join(["glues:", *links])
    path = folder / "ideal.yaml"
    path.write_text(f"{text}\nGse: {gse}\nGmc: {gmc}\n")
    return path


def set_of(name):
    return str(SETS / f"{name}.yaml")


def why_not(error):
    """Words needed, the verdict, words found, the bound and the gap, of the program's refusal."""
    text = " ".join(str(error).split())
    number = lambda pattern: next(iter(re.findall(pattern, text)), None)
    bound = re.search(r"of those with (\d+) magnets? at most (\d+)", text)
    bound = f"{bound[2]} with {bound[1]} magnets" if bound else None
    return [number(r"(\d+) words \("), "none, proved" if bound else "open",
            number(r": (\d+) were found"), bound, number(r"gap of ([\d.]+)")]


def builds(program, folder, out, often):
    """Which set can be built with which faces, and with which errors."""
    table = Table(out / "builds.csv", [
        "set", "shape", "magnets", "arrangement", "places", "face_m", "words_needed", "words", "found",
        "at_most", "gap", "wider_gap", "weakest_bond_J", "strongest_mismatch_J", "window_low_J",
        "window_high_J", "kt_J", "Gse", "Gmc", *GREW, *(f"{it}_ideal" for it in GREW)])
    for name in NAMES:
        for shape in SHAPES:
            for magnets, arrangement, places, pitch, options in FACES:
                head = [name, shape, magnets, arrangement, places, figure(places * pitch)]
                if table.has(*head):
                    continue
                arguments = [set_of(name), *options, "--shape", shape, "--seconds", "4"]
                try:
                    given, first = with_words(program, folder / "built", arguments)
                except Refused as error:
                    table.add(head + why_not(error) + [None] * 16)
                    continue
                report = at_growth(program, folder / "built", given, EXCESS)
                wider = [it for it in first["faces_tried"] if it["verdict"] != "found"]
                wider = "none wider, proved" if not wider or wider[-1]["verdict"] != "open" else "open"
                window = report["window_kt_J"] or [None, None]
                mismatch = report["strongest_mismatch"] or {"energy_J": 0.0}
                weakest = max(it["energy_J"] for it in report["bonds"])
                gse, gmc, size = report["Gse"], report["Gmc"], whole(report)
                runs = times(name, often)
                own = measured(folder / "built" / "assembly.yaml", gmc, size, runs)
                path = ideal(folder, (folder / "built" / "tileset.yaml").read_text(), gse, gmc)
                table.add([
                    *head, report["tile_set"]["words_needed"], "found", report["tile_set"]["words_needed"], None,
                    figure(first["faces_tried"][-1]["gap"]), wider,
                    *(figure(it, 4) for it in (weakest, mismatch["energy_J"], *window, report["kt_J"], gse, gmc)),
                    *own, *measured(path, gmc, size, runs, plain=True)])


def smallest(program, folder, out, _):
    """The smallest face that carries a set with a gap of 0.5."""
    table = Table(out / "smallest.csv", ["set", "shape", "magnets", "places", "face_m", "none_proved_to"])
    for name in NAMES:
        for shape in SHAPES:
            for magnets in (None, 4, 8, 16):
                if table.has(name, shape, magnets or "one a place"):
                    continue
                pitch = 0.015 if magnets else 0.040
                refuted = [0]

                def carries(places):
                    arguments = [set_of(name), "--length", str(places), "--shape", shape, "--gap", "0.5", "--seconds", "1.5"]
                    arguments += ["--magnets", str(magnets), *SPACED] if magnets else []
                    try:
                        with_words(program, folder / "smallest", arguments)
                        return True
                    except Refused as error:
                        if why_not(error)[1] != "open":
                            refuted.append(places)
                        return False

                low, high = (magnets or 2) - 1, magnets or 2
                while high <= LONGEST and not carries(high):
                    low, high = high, max(high + 1, min(high * 3 // 2, LONGEST) if high < LONGEST else LONGEST + 1)
                while high <= LONGEST and high - low > 1:
                    middle = (low + high) // 2
                    low, high = (low, middle) if carries(middle) else (middle, high)
                found = [high, figure(high * pitch)] if high <= LONGEST else [None, None]
                table.add([name, shape, magnets or "one a place", *found, max(refuted)])


def shaking(program, folder, out, often):
    """Errors and speed over shaking, measured matrices against ideal glues: from where nothing
    grows (tau Gse - Gmc below 0) to beyond where one bond less than tau holds (above Gse)."""
    table = Table(out / "shaking.csv", [
        "set", "tau_Gse_less_Gmc", "window_low_J", "window_high_J", "kt_J", "Gse", "Gmc", *GREW,
        *(f"{it}_ideal" for it in GREW)])
    order = [(name in SLOW, excess, name) for excess in EXCESSES for name in ORDER]
    for _, excess, name in sorted(order, key=lambda it: it[0]):
        if not table.has(name, excess):
            given = kept_words(program, name)
            report = at_growth(program, folder / name, given, excess)
            gse, gmc, size = report["Gse"], report["Gmc"], whole(report)
            # Below 0 nothing grows, and little is waited for.
            runs, events = (times(name, often), EVENTS) if excess > 0 else (1, EVENTS // 40)
            own = measured(folder / name / "assembly.yaml", gmc, size, runs, events=events)
            path = ideal(folder, (folder / name / "tileset.yaml").read_text(), gse, gmc)
            table.add([name, excess, *(figure(it, 4) for it in (*report["window_kt_J"], report["kt_J"], gse, gmc)), *own,
                       *measured(path, gmc, size, runs, plain=True, events=events)])


def blocks(program, folder, out, often):
    """Sierpinski's set of abstract glues in blocks, where wrong ones bind in part."""
    table = Table(out / "blocks.csv", ["Gse", "tau_Gse_less_Gmc", "wrong_strength", "block", "errors_a_block", "standard_error", "blocks_a_docking_time", "grown"])
    texts = {k: blocks_of(program, folder, k) for k in (1, 2, 3)}
    for k, text in texts.items():
        for gse in (8.0, 10.0, 13.0):
            for wrong in (0.0, 0.125, 0.25, 0.375, 0.5):
                key = [gse, EXCESS, wrong, k]
                if not table.has(*key):
                    gmc = 2 * gse - EXCESS
                    path = ideal(folder, text, gse, gmc, wrong)
                    table.add([*key, *measured(path, gmc, BLOCKS[k] * k * k, RUNS[k], plain=True, side=k)])


def blocks_of(program, folder, k):
    out = folder / f"blocks-{k}"
    arguments = [set_of("sierpinski"), "--proofread", str(k), "--length", "16", "--shape", "shared"]
    assemble(program, out, *arguments, "--kt", "5e-3", "--coverage", "0.1", "--seconds", "2")
    return (out / "tileset.yaml").read_text()


def proofreading(program, folder, out, often):
    """Sierpinski's set and the counter in blocks, of magnets."""
    table = Table(out / "proofreading.csv", [
        "set", "block", "words", "magnets", "gap", "strongest_mismatch", "tau_Gse_less_Gmc", "kt_J", "Gse", "Gmc",
        "errors_a_block", "standard_error", "blocks_a_docking_time", "grown"])
    for k in (1, 2, 3):
        for places in (8, 16):
            for name in ("sierpinski", "binary-counter"):
                if any(row[:2] == [name, str(k)] and row[3] == str(places) for row in table.rows):
                    continue
                arguments = [set_of(name), "--proofread", str(k), "--length", str(places), "--shape", "shared", "--seconds", "4"]
                try:
                    given, first = with_words(program, folder / "proof", arguments)
                except Refused as error:
                    table.add([name, k, None, places, why_not(error)[1], *[None] * 9])
                    continue
                for excess in (1, 3):
                    report = at_growth(program, folder / "proof", given, excess)
                    mismatch = (report["strongest_mismatch"] or {"energy_J": 0.0})["energy_J"]
                    own = measured(folder / "proof" / "assembly.yaml", report["Gmc"], BLOCKS[k] * k * k, RUNS[k], side=k)
                    table.add([name, k, report["tile_set"]["words_needed"], places, figure(first["faces_tried"][-1]["gap"]),
                               figure(-mismatch / report["bond_J"]), excess,
                               *(figure(report[it], 4) for it in ("kt_J", "Gse", "Gmc")), *own])


def pictures(program, folder, out, _):
    from draw import draw

    draw(program, folder, out)


PARTS = {"builds": (builds, 3), "smallest": (smallest, 0), "shaking": (shaking, 4), "blocks": (blocks, 4),
         "proofreading": (proofreading, 5), "pictures": (pictures, 0)}


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for name in [it for it in sys.argv[3:] if it in PARTS] or PARTS:
        part, often = PARTS[name]
        with tempfile.TemporaryDirectory() as folder:
            part(program, pathlib.Path(folder), out, often)


if __name__ == "__main__":
    main()
