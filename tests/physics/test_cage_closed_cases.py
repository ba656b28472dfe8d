"""The cage in the plane against motions that have closed forms: on its land, and in pockets that grip."""

import math

import numpy as np
import pytest
from cages import linear_roots
from scipy.special import ellipk

from separatrix.cage import PlanarCage, follow
from separatrix.study import Guidance

M, R, C_G, G = 0.025, 0.036, 0.5e-3, 9.80665


def on_a_land(**changes) -> PlanarCage:
    """A cage whose pockets are so wide that it never meets a ball, on a stiff land."""
    given = {
        "mass": M,
        "moment_of_inertia": M * R * R,
        "ball_count": 13,
        "pitch_radius": R,
        "cage_speed": 0.0,
        "inner_speed": 0.0,
        "outer_speed": 0.0,
        "pocket_clearance": 10e-3,
        "ball_cage_stiffness": 3e6,
        "race_damping": 300.0,
        "ball_cage_friction": 0.0,
        "guidance": Guidance.INNER,
        "land_clearance": 2.0 * C_G,
        "land_stiffness": 1e9,
        "land_restitution": 0.0,
        "land_friction": 0.0,
    }
    return PlanarCage(**given | changes)


def history(cage: PlanarCage, **given):
    """One run with the balls in the middle of their pockets."""
    return follow(cage, ball_lead=np.zeros(cage.ball_count), **given)


@pytest.mark.parametrize(("friction", "frequency"), [(0.0, 22.28925), (0.8, 15.76088)])
def test_a_cage_hangs_on_its_land_as_a_pendulum(friction, frequency):
    """Sliding sqrt(g/c)/2 pi, rolling with a thin ring's inertia 1/sqrt 2 of it (dynamics3d E5).

    It falls on its land first. A swing of 12 mrad lengthens the period by 1e-5 of it; twice that is allowed.
    """
    cage = on_a_land(gravity=G, land_friction=friction)
    found = history(cage, kick=5e-4, direction=math.pi / 2, duration=0.4, samples=8001)
    late = found.time > 0.2
    t, y = found.time[late], found.position[late, 1]
    i = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    crossings = t[i] - y[i] * (t[i + 1] - t[i]) / (y[i + 1] - y[i])
    assert np.diff(crossings).mean() == pytest.approx(1.0 / frequency, rel=2e-5)


def test_a_rolling_cage_swings_far_as_the_elliptic_pendulum_does():
    """4 K(sin(A/2))/w_0, w_0^2 = g/(c (1 + J/(M R^2))): .06809150 s at 60 deg (dynamics3d E5).

    It lands near there and swings from 60.09 deg on; the land gives way by 5e-7 of the clearance.
    """
    cage = on_a_land(gravity=G, land_friction=1.5)
    found = history(cage, kick=1.0, direction=math.radians(60.2), duration=0.2, samples=8001)
    late = found.time > 0.02
    t, angle = found.time[late], np.arctan2(*found.position[late].T[::-1])
    i = np.flatnonzero((angle[:-1] < 0.0) & (angle[1:] >= 0.0))
    crossings = t[i] - angle[i] * (t[i + 1] - t[i]) / (angle[i + 1] - angle[i])
    amplitude, rate = np.abs(angle).max(), math.sqrt(G / (2.0 * C_G))
    assert math.degrees(amplitude) == pytest.approx(60.0, abs=0.2)
    period = 4.0 / rate * ellipk(math.sin(amplitude / 2.0) ** 2)
    assert np.diff(crossings).mean() == pytest.approx(period, rel=1e-6)
    assert 4.0 / rate * ellipk(0.25) == pytest.approx(0.06809150, rel=1e-7)


def test_a_dry_land_slows_down_a_whirl_against_it():
    """Nu = nu_0/(1 + f nu_0 t), N = M c nu^2, and the spin takes M R c (nu_0 - nu)/J (dynamics3d E6).

    From 500 rad/s at f .1: 333.3333 after 10 ms, 2.807674 rad/s, 3.125 N. From the centre a cage meets its
    land head on; a ball deflects it before, and lets it whirl against the ring. Tolerance as below.
    """
    J, f = 2.671250e-5, 0.1
    cage = on_a_land(
        ball_count=2, moment_of_inertia=J, guidance=Guidance.OUTER, outer_speed=1e5, land_friction=f,
        race_damping=3000.0, pocket_clearance=1.0,
    )  # fmt: skip
    lead = np.array([0.0, 0.5 - 3e-4])
    start = {"ball_lead": lead, "kick": 1.5, "direction": math.pi / 4}
    found = follow(cage, **start, duration=0.03, until=0.03, samples=1501)
    late = found.time > 0.01
    (x, y), (vx, vy) = found.position[late].T, found.velocity[late].T
    nu = -(x * vy - y * vx) / (x * x + y * y)
    assert nu[0] > nu[-1] > 30.0
    assert np.polyfit(found.time[late], 1.0 / nu, 1)[0] == pytest.approx(f, rel=1e-5)
    assert found.land_force[late] == pytest.approx(M * C_G * nu**2, rel=2e-4)  # the land still rings
    gained = found.rotation_rate[late][-1] - found.rotation_rate[late][0]
    assert gained == pytest.approx(M * R * C_G * (nu[0] - nu[-1]) / J, rel=1e-5)
    after = 1.0 / (1.0 / 500.0 + f * 0.01)
    spun = M * R * C_G * (500.0 - after) / J
    assert (after, spun, M * C_G * 500.0**2) == pytest.approx((333.3333, 2.807674, 3.125), rel=2e-7)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_dry_land_speeds_up_a_whirl(sense):
    """Nu = nu_0/(1 - f nu_0 t): 1/nu falls by f each second (dynamics3d E6), with the spin held.

    The land gives way a little: 4.9e-6 at 1e9 N/m, a tenth of that at ten times the stiffness.
    """
    f = 0.1
    cage = on_a_land(moment_of_inertia=1e3, guidance=Guidance.OUTER, outer_speed=1e4 * sense, land_friction=f)
    found = history(cage, kick=0.3, direction=0.0, duration=0.04, samples=4001)
    assert found.land_force.max() > 0.0
    late = found.time > 0.02
    x, y = found.position[late].T
    vx, vy = found.velocity[late].T
    nu = (x * vy - y * vx) / (x * x + y * y)
    slope = np.polyfit(found.time[late], 1.0 / np.abs(nu), 1)[0]
    assert slope == pytest.approx(-f, rel=1e-5)


@pytest.mark.parametrize(
    ("friction", "offset", "angle"), [(0.0, 1.586139e-7, 85.4536), (0.1, 1.578267e-7, 91.1642)]
)
def test_gripped_pockets_hold_a_cage_against_gravity(friction, offset, angle):
    """Sag and its angle from gravity where the pockets of a turning ball set grip (dynamics3d E8).

    To the digits printed there: 7 of the sag, 4 decimals of the angle.
    """
    cage = on_a_land(
        guidance=Guidance.BALL, land_clearance=None, pocket_clearance=0.0, pitch_radius=0.0325,
        moment_of_inertia=M * 0.0325**2, cage_speed=668.9886, inner_speed=1570.8, race_damping=356.5792,
        ball_cage_friction=friction, gravity=G,
    )  # fmt: skip
    found = history(cage, kick=1e-3, direction=0.0, duration=0.3, samples=3001)
    # beside the sag, which turns backward in this frame, the slow root of small motions is left
    late = found.time > 0.1
    t, drift = found.time[late], linear_roots(cage)[0]
    columns = np.stack([np.exp(-1j * cage.cage_speed * t), np.exp(drift * t)], axis=1)
    sag = np.linalg.lstsq(columns, found.position[late] @ np.array([1.0, 1j]), rcond=None)[0][0]
    assert np.abs(sag) == pytest.approx(offset, rel=1e-6)
    assert math.degrees(abs(np.angle(sag))) == pytest.approx(angle, abs=1e-4)
