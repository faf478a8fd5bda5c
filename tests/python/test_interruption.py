"""Ctrl-C stops long work and leaves the session as it was; progress is shown."""

import os
import signal
import threading
import time

import numpy as np
import pytest
import tilebind
from tilebind import _progress

# None of these ends by itself within the test's patience.
MANY = 10_000_000
JOBS = {
    "roadmap": lambda d: d.analyse(milestones=400_000),
    "certificate": lambda d: d.barrier(d.bound, tolerance=1e-12, certify_work=3600, milestones=4000),
    "states": lambda d: d.analyse(milestones=2000, complete_work=3600, complete_below=1e-4),
    "docking": lambda d: d.dock(runs=400_000),
    "sweep": lambda d: tilebind.sweep(d, {"magnet.pitch": np.linspace(0.03, 0.05, 1000)}),
    "energies": lambda d: d.energy(np.full((MANY, 3), 0.5), model="cuboid"),
    "words": lambda d: tilebind.words(14, gap=0.6, seconds=3600),
    "crosstalk": lambda d: tilebind.crosstalk(["NNSN", "NSSS"], certify=1e-9),
}


@pytest.fixture(autouse=True)
def interruptions_are_heard():
    """A shell lets what it starts in the background ignore them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("job", JOBS)
def test_an_interruption_is_heeded(design, job):
    asked = []

    def interrupt():
        asked.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, interrupt)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            JOBS[job](design)
    finally:
        timer.cancel()
    waited = time.monotonic() - asked[0]
    print(f"{job}: stopped after {waited:.2f} s")
    # The session goes on.
    assert design.energy(design.bound) < 0
    assert len(design.dock(runs=2, progress=False)) == 2


def test_progress_is_told(design, monkeypatch):
    told = []

    class Bar:
        def show(self, share, text):
            told.append((share, text))

        def close(self):
            told.append("closed")

    monkeypatch.setattr(_progress, "bar", lambda progress: Bar())
    design.analyse(milestones=4000, certify_seconds=0, complete_seconds=0)
    assert told[-1] == "closed"
    shares = [share for share, _ in told[:-1]]
    assert shares and shares == sorted(shares) and all(0 <= share <= 1 for share in shares)


def test_bars_are_for_those_who_look(monkeypatch):
    pytest.importorskip("tqdm")
    assert _progress.bar(None) is None
    bar = _progress.bar(True)
    bar.show(0.5, "half")
    assert bar.tqdm.n == 50
    bar.close()
