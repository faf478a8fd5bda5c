#!/usr/bin/env python3
"""How fast energies are, and how magpylib compares.

    python tests/python/bench.py
"""

import pathlib
import time

import numpy as np
import tilebind

ROOT = pathlib.Path(__file__).resolve().parents[2]


def best(work, repeats=5):
    """The shortest of a few times (s)."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    design = tilebind.Design.load(ROOT / "shapes/paper-tile.toml")
    rng = np.random.default_rng(1)
    poses = rng.uniform([-0.8, -0.8, -3.1], [0.8, 0.8, 3.1], (1_000_000, 3))
    poses = poses[design.clearance(poses) > 0.005]
    one = poses[0]
    calls = 20_000
    for model in ("dipole", "cuboid"):
        each = best(lambda: [design.energy(one, model=model) for _ in range(calls)]) / calls
        print(f"one pose, {model}: {1e6 * each:.2f} us a call")
    for model, count in (("dipole", len(poses)), ("cuboid", len(poses) // 10)):
        some = poses[:count]
        kernel = min(design._kernel_seconds(some, model) for _ in range(5))
        called = best(lambda: design.energy(some, model=model))
        print(
            f"{count} poses, {model}: {1e9 * called / count:.0f} ns a pose, "
            f"{called / kernel:.2f} times the kernel's own {1e9 * kernel / count:.0f} ns"
        )
    try:
        import magpylib
    except ImportError:
        print("magpylib: skipped, it is not installed")
        return
    some = poses[:20]
    count = 100_000
    ours = best(lambda: design.wrench(poses[:count], model="cuboid"), 3) / count
    found = design.wrench(some, model="cuboid")
    fixed, moving = design.to_magpylib(some)
    by_cells = {}
    for cells in ((2, 2, 1), (4, 4, 2), (8, 8, 4)):
        start = time.perf_counter()
        pivot = np.column_stack([some[:, :2], 0 * some[:, 0]])
        force, torque = magpylib.getFT(fixed, moving, pivot=pivot, meshing=cells)
        theirs = (time.perf_counter() - start) / len(some)
        by_cells[cells] = np.column_stack([force[:, :2], torque[:, 2]])
        off = worst(by_cells[cells], found)
        print(
            f"forces of blocks: {1e6 * ours:.2f} us a pose; magpylib's getFT with cells {cells}: "
            f"{1e3 * theirs:.1f} ms, {theirs / ours:.0f} times as long, off by {off:.1e}"
        )
    extrapolated = (4 * by_cells[8, 8, 4] - by_cells[4, 4, 2]) / 3
    print(f"getFT extrapolated from the last two: they agree to {worst(extrapolated, found):.1e}")


def worst(theirs, ours):
    """The largest difference, as a share of the force or of the torque over the tile's arm."""
    scale = np.linalg.norm(ours, axis=1, keepdims=True)
    return np.max(np.abs(theirs - ours) / scale)


if __name__ == "__main__":
    main()
