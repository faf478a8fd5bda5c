"""The script for HOOMD-blue: what it makes of outlines and magnets."""

import importlib.util
import pathlib
import sys
import types

import numpy as np
import pytest

SCRIPT = pathlib.Path(__file__).parents[2] / "src/report/hoomd_table.py"
# A slot of 20 x 20 mm in a square of 0.2 m.
SLOTTED = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [0.01, 0.1], [0.01, 0.08], [-0.01, 0.08], [-0.01, 0.1],
           [-0.1, 0.1]]
BLOCK = {"position": [0.02, 0.09], "angle": 0.3, "moment": 0.286, "size": [0.01, 0.012, 0.003], "up": 0, "face": 2}


@pytest.fixture
def script(monkeypatch):
    gsd = types.ModuleType("gsd")
    gsd.hoomd = types.ModuleType("gsd.hoomd")
    for name, module in {"gsd": gsd, "gsd.hoomd": gsd.hoomd, "hoomd": types.ModuleType("hoomd")}.items():
        monkeypatch.setitem(sys.modules, name, module)
    spec = importlib.util.spec_from_file_location("hoomd_script", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_discs_touch_the_outline_from_inside(script):
    outline, diameter = np.array(SLOTTED), 0.004
    discs = script.discs(outline, diameter)
    edges = list(zip(outline, np.roll(outline, -1, axis=0)))
    depths = np.min([script.distance(discs, *edge) for edge in edges], axis=0)
    assert np.allclose(depths, diameter / 2)
    # Inside: the square, but not the slot.
    x, y = discs.T
    assert np.all((abs(x) < 0.1) & (abs(y) < 0.1) & ~((abs(x) < 0.01) & (y > 0.08)))
    # No gap is wider than a disc, so that no corner enters.
    for start, end in edges:
        for share in np.linspace(0.0, 1.0, 101):
            nearest = np.min(np.linalg.norm(discs - (start + share * (end - start)), axis=1))
            assert nearest < 0.75 * diameter


@pytest.mark.parametrize("model, count", [("dipole", 1), ("cuboid", 12)])
def test_dipoles_have_the_moment_of_their_magnet(script, model, count):
    places, angle, moment = script.dipoles(BLOCK, model)
    assert len(places) == count and angle == BLOCK["angle"]
    assert moment * count == pytest.approx(BLOCK["moment"])
    assert np.mean(places, axis=0) == pytest.approx(BLOCK["position"])


def test_a_tile_that_bonds_does_not_pass_through_discs(script):
    kinds = [{"mass": 0.1, "magnets": [BLOCK] * 4}]
    diameter = 0.004
    energy = 4 * 2e-7 * BLOCK["moment"] ** 2 / 0.01**3
    assert 0.5 * script.spring(kinds, diameter, 3e-3) * (0.5 * diameter) ** 2 == pytest.approx(energy)
    assert script.spring(kinds, diameter, 1e3) > script.spring(kinds, diameter, None)
