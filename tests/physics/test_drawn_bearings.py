"""Runs that draw their own bearing: limits, a probability counted another way, frictions of each pocket."""

from dataclasses import replace

import numpy as np
import pytest
from cages import with_distributions

from separatrix.cage import RunOutcome, moving_cage, run_ensemble
from separatrix.cage.disturbance import settings_for
from separatrix.chain.solution import solve
from separatrix.study.distribution import normal, samples, uniform
from separatrix.study.reading import read_study
from separatrix.study.study import Candidate, Friction
from separatrix.verdict.draws import Case, drawn_bearings, sample
from separatrix.verdict.judgement import Verdict, judge
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
    (tmp_path / "friction.toml").write_text("\n".join(rows), encoding="utf-8")
    (tmp_path / "study.toml").write_text(
        'extends = "cryogenic-turbopump"\n[operation]\ninner_speed = "15000 rpm +- 20 %"\n'
        '[ranking]\nfriction = "friction.toml"\n',
        encoding="utf-8",
    )
    study = read_study(tmp_path / "study.toml")
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
