"""Results of a few fields."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class AirTable(tuple):  # type: ignore[type-arg]
    """Size of the air table (m) along x and along y; called, it has many tiles put on it."""

    def __new__(cls, size, put):
        table = super().__new__(cls, size)
        table._put = put
        return table

    def __call__(self, time, **settings):
        """Many tiles on one table, with contact, friction and drives, and what they hold.

        Parameters
        ----------
        time : float
            How long each run lasts (s).
        count : sequence of int, optional
            Tiles of the fixed tile's kind and of the moving one's, at random places.
        start : str or os.PathLike, optional
            In place of `count`: a CSV file of the tiles at the start, with the columns `tile`, `kind`
            ("fixed" or "moving"), `x`, `y`, `theta`, `vx`, `vy`, `omega` (m, rad, m/s, rad/s).
        runs : int, optional
        shard : str, optional
            "i/n": make every n-th run only, from the i-th.
        shaking : float, optional
            Effective energy kT (J) of shaking.
        correlation : float, optional
            Its correlation time (s): that between two random kicks.
        orbital : tuple of float, optional
            The table goes round in a circle: radius (m) and rounds a second (Hz).
        drag, friction, restitution : float, optional
            Drag rate (1/s), Coulomb's coefficient, share of the approach velocity that a knock gives
            back.
        fan : sequence, optional
            Of (x, y, energy, width) in m, m, J and m, and perhaps the share by which it swings and
            how often a second.
        step : float, optional
            Longest step (s).
        frames : float, optional
            Time (s) between two moments whose places are kept.
        compare : bool, optional
            Set what `yields` says of as many tiles at this kT beside it.
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
    """One barrier: the lowest possible value of the highest energy on the way."""

    lower: float | None
    """Every free way reaches at least this energy (J); None where nothing is proved."""
    upper: float | None
    """A free way is known that nowhere exceeds this energy (J)."""
    path: np.ndarray
    """The best way found, structured: s_m, x_m, y_m, theta_rad, energy_J, clearance_m."""
    saddle_energy: float
    """Highest energy on it (J); infinite where no way is known."""
    saddle_pose: np.ndarray
    """Where that is, (3,) in m, m and rad."""
    forward: float
    """Saddle less the energy of the start (J)."""
    reverse: float
    """Saddle less the energy of the end (J)."""
    caged: bool
    """Proved that there is no free way at all."""
    uncertified: str | None
    """Why there are no bounds, where there are none."""
    ended_by: str | None
    """What ended the narrowing before it was done: "work" or "clock"."""


class LandscapeMap(NamedTuple):
    """The lowest energy over the orientation at each place about the fixed tile."""

    x: np.ndarray
    """(columns,) in m."""
    y: np.ndarray
    """(rows,) in m."""
    energy: np.ndarray
    """(rows, columns) in J; NaN where no orientation is free."""
    theta: np.ndarray
    """(rows, columns) in rad: the orientation of that energy."""


class Share(NamedTuple):
    """A share that was counted, with its 95 % interval."""

    value: float
    """From 0 to 1."""
    low: float
    """Lower end of the interval."""
    high: float
    """Upper end of the interval."""
    count: int
    """How many were counted."""
    of: int
    """Of how many."""
