"""Results of a few fields."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


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
