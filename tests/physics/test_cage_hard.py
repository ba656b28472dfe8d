"""The hard-impact form: its limits, the restitution of a ring that may turn, and its guard."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST as CAGE
from cages import damping_of, whirl_probability

from separatrix.cage import (
    Cause,
    RunOutcome,
    hard,
    impact_restitution,
    run_ensemble,
    run_hard_ensemble,
)
from separatrix.cage.hard import next_impact
from separatrix.cage.records import records
from separatrix.limits.point import closed_hard_limit
from separatrix.study import StabilitySettings

START = 0.5 * CAGE.mass * 0.5**2
"""Energy of the kick [J]."""

EVEN = StabilitySettings(kicks=(0.5,), runs=24, duration=5.0, ball_scatter=0.0)


@pytest.mark.parametrize("eta", [0.0, 1e-3])
@pytest.mark.parametrize(("balls", "limit"), [(11, 0.1438), (12, 0.2679)])
def test_critical_friction_of_dead_impacts_between_even_pockets(balls, limit, eta):
    """Z walls, 2 Z where Z is odd: tan(pi/22), tan(pi/12), within 1 %; two balls leave the cage a way out."""
    assert closed_hard_limit(balls) == pytest.approx(limit, abs=5e-5)  # four digits given
    assert closed_hard_limit(2) is None
    for friction, least, most in ((0.99 * limit, 0.0, 0.0), (1.01 * limit, 0.6, 1.0)):
        # above the limit the cage grows unless it set out against the whirl, and never turned round
        cage = replace(CAGE, ball_count=balls, ball_cage_friction=friction)
        share = whirl_probability(run_hard_ensemble(cage, EVEN, restitution=eta, may_turn=False))[0]
        assert least <= share <= most


@pytest.mark.parametrize(("nominal", "free"), [(0.90, 0.928), (0.60, 0.698)])
def test_a_ring_that_may_turn_returns_more(nominal, free):
    """Its impact feels M/2; held against turning it has the nominal restitution."""
    cage = replace(CAGE, race_damping=damping_of(nominal))
    assert impact_restitution(cage) == pytest.approx(free, abs=5e-4)  # three digits given
    # the same closed form there and back: rounding
    assert impact_restitution(cage, may_turn=False) == pytest.approx(nominal, rel=1e-12)
    assert impact_restitution(replace(cage, race_damping=1.0)) == 0.0


def test_the_force_of_a_hard_impact_is_that_of_an_undamped_spring():
    """Between races that grip, in the first crossing: impact speed times sqrt(k M/2); chi is 2e-4."""
    cage = replace(CAGE, race_damping=math.inf, ball_cage_friction=0.0)
    weak = StabilitySettings(kicks=(5e-4,), runs=24, duration=1.2)
    soft = run_ensemble(cage, replace(weak, duration=0.3))
    assert soft.followed.min() >= 1.2  # nothing takes energy: four times its duration
    whole = replace(weak, duration=soft.followed.max())
    forces = [soft.largest_contact_force, run_hard_ensemble(cage, whole).largest_contact_force]
    assert forces[1].min() > 0.0
    # one impact in some is met by another pocket before it is over
    assert np.quantile(np.abs(forces[0] / forces[1] - 1.0), 0.75) < 1e-3


@pytest.mark.parametrize("speed", [0.0, 300.0])
def test_the_energy_of_hard_impacts_is_accounted_for(speed):
    """Work of impacts, friction and frame explains the energy, to the rounding of 1e5 events."""
    cage = replace(CAGE, race_damping=damping_of(0.9), ball_cage_friction=0.12, cage_speed=speed)
    runs = run_hard_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=16, duration=0.3))
    assert runs.energy_imbalance.max() < 1e-10


def test_free_impacts_without_friction_or_loss_keep_the_energy():
    """Restitution 1 and no friction: the energy is the kick's for ever."""
    cage = replace(CAGE, ball_cage_friction=0.0)
    runs = run_hard_ensemble(cage, replace(EVEN, duration=0.5, ball_scatter=0.3), restitution=1.0)
    tenth = run_hard_ensemble(replace(cage, cage_speed=1.0), replace(EVEN, duration=0.5), restitution=0.99)
    # from the start to the middle of the last fifth, 0.45 s, by the same formula: rounding
    np.testing.assert_allclose(tenth.growth_rate, 0.5 * np.log(tenth.end_energy / START) / 0.45, rtol=1e-12)
    np.testing.assert_allclose(runs.end_energy, START, rtol=1e-10)  # rounding of some thousand impacts
    assert np.all(runs.largest_offset < 6e-4)


def test_whirl_of_hard_impacts_follows_the_balls_spin():
    """Forward for inner rotation, backward for outer, in the runs that grow."""
    for speeds, sense in (((1500.0, 0.0), 1), ((0.0, 1500.0), -1)):
        cage = replace(CAGE, ball_cage_friction=0.3, inner_speed=speeds[0], outer_speed=speeds[1])
        runs = run_hard_ensemble(cage, replace(EVEN, duration=0.3, ball_scatter=0.3), restitution=0.8)
        grows = runs.outcome == RunOutcome.WHIRLS
        assert grows.mean() > 0.5
        assert np.median(runs.whirl_direction[grows]) == sense


def test_a_collapse_of_impacts_is_unresolved():
    """The centrifugal force presses a turning cage into a corner, where dead impacts come in no time."""
    cage = replace(CAGE, cage_speed=600.0)
    runs = run_hard_ensemble(cage, replace(EVEN, duration=0.3), restitution=0.1)
    assert np.all(runs.outcome == RunOutcome.UNRESOLVED)
    assert np.all(runs.cause == Cause.IMPACTS)
    assert np.all(np.isfinite(runs.end_energy))


@pytest.mark.parametrize(("turning", "fastest", "longest"), [(2000.0, 0.3, 1e-3), (300.0, 3.0, 3e-4)])
def test_no_wall_is_passed_before_the_next_impact(turning, fastest, longest):
    """Flight up to the time of `next_impact` stays between the walls, bent by a fast frame or its speed."""
    cage = replace(CAGE, cage_speed=turning)
    p = hard.walls(cage, restitution=None, may_turn=True, duration=1.0)
    angles = np.array(cage.ball_angles)
    cos, sin = np.cos(angles), np.sin(angles)
    generator = np.random.default_rng(1)
    for s in records(hard.Flight, 200):
        s["x"], s["y"] = generator.uniform(-1e-4, 1e-4, 2)
        s["vx"], s["vy"] = generator.uniform(-fastest, fastest, 2)
        dt, _, _ = next_impact(p, cos, sin, np.zeros(11), s, longest)
        for _ in range(20):
            hard.fly(p, s, dt / 20)
            # rounding of the flight, relative to the play
            assert np.abs(s["y"] * cos - s["x"] * sin).max() <= cage.half_play * (1 + 1e-9)


def test_threads_change_no_bit_of_the_hard_form():
    """1 and 2 workers."""
    one, two = (run_hard_ensemble(CAGE, replace(EVEN, duration=0.1), jobs=jobs) for jobs in (1, 2))
    assert np.array_equal(one.end_energy, two.end_energy)
