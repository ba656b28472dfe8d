"""What must hold of the planar motion: impacts, land, free flight, energy, order of the step, repeats."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST, ON_A_LAND, damping_of, followed
from scipy.integrate import solve_ivp

from separatrix.cage import PlanarCage, RunOutcome, linear_critical_friction, run_ensemble, simulate
from separatrix.cage.closed_forms import rebound, rebound_damping
from separatrix.study import Guidance, StabilitySettings

M, K, R = 0.05, 3e6, 0.0325
CAGE = replace(AT_REST, race_damping=3000.0)
TURNING = replace(ON_A_LAND, moment_of_inertia=26.4e-6, race_damping=3000.0, ball_cage_friction=0.1)


def lone(eta: float, **change: float) -> PlanarCage:
    """Cage with one ball, no friction and so much inertia that it cannot turn: one impact, head on."""
    damping = damping_of(eta) if eta > 0 else math.sqrt(K * M) / 3.0  # zeta of 1.5
    whole = {"ball_count": 1, "ball_cage_friction": 0.0, "moment_of_inertia": 1e6, "race_damping": damping}
    return replace(CAGE, **(whole | change))


@pytest.mark.parametrize("eta", [0.0, 0.07, 0.34, 0.6, 0.74, 0.94])
def test_one_impact_returns_the_restitution_factor(eta):
    """Head on against one ball the series spring and damper give back eta times the speed."""
    duration = 0.0015 if eta > 0 else 0.006  # without rebound the cage comes to rest with the ball
    run = followed(lone(eta), duration, direction=math.pi / 2)
    # the inertia of 1e6 kg m2 leaves 1e-10 of turning; a run that rests is ended at 1e-4 of its energy
    assert -run.velocity[-1, 1] / 0.5 == pytest.approx(eta, abs=3e-10 if eta > 0 else 0.0101)


def test_a_impact_keeps_the_impulse_law():
    """Friction's impulse is f times the normal one, inward behind the ball (inner rotation)."""
    cage = replace(lone(0.6), ball_cage_friction=0.2)
    run = followed(cage, 0.0015, direction=math.pi / 2)
    normal = M * (run.velocity[-1, 1] - 0.5)
    assert M * run.velocity[-1, 0] == pytest.approx(0.2 * normal, rel=1e-14)  # 50 roundings; seen: 0
    other = followed(replace(cage, inner_speed=0.0, outer_speed=1500.0), 0.0015, direction=math.pi / 2)
    assert other.velocity[-1, 0] == pytest.approx(-run.velocity[-1, 0], rel=1e-9)


@pytest.mark.parametrize("zeta", [0.1, 0.5, 0.7, 1.0, 1.7])
def test_rebound_of_a_damper_that_cannot_pull(zeta):
    """The closed form against the equation of motion, integrated until the force is back at zero."""

    def force_left(time, state):
        return state[0] + 2 * zeta * state[1] if time > 1e-3 else 1.0

    force_left.terminal = True
    how = {"events": force_left, "rtol": 1e-11, "atol": 1e-13}
    course = solve_ivp(lambda _, x: [x[1], -x[0] - 2 * zeta * x[1]], (0, 60), [0, 1], **how)
    # the integrator's own tolerance, and its event's
    assert rebound(zeta) == pytest.approx(-course.y_events[0][0][1], abs=1e-8)


@pytest.mark.parametrize("restitution", [1e-4, 0.1, 0.5, 0.9, 1.0])
def test_rebound_damping_inverts_rebound(restitution):
    """To the tolerance of the root."""
    assert rebound(rebound_damping(restitution)) == pytest.approx(restitution, rel=1e-9)


@pytest.mark.parametrize("guidance", [Guidance.OUTER, Guidance.INNER])
@pytest.mark.parametrize("restitution", [0.1, 0.5, 1.0])
def test_the_land_returns_its_restitution(guidance, restitution):
    """Head on without friction the land gives back its restitution, exactly."""
    land = {"guidance": guidance, "land_clearance": 2e-4, "land_friction": 0.0}
    cage = lone(0.6, pocket_clearance=0.1, land_restitution=restitution, **land)
    run = followed(cage, 0.0006, direction=0.7)
    speed = -run.velocity[-1] @ [math.cos(0.7), math.sin(0.7)]
    # rounding, and the root that gives the damper its restitution
    assert speed == pytest.approx(0.5 * restitution, rel=1e-9)


@pytest.mark.parametrize("guidance", [Guidance.OUTER, Guidance.INNER])
@pytest.mark.parametrize("ring", [0.0, 2000.0])
def test_friction_of_the_land_follows_its_sliding(guidance, ring):
    """Tangential impulse mu times the normal one, along the ring's motion past the cage, with its moment."""
    cage = far_land(guidance=guidance, land_friction=0.2, inner_speed=ring, outer_speed=-ring)
    run = followed(cage, 1.01, samples=2)
    normal, tangential = M * (run.velocity[-1, 0] - 0.5), M * run.velocity[-1, 1]
    # A ring at rest meets a cage that only comes head on: no sliding, no friction (rounding).
    # The outer land is touched at angle 0 and its surface, of speed -ring, drags down; the inner one is
    # touched at the opposite side, where a positive speed drags down too.
    # 1e-3: the cage slides along the land by 1e-4 of its gap during the impact
    assert tangential == pytest.approx(0.2 * normal * (ring > 0), rel=1e-3, abs=1e-12)
    side = 1 if guidance is Guidance.OUTER else -1
    moment = side * R * tangential
    assert M * R * R * run.rotation_rate[-1] == pytest.approx(moment, rel=1e-3, abs=1e-12)


def test_a_sticking_land_only_stops_the_sliding():
    """A ring so slow that friction can stop the sliding: cage and ring have one speed where they touch."""
    cage = far_land(guidance=Guidance.OUTER, land_friction=0.5, outer_speed=1.0)
    run = followed(cage, 1.01, samples=2)
    surface = run.velocity[-1, 1] + R * run.rotation_rate[-1]
    assert surface == pytest.approx(R * 1.0, rel=1e-3)  # the land turns by 1e-5 under the sliding cage


def far_land(**change: object) -> PlanarCage:
    """Cage in wide pockets, with a land so far out that an impact is head on to 1e-4, and free to turn."""
    wide = {"pocket_clearance": 10.0, "moment_of_inertia": M * R * R, "land_clearance": 1.0}
    return lone(0.6, **(wide | change))


@pytest.mark.parametrize("excess", [-0.02, 0.004, 0.02])
def test_without_play_a_motion_settles_below_the_linear_limit_and_whirls_above_it(excess):
    """The motion is linear: part of a kick decays, the rest grows, slowly at first."""
    gripped = replace(CAGE, pocket_clearance=0.0)
    cage = replace(gripped, ball_cage_friction=(1.0 + excess) * linear_critical_friction(gripped))
    found = run_ensemble(cage, StabilitySettings(runs=4, duration=0.5), kicks=(0.5,))
    assert np.all(found.outcome == (RunOutcome.WHIRLS if excess > 0.0 else RunOutcome.SETTLES))


def test_a_land_that_has_let_go_presses_again_before_it_is_left():
    """Its weight turns a rebound within the land; the force is the larger of 0 and K d + C d' throughout.

    1e-6 N: rounding of 1e-16 m times K.
    """
    cage = far_land(guidance=Guidance.OUTER, land_clearance=2e-4, gravity=50.0, land_restitution=0.05)
    run = followed(cage, 3e-3, kick=0.332, samples=20_000)
    distance = np.hypot(*run.position.T)
    depth = distance - cage.land_gap
    rate = np.sum(run.position * run.velocity, axis=1) / np.maximum(distance, 1e-9)
    damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(cage.land_stiffness * M)
    force = np.where(depth > 0.0, np.maximum(0.0, cage.land_stiffness * depth + damping * rate), 0.0)
    np.testing.assert_allclose(run.land_force, force, atol=1e-6)
    pressed = run.land_force > 0.0
    assert np.any(~pressed[:-1] & pressed[1:] & (depth[:-1] > 1e-6))


@pytest.mark.parametrize("run", range(3))
@pytest.mark.parametrize(("kick", "friction"), [(0.1, 0.05), (0.5, 0.1), (2.0, 0.3)])
def test_a_history_is_consistent_with_itself(kick, friction, run):
    """Forces follow from the places of cage and balls, and the work entered from the energy, row by row.

    So no impact was passed over: a ball beyond its play would lack its force.
    """
    cage = replace(TURNING, ball_cage_friction=friction)
    run = simulate(cage, kick=kick, run=run, duration=0.05, until=0.05, samples=3000)
    angle = 2 * np.pi * np.arange(13) / 13
    x, y = run.position.T[:, :, np.newaxis]
    seat = y * np.cos(angle) - x * np.sin(angle) + R * run.rotation[:, np.newaxis]
    excess = np.abs(seat - run.ball_lead) - TURNING.half_play
    force = K * np.maximum(excess, 0) * np.sign(seat - run.ball_lead)
    np.testing.assert_allclose(run.contact_force, force, atol=1e-6)  # 1e-6 N: rounding of 1e-16 m times k
    energy = run.kinetic_energy + run.spring_energy + run.land_energy
    explained = energy[0] + sum(run.work.values())
    # what the ledger is asked to close to; it closes to 1e-12
    np.testing.assert_allclose(energy, explained, rtol=1e-9, atol=1e-9 * energy[0])


def test_a_growing_run_ends_before_its_numbers_do():
    """Friction far above any limit: WHIRLS, with finite evidence."""
    cage = replace(CAGE, ball_cage_friction=5.0, race_damping=1e5)
    result = run_ensemble(cage, StabilitySettings(kicks=(2.0,), runs=4, duration=3.0))
    assert np.all(result.outcome == RunOutcome.WHIRLS)
    assert np.all(np.isfinite(result.end_energy))


def test_a_whirl_that_grazes_its_pockets_goes_on():
    """A pocket that just lets go is not met again at once: none of 32 runs is unresolved."""
    cage = replace(TURNING, race_damping=6500.0, ball_cage_friction=0.0348)
    runs = run_ensemble(cage, StabilitySettings(runs=32), kicks=(2.0,))
    assert runs.count(RunOutcome.UNRESOLVED) == 0
    assert runs.pocket_impacts.sum() > 10_000
