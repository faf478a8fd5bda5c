"""The bridge to magpylib: the same magnets feel the same forces."""

import numpy as np
import pytest
import tilebind

magpylib = pytest.importorskip("magpylib", minversion="6")


def wrench(fixed, moving, pivot, cells=(6, 6, 2)):
    """Force (N) and torque (N m) by magpylib, its midpoint sums extrapolated to fine cells."""
    coarse, fine = (
        magpylib.getFT(fixed, moving, pivot=pivot, meshing=tuple(k * n for n in cells))
        for k in (1, 2)
    )
    force, torque = ((4 * f - c) / 3 for f, c in zip(fine, coarse))
    return np.array([*force[:2], torque[2]])


@pytest.mark.parametrize("pose", [(0.45, 0.0, 0.0), (0.46, -0.03, 0.1), (-0.02, 0.47, 1.6)])
def test_forces_agree(design, pose):
    theirs = wrench(*design.to_magpylib(pose), pivot=(*pose[:2], 0))
    ours = design.wrench(pose, model="cuboid")
    assert np.allclose(ours, theirs, rtol=0, atol=1e-5 * np.linalg.norm(theirs))


def test_paths_are_those_of_the_poses(tab):
    poses = np.array([[0.45, 0.0, 0.0], [0.5, 0.1, 0.4], [0.6, -0.1, -2.0]])
    fixed, moving = tab.to_magpylib(poses)
    assert len(fixed.children) == len(tab.magnets("fixed")) == 4
    assert np.allclose(moving.position[:, :2], poses[:, :2])
    magnet, known = moving.children[0], tab.magnets("moving")[0]
    for place, turn, (x, y, theta) in zip(magnet.position, magnet.orientation, poses):
        turned = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
        assert np.allclose(place[:2], [x, y] + turned @ [known["x_m"], known["y_m"]])
        angle = turn.as_euler("zyx")[0] - theta - known["angle_rad"]
        assert np.isclose(np.cos(angle), 1)


@pytest.mark.parametrize("name", ["paper-tile", "halbach", "hexagon", "arrowhead"])
def test_there_and_back(root, name):
    design = tilebind.Design.load(root / f"shapes/{name}.toml")
    tables = design.to_dict()
    bodies = {}
    for which, magnets in zip(("fixed", "moving"), design.to_magpylib([0, 0, 0])):
        tile = tables[which]
        given = {key: tile[key] for key in ("side", "sides", "vertices") if key in tile}
        body = {"thickness": tile["thickness"], "mass": tile["mass"], **given}
        bodies[which] = tilebind.Tile.from_magpylib(magnets, **body)
    again = tilebind.Design.from_dict({**tables, **bodies})
    rng = np.random.default_rng(2)
    poses = rng.uniform([-1, -1, -3], [1, 1, 3], (50, 3))
    depth = abs(design.energy(design.bound))
    assert np.allclose(again.energy(poses), design.energy(poses), rtol=1e-9, atol=1e-12 * depth)
    assert again.energy(design.bound) == pytest.approx(design.energy(design.bound), rel=1e-9)


def test_what_is_no_tile_is_refused():
    block = magpylib.magnet.Cuboid(dimension=(0.01, 0.01, 0.003), polarization=(0, 0, 1))
    body = {"side": 0.1, "thickness": 0.01, "mass": 0.1}
    with pytest.raises(ValueError, match="in the plane"):
        tilebind.Tile.from_magpylib([block], **body)
    block = magpylib.magnet.Cuboid((0.01, 0, 0.1), dimension=(0.01, 0.01, 0.003), polarization=(1, 0, 0))
    with pytest.raises(ValueError, match="z = 0"):
        tilebind.Tile.from_magpylib([block], **body)
    with pytest.raises(ValueError, match="side or vertices"):
        tilebind.Tile.from_magpylib([], thickness=0.01, mass=0.1)
    tile = tilebind.Tile.from_magpylib([], **body)
    with pytest.raises(AttributeError):
        tile.mass = 2
