"""Equilibrium against cases computed twice independently, exact identities, balances, and its friction."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import BEARING as TURBOPUMP
from cages import BEARING_218, STEEL_218
from mobile_balls import RPM, study_of
from scipy.optimize import root
from scipy.special import ellipe

from separatrix import ConvergenceError, InputError, KinematicModel, Operation, Race, read_study
from separatrix.chain.equilibrium import Equilibrium, contact, equilibrium
from separatrix.chain.grooved_ball import contact_actions, problem, touch
from separatrix.chain.hertz import contact_ellipse, contact_modulus, race_curvatures
from separatrix.chain.slip_friction import NODES, chebyshev_nodes, friction_resultants
from separatrix.ground.units import Array

FREE = KinematicModel.FREE
OUTER, INNER = KinematicModel.OUTER_RACE_CONTROL, KinematicModel.INNER_RACE_CONTROL
BALANCED = 2e-6  # the ring stops at 1e-6 of its load, the balls far below

LE7 = read_study("le7").bearing
"""A turbopump's bearing."""

SPINNING = Operation(inner_speed=10_000 * RPM, axial_load=22_250.0)
COMBINED = Operation(inner_speed=50_000 * RPM, axial_load=2670.0, radial_load=800.0, moment=1.0)


@pytest.mark.parametrize(
    ("model", "angles", "loads", "ratio"),
    [
        (OUTER, (48.705, 33.615), (1850.9, 2304.8), 0.4492),
        (INNER, (44.044, 39.185), (1783.1, 2201.0), None),
        (FREE, (48.40, 34.01), None, 0.4440),
    ],
)
def test_218_bearing(model, angles, loads, ratio) -> None:
    """The three kinematic models at 22 250 N and 10 000 rpm, friction 0.15; digits as given."""
    result = equilibrium(BEARING_218, SPINNING, model, 0.15)
    digit = 0.01 if model is FREE else 0.001
    # The gyroscopic moment opens the angles: with the wrong sign the inner one would fall to 44.9 deg.
    assert math.degrees(result.contact_angle_inner[0]) == pytest.approx(angles[0], abs=digit)
    assert math.degrees(result.contact_angle_outer[0]) == pytest.approx(angles[1], abs=digit)
    if loads:
        assert (result.load_inner[3], result.load_outer[3]) == pytest.approx(loads, abs=0.06)
    if ratio:
        assert result.orbital_speed[0] / SPINNING.inner_speed == pytest.approx(ratio, abs=6e-5)
    if model is FREE:
        assert math.degrees(result.pitch_angle[0]) == pytest.approx(32.40, abs=0.02)
    assert result.ball_spin[0, 0] < 0.0 < result.pitch_angle[0]  # the ball turns against its orbit


def test_218_bearing_at_rest() -> None:
    """17 800 N without speed: angle, load, displacement and inner pressure, digits as given."""
    result = equilibrium(BEARING_218, Operation(inner_speed=0.0, axial_load=17_800.0), OUTER, 0.15)
    assert math.degrees(result.contact_angle_inner[0]) == pytest.approx(41.500, abs=6e-4)
    assert result.load_outer[5] == pytest.approx(1678.96, abs=0.006)
    assert result.axial_displacement == pytest.approx(35.99e-6, abs=6e-9)
    pressure = contact(result, BEARING_218, Race.INNER, 0).max_pressure
    assert pressure == pytest.approx(1522.4e6, abs=0.06e6)


def test_a_load_that_vanishes_presses_all_balls_alike() -> None:
    """1e-300 N at rest: the load of each ball is 0, so that the first is as loaded as any."""
    result = equilibrium(BEARING_218, Operation(inner_speed=0.0, axial_load=1e-300), OUTER, 0.15)
    assert not result.load_outer.any()
    assert result.most_loaded == 0


def test_turbopump_bearing() -> None:
    """50 000 rpm and 2670 N under outer race control, digits as given."""
    result = equilibrium(LE7, Operation(inner_speed=50_000 * RPM, axial_load=2670.0), OUTER, 0.1)
    assert math.degrees(result.contact_angle_inner[0]) == pytest.approx(26.2326, abs=6e-5)
    assert math.degrees(result.contact_angle_outer[0]) == pytest.approx(18.6054, abs=6e-5)
    assert result.axial_displacement == pytest.approx(51.93e-6, abs=6e-9)
    assert result.load_inner[0] == pytest.approx(604.05, abs=0.006)
    assert result.load_outer[0] == pytest.approx(768.82, abs=0.006)
    assert result.orbital_speed[0] == pytest.approx(2143.3, abs=0.06)
    assert set(result.race_control) == {Race.OUTER}


@pytest.mark.parametrize("model", [OUTER, INNER, FREE])
def test_at_rest_both_angles_are_equal(model: KinematicModel) -> None:
    """0 rpm: one line through both contacts, no inertia, and speed ratios in the limit of slow turning."""
    operation = Operation(inner_speed=0.0, axial_load=500.0, radial_load=1500.0)
    result = equilibrium(BEARING_218, operation, model, 0.15)
    assert result.contact_angle_inner == pytest.approx(result.contact_angle_outer, abs=1e-12)
    assert not result.centrifugal_force.any()
    assert not result.orbital_speed.any()
    assert np.isfinite(result.spin_roll_ratio_inner).all()


@pytest.mark.parametrize("speeds", [(100.0, 0.0), (0.0, 100.0), (300.0, -120.0), (-50.0, 80.0)])
@pytest.mark.parametrize("model", [OUTER, INNER])
def test_orbit_for_equal_angles(model: KinematicModel, speeds: tuple[float, float]) -> None:
    """Slow turning: w_m = (w_i (1 - g) + w_o (1 + g))/2 with g = D cos(alpha)/d_m, whichever rings turn."""
    inner, outer = (rpm * RPM for rpm in speeds)
    turning = Operation(inner_speed=inner, outer_speed=outer, axial_load=2e4)
    result = equilibrium(BEARING_218, turning, model, 0.1)
    g = 22.23 / 125.26 * math.cos(result.contact_angle_inner[0])
    expected = 0.5 * (inner * (1.0 - g) + outer * (1.0 + g))
    # the angles differ by about 1e-6 from the centrifugal force at these speeds
    assert result.orbital_speed[0] == pytest.approx(expected, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("speeds", [(10_000.0, 0.0), (3000.0, -4000.0)])
@pytest.mark.parametrize("model", [OUTER, INNER, FREE])
def test_speeds_and_inertia_follow_from_the_motion(model, speeds) -> None:
    """Rigid bodies as vectors (along x, outward, along the orbit), seen from the ball's orbit; rounding only.

    Rolling speed is the mean speed of both surfaces through the contact, spin over roll that of the ball's
    turning on the race; forces and moment are those of a ball that is carried round.
    """
    inner, outer = (rpm * RPM for rpm in speeds)
    loaded = Operation(inner_speed=inner, outer_speed=outer, axial_load=22_250.0)
    result, D, dm = equilibrium(BEARING_218, loaded, model, 0.15), 22.23e-3, 125.26e-3
    spin, orbit = result.ball_spin[0], result.orbital_speed[0]
    for side, name, ring in ((-1.0, "inner", inner), (1.0, "outer", outer)):
        angle = getattr(result, f"contact_angle_{name}")[0]
        normal = side * np.array([math.sin(angle), math.cos(angle), 0.0])
        turn = np.array([ring - orbit, 0.0, 0.0])
        surfaces = np.cross(turn, [0.0, 0.5 * dm, 0.0] + 0.5 * D * normal), np.cross(spin, 0.5 * D * normal)
        along = np.array([0.0, 0.0, 1.0])
        rolling = 0.5 * abs(sum(surfaces) @ along)
        assert getattr(result, f"rolling_speed_{name}")[0] == pytest.approx(rolling, rel=1e-9)
        pivoting = (spin - turn) @ normal / ((spin - turn) @ np.cross(normal, along))
        assert getattr(result, f"spin_roll_ratio_{name}")[0] == pytest.approx(pivoting, rel=1e-9, abs=1e-12)
    mass = STEEL_218.density * math.pi * D**3 / 6.0
    moment = np.cross([orbit, 0.0, 0.0], 0.1 * mass * D**2 * spin)
    assert result.gyroscopic_moment[0] == pytest.approx(np.linalg.norm(moment), rel=1e-9)
    assert result.centrifugal_force[0] == pytest.approx(0.5 * mass * dm * orbit**2, rel=1e-9)


@pytest.mark.parametrize("model", [OUTER, INNER])
def test_ring_carries_its_loads(model: KinematicModel) -> None:
    """Normal loads and the shared gyroscopic friction of the balls, summed here, are the loads asked for."""
    result = equilibrium(LE7, COMBINED, model, 0.1)
    T = (2.0 if model is INNER else 0.0) * result.gyroscopic_moment / LE7.ball_diameter
    s, c = np.sin(result.contact_angle_inner), np.cos(result.contact_angle_inner)
    axial, outward = result.load_inner * s + T * c, result.load_inner * c - T * s
    tilting, around = 0.5 * (LE7.pitch_diameter * axial - LE7.ball_diameter * T), np.cos(result.azimuth)
    sums = axial.sum(), (outward * around).sum(), (tilting * around).sum()
    assert sums == pytest.approx((2670.0, 800.0, 1.0), rel=BALANCED)


def test_held_tilt_returns_its_moment() -> None:
    """Rings held at the tilt that a moment makes need that moment."""
    free = equilibrium(LE7, COMBINED, OUTER, 0.1)
    held = replace(COMBINED, moment=None, tilt=free.tilt)
    result = equilibrium(LE7, held, OUTER, 0.1)
    assert result.load_inner == pytest.approx(free.load_inner, rel=1e-6)
    assert result.moment == pytest.approx(1.0, rel=1e-5)


def test_rings_are_held_parallel_unless_a_moment_frees_them() -> None:
    """Without a moment the ring keeps its angle and takes a reaction; a moment of 0 tilts it."""
    loaded = Operation(inner_speed=50_000 * RPM, axial_load=2670.0, radial_load=800.0)
    held = equilibrium(LE7, loaded, OUTER, 0.1)
    assert held.is_tilt_held
    assert held.tilt == held.cross_tilt == 0.0
    assert abs(held.moment) > 1.0
    free = equilibrium(LE7, replace(loaded, moment=0.0), OUTER, 0.1)
    assert not free.is_tilt_held
    assert abs(free.tilt) > 1e-4
    assert free.moment == 0.0
    assert free.most_loaded == 0  # of azimuth 0, where the radial load points
    parallel = equilibrium(LE7, replace(loaded, tilt=0.0), OUTER, 0.1)
    assert np.array_equal(parallel.load_inner, held.load_inner)


def test_second_road_by_a_general_solver() -> None:
    """All balls and the ring at once, force balances written anew, solved by MINPACK."""
    bearing, Z = LE7, 10
    result = equilibrium(bearing, COMBINED, OUTER, 0.1)
    psi, D, dm = result.azimuth, bearing.ball_diameter, bearing.pitch_diameter
    fi, fo, a0 = bearing.inner_conformity, bearing.outer_conformity, bearing.free_angle
    modulus = contact_modulus(bearing.ball_material, bearing.ring_material)
    mass = 7750.37 * math.pi * D**3 / 6.0

    def hertz(length: Array, f: float, race: Race, angle: Array) -> Array:
        loads = []
        for gap, alpha in zip(length - (f - 0.5) * D, angle, strict=True):
            one = contact_ellipse(1.0, *race_curvatures(bearing, race, float(alpha)), modulus)
            loads.append((max(gap, 0.0) / one.approach) ** 1.5)
        return np.array(loads)

    def unbalance(u: Array) -> Array:
        x, y, tilt = u[0] * 1e-5, u[1] * 1e-5, u[2] * 1e-3
        V1, V2 = u[3 : 3 + Z] * 1e-5, u[3 + Z :] * 1e-5
        A1 = (fi + fo - 1.0) * D * math.sin(a0) + x + 0.5 * dm * tilt * np.cos(psi)
        A2 = (fi + fo - 1.0) * D * math.cos(a0) + y * np.cos(psi)
        ai, ao = np.arctan2(A1 - V1, A2 - V2), np.arctan2(V1, V2)
        Qi = hertz(np.hypot(A1 - V1, A2 - V2), fi, Race.INNER, ai)
        Qo = hertz(np.hypot(V1, V2), fo, Race.OUTER, ao)
        g = D / dm
        beta = np.arctan2(np.sin(ao), np.cos(ao) + g)  # Harris: tan(beta) = sin/(cos + g)
        away, near = np.cos(beta - ao) / (1 + g * np.cos(ao)), np.cos(beta - ai) / (1 - g * np.cos(ai))
        wr = -COMBINED.inner_speed / ((away + near) * g)
        wm = COMBINED.inner_speed * away / (away + near)
        Mg = mass * D**2 / 10.0 * wr * wm * np.sin(beta)  # negative, as in the standard equations
        Fc = 0.5 * mass * dm * wm**2
        T = 2.0 * Mg / D
        axial = Qo * np.sin(ao) - Qi * np.sin(ai) - T * np.cos(ao)
        outward = Qo * np.cos(ao) - Qi * np.cos(ai) + T * np.sin(ao) - Fc
        ring = (
            2670.0 - np.sum(Qi * np.sin(ai)),
            800.0 - np.sum(Qi * np.cos(ai) * np.cos(psi)),
            (1.0 - 0.5 * dm * np.sum(Qi * np.sin(ai) * np.cos(psi))) * 100.0,
        )
        return np.concatenate((ring, axial, outward)) / 100.0

    span = (fi + fo - 1.0) * D * 1e5
    start = np.concatenate(
        ([4.0, 2.0, -1.5], np.full(Z, 0.27 * span * math.sin(a0)), np.full(Z, 0.27 * span * math.cos(a0)))
    )
    answer = root(unbalance, start, method="hybr", options={"maxfev": 20_000, "xtol": 1e-13})
    assert np.abs(answer.fun).max() < 1e-7  # N/100
    assert result.axial_displacement == pytest.approx(answer.x[0] * 1e-5, rel=1e-6)
    assert result.radial_displacement == pytest.approx(answer.x[1] * 1e-5, rel=1e-6)
    assert result.tilt == pytest.approx(answer.x[2] * 1e-3, rel=1e-6)


def test_balls_that_leave_the_inner_race_rest_on_the_outer() -> None:
    """Radial load with play at speed: unloaded balls press outward with their centrifugal force alone."""
    bearing = replace(BEARING_218, contact_angle=math.radians(8.0))
    operation = Operation(inner_speed=6000 * RPM, axial_load=0.0, radial_load=5000.0)
    for model in (OUTER, INNER, FREE):
        result = equilibrium(bearing, operation, model, 0.1)
        lost = ~result.inner_contact
        assert lost.any()
        assert not lost.all()
        assert not result.load_inner[lost].any()
        # the outer load turns the ball by friction, hence a part in 1e6 in the free model
        assert result.load_outer[lost] == pytest.approx(result.centrifugal_force[lost], rel=1e-5)
        assert np.abs(result.contact_angle_outer[lost]).max() < 1e-3
        for name in ("contact_angle_inner", "orbital_speed", "spin_roll_ratio_inner", "pitch_angle"):
            assert np.isfinite(getattr(result, name)).all()


@pytest.mark.parametrize("model", [OUTER, INNER, FREE])
def test_balls_that_float_at_rest_touch_neither_race(model: KinematicModel) -> None:
    """Radial load without speed: balls of the far side carry nothing, and no rounding decides a contact."""
    result = equilibrium(LE7, Operation(inner_speed=0.0, axial_load=0.0, radial_load=1000.0), model, 0.1)
    floats = np.abs(result.load_inner) < 1e-9 * result.load_inner.max()
    assert floats.any()
    assert not (result.inner_contact | result.outer_contact)[floats].any()
    assert (result.inner_contact & result.outer_contact)[~floats].all()
    assert np.isfinite(result.spin_roll_ratio_inner).all()


# Friction of whole slip fields: full sliding, power, symmetry, and the smoothing of Coulomb's corner.


def resultants(c: tuple[float, ...], a: float, b: float, smoothing: float, cells: int = 48) -> Array:
    """Per unit load and friction, on a ball of 1 cm radius."""
    out = np.empty((5, 7))
    friction_resultants(np.array(c), a, b, 1e-2, 1.02e-2, smoothing, chebyshev_nodes(cells // 2), out)
    return out


@pytest.mark.parametrize("ratio", [1.0, 0.5, 0.12])
def test_spin_moment_in_full_sliding(ratio: float):
    """Pure spin: (3/8) a E(1 - b^2/a^2) per unit of friction and load."""
    a = 1e-3
    moment = resultants((1.0, 0.0, 0.0, 0.0), a, ratio * a, 1e-12)[0, 0]
    # 48 strips: the error falls as their width squared, 1/48^2
    assert moment == pytest.approx(0.375 * a * ellipe(1.0 - ratio**2), rel=1e-3)


def test_resultants_converge_with_the_strips():
    """Rolling with Heathcote slip and a line of no slip anywhere: 48 strips are within 3e-3 of 960."""
    for offset in np.linspace(0.0, 3e-6, 7):
        c = (0.02, 1.0, -1e-2 + offset, 0.0)
        coarse, fine = resultants(c, 1e-3, 2e-4, 1e-8), resultants(c, 1e-3, 2e-4, 1e-8, 960)
        # where two such lines meet at y = 0 a few strips of 48 have slip that is not linear in y
        assert coarse[2, 0] == pytest.approx(fine[2, 0], abs=3e-3)
        assert coarse[0, 0] == pytest.approx(fine[0, 0], abs=3e-3 * 1e-3)


def test_slopes_are_those_of_the_resultants():
    """Central differences of every coefficient, with rolling, spin, lateral slip and curvature at once."""
    c = np.array((0.3, 0.02, -2.1e-4, 1.5e-3))
    out = resultants(tuple(c), 1.1e-3, 2e-4, 2e-5)
    for k, step in enumerate((1e-6, 1e-8, 1e-10, 1e-8)):
        more, less = c.copy(), c.copy()
        more[k] += step
        less[k] -= step
        change = resultants(tuple(more), 1.1e-3, 2e-4, 2e-5) - resultants(tuple(less), 1.1e-3, 2e-4, 2e-5)
        # differences of 1e-16/1e-6 and a second-order step error
        assert out[:, 1 + k] == pytest.approx(change[:, 0] / (2 * step), rel=2e-4, abs=1e-9)


def free(inner: float, outer: float = 0.0, friction: float = 0.15, **loads: float) -> Equilibrium:
    """The 218 bearing without race control."""
    loads = {"axial_load": 22_250.0} | loads
    operation = Operation(inner_speed=inner * RPM, outer_speed=outer * RPM, **loads)
    return equilibrium(BEARING_218, operation, FREE, friction)


@pytest.mark.parametrize("speeds", [(10_000.0, 0.0), (0.0, 6000.0), (8000.0, -3000.0)])
def test_reversed_rotation_mirrors_the_state(speeds):
    """Both speeds reversed: same loads and angles, speeds reversed, yaw the other way."""
    one, two = free(*speeds), free(-speeds[0], -speeds[1])
    same = {"rel": 1e-7, "abs": 1e-9}  # solver tolerance
    assert two.contact_angle_inner == pytest.approx(one.contact_angle_inner, **same)
    assert two.load_outer == pytest.approx(one.load_outer, **same)
    assert two.orbital_speed == pytest.approx(-one.orbital_speed, **same)
    assert two.spin_roll_ratio_inner == pytest.approx(one.spin_roll_ratio_inner, **same)
    assert two.ball_spin[:, :2] == pytest.approx(-one.ball_spin[:, :2], rel=1e-6, abs=1e-4)
    assert two.ball_spin[:, 2] == pytest.approx(one.ball_spin[:, 2], rel=1e-4, abs=1e-3)


def test_balls_alike_are_solved_alike():
    """One ball for all, and every ball on its own under a hair of radial load, agree."""
    one, many = free(10_000.0), free(10_000.0, radial_load=1e-3)
    assert many.load_inner == pytest.approx(one.load_inner, rel=1e-5)  # 1e-3 N over 16 balls of 1850 N
    assert many.spin_roll_ratio_inner == pytest.approx(one.spin_roll_ratio_inner, rel=1e-5)


@pytest.mark.parametrize("speeds", [(10_000.0, 0.0), (0.0, 6000.0), (-7000.0, 3000.0)])
def test_power_of_the_rings_is_lost_in_sliding(speeds):
    """What both rings put into a ball equals friction times slip: steady inertia does no work."""
    result = free(*speeds)
    operation = Operation(inner_speed=speeds[0] * RPM, outer_speed=speeds[1] * RPM, axial_load=22_250.0)
    p = problem(BEARING_218, operation, 0.0, 0.15)
    orbit = (result.orbital_speed[0] - p.outer_speed) / p.speed
    given, lost = 0.0, result.heat_inner[0] + result.heat_outer[0]
    rings = ((-1.0, operation.inner_speed, Race.INNER), (1.0, operation.outer_speed, Race.OUTER))
    for side, ring, race in rings:
        angle = (result.contact_angle_inner if side < 0 else result.contact_angle_outer)[0]
        load = (result.load_inner if side < 0 else result.load_outer)[0]
        length = 0.023167 * 22.23e-3 + contact(result, BEARING_218, race, 0).approach
        at = touch(p, side, length * math.sin(angle), length * math.cos(angle))
        state = np.array((0.0, 0.0, orbit, *(result.ball_spin[0] / p.speed)))
        smoothing, acts = 1e-4 * 0.25 * p.pitch_diameter, np.empty((6, 7))
        contact_actions(p, side, at, load, 0.0, state, smoothing, NODES, acts)
        force = acts[:, 0]
        given += ring * (0.5 * p.pitch_diameter * force[2] + force[3])
    assert lost > 0.0
    assert given == pytest.approx(lost, rel=1e-6)  # the balls balance to 1e-9 of their friction
    heat = np.sum(result.heat_inner + result.heat_outer)
    assert result.friction_torque * abs(p.speed) == pytest.approx(heat, rel=1e-12)  # rounding


@pytest.mark.parametrize(
    ("name", "inner", "outer", "torque"),
    [
        ("cryo", 17.2370, 7.1120, 0.20151),
        ("le7", 52.0184, 28.7249, 0.15421),
        ("wheel 2000", 0.00147, 0.00217, 1.91e-4),
        ("wheel 6000", 0.01031, 0.00257, 2.25e-4),
    ],
)
def test_heat_and_torque_of_an_independent_program(name, inner, outer, torque):
    """Of rigid bodies on their whole slip fields (balls integrated in space to their steady state)."""
    given = study_of(name)
    result = equilibrium(given.bearing, given.operation, FREE, given.film.race_friction)
    # 24 nodes for the whole ellipse leave 1e-4, another rounding of Coulomb's corner 3e-4; near free rolling,
    # in the wheel, that counts most (a tenth of the rounding moves its damping by 9 %); and their digits
    near, digits = (1.5e-2, 5e-3) if name.startswith("wheel") else (5e-4, 2e-4)
    assert result.heat_inner[0] == pytest.approx(inner, rel=near)
    assert result.heat_outer[0] == pytest.approx(outer, rel=near)
    # three digits of the wheel, and the same reasons; five of the others
    assert result.friction_torque == pytest.approx(torque, rel=digits)


def test_friction_cannot_hold_what_it_has_not():
    """The less friction, the less pitch: the gyroscopic moment J w_m w_R sin(beta) stays below 2 mu Q D/2."""
    pitches = []
    for friction in (0.2, 0.02, 0.005):
        result = free(10_000.0, friction=friction)
        limit = 0.5 * friction * 22.23e-3 * (result.load_inner + result.load_outer)
        assert (result.gyroscopic_moment <= limit).all()
        pitches.append(result.pitch_angle[0])
    assert pitches[0] > pitches[1] > pitches[2] > 0.0


def test_much_friction_spins_least_at_the_better_held_race():
    """Jones's criterion names the race where the free ball spins less."""
    result = free(10_000.0, friction=0.3)
    assert result.race_control[0].value == "outer"
    assert abs(result.spin_roll_ratio_outer[0]) < abs(result.spin_roll_ratio_inner[0])


# What the equilibrium refuses, and what it says when it cannot balance.

STEEL = replace(STEEL_218, elastic_modulus=206e9)
BEARING = replace(TURBOPUMP, outer_conformity=0.52, ball_material=STEEL, ring_material=STEEL)
OPERATION = Operation(inner_speed=1500.0, axial_load=3000.0)


TIGHT = {"inner_conformity": 0.508, "outer_conformity": 0.567, "contact_angle": math.radians(45.0)}
LIGHT = replace(BEARING, ball_material=replace(STEEL, density=None))
REFUSED = [
    *((BEARING, OPERATION, FREE, friction, "must be > 0 without race control.*use race control")
      for friction in (0.0, -0.1, math.nan, math.inf)),
    (LIGHT, OPERATION, OUTER, 0.1, r"ball_material needs a density \[kg/m3\]"),
    # a grain of axial load at 4e6 DN and a tight inner groove: the ball climbs its groove to the edge
    *((replace(BEARING, **TIGHT), Operation(inner_speed=6000.0, axial_load=100.0), model, 0.1,
       "out of their grooves: a contact angle .*raise the axial load") for model in KinematicModel),
    # grooves that hug the balls make long ellipses: over 90 deg from the bottom there is no groove
    (replace(BEARING, inner_conformity=0.5005, outer_conformity=0.5005),
     Operation(inner_speed=10.0, axial_load=1e5), FREE, 0.1, "press balls over the edges of their grooves"),
]  # fmt: skip


@pytest.mark.parametrize(("bearing", "operation", "model", "friction", "words"), REFUSED)
def test_what_has_no_equilibrium_is_refused_with_the_cure(bearing, operation, model, friction, words) -> None:
    """Nothing that turns a ball, no mass of one that turns, balls beside or over the edges of grooves."""
    with pytest.raises(InputError, match=words):
        equilibrium(bearing, operation, model, friction)
    still = Operation(inner_speed=0.0, axial_load=3000.0)
    assert equilibrium(LIGHT, still, OUTER, 0.1).load_inner[0] > 0.0


def test_balls_that_touch_nothing_have_nominal_angles() -> None:
    """A ball on the far side of a radial load does not touch the missing upper half of the inner groove."""
    sizes = {"ball_diameter": 1.0906e-3, "pitch_diameter": 61.72e-3, "ball_count": 160}
    grooves = {"contact_angle": math.radians(79.0), "inner_conformity": 0.6, "outer_conformity": 0.51}
    bearing = replace(BEARING, **sizes, **grooves)
    operation = Operation(inner_speed=0.0, outer_speed=10472.0, axial_load=0.0, radial_load=500.0)
    result = equilibrium(bearing, operation, OUTER, 2.0)
    # The groove was a full circle: such a ball reported an inner angle of 180 deg.
    assert not result.inner_contact.all()
    assert result.outer_contact.all()
    assert abs(result.contact_angle_inner).max() < 0.5 * math.pi


@pytest.mark.parametrize("model", [FREE, INNER])
def test_a_load_that_cannot_be_carried_is_one_sentence(model: KinematicModel) -> None:
    """A ring that weighs next to nothing and may tilt: said in one line, with a cure and how far it came."""
    afloat = Operation(inner_speed=1500.0, axial_load=1e-6, radial_load=5e-6, moment=0.0)
    with pytest.raises(ConvergenceError, match=r"^[^\n]*axial load[^\n]*$") as caught:
        equilibrium(BEARING, afloat, model, 0.1)
    assert min(caught.value.iterations, caught.value.residual) > 0


@pytest.mark.parametrize("radial", [0.0, 1e-6, 1000.0])
def test_a_load_of_a_micronewton_is_carried(radial: float) -> None:
    """The normal loads and the friction carry it; none drowns in the tolerance of a larger load."""
    operation = Operation(inner_speed=1500.0, axial_load=1e-6, radial_load=radial)
    result = equilibrium(BEARING, operation, OUTER, 0.1)
    carried = float((result.load_inner * np.sin(result.contact_angle_inner)).sum())
    assert carried == pytest.approx(1e-6, rel=1e-3)  # what `LEAST` accepts
