"""The same request has the same answer, byte for byte, from the program and from Python. Files of
`analyse`, `dock --from-bond` and `sweep` are compared in test_jobs.py."""

import json
import subprocess

import pytest
import tilebind

HEXAGON, PAPER = "shapes/hexagon.toml", "shapes/paper-tile.toml"


def loaded(root, name):
    return tilebind.Design.load(root / name)


def surveyed(root, name):
    # Whatever was analysed before.
    return loaded(root, name).analyse(quick=True, milestones=300, progress=False)


REQUESTS = {
    "bond": (
        ["bond", HEXAGON, "--kt", "3e-3", "--coverage", "0.3"],
        lambda root: surveyed(root, HEXAGON).bond(3e-3, 0.3),
    ),
    "rates": (
        ["rates", HEXAGON, "--kt", "6e-3", "--traps", "1", "--drag", "80"],
        lambda root: surveyed(root, HEXAGON).rates(6e-3, traps=1, drag=80),
    ),
    "exits": (
        ["rates", PAPER, "--kt", "8e-3", "--start", "0.43,-0.04,0", "--check", "10", "--seed", "5"],
        lambda root: loaded(root, PAPER).exits([0.43, -0.04, 0], kt=8e-3, check=10, seed=5),
    ),
    "yield": (
        "yield shapes/paper-tile.toml --kt 6e-3 --tiles 4 --time 60 --runs 20 --simulations 20".split(),
        lambda root: loaded(root, PAPER).yields(
            [6e-3], tiles=4, time=60, runs=20, simulations=20, progress=False
        ),
    ),
    "tolerance": (
        ["tolerance", HEXAGON, "--strength", "5%", "--place", "0.2 mm", "--draws", "50", "--checks", "0"],
        lambda root: tilebind.tolerance(
            loaded(root, HEXAGON), strength=0.05, place="0.2 mm", draws=50, checks=0, progress=False
        ),
    ),
    "words": (
        ["words", "--length", "5", "--gap", "0.4"],
        lambda root: tilebind.words(length=5, gap=0.4, progress=False),
    ),
}


@pytest.mark.parametrize("name", REQUESTS)
def test_program_and_python_agree(program, root, name):
    command, call = REQUESTS[name]
    run = [program, *command, "--json", "--quiet"]
    theirs = json.loads(subprocess.run(run, cwd=root, check=True, capture_output=True).stdout)
    ours = json.loads(json.dumps(call(root)))
    for answer in (theirs, ours):
        answer.pop("timing", None)
    assert json.dumps(ours) == json.dumps(theirs)
