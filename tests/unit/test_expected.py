"""The time that a ranking will take, estimated from runs that are timed by a clock of the test's own."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from separatrix.cage import settings_for
from separatrix.cage_choice import required_environment
from separatrix.chain.solution import solve
from separatrix.explore import expected
from separatrix.study import BallModel, StabilitySettings
from separatrix.study_file import read_study


@pytest.fixture
def timed(monkeypatch):
    """Runs that last by their duration and their ball's model; rates in seconds a simulated second."""
    rates, clock, runs_made = {BallModel.DAMPER: 0.1, BallModel.TRACTION: 0.1}, [0.0], []

    def run_ensemble(cage, settings, *, runs, kicks=None):
        ball = BallModel.DAMPER if cage.traction is None else BallModel.TRACTION
        took = rates[ball] * settings.duration * runs * len(kicks or settings.kicks)
        clock[0] += took
        runs_made.append(took)
        return np.zeros((len(settings.kicks), runs))

    monkeypatch.setattr(expected, "run_ensemble", run_ensemble)
    clocks = SimpleNamespace(perf_counter=lambda: clock[0], monotonic=lambda: clock[0])
    monkeypatch.setattr(expected, "time", clocks)
    return SimpleNamespace(rates=rates, clock=clock, runs=runs_made)


SETTINGS = StabilitySettings(kicks=(0.1, 0.5), runs=64, duration=0.3)


def in_space(**cage):
    """The shipped study with its cage changed."""
    study = read_study("cryogenic-turbopump")
    return replace(study, stability=SETTINGS, cage=replace(study.cage, **cage))


def test_a_slow_run_is_not_timed_whole(timed):
    """At 1000 s a simulated second one run takes 300 s; 64 from each of two kicks are foreseen."""
    timed.rates[BallModel.DAMPER] = 1e3
    cage = solve(in_space()).cage_with(0.1)
    found = expected.expected_verdicts(cage, SETTINGS, [0.1], jobs=2)
    # in every test here 1e-9 is for the rounding of a clock that adds up
    assert found == pytest.approx(1e3 * 0.3 * 64 * 2 / 2, rel=1e-9)
    assert sum(timed.runs) < expected.LONGEST_SAMPLE


def test_a_fast_run_is_timed_whole(timed):
    """Runs that end early take less than their share: they are timed to their end, one from each kick."""
    cage = solve(in_space()).cage_with(0.1)
    found = expected.expected_verdicts(cage, SETTINGS, [0.1], jobs=1)
    assert found == pytest.approx(0.1 * 0.3 * 64 * 2, rel=1e-9)
    assert timed.runs[-1] == pytest.approx(0.1 * 0.3 * 2)


def test_second_verdicts_are_foreseen(timed):
    """16 runs from each kick with the other ball, for every friction of the bearing's own environment."""
    study = in_space()
    few = expected.expected_ranking(study, jobs=1)
    timed.rates[BallModel.TRACTION] = 1e3
    more = expected.expected_ranking(study, jobs=1)
    solution, environment = solve(study), required_environment(study, study.ranking)
    kicks = settings_for(solution.stability, solution.cage_with(0.0)).kicks
    measured = {
        found.mean
        for one in study.ranking.candidates
        if (found := solve(study, one).frictions[environment]) is not None
    }
    # in the first estimate the same runs take 1e-4 of this
    assert more - few == pytest.approx(1e3 * 0.3 * 16 * len(kicks) * len(measured), rel=1e-3)
    weak = replace(study, stability=replace(SETTINGS, kicks=(1e-3,), reference_kick=1e-3))
    assert expected.expected_ranking(weak, jobs=1) < few
