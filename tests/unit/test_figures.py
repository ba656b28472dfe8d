"""What the figures rely on: labels that keep apart, spectra, the same bytes each time."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from separatrix.figures.ranking import _ranks, file_name
from separatrix.figures.simulation import whirl_spectrum
from separatrix.figures.style import canvas, journal, label_lines, save, settled, spread


def test_labels_keep_their_distance_and_order():
    """Ten labels wanted at two places end `gap` apart, in order, inside the picture."""
    places = spread([0.5] * 5 + [0.52] * 5, 0.05)
    assert np.diff(sorted(places)).min() > 0.05 - 1e-6  # the sweep stops at 1e-9 of a lack
    assert max(places[:5]) < min(places[5:])
    assert 0 < min(places) < max(places) < 1


def test_labels_that_are_apart_stay():
    """Nothing moves without need."""
    assert spread([0.2, 0.8, 0.5], 0.05) == [0.2, 0.8, 0.5]


def test_a_label_that_moved_is_tied_to_its_line():
    """Two lines at one height get two labels and two leaders; lines apart from each other none."""
    for heights, tied in (((0.5, 0.5), 2), ((0.2, 0.8), 0)):
        _, axes = canvas()
        label_lines(axes, [(1.0, height, "label", "black") for height in heights], gap=0.1)
        assert sum(text.arrow_patch is not None for text in axes.texts) == tied


def test_shared_ranks_are_marked_and_missing_ones_are_dashes():
    """As in the printed table."""
    assert _ranks(np.array([1.0, 2.0, 2.0, np.nan])) == ["1", "2=", "2=", "-"]
    assert _ranks(np.array(["", ""])) == ["-", "-"]  # nothing ranked: netCDF has no type for it


@pytest.mark.parametrize("turns", [40.0, -40.0])
def test_whirl_spectrum_tells_forward_from_backward(turns):
    """A velocity turning at 40 Hz with the ball set peaks at +40 Hz, against it at -40 Hz."""
    time = np.linspace(0, 1, 1001)
    velocity = np.column_stack([np.cos(2 * np.pi * turns * time), np.sin(2 * np.pi * turns * time)])
    frequency, share = whirl_spectrum(time, velocity)
    assert frequency[share.argmax()] == pytest.approx(turns, abs=1.0)  # one bin of a run of 1 s
    assert share.max() == 1.0


def test_a_run_at_rest_has_a_spectrum_without_nan():
    """No motion at all: zeros."""
    _, share = whirl_spectrum(np.linspace(0, 1, 20), np.zeros((20, 2)))
    assert not share.any()


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("gaseous nitrogen, Chromex 40", "gaseous-nitrogen-chromex-40"),
        ("../\u00fc/..", "environment"),
        ("a" * 99, "a" * 60),
    ],
)
def test_file_names_of_environments_are_safe(text, name):
    """Letters, digits and dashes, never a path."""
    assert file_name(text) == name


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_the_same_figure_is_the_same_bytes(suffix, tmp_path):
    """No date, no random identifier, no version in a file."""
    for name in ("a", "b"):
        with journal():
            figure = Figure(figsize=(2, 2), layout="constrained")
            figure.subplots().plot([1, 2], [3, 4], label="line")
            settled(figure)
        save(figure, tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
