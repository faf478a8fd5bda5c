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
        return self._put(time, **settings)

    def __reduce__(self):
        return tuple, (tuple(self),)


def _described(**texts):
    """Gives the fields of a named tuple their documentation."""

    def describe(cls):
        for name, text in texts.items():
            getattr(cls, name).__doc__ = text
        return cls

    return describe


@_described(
    lower="Every collision-free path reaches at least this energy (J); None if nothing is proved.",
    upper="A collision-free path is known that never exceeds this energy (J).",
    path="The best path found, structured: s_m, x_m, y_m, theta_rad, energy_J, clearance_m.",
    saddle_energy="Highest energy on it (J); infinite if no path is known.",
    saddle_pose="The pose of that energy, (3,) in m, m and rad.",
    forward="Saddle energy minus the energy of the start (J).",
    reverse="Saddle energy minus the energy of the end (J).",
    caged="Whether it is proved that there is no collision-free path.",
    uncertified="Why there are no bounds; None if there are.",
    ended_by='What ended the bounds before they reached the target width: "work" or "clock".',
)
class Barrier(NamedTuple):
    """One barrier: the lowest maximum energy over all collision-free paths."""

    lower: float | None
    upper: float | None
    path: np.ndarray
    saddle_energy: float
    saddle_pose: np.ndarray
    forward: float
    reverse: float
    caged: bool
    uncertified: str | None
    ended_by: str | None


@_described(
    x="(columns,) in m.",
    y="(rows,) in m.",
    energy="(rows, columns) in J; NaN where the tiles overlap in every orientation.",
    theta="(rows, columns) in rad: the orientation of that energy.",
)
class LandscapeMap(NamedTuple):
    """The lowest energy over all orientations at each position around the fixed tile."""

    x: np.ndarray
    y: np.ndarray
    energy: np.ndarray
    theta: np.ndarray


@_described(
    value="From 0 to 1.",
    low="Lower end of the interval.",
    high="Upper end of the interval.",
    count="Number of hits.",
    of="Number of trials.",
)
class Share(NamedTuple):
    """A counted fraction with its 95 % interval."""

    value: float
    low: float
    high: float
    count: int
    of: int
