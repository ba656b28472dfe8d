"""The stability map: its points, the rule that ends them early, its order and its bands."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from separatrix.cage import RunOutcome, moving_cage, run_ensemble
from separatrix.cage.closed_forms import drifts
from separatrix.chain.solution import solve
from separatrix.ground.errors import InputError
from separatrix.study.reading import read_study
from separatrix.study.study import Guidance, MotionModel, PocketShape, Wear
from separatrix.verdict.judgement import Verdict, is_calm, judge, wilson_interval
from separatrix.verdict.ledger import NAME, Ledger
from separatrix.verdict.long_jobs import Interrupted, Runner
from separatrix.verdict.map_fill import (
    AGREEING,
    CHECK_EVERY,
    Filled,
    Tally,
    changes,
    fill,
    first_look,
    further,
    margins,
    near_a_change,
    other_decision_probability,
    rounds,
    settled,
    wrong_side_probability,
)
from separatrix.verdict.map_records import MapAxis, MapPoint, MapQuestion, parameters, side, value_in, varied
from separatrix.verdict.crossing import cage_at
from separatrix.verdict.stability_map import AGREED, PointFinder, inference, stability_map

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
        assert (point.decision, point.reason) == (judge(there, alone).verdict, judge(there, alone).reason)
        evidence = judge(there, alone)
        for name in ("largest_offset", "drift_rate", "largest_contact_force"):
            assert getattr(point, name) == getattr(evidence, name)
        whole = run_ensemble(there, study.stability, kicks=(0.5,), runs=12)
        first = np.where(is_calm(whole.outcome), RunOutcome.SETTLES, whole.outcome)[0, :AGREEING]
        # six where the first six agree, as many as could change the answer otherwise; the first of all
        assert point.runs == AGREEING or not (first == first[0]).all()
        assert point.runs == AGREEING or point.decision is judge(there, whole).verdict
        assert (alone.outcome == whole.outcome[:, : point.runs]).all()
    assert {AGREEING} < {point.runs for point in found.points}


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
    assert not caught.value.finished.complete
    assert stability_map(asked, runner=Runner(ledger=ledger)) == whole
    assert 0 < ledger.taken < sum(p.runs for p in whole.points)
    ledger.close()


def test_a_cage_that_can_drift_is_never_stable(study):
    """Without a land, in a turning ball set: where motion dies the point is undecided, and says drift."""
    free = replace(study.cage, guidance=Guidance.BALL, land_clearance=None)
    loose = replace(study, cage=free)
    assert drifts(moving_cage(solve(loose), 0.0))
    found = stability_map(question(loose))
    assert found.counts["STABLE"] == 0
    calm = [point for point in found.points if point.whirling == 0]
    assert calm
    assert all("drift" in p.reason for p in calm if "Too short" not in p.reason)
    assert {p.decision for p in calm} == {Verdict.UNDECIDED}


@pytest.mark.parametrize("most", [6, 9, 16, 25])
def test_a_settled_point_keeps_its_answer_however_the_rest_ends(most):
    """Every state of the runs, every end of the others: the same answer, also by the runs that were made."""
    ended = 0
    for whirls, settles, others in itertools.product(range(most + 1), range(most + 1), (0, 1, 3)):
        made = whirls + settles + others
        if not 1 <= made < most:
            continue
        now = Tally(runs=made, whirls=whirls, settles=settles)
        if not settled(now, most):
            continue
        ended += 1
        left = most - made
        ends = {answer(whirls + w, settles + s, most) for w in range(left + 1) for s in range(left + 1 - w)}
        assert ends == {answer(whirls, settles, made)}
    assert ended > 0


def answer(whirls: int, settles: int, runs: int) -> tuple[int, str]:
    """Side and decision by the letter of the rule."""
    wild, calm = (wilson_interval(count, runs)[0] for count in (whirls, settles))
    decision = "UNSTABLE" if wild > 0.5 else "UNDECIDED"
    if calm > 0.5 and settles >= 0.9 * runs:
        decision = "STABLE"
    return side(*wilson_interval(whirls, runs)), decision


def test_a_point_is_settled_as_soon_as_its_answer_is():
    """Of 16 runs: five of each kind are neither; twelve that whirl are UNSTABLE; STABLE takes all runs.

    Runs are looked at again after two, or an eighth of those made.
    """

    def at(whirls: int, settles: int) -> bool:
        return settled(Tally(runs=whirls + settles, whirls=whirls, settles=settles), 16)

    assert [at(5, 5), at(4, 5), at(5, 4)] == [True, False, False]
    assert [at(12, 1), at(11, 1)] == [True, False]
    assert [at(2, 12), at(2, 13), at(1, 14), at(1, 15)] == [True, True, False, True]
    assert [further(made, 16) for made in (6, 8, 15)] + [further(800, 1000)] == [2, 2, 1, 100]


@pytest.mark.parametrize(("runs", "agreeing"), [(7, 2), (8, 3), (9, 4), (6, 3)])
def test_the_error_of_the_rule_is_that_of_all_orders(runs, agreeing):
    """Every order of every mixture of outcomes counted: the largest share that ends on the wrong side."""
    worst = 0.0
    for kind in range(runs // 2 + 1, runs + 1):
        orders = list(itertools.combinations(range(runs), kind))  # where those of the majority stand
        wrong = sum(min(order) >= agreeing for order in orders)
        worst = max(worst, wrong / len(orders))
    assert wrong_side_probability(runs, agreeing) == pytest.approx(worst, rel=1e-15)


def test_six_of_sixteen_that_agree_are_rarely_outvoted():
    """Of 16 runs, 9 against 7: 7 of the 8008 draws of the first 6 are all of the 7; of the first 8 none."""
    assert wrong_side_probability(16, 6) == pytest.approx(7 / 8008, rel=1e-15)
    assert wrong_side_probability(16, 8) == 0.0
    both_in_the_last_10 = (10 * 9) / (16 * 15)  # 2 against 14
    assert other_decision_probability(16, 6) == pytest.approx(both_in_the_last_10, rel=1e-15)
    assert wrong_side_probability(6, 6) == other_decision_probability(6, 6) == 0.0


@pytest.mark.parametrize("runs", [1, 3, 6, 8, 12, 16, 32, 64, 500])
def test_the_first_look_is_as_early_as_its_error_allows(runs):
    """At most one in a thousand on the wrong side; one run fewer would be more, or too few to decide."""
    first = first_look(runs)
    assert min(AGREEING, runs) <= first <= runs
    assert wrong_side_probability(runs, first) <= 1e-3
    assert first in (runs, AGREEING) or wrong_side_probability(runs, first - 1) > 1e-3


def test_every_point_is_in_one_round():
    """From the coarse grid on, each place once; the first round spans the plane."""
    found = [place for _, places in rounds(21, 10) for place in places]
    assert sorted(found) == list(itertools.product(range(21), range(10)))
    first = next(rounds(21, 10))[1]
    assert {(0, 0), (0, 9), (20, 0), (20, 9)} <= set(first)


def test_points_near_a_change_are_found():
    """A step between two coarse columns wants the points between and both columns, no others."""
    coarser = ([0, 4, 8, 12, 16], [0, 4, 8])
    answers = {(i, j): i >= 8 for i in coarser[0] for j in coarser[1]}
    wanted = [i for i in range(17) if near_a_change((i, 2), coarser, answers)]
    assert wanted == [*range(4, 9)]


PLANE = {
    "x": MapAxis(parameter="restitution_factor", unit="-", values=tuple(i / 20 for i in range(21))),
    "y": MapAxis(parameter="ball_cage_friction", unit="-", values=tuple(i / 40 for i in range(21))),
    "runs": 3,
}


def test_an_adaptive_map_says_what_it_ran_and_how_often_it_would_be_wrong(study):
    """Points that are run are those of the full map; the others say what is around; some are checked."""
    full = stability_map(question(study, **PLANE), runner=Runner(jobs=2))
    assert full.inference is None
    some = stability_map(question(study, **PLANE, adaptive=True), runner=Runner(jobs=2))
    run = [p for p in some.points if p.runs]
    at = {(p.x, p.y): p for p in full.points}
    assert all(replace(p, margin=None) == replace(at[p.x, p.y], margin=None) for p in run)
    left = [p for p in some.points if not p.runs]
    assert len(left) == len(full.points) - len(run) == some.counts["inferred"] == some.inference.points > 0
    assert {p.reason for p in left} == {AGREED}
    assert {p.decision for p in left} == {None}
    assert {p.inferred_decision for p in left} <= {p.decision for p in run}
    assert some.inference.checked == round((len(left) + some.inference.checked) / CHECK_EVERY)


def test_what_is_known_does_not_change_an_adaptive_map(study, tmp_path):
    """The same points and checks, whether nothing or the full map was run before."""
    asked, ledger = question(study, **PLANE, adaptive=True), Ledger(tmp_path / NAME)
    stability_map(question(study, **PLANE), runner=Runner(jobs=2, ledger=ledger))
    assert stability_map(asked, runner=Runner(jobs=2)) == stability_map(asked, runner=Runner(ledger=ledger))
    assert ledger.taken > 0
    ledger.close()


def test_a_check_that_differs_is_counted(study):
    """A calm plane but for one island between the coarse points, which a check happens to meet."""
    values = tuple(i / 32 for i in range(33))
    axes = {name: replace(PLANE[name], values=values) for name in "xy"}
    asked = question(study, **axes, adaptive=True)
    calm = filled(asked)
    assert len(calm.found) == 25 + len(calm.checked)  # the coarse grid, 5 by 5, and the checks
    assert set(calm.inferred.values()) == {Verdict.STABLE}
    i, j = next(iter(calm.checked))
    found = inference(filled(asked, island=(values[i], values[j])))
    assert (found.checked, found.decided_otherwise) == (len(calm.checked), 1)
    assert (found.error_low, found.error_high) == wilson_interval(1, found.checked)
    assert inference(calm).decided_otherwise == 0


def filled(asked: MapQuestion, island: tuple[float, float] | None = None) -> Filled:
    """Fill a plane that is STABLE but at the island."""

    def find(at: tuple[float, float]) -> MapPoint:
        return MapPoint(x=at[0], y=at[1], decision=Verdict.UNSTABLE if at == island else Verdict.STABLE)

    return fill(asked, find, Runner())


def test_bands_and_margins_of_a_column():
    """Dies, dies, neither, grows: a band from the second to the fourth; distances to it with their sign."""
    values, sides = (1.0, 2.0, 3.0, 4.0, 6.0), (-1, -1, 0, 1, 1)
    assert changes(sides) == [(1, 3)]
    assert margins(values, sides) == [1.0, 0.0, 0.0, 0.0, -2.0]
    assert margins(values, (-1, 0, -1, -1, 0)) == [None] * 5
    assert margins(values, (0, -1, 1, 1, 0)) == [None, 0.0, 0.0, -1.0, None]
    assert changes((1, -1, -1, 1, 0)) == [(0, 1), (2, 3)]


RING = {"inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.014}
IN_SPACE = {
    *("transverse_inertia", "land_spacing", "land_width", "land_diameter", "dynamic_unbalance"),
    *("axial_gravity", "added_mass"),
}


@pytest.mark.parametrize("name", sorted(parameters()))
def test_every_parameter_reaches_the_study(name, study):
    """Each parameter changes the study, but those that belong to the cage in the plane alone."""
    cage = {"pocket_shape": PocketShape.ELONGATED, "pocket_axial_clearance": 2e-4}
    if name.removeprefix("cage.") in RING:
        cage |= RING
    if name.removeprefix("cage.") in IN_SPACE:
        cage |= {"motion": MotionModel.SPACE}
    if name == "cage.land_spacing":
        cage |= {"land_count": 2, "land_spacing": 0.01}
    if name == "cage.land_lobes":
        cage |= {"land_out_of_round": 1e-6}
    if name == "cage.land_count":
        cage |= {"motion": MotionModel.PLANE}
    study = replace(study, cage=replace(study.cage, **cage))
    if name == "operation.ramp_start":
        study = replace(study, operation=replace(study.operation, ramp_time=0.1))
    if name.startswith("film.wear."):
        form = {"share": 0.1} if name.endswith("share") else {"width": 2e-4}
        worn = replace(study.film, wear=Wear(friction=0.3, thickness=1e-8, **form))
        study = replace(study, film=worn)
    here = value_in(study, name)
    value = 3 if parameters()[name].is_whole else 1.02 * (here or 1e-6)
    fits = {"cage.land_diameter": 66e-3, "cage.moment_of_inertia": 2.6e-5, "cage.transverse_inertia": 1.4e-5}
    value = {"cage.land_count": 2, "film.elastic_modulus": 2e9, **fits}.get(name, value)
    assert (varied(study, {name: value}) == study) == (name in ("restitution_factor", "kick"))


def test_a_refused_study_is_asked_for_once(study):
    """The refusal of a value is remembered as its point's reason."""
    given = replace(study, cage=replace(study.cage, ball_cage_friction=0.1))
    wide = MapAxis(parameter="cage.pocket_clearance", unit="m", values=(1e-4, 1.0))
    finder = PointFinder(question(given, x=wide, y=KICKS), Runner())
    points = [finder((1.0, kick)) for kick in (0.1, 0.2)]
    assert points[0].reason == points[1].reason
    assert points[0].reason.startswith("[cage] pocket_clearance must be smaller than the gap")
    assert finder._state.cache_info().misses == 1


def test_a_map_without_friction_is_refused(study):
    """A friction is asked for where no axis is it."""
    bare = replace(study, ranking=None, cage=replace(study.cage, ball_cage_friction=None))
    with pytest.raises(InputError, match="ball_cage_friction is missing"):
        stability_map(question(bare, y=KICKS))
