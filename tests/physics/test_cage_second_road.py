"""The second road itself: what its small steps must give where the answer is known, and its order.

What engine and second road are both held to is here; test_cage_features holds one to the other.

Tolerances: the step's order (fourth within a mode, second over a contact that starts or ends), measured here
by halving it, or rounding over some 10 000 steps where Runge-Kutta is exact.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import small_step
from cages import ON_A_LAND, followed, linear_roots

from separatrix.study import Guidance, PocketShape

M, R, K = 0.025, 0.0325, 3e6
CAGE = replace(ON_A_LAND, cage_speed=669.0, inner_speed=1570.8)
FREE = replace(CAGE, guidance=Guidance.BALL, pocket_clearance=10.0)
HEAD_ON = replace(
    FREE, ball_count=1, pocket_clearance=2e-4, moment_of_inertia=1e6, cage_speed=0.0, ball_cage_friction=0.0
)


def go(cage, *, kick=0.5, direction=0.4, lead=None, duration=2e-3, step=2e-7, **more):
    """Run of the second road."""
    lead = np.zeros(cage.ball_count) if lead is None else lead
    return small_step.follow(
        cage, kick=kick, direction=direction, ball_lead=lead, duration=duration, step=step, **more
    )


def follow_in_the_engine(cage, *, kick=0.5, duration, step):
    """Run of the engine, which takes its own steps."""
    return followed(cage, duration, kick=kick, direction=0.4, samples=50)


def in_space(cage, run, time):
    """Orbit of the centre of mass seen from space, as complex numbers, and the angle turned by the balls."""
    s0, tr = cage.ramp_start, cage.ramp_time
    ramped = np.minimum(time, tr)
    missing = (1 - s0) * (ramped - ramped**2 / (2 * tr)) if tr else 0.0 * time
    turned = cage.cage_speed * (time - missing)
    eccentricity = cage.unbalance / cage.mass
    return np.exp(1j * turned) * (run.position @ [1, 1j] + eccentricity * np.exp(1j * run.rotation)), turned


ROADS = {"engine": (follow_in_the_engine, 1e-15), "second": (go, 1e-14)}
"""Both programs, and what is left of the way of some mm: rounding, and (Omega h)^4 = 2e-13 of it."""


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize("ramp", [0.0, 0.003])
def test_free_flight_is_a_line_or_a_parabola_in_space(gravity, ramp, road):
    """Ramp or not, a cage that touches nothing keeps its velocity and its spin in space, or falls."""
    follow, left = ROADS[road]
    cage = replace(FREE, gravity=gravity, ramp_time=ramp, ramp_start=0.2)
    run = follow(cage, duration=5e-3, step=1e-6)
    seen, turned = in_space(cage, run, run.time)
    fallen = 0.5 * np.exp(0.4j) * run.time + 0.5 * gravity * run.time**2
    assert len(run.time) > 5
    np.testing.assert_allclose(seen, fallen, atol=left)
    start = cage.cage_speed * (cage.ramp_start if ramp else 1.0)
    # rounding: 1e-12 rad of some rad
    np.testing.assert_allclose(run.rotation + turned, start * run.time, atol=1e-11)


@pytest.mark.parametrize("road", ROADS)
def test_an_unbalanced_cage_circles_its_centre_of_mass(road):
    """The centre of mass goes straight; the geometric centre is the eccentricity behind, turning evenly."""
    follow, left = ROADS[road]
    run = follow(replace(FREE, unbalance=1e-6), kick=0.01, duration=5e-3, step=1e-6)
    e, turned = 1e-6 / M, 669.0 * run.time
    straight = e + (0.01 * np.exp(0.4j) + 1j * 669.0 * e) * run.time
    centre = np.exp(1j * turned) * (run.position @ [1, 1j])
    np.testing.assert_allclose(centre, straight - e * np.exp(1j * turned), atol=left)


def test_a_hertz_impact_lasts_and_dips_as_hertz_says():
    """Without dampers: approach (5 M v^2 / 4 K)^(2/5), lasting 2.9432 approach/v, all the energy returned."""
    K_H, v = 3e8, 0.5
    cage = replace(HEAD_ON, race_damping=math.inf, hertz_coefficient=K_H)
    run = go(cage, kick=v, direction=math.pi / 2, duration=8e-4, step=1e-7, samples=10**6)
    dip = (1.25 * M * v**2 / K_H) ** 0.4
    assert run.position[:, 1].max() - 1e-4 == pytest.approx(dip, rel=1e-6)  # (h / contact time)^2
    inside = run.position[:, 1] > 1e-4
    # two steps of the contact's time
    assert np.ptp(run.time[inside]) == pytest.approx(2.9432 * dip / v, abs=2e-7)
    assert run.velocity[-1, 1] == pytest.approx(-v, rel=1e-6)


@pytest.mark.parametrize(
    ("guidance", "lobes", "way"),
    [(Guidance.OUTER, 2, -1), (Guidance.OUTER, 3, -1), (Guidance.INNER, 2, -1), (Guidance.INNER, 3, 1)],
)
def test_a_lobe_takes_room_where_the_land_is_touched(guidance, lobes, way):
    """A lobe stands at angle 0; an inner land is touched opposite, where three lobes leave room."""
    cage = replace(FREE, cage_speed=0.0, guidance=guidance, land_clearance=2e-4)
    run = go(replace(cage, land_out_of_round=1e-5, land_lobes=lobes), direction=0.0, duration=4e-4, step=1e-7)
    touched = run.time[np.argmax(run.velocity[:, 0] < 0.5 - 1e-9)]
    assert touched == pytest.approx((1e-4 + way * 1e-5) / 0.5, abs=2e-7)  # two steps


@pytest.mark.parametrize(
    ("shape", "offset"),
    [(PocketShape.SQUARE, 0.0)]
    + [(shape, z) for shape in (PocketShape.CYLINDRICAL, PocketShape.ELONGATED) for z in (0.0, 1e-4, 2.5e-4)],
)
def test_a_pocket_holds_its_ball_as_its_outline_says(shape, offset):
    """Play and stiffness along the circumference, from the outline drawn in the plane of the pocket.

    The ball's centre may go a straight way and then on the circle of the end's play; beyond it the spring's
    force is along the normal. The stiffness is the slope of its circumferential part at the first touch.
    """
    c, end = 3e-4, {PocketShape.CYLINDRICAL: 3e-4, PocketShape.ELONGATED: 2.6e-4}.get(shape)
    axial = 2 * end if shape is PocketShape.ELONGATED else None
    cage = replace(CAGE, pocket_shape=shape, pocket_axial_offset=offset, pocket_axial_clearance=axial)
    play, psi = small_step.contact(cage)

    def push(u):
        if end is None:
            return K * (u - c)
        ahead = u - (c - end)
        reach = math.hypot(ahead, offset)
        return K * (reach - end) * ahead / reach

    assert push(play) == pytest.approx(0.0, abs=1e-9)
    slope = (push(play + 1e-9) - push(play - 1e-9)) / 2e-9
    assert small_step.numbers(cage).stiffness == pytest.approx(slope, rel=1e-6)
    assert math.cos(psi) ** 2 * K == pytest.approx(slope, rel=1e-6)


def test_balls_that_touch_nothing_lead_and_lag_with_the_load():
    """The integral of their own speed, in closed form, through a ramp and after."""
    cage = replace(FREE, orbital_cosines=(0.05, 0.03), orbital_sines=(-0.02, 0.04))
    cage = replace(cage, ramp_time=2e-3, ramp_start=0.3)
    run = go(cage, duration=5e-3, step=1e-6)
    at = 2 * math.pi * np.arange(13) / 13 + in_space(cage, run, run.time)[1][:, np.newaxis]
    parts = zip((1, 2), cage.orbital_cosines, cage.orbital_sines, strict=True)
    # dy/dphi = V/Omega at any speed, both rising together
    free = sum((A * np.sin(h * at) - B * np.cos(h * at)) / (h * 669.0) for h, A, B in parts)
    np.testing.assert_allclose(run.ball_lead, free - free[0], atol=1e-14)


@pytest.mark.parametrize(("speed", "friction"), [(0.0, 0.0), (0.0, 0.08), (669.0, 0.12), (-300.0, 0.05)])
def test_a_gripped_cage_moves_on_its_exact_roots(speed, friction):
    """Zero clearance: the three exponentials of the linear law, from the start of the kick."""
    cage = replace(FREE, pocket_clearance=0.0, cage_speed=speed, ball_cage_friction=friction)
    run = go(cage, duration=2e-3, step=2e-7)
    roots = linear_roots(cage)
    v = 0.5 * np.exp(0.4j)
    share = np.linalg.solve(np.vander(roots, increasing=True).T, [0.0, v, -2j * speed * v])
    exact = np.exp(np.outer(run.time, roots)) @ share
    # the slow root is 1e-6 of the others, and known to some 1e-10 of itself
    np.testing.assert_allclose(run.position @ [1, 1j], exact, rtol=0, atol=1e-7 * np.abs(exact).max())


def test_the_step_is_of_fourth_order_within_a_mode():
    """Halved steps, no play, gravity and unbalance on: the change falls by 16, within 10 % of the order."""
    cage = replace(CAGE, pocket_clearance=0.0, guidance=Guidance.BALL, unbalance=1e-6, gravity=9.81)
    ends = [go(cage, step=step, duration=1e-3).velocity[-1] for step in (1e-5, 5e-6, 2.5e-6)]
    order = math.log2(np.linalg.norm(ends[0] - ends[1]) / np.linalg.norm(ends[1] - ends[2]))
    assert order == pytest.approx(4.0, abs=0.4)
