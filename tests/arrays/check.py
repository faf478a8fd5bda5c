#!/usr/bin/env python3
"""Reads what `tilebind analyse --arrays` writes with NumPy and holds it against report.json.

    tests/arrays/check.py target/release/tilebind

Skips with a line where NumPy is missing.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("arrays: skipped, this Python has no numpy")
    sys.exit(0)

DESIGN = "shapes/tab-20mm.toml"


def close(a, b):
    assert np.allclose(a, b, rtol=1e-12, atol=1e-15, equal_nan=True), (a, b)


def pose(table):
    return np.stack([table["x_m"], table["y_m"], table["theta_rad"]], axis=-1)


def check(folder):
    report = json.loads((folder / "report.json").read_text())
    array = lambda name: np.load(folder / "arrays" / f"{name}.npy")

    states = array("states")
    close(pose(states), [state["pose"] for state in report["states"]])
    close(states["energy_J"], [state["energy_J"] for state in report["states"]])

    milestones, edges = array("milestones"), array("edges")
    assert len(milestones) == report["counts"]["milestones"]
    assert len(edges) == report["counts"]["edges"]
    for end in ("from", "to"):
        assert edges[end].min() >= 0 and edges[end].max() < len(milestones)
        # A way is nowhere lower than at its highest.
        assert np.all(edges["peak_J"] >= milestones["energy_J"][edges[end]] - 1e-15)
    # Work there and back differs by the energy between the ends.
    climb = milestones["energy_J"][edges["to"]] - milestones["energy_J"][edges["from"]]
    close(edges["work_forwards_J"] - edges["work_backwards_J"], climb)

    shape = tuple(len(array(f"around_{axis}")) for axis in ("theta_rad", "y_m", "x_m"))
    energy = array("around_energy_J")
    assert energy.shape == shape and energy.dtype == np.float64
    # Overlapping tiles have no energy, and the map is no deeper than the deepest state.
    middle = energy[:, shape[1] // 2, shape[2] // 2]
    assert np.isnan(middle).all()
    assert np.nanmin(energy) >= states["energy_J"].min() - 1e-12
    front = array("front_energy_J")
    assert front.shape == tuple(len(array(f"front_{a}")) for a in ("gap_m", "tilt_rad", "slide_m"))
    assert array("front_landing_m").shape == front.shape[1:]

    barriers = array("barriers")
    assert set(barriers["to"]) <= set(states["id"]) | {-1}
    lower, upper = barriers["lower_J"], barriers["upper_J"]
    known = ~np.isnan(lower)
    assert known.any() and np.all(lower[known] <= upper[known])

    minima = np.loadtxt(folder / "topsearch" / "min.data")
    saddles = np.loadtxt(folder / "topsearch" / "ts.data", ndmin=2)
    assert list(minima[:, 0]) == list(range(len(minima)))
    assert np.all(np.diff(minima[:, 1]) >= 0) and minima[-1, 1] == 0
    for i, j, energy in saddles:
        assert energy >= max(minima[int(i), 1], minima[int(j), 1])


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        quick = ["--milestones", "2000", "--far-starts", "50", "--quiet"]
        subprocess.run([program, "analyse", DESIGN, "--out", folder, "--arrays", *quick], check=True)
        check(folder)
        subprocess.run([program, "analyse", DESIGN, "--out", folder, *quick], check=True)
        assert not (folder / "arrays").exists(), "an earlier analysis's arrays are left"
    print("arrays: NumPy reads what analyse --arrays writes")


main(sys.argv[1])
