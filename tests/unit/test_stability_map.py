"""The stability map: its points, the rule that ends them early, and its bands."""

import contextlib
import itertools
from dataclasses import replace

import numpy as np
import pytest
from commands import written
from rich_studies import PLANE, SPACE

from separatrix import Arrangement, InputError, Interrupted, MotionModel, Runner, read_study, solve
from separatrix.cage import RunOutcome, moving_cage, run_ensemble
from separatrix.verdict.crossing import cage_at
from separatrix.verdict.judgement import is_calm, judge
from separatrix.verdict.ledger import NAME, Ledger
from separatrix.verdict.parameter_axes import MapAxis, parameters, value_in, varied
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
