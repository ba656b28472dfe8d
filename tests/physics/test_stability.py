"""Stability curve and threshold: the linear limit, brute force at a point; the law of kick over clearance.

Kick over clearance, chi = v0 sqrt(M/k)/c_p, decides: impacts, a softened whirl, then the linear law. The
whole curves are in docs/images/chi-law.csv (benchmarks/chi_law.py); the points here are of that cage.
"""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from cages import SMALL as CAGE

from separatrix import Runner, critical_friction, restitution_threshold, stability_curve, wilson_interval
from separatrix.cage import Cause, RunOutcome, linear_critical_friction, run_ensemble
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.study.study import Guidance, StabilitySettings
from separatrix.verdict.critical_friction import cage_at
from separatrix.verdict.stability_curve import curve_of_points, threshold_factors

SETTINGS = StabilitySettings(kicks=(0.5,), reference_kick=0.5, runs=32, duration=0.1, seed=3)


@pytest.fixture(scope="module")
def points():
    """Critical frictions from 0 to 1, where they are wanted."""
    runner, factors = Runner(jobs=2), threshold_factors(SETTINGS)
    return runner.work_out(
        lambda eta: critical_friction(CAGE, eta, SETTINGS, runner=runner, band=False),
        factors,
        into=lambda found: [found[eta] for eta in factors],
    )


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
    # More friction never raises a threshold, whatever the wiggles: the curve is cut further left; no
    # tolerance.
    assert heights[0] > heights[len(heights) // 2] > heights[-1]
    values = [restitution_threshold(points, f / 100).value for f in range(50)]
    assert values == sorted(values, reverse=True)


@pytest.fixture(scope="module")
def curve():
    """Curve with its band at given restitution factors."""
    given = replace(SETTINGS, kicks=(0.2, 0.5, 1.0), restitution_factors=(0.6, 0.9))
    return stability_curve(CAGE, given, runner=Runner(jobs=2))


def test_restitution_factors_that_are_given_are_used_as_they_are(curve):
    """Two were asked for; the bearing's own stands beside them."""
    for points in (curve.curve, curve.linear_limit):
        assert [point.restitution_factor for point in points] == [0.6, 0.9]
    assert curve.here.restitution_factor == pytest.approx(0.7367, abs=5e-5)  # the digits of C_mu = 2000


def test_the_band_holds_the_middle_and_depends_on_the_kick(curve):
    """The critical friction is inside its band, each end inside its own interval."""
    each = (replace(SETTINGS, kicks=(kick,), reference_kick=kick) for kick in (0.2, 1.0))
    weak, strong = (critical_friction(CAGE, 0.9, one, band=False).critical_friction for one in each)
    # The instability is sub-critical: at a restitution factor of 0.9 half the runs whirl first from 1 m/s.
    assert strong < weak
    for point in (*curve.curve, curve.here):
        assert point.critical_friction_low <= point.critical_friction <= point.critical_friction_high
        assert point.low_scatter_low <= point.critical_friction_low <= point.low_scatter_high
        assert point.high_scatter_low <= point.critical_friction_high <= point.high_scatter_high


def test_below_the_band_kicks_die_and_above_they_grow(curve):
    """Other seeds, every kick, at the far end of the band's interval: not surely more than a tenth err."""
    at = curve.curve[0]
    settings = replace(SETTINGS, kicks=curve.kicks, seed=77)
    below = run_ensemble(cage_at(CAGE, 0.6, at.low_scatter_low), settings)
    above = run_ensemble(cage_at(CAGE, 0.6, at.high_scatter_high), settings)
    for kick in range(3):
        assert wilson_interval(int((below.outcome[kick] == 1).sum()), 32)[0] < 0.1
        assert wilson_interval(int((above.outcome[kick] != 1).sum()), 32)[0] < 0.1


def test_a_whirl_of_the_land_is_none_of_the_pockets():
    """Friction on the land makes it grow without limit at any in the pockets, which drives none of it."""
    land = {"land_clearance": 0.05e-3, "land_friction": 0.5, "land_restitution": 1.0}
    driven = replace(CAGE, guidance=Guidance.INNER, cage_speed=400.0, **land)
    found = critical_friction(driven, 0.9, replace(SETTINGS, runs=8, kicks=(0.5,)))
    assert found.critical_friction is None
    assert "under 50 % of the runs from 0.5 m/s whirl by friction in the pockets, at 1" in found.reason
    ends = run_ensemble(replace(driven, ball_cage_friction=0.2), SETTINGS, kicks=(0.5,), runs=8)
    assert np.all((ends.outcome == RunOutcome.WHIRLS) & (ends.cause == Cause.LAND_FRICTION))


def test_the_curve_of_a_landless_cage_says_that_it_drifts():
    """Turning without a land: the rate of the linear law, and no word of stable; silent where it is held."""
    landless = replace(CAGE, cage_speed=400.0)
    law = drift_rate_law(landless)
    found = curve_of_points(landless, SETTINGS, [])
    assert found.drifts
    assert found.drift_rate_law == law
    held = curve_of_points(replace(landless, cage_speed=0.0), SETTINGS, [])
    assert not held.drifts


MASS, STIFFNESS, HALF_PLAY = CAGE.mass, CAGE.ball_cage_stiffness, CAGE.half_play
CROSSINGS = 250


def chi_settings(chi, runs=64):
    """Ensemble of one kick, as long as in the curves: 0.3 s, or 250 crossings of the clearance."""
    duration = max(0.3, CROSSINGS * crossing(chi))
    return StabilitySettings(kicks=(2 * HALF_PLAY / crossing(chi),), runs=runs, duration=duration)


def crossing(chi):
    """Time in which the kick crosses the play [s]."""
    return 2 * sqrt(MASS / STIFFNESS) / chi


def linear(eta):
    """Critical friction without clearance."""
    return linear_critical_friction(cage_at(CAGE, eta, 0.0))


@pytest.mark.parametrize("chi", [0.0121, 0.215])
def test_kick_and_clearance_count_by_their_ratio_only(chi):
    """Twice the kick in twice the play is the same motion, twice as large: every bit of it."""
    cage, ensemble = cage_at(CAGE, 0.8, 0.12), chi_settings(chi, 16)
    cage = replace(cage, ball_diameter=0.01, ball_spin=(-1e6, 0.0, 0.0))
    wide = replace(cage, pocket_clearance=2 * CAGE.pocket_clearance, ball_spin=(-2e6, 0.0, 0.0))
    small = run_ensemble(cage, ensemble)
    large = run_ensemble(wide, ensemble, kicks=[2 * kick for kick in ensemble.kicks])
    # So must be the speeds of the ball's surface, against which friction acts.
    assert (small.outcome == large.outcome).all()
    assert (4 * small.end_energy == large.end_energy).all()


def energy_over_kick(eta, friction, chi):
    """Energy at the end over the kick's, of four runs."""
    how, cage = chi_settings(chi, 4), cage_at(CAGE, eta, friction)
    return run_ensemble(cage, how).end_energy[0] / (0.5 * MASS * how.kicks[0] ** 2)


@pytest.mark.parametrize(
    ("chi", "eta", "dies", "grows"),
    [(12.1, 0.6, 0.82, 0.97), (12.1, 0.3, 0.82, 0.97), (121.0, 0.8, 0.94, 1.05), (121.0, 0.3, 0.94, 1.05)],
)
def test_strong_kicks_meet_the_linear_law_from_below(chi, eta, dies, grows):
    """Harmonic balance has 0.88 of the limit at chi of 12, 0.988 at 121: smaller below, larger above."""
    # At 12 the play takes a fifth of the pockets' stiffness, and the linear law goes with its root.
    assert np.all(energy_over_kick(eta, dies * linear(eta), chi) < 0.5)
    assert np.all(energy_over_kick(eta, grows * linear(eta), chi) > 2.0)
