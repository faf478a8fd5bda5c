#!/usr/bin/env python3
"""Why xgrow's files omit repulsion, and the effect of that.

    tests/assembly/repulsion.py target/release/tilebind results/assembly/repulsion.csv

Grows two sets with and without their repulsive links in rgrow and xgrow, and in an xgrow in which one
comparison of choose_cell (grow.c) is that of calc_rates: the rate of a free place counts the tiles
whose bonds there are above 0, the choice passes over those whose bonds are 0. With a repelled tile
among them the choice falls on it in place of one that would hold, again and again.
"""

import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from check import ByXgrow, Grown, at_growth, kept_words, mean, with_xgrow

SIZE = 1000
EVENTS = 1_000_000
RUNS = 3
EXCESS = 4.0
LINE = "if (Gse(fp, i, j, n) == 0)\n               continue;"


def mended(program, folder):
    """The program with that line fixed, compiled next to its sources."""
    sources = pathlib.Path(program).parent / "src"
    shutil.copytree(sources, folder / "src")
    text = (folder / "src/grow.c").read_text()
    assert text.count(LINE) == 1, "other sources than those this was written for"
    (folder / "src/grow.c").write_text(text.replace(LINE, LINE.replace("==", "<=")))
    command = ["cc", "-O2", "-w", "-o", "xgrow-mended", "src/xgrow.c", "src/grow.c", "-lX11", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return str(folder / "xgrow-mended")


def with_repulsion(folder):
    """An xgrow file with the links of rgrow's."""
    yaml, tiles = ((folder / f"assembly.{it}").read_text() for it in ("yaml", "tiles"))
    bonds = re.findall(r'^- \{name: "(.*)", strength: (.*)\}$', yaml, re.M)
    number = {name: at + 1 for at, (name, _) in enumerate(bonds)}
    links = re.findall(r'^- \["(.*?)", "(.*?)", (.*)\]$', yaml, re.M)
    head, tail = tiles.split("binding strengths=")[0], tiles[tiles.index("seed=") :]
    strengths = "\n".join(strength for _, strength in bonds)
    links = "\n".join(f"g({number[a]},{number[b]})={strength}" for a, b, strength in links)
    path = folder / "repelled.tiles"
    path.write_text(f"{head}binding strengths={{\n{strengths}\n}}\n{links}\n{tail}")
    shutil.copy(folder / "assembly.yaml", folder / "repelled.yaml")
    return path


def without_repulsion(folder):
    """An rgrow file with negative values replaced by 0."""
    text = (folder / "assembly.yaml").read_text()
    path = folder / "neutral.yaml"
    path.write_text(re.sub(r"(strength: |\", )-[\d.e-]+([}\]])$", r"\g<1>0.0\2", text, flags=re.M))
    return path


def main():
    program, out = (str(pathlib.Path(it).resolve()) for it in sys.argv[1:3])
    xgrow, rows = with_xgrow(), []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        repaired = mended(xgrow, folder)
        for name in ("binary-counter", "sierpinski"):
            at_growth(program, folder / name, kept_words(program, name), EXCESS)
            own, other = folder / name / "assembly.tiles", with_repulsion(folder / name)
            ways = [
                ("rgrow", "kept", lambda: Grown(folder / name / "assembly.yaml", size=SIZE, events=EVENTS)),
                ("rgrow", "left out", lambda: Grown(without_repulsion(folder / name), size=SIZE, events=EVENTS)),
                ("xgrow", "left out", lambda: ByXgrow(xgrow, own, SIZE, EVENTS)),
                ("xgrow", "kept", lambda: ByXgrow(xgrow, other, SIZE, EVENTS)),
                ("xgrow, mended", "kept", lambda: ByXgrow(repaired, other, SIZE, EVENTS)),
            ]
            for engine, links, grow in ways:
                runs = [grow() for _ in range(RUNS)]
                errors, spread = mean(len(it.settled) / it.count for it in runs)
                tiles = sorted(it.count for it in runs)[RUNS // 2]
                rows.append([name, engine, links, tiles, f"{errors:.3g}", f"{spread:.3g}"])
                print(*rows[-1], flush=True)
    with open(out, "w", newline="") as file:
        head = ["set", "engine", "repulsive_links", "tiles_median", "errors_a_tile", "standard_error"]
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


if __name__ == "__main__":
    main()
