"""Figures in matplotlib."""

import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def test_figures_are_drawn_where_they_are_wanted(analysis, tmp_path):
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.5))
    assert analysis.plot_map(ax=axes[0], cmap="PuOr") is axes[0]
    assert analysis.plot_profile("A", ax=axes[1], color="C3") is axes[1]
    assert analysis.plot_disconnectivity(ax=axes[2]) is axes[2]
    assert axes[0].get_xlabel() == "x (m)" and axes[1].get_ylabel() == "energy (mJ)"
    assert axes[1].lines[0].get_color() == "C3"
    assert len(axes[2].texts) == len({*analysis.states["name"], "free"})
    figure.tight_layout()
    figure.savefig(tmp_path / "figure.png", dpi=80)
    plt.close(figure)


def test_the_current_axes_are_drawn_on_by_default(analysis):
    figure, ax = plt.subplots()
    assert analysis.plot_profile() is ax
    plt.close(figure)
