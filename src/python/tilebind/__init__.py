"""How two magnetic tiles bind: states, traps, certified energy barriers, pathways.

Everything is in SI units (m, kg, s, T, J, N, rad). A pose is ``(x, y, theta)``: the moving tile's
reference point in the fixed tile's frame and its orientation, counter-clockwise; arrays of poses
are ``(n, 3)``. Numbers among the options may be texts with a unit, as on the command line:
``"3 mJ"``. The intended contact of the tiles is the *bond*, any other stable
contact is a *trap*, and tiles far apart are *free*.

>>> import tilebind
>>> design = tilebind.Design.load("shapes/paper-tile.toml")
>>> energy = design.energy([[0.43, 0.0, 0.0], [0.43, -0.04, 0.0]])  # J
>>> analysis = design.analyse()
>>> pandas.DataFrame(analysis.states)
"""

from ._errors import DesignError
from ._magpylib import Tile
from ._results import AirTable, Barrier, LandscapeMap, Share
from ._tilebind import (
    Analysis,
    Comparison,
    Design,
    Docking,
    Search,
    Sweep,
    __version__,
    assemble,
    compare,
    crosstalk,
    dock,
    search,
    sweep,
    tolerance,
    verify,
    words,
)

# Calling the table is a method of designs.
AirTable.__call__.__doc__ = Design._on_table.__doc__

__all__ = [
    "Analysis",
    "Barrier",
    "Comparison",
    "Design",
    "DesignError",
    "Docking",
    "LandscapeMap",
    "Search",
    "Share",
    "Sweep",
    "Tile",
    "__version__",
    "assemble",
    "compare",
    "crosstalk",
    "dock",
    "search",
    "sweep",
    "tolerance",
    "verify",
    "words",
]
