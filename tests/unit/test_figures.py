"""What all figures share: labels that keep apart, headings, names of files, the same bytes each time."""

from __future__ import annotations

import json
from dataclasses import replace

import drawn
import numpy as np
import pytest
from matplotlib.figure import Figure

import separatrix
from separatrix import figures
from separatrix.figures.chain import signed
from separatrix.figures.envelope import sweep
from separatrix.figures.ranking import file_name, overview, rank_texts, text_order
from separatrix.figures.sensitivity import bearings
from separatrix.figures.style import (
    canvas,
    heading,
    journal,
    label_lines,
    literal_texts,
    save,
    settled,
    spread,
)
from separatrix.ground.errors import InputError


def test_labels_keep_their_distance_and_order():
    """Ten labels wanted at two places end `gap` apart, in order, inside the picture; others stay."""
    places = spread([0.5] * 5 + [0.52] * 5, 0.05)
    # the sweep stops at 1e-9 of a lack
    assert np.diff(sorted(places)).min() > 0.05 - 1e-6
    assert max(places[:5]) < min(places[5:])
    assert 0 < min(places) < max(places) < 1
    assert spread([0.2, 0.8, 0.5], 0.05) == [0.2, 0.8, 0.5]


@pytest.mark.parametrize("scale", ["linear", "log"])
@pytest.mark.parametrize(("heights", "tied"), [((0.5, 0.5), 2), ((0.02, 0.8), 0)])
def test_a_label_that_moved_is_tied_to_its_line(heights, tied, scale):
    """Two lines at one height get two labels and two leaders; lines apart from each other none."""
    _, axes = canvas()
    axes.set(yscale=scale, ylim=(0.01, 1.0))
    label_lines(axes, [(1.0, height, "label", "black") for height in heights], gap=0.1)
    assert sum(text.arrow_patch is not None for text in axes.texts) == tied


@pytest.mark.parametrize(
    ("found", "wanted"),
    [
        (rank_texts([1.0, 2.0, 2.0, np.nan]), ["1", "2=", "2=", "-"]),
        (rank_texts(["", ""]), ["-", "-"]),  # nothing ranked: netCDF has no type for it
        (file_name("gaseous nitrogen, Chromex 40"), "gaseous-nitrogen-chromex-40"),
        (file_name("../\u00fc/.."), "environment"),
        (file_name("a" * 99), "a" * 60),
        (signed(-0.0, 2), "0"),
        (signed(-0.0758, 3), "\N{MINUS SIGN}0.0758"),
    ],
)
def test_texts_of_ranks_files_and_numbers(found, wanted):
    """Shared ranks are marked and missing ones are dashes; names of files are never a path."""
    assert found == wanted


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


def test_one_entry_draws_every_verb():
    """`plot` returns the first picture; an answer without pictures yields none, and `plot` refuses it."""
    assert [name for name, _ in figures.draw("stability", drawn.curve())] == ["stability-curve"]
    for space in (False, True):
        assert [name for name, _ in figures.draw("simulate", drawn.run(space=space))] == ["simulation"]
    ((name, figure),) = figures.draw("compare", drawn.run(), drawn.run(), names=("a $", "b"))
    assert (name, figure.axes[0].get_title(loc="left")[:7]) == ("comparison", r"A  a \$")
    assert figures.plot("stability", drawn.curve()).axes[0].get_title(loc="left")
    assert not list(figures.draw("check", drawn.curve()))
    bare_races = drawn.curve().drop_dims("restitution_factor")
    for verb in ("rank", "restitution", "sweep"):
        with pytest.raises(InputError, match="has no picture"):
            figures.plot(verb, bare_races)
    for verb, other in (("compare", None), ("stability", drawn.curve())):
        with pytest.raises(InputError, match="dataset"):
            list(figures.draw(verb, drawn.run(), other))


STUDY = {
    "operation": {"fluid": {"value": "liquid nitrogen"}, "temperature": {"value": 77.0}},
    "film": {"material": {"name": "PTFE"}, "thickness": {"value": 1e-6}, "is_bare": False},
    "cage": {
        "ball_cage_friction": {"value": None, "candidate": "Armalon", "environment": "vacuum"},
        "material": {"value": None},
    },
}
LOADED = {**STUDY["operation"], "axial_load": {"value": 300.0}, "inner_speed": {"value": 100.0}}
FILM = "PTFE, 1 \N{MICRO SIGN}m"
POINT = f"liquid nitrogen, 77 K; {FILM}"
ONE = drawn.run(cage_ball_cage_friction=0.09, run=3)
END = "kick 0.5 m/s, run 3, seed 7: the cage whirls (run of 10 ms)"
OWN = {"ball_cage_friction": {"value": 0.2}, "material": {"name": "bronze"}}


BARE = {"film": {"is_bare": True}, "operation": LOADED}
AXES = drawn.plane([[0.0]], x_parameter="operation.axial_load", y_parameter="film.thickness")
CASES = drawn.swept(["operation.inner_speed", "operation.temperature"])
GIVEN = {"cage": {"ball_cage_friction": {"value": 0.09}}}


@pytest.mark.parametrize(
    ("verb", "data", "changes", "last"),
    [
        ("simulate", ONE, {}, f"{POINT}|pocket friction 0.09 (Armalon in vacuum), {END}"),
        ("simulate", ONE, {"cage": OWN}, f"{POINT}|pocket friction 0.09 (bronze), {END}"),
        ("simulate", ONE, GIVEN, f"{POINT}|pocket friction 0.09, {END}"),
        ("stability", drawn.curve(), {}, f"{POINT}; seed 7"),
        ("traction", drawn.curve(), {}, POINT),
        ("traction", AXES, BARE, "liquid nitrogen, 77 K; inner ring 954.9 rpm; bare races"),
        ("map", AXES, {"operation": LOADED}, "liquid nitrogen, 77 K; inner ring 954.9 rpm; PTFE; seed 7"),
        ("sweep", CASES, {"operation": LOADED}, f"liquid nitrogen; 300 N axial; {FILM}; seed 7"),
    ],
)
def test_the_heading_of_a_picture(verb, data, changes, last):
    """Study, operating point without what the answer varies, and which run; a dollar is not a formula."""
    attrs = {"title": "A $5 bearing", "study": json.dumps(STUDY | changes), "seed": 7, "verb": verb}
    assert heading(literal_texts(data.assign_attrs(attrs))) == [r"A \$5 bearing", *last.split("|")]


def test_a_long_title_is_cut_and_data_without_a_study_have_no_heading():
    """Two lines, whatever is written into a study."""
    assert heading(drawn.curve()) == []
    lines = heading(drawn.curve().assign_attrs(title="word " * 200), 40)
    assert [len(line) <= 40 for line in lines] == [True, True]
    assert lines[1].endswith("...")


@pytest.mark.parametrize(
    ("stated", "rows"), [("vacuum", [3, 2, 0, 1]), (None, [1, 0, 3, 2])], ids=["own", "overall"]
)
def test_the_overview_lists_the_materials_as_the_text_does(stated, rows):
    """By rank in the own environment, then margin, then friction; whoever has no rank comes last."""
    data = drawn.ranking(
        material_rank=[[1.0, 2.0, 3.0, 4.0], [3.0, np.nan, 1.0, 1.0]],
        material_margin=[[0.4, 0.3, 0.2, 0.1], [0.1, np.nan, 0.3, 0.4]],
        overall_rank=[2.0, 1.0, 3.0, 3.0],
        overall_margin=[0.2, 0.3, 0.1, 0.2],
    )
    study = {"ranking": {"environment": {"value": stated}}}
    data = data.assign_attrs(study=json.dumps(study))
    data["material_extrapolation"][1, 0] = data["overall_extrapolation"][0] = "too fast"
    assert text_order(data) == rows
    axes = overview(data).axes[0]
    labels = [label.get_text() for label in axes.get_yticklabels()][::-1]
    assert [label.split(maxsplit=1)[0] for label in labels] == ["ABCD"[i] + "*" * (i == 0) for i in rows]
    assert "friction extrapolated" in axes.get_legend_handles_labels()[1]


def test_candidates_are_drawn_below_the_top_of_the_curve():
    """Also where the curve is higher than every candidate."""
    data = drawn.ranking().isel(environment=[0])
    (figure,) = [one for name, one in figures.draw("rank", data) if name == "rank-1-air"]
    (axes,) = figure.axes
    assert axes.get_ylim()[1] > max(0.4, float(data["critical_friction"].max()))
    assert "1  A  0.1" in {text.get_text() for text in axes.texts}


@pytest.mark.parametrize("varies", [True, False])
def test_bearings_of_one_restitution_factor_are_drawn_apart(varies):
    """Against the restitution factor if it varies within a candidate, else against the bearing's number."""
    eta = np.stack([np.linspace(0.2, 0.2 + 0.1 * varies, 8), np.full(8, 0.5)])
    figure = bearings(drawn.cloud(eta).isel(environment=0))
    (axes,) = figure.axes
    assert ("number" in axes.get_xlabel()) is not varies
    points = np.concatenate([line.get_xdata() for line in axes.lines if line.get_marker() in ".x"])
    assert axes.get_xlim()[0] < points.min() < points.max() < axes.get_xlim()[1]
    assert (np.unique(points).size > 2) is True
    named = [text.get_text() for text in axes.texts if "P(stable)" in text.get_text()]
    assert all((r"$\eta$" in text) is not varies for text in named)


def test_a_sweep_marks_verdicts_and_names_units():
    """One panel for each parameter, in an engineer's unit."""
    data = drawn.swept(["film.thickness", "operation.inner_speed"], verdict=["STABLE", "", "UNSTABLE"])
    labels = [axes.get_xlabel() for axes in sweep(data).axes]
    assert labels == ["film thickness [\N{MICRO SIGN}m]", "inner speed [rpm]"]
    assert sweep(data).legends


@pytest.mark.parametrize(
    ("name", "heavier"), [("momentum-wheel", 1.0), ("lox-turbopump", 1.0), ("cryogenic-turbopump", 100.0)]
)
def test_what_names_the_point_of_a_film_covers_no_curve(name, heavier):
    """Curves end at 1, the top of the panel; what names the study's point begins above it.

    The heavy cage has a restitution factor of 0 at every race friction: its words fit beside each other, too.
    """
    study = separatrix.read_study(name)
    cage = replace(study.cage, mass=heavier * study.cage.mass)
    data = separatrix.restitution(replace(study, cage=cage)).to_xarray()
    figure = dict(figures.draw("restitution", data))["restitution-film"]
    figure.draw_without_rendering()
    left, right = (axes.get_legend().get_window_extent() for axes in figure.axes)
    assert left.x1 <= right.x0
    for axes in figure.axes:
        text = axes.get_legend().get_texts()[0]
        assert text.get_window_extent().y0 >= axes.get_window_extent().y1
        assert text.get_window_extent().x1 <= figure.bbox.width
