"""What the tests share: designs that are shipped, and an analysis small enough to be made often."""

import os
import pathlib

import pytest
import tilebind

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: As little as shows everything that an analysis has.
SMALL = {"milestones": 400, "far_starts": 60, "certify_seconds": 0.0, "complete_seconds": 0.0}


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="session")
def design():
    return tilebind.Design.load(ROOT / "shapes/paper-tile.toml")


@pytest.fixture(scope="session")
def tab():
    return tilebind.Design.load(ROOT / "shapes/tab-20mm.toml")


@pytest.fixture(scope="session")
def analysis(tab):
    return tab.analyse(progress=False, **SMALL)


@pytest.fixture(scope="session")
def program():
    """The program built from the same sources."""
    if named := os.environ.get("TILEBIND"):
        return named
    built = [p for k in ("release", "quick") if (p := ROOT / f"target/{k}/tilebind").is_file()]
    if not built:
        pytest.skip("the program is not built: cargo build --release, or TILEBIND=its path")
    return str(max(built, key=lambda path: path.stat().st_mtime))
