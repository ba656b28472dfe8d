"""The stability map: its points, the rule that ends them early, its bands; the verb `map`."""

import contextlib
import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import SMALL, document, written
from rich_studies import PLANE, SPACE

from separatrix import Arrangement, InputError, Interrupted, MotionModel, Runner, read_study, solve
from separatrix.cage import RunOutcome, moving_cage, run_ensemble
from separatrix.front import main
from separatrix.verdict.critical_friction import cage_at
from separatrix.verdict.judgement import is_calm, judge
from separatrix.verdict.long_jobs import NAME, Ledger
from separatrix.verdict.parameter_axes import MapAxis, parameters, read_axis, value_in, varied
from separatrix.verdict.stability_map import (
    AGREEING,
    MapQuestion,
    PointFinder,
    changes,
    margins,
    stability_map,
    stopping,
)

KICKS = MapAxis(parameter="kick", unit="m/s", values=(0.1, 0.2))


@pytest.fixture(scope="module")
def study():
    """The shipped study with short runs."""
    found = read_study("cryogenic-turbopump")
    return replace(found, stability=replace(found.stability, duration=0.02))


def question(study, **changed):
    """A map of restitution factor and friction, 4 by 5, with changes."""
    given = {
        "x": MapAxis(parameter="restitution_factor", unit="-", values=(0.0, 0.3, 0.6, 0.9)),
        "y": MapAxis(parameter="ball_cage_friction", unit="-", values=(0.0, 0.05, 0.1, 0.3, 0.5)),
        "kick": 0.5,
        "runs": 12,
    }
    return MapQuestion(study=study, **given | changed)


def test_a_point_is_the_ensemble_of_its_cage(study):
    """Runs, whirling runs and decision of a point are those of the same cage by itself; some end early."""
    cage = moving_cage(solve(study), 0.1)
    found = stability_map(question(study))
    columns = itertools.product(found.x.values, found.y.values)  # one after the other
    assert [(p.x, p.y) for p in found.points] == list(columns)
    for point in found.points:
        there = cage_at(cage, point.x, point.y)
        alone = run_ensemble(there, study.stability, kicks=(0.5,), runs=point.runs)
        assert point.whirling == int(alone.count(RunOutcome.WHIRLS)[0])
        evidence = judge(there, alone)
        assert (point.decision, point.reason) == (evidence.verdict, evidence.reason)
        assert point.largest_offset == evidence.largest_offset
        whole = run_ensemble(there, study.stability, kicks=(0.5,), runs=12)
        first = np.where(is_calm(whole.outcome), RunOutcome.SETTLES, whole.outcome)[0, :AGREEING]
        # six where the first six agree, all otherwise
        assert point.runs == (AGREEING if (first == first[0]).all() else 12)
        assert (alone.outcome == whole.outcome[:, : point.runs]).all()
    assert {AGREEING, 12} == {point.runs for point in found.points}


def test_threads_and_earlier_runs_change_nothing(study, tmp_path):
    """One thread, three, and a call that knows the runs of an interrupted one."""
    asked, ledger = question(study, runs=3), Ledger(tmp_path / NAME)
    whole = stability_map(asked)
    assert stability_map(asked, runner=Runner(jobs=3)) == whole

    def interrupt(done, total):
        if done == total // 2:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as caught:
        stability_map(asked, runner=Runner(ledger=ledger, progress=interrupt))
    part = caught.value.finished
    left = [point for point in part.points if not point.runs]
    assert (part.complete, {point.reason for point in left}) == (False, {"not run: interrupted"})
    assert 0 < part.counts["not_run"] == len(left) < len(part.points)
    assert stability_map(asked, runner=Runner(ledger=ledger)) == whole
    assert 0 < ledger.taken < sum(p.runs for p in whole.points)
    ledger.close()


@pytest.mark.parametrize("runs", [6, 7, 8, 9, 12])
def test_the_error_of_the_rule_is_that_of_all_orders(runs):
    """Every order of every mixture of outcomes counted: the largest share that ends on the wrong side."""
    rule, worst = stopping(runs), 0.0
    for kind in range(runs // 2 + 1, runs + 1):
        orders = list(itertools.combinations(range(runs), kind))  # where those of the majority stand
        wrong = sum(min(order) >= rule.agreeing_runs for order in orders)
        worst = max(worst, wrong / len(orders))
    assert rule.wrong_side_probability == pytest.approx(worst, rel=1e-15)


@pytest.mark.parametrize("runs", [1, 3, 6, 8, 12, 16, 32, 64, 500])
def test_the_first_look_is_as_early_as_its_error_allows(runs):
    """At most one in a thousand on the wrong side; from `AGREEING` runs on."""
    rule = stopping(runs)
    assert min(AGREEING, runs) <= rule.agreeing_runs <= runs
    assert rule.wrong_side_probability <= 1e-3


def test_bands_and_margins_of_a_column():
    """Dies, dies, neither, grows: a band from the second to the fourth; distances to it with their sign."""
    values, sides = (1.0, 2.0, 3.0, 4.0, 6.0), (-1, -1, 0, 1, 1)
    assert changes(sides) == [(1, 3)]
    assert margins(values, sides) == [1.0, 0.0, 0.0, 0.0, -2.0]
    assert margins(values, (-1, 0, -1, -1, 0)) == [None] * 5
    assert margins(values, (0, -1, 1, 1, 0)) == [None, 0.0, 0.0, -1.0, None]
    assert changes((1, -1, -1, 1, 0)) == [(0, 1), (2, 3)]


@pytest.fixture(scope="module")
def rich(tmp_path_factory, study):
    """Studies that state nearly every number, in space and in the plane; a plain one and a preloaded one."""
    folder = tmp_path_factory.mktemp("rich")
    plain = replace(study, cage=replace(study.cage, motion=MotionModel.PLANE))
    pressed = replace(study, operation=replace(study.operation, preload=40.0, arrangement=Arrangement.SINGLE))
    return [*(read_study(written(folder, text)) for text in (SPACE, PLANE)), plain, pressed]


@pytest.mark.parametrize("name", sorted(parameters()))
def test_every_parameter_reaches_the_study(name, rich):
    """2 % or one more changes a study that may have the number; the two that belong to a map change none."""
    absent, changed = {"cage.ball_cage_stiffness": 1e6, "cage.land_diameter": 38e-3}, []
    for study in rich:
        here = value_in(study, name) or absent.get(name, 1e-6)
        value = round(here) + 1 if parameters()[name].is_whole else 1.02 * here
        with contextlib.suppress(InputError):
            changed.append(varied(study, {name: value}) != study)
    assert changed
    assert all(changed) == (name not in ("restitution_factor", "kick"))


def test_a_refused_study_is_asked_for_once(study):
    """The refusal of a value is remembered as its point's reason."""
    given = replace(study, cage=replace(study.cage, ball_cage_friction=0.1))
    wide = MapAxis(parameter="cage.pocket_clearance", unit="m", values=(1e-4, 1.0))
    finder = PointFinder(question(given, x=wide, y=KICKS), Runner())
    points = [finder(1.0, kick) for kick in (0.1, 0.2)]
    assert points[0].reason == points[1].reason
    assert points[0].reason.startswith("[cage] pocket_clearance must be smaller than the gap")
    assert finder._state.cache_info().misses == 1


def test_a_map_without_friction_is_refused(study):
    """A friction is asked for where no axis is it."""
    bare = replace(study, ranking=None, cage=replace(study.cage, ball_cage_friction=None))
    with pytest.raises(InputError, match="ball_cage_friction is missing"):
        stability_map(question(bare, y=KICKS))


# The verb `map`: axes, keys, files, errors, and how an interrupted map goes on.

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
