#!/usr/bin/env python3
"""A lattice of 3 x 3 tiles, pair by pair: is any bond deeper than in the matrix?

    tests/assembly/lattice.py target/release/tilebind results/assembly/lattice.csv

Writes the lattice as designs, analyses each with all faces of both tiles, and sets its bond and its
deepest trap beside the matrix and the gap of its words.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

ASSEMBLE = "assemble lattice --lattice 3x3 --length 6 --gap 0.25 --kt 4e-3 --coverage 0.1 --json"
ANALYSE = "--complete-seconds 0 --certify-seconds 0 --milestones 1000 --compact --json"


def run(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def main():
    program, out = sys.argv[1], sys.argv[2]
    head = ["pair", "word", "matrix_J", "bond_J", "deepest_trap_J", "states"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        report = run(program, *ASSEMBLE.split(), "--out", str(folder))
        with open(folder / "pairs.csv") as file:
            pairs = list(csv.DictReader(file))
        rows = []
        for pair in pairs:
            design = folder / pair["design"]
            found = run(program, "analyse", str(design), *ANALYSE.split(), "--out", str(folder / "pair"))
            bond, matrix = found["bound"]["energy_J"], float(pair["faces_J"])
            assert bond >= matrix * (1 + 1e-9), (design.stem, bond, matrix)
            traps = [it["energy_J"] for it in found["states"] if it["kind"] != "bound"]
            figures = [f"{it:.5g}" for it in (matrix, bond, min(traps))]
            rows.append([design.stem, pair["word"], *figures, len(found["states"])])
            print(*rows[-1], flush=True)
            with open(out, "w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows([head, *rows])
    shallower = max(1 - float(row[3]) / float(row[2]) for row in rows)
    deepest = max(-float(row[4]) for row in rows) / report["bond_J"]
    print(f"no bond is deeper than the matrix says, none shallower by more than {100 * shallower:.1f} %;")
    print(f"the deepest trap has {100 * deepest:.0f} % of the weakest bond")


if __name__ == "__main__":
    main()
