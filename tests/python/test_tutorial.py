"""The tutorial runs from its first cell to its last."""

import pathlib
import subprocess
import sys

import pytest

NOTEBOOK = pathlib.Path(__file__).with_name("tutorial.ipynb")


def test_the_tutorial_runs():
    for needed in ("nbmake", "ipykernel", "pandas", "scipy", "matplotlib", "magpylib"):
        pytest.importorskip(needed)
    run = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--nbmake", str(NOTEBOOK)]
    done = subprocess.run(run, capture_output=True, text=True, cwd=NOTEBOOK.parent)
    assert done.returncode == 0, done.stdout[-4000:]
