"""Ranks, ties, means, reasons and gaps of a ranking, on a cage whose ensemble takes no time."""

import math
from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

from separatrix import Candidate, Friction, Material, RankingQuestion, StabilitySettings, moving_cage, solve
from separatrix.chain.pocket_friction import with_scatter
from separatrix.study.reading import read_study
from separatrix.study.study import CageModel
from separatrix.verdict.beyond_models import Pocket
from separatrix.verdict.judgement import Judgement, Verdict, judge, transmitted_force
from separatrix.verdict.long_jobs import NAME, Interrupted, Ledger, Runner
from separatrix.verdict.ranking import Asked, _row, rank
from separatrix.verdict.ranking_records import (
    MeanFriction,
    NotFinished,
    NotMeasured,
    Ranked,
    margin_interval,
    may_be_lower,
    measured,
    meet,
    overall,
    ranks,
    safety_interval,
    same_rank,
)
from separatrix.verdict.reasons import CageMotion

IN_AIR = {"air": Friction(mean=0.3)}
QUICK = StabilitySettings(kicks=(0.5,), runs=8, duration=0.004, restitution_factors=(0.3, 0.6), seed=1)


def quick_study(**changes):
    """The shipped study with an ensemble of no weight."""
    return replace(read_study("cryogenic-turbopump"), **{"stability": QUICK} | changes)


def asked(*candidates, environments=("air",)):
    """A question about candidates given as (name, friction or None)."""
    return RankingQuestion(
        environments=environments,
        candidates=tuple(Candidate(name=n, friction=dict.fromkeys(environments, f)) for n, f in candidates),
    )


def judgement(**given):
    """A verdict whose evidence is 0 where it is not given, without the checks of a real one."""
    one = object.__new__(Judgement)
    values = dict.fromkeys((f.name for f in fields(Judgement)), 0.0)
    values |= {"verdict": Verdict.STABLE, "cage_motion": next(iter(CageMotion)), "reason": "So it is."}
    for name, value in (values | {"pocket_impact_shares": (0.0,) * 3} | given).items():
        object.__setattr__(one, name, value)
    return one


def ranked(name, stiffness, eta, threshold, half):
    """A candidate with this threshold and the half width of its interval."""
    values = dict.fromkeys((f.name for f in fields(Ranked)), None) | {"extrapolation": (), "reason": ""}
    ends = {"restitution_threshold_low": threshold - half, "restitution_threshold_high": threshold + half}
    values |= {"name": name, "ball_cage_stiffness": stiffness, "restitution_factor": eta, **ends}
    values |= {"restitution_threshold": threshold, "margin": threshold - eta, "judgement": judgement()}
    return Ranked(**values)


@pytest.mark.parametrize(
    "thresholds",
    [
        [(0.8, 0.7, 0.9), (0.75, 0.65, 0.85), (0.3, 0.2, 0.4)],
        [(0.80, 0.7, 0.9), (0.65, 0.55, 0.75), (0.5, 0.4, 0.6)],
        [(0.5, 0.5, 0.5), (0.5, 0.5, 0.5), (0.4, 0.4, 0.4)],
    ],
)
def test_ties_share_the_lowest_rank(thresholds):
    """Two overlap; the third does not reach the first and leads its own group."""
    assert ranks(thresholds, lambda i, leader: meet(thresholds[i], thresholds[leader])) == [1, 1, 3]


@pytest.mark.parametrize("interval", [margin_interval, safety_interval])
def test_of_one_cage_frictions_decide_who_is_tied(interval):
    """Wide intervals of one cage do not tie what friction tells apart; those of two cages do."""
    known = {name: MeanFriction(f, 0.09 * f) for name, f in (("A", 0.08), ("B", 0.09), ("C", 0.11))}
    a, b, c = (
        replace(
            ranked(name, 3e6, 0.3, t, 0.1),
            safety_factor=2.0 * t,
            safety_factor_low=2.0 * t - 0.3,
            safety_factor_high=2.0 * t + 0.3,
        )
        for name, t in (("A", 0.74), ("B", 0.7), ("C", 0.6))
    )
    assert same_rank(b, a, known, interval)
    assert not same_rank(c, a, known, interval)  # 2.5 standard deviations; the intervals meet
    for other in ({"ball_cage_stiffness": 4e6}, {"cage_mass": 0.05}, {"pocket_clearance": 5e-4}):
        assert same_rank(replace(c, **other), a, known, interval)
    alike = replace(c, margin=a.margin, safety_factor=a.safety_factor)  # such as 1: stable at any factor
    assert same_rank(alike, a, known, interval)


def test_a_safety_factor_beyond_what_was_searched_ranks_by_its_bound():
    """The lowest friction is first; a friction of 0 before all, one that a land drives behind all."""
    rows = [ranked(name, 3e6, 0.3, 0.5, 0.1) for name in "ABCD"]
    rows[3] = replace(rows[3], judgement=judgement(verdict=Verdict.UNSTABLE, driven_by_land=True))
    bounds = [(None, 1.0 / 0.3, None), (None, 1.0 / 0.05, None), (None, None, None), (None, None, None)]
    names = ("safety_factor", "safety_factor_low", "safety_factor_high")
    rows = [replace(row, **dict(zip(names, one, strict=True))) for row, one in zip(rows, bounds, strict=True)]
    values = [safety_interval(row)[0] for row in rows]
    assert values == [1.0 / 0.3, 1.0 / 0.05, math.inf, 0.0]
    assert not same_rank(rows[3], rows[0], {}, safety_interval)  # whatever their frictions


def test_where_eta_differs_the_margin_ranks():
    """Threshold 0.9 at eta 0.5 stands behind 0.8 at eta 0.1; equal thresholds of two curves do not tie."""
    given = (("A", 1e6, 0.5, 0.9), ("B", 3e6, 0.1, 0.8), ("C", 2e6, 0.3, 0.9))
    rows = [ranked(name, stiffness, eta, t, 0.02) for name, stiffness, eta, t in given]
    known = {row.name: MeanFriction(0.1, 0.01) for row in rows}
    margins = [margin_interval(row) for row in rows]
    found = ranks(margins, lambda i, leader: same_rank(rows[i], rows[leader], known, margin_interval))
    assert found == [3, 1, 2]


def test_who_may_have_the_lower_friction_is_told_at_five_per_cent():
    """The difference of logarithms over its standard deviation, at 1.64."""
    leader = MeanFriction(0.1, 0.001)
    at = 0.1 * math.exp(1.6449 * 0.01 * math.sqrt(2.0))
    assert may_be_lower(MeanFriction(at * 0.9999, at * 0.01), leader)
    assert not may_be_lower(MeanFriction(at * 1.0001, at * 0.01), leader)


def test_scatter_of_the_friction_becomes_a_standard_error_of_its_mean():
    """Deviation over the root of a count; of two environments half the root of the sum of squares."""
    assert measured(Friction(mean=0.12, standard_deviation=0.02)).error == pytest.approx(0.02)
    found = measured(Friction(mean=0.12, standard_deviation=0.02, count=4))
    assert found.error == pytest.approx(0.01)
    assert found.interval() == pytest.approx((0.12 - 0.0196, 0.12 + 0.0196))
    # a blank of the table is absent, never 0
    assert overall([None, Friction(mean=0.2), Friction(mean=0.4)]).mean == pytest.approx(0.3)
    assert overall([None, None]) is None
    both = [Friction(mean=0.2, standard_deviation=0.03, count=9), Friction(mean=0.4, standard_error=0.04)]
    assert overall(both).error == pytest.approx(math.hypot(0.01, 0.04) / 2, rel=1e-12)  # rounding


def test_outside_the_tests_a_mean_is_known_less_well():
    """The widening is part of the error of the mean, once, and so of probabilities and tie groups."""
    inside = Friction(mean=0.12, standard_deviation=0.02, standard_error=0.003)
    outside = replace(inside, standard_deviation=math.hypot(0.02, 0.04), widening=0.04)
    assert measured(inside).error == 0.003
    assert measured(outside).error == pytest.approx(math.hypot(0.003, 0.04))
    assert with_scatter(outside, 0.09) == outside
    other = Friction(mean=0.15, standard_error=0.003)
    assert not may_be_lower(measured(other), measured(inside))
    assert may_be_lower(measured(other), measured(outside))


def test_a_missing_measurement_is_shown_as_missing():
    """A row of another type, last; the others are ranked without it."""
    question = RankingQuestion(
        environments=("air", "vacuum"),
        environment="air",
        candidates=(
            Candidate(name="B", friction={"air": None, "vacuum": Friction(mean=0.3)}),
            Candidate(name="A", friction={"air": Friction(mean=0.9), "vacuum": Friction(mean=0.1)}),
        ),
    )
    found = rank(quick_study(ranking=question))
    a, b = found.environments[0].materials
    assert (a.name, a.rank) == ("A", 1)
    assert b == NotMeasured(name="B", reason="not measured in air")
    assert [(row.name, row.friction) for row in found.overall] == [("B", 0.3), ("A", 0.5)]


def test_a_row_carries_the_judgement_behind_its_verdict():
    """That of its friction, as it is."""
    study = quick_study(ranking=asked(("A", Friction(mean=0.1))))
    study = replace(study, cage=replace(study.cage, model=CageModel.PAPER))
    (a,) = rank(study).environments[0].materials
    assert a.margin == a.restitution_threshold - a.restitution_factor
    solution = solve(study)
    cage = moving_cage(solution, 0.1)
    capacity = transmitted_force(solution)
    assert a.judgement == judge(cage, Runner().whole_ensemble(cage, QUICK), capacity=capacity)
    assert (a.judgement.ball, a.judgement.ball_reason) == ("damper", None)


def test_scatter_of_the_friction_widens_the_threshold():
    """A friction known to 0.04 leaves a wider threshold than one taken as exact."""
    exact, scattered = (
        rank(quick_study(ranking=asked(("A", friction)))).overall[0]
        for friction in (Friction(mean=0.12), Friction(mean=0.12, standard_deviation=0.04, count=4))
    )
    assert scattered.restitution_threshold == exact.restitution_threshold
    assert scattered.restitution_threshold_low < exact.restitution_threshold_low
    assert scattered.restitution_threshold_high > exact.restitution_threshold_high


def test_an_interrupt_leaves_a_ranking_that_says_so_and_goes_on(tmp_path):
    """What was finished stays, what was not has that reason; with its ledger the rest gives the whole."""

    def stop(done, total):
        if done > 0.6 * total:
            raise KeyboardInterrupt

    two = asked(("A", Friction(mean=0.1)), ("B", Friction(mean=0.2)))
    long = replace(QUICK, runs=64)
    study, ledger = quick_study(ranking=two, stability=long), Ledger(tmp_path / NAME)
    with pytest.raises(Interrupted) as caught:
        rank(study, runner=Runner(progress=stop, ledger=ledger))
    found = caught.value.finished
    assert not found.complete
    for row in found.overall:
        assert isinstance(row, NotFinished)
        assert row.reason.removesuffix(".").endswith("interrupted before this was computed")
    assert any(row.judgement for row in found.overall)
    assert repr(rank(study, runner=Runner(ledger=ledger))) == repr(rank(study))
    assert ledger.taken > 0
    ledger.close()


def test_each_candidate_has_the_stiffness_of_its_own_pocket():
    """Without a given stiffness a stiffer material has a stiffer pocket and gets back less speed."""
    study = quick_study()
    soft = Material(name="soft", elastic_modulus=2e9, poisson_ratio=0.4)
    walls = soft, replace(soft, name="stiff", elastic_modulus=4e9)
    candidates = tuple(Candidate(name=m.name, friction=IN_AIR, material=m) for m in walls)
    cage = replace(study.cage, ball_cage_stiffness=None, material=None)
    question = RankingQuestion(environments=("air",), candidates=candidates)
    found = rank(replace(study, cage=cage, ranking=question)).overall
    soft_one, stiff_one = sorted(found, key=lambda row: row.ball_cage_stiffness)
    assert (soft_one.name, stiff_one.name) == ("soft", "stiff")
    assert soft_one.restitution_factor > stiff_one.restitution_factor
    for row, candidate in ((soft_one, candidates[0]), (stiff_one, candidates[1])):
        lonely = replace(question, candidates=(candidate,))
        (alone,) = rank(replace(study, cage=cage, ranking=lonely)).overall
        assert repr(replace(row, rank=1)) == repr(alone)


def test_a_cage_by_its_shape_has_the_mass_of_each_candidate():
    """Its density where it is known, else that of the cage's material; a stated mass is that of all."""
    study = quick_study()
    wall = Material(name="light", elastic_modulus=3e9, poisson_ratio=0.4, density=1300.0)
    walls = (wall, replace(wall, name="heavy", density=8800.0), replace(wall, name="unknown", density=None))
    candidates = tuple(Candidate(name=m.name, friction=IN_AIR, material=m) for m in walls)
    ring = {"inner_diameter": 61e-3, "outer_diameter": 69e-3, "width": 15e-3}
    cage = replace(study.cage, mass=None, material=wall, land_diameter=None, **ring)
    question = RankingQuestion(environments=("air",), candidates=candidates)
    found = {row.name: row for row in rank(replace(study, cage=cage, ranking=question)).overall}
    heavy = 8800.0 / 1300.0 * found["light"].cage_mass
    assert found["heavy"].cage_mass == pytest.approx(heavy, rel=1e-12)  # rounding of one product
    assert found["unknown"].cage_mass == found["light"].cage_mass
    assert found["heavy"].restitution_factor != found["light"].restitution_factor
    given = rank(replace(study, cage=replace(cage, mass=0.02), ranking=question)).overall
    assert {row.cage_mass for row in given} == {0.02}


@pytest.mark.parametrize("bad", [np.inf, np.nan])
def test_a_row_whose_evidence_is_not_finite_has_a_reason_and_no_verdict(bad):
    """Every number of it is absent, so that the answer can be written."""
    eta = SimpleNamespace(restitution_factor=0.3)
    pocket = Pocket(0.02, 1e6, 1e-4, 0.0)
    cages = {pocket: SimpleNamespace(restitution=eta)}
    rest = {"longer": None, "settings": SimpleNamespace(runs=16)}
    question = SimpleNamespace(pockets={"A": pocket}, cages=cages, spreads={}, **rest)
    evidence = judgement(largest_contact_force=float(bad))
    found = {Asked(pocket, 0.1): evidence}
    row = _row(question, found, "A", "air", MeanFriction(0.1, 0.01))
    assert isinstance(row, NotFinished)
    assert row.judgement is None
    assert row.reason.startswith(
        f"no verdict: largest contact force is {float(bad)}. The inputs are far from"
    )
