"""Python has every option of the program that says what is asked, and the reverse."""

import ast
import pathlib
import re
import subprocess

import numpy as np
import pytest
import tilebind

# Where results go and how they look: Python returns them.
SHOWN = {"out", "force", "figure_width", "figure_font", "figure_panels", "json", "text", "quiet", "threads",
         "help", "version", "compact", "no_pictures", "pathway"}
# The design is an object, its model a keyword of energies; tile sets, words and tables are read from
# their places; a bar is Python's own.
OBJECTS = {"self", "design", "designs", "tiles", "progress", "model", "name", "table", "folders"}
# Called otherwise: a flag with a number, poses by their place, several files.
NAMES = {"dynamics": "dynamics_runs", "from": "start", "to": "end"}

CALLS = {
    "analyse": "Design.analyse",
    "assemble": "assemble",
    "barrier": "Design.barrier",
    "bond": "Analysis.bond",
    "calibrate": "Design.calibrate Design.calibrate_bonds Design.calibrate_gaps",
    "compare": "compare",
    "crosstalk": "crosstalk",
    "dock": "dock Design.releases",
    "init": "Design.start",
    "make": "Design.make",
    "match": "Design.matches",
    "rates": "Design.exits Analysis.rates",
    "sweep": "sweep search",
    "table": "_AirTable.__call__",
    "tolerance": "tolerance",
    "verify": "verify",
    "words": "words",
    "yield": "Design.yields",
}
# Parts of a sweep on many machines; what has a method of its own; the seed of an analysis that is there;
# the words of a tile set, whose parts only the program makes.
ELSEWHERE = {
    "bond": {"seed"},
    "calibrate": {"bonds", "gaps"},
    "dock": {"from_bond", "trajectory"},
    "make": {"words"},
    "table": {"lattice", "merge", "hoomd"},
    "sweep": {"run", "merge", "status", "shard", "plan"},
}
# A set of words is a file of the program's.
FILES = {"crosstalk": {"words"}}


def parameters(name):
    """The parameters of a call as the stubs have them."""
    stubs = pathlib.Path(tilebind.__file__).with_name("_tilebind.pyi").read_text()
    tree = ast.parse(stubs)
    for part in name.split("."):
        tree = next(node for node in tree.body if getattr(node, "name", None) == part)
    arguments = tree.args.posonlyargs + tree.args.args + tree.args.kwonlyargs
    return {argument.arg for argument in arguments} - OBJECTS


@pytest.mark.parametrize("command", CALLS)
def test_options_are_keywords(program, command):
    told = subprocess.run([program, command, "--help"], capture_output=True, text=True, check=True).stdout
    # Up to the next heading.
    told = re.split(r"\n(?=\S)", told.split("Options:")[1])[0]
    options = {one.replace("-", "_") for one in re.findall(r"^\s+(?:-\w, )?--([a-z-]+)", told, re.M)}
    options = {NAMES.get(one, one) for one in options - SHOWN - OBJECTS - ELSEWHERE.get(command, set())}
    keywords = set().union(*map(parameters, CALLS[command].split()))
    assert options == keywords - FILES.get(command, set())


@pytest.mark.parametrize(
    "value",
    [
        b"3",
        bytearray(b"3"),
        memoryview(b"3"),
        True,
        [True],
        np.bool_(True),
        {3},
        frozenset({3}),
        {3: 3},
        "",
        [],
        np.ma.masked,
        np.ma.array([3.0], mask=[True]),
        np.timedelta64(3, "s"),
        np.datetime64("2020"),
        3 + 0j,
        np.complex128(3),
        float("nan"),
        10**400,
        object(),
    ],
)
def test_what_is_no_number_is_no_option(design, value):
    """Python and NumPy make numbers of bytes, truth values, times and masked entries."""
    calls = [
        lambda: design.analyse(milestones=value),
        lambda: design.exits([0.43, 0, 0], kt=value),
        lambda: design.yields(value, tiles=4, time=1),
        lambda: design.yields(1e-3, tiles=value, time=1),
        lambda: tilebind.tolerance(design, strength=value),
        lambda: tilebind.words(value),
        lambda: tilebind.dock(design, runs=value),
        lambda: design.replace("magnet.pitch", value),
    ]
    for call in calls:
        with pytest.raises((TypeError, ValueError, OverflowError)):
            call()


@pytest.mark.parametrize("value", [True, np.True_, b"1", np.ma.masked, -1, 1.5, "1", 10**400])
def test_what_is_no_whole_number_is_no_index(design, analysis, value):
    docked = design.dock(runs=2, duration=0.1, progress=False)
    calls = [
        lambda: design.matches(value),
        lambda: analysis.landscape_map(samples=value),
        lambda: analysis.landscape_map(orientations=value),
        lambda: analysis.pathway(value),
        lambda: docked.trajectory(value),
        lambda: docked.trajectory(0, interval=value if value not in (1.5, "1") else None),
        lambda: tilebind.search(design, {"magnet.pitch": [0.04, 0.05]}, maximise="captured", points=value),
    ]
    for call in calls:
        with pytest.raises((TypeError, ValueError, OverflowError, LookupError)):
            call()


@pytest.mark.parametrize("name", ["a\0b", "a\u202eb", "a\nb", "\u200b"])
def test_names_of_designs_can_be_seen(name):
    with pytest.raises(ValueError, match="(invisible|control) character"):
        tilebind.Design.start(name)


def test_what_numpy_calls_a_number_is_one(design):
    assert design.replace("magnet.pitch", np.float32(0.04)).text == design.replace("magnet.pitch", float(np.float32(0.04))).text
    few = [tilebind.tolerance(design, strength=0.05, draws=draws, checks=0) for draws in (20, np.int64(20))]
    assert few[0] == few[1]
