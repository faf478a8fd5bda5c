"""A tqdm progress bar, if tqdm is installed and the bar would be visible."""

from __future__ import annotations

import sys


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


def bar(progress: bool | None) -> "_Bar | None":
    """A bar; by default only where standard error is a terminal, or in a notebook."""
    if progress is None and not (_in_notebook() or sys.stderr.isatty()):
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    form = "{percentage:3.0f} %|{bar}| {elapsed}{postfix}"
    return _Bar(tqdm(total=100, leave=False, bar_format=form))


class _Bar:
    def __init__(self, tqdm):
        self.tqdm = tqdm

    def show(self, share: float, text: str) -> None:
        self.tqdm.n = max(self.tqdm.n, min(100, int(100 * share)))
        self.tqdm.set_postfix_str(text, refresh=True)

    def close(self) -> None:
        self.tqdm.close()
