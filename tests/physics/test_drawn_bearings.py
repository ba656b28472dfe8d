"""Runs that draw their own bearing: limits, a probability counted another way, frictions of each pocket."""

from dataclasses import replace

import numpy as np
import pytest
from cages import with_distributions
from commands import extended, written
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr

from separatrix import InputError, RunOutcome, Verdict, judge, moving_cage, read_study, run_ensemble, solve
from separatrix.cage.disturbance import settings_for
from separatrix.friction.friction_fit import TestedFriction
from separatrix.study.candidates import environment_of
from separatrix.study.study import Candidate, Friction, RankingQuestion
from separatrix.study.uncertain import normal, samples, uniform
from separatrix.verdict.draws import (
    Case,
    drawn_bearings,
    next_cage_deviation,
    sample,
    sobol_points,
    uncertain_inputs,
)
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.ranking import rank

PLACE = "liquid nitrogen, 440C"
CASE = Case("A")
FRICTION = f"ranking.A.{PLACE}"


def study_of(friction, **given):
    """The shipped study with one candidate, and some of its numbers uncertain."""
    shipped = read_study("cryogenic-turbopump", "paper")
    candidate = Candidate(name="A", friction={PLACE: Friction(mean=friction)})
    ranking = replace(shipped.ranking, candidates=(candidate,), environments=(PLACE,))
    study = replace(shipped, ranking=ranking, cage=replace(shipped.cage, material=None, material_name=""))
    return with_distributions(study, {key.replace("__", "."): one for key, one in given.items()})


def test_inputs_that_hardly_vary_give_the_runs_of_a_certain_study():
    """Mass and friction to 1e-12 of themselves: the same runs, so the same counts from every kick."""
    study = study_of(0.2, cage__mass=normal(mean=0.025, standard_deviation=2.5e-14))
    study = with_distributions(study, {FRICTION: normal(mean=0.2, standard_deviation=2e-13)})
    drawn = drawn_bearings(study, 8)
    central = solve(study)
    cage = moving_cage(central, 0.2)
    settings = settings_for(study.stability, cage)
    certain = judge(cage, run_ensemble(cage, settings, runs=8))
    found = drawn.judge(CASE, settings.kicks, Runner())
    # settled and whirling runs alike: a change of 1e-12 is a different motion after some impacts
    assert [count.settles for count in found.by_kick] == [count.settles for count in certain.by_kick]


def test_no_draw_of_a_wide_friction_is_left_out():
    """Of mean 0.5 and scatter 1 a few in a hundred exceed 2: left out, they made a cage look stable."""
    study = study_of(0.5)
    wide = Friction(mean=0.5, standard_deviation=1.0, count=8)
    candidate = replace(study.ranking.candidates[0], friction={PLACE: wide})
    found = drawn_bearings(replace(study, ranking=replace(study.ranking, candidates=(candidate,))), 64)
    assert found.failures == ()
    assert np.count_nonzero(found.friction[CASE] == 2.0) > 0


def test_the_probability_is_that_of_counting_over_the_distribution():
    """Friction between 0.1 and 0.3: the mean of P(settles) counted at frictions one by one, by other runs."""
    study = with_distributions(study_of(0.2), {FRICTION: uniform(low=0.1, high=0.3)})
    central = solve(study)
    settings, runs = settings_for(study.stability, moving_cage(central, 0.2)), 256
    kick = settings.kicks[1]
    found = drawn_bearings(study, runs).judge(CASE, (kick,), Runner())
    middles = np.linspace(0.1, 0.3, 33)[1::2]  # of 16 equal parts
    how = {"kicks": (kick,), "runs": 16, "first_run": 5000}
    others = [run_ensemble(moving_cage(central, f), settings, **how) for f in middles]
    shares = [one.count(RunOutcome.SETTLES)[0] / 16 for one in others]
    assert 0.2 < np.mean(shares) < 0.8
    # 256 runs each: standard deviations of at most 0.031, of their difference 0.044, 2.5 times that
    assert found.probability_stable == pytest.approx(np.mean(shares), abs=0.11)


def test_a_friction_from_tests_follows_the_pocket_of_its_draw(tmp_path):
    """A power law of slip speed: the drawn friction times what the tests say at the draw's own speed."""
    rows = [
        f'[[test]]\nmaterial = "A"\ncounterface = "440C"\nmedium = "liquid nitrogen"\n'
        f'slip_speed = "{v} m/s"\n'
        f'friction = {0.1 * (v / 20.0) ** 0.4 * scatter}\npressure = "60 MPa"\ntemperature = "77 K"\n'
        for v, scatter in zip((5.0, 12.0, 30.0, 60.0), (1.02, 0.97, 1.01, 1.0), strict=True)
    ]
    written(tmp_path, "\n".join(rows), "friction.toml")
    speed, friction = 'inner_speed = "15000 rpm +- 20 %"', 'friction = "friction.toml"'
    study = extended(tmp_path, f"[operation]\n{speed}\n[ranking]\n{friction}\n")
    drawn = drawn_bearings(study, 8)
    draws = sample(study, 8, frictions=drawn.stated)
    column = draws.names.index(FRICTION)
    central = drawn.stated[CASE].mean
    ratios = []
    for run in range(8):
        changed = draws.setter()(draws.values[run].tolist())
        unchanged = solve(changed, study.ranking.candidates[0])  # the law, not its draw
        ratios.append(unchanged.frictions[PLACE].mean / central)
        # the same law by two ways: rounding
        assert drawn.friction[CASE][run] == pytest.approx(draws.values[run, column] * ratios[-1], rel=1e-9)
    assert max(ratios) / min(ratios) > 1.05


def test_draws_that_make_no_bearing_are_left_out_and_counted():
    """Each size alone fits; the larger balls on the smaller pitch circle do not."""
    shipped = read_study("cryogenic-turbopump").bearing
    largest = 0.9 * shipped.pitch_diameter * np.sin(np.pi / shipped.ball_count)
    given = {
        "bearing.ball_diameter": samples(values=(shipped.ball_diameter, largest)),
        "bearing.pitch_diameter": samples(values=(0.97 * shipped.pitch_diameter, shipped.pitch_diameter)),
    }
    found = drawn_bearings(with_distributions(study_of(0.1), given), 16)
    assert 0 < len(found.failures) < 16
    assert len(found.runs) == len(found.solved) == 16 - len(found.failures)
    assert found.friction[CASE].shape == (len(found.runs),)


def test_rank_shows_both_verdicts_only_where_inputs_are_uncertain():
    """At central values, and over the stated inputs; a study without any has the first alone."""
    few = {"runs": 4, "restitution_factors": (0.5,)}
    certain = study_of(0.05)
    certain = replace(certain, stability=replace(certain.stability, **few))
    row = rank(certain, runner=Runner(jobs=2)).environments[0].materials[0]
    assert row.over_inputs is None
    uncertain = with_distributions(certain, {"cage.mass": normal(mean=0.025, standard_deviation=0.002)})
    row = rank(uncertain, runner=Runner(jobs=2)).environments[0].materials[0]
    both = row.judgement.verdict, row.over_inputs.verdict
    assert (*both, row.over_inputs.runs) == (Verdict.STABLE, Verdict.STABLE, 4)
    assert row.over_inputs.probability_low < row.over_inputs.probability_stable == 1.0


# Quasi-random draws: what holds whatever the study, the number of samples and the seed.

BASE = read_study("cryogenic-turbopump")
LAWS = {
    "film.thickness": normal(mean=5e-7, standard_deviation=1e-7),
    "bearing.pitch_diameter": samples(values=(0.0648, 0.065)),
    "operation.axial_load": uniform(low=2500.0, high=3500.0),
}
UNCERTAIN = with_distributions(BASE, LAWS)

FEW = settings(max_examples=30)


@FEW
@given(st.integers(1, 300), st.integers(1, 300), st.integers(0, 2**40), st.integers(1, 8))
def test_fewer_samples_are_the_first_of_more(few, more, seed, dimensions):
    """A study can be carried on: what was drawn stays drawn, to the last bit."""
    low, high = sorted((few, more))
    first, points = (sobol_points(samples, dimensions, seed) for samples in (low, high))
    assert np.array_equal(first, points[:low])


@FEW
@given(st.integers(0, 10), st.integers(0, 2**62))
def test_every_dimension_is_stratified_inside_the_cube(power, seed):
    """A power of two of points has exactly one in each of as many equal cells, along every axis."""
    points = sobol_points(2**power, 5, seed)
    cells = np.sort(np.floor(points * 2**power).astype(int), axis=0)
    # Each is in the middle of its cell of 2**-30, so none is 0 or 1, where a quantile has its end.
    assert (cells == np.arange(2**power)[:, None]).all()
    assert (np.mod(points * 2.0**31, 2.0) == 1.0).all()
    assert 0.0 < points.min() <= points.max() < 1.0


@FEW
@given(st.integers(0, 2**20))
def test_the_same_seed_gives_the_same_draws_and_leaves_global_chance_alone(seed):
    """Nothing but study, number and seed decides."""
    np.random.seed(1)  # noqa: NPY002 - what must not matter
    first = sample(UNCERTAIN, 16, seed)
    state = np.random.get_state()[1].copy()  # noqa: NPY002
    again = sample(UNCERTAIN, 16, seed)
    assert np.array_equal(first.values, again.values)
    assert np.array_equal(state, np.random.get_state()[1])  # noqa: NPY002
    other = sample(UNCERTAIN, 16, seed + 1)
    assert not np.array_equal(first.probabilities, other.probabilities)


@FEW
@given(st.integers(1, 200), st.integers(0, 2**20))
def test_every_draw_lies_in_its_distribution(samples, seed):
    """Columns stand in the order of the inputs, each within its ends; samples are drawn as they are."""
    draws = sample(UNCERTAIN, samples, seed)
    for i, one in enumerate(draws.inputs):
        assert draws.values[:, i].min() >= one.distribution.low
        assert draws.values[:, i].max() <= one.distribution.high
    assert set(draws.values[:, draws.names.index("bearing.pitch_diameter")]) <= {0.0648, 0.065}


def test_inputs_are_those_of_the_study_then_the_measured_frictions():
    """First what the file says, in its order; then each friction of the bearing's environment."""
    inputs = uncertain_inputs(UNCERTAIN)
    assert tuple(one.key for one in inputs[:3]) == tuple(LAWS)
    assert [one.source for one in inputs[:3]] == ["study"] * 3
    frictions = inputs[3:]
    measured = [one.friction[environment_of(BASE.ranking)] for one in BASE.ranking.candidates]
    assert len(frictions) == len(measured)
    for one, friction in zip(frictions, measured, strict=True):
        assert one.key.startswith("ranking.")
        assert one.source == "assumed"
        assert one.distribution.standard_deviation == pytest.approx(0.09 * friction.mean, rel=1e-12)


@pytest.mark.parametrize(
    ("friction", "deviation", "source"),
    [
        (Friction(mean=0.1), 0.009, "assumed"),
        (Friction(mean=0.1, standard_deviation=0.02), 0.02, "measured"),
        (Friction(mean=0.1, standard_deviation=0.02, count=4), 0.02 * 1.25**0.5, "measured"),
        (Friction(mean=0.1, standard_deviation=0.03, standard_error=0.04), 0.05, "measured"),
        (Friction(mean=0.1, standard_deviation=0.03, assumed_scatter=True), 0.03, "assumed"),
    ],
)
def test_the_next_cage_scatters_more_than_the_mean(friction, deviation, source):
    """The scatter of one sample and the error of the mean add in quadrature; nothing known is 9 %."""
    found = next_cage_deviation(friction, 0.09)
    assert found == (pytest.approx(deviation, rel=1e-12), source)


def of_friction(**known):
    """A study with one candidate of this friction in air."""
    tested = Candidate(name="Tested", friction={"air": Friction(**known)})
    return replace(BASE, ranking=RankingQuestion(environments=("air",), candidates=(tested,)))


def test_a_friction_whose_scatter_reaches_zero_is_log_normal():
    """No draw of a friction is negative, the mean stays the measured one; 0 without scatter is certain."""
    assert uncertain_inputs(of_friction(mean=0.0)) == ()
    draws = sample(of_friction(mean=0.05, standard_deviation=0.02), 1024)
    assert draws.inputs[0].distribution.kind == "log-normal"
    assert draws.values.min() > 0.0
    assert draws.values.mean() == pytest.approx(0.05, rel=2e-3)  # 1024 points, 40 % wide, error near 1/n


def of_tests(**known):
    """The same, where a fit to tests foretells the friction."""
    law = TestedFriction(material="Tested", environment="air", tests=(), default_scatter=0.09)
    return of_friction(law=law, **known)


def test_a_friction_that_tests_foretell_is_drawn_about_its_median():
    """A fit says median and scatter of the logarithm: 0.3 and 0.4 in quadrature make 0.5."""
    known = {"mean": 0.08, "standard_error": 0.3 * 0.08, "standard_deviation": 0.4 * 0.08}
    (one,) = uncertain_inputs(of_tests(**known))
    levels = ndtr(np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
    found = np.log(one.distribution.quantile(levels) / 0.08)
    assert found == pytest.approx([-1.0, -0.5, 0.0, 0.5, 1.0], abs=1e-5)  # the cut at 5 standard deviations


REFUSED = [
    (lambda: sample(UNCERTAIN, 0), "samples must be a whole number from 1"),
    (lambda: sample(UNCERTAIN, 2**20 + 1), "must be a whole number from 1"),
    (lambda: sample(replace(BASE, name="certain", ranking=None), 16), "certain has no uncertain number"),
    (lambda: uncertain_inputs(of_friction(mean=0.0, standard_deviation=0.1)), "mean must be > 0"),
    (lambda: uncertain_inputs(of_tests(mean=0.08, standard_error=0.0, standard_deviation=0.9)),
     "tests of Tested in air must not scatter by ten times"),
]  # fmt: skip


@pytest.mark.parametrize(("draw", "words"), REFUSED)
def test_what_cannot_be_drawn_is_refused(draw, words):
    """Too few, too many, or nothing uncertain; a zero that scatters; a friction known to ten powers of e."""
    with pytest.raises(InputError, match=words):
        draw()
