#!/usr/bin/env python3
"""The study of results/assembly: tables and pictures of sets grown in rgrow.

    tests/assembly/study.py target/release/tilebind results/assembly

Takes minutes. See check.py for what an error is.
"""

import csv
import pathlib
import sys
import tempfile

from check import SETS, Grown, assemble, at_growth, ideal, mean

import numpy as np

NAMES = ["unary-square", "binary-tree", "binary-counter", "beaver-square", "spiral"]
FACES = [
    ("4 even", ["--length", "4"]),
    ("8 even", ["--length", "8"]),
    ("16 even", ["--length", "16"]),
    ("4 in 16", ["--length", "16", "--magnets", "4", "--pitch", "0.015"]),
    ("8 in 24", ["--length", "24", "--magnets", "8", "--pitch", "0.015"]),
    ("16 in 32", ["--length", "32", "--magnets", "16", "--pitch", "0.015"]),
]


def table(path, header, rows):
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows(rows)


def figure(value, digits=3):
    return f"{value:.{digits}g}"


def whole(report):
    grown = report["grown"]
    return min(2000, grown["tiles"]) if grown["complete"] else 2000


def runs(path, size, often, **more):
    grown = [Grown(path, size=size, wall=20, **more) for _ in range(often)]
    done = [it for it in grown if it.count >= size]
    return done, len(done) / often


def measured(path, report, often, plain=False):
    """Errors a tile with its standard error, tiles a docking time, and the share that got there."""
    size = whole(report)
    done, share = runs(path, size, often, plain=plain)
    if not done:
        return None, None, None, share
    errors, spread = mean(it.errors / it.count for it in done)
    gmc = report["Gmc"]
    speed, _ = mean(it.count / (it.time * 1e6 * np.exp(-gmc)) for it in done)
    return errors, spread, speed, share


def told(found):
    return ["" if it is None else figure(it) for it in found]


def ideal_like(name, report, folder, often):
    text = (SETS / f"{name}.yaml").read_text()
    path = folder / "like.yaml"
    path.write_text(text + f"Gse: {report['Gse']}\nGmc: {report['Gmc']}\n")
    return measured(path, report, often, plain=True)


def builds(program, folder, out, often):
    rows = []
    for name in NAMES:
        for face, options in FACES:
            for shape in ("none", "shared"):
                arguments = [str(SETS / f"{name}.yaml"), *options, "--shape", shape, "--seconds", "6"]
                try:
                    words = folder / f"{name}-{face}-{shape}".replace(" ", "-")
                    first = assemble(program, words, *arguments, "--kt", "5e-3", "--coverage", "0.1")
                except AssertionError as error:
                    why = "none, proved" if "proved" in str(error) else "none found"
                    rows.append([name, face, shape, why] + [""] * 9)
                    print(rows[-1], flush=True)
                    continue
                given = [str(SETS / f"{name}.yaml"), "--words", str(words / "words.toml")]
                report = at_growth(program, folder / "built", given)
                mismatch = report["strongest_mismatch"] or {"energy_J": 0.0}
                own = measured(folder / "built" / "assembly.yaml", report, often)
                plain = ideal_like(name, report, folder, often)
                gap = first["faces_tried"][-1]["gap"]
                rows.append([
                    name, face, shape, "built", figure(gap),
                    figure(-mismatch["energy_J"] / report["bond_J"]),
                    figure(report["kt_J"]), figure(report["Gse"], 4), figure(report["Gmc"], 4),
                    *told(own[:2]), *told(plain[:2]),
                ])
                print(rows[-1], flush=True)
    header = ["set", "magnets", "shape", "words", "gap", "strongest_mismatch", "kt_J", "Gse", "Gmc",
              "errors_a_tile", "standard_error", "errors_ideal", "standard_error_ideal"]
    table(out / "builds.csv", header, rows)


def shaking(program, folder, out, often):
    rows = []
    for name in ["sierpinski", *NAMES]:
        options = ["--length", "16", "--shape", "shared", "--seconds", "6"]
        words = folder / f"{name}-words"
        assemble(program, words, str(SETS / f"{name}.yaml"), *options, "--kt", "5e-3", "--coverage", "0.1")
        given = [str(SETS / f"{name}.yaml"), "--words", str(words / "words.toml"), "--shape", "shared"]
        for excess in (0.1, 0.3, 1, 2, 4, 6, 8):
            report = at_growth(program, folder / "shaken", given, excess)
            own = measured(folder / "shaken" / "assembly.yaml", report, often)
            plain = ideal_like(name, report, folder, often)
            rows.append([name, excess, figure(report["kt_J"]), figure(report["Gse"], 4),
                         figure(report["Gmc"], 4), *told(own), *told(plain)])
            print(rows[-1], flush=True)
    header = ["set", "tau_Gse_less_Gmc", "kt_J", "Gse", "Gmc", "errors_a_tile", "standard_error",
              "tiles_a_docking_time", "grown", "errors_ideal", "standard_error_ideal",
              "tiles_a_docking_time_ideal", "grown_ideal"]
    table(out / "shaking.csv", header, rows)


def proofreading(program, folder, out, often):
    """Blocks of abstract glues, wrong ones of strength 1 binding in part."""
    rows = []
    for k in (1, 2, 3):
        blocks = folder / f"blocks-{k}"
        arguments = [str(SETS / "sierpinski.yaml"), "--proofread", str(k), "--length", "16"]
        assemble(program, blocks, *arguments, "--gap", "0", "--kt", "5e-3", "--coverage", "0.1")
        text = (blocks / "tileset.yaml").read_text()
        weak = [line.split("name:")[1].split(",")[0].strip() for line in text.splitlines()
                if line.startswith("- {name:") and line.endswith("strength: 1.0}")]
        for gse in (8.0, 10.0):
            for wrong in (0, 0.125, 0.25, 0.375, 0.5):
                links = [f"- [{a}, {b}, {wrong}]" for i, a in enumerate(weak) for b in weak[:i] if wrong]
                path = folder / "blocks.yaml"
                gmc = 2 * gse - 0.3
                path.write_text("\n".join([text, f"Gse: {gse}", f"Gmc: {gmc}", *(["glues:"] if links else []), *links]))
                size = 500 * k * k
                done, share = runs(path, size, often, plain=True)
                if not done:
                    rows.append([gse, wrong, k, "", "", "", figure(share)])
                    continue
                errors, spread = mean(it.errors * k * k / it.count for it in done)
                speed, _ = mean(it.count / (k * k) / (it.time * 1e6 * np.exp(-gmc)) for it in done)
                rows.append([gse, wrong, k, figure(errors), figure(spread), figure(speed), figure(share)])
                print(rows[-1], flush=True)
    header = ["Gse", "wrong_strength", "block", "errors_a_block", "standard_error", "blocks_a_docking_time", "grown"]
    table(out / "proofreading.csv", header, rows)


def pictures(program, folder, out):
    """What grew once, errors in black."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure_, axes = plt.subplots(2, 3, figsize=(9, 6.4), constrained_layout=True)
    for axis, name in zip(axes.flat, ["sierpinski", *NAMES]):
        words = folder / f"{name}-words"
        given = [str(SETS / f"{name}.yaml"), "--words", str(words / "words.toml"), "--shape", "shared"]
        report = at_growth(program, folder / "drawn", given, 1.0)
        grown = Grown(folder / "drawn" / "assembly.yaml", size=whole(report), wall=20)
        canvas = grown.canvas
        colours = [line.split('color: "')[1][:7] if "color:" in line else "#888888"
                   for line in (folder / "drawn" / "assembly.yaml").read_text().splitlines()
                   if line.startswith("- {name:") and "edges:" in line]
        table_ = np.array([[1.0, 1.0, 1.0]] + [matplotlib.colors.to_rgb(it) for it in colours])
        rows, columns = np.nonzero(canvas)
        low, high = (rows.min(), columns.min()), (rows.max() + 1, columns.max() + 1)
        axis.imshow(table_[canvas][low[0]:high[0], low[1]:high[1]], interpolation="nearest")
        wrong = np.array(grown.places) - low if grown.places else np.empty((0, 2))
        axis.plot(wrong[:, 1], wrong[:, 0], "kx", markersize=3, markeredgewidth=0.8)
        axis.set_title(f"{name}: {grown.count} tiles, {grown.errors} wrong contacts", fontsize=9)
        axis.set_axis_off()
    figure_.savefig(out / "grown.png", dpi=110, metadata={"Software": None})


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    out = pathlib.Path(sys.argv[2])
    parts = [it for it in sys.argv[3:] if not it.startswith("-")] or ["shaking", "proofreading", "builds", "pictures"]
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if "shaking" in parts:
            shaking(program, folder, out, 8)
        if "proofreading" in parts:
            proofreading(program, folder, out, 8)
        if "builds" in parts:
            builds(program, folder, out, 5)
        if "pictures" in parts:
            pictures(program, folder, out)


main()
