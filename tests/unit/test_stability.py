"""Counting, crossing and inverting, without any cage: counts that know their probabilities."""

import math
import re
from itertools import accumulate

import numpy as np
import pytest

from separatrix import Runner, critical_friction, read_study, restitution_threshold, solve
from separatrix.cage import Cause, RunOutcome, moving_cage, run_ensemble
from separatrix.chain.impact_restitution import damping_ratio, restitution_factor
from separatrix.study.study import BallModel, StabilitySettings
from separatrix.verdict import long_jobs as runner
from separatrix.verdict import stability_curve
from separatrix.verdict.critical_friction import (
    LADDER,
    Count,
    Crossing,
    Response,
    Side,
    cage_at,
    cell_of,
    responses,
)
from separatrix.verdict.stability_curve import (
    FACTORS,
    CriticalFriction,
    own_restitution_factor,
    own_threshold,
)

SHIPPED = solve(read_study("cryogenic-turbopump"))
CAGE = moving_cage(SHIPPED, 0.1)


def response(probability, runs=64):
    """Response whose counts are, run by run, as near to the probability as whole numbers allow."""
    due = {}

    def look(friction, first_run, count):
        before = due.get(friction, 0.0)
        due[friction] = before + count * probability(friction)
        return Count(math.floor(due[friction] + 0.5) - math.floor(before + 0.5), count)

    return Response(look, runs)


def logistic(middle, slope):
    """P(whirl) logistic in ln f."""
    return lambda f: 1.0 / (1.0 + (middle / f) ** slope) if f > 0.0 else 0.0


@pytest.mark.parametrize("slope", [5.0, 10.0, 20.0])
@pytest.mark.parametrize("guess", [0.03, 0.1, 0.8])
@pytest.mark.parametrize("target", [0.1, 0.5, 0.9])
def test_a_crossing_is_found_from_any_guess(guess, slope, target):
    """A logistic P passes its target where algebra says, inside the interval, and nearer than its half."""
    at = 0.12 * (target / (1.0 - target)) ** (1.0 / slope)
    found = response(logistic(0.12, slope)).crossing(target, 96, guess)
    assert found.low < at < found.high
    assert abs(math.log(found.value / at)) < 0.5 * math.log(found.high / found.low)


def test_the_interval_shrinks_with_the_root_of_the_runs():
    """Sixteen times the runs, a quarter of the interval; 30 %, for runs stand on a ladder."""

    def width(runs):
        found = response(logistic(0.1, 8.0), runs).crossing(0.5, runs, 0.1)
        return math.log(found.high / found.low)

    assert width(64) / width(1024) == pytest.approx(4.0, rel=0.3)


def known_responses(seed):
    """Counts of a known probability, whatever the cage: binomial luck, the same for the same runs."""

    def look(friction, first_run, runs):
        numbers = np.random.default_rng((seed, round(1e9 * friction), first_run))
        return Count(int(numbers.binomial(runs, logistic(0.12, 8.0)(friction))), runs)

    return lambda _cage, settings, kicks, _runner: {kick: Response(look, settings.runs) for kick in kicks}


def test_the_band_goes_from_a_tenth_that_grow_to_nine_tenths(monkeypatch):
    """Where algebra says: the mean of 16, each good to 6 %, lies within 4 %; a fifth would be 10 % off."""
    settings, found = StabilitySettings(kicks=(0.5,), runs=256), []
    for seed in range(16):
        monkeypatch.setattr(stability_curve, "responses", known_responses(seed))
        found.append(critical_friction(CAGE, 0.5, settings))
    for end, at in (("_low", 0.12 / 9 ** (1 / 8)), ("", 0.12), ("_high", 0.12 * 9 ** (1 / 8))):
        mean = np.mean([getattr(point, f"critical_friction{end}") for point in found])
        assert mean == pytest.approx(at, rel=0.04)


def at_three_kicks(monkeypatch, *probabilities):
    """Critical friction where the probability of each kick is known: 0.2, 0.5 and 1 m/s."""
    kicks = (0.2, 0.5, 1.0)
    settings = StabilitySettings(kicks=kicks, reference_kick=0.5, runs=256)
    known = {kick: response(one, 256) for kick, one in zip(kicks, probabilities, strict=True)}
    monkeypatch.setattr(stability_curve, "responses", lambda *_: known)
    return critical_friction(CAGE, 0.5, settings)


def test_the_runs_of_an_end_go_to_the_kick_that_sets_it(monkeypatch):
    """Kicks a factor of two apart, logistic alike: intervals of both ends are alike."""
    point = at_three_kicks(monkeypatch, *(logistic(middle, 8.0) for middle in (0.24, 0.12, 0.06)))
    assert point.low_scatter_low < 0.06 / 9 ** (1 / 8) < point.low_scatter_high
    assert point.high_scatter_low < 0.24 * 9 ** (1 / 8) < point.high_scatter_high
    lower = point.low_scatter_high / point.low_scatter_low
    upper = point.high_scatter_high / point.high_scatter_low
    # A ladder step of 10 % is 0.8 of P's width, 1/8: where the runs fall on it makes 21 % here. A third of
    # the runs, those of the first look, would make an interval 70 % wider.
    assert math.log(upper) == pytest.approx(math.log(lower), rel=0.3)


USUAL = logistic(0.12, 8.0)


@pytest.mark.parametrize(
    ("kicks", "end", "reason"),
    [
        (
            (USUAL, USUAL, lambda f: max(0.3, USUAL(f))),
            *("low", "10 % of the runs from 1 m/s whirl even at zero pocket friction"),
        ),
        (
            (lambda f: min(0.7, USUAL(f)), USUAL, USUAL),
            *("high", "under 90 % of the runs from 0.2 m/s whirl by friction in the pockets, at 1"),
        ),
    ],
)
def test_one_kick_without_a_tenth_or_nine_leaves_the_band_without_that_end(monkeypatch, kicks, end, reason):
    """It grows without friction, or never: whatever the others do, the band has no lower, or upper, end."""
    point = at_three_kicks(monkeypatch, *kicks)
    assert point.critical_friction is not None
    names = (f"critical_friction_{end}", f"{end}_scatter_low", f"{end}_scatter_high")
    assert [getattr(point, name) for name in names] == [None] * 3
    assert point.reason == reason


def test_a_crossing_far_from_every_count_is_counted_at():
    """P is 0 up to 0.33 and 0.9 from 0.7 on, and the guess lies far below: runs are spent between the two."""
    spent = []

    def look(friction, number, runs):
        spent.append(runs)
        return Count(0 if friction < 0.34 else 7 * runs // 8, runs)

    found = Response(look, 64).crossing(0.5, 96, 0.06)
    assert found.low <= 0.34 <= found.high
    assert sum(spent) < 400  # both ends of the ladder, the bracket, and the 96 that were asked for


@pytest.mark.parametrize(
    ("probability", "runs", "guess", "low", "high"),
    [
        # a rise above the least friction of the ladder, and the guess far above both
        (lambda f: float(f > 0.005), 96, 0.04, (0.004, 0.005), (0.005, 0.006)),
        # nothing was counted beyond friction 1
        (logistic(0.95, 5.0), 16, 0.5, (0.0, 0.95), (1.0, 1.0)),
        # a step between two places is somewhere between them, and no more is known
        (lambda f: float(f > 0.105), 96, 0.1, (LADDER[cell_of(0.1)],) * 2, (LADDER[cell_of(0.11)],) * 2),
        # between nothing and the first step of the ladder
        (lambda f: float(f > 0.0), 96, 0.1, (0.0, 0.0), (LADDER[1],) * 2),
    ],
)
def test_an_interval_ends_where_runs_were_counted(probability, runs, guess, low, high):
    """A crossing whose interval is bounded by the places at which P is known."""
    found = response(probability).crossing(0.5, runs, guess)
    assert low[0] <= found.low <= low[1]
    assert high[0] <= found.high <= high[1]
    assert found.low < found.value < found.high


@pytest.mark.parametrize(
    ("probability", "guess", "side"),
    [
        (lambda _: 0.8, 0.1, Side.ABOVE),
        (lambda _: 0.2, 0.1, Side.BELOW),
        (lambda f: 0.9 - 0.8 * f, 0.9, Side.ABOVE),
    ],
)
def test_without_a_crossing_the_side_is_told(probability, guess, side):
    """P that never rises through one half lies above or below it; nothing is extrapolated or inverted."""
    assert response(probability).crossing(0.5, 96, guess) is side


def test_runs_are_numbered_one_after_the_other_and_few_are_wasted_far_from_the_crossing():
    """No run is counted twice, so counts are independent: 96 near the crossing, 16 at each end, few looks."""
    asked = []

    def look(friction, first_run, runs):
        asked.append((first_run, runs))
        return Count(round(runs * logistic(0.1, 8.0)(friction)) if friction else 0, runs)

    Response(look, 64).crossing(0.5, 96, 0.9)
    ends = [0, *accumulate(runs for _, runs in asked)]
    assert [first for first, _ in asked] == ends[:-1]
    assert 96 <= ends[-1] <= 96 + 16 * 9
    # half of the first 16 grow without friction, of all an eighth: that end is looked at again
    first = lambda f, number, runs: Count(8 if number == 0 else 0 if f < 0.1 else runs, runs)  # noqa: E731
    assert isinstance(Response(first, 64).crossing(0.5, 96, 0.1), Crossing)


def test_unresolved_runs_and_those_of_the_land_are_told(monkeypatch):
    """They count as not whirling, and a note says how many, but for those whose motion falls."""
    cage = CAGE
    found = run_ensemble(cage, StabilitySettings(duration=1e-3), kicks=(0.5,), runs=5)
    found.outcome[0] = (RunOutcome.WHIRLS, *[RunOutcome.UNRESOLVED] * 4)
    found.cause[0] = (Cause.NONE, Cause.NOT_FINITE, Cause.NO_CONTACT, Cause.FALLING, Cause.LEFT_POCKET)
    monkeypatch.setattr(runner.Runner, "ensemble", lambda *_, **__: found)
    counts = responses(cage, StabilitySettings(), (0.5,), Runner())[0.5]
    count = counts.add(cell_of(0.1), 5)
    # A ball at the edge of its wall counts as a whirl: where all balls leave their pockets no motion settles.
    assert (count.whirling, count.runs) == (2, 5)
    (note,) = count.notes
    assert re.search(r"2 of 5 runs from 0.5 m/s at friction 0.1 .* not whirling", note)
    found.outcome[0], found.cause[0] = RunOutcome.WHIRLS, Cause.LAND_FRICTION
    count = counts.add(cell_of(0.2), 5)
    assert count.whirling == 0
    assert "land drives 5 of 5 runs from 0.5 m/s at friction 0.196. It leaves these out" in count.notes[0]


@pytest.mark.parametrize("ball", [BallModel.TRACTION, BallModel.FREE])
def test_races_that_hold_twice_as_hard_give_the_same_traction_at_half_the_slip(ball):
    """Capacity and mass stay; at eta = 1 the balls are gripped."""
    cage = moving_cage(SHIPPED, 0.1, ball)
    zeta = damping_ratio(cage.ball_cage_stiffness, cage.mass, 2.0 * cage.race_damping)
    hard = cage_at(cage, restitution_factor(zeta), 0.1)
    assert hard.traction.capacity == pytest.approx(cage.traction.capacity, rel=1e-12)  # rounding
    # of eta and back
    assert hard.traction.slope == pytest.approx(2.0 * cage.traction.slope, rel=1e-9)
    assert (hard.free_ball is None) == (ball is not BallModel.FREE)
    if hard.free_ball is not None:
        slip = cage.free_ball.inner.elastic_slip / 2.0
        assert hard.free_ball.inner.elastic_slip == pytest.approx(slip, rel=1e-9)
        assert hard.free_ball.capacity == cage.free_ball.capacity
    gripped = cage_at(cage, 1.0, 0.1)
    assert (gripped.traction, gripped.free_ball, gripped.race_damping) == (None, None, math.inf)


@pytest.mark.parametrize("eta", [0.0, 0.05, 0.5, 0.95, 1.0])
def test_a_cage_at_a_restitution_factor_has_it_for_its_own(eta):
    """The damping that is set for a factor is read back as that factor; rounding only."""
    assert own_restitution_factor(cage_at(CAGE, eta, 0.1)) == pytest.approx(eta, rel=1e-9, abs=1e-12)


def test_straight_lines_between_the_factors_follow_a_curve_that_bends():
    """Like the shipped bearing, straight to 0.75, level to 0.9, 0 at 1: within 0.01 of friction."""

    def height(eta):
        return 0.117 - 0.188 * (eta - 0.5) if eta < 0.75 else min(0.07, 0.64 * (1.0 - eta))

    for eta in np.linspace(0.0, 1.0, 1001):
        assert abs(np.interp(eta, FACTORS, [height(one) for one in FACTORS]) - height(eta)) < 0.01


@pytest.mark.parametrize(("friction", "most"), [(0.29, 3), (0.15, 10), (0.05, 11)])
def test_a_threshold_is_followed_no_further_than_it_can_lie(friction, most, monkeypatch):
    """The same as on the whole curve, which falls from 0.3 to 0.1, with so many points at most."""
    asked = []

    def known(_, eta, *__, **___):
        asked.append(eta)
        return point(eta, 0.3 - 0.2 * eta, 0.001)

    monkeypatch.setattr(stability_curve, "critical_friction", known)
    found = own_threshold(CAGE, StabilitySettings(), friction, Runner())
    assert len(asked) <= most
    assert found == restitution_threshold([known(None, eta) for eta in FACTORS], friction)


def point(eta, f, spread=0.01, side=Side.ABOVE):
    """Critical friction at one restitution factor."""
    if f is None:
        return CriticalFriction(restitution_factor=eta, side=side)
    ends = {"scatter_low": f - spread, "scatter_high": f + spread}
    return CriticalFriction(restitution_factor=eta, critical_friction=f, **ends)


POINTS = [point(0.0, 0.4), point(0.5, 0.2), point(1.0, 0.1)]
WAVERS = [point(0.0, 0.4), point(0.3, 0.2), point(0.6, 0.3), point(1.0, 0.1)]
GROWS = [point(0.0, 0.4), point(0.5, None, side=Side.ABOVE), point(1.0, None, side=Side.ABOVE)]
NEVER = [point(0.0, None, side=Side.BELOW), point(1.0, None, side=Side.BELOW)]


@pytest.mark.parametrize(
    ("points", "friction", "eta"),
    [
        *((POINTS, 0.5, 0.0), (POINTS, 0.4, 0.0), (POINTS, 0.3, 0.25), (POINTS, 0.2, 0.5)),
        *((POINTS, 0.15, 0.75), (POINTS, 0.1, 1.0), (POINTS, 0.05, 1.0)),
        (WAVERS, 0.25, 0.225),  # the end of the stable stretch that starts at 0
        (GROWS, 0.2, 0.25),  # above one half without friction the critical one counts as 0
        (GROWS, 0.0, 0.5),
        (NEVER, 0.9, 1.0),  # below one half throughout it counts as the top of the search
    ],
)
def test_a_threshold_is_where_the_curve_first_has_the_friction(points, friction, eta):
    """Straight lines between points; 0 if never stable, 1 if stable even on gripped balls; rounding."""
    assert restitution_threshold(points, friction).value == pytest.approx(eta, abs=1e-12)


def test_the_interval_of_a_threshold_comes_from_that_of_the_curve():
    """A band of 0.01 in friction is 0.025 in eta on the first line, which falls 0.4 a unit; rounding."""
    found = restitution_threshold(POINTS, 0.3)
    assert (found.low, found.high) == pytest.approx((0.225, 0.275), abs=1e-12)
