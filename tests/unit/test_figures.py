"""What the figures rely on: labels that keep apart, spectra, the same bytes each time."""

from __future__ import annotations

import json

import drawn
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from separatrix.errors import InputError
from separatrix.figures.heading import heading
from separatrix.figures.literal import literal_texts
from separatrix.figures.ranking import _ranks, file_name, text_order
from separatrix.figures.spectrum import spectrum_against_time, whirl_spectrum
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


def test_the_spectrum_against_time_follows_a_whirl_that_turns_faster():
    """A velocity that turns at 1000 t Hz is strongest near 1000 t Hz in each piece of the run."""
    time = np.linspace(0, 1, 4001)
    phase = np.pi * 1000.0 * time**2
    found = spectrum_against_time(time, np.column_stack([np.cos(phase), np.sin(phase)]))
    middles, frequency, share = found
    strongest = frequency[share.argmax(axis=1)]
    assert strongest == pytest.approx(1000.0 * middles, abs=frequency[1] - frequency[0])  # one bin
    assert middles[0] < 0.1
    assert middles[-1] > 0.9


def test_a_run_at_rest_has_a_spectrum_without_nan():
    """No motion at all: zeros."""
    for spectrum in (whirl_spectrum, spectrum_against_time):
        assert not spectrum(np.linspace(0, 1, 20), np.zeros((20, 2)))[-1].any()


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


@pytest.mark.parametrize("suffix", [".svg", ".png", ".pdf"])
def test_the_same_figure_is_the_same_bytes(suffix, tmp_path):
    """No date, no random identifier, no version in a file."""
    for name in ("a", "b"):
        with journal():
            figure = Figure(figsize=(2, 2), layout="constrained")
            figure.subplots().plot([1, 2], [3, 4], label="line")
            settled(figure)
        save(figure, tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


@pytest.mark.parametrize("name", ["curve", "curve.avi"])
def test_a_picture_of_another_kind_is_refused_in_one_line(name, tmp_path):
    """No ending, or one that is not drawn; nothing is written."""
    with pytest.raises(InputError, match=r"must end in \.png, \.svg, \.pdf; got") as raised:
        save(Figure(), tmp_path / name)
    assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())


STUDY = {
    "operation": {"fluid": {"value": "liquid nitrogen"}, "temperature": {"value": 77.0}},
    "film": {"material": {"name": "PTFE"}, "thickness": {"value": 5e-7}, "is_bare": False},
    "cage": {
        "ball_cage_friction": {"value": None, "candidate": "Armalon", "environment": "vacuum"},
        "material": {"value": None},
    },
}


def described(data, verb, **changes):
    """A dataset with the attributes of a saved answer."""
    attrs = {"title": "A $5 bearing", "study": json.dumps(STUDY | changes), "seed": 7, "verb": verb}
    return data.assign_attrs(attrs)


def test_a_run_is_headed_by_study_medium_friction_kick_run_and_seed():
    """Three lines: what it is, what it runs in and on, which run; a dollar is no formula."""
    one = described(drawn.run(cage_ball_cage_friction=0.09, run=3), "simulate")
    assert heading(literal_texts(one)) == [
        r"A \$5 bearing",
        "liquid nitrogen, 77 K; PTFE, 500 nm",
        "pocket friction 0.09 (Armalon in vacuum), kick 0.5 m/s, run 3, seed 7: the cage whirls "
        "(run of 10 ms)",
    ]
    own = {"ball_cage_friction": {"value": 0.2}, "material": {"name": "bronze"}}
    assert "(bronze)" in heading(described(one, "simulate", cage=own))[2]
    assert (
        "friction 0.09, kick"
        in heading(described(one, "simulate", cage={"ball_cage_friction": {"value": 0.09}}))[2]
    )


def test_an_ensemble_is_headed_by_its_seed_and_the_chain_is_not():
    """Loads and traction do not depend on it; data without a study have no heading."""
    assert heading(described(drawn.curve(), "stability"))[1].endswith("; seed 7")
    assert "seed" not in heading(described(drawn.curve(), "traction"))[1]
    assert heading(described(drawn.curve(), "stability", film={"is_bare": True}))[1].count("bare races") == 1
    assert heading(drawn.curve()) == []


def test_a_long_title_is_cut_on_its_second_line():
    """Whatever is written into a study."""
    lines = heading(described(drawn.curve(), "bearing").assign_attrs(title="word " * 200), 40)
    assert [len(line) <= 40 for line in lines] == [True] * len(lines)
    assert lines[1].endswith("...")


def test_the_overview_lists_the_materials_as_the_text_does():
    """By rank in the own environment, then margin, then friction; whoever has no rank comes last."""
    on = ("environment", "material")
    data = xr.Dataset(
        {
            "material_rank": (on, [[1.0, 2.0, 3.0, 4.0], [3.0, np.nan, 1.0, 1.0]]),
            "material_margin": (on, [[0.4, 0.3, 0.2, 0.1], [0.1, np.nan, 0.3, 0.4]]),
            "material_friction": (on, [[0.1, 0.2, 0.3, 0.4], [0.4, np.nan, 0.1, 0.1]]),
        },
        coords={"environment": ["air", "vacuum"], "material": list("ABCD")},
        attrs={"study": json.dumps({"ranking": {"environment": {"value": "vacuum"}}})},
    )
    assert text_order(data) == [3, 2, 0, 1]
