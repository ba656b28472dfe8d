"""Counting, crossing and inverting, without any cage: a counter that knows its probabilities."""

import threading
import time

import pytest

from separatrix.stability import Count, CriticalFriction, Side, restitution_threshold, threshold_factors
from separatrix.stability.crossing import Crossing, find_crossing, interval
from separatrix.stability.pool import work_through
from separatrix.study import StabilitySettings

GRID = tuple(i / 20 for i in range(21))


def counter(probability, runs=64, few=8):
    """Count exactly the expected number of growing runs; few of them where a target is far."""

    def count(at, target):
        p = probability(at)
        first = Count(round(p * few), few)
        return first if target is not None and first.decides(target) else Count(round(p * runs), runs)

    return count


def ramp(start, end):
    """Probability that rises in a straight line."""
    return lambda x: min(1.0, max(0.0, (x - start) / (end - start)))


def test_a_few_runs_decide_far_from_the_target_only():
    """Eight dead runs tell P from one half but not from a tenth; 24 that agree decide anything."""
    assert Count(0, 8).decides(0.5)
    assert not Count(0, 8).decides(0.1)
    assert not Count(4, 8).decides(0.5)
    assert Count(0, 24).decides(0.1)


@pytest.mark.parametrize("start", [0, 3, 10, 19, 20])
@pytest.mark.parametrize("target", [0.1, 0.5, 0.9])
def test_a_crossing_is_found_from_any_start(start, target):
    """A ramp from 0.2 to 0.7 crosses its target at 0.2 + 0.5 target; one run in 64 is 0.008 here."""
    found = find_crossing(counter(ramp(0.2, 0.7)), GRID, target, start)
    assert isinstance(found, Crossing)
    assert found.value == pytest.approx(0.2 + 0.5 * target, abs=0.008)


@pytest.mark.parametrize(("share", "side"), [(0.8, Side.ABOVE), (0.2, Side.BELOW)])
def test_without_a_crossing_the_side_is_told(share, side):
    """P that never meets one half lies above or below it; nothing is extrapolated."""
    assert find_crossing(counter(lambda _: share), GRID, 0.5) is side


def test_what_falls_again_is_not_inverted_blindly():
    """P that is above one half at the low end is ABOVE, though it falls below further up."""
    assert find_crossing(counter(lambda x: 0.9 - x), GRID, 0.5, start=15) is Side.ABOVE


def test_the_interval_holds_the_points_where_counts_do_not_decide():
    """64 runs at P = 1/2 leave 0.38 to 0.62: a fifth of the ramp on either side, here 0.06."""
    count = counter(ramp(0.2, 0.7))
    found = find_crossing(count, GRID, 0.5)
    low, high = interval(count, GRID, found, 0.5)
    assert (low, high) == pytest.approx(
        (0.39, 0.51), abs=0.01
    )  # rounding of counts, curvature of Wilson's ends


def test_a_jump_inside_a_cell_leaves_the_whole_cell():
    """P that steps from 0 to 1 between two points is somewhere between them, and no more is known."""
    count = counter(lambda x: float(x > 0.42))
    found = find_crossing(count, GRID, 0.5)
    assert interval(count, GRID, found, 0.5) == (0.4, 0.45)


def point(eta, f, spread=0.01, side=None):
    """Critical friction at one restitution factor."""
    if f is None:
        return CriticalFriction(restitution_factor=eta, side=side)
    return CriticalFriction(
        restitution_factor=eta, critical_friction=f, scatter_low=f - spread, scatter_high=f + spread
    )


POINTS = [point(0.0, 0.4), point(0.5, 0.2), point(1.0, 0.1)]


@pytest.mark.parametrize(
    ("friction", "eta"),
    [(0.5, 0.0), (0.4, 0.0), (0.3, 0.25), (0.2, 0.5), (0.15, 0.75), (0.1, 1.0), (0.05, 1.0)],
)
def test_a_threshold_is_where_the_curve_has_the_friction(friction, eta):
    """Straight lines between points; 0 if never stable, 1 if stable even on gripped balls; rounding."""
    assert restitution_threshold(POINTS, friction).value == pytest.approx(eta, abs=1e-12)


def test_the_interval_of_a_threshold_comes_from_that_of_the_curve():
    """A band of 0.01 in friction is 0.025 in eta on the first line, which falls 0.4 a unit; rounding."""
    found = restitution_threshold(POINTS, 0.3)
    assert (found.low, found.high) == pytest.approx((0.225, 0.275), abs=1e-12)


def test_where_the_curve_wavers_the_first_fall_counts():
    """The threshold is the end of the stable stretch that starts at 0."""
    points = [point(0.0, 0.4), point(0.3, 0.2), point(0.6, 0.3), point(1.0, 0.1)]
    assert restitution_threshold(points, 0.25).value == pytest.approx(0.225)


def test_a_cage_that_grows_without_friction_is_stable_nowhere_beyond():
    """Where P is above one half at no friction the critical friction counts as 0, and none is below it."""
    points = [point(0.0, 0.4), point(0.5, None, side=Side.ABOVE), point(1.0, None, side=Side.ABOVE)]
    assert restitution_threshold(points, 0.2).value == pytest.approx(0.25)
    assert restitution_threshold(points, 0.0).value == pytest.approx(0.5)


def test_a_cage_that_never_grows_is_stable_throughout():
    """Where P stays below one half the critical friction counts as the top of the search."""
    points = [point(0.0, None, side=Side.BELOW), point(1.0, None, side=Side.BELOW)]
    assert restitution_threshold(points, 0.9).value == 1.0


def test_thresholds_are_solved_over_all_of_zero_to_one():
    """The points go from 0 to 1, whatever restitution factors the study asks for."""
    factors = threshold_factors(StabilitySettings(restitution_factors=(0.3, 0.5)))
    assert factors == [0.0, 0.3, 0.5, 0.98, 1.0]


def test_work_comes_back_in_order():
    """Results stand in the order of the items, however many threads."""
    told = []
    found = work_through(
        lambda x: x * x, range(20), jobs=3, progress=lambda done, total: told.append((done, total))
    )
    assert found == [x * x for x in range(20)]
    assert told == [(i, 20) for i in range(1, 21)]


def test_an_interrupt_keeps_what_is_done():
    """Ctrl-C after three items: those are returned, the rest is None, and no thread is left behind."""

    def stop(done, total):
        if done == 3:
            raise KeyboardInterrupt

    def work(item):
        time.sleep(1e-3)
        return item + 1

    found = work_through(work, range(500), jobs=1, progress=stop)
    assert found[:3] == [1, 2, 3]
    assert None in found
    assert not [thread for thread in threading.enumerate() if "ThreadPool" in thread.name]


def test_a_fault_in_the_work_is_not_swallowed():
    """An exception of one item is raised, not turned into a gap."""
    with pytest.raises(ZeroDivisionError):
        work_through(lambda x: 1 // x, [1, 0], jobs=2)
