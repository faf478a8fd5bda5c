"""Energies, wrenches and clearances of many poses."""

import datetime
import decimal
import fractions
import threading
import time

import numpy as np
import pytest


@pytest.fixture(scope="module")
def poses():
    rng = np.random.default_rng(1)
    return rng.uniform([-0.8, -0.8, -3.1], [0.8, 0.8, 3.1], (5000, 3))


@pytest.mark.parametrize("model", ["dipole", "cuboid"])
def test_force_is_the_slope_of_the_energy(design, model):
    step = 1e-6
    pose = np.array([0.44, 0.02, 0.05])
    sides = pose + step * np.concatenate([np.eye(3), -np.eye(3)])
    energy = design.energy(sides, model=model)
    slope = (energy[:3] - energy[3:]) / (2 * step)
    assert np.allclose(design.wrench(pose, model=model), -slope, rtol=1e-5, atol=1e-9)


def test_arrays_of_any_shape_and_kind(design, poses):
    energy = design.energy(poses)
    assert energy.shape == (5000,) and energy.dtype == np.float64
    # On threads, by fewer and one by one.
    assert np.array_equal(design.energy(poses[:100]), energy[:100])
    assert [design.energy(pose) for pose in poses[:5]] == energy[:5].tolist()
    assert design.energy(poses.reshape(50, 100, 3)).shape == (50, 100)
    assert design.wrench(poses.reshape(50, 100, 3)).shape == (50, 100, 3)
    assert design.wrench(poses[0]).shape == (3,)
    assert np.array_equal(design.energy(np.asfortranarray(poses)), energy)
    assert np.array_equal(design.energy(poses[::7]), energy[::7])
    assert design.energy([[1, 0, 0]]) == design.energy(np.array([[1, 0, 0]], dtype=np.int32))
    assert isinstance(design.energy([0.43, 0, 0]), float)
    assert isinstance(design.is_free([0.43, 0, 0]), bool)
    assert design.energy(np.empty((0, 3))).shape == (0,)
    for wrong in ([1, 2], np.zeros((2, 4)), 3.0):
        with pytest.raises(ValueError, match=r"\(n, 3\)"):
            design.energy(wrong)
    with pytest.raises((TypeError, ValueError)):
        design.energy("pose")
    with pytest.raises(ValueError, match="dipole"):
        design.energy(poses, model="quadrupole")


def test_what_is_not_finite_is_not_known(design):
    poses = np.array([[0.43, 0, 0], [np.nan, 0, 0], [0, np.inf, 0], [0.5, 0, 0]])
    for found in (design.energy(poses), design.clearance(poses), design.wrench(poses)[:, 0]):
        assert np.isnan(found).tolist() == [False, True, True, False]
    assert design.is_free(poses).tolist() == [True, False, False, True]
    assert abs(design.energy([1e30, 0, 0])) < 1e-100 and np.isnan(design.energy([1e300, 0, 0]))


def test_rows_that_no_memory_holds_are_refused(design):
    """One row may stand for any number of them."""
    for count in (10**10, 10**14):
        with pytest.raises(MemoryError, match="GB"):
            design.energy(np.broadcast_to([0.5, 0.0, 0.0], (count, 3)))
    with pytest.raises(MemoryError):
        design.is_free(np.broadcast_to([0.5, 0.0, 0.0], (10**12, 3)))


def test_clearances_tell_what_is_free(design, poses):
    clearance, free = design.clearance(poses), design.is_free(poses)
    assert free.dtype == bool and np.array_equal(free, clearance >= 0)
    assert 0.2 < free.mean() < 0.8
    assert design.clearance(design.bound) == 0.0
    assert design.clearance([0.44, 0, 0]) == pytest.approx(0.01)


def test_the_lock_is_released(design):
    poses = np.tile([0.5, 0.1, 0.2], (20_000, 1))
    worker = threading.Thread(target=lambda: design.energy(poses, model="cuboid"))
    worker.start()
    turns = 0
    while worker.is_alive():
        turns += 1
        time.sleep(0.0005)
    # With the lock held, the loop would turn once.
    assert turns > 3


@pytest.mark.parametrize(
    "poses",
    [
        "0.43,0,0",
        b"abc",
        bytearray(b"abc"),
        ["0.43", "0", "0"],
        np.array([b"0.43", b"0", b"0"]),
        np.ma.masked_all((2, 3)),
        np.ma.array([[0.43, 0, 0]], mask=[[False, True, False]]),
        np.array([[0.43, None, 0]], dtype=object),
        np.array([[0.43, "0", 0]], dtype=object),
        np.array(["2020", "2021", "2022"], dtype="datetime64[s]"),
        np.zeros((1, 3), dtype="timedelta64[s]"),
        [datetime.datetime(2020, 1, 1), 0, 0],
        np.zeros((1, 3), dtype=bool),
        [[True, 0, 0]],
        ([0.43, np.True_, 0.0],),
        [0.43, np.array(False), 0],
        [[np.ma.masked, 0, 0]],
        [np.ma.array([0.43, 0, 0], mask=[True, False, False])],
        memoryview(b"abc"),
        [[b"1", 0, 0]],
        [0.43 + 0j, 0, 0],
        np.array([(0.43, 0, 0)], dtype=[("x", "f8"), ("y", "f8"), ("theta", "f8")]),
        {0.43, 0, 0},
        {0: 0.43},
        (x for x in [0.43, 0, 0]),
    ],
)
def test_what_holds_no_numbers_are_no_poses(design, poses):
    for method in (design.energy, design.wrench, design.clearance, design.is_free, design.barrier):
        with pytest.raises(ValueError, match="are no poses"):
            method(poses)


def test_lists_without_an_end_are_refused(design):
    endless = []
    endless.append(endless)
    with pytest.raises(ValueError, match="levels"):
        design.energy(endless)


@pytest.mark.parametrize("poses", [[[10**400, 0, 0]], [[0.43, 0, 0], [1, 2]]])
def test_numbers_that_form_no_poses_are_refused_in_our_words(design, poses):
    with pytest.raises(ValueError, match="poses are an array"):
        design.energy(poses)


def test_all_kinds_of_numbers_are_accepted(design):
    energy = design.energy([0.5, 0, 0])
    for half in (decimal.Decimal("0.5"), fractions.Fraction(1, 2), np.float32(0.5), np.longdouble(0.5)):
        assert design.energy([half, 0, 0]) == energy
    assert design.energy(np.array([0.5, 0, 0], dtype=">f8")) == energy


def test_arrays_that_can_be_masked_but_are_not(design):
    assert design.energy(np.ma.array([0.43, 0, 0])) == design.energy([0.43, 0, 0])


def test_poses_that_overlap_slightly_are_moved_out(design):
    with pytest.warns(RuntimeWarning, match="out to contact"):
        design.barrier([0.43, 0, 1.5708], certify_work=0, milestones=500)
