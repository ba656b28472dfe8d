"""Stability curve and threshold: the linear limit, brute force at a point, threads, directions."""

from dataclasses import replace

import pytest

from separatrix.cage import PlanarCage, growth_probability, run_ensemble, wilson_interval
from separatrix.stability import (
    cage_at,
    critical_friction,
    curve_of_points,
    linear_limit,
    restitution_threshold,
    stability_curve,
    threshold_points,
)
from separatrix.study import Guidance, StabilitySettings

RADIUS, MASS = 0.03, 0.05
CAGE = PlanarCage(
    mass=MASS, moment_of_inertia=MASS * RADIUS**2, ball_count=11, pitch_radius=RADIUS, cage_speed=0.0,
    inner_speed=1000.0, outer_speed=0.0, pocket_clearance=0.6e-3, ball_cage_stiffness=3e6,
    race_damping=2000.0, ball_cage_friction=0.1,
)  # fmt: skip
SETTINGS = StabilitySettings(kicks=(0.5,), runs=32, duration=0.1, restitution_factors=(0.3, 0.6, 0.9), seed=3)


@pytest.mark.parametrize("eta", [0.1, 0.5, 0.9])
def test_without_clearance_the_linear_limit_is_recovered(eta):
    """Zero play, ball set at rest: dies 2 % below 2 zeta sqrt(2/Z) and grows 2 % above, as promised."""
    gripped = replace(CAGE, pocket_clearance=0.0)
    limit = linear_limit(gripped, eta).critical_friction
    for share, grows in ((0.98, 0.0), (1.02, 1.0)):
        ensemble = run_ensemble(cage_at(gripped, eta, share * limit), replace(SETTINGS, duration=0.3), runs=4)
        assert growth_probability(ensemble)[0] == grows


def test_the_curve_without_clearance_brackets_the_linear_limit():
    """The search on its grid lands in the cell that holds the closed form; no more is asked of it."""
    settings = replace(SETTINGS, runs=4, duration=0.3)
    for eta in (0.3, 0.9):
        gripped = replace(CAGE, pocket_clearance=0.0)
        found = critical_friction(gripped, eta, settings)
        assert found.scatter_low <= linear_limit(gripped, eta).critical_friction <= found.scatter_high


@pytest.fixture(scope="module")
def points():
    """Critical frictions from 0 to 1."""
    return threshold_points(CAGE, SETTINGS, jobs=2)


@pytest.mark.parametrize("friction", [0.09, 0.13])
def test_a_threshold_is_where_half_the_runs_grow(points, friction):
    """Brute force with other seeds: not surely more than half at the low end, nor less at the high one."""
    found = restitution_threshold(points, friction)
    other = replace(SETTINGS, seed=99, runs=64)

    def grown(eta):
        return int((run_ensemble(cage_at(CAGE, eta, friction), other).outcome == 1).sum())

    assert wilson_interval(grown(found.low), 64)[0] < 0.5
    assert wilson_interval(grown(found.high), 64)[1] > 0.5
    assert 0.25 < grown(found.value) / 64 < 0.75  # 4 standard deviations of 64 runs at one half


def test_the_curve_falls_with_the_restitution_factor(points):
    """A cage that gets more of its speed back is unstable at less friction (the paper, section 2.2)."""
    heights = [point.critical_friction for point in points]
    assert heights[0] > heights[2] > heights[-1]


def test_more_friction_never_raises_a_threshold(points):
    """The curve is cut further left, whatever its wiggles; no tolerance."""
    values = [restitution_threshold(points, f / 100).value for f in range(50)]
    assert values == sorted(values, reverse=True)


def test_the_number_of_threads_changes_nothing():
    """One thread and two give the same curve, to the last bit."""
    settings = replace(SETTINGS, runs=12, duration=0.03, kicks=(0.2, 0.5, 1.0))
    assert stability_curve(CAGE, settings, jobs=1) == stability_curve(CAGE, settings, jobs=2)


def test_the_band_holds_the_middle():
    """One run in ten grows at less friction than half of them, nine in ten at more."""
    for point in stability_curve(CAGE, replace(SETTINGS, kicks=(0.2, 0.5, 1.0)), jobs=2).curve:
        assert point.critical_friction_low <= point.critical_friction <= point.critical_friction_high


def test_mirroring_the_bearing_changes_nothing():
    """Seen from the other side speeds change sign; chaotic runs differ, so the intervals must overlap."""
    mirrored = replace(CAGE, inner_speed=-CAGE.inner_speed)
    there, back = (critical_friction(cage, 0.6, SETTINGS, band=False) for cage in (CAGE, mirrored))
    assert there.scatter_low <= back.scatter_high
    assert back.scatter_low <= there.scatter_high


def test_land_friction_alone_can_leave_no_crossing():
    """A cage driven by its land grows without pocket friction: no critical friction, and a reason."""
    land = {"land_clearance": 0.05e-3, "land_friction": 0.5, "land_restitution": 1.0}
    driven = replace(CAGE, guidance=Guidance.INNER, cage_speed=400.0, **land)
    found = critical_friction(driven, 0.9, replace(SETTINGS, runs=8, kicks=(0.5,)))
    assert found.critical_friction is None
    assert "grows even without pocket friction" in found.reason


def test_a_curve_cut_short_has_limits_for_its_own_points_only():
    """After an interrupt curve and linear limit still stand at the same restitution factors."""
    points = [critical_friction(CAGE, 0.6, replace(SETTINGS, runs=2, duration=0.01), band=False)]
    found = curve_of_points(CAGE, SETTINGS, points)
    assert [limit.restitution_factor for limit in found.linear_limit] == [0.6]
    assert found.complete is False
