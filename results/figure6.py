#!/usr/bin/env python3
"""The paper's figure 6 of a docking experiment: how often tiles match that start with relative
orientations of -0.5 to 1.5 rad at 0.4 to 0.8 m/s, where the paper finds more than 4 %.

    tilebind dock shapes/paper-tile.toml --runs 12000 --out target/dock
    results/figure6.py target/dock
"""

import csv
import pathlib
import sys

ORIENTATION, SPEED, CLAIM = (-0.5, 1.5), (0.4, 0.8), 0.04


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def main(folder):
    def inside(low, high, region):
        return float(low) >= region[0] - 1e-9 and float(high) <= region[1] + 1e-9

    there = [run for run in rows(folder / "runs.csv")
             if inside(run["orientation_rad"], run["orientation_rad"], ORIENTATION)
             and inside(run["speed_m_per_s"], run["speed_m_per_s"], SPEED)]
    bound = sum(run["end"] == "bound" for run in there)
    cells = [cell for cell in rows(folder / "map.csv") if int(cell["runs"])
             and inside(cell["orientation_low_rad"], cell["orientation_high_rad"], ORIENTATION)
             and inside(cell["speed_low_m_per_s"], cell["speed_high_m_per_s"], SPEED)]
    above = sum(float(cell["share_low"]) > CLAIM for cell in cells)
    below = sum(float(cell["share_high"]) < CLAIM for cell in cells)
    print(f"{bound} of {len(there)} ({bound / len(there):.1%}) match there; of {len(cells)} cells "
          f"{above} are above {CLAIM:.0%} for certain and {below} below")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
