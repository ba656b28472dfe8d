"""The cage in space against what is known: the plane, small steps with exact rotations, closed forms.

E4, E9, E10 and P1 to P4 are our own derivations and programs. Each test says its tolerance.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import ON_A_LAND, TURNING, WAVES, follow
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from scipy.special import ellipk
from scipy.stats import binomtest
from space_cages import IN_PLANE, PITCH, ROUND, course, in_space, ring
from space_program import SmallSteps, bore_contact, land_gap, ring_axes, sliding

from separatrix.ball_traction import BallTraction
from separatrix.cage import RunOutcome, run_ensemble
from separatrix.cage.closed_forms import time_unit
from separatrix.cage.records import Pace
from separatrix.cage.space.inputs import numbers, parts_of
from separatrix.cage.space.land import dent_strip, press_strip, strip_forces
from separatrix.cage.space.pocket import expand_contact, place_pocket
from separatrix.cage.space.records import (
    AXIAL,
    DEPTH_L,
    FAR,
    GA,
    GB,
    GX,
    GY,
    LEAD,
    NX,
    NY,
    PT,
    PZ,
    ROUND_END,
    SLIDE,
    SLIDE_Q,
    SLIDE_R,
    VS,
    VZ,
    S,
    Z,
)
from separatrix.pocket_shape import PocketShape
from separatrix.study import Guidance, StabilitySettings


def axes(x, y, z):
    """From the document's axes, x along the bearing, to those of the package, z along it."""
    return np.array([y, z, x])


SPEED, SPIN = axes(0.02, 0.3, -0.1), axes(670.9886, 5.0, -8.0)
LEADS = 9e-5 * np.array([0.02, 0.9, -0.71, 0.9, -0.38, -0.15, 0.65, -0.18, 0.1, -0.94, 0.51, 0.08, -0.34])
CENTRE, TURNED = axes(1e-4, 1.5e-4, -5e-5), Rotation.from_rotvec(axes(3e-3, 4e-3, -2e-3))
OUT, ALONG = ring_axes(2.0 * math.pi * 3 / 13 + 0.002)
BALL = 32.55e-3 * OUT + axes(3e-5, 0.0, 0.0)


def test_a_ball_in_its_bore():
    """P1: offset, gap, height and direction of the force on the ball, to the digits given."""
    offset, height, away = bore_contact(CENTRE, TURNED, 2.0 * math.pi * 3 / 13, 32.5e-3, BALL)
    assert offset == pytest.approx(2.405062620e-4, rel=1e-9)
    assert 3e-4 - offset == pytest.approx(5.949373797e-5, rel=1e-9)
    assert height == pytest.approx(8.142034376e-5, rel=1e-9)
    assert [-away[2], -away @ OUT, -away @ ALONG] == pytest.approx([0.861332, -0.003116, -0.508032], abs=5e-7)


def test_the_sliding_of_a_ball_in_its_bore():
    """P2: rate along the normal and the three parts of the sliding, to the digits given."""
    away = bore_contact(CENTRE, TURNED, 2.0 * math.pi * 3 / 13, 32.5e-3, BALL)[2]
    orbit = axes(668.9886, 0.0, 0.0)
    whirling = axes(-4083.218, 0.0, 0.0) + 1942.614 * OUT - 3.530 * ALONG + orbit
    rate, slip = sliding(SPEED, SPIN, CENTRE, BALL, np.cross(orbit, BALL), whirling, away, 11.1125e-3 / 2.0)
    assert rate == pytest.approx(-0.296397, abs=5e-7)
    assert [slip[2], slip @ OUT, slip @ ALONG] == pytest.approx([5.548003, 11.686468, 9.334559], abs=5e-7)
    assert np.linalg.norm(slip) == pytest.approx(15.952676, abs=5e-7)


def test_the_engine_has_that_contact_to_first_order():
    """P1 and P2 by the kernels: the offset to 5e-4, directions to 1.5e-3, the sliding to .06 of 16 m/s.

    The second order of tilts up to 4 mrad, and the way and speed of the ball outward, are left out.
    """
    plane = replace(TURNING, cage_speed=668.9886, pocket_shape=PocketShape.CYLINDRICAL)
    cage = in_space(plane)
    p, parts, R, T = numbers(cage, 0.5), parts_of(cage), cage.pitch_radius, time_unit(cage)
    now, rates, turned = parts.cage[0], parts.cage[1], TURNED.as_rotvec()
    now[[GX, GY, Z]], now[[GA, GB, S]] = CENTRE, R * turned
    seen = (SPEED - np.cross([0.0, 0.0, plane.cage_speed], CENTRE)) * T
    rates[[GX, GY]], now[VZ] = seen[:2], seen[2]
    rates[[GA, GB]], now[VS] = R * T * SPIN[:2], R * T * (SPIN[2] - plane.cage_speed)
    parts.ball[3, 0, [LEAD, AXIAL]] = 0.002 * R, 3e-5
    parts.kind[6] = ROUND_END
    place_pocket(p, parts, 3, 0)
    expand_contact(p, parts, 6, Pace(1.0, 0.0), 0)
    c = parts.contact[6, 0]
    assert c[FAR] == pytest.approx(2.405062620e-4, rel=5e-4)
    assert [-c[PZ], -c[PT]] == pytest.approx([0.861332, -0.508032], abs=1.5e-3)
    slip = np.array([-c[SLIDE_Q] * c[PT], c[SLIDE_R], c[SLIDE_Q] * c[PZ], c[SLIDE]]) / T
    assert slip == pytest.approx([5.548003, 11.686468, 9.334559, 15.952676], abs=0.06)


def test_the_engine_has_the_gap_of_a_land_to_first_order():
    """P3 by the kernels, less the second order (R_c/2)(k e)^2 of the tilt: to .3 um, as the notes have it."""
    cage = in_space(replace(ON_A_LAND, land_clearance=1e-3), land_heights=(6e-3,))
    p, parts, R = numbers(cage, 0.5), parts_of(cage), cage.pitch_radius
    tilt, centre = axes(0.0, 8e-3, 3e-3), axes(0.0, 3e-4, 1e-4)
    parts.cage[0, [GX, GY]], parts.cage[0, [GA, GB]] = centre[:2], R * tilt[:2]
    dent_strip(p, parts, 0, 0)
    out = parts.strip[0, 0, [NX, NY]]
    second = 0.5 * 36e-3 * (tilt[1] * out[0] - tilt[0] * out[1]) ** 2
    assert second - parts.strip[0, 0, DEPTH_L] == pytest.approx(177.8263833e-6, abs=0.3e-6)
    assert math.degrees(math.atan2(out[1], out[0])) == pytest.approx(9.3763, abs=0.1)


def test_the_gap_of_a_tilted_cage_on_its_land():
    """P3: by search around the circle, to the digits given."""
    tilted = Rotation.from_rotvec(axes(0.0, 8e-3, 3e-3))
    gap, azimuth = land_gap(axes(0.0, 3e-4, 1e-4), tilted, 6e-3, 36e-3, 5e-4)
    assert gap == pytest.approx(177.8263833e-6, rel=1e-9)
    assert math.degrees(azimuth) == pytest.approx(9.3763, abs=5e-4)  # a flat minimum


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"cage_speed": 0.0, "ball_cage_friction": 0.3},
        {"land": True, "land_clearance": 3e-4, "land_friction": 0.2},
        {"unbalance": 1e-6, "gravity": 50.0, **WAVES},
        {"traction": BallTraction(mass=6.567e-3, slopes=(188.0,), speeds=(0.4,))},
    ],
    ids=["turning", "at rest", "land", "unbalance, gravity, uneven orbits", "traction"],
)
def test_held_in_the_plane_it_moves_as_the_planar_cage(changes):
    """Limit (a): 1e-9 m over three cage turns; both engines sum the same series of the same numbers."""
    changes = dict(changes)
    plane = replace(ON_A_LAND if changes.pop("land", False) else TURNING, race_damping=356.58, **changes)
    turns = 3 * 2.0 * math.pi / 669.0
    start = {"kick": 0.5, "direction": 0.3, "samples": 31}
    there = follow(plane, ball_lead=LEADS, duration=turns, until=turns, **start)
    held = in_space(plane, **IN_PLANE, groove_damping=math.inf, groove_stiffness=0.0)
    here = course(held, turns, lead=LEADS, **start)
    assert here.hits > 5
    pressed = np.asarray(here.books.looks)["land_max"][0] > 0.0
    assert bool(pressed) is (plane.guidance is not Guidance.BALL)
    rows = len(there.position)  # a whirl that grows without limit ends early
    assert rows > 15
    turned = here.motion[:, 3] / plane.pitch_radius
    away = plane.unbalance / plane.mass * np.stack([np.cos(turned), np.sin(turned)], 1)
    assert (here.motion[:, :2] - away)[:rows] == pytest.approx(there.position, abs=1e-9)
    assert here.motion[:rows, 3] == pytest.approx(there.rotation * plane.pitch_radius, abs=1e-9)


def test_held_in_the_plane_ensembles_end_as_in_the_plane():
    """Limit (a): the same starts end alike, some settling and some whirling."""
    plane = replace(ON_A_LAND, race_damping=1500.0, ball_cage_friction=0.13)
    settings = StabilitySettings(kicks=(0.1, 1.0), runs=4, duration=0.05)
    held = in_space(plane, **IN_PLANE, groove_damping=math.inf, groove_stiffness=0.0)
    here, there = run_ensemble(held, settings), run_ensemble(plane, settings)
    assert here.outcome == pytest.approx(there.outcome)
    assert here.judged_from == pytest.approx(there.judged_from)


def differences(cage, scale):
    """Largest difference of the engine from small steps over 2 ms, both shrunk by the scale [m]."""
    shrunk = replace(
        cage,
        pocket_clearance=scale * cage.pocket_clearance,
        space=replace(cage.space, axial_kick=0.2, tilt_kick=0.4),
    )
    leads, kick, duration = scale * LEADS, 0.5 * scale, 2.5e-3
    here = course(shrunk, duration, kick=kick, lead=leads, samples=7)
    speed = kick * np.array([math.cos(0.3), math.sin(0.3), 0.2])
    spin = np.array([0.4 * kick / cage.pitch_radius, 0.0, 0.0])
    there = SmallSteps(shrunk).run(speed, spin, leads, here.time, 1e-5)
    assert here.hits > 3
    R = cage.pitch_radius
    return np.abs(here.motion - there[:, [0, 1, 2, 5, 3, 4]] * [1.0, 1.0, 1.0, R, R, R]).max()


def test_it_moves_as_small_steps_with_exact_rotations_to_first_order():
    """Differences fall as the square of the size of the motion: by 4 for half of it, within a quarter."""
    full, half = differences(ROUND, 1.0), differences(ROUND, 0.5)
    assert full < 2e-6
    assert full / half == pytest.approx(4.0, rel=0.25)


def test_a_free_cage_wobbles():
    """E4: J_p w / J_t is 206.6285 Hz in space and 100.1557 Hz in the turning frame; to rounding of both."""
    plane = replace(
        TURNING, moment_of_inertia=2.671250e-5, cage_speed=668.9886, pocket_clearance=8e-3,
    )  # fmt: skip
    free = in_space(plane, transverse_inertia=1.376458e-5, tilt_kick=1.0)
    there = course(free, 0.01, kick=0.05, tilt_way=0.4, samples=200)
    assert there.hits == 0
    tilt, rate = (x[:, 4] + 1j * x[:, 5] for x in (there.motion, there.rates))
    seen = rate + 1j * plane.cage_speed * tilt  # rate in space, along the turning axes
    turns = np.unwrap(np.angle(seen)) / (2.0 * math.pi)
    frequency = np.polyfit(there.time, turns, 1)[0]
    assert frequency == pytest.approx(100.1557, abs=1e-4)
    assert frequency + plane.cage_speed / (2.0 * math.pi) == pytest.approx(206.6285, abs=1e-4)


def test_a_body_of_three_inertias_tumbles():
    """E4, of the small-step program: (1, 2, 3)e-5 kg m2 from (10, 2, 600) rad/s are there again in a period.

    1.047221e-2 s, with k^2 9.629594e-5 of the elliptic integral; seven digits.
    """
    alone = SmallSteps(replace(ROUND, ball_count=1, pocket_clearance=1.0))
    inertia, spin = np.array([1e-5, 2e-5, 3e-5]), np.array([10.0, 2.0, 600.0])
    alone.inertia = np.diag(inertia)
    a, b, c = inertia
    energy, squared = inertia @ spin**2, (inertia * spin) @ (inertia * spin)
    modulus = (b - a) * (c * energy - squared) / ((c - b) * (squared - a * energy))
    modulus = min(modulus, 1.0 / modulus)
    period = 4.0 * math.sqrt(a * b * c / ((c - b) * (squared - a * energy))) * ellipk(modulus)
    assert (modulus, period) == pytest.approx((9.629594e-5, 1.047221e-2), rel=5e-7)
    start = np.concatenate([np.zeros(3), [0.0, 0.0, 0.0, 1.0], np.zeros(3), spin, [1e-4, 0.0]])
    end = solve_ivp(alone.rates, (0.0, period), start, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
    assert Rotation.from_quat(end[3:7]).inv().apply(end[10:13]) == pytest.approx(spin, abs=1e-5)


CRITICAL = 0.045720
GRIPPED = {"clearance": 0.0, "ball_spin": (-4e15 * math.cos(PITCH), 4e15 * math.sin(PITCH), 0.0)}


def gripped(friction):
    """Return the ring of E9: no clearance, square pockets, free across."""
    free = {"groove_damping": math.inf, "groove_stiffness": 0.0}
    return replace(ring(friction, **(GRIPPED | free)), race_damping=4000.0)


@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.02, True)])
def test_without_clearance_a_whirl_grows_above_the_linear_threshold(share, grows):
    """E9: sqrt(2 k M / Z) / (C cos b) = .045720; energy of the last quarter over that of the second."""
    energy = course(gripped(share * CRITICAL), 0.12, samples=121).kinetic
    assert bool(energy[90:].mean() > energy[30:60].mean()) is grows


@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.02, True)])
def test_flats_along_the_axis_change_the_threshold(share, grows):
    """E9: .0903 with flats along the axis as stiff as along the orbit, C 2000, k_g 5.05e6, c_g 370."""
    cage = ring(share * 0.0903, groove_stiffness=5.05e6, axial_play=0.0, **GRIPPED)
    energy = course(replace(cage, race_damping=2000.0), 0.12, samples=121).kinetic
    assert bool(energy[90:].mean() > energy[30:60].mean()) is grows


def test_without_clearance_a_whirl_tilts_as_the_linear_law_says():
    """E9: 2891.193 Hz, and a forced tilt of .039251 of the offset; the fit leaves 1e-3."""
    there = course(gripped(CRITICAL), 0.1, samples=20001)
    late = slice(10000, None)
    time, w = there.time[late], 2.0 * math.pi * 2891.193
    waves = np.stack([0.0 * time + 1.0, time, np.exp(1j * w * time), np.exp(-1j * w * time)], 1)
    offset, tilt = (
        np.linalg.lstsq(waves, there.motion[late, k] + 1j * there.motion[late, k + 1], rcond=None)[0]
        for k in (0, 4)
    )
    assert np.abs(tilt[2:]).max() / np.abs(offset[2:]).max() == pytest.approx(0.039251, rel=2e-3)
    moving = there.rates[late, 0] + 1j * there.rates[late, 1]
    turns = np.unwrap(np.angle(moving)) / (2.0 * math.pi)
    assert abs(np.polyfit(time, turns, 1)[0]) == pytest.approx(2891.193, rel=1e-4)


@pytest.mark.parametrize(
    ("friction", "is_tilt_held", "grows"),
    [(0.03, False, False), (0.10, False, True), (0.08, True, False), (0.18, True, True)],
)
def test_tilting_lowers_the_critical_friction_of_bores(friction, is_tilt_held, grows):
    """E10: half the runs end above the kick's energy at .062 with the tilt free, at .119 with it held.

    Of 16 runs at the friction, the 95 % interval of the share lies on the right side of a half. Below
    the threshold some runs whirl on with less energy than the kick's: WHIRLS counts these too.
    """
    cage = ring(friction, clearance=6e-4, is_tilt_held=is_tilt_held, groove_stiffness=5.05e6)
    ends = run_ensemble(cage, StabilitySettings(duration=0.3, ball_scatter=0.3, runs=16), kicks=(0.5,))
    above = int((ends.end_energy > 0.5 * cage.mass * 0.5**2).sum())
    low, high = binomtest(above, ends.outcome.size).proportion_ci(0.95)
    assert (low > 0.5) if grows else (high < 0.5)
    assert int((ends.outcome == RunOutcome.WHIRLS).sum()) >= above


def test_two_lands_bear_a_tilted_cage():
    """P4: 1e9 N/m2 on two lands of 4 mm at +-6 mm, 20 um deep, 2 mrad: 160.0000 N and .59733333 N m."""
    plane = replace(
        ON_A_LAND, land_clearance=1e-3, land_count=2, land_stiffness=4e6, land_friction=0.0,
        land_restitution=1.0, pocket_clearance=8e-3,
    )  # fmt: skip
    lands = {"land_heights": (-6e-3, 6e-3), "land_width": 4e-3}
    force, moment = dented(in_space(plane, **lands), x=5.2e-4, tilt=2e-3)
    assert force == pytest.approx(-160.0, rel=1e-9)
    assert abs(moment) == pytest.approx(0.59733333, abs=5e-9)


def dented(cage, x, tilt):
    """Force along x and moment about y of the strips on a cage that sits there."""
    p, parts, R = numbers(cage, 0.5), parts_of(cage), cage.pitch_radius
    parts.cage[0, GX], parts.cage[0, GB] = x, tilt * R
    found = np.zeros(6)
    for i in range(parts.mode.size):
        dent_strip(p, parts, i, 0)
        dent_strip(p, parts, i, 1)
        press_strip(p, parts, i, Pace(1.0, 0.0), 0)
        found += strip_forces(p, parts, i, 0)
    unit = cage.mass / time_unit(cage) ** 2
    return found[0] * unit, found[5] * unit * R
