"""Results of a few fields."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class AirTable(tuple):  # type: ignore[type-arg]
    """Size of the air table (m) along x and y. Call it to simulate many tiles."""

    def __new__(cls, size, put):
        table = super().__new__(cls, size)
        table._put = put
        return table

    def __call__(self, time, **settings):
        """Simulate many tiles on one table, with contact, friction and drives; count bonds and traps.

        Parameters
        ----------
        time : float
            Duration of each run (s).
        count : sequence of int, optional
            Numbers of tiles of the fixed and of the moving kind, at random positions.
        start : str or os.PathLike, optional
            Instead of `count`: a CSV file of the initial tiles, with the columns `tile`, `kind`
            ("fixed" or "moving"), `x`, `y`, `theta`, `vx`, `vy`, `omega` (m, rad, m/s, rad/s).
        runs : int, optional
        shard : str, optional
            "i/n": compute only every nth run, from the ith on.
        shaking : float, optional
            Effective energy kT (J) of shaking.
        correlation : float, optional
            Time between random kicks of the shaking (s).
        orbital : tuple of float, optional
            Move the table in a circle: radius (m) and revolutions per second (Hz).
        drag, friction, restitution : float, optional
            Drag rate (1/s), coefficient of friction, coefficient of restitution.
        fan : sequence, optional
            (x, y, energy, width) in m, m, J and m, optionally followed by relative amplitude
            and frequency (Hz).
        step : float, optional
            Longest step (s).
        frames : float, optional
            Interval (s) at which poses are recorded.
        compare : bool, optional
            Compare with the predictions of `bond` and `yields`.
        seed : int, optional
        progress : bool, optional

        Returns
        -------
        dict
            As ``tilebind table --json``.
        """
        return self._put(time, **settings)

    def __reduce__(self):
        return tuple, (tuple(self),)


class Barrier(NamedTuple):
    """One barrier: the lowest maximum energy over all collision-free paths."""

    lower: float | None
    """Every collision-free path reaches at least this energy (J); None if nothing is proved."""
    upper: float | None
    """A collision-free path is known that never exceeds this energy (J)."""
    path: np.ndarray
    """The best path found, structured: s_m, x_m, y_m, theta_rad, energy_J, clearance_m."""
    saddle_energy: float
    """Highest energy on it (J); infinite if no path is known."""
    saddle_pose: np.ndarray
    """The pose of that energy, (3,) in m, m and rad."""
    forward: float
    """Saddle energy minus the energy of the start (J)."""
    reverse: float
    """Saddle energy minus the energy of the end (J)."""
    caged: bool
    """Whether it is proved that there is no collision-free path."""
    uncertified: str | None
    """Why there are no bounds; None if there are."""
    ended_by: str | None
    """What ended the bounds before they reached the target width: "work" or "clock"."""


class LandscapeMap(NamedTuple):
    """The lowest energy over all orientations at each position around the fixed tile."""

    x: np.ndarray
    """(columns,) in m."""
    y: np.ndarray
    """(rows,) in m."""
    energy: np.ndarray
    """(rows, columns) in J; NaN where the tiles overlap in every orientation."""
    theta: np.ndarray
    """(rows, columns) in rad: the orientation of that energy."""


class Share(NamedTuple):
    """A counted fraction with its 95 % interval."""

    value: float
    """From 0 to 1."""
    low: float
    """Lower end of the interval."""
    high: float
    """Upper end of the interval."""
    count: int
    """Number of hits."""
    of: int
    """Number of trials."""
