#!/usr/bin/env python3
"""Grows what `tilebind assemble` writes in rgrow, to 2,000 tiles, and counts errors.

    tests/assembly/check.py target/release/tilebind [more]

Installs the rgrow wheel in a virtual environment of its own (below the system's folder for
temporary files) unless this Python has it; skips with a line where that fails. With `more` it
grows every set ten times as often, for figures rather than for a check.

An error is a pair of neighbours whose faces are no word and its mate: by the names of their glues,
since the engine's own count of mismatches has a threshold of its own. Where a program `xgrow` is on
the path it grows the same tiles as well.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import venv

SETS = pathlib.Path("shapes/assemblies")
SIZE = 2000
LIBRARY = ["rgrow==0.23.0"]


def skip(why):
    print(f"assembly: skipped, {why}")
    sys.exit(0)


def with_rgrow():
    """Runs this script again in an environment that has rgrow."""
    try:
        import rgrow  # noqa: F401

        return
    except ImportError:
        pass
    folder = pathlib.Path(tempfile.gettempdir()) / "tilebind-rgrow"
    python = folder / "bin" / "python"
    if "--inside" in sys.argv:
        skip("the environment with rgrow does not work")
    try:
        if not python.exists():
            venv.create(folder, with_pip=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--only-binary", ":all:", *LIBRARY]
        subprocess.run(pip, check=True, capture_output=True, timeout=300)
    except (OSError, subprocess.SubprocessError) as error:
        skip(f"rgrow cannot be installed here ({error})")
    sys.exit(subprocess.run([python, *sys.argv, "--inside"]).returncode)


with_rgrow()

import numpy as np  # noqa: E402
import rgrow  # noqa: E402


def mate(glue):
    """What a word or a mate is meant to meet; a plain glue meets itself."""
    return glue[:-1] if glue.endswith("*") else glue + "*"


class Grown:
    """A file grown once."""

    def __init__(self, path, plain=False, size=SIZE, wall=60):
        self.tiles = rgrow.rgrow.TileSet.from_file(str(path))
        text = pathlib.Path(path).read_text()
        names, edges = read(text)
        system, state = self.tiles.create_system_and_state()
        system.evolve(state, size_max=size, for_wall_time=wall)
        self.canvas = np.array(state.canvas_view)
        self.count, self.time = state.n_tiles, state.time
        fits = (lambda a, b: a == b) if plain else (lambda a, b: b == mate(a))
        self.errors = self.pairs = 0
        self.places = []
        rows, columns = self.canvas.shape
        for i, j in zip(*np.nonzero(self.canvas)):
            here = edges[self.canvas[i, j] - 1]
            for there, out, back in (((i, j + 1), 1, 3), ((i + 1, j), 2, 0)):
                if there[0] < rows and there[1] < columns and self.canvas[there]:
                    other = edges[self.canvas[there] - 1]
                    a, b = here[out], other[back]
                    # The word is on the north or east face.
                    a, b = (b, a) if out == 2 else (a, b)
                    self.pairs += 1
                    # An empty face binds nothing and hinders nothing.
                    wrong = "0" not in (a, b) and not fits(a, b)
                    self.errors += wrong
                    if wrong:
                        self.places.append(((i + there[0]) / 2, (j + there[1]) / 2))


def read(text):
    """Names and edges of the tiles of a file as tilebind writes it: a tile a line."""
    names, edges = [], []
    for line in text.splitlines():
        if line.startswith("- {name:") and "edges:" in line:
            names.append(line.split("name:")[1].split(", edges")[0].strip().strip('"'))
            inside = line.split("edges: [")[1].split("]")[0]
            edges.append([edge.strip().strip('"') for edge in inside.split(",")])
    return names, edges


def mean(values):
    values = list(values)
    middle = sum(values) / len(values)
    spread = sum((value - middle) ** 2 for value in values) / max(len(values) - 1, 1)
    return middle, math.sqrt(spread / len(values))


def assemble(program, folder, *arguments):
    command = [program, "assemble", *arguments, "--out", str(folder), "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def at_growth(program, folder, arguments, excess=0.3):
    """Assembles at the kT at which Gmc = tau Gse - excess."""
    low, high = 1e-4, 1.0
    report = None
    if "--words" not in arguments:
        found = folder.with_name(folder.name + "-words")
        assemble(program, found, *arguments, "--kt", "5e-3", "--coverage", "0.1")
        arguments = [*arguments, "--words", str(found / "words.toml")]
    for _ in range(40):
        kt = math.sqrt(low * high)
        report = assemble(program, folder, *arguments, "--kt", repr(kt), "--coverage", "0.1")
        wanted = report["tile_set"]["tau"] * report["Gse"] - excess
        low, high = (kt, high) if report["Gmc"] < wanted else (low, kt)
        if high / low < 1.0005:
            return report
    return report


def ideal(name, gse, folder, half=False):
    """A shipped set with abstract glues; where `half`, wrong ones of strength 1 bind half."""
    text = (SETS / f"{name}.yaml").read_text()
    text += f"Gse: {gse}\nGmc: {2 * gse - 0.3}\n"
    if half:
        text += "glues:\n- [zero, one, 0.5]\n"
    path = folder / "ideal.yaml"
    path.write_text(text)
    return path


def check_ideal(folder, often):
    """Sierpinski's errors with ideal glues are the published ones."""
    for half, published in ((False, 0.0023), (True, 0.051)):
        path = ideal("sierpinski", 8.0, folder, half)
        errors, spread = mean(
            grown.errors / grown.count for grown in (Grown(path, plain=True) for _ in range(often))
        )
        print(f"ideal glues, wrong ones {'bind half' if half else 'neutral'}: {errors:.4f} +- {spread:.4f} errors a tile, published {published}")
        assert published / 3 - 2 * spread < errors < published * 3 + 2 * spread, errors


def check_sets(program, folder, often):
    """Every shipped set grows as written, without many errors."""
    for name, arguments in (
        ("unary-square", ["--length", "16"]),
        ("binary-counter", ["--length", "8"]),
        ("sierpinski", ["--length", "8"]),
        ("spiral", ["--length", "16"]),
    ):
        out = folder / name
        report = at_growth(program, out, [str(SETS / f"{name}.yaml"), *arguments])
        whole = min(SIZE, report["grown"]["tiles"] if report["grown"]["complete"] else SIZE)
        runs = [Grown(out / "assembly.yaml", size=whole) for _ in range(often)]
        errors, spread = mean(run.errors / run.count for run in runs)
        print(f"{name}: Gse {report['Gse']:.2f}, Gmc {report['Gmc']:.2f}: {errors:.4f} +- {spread:.4f} errors a tile")
        assert max(run.count for run in runs) >= whole, [run.count for run in runs]
        assert errors < 0.3, errors
        same = rgrow.rgrow.TileSet.from_file(str(out / "assembly.tiles"))
        system, state = same.create_system_and_state()
        system.evolve(state, size_max=whole, for_wall_time=60)
        assert state.n_tiles >= whole, state.n_tiles
        by_xgrow(out / "assembly.tiles", whole)


def by_xgrow(path, whole):
    program = shutil.which("xgrow")
    if program is None:
        return
    done = subprocess.run([program, str(path), f"smax={whole}", "-nw"], capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr


def main():
    arguments = [it for it in sys.argv[1:] if it != "--inside"]
    program = str(pathlib.Path(arguments[0]).resolve())
    often = 50 if "more" in arguments else 5
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        check_ideal(folder, 2 * often)
        check_sets(program, folder, often)
    print("assembly: what tilebind writes grows in rgrow", "" if shutil.which("xgrow") else "(no xgrow here)")


if __name__ == "__main__":
    main()
