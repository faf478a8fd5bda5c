from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import Barrier, LandscapeMap, Share

__version__: str

_Model = Literal["dipole", "cuboid"]
_TileName = Literal["fixed", "moving"]
_Place = int | np.integer[Any] | str
_Picture = Literal[
    "map", "approach", "profiles", "docking", "models", "disconnectivity", "disconnectivity-linear"
]
_Floats = NDArray[np.float64]
# Structured: its fields are described where it is returned.
_Table = NDArray[np.void]
_Value = float | str | bool | Sequence[Any] | Mapping[str, Any]

@type_check_only
class _AirTable(tuple[float, float]):
    def __call__(
        self,
        time: float,
        *,
        count: int | Sequence[int] | None = None,
        runs: int = 1,
        shard: str | None = None,
        shaking: float | str | None = None,
        correlation: float | str | None = None,
        orbital: Sequence[float | str] | str | None = None,
        linear: Sequence[float | str] | str | None = None,
        table_friction: float | str = 0,
        drag: float | str = 0.005,
        friction: float | str = 0.3,
        restitution: float | str = 0.01,
        fan: Sequence[float | str] | str | Sequence[Sequence[float | str] | str] | None = None,
        step: float | str | None = None,
        frames: float | str | None = None,
        target: str | None = None,
        compare: bool = False,
        seed: int = 1,
        start: str | PathLike[str] | None = None,
        progress: bool | None = None,
    ) -> dict[str, Any]: ...

@final
class Design:
    @staticmethod
    def load(path: str | PathLike[str]) -> Design: ...
    @staticmethod
    def loads(text: str, *, file: str = "design.toml") -> Design: ...
    @staticmethod
    def from_dict(tables: Mapping[str, Any]) -> Design: ...
    @staticmethod
    def start(
        name: str = "starter",
        *,
        sides: int | None = None,
        side: float | str | None = None,
        magnets: int | None = None,
        shape: Literal["flat", "tab", "arc", "sine", "triangle"] | None = None,
        magnet: str | None = None,
        thickness: float | str | None = None,
        material: str | None = None,
        one_kind: bool = False,
    ) -> Design: ...
    def replace(self, key: str, value: _Value) -> Design: ...
    def to_dict(self) -> dict[str, Any]: ...
    @property
    def text(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def model(self) -> _Model: ...
    @property
    def warnings(self) -> tuple[str, ...]: ...
    @property
    def bound(self) -> _Floats: ...
    @property
    def table(self) -> _AirTable: ...
    def outline(self, tile: _TileName) -> _Floats: ...
    def magnets(self, tile: _TileName) -> _Table: ...
    def energy(self, poses: ArrayLike, *, model: _Model | None = None) -> Any: ...
    def wrench(self, poses: ArrayLike, *, model: _Model | None = None) -> _Floats: ...
    def clearance(self, poses: ArrayLike) -> Any: ...
    def is_free(self, poses: ArrayLike) -> Any: ...
    def analyse(
        self,
        *,
        milestones: int | None = None,
        neighbours: int | None = None,
        settled: float | str = 0.005,
        far_starts: int | None = None,
        kinds: int | None = None,
        dynamics_runs: int | bool = 0,
        repeats: int = 1,
        boltzmann: float | str | None = None,
        thermal_energy: float | str | None = None,
        tolerance: float | str | None = None,
        certify_work: float | str | None = None,
        certify_seconds: float | str | None = None,
        certify_cells: int = 1000000,
        quick: bool = False,
        complete_work: float | str | None = None,
        complete_seconds: float | str | None = None,
        complete_below: float | str = 0.01,
        complete_escape: float | str = 0.005,
        complete_cells: int = 4000000,
        seed: int = 1,
        progress: bool | None = None,
    ) -> Analysis: ...
    def barrier(
        self,
        start: ArrayLike,
        end: ArrayLike | Literal["free"] | None = None,
        *,
        tolerance: float | str | None = None,
        certify_work: float | str | None = None,
        certify_seconds: float | str | None = None,
        milestones: int | None = None,
        seed: int = 1,
        progress: bool | None = None,
    ) -> Barrier: ...
    def dock(
        self,
        *,
        runs: int = 2000,
        duration: float | str = 5,
        drag: float | str = 0.005,
        friction: float | str = 0.3,
        restitution: float | str = 0.01,
        fan: Sequence[float | str] | str | Sequence[Sequence[float | str] | str] | None = None,
        threshold: float | str | None = None,
        distance: Sequence[float | str] | str | None = None,
        direction: float | str | None = None,
        orientation: float | str | None = None,
        speed: Sequence[float | str] | str | None = None,
        aim: float | str | None = None,
        spin: float | str | None = None,
        no_walls: bool = False,
        shaking: float | str | None = None,
        seed: int = 1,
        progress: bool | None = None,
    ) -> Docking: ...
    def matches(self, most: int = 100) -> _Table: ...
    def exits(
        self,
        start: ArrayLike,
        *,
        kt: float | str,
        drag: float | str = 50,
        basin_energy: float | str | None = None,
        free_at: float | str | None = None,
        check: int | None = None,
        restitution: float | str = 1,
        seed: int = 1,
    ) -> dict[str, Any]: ...
    def yields(
        self,
        kt: Sequence[float],
        *,
        tiles: int,
        time: float | str,
        coverage: float | str = 0.3,
        runs: int = 400,
        attachments: int = 0,
        duration: float | str = 10,
        rates: Literal["docking", "overdamped"] = "docking",
        drag: float | str | None = None,
        friction: float | str = 0.3,
        restitution: float | str = 0.01,
        simulations: int = 1000,
        seed: int = 1,
        progress: bool | None = None,
    ) -> dict[str, Any]: ...
    def make(
        self,
        *,
        kerf: float | str = 0,
        clearance: float | str = "0.1 mm",
        copies: int | None = None,
        count: int | Sequence[int] | str | None = None,
        sheet: str | None = None,
        spacing: float | str = "2 mm",
        layers: Sequence[float | str] | str | None = None,
    ) -> dict[str, bytes]: ...
    def calibrate(
        self,
        table: Any,
        *,
        hold_out: int | None = None,
    ) -> dict[str, Any]: ...
    def calibrate_gaps(self, table: Any) -> dict[str, Any]: ...
    def calibrate_bonds(
        self,
        table: Any,
        *,
        area: float | str | None = None,
        within: float | str | None = None,
    ) -> dict[str, Any]: ...
    def releases(
        self,
        *,
        shaking: float,
        overdamped: bool = False,
        progress: bool | None = None,
        **settings: Any,
    ) -> dict[str, Any]: ...
    def summary(self) -> str: ...
    def show(self) -> dict[str, Any]: ...
    def svg(self) -> str: ...
    def to_magpylib(self, poses: ArrayLike | None = None) -> tuple[Any, Any]: ...

@final
class Analysis:
    @property
    def design(self) -> Design: ...
    @property
    def states(self) -> _Table: ...
    @property
    def barriers(self) -> _Table: ...
    @property
    def bound(self) -> _Floats: ...
    @property
    def bound_energy(self) -> float: ...
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def inventory(self) -> dict[str, Any]: ...
    def pathway(self, start: _Place, end: _Place | None = None) -> _Table: ...
    def landscape_map(self, samples: int = 160, orientations: int = 48) -> LandscapeMap: ...
    def rates(
        self,
        kt: float,
        *,
        drag: float | str = 50,
        basin_energy: float | str | None = None,
        free_at: float | str | None = None,
        traps: int = 3,
    ) -> dict[str, Any]: ...
    def bond(
        self,
        kt: float | str,
        coverage: float | str,
    ) -> dict[str, Any]: ...
    def disconnectivity(self) -> _Table: ...
    def svg(self, name: _Picture) -> str: ...
    def summary(self) -> str: ...
    def report_html(self) -> str: ...
    def report_json(self) -> str: ...
    def write(
        self,
        folder: str | PathLike[str],
        *,
        compact: bool = False,
        command: str | None = None,
        force: bool = False,
    ) -> None: ...
    def plot_map(self, ax: Any = None, **style: Any) -> Any: ...
    def plot_profile(
        self, start: _Place | None = None, end: _Place | None = None, ax: Any = None, **style: Any
    ) -> Any: ...
    def plot_disconnectivity(self, ax: Any = None, **style: Any) -> Any: ...
    def _repr_html_(self) -> str: ...

@final
class Comparison:
    @property
    def table(self) -> _Table: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def summary(self) -> str: ...
    def markdown(self) -> str: ...
    def svg(self) -> str: ...
    def report_html(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Sweep:
    @property
    def table(self) -> _Table: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def design(self, index: int) -> Design: ...
    def summary(self) -> str: ...
    def svg(self) -> list[str]: ...
    def report_html(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Search:
    @property
    def best(self) -> Design | None: ...
    @property
    def front(self) -> list[int]: ...
    @property
    def table(self) -> _Table: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def design(self, index: int) -> Design: ...
    def summary(self) -> str: ...
    def svg(self) -> list[str]: ...
    def report_html(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Docking:
    @property
    def bound(self) -> Share: ...
    @property
    def trapped(self) -> Share: ...
    @property
    def free(self) -> Share: ...
    @property
    def runs(self) -> _Table: ...
    @property
    def traps(self) -> _Table: ...
    @property
    def chances(self) -> _Table: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def trajectory(self, index: int, *, interval: float = 0.02) -> _Table: ...
    def summary(self) -> str: ...
    def svg(self) -> str: ...
    def __len__(self) -> int: ...

def compare(
    designs: Sequence[Design],
    *,
    milestones: int | None = None,
    neighbours: int | None = None,
    settled: float | str = 0.005,
    far_starts: int | None = None,
    kinds: int | None = None,
    tolerance: float | str | None = None,
    certify_cells: int | None = None,
    complete_cells: int | None = None,
    dynamics_runs: int | bool = 0,
    strength: float | str | None = None,
    place: float | str | None = None,
    turn: float | str | None = None,
    gap: float | str | None = None,
    flip: float | str | None = None,
    batch: float | str | None = None,
    draws: int | None = None,
    selectivity: float | str | None = None,
    seed: int = 1,
    by: str = "selectivity",
    progress: bool | None = None,
) -> Comparison: ...
def sweep(
    design: Design,
    vary: Mapping[str, Iterable[float | str | bool]],
    *,
    refine: int | None = None,
    baseline: str | None = None,
    milestones: int | None = None,
    neighbours: int | None = None,
    settled: float | str = 0.005,
    far_starts: int | None = None,
    kinds: int | None = None,
    tolerance: float | str | None = None,
    certify_cells: int | None = None,
    complete_cells: int | None = None,
    dynamics_runs: int | bool = 0,
    strength: float | str | None = None,
    place: float | str | None = None,
    turn: float | str | None = None,
    gap: float | str | None = None,
    flip: float | str | None = None,
    batch: float | str | None = None,
    draws: int | None = None,
    selectivity: float | str | None = None,
    seed: int = 1,
    progress: bool | None = None,
) -> Sweep: ...
def search(
    designs: Design | Sequence[Design],
    vary: Mapping[str, str | Iterable[float | str | bool]],
    *,
    maximise: str | Sequence[str] | None = None,
    minimise: str | Sequence[str] | None = None,
    subject: str | Sequence[str] | None = None,
    points: int | None = None,
    milestones: int | None = None,
    neighbours: int | None = None,
    settled: float | str = 0.005,
    far_starts: int | None = None,
    kinds: int | None = None,
    tolerance: float | str | None = None,
    certify_cells: int | None = None,
    complete_cells: int | None = None,
    dynamics_runs: int | bool = 0,
    strength: float | str | None = None,
    place: float | str | None = None,
    turn: float | str | None = None,
    gap: float | str | None = None,
    flip: float | str | None = None,
    batch: float | str | None = None,
    draws: int | None = None,
    selectivity: float | str | None = None,
    seed: int = 1,
    progress: bool | None = None,
) -> Search: ...
def dock(
    design: Design,
    *,
    runs: int = 2000,
    duration: float | str = 5,
    drag: float | str = 0.005,
    friction: float | str = 0.3,
    restitution: float | str = 0.01,
    fan: Sequence[float | str] | str | Sequence[Sequence[float | str] | str] | None = None,
    threshold: float | str | None = None,
    distance: Sequence[float | str] | str | None = None,
    direction: float | str | None = None,
    orientation: float | str | None = None,
    speed: Sequence[float | str] | str | None = None,
    aim: float | str | None = None,
    spin: float | str | None = None,
    no_walls: bool = False,
    shaking: float | str | None = None,
    seed: int = 1,
    progress: bool | None = None,
) -> Docking: ...
def words(
    length: int | None = None,
    *,
    gap: float | str | None = None,
    count: int | None = None,
    contacts: int | None = None,
    self: bool = False,
    faces: Literal["all", "mates"] = "all",
    shape: Literal["none", "shared", "polar"] = "none",
    flip: bool = False,
    slots: int | None = None,
    magnets: int | None = None,
    continuous: bool = False,
    face: float | str | None = None,
    tolerate: Literal["missing=1", "flipped=1", "missing", "flipped"] | None = None,
    pitch: float | str | None = None,
    balanced: bool = False,
    max_run: int | None = None,
    min_mismatch: Sequence[int] | str | None = None,
    consecutive: Sequence[int] | str | None = None,
    min_bond: float | str | None = None,
    word_word: Sequence[float | str] | str | None = None,
    word_mate: Sequence[float | str] | str | None = None,
    mate_mate: Sequence[float | str] | str | None = None,
    model: Literal["dipole", "cuboid"] | None = None,
    seconds: float | str = 20,
    seed: int = 1,
    design: Design | None = None,
    progress: bool | None = None,
) -> dict[str, Any]: ...
def crosstalk(
    words: Sequence[str] | Mapping[str, Any],
    *,
    certify: float | str | bool | None = None,
    certify_cells: int = 8000000,
    model: Literal["dipole", "cuboid"] | None = None,
    progress: bool | None = None,
) -> dict[str, Any]: ...
def assemble(
    tiles: str | PathLike[str],
    words: Sequence[str] | Mapping[str, Any] | None = None,
    *,
    kt: float | str | None = None,
    coverage: float | str = 0.3,
    lattice: Sequence[int] | str | None = None,
    side: int | None = None,
    proofread: int = 1,
    length: int | None = None,
    magnets: int | None = None,
    gap: float | str | None = None,
    shape: Literal["none", "shared", "polar"] = "none",
    pitch: float | str | None = None,
    model: Literal["dipole", "cuboid"] | None = None,
    seconds: float | str = 20,
    seed: int = 1,
    design: Design | None = None,
    progress: bool | None = None,
) -> dict[str, bytes]: ...
def tolerance(
    design: Design,
    *,
    strength: float | str | None = None,
    place: float | str | None = None,
    turn: float | str | None = None,
    gap: float | str | None = None,
    flip: float | str | None = None,
    batch: float | str | None = None,
    draws: int | None = None,
    selectivity: float | str | None = None,
    beats: float | str | None = None,
    checks: int = 2,
    seed: int = 1,
    progress: bool | None = None,
) -> dict[str, Any]: ...
def verify(
    *folders: str | PathLike[str],
    progress: bool | None = None,
) -> dict[str, Any]: ...
