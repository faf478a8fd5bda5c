#!/usr/bin/env python3
"""Grows what `tilebind assemble` writes in rgrow, to 2,000 tiles, and counts errors.

    tests/assembly/check.py target/release/tilebind [more]

Installs the rgrow wheel in a virtual environment of its own (below the system's folder for
temporary files) unless this Python has it; skips with a line where that fails. With `more` it
grows every set ten times as often, for figures rather than for a check.

An error is a pair of neighbours whose faces are no word and its mate: by the names of their glues,
since the engine's own count of mismatches has a threshold of its own. A program `xgrow` grows the
same tiles as well: the one on the path, or compiled from its sources where that can be done.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import venv

SETS = pathlib.Path(__file__).resolve().parents[2] / "shapes/assemblies"
SIZE = 2000
LIBRARY = ["rgrow==0.23.0"]


def skip(why):
    print(f"assembly: skipped, {why}")
    sys.exit(0)


def with_rgrow():
    """Runs the script again in an environment that has rgrow."""
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
    """The intended partner of a word or a mate; that of a plain glue is itself."""
    return glue[:-1] if glue.endswith("*") else glue + "*"


class Counted:
    """The errors of a canvas of tiles, numbered from 1, with these edges."""

    def __init__(self, canvas, edges, plain=False):
        fits = (lambda a, b: a == b) if plain else (lambda a, b: b == mate(a))
        self.canvas, self.count = canvas, int((canvas > 0).sum())
        self.errors, self.places = 0, []
        # Permanent wrong contacts: both tiles have three neighbours. A tile that has docked at a
        # wrong place has fewer, and detaches again.
        filled = np.pad(canvas > 0, 1).astype(int)
        about = filled[:-2, 1:-1] + filled[2:, 1:-1] + filled[1:-1, :-2] + filled[1:-1, 2:]
        self.inner, self.settled = (about >= 3) & (canvas > 0), []
        rows, columns = canvas.shape
        for i, j in zip(*np.nonzero(canvas)):
            here = edges[canvas[i, j] - 1]
            # The word is on the north or east face.
            for there, out, back in (((i, j + 1), 1, 3), ((i - 1, j), 0, 2)):
                if 0 <= there[0] and there[1] < columns and canvas[there]:
                    a, b = here[out], edges[canvas[there] - 1][back]
                    # An empty face neither binds nor repels.
                    if "0" not in (a, b) and not fits(a, b):
                        self.errors += 1
                        self.places.append(((i + there[0]) / 2, (j + there[1]) / 2))
                        if self.inner[i, j] and self.inner[there]:
                            self.settled.append((i, j))


class Grown(Counted):
    """A file grown once in rgrow."""

    def __init__(self, path, plain=False, size=SIZE, events=20_000_000):
        tiles = rgrow.rgrow.TileSet.from_file(str(path))
        system, state = tiles.create_system_and_state()
        system.evolve(state, size_max=size, for_events=events, for_wall_time=600)
        self.time = state.time
        edges = edges_of(pathlib.Path(path).with_suffix(".yaml").read_text())
        super().__init__(np.array(state.canvas_view), edges, plain)


class ByXgrow(Counted):
    """A file grown once in xgrow, which has its own random numbers."""

    def __init__(self, program, path, size=SIZE, events=1_000_000_000):
        array = pathlib.Path(path).with_name("array.txt")
        array.unlink(missing_ok=True)
        command = [program, str(path), f"smax={size}", f"emax={events}", "-nw", f"arrayfile={array}"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
        # The canvas is the third bracket of the flake.
        canvas = array.read_text().split("[")[3].split("]")[0].replace("...", "")
        rows = [[int(it) for it in row.split()] for row in canvas.split(";") if row.strip()]
        edges = edges_of(pathlib.Path(path).with_suffix(".yaml").read_text())
        super().__init__(np.array(rows), edges)


def edges_of(text):
    """Edges of the tiles of a file as tilebind writes it: a tile a line."""
    lines = [it for it in text.splitlines() if it.startswith("- {name:") and "edges:" in it]
    inside = [line.split("edges: [")[1].split("]")[0] for line in lines]
    return [[edge.strip().strip('"') for edge in it.split(",")] for it in inside]


def mean(values):
    """The mean and its standard error."""
    values = list(values)
    middle = sum(values) / len(values)
    spread = sum((value - middle) ** 2 for value in values) / max(len(values) - 1, 1)
    return middle, math.sqrt(spread / len(values))


class Refused(Exception):
    """The program says that it cannot be built."""


def assemble(program, folder, *arguments):
    command = [program, "assemble", *arguments, "--out", str(folder), "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise Refused(done.stderr)
    return json.loads(done.stdout)


def with_words(program, folder, arguments):
    """Searches words, and gives the arguments that take them, and the report."""
    found = folder.with_name(folder.name + "-words")
    report = assemble(program, found, *arguments, "--kt", "5e-3", "--coverage", "0.1")
    kept = [it for at, it in enumerate(arguments) if "--proofread" in arguments[max(at - 1, 0) : at + 1]]
    return [arguments[0], *kept, "--words", str(found / "words.toml")], report


def kept_words(program, name):
    """Words of 16 magnets for a shipped set, on faces that do not slide; searched once and kept, below
    the system's folder for temporary files."""
    folder = pathlib.Path(tempfile.gettempdir()) / "tilebind-study"
    folder.mkdir(exist_ok=True)
    words, tiles = folder / f"{name}.toml", str(SETS / f"{name}.yaml")
    if not words.exists():
        arguments = [tiles, "--length", "16", "--shape", "shared", "--seconds", "4"]
        with tempfile.TemporaryDirectory() as found:
            with_words(program, pathlib.Path(found) / "it", arguments)
            words.write_text((pathlib.Path(found) / "it-words" / "words.toml").read_text())
    return [tiles, "--words", str(words)]


def at_growth(program, folder, given, excess=0.3, kt=5e-3):
    """Assembles at the kT at which Gmc = tau Gse - excess."""
    for _ in range(8):
        report = assemble(program, folder, *given, "--kt", repr(kt), "--coverage", "0.1")
        tau = report["tile_set"]["tau"]
        if abs(tau * report["Gse"] - report["Gmc"] - excess) < 0.01:
            break
        # Gse is proportional to 1 / kT; Z0 about to kT^(5/2).
        low, high = 1e-6, 10.0
        for _ in range(60):
            kt = math.sqrt(low * high)
            gmc = report["Gmc"] - 2.5 * math.log(kt / report["kt_J"])
            wanted = tau * report["bond_J"] / kt - excess
            low, high = (kt, high) if gmc < wanted else (low, kt)
    return report


def ideal(name, gse, folder, half=False):
    """A shipped set with abstract glues; with `half`, wrong ones of strength 1 bind with half strength."""
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


# These sets get one run instead of several: a spiral grows at only one place, and only one of the
# beaver's 101 tiles fits at a place.
SLOW = {"spiral": 5, "beaver-square": 5}


def whole(report, most=SIZE):
    """Tiles to grow: this many, or nearly all of a finite set, because it loses a tile now and then."""
    grown = report["grown"]
    tiles = grown["tiles"] - grown["tiles"] // 20
    return min(most, tiles) if grown["complete"] else most


def told(runs):
    """Errors per tile, and permanent ones."""
    all_, spread = mean(run.errors / run.count for run in runs)
    settled, its = mean(len(run.settled) / run.count for run in runs)
    return f"{all_:.4f} +- {spread:.4f} errors a tile ({settled:.4f} +- {its:.4f} to stay)"


def check_sets(program, xgrow, folder, often):
    """Every shipped set grows as written, without many errors, in both engines: to 2,000 tiles, or
    completely if it is finite (square, tree and beaver square)."""
    for name in ("unary-square", "binary-tree", "binary-counter", "sierpinski", "beaver-square", "spiral"):
        out = folder / name
        report = at_growth(program, out, kept_words(program, name), 2.0)
        size, runs = whole(report), max(1, often // SLOW.get(name, 1))
        ends = "its whole" if report["grown"]["complete"] else "of more than"
        engines = [("rgrow", lambda: Grown(out / "assembly.yaml", size=size))]
        if xgrow:
            engines.append(("xgrow", lambda: ByXgrow(xgrow, out / "assembly.tiles", size)))
        print(f"{name}: {size} tiles ({ends} {report['grown']['tiles']}) at Gse {report['Gse']:.2f}, Gmc {report['Gmc']:.2f}")
        for engine, grow in engines:
            grown = [grow() for _ in range(runs)]
            print(f"    {engine}, {runs} times: {told(grown)}", flush=True)
            assert min(run.count for run in grown) >= size, (name, engine, [run.count for run in grown])
            assert mean(run.errors / run.count for run in grown)[0] < 0.3, (name, engine)


XGROW = "https://github.com/DNA-and-Natural-Algorithms-Group/xgrow"
COMMIT = "abae7e9609fa89c6a292f45b3ab3b001657d56c5"


def with_xgrow():
    """The program xgrow: the one on the path, or compiled; None, with a message, if there is neither."""
    program = shutil.which("xgrow")
    folder = pathlib.Path(tempfile.gettempdir()) / "tilebind-xgrow"
    if program or (folder / "xgrow-program").exists():
        return program or str(folder / "xgrow-program")
    try:
        folder.mkdir(exist_ok=True)
        sources = ["src/xgrow.c", "src/grow.c"]
        for command in (
            ["git", "init", "--quiet"],
            ["git", "fetch", "--quiet", "--depth", "1", XGROW, COMMIT],
            ["git", "checkout", "--quiet", "FETCH_HEAD"],
            ["cc", "-O2", "-w", "-o", "xgrow-program", *sources, "-lX11", "-lm"],
        ):
            subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=120)
        return str(folder / "xgrow-program")
    except (OSError, subprocess.SubprocessError) as error:
        print(f"assembly: without xgrow, which needs git, cc and libX11's headers ({error})")
        return None


def main():
    arguments = [it for it in sys.argv[1:] if it != "--inside"]
    program = str(pathlib.Path(arguments[0]).resolve())
    often = 50 if "more" in arguments else 5
    xgrow = with_xgrow()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        check_ideal(folder, 2 * often)
        check_sets(program, xgrow, folder, often)
    print("assembly: what tilebind writes grows in", "rgrow and xgrow" if xgrow else "rgrow")


if __name__ == "__main__":
    main()
