"""The time that a verb will take, estimated from runs that are timed by a clock of the test's own."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from separatrix.cage import moving_cage
from separatrix.cage.rows import LANES
from separatrix.chain.solution import solve
from separatrix.explore import expected
from separatrix.study.reading import read_study
from separatrix.study.study import StabilitySettings

STUDY = read_study("cryogenic-turbopump")
SETTINGS = StabilitySettings(kicks=(0.1, 0.5), reference_kick=0.5, runs=64)
SOLUTION = solve(replace(STUDY, stability=SETTINGS))


@pytest.fixture
def timed(monkeypatch):
    """Runs of half a second each; what was run, in order."""
    clock, made = [0.0], []

    class Slow:
        def ensemble(self, cage, _, *, kicks, runs):
            clock[0] += 0.5 * runs * len(kicks)
            made.append((cage.ball_cage_friction, runs))

        def alone(self, work):
            return work()

    monkeypatch.setattr(expected, "Runner", Slow)
    monkeypatch.setattr(expected, "time", SimpleNamespace(perf_counter=lambda: clock[0]))
    return made


def test_verdicts_are_counted_by_the_time_of_a_run(timed):
    """64 runs from each of two kicks, at three frictions, on two threads."""
    found = expected._of_verdicts(SOLUTION, [0.1, 0.2, 0.3], 64, jobs=2)
    assert found == pytest.approx(0.5 * 64 * 2 * 3 / 2, rel=1e-9)  # rounding of a clock that adds up


def test_no_more_is_timed_once_that_took_long(timed):
    """One run loads the code, as many as go side by side are timed: of five frictions only the first."""
    expected._of_verdicts(SOLUTION, [0.1, 0.15, 0.2, 0.25, 0.3], 64, jobs=1)
    assert timed == [(0.1, 1), (0.1, LANES)]


def test_a_curve_with_its_band_takes_longer(timed):
    """And in proportion to its points."""
    cage = moving_cage(SOLUTION, 0.0)
    three, six = (tuple(i / 8 for i in range(1, n + 1)) for n in (3, 6))
    few, many = (replace(SETTINGS, restitution_factors=etas) for etas in (three, six))
    without, band = (expected.expected_curve(cage, few, jobs=1, band=one) for one in (False, True))
    assert without < band
    assert expected.expected_curve(cage, many, jobs=1, band=True) > 1.7 * band
