"""The verb `map`: axes, keys, files, errors, and how an interrupted map goes on."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from commands import SMALL, document

from separatrix import InputError, read_study, solve
from separatrix.front import main
from separatrix.verdict.parameter_axes import read_axis

pytestmark = pytest.mark.usefixtures("undrawn")


@pytest.fixture(autouse=True)
def _small(elsewhere):
    """Run in a folder with nothing but the small study."""
    Path("small.toml").write_text(SMALL)


def mapped(capsys, *options: str) -> dict:
    """Return the document of a small map."""
    return document(capsys, "map", "small.toml", *options)


@pytest.mark.parametrize(
    ("text", "unit", "values"),
    [
        ("cage.pocket_clearance=0.1..1mm:4", "m", (1e-4, 4e-4, 7e-4, 1e-3)),
        ("cage.pocket_clearance=100um..1mm:2", "m", (1e-4, 1e-3)),
        ("cage.mass=1..100 g:3:log", "kg", (1e-3, 1e-2, 1e-1)),
        ("film.race_friction=0.02..0.3:3", "-", (0.02, 0.16, 0.3)),
        ("cage.ball_cage_friction=0..0.5:2", "-", (0.0, 0.5)),
        ("bearing.ball_count=8..12", "-", (8, 9, 10, 11, 12)),
        ("bearing.ball_count=8..12:3", "-", (8, 10, 12)),
        ("operation.temperature=-200..0degC:2", "K", (73.15, 273.15)),
        ("kick=0.1..10 m/s:3:log", "m/s", (0.1, 1.0, 10.0)),
        ("film.elastic_modulus=1..3GPa:2", "Pa", (1e9, 3e9)),
    ],
)
def test_an_axis_is_read_as_it_is_written(text, unit, values):
    """Units hold for both ends, values are exact at the ends, whole numbers stay whole; one name each."""
    axis = read_axis(text, "--x", 5)
    assert axis.parameter == text.partition("=")[0].replace("cage.ball_cage_friction", "ball_cage_friction")
    assert (axis.unit, axis.values) == (unit, values)
    assert all(type(a) is type(b) for a, b in zip(axis.values, values, strict=True))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("cage.mass", "needs a parameter"),
        ("cage.mas=1..2g", "Did you mean cage.mass?"),
        ("pocket_clearance=1..2mm", "Did you mean cage.pocket_clearance?"),
        ("cage.guidance=1..2", "is not a number"),
        ("cage.mass=1..2", 'Write "2 g"'),
        ("cage.mass=1..2mm", "needs a unit of mass"),
        ("cage.mass=2..1g", "must rise"),
        ("cage.mass=1g", "needs a range"),
        ("cage.mass=1...2g", "needs a range"),
        ("cage.mass=1,5..2g", "decimal point"),
        ("cage.mass=nan..2g", "finite"),
        ("cage.mass=1..2g:1", "between 2 and 1000 points"),
        ("cage.mass=1..2g:log:5", "number of points and log"),
        ("cage.mass=0..2g:log", "> 0 for log"),
        ("bearing.ball_count=8.5..16", "whole numbers"),
        ("bearing.ball_count=8..16mm", "plain numbers"),
        ("bearing.ball_count=8..16:log", "no log"),
        ("restitution_factor=0..1.5", "between 0 and 1"),
        ("ball_cage_friction=-0.1..1", "between 0 and 2"),
    ],
)
def test_a_wrong_axis_is_refused(text, said):
    """What is wrong, and the cure."""
    with pytest.raises(InputError) as refusal:
        read_axis(text, "--x", 5)
    assert said in str(refusal.value)


def test_a_refused_point_is_a_row_with_its_reason(capsys):
    """Pockets wider than the gap between balls: no decision, no numbers, the reason; the others are run."""
    found = mapped(capsys, "--x", "cage.pocket_clearance=1..6mm:3", "--points", "2", "--runs", "2")
    refusals = [point for point in found["points"] if point["x"] == 0.006]
    assert [point["decision"] for point in refusals] == [None, None]
    assert all("gap between balls" in point["reason"] for point in refusals)
    assert (found["counts"]["refused"], found["complete"]) == (2, True)
    assert {point["runs"] for point in found["points"] if point["x"] == 0.001} == {2}


def test_a_film_without_thickness_is_bare_races(capsys):
    """The row at 0 has the restitution factor of the same study without a film; no point is refused."""
    axes = ("--x", "ball_cage_friction=0..0.2:2", "--y", "film.thickness=0..5um:3")
    found = mapped(capsys, *axes, "--runs", "2", "--quiet")
    assert (found["counts"]["refused"], found["x"]["here"]) == (0, 0.1)
    assert found["y"]["values"][0] == 0.0
    coated = {point["y"]: point["restitution_factor"] for point in found["points"]}
    study = read_study("small.toml")
    bare = replace(study, film=replace(study.film, material=None, thickness=None))
    assert coated[0.0] == solve(bare).restitution.restitution_factor
    assert coated[0.0] != coated[2.5e-6]


def test_a_second_call_takes_finished_runs_and_says_so(capsys):
    """The same document, and a line on standard error; a finer grid, too, goes on from 9 of its 25 points."""
    first = mapped(capsys, "--points", "3", "--runs", "2", "--out", "m")
    for points in ("3", "5"):
        assert main(["map", "small.toml", "--json", "--points", points, "--runs", "2", "--out", "m"]) == 0
        out, err = capsys.readouterr()
        assert err.startswith("separatrix: 18 runs were taken from m/finished-runs.sqlite")
        assert (json.loads(out) == first) == (points == "3")
