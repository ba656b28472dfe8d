"""The cage in the plane against motions that have closed forms: impacts, its land, pockets that grip.

In double precision. An impact begins and ends within a step, which leaves an error of the square of the step;
tolerances are that, as measured, with a factor of 2 to 3.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from cages import AT_REST, ON_A_LAND, damping_of, followed, impact_restitution, linear_roots
from mobile_balls import impact
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from separatrix import BallTraction, Guidance, MovingCage
from separatrix.cage.closed_forms import rebound, rebound_damping, returned_share
from separatrix.cage.numbers import numbers_of
from separatrix.cage.rows import PIVOT, of
from separatrix.chain.impact_restitution import damping_for

M, R = AT_REST.mass, AT_REST.pitch_radius
CRYO = BallTraction(mass=6.567e-3, slope=188.0, speed=73.0 / 188.0)
"""A turbopump's ball: 73 N at most."""

WHEEL = BallTraction(mass=1.289e-3, slope=74.3, speed=1.3 / 74.3)
"""A momentum wheel's: 1.3 N at most."""


def one_ball(**change: object) -> MovingCage:
    """A cage of 50 g with one ball, head on, which turns only if its inertia is given, without friction."""
    alone = {"ball_count": 1, "ball_cage_friction": 0.0, "moment_of_inertia": 1e9}
    return replace(AT_REST, **(alone | change))


def test_a_cage_that_touches_nothing_swims_in_its_fluid():
    r"""With z = x + iy of the turning frame, M = m + m_a, and D the speed of the frame less the fluid's.

    :math:`M z'' + (2i(m\Omega + m_a D) + c) z' - (m\Omega^2 + m_a D^2 - icD) z = 0`.
    """
    turn, swirl, fluid, drag, speed = 670.0, 300.0, 0.02, 3.0, 0.5
    cage = one_ball(
        cage_speed=turn, added_mass=fluid, fluid_speed=swirl, fluid_damping=drag, pocket_clearance=1.0
    )
    lag, m = turn - swirl, cage.mass
    twice, pull = 2j * (m * turn + fluid * lag) + drag, m * turn**2 + fluid * lag**2 - 1j * drag * lag
    a, b = np.roots([m + fluid, twice, -pull])
    after = followed(cage, 5e-3, refine=4)
    exact = 1j * speed * (np.exp(a * after.time) - np.exp(b * after.time)) / (a - b)
    found = after.position[:, 0] + 1j * after.position[:, 1]
    # of a step of fourth order: 5e-10 at the usual length, 256 times less at a quarter
    assert np.abs(found - exact).max() < 4e-12 * np.abs(exact).max()
    # the frame's work less the drag's is what the cage has more: nothing else gives or takes energy
    assert after.energy_imbalance < 1e-7  # 3e-8 measured, of the step


# Impacts on a ball.


@pytest.mark.parametrize("may_turn", [False, True])
@pytest.mark.parametrize("eta", [0.07, 0.6, 0.94])
def test_one_impact_returns_the_restitution_of_its_closed_form(eta, may_turn):
    """Spring and damper in series: 1e-3 at the step that runs have, 1e-4 at a quarter; half is measured."""
    inertia = M * R * R if may_turn else 1e9
    cage = one_ball(race_damping=damping_of(eta), moment_of_inertia=inertia)
    back = impact_restitution(cage, may_turn=may_turn)
    for refine, tolerance in ((1, 1e-3), (4, 1e-4)):
        after = followed(cage, 0.0015, refine=refine)
        pocket = after.velocity[-1, 1] + R * after.rotation_rate[-1]
        assert -pocket / 0.5 == pytest.approx(back, abs=tolerance)


@pytest.mark.parametrize("outer", [False, True])
def test_friction_of_an_impact_is_a_share_of_its_impulse(outer):
    """F times the normal impulse: inward behind the ball if the inner race turns, else outward."""
    speeds = {"inner_speed": 0.0, "outer_speed": 1500.0} if outer else {}
    after = followed(one_ball(ball_cage_friction=0.2, race_damping=damping_of(0.6), **speeds), 0.0015)
    normal, sense = M * (after.velocity[-1, 1] - 0.5), -1.0 if outer else 1.0
    # rounding, 4e-16: the ball is as good as infinitely fast, and one force acts along and across
    assert M * after.velocity[-1, 0] == pytest.approx(0.2 * sense * normal, rel=1e-12)


def test_a_hertz_impact_has_the_force_and_the_time_of_the_closed_form():
    """5.496616 g at 0.5 m/s on K 5e8: 66.15387 N for 152.8449 us (numbers of dynamics3d.md, E7)."""
    # Cage and ball have twice the mass each, which makes that mass of the pair, and trade their speeds.
    twice = 2 * 5.496616e-3
    free = BallTraction(mass=twice, slope=1e-9, speed=math.inf)
    cage = one_ball(traction=free, mass=twice, hertz_coefficient=5e8)
    after = followed(cage, 1e-3, samples=10_000, refine=64)
    force = after.contact_force[:, 0]
    touching = np.count_nonzero(force > 1e-3) * after.time[1]
    # the peak lies up to half a row, 0.15 us, beside one: (pi/2 x 0.15/76)^2 of the force at most
    assert force.max() == pytest.approx(66.15387, rel=1e-5)
    assert touching == pytest.approx(152.8449e-6, abs=after.time[1])  # rows are counted: one more or less
    assert after.ball_speed[-1, 0] == pytest.approx(0.5, rel=3e-8)  # 1e-8: ends within a step


@pytest.mark.parametrize("kick", [0.02, 0.5, 2.0])
@pytest.mark.parametrize(("law", "mass", "stiffness"), [(CRYO, 0.025, 3e6), (WHEEL, 0.005, 1e6)])
def test_a_ring_that_may_turn_rebounds_by_the_law(law, mass, stiffness, kick):
    """One ball: the pocket's speed is that of half the ring's mass; scipy on the three equations."""
    ring = {"mass": mass, "moment_of_inertia": mass * R * R, "ball_cage_stiffness": stiffness}
    exactly = {"rtol": 1e-12, "atol": 1e-16, "method": "DOP853"}
    back, _, contact = impact(
        lambda x, N: (N - law.force(x)) / law.mass, 1, (mass / 2, stiffness), kick, **exactly
    )
    after = followed(one_ball(traction=law, **ring), 5e-4 / kick + contact, kick=kick, refine=8)
    pocket = after.velocity[-1, 1] + R * after.rotation_rate[-1]
    # 2.9e-5 measured: begin and end of the impact within an eighth of the usual step
    assert -pocket / kick == pytest.approx(back, abs=4e-5)
    returned = returned_share(law, mass / 2, stiffness, kick)
    # 9.7e-11 measured: scipy keeps 1e-8 of each step; ten times, for its steps differ between versions
    assert returned == pytest.approx(max(0.0, back), abs=1e-9)


def test_the_law_of_friction_does_not_depend_on_the_disturbance():
    """Where balls hardly spin, a share of their orbital speed; at rest nothing else has a speed."""
    turning = replace(ON_A_LAND, pivot_speed=0.0)
    speeds = {numbers_of(turning, kick, 0.1).numbers[of(PIVOT)] for kick in (0.1, 2.0)}
    assert len(speeds) == 1
    at_rest = replace(turning, cage_speed=0.0)
    assert len({numbers_of(at_rest, kick, 0.1).numbers[of(PIVOT)] for kick in (0.1, 2.0)}) == 2


@pytest.mark.parametrize("eta", [0.0, 0.07, 0.6, 0.95])
def test_a_ball_without_inertia_that_cannot_slide_returns_eta(eta):
    """Eq. 17: the restitution factor of the damper; 0 where it is overdamped."""
    mass, stiffness = 0.025, 3e6
    slope = damping_for(eta, stiffness, mass) * (0.5 if eta == 0.0 else 1.0)
    law = BallTraction(mass=1e-9, slope=slope, speed=math.inf)
    # 1.1e-8 measured, in proportion to the ball's 1 ug
    assert returned_share(law, mass, stiffness, 0.5) == pytest.approx(eta, abs=3e-8)


# A cage on its land.


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.7, 1.0, 1.7, 40.0])
def test_rebound_of_a_damper_that_cannot_pull(zeta):
    """The closed form against the equation of motion, until the force is back at zero; and its inverse."""

    def force_left(time, state):
        return state[0] + 2 * zeta * state[1] if time > 1e-3 else 1.0

    force_left.terminal = True
    how = {"events": force_left, "rtol": 1e-11, "atol": 1e-13}
    course = solve_ivp(lambda _, x: [x[1], -x[0] - 2 * zeta * x[1]], (0, 60), [0, 1], **how)
    assert rebound(zeta) == pytest.approx(-course.y_events[0][0][1], abs=1e-8)  # the integrator's tolerance
    assert rebound_damping(rebound(zeta)) == pytest.approx(zeta, abs=1e-9, rel=1e-6)


@pytest.mark.parametrize(("guidance", "count"), [(Guidance.OUTER, 1), (Guidance.INNER, 2)])
@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9])
def test_the_land_returns_its_restitution(guidance, count, restitution):
    """Head on without friction, as one land or as two that share the damping."""
    land = {"guidance": guidance, "land_clearance": 2e-4, "land_friction": 0.0, "land_count": count}
    cage = one_ball(pocket_clearance=0.02, land_restitution=restitution, **land)
    after = followed(cage, 0.0006, direction=0.7, refine=64)
    speed = -after.velocity[-1] @ [math.cos(0.7), math.sin(0.7)]
    # 1.2e-4: the damper begins to push with a jump within a step, an error of the first order
    assert speed == pytest.approx(0.5 * restitution, abs=2.5e-4)


def test_a_land_with_a_slow_ring_only_stops_the_sliding():
    """A ring so slow that friction can stop the sliding: cage and ring have one speed where they touch."""
    far = {"pocket_clearance": 0.04, "land_clearance": 0.02, "moment_of_inertia": M * R * R}
    cage = one_ball(guidance=Guidance.OUTER, land_friction=0.5, outer_speed=1.0, **far)
    after = followed(cage, 0.021, direction=0.0, refine=4)
    surface = after.velocity[-1, 1] + R * after.rotation_rate[-1]
    assert surface == pytest.approx(R * 1.0, rel=6e-3)  # the cage slides along its land during the impact


M_L, R_L, C_G, G = 0.025, 0.036, 0.5e-3, 9.80665


def on_a_land(**changes: object) -> MovingCage:
    """The cage of dynamics3d's E5 and E6, in pockets so wide that it never meets a ball."""
    given = {
        "mass": M_L, "moment_of_inertia": M_L * R_L * R_L, "ball_count": 2, "pitch_radius": R_L,
        "cage_speed": 0.0, "inner_speed": 0.0, "outer_speed": 0.0, "pocket_clearance": 10e-3,
        "race_damping": 300.0, "ball_cage_friction": 0.0, "guidance": Guidance.INNER,
        "land_clearance": 2.0 * C_G, "land_stiffness": 3e7, "land_restitution": 0.05, "land_friction": 0.0,
    }  # fmt: skip
    return replace(ON_A_LAND, **(given | changes))


def rising(angle):
    """Places before which a swing rises through zero."""
    return np.flatnonzero((angle[:-1] < 0.0) & (angle[1:] >= 0.0))


def crossings(time, angle):
    """Mean period of a swing through zero."""
    i = rising(angle)
    return np.diff(time[i] - angle[i] * (time[i + 1] - time[i]) / (angle[i + 1] - angle[i])).mean()


def whirl(found, late):
    """Angular speed of the centre about the axis."""
    (x, y), (vx, vy) = found.position[late].T, found.velocity[late].T
    return (x * vy - y * vx) / (x * x + y * y)


@pytest.mark.parametrize(("friction", "frequency"), [(0.0, 22.28925), (0.8, 15.76088)])
def test_a_cage_hangs_on_its_land_as_a_pendulum(friction, frequency):
    """Sliding sqrt(g/c)/2 pi, rolling with a thin ring's inertia 1/sqrt 2 of it (dynamics3d E5)."""
    cage = on_a_land(gravity=G, land_friction=friction)
    found = followed(cage, 0.4, kick=5e-3, direction=0.0121, samples=8001)
    late = found.time > 0.2
    period = crossings(found.time[late], found.position[late, 1])
    # It falls on its land first. A swing of 12 mrad lengthens the period by 1e-5 of it; a rolling one creeps.
    assert period == pytest.approx(1.0 / frequency, rel=2.5e-5)


def test_a_rolling_cage_swings_far_as_the_elliptic_pendulum_does():
    """4 K(sin(A/2))/w_0, w_0^2 = g/(c (1 + J/(M R^2))): .06809150 s at 60 deg (dynamics3d E5)."""
    cage = on_a_land(gravity=G, land_friction=1.5)
    found = followed(cage, 0.3, kick=0.3, direction=math.radians(62.0), samples=8001)
    late = found.time > 0.02
    angle = np.arctan2(*found.position[late].T[::-1])
    amplitude = np.array([0.5 * np.ptp(angle[a:b]) for a, b in pairwise(rising(angle))])
    rate = math.sqrt(G / (2.0 * C_G))
    period = (4.0 / rate * ellipk(np.sin(amplitude / 2.0) ** 2)).mean()
    assert amplitude[0] > math.radians(50.0)
    assert crossings(found.time[late], angle) == pytest.approx(period, rel=2.5e-5)
    assert 4.0 / rate * ellipk(0.25) == pytest.approx(0.06809150, rel=1e-7)


def test_a_dry_land_slows_down_a_whirl_against_it():
    """Nu = nu_0/(1 + f nu_0 t), N = M c nu^2, and the spin takes M R c (nu_0 - nu)/J (dynamics3d E6)."""
    J, f = 2.671250e-5, 0.1
    cage = on_a_land(
        moment_of_inertia=J, guidance=Guidance.OUTER, outer_speed=1e5, land_friction=f,
        race_damping=3000.0, pocket_clearance=0.1, land_stiffness=1e8,
    )  # fmt: skip
    lead = np.array([0.0, 0.05 - 3e-4])
    found = followed(cage, 0.03, lead=lead, kick=1.5, direction=math.pi / 4, samples=1501)
    late = found.time > 0.01
    nu = -whirl(found, late)
    gained = found.rotation_rate[late][-1] - found.rotation_rate[late][0]
    # From 500 rad/s at f .1: 333.3333 after 10 ms, 2.807674 rad/s, 3.125 N. From the centre a cage meets its
    # land head on; a ball deflects it before, and lets it whirl against the ring.
    assert nu[0] > nu[-1] > 30.0
    assert np.polyfit(found.time[late], 1.0 / nu, 1)[0] == pytest.approx(f, rel=1e-4)
    assert found.land_force[late] == pytest.approx(M_L * C_G * nu**2, rel=3e-5)  # it gives way by 1e-5
    assert gained == pytest.approx(M_L * R_L * C_G * (nu[0] - nu[-1]) / J, rel=1e-4)
    after = 1.0 / (1.0 / 500.0 + f * 0.01)
    spun = M_L * R_L * C_G * (500.0 - after) / J
    assert (after, spun, M_L * C_G * 500.0**2) == pytest.approx((333.3333, 2.807674, 3.125), rel=2e-7)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_dry_land_speeds_up_a_whirl(sense):
    """Nu = nu_0/(1 - f nu_0 t): 1/nu falls by f each second (dynamics3d E6), with the spin held."""
    f = 0.1
    held = {"moment_of_inertia": 1e3, "guidance": Guidance.OUTER, "outer_speed": 1e4 * sense}
    found = followed(on_a_land(**held, land_friction=f), 0.04, kick=0.3, direction=0.0, samples=4001)
    late = found.time > 0.02
    nu = whirl(found, late)
    # The ring drags it along; 2e-5 measured: the land gives way by 1e-5 of the clearance.
    assert np.all(nu * sense > 0.0)
    assert np.polyfit(found.time[late], 1.0 / np.abs(nu), 1)[0] == pytest.approx(-f, rel=5e-5)


@pytest.mark.parametrize(
    ("friction", "offset", "angle"), [(0.0, 1.586139e-7, 85.4536), (0.1, 1.578267e-7, 91.1642)]
)
def test_gripped_pockets_hold_a_cage_against_gravity(friction, offset, angle):
    """Sag and its angle from gravity where the pockets of a turning ball set grip (dynamics3d E8)."""
    cage = on_a_land(
        guidance=Guidance.BALL, land_clearance=None, pocket_clearance=0.0, pitch_radius=0.0325,
        moment_of_inertia=M_L * 0.0325**2, cage_speed=668.9886, inner_speed=1570.8, race_damping=356.5792,
        ball_cage_friction=friction, gravity=G, ball_count=13,
    )  # fmt: skip
    found = followed(cage, 0.2, kick=1e-3, direction=0.0, samples=2001)
    # beside the sag, which turns backward in this frame, the slow root of small motions is left
    late = found.time > 0.1
    t, drift = found.time[late], linear_roots(cage)[0]
    columns = np.stack([np.exp(-1j * cage.cage_speed * t), np.exp(drift * t)], axis=1)
    sag = np.linalg.lstsq(columns, found.position[late] @ np.array([1.0, 1j]), rcond=None)[0][0]
    # To the digits printed there: 7 of the sag, 4 decimals of the angle.
    assert np.abs(sag) == pytest.approx(offset, rel=5e-7)
    assert math.degrees(abs(np.angle(sag))) == pytest.approx(angle, abs=1e-4)


# Impacts so hard and dead that a cage slides round in the polygon that its pockets leave it.

DAMPING = 2000.0
STIFFNESS = 1.05 * 8.0 * DAMPING**2 / AT_REST.mass
"""Dead even where two opposite balls are struck at once: zeta, sqrt(2 k M)/4 C there, is above 1."""


def dead(balls: int, friction: float) -> MovingCage:
    """A cage that may not turn, among dampers at rest; an impact returns nothing."""
    return replace(
        AT_REST, ball_count=balls, moment_of_inertia=1e9, pocket_clearance=20e-3, race_damping=DAMPING,
        ball_cage_stiffness=STIFFNESS, ball_cage_friction=friction,
    )  # fmt: skip


def growth(balls: int, friction: float) -> float:
    """Growth of the logarithm of the speed in a turn of its direction, over the whole turns of 0.5 s."""
    # Later a growing one would be so fast that its impacts are no longer short.
    found = followed(dead(balls, friction), 0.5, kick=3.0, samples=10_000)
    speed = found.velocity @ [1.0, 1j]
    turned = np.unwrap(np.angle(speed)) / (2.0 * math.pi)
    late = turned > turned[-1] - math.floor(turned[-1] - 1.0)  # the first impact is another one
    return float(np.polyfit(turned[late], np.log(np.abs(speed[late])), 1)[0])


@pytest.mark.parametrize(("balls", "corners", "critical"), [(11, 22, 0.1438), (12, 12, 0.2679)])
def test_a_cage_whirls_in_the_polygon_of_its_pockets_above_a_tangent(balls, corners, critical):
    """A corner turns it by 2 pi/n and leaves cos + f sin of its speed: it grows above tan(pi/n)."""
    angle = 2.0 * math.pi / corners
    # 2 % below and above. 1e-5 of what the corners take without friction is measured: impacts last a part of
    # the way to the next corner.
    assert critical == pytest.approx(math.tan(math.pi / corners), abs=5e-5)  # the digits given
    whole = -corners * math.log(math.cos(angle))
    for friction in (0.98 * critical, 1.02 * critical):
        lasts = corners * math.log(math.cos(angle) + friction * math.sin(angle))
        assert growth(balls, friction) == pytest.approx(lasts, abs=3e-5 * whole)
