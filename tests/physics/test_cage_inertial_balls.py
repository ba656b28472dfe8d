"""Balls with inertia and saturating traction: impacts in closed form, and whole runs by another program.

The other program (`inertial_balls`) is scipy's DOP853 on the equations as written, at a tolerance of 1e-12.
"""

import math
from dataclasses import fields, replace

import inertial_balls
import numpy as np
import pytest
from cages import AT_REST, EVERYTHING, RAMP, TURNING, WAVES, followed, linear_roots
from scipy.integrate import quad, solve_ivp

from separatrix.ball_traction import BallTraction
from separatrix.cage import (
    Ensemble,
    RunOutcome,
    ensemble,
    linear_critical_friction,
    run_ensemble,
    simulate,
)
from separatrix.cage.closed_forms import whirl_rate
from separatrix.cage.planar import turned_forward
from separatrix.study import Guidance, PocketShape, StabilitySettings

CRYO = BallTraction(mass=6.567e-3, slopes=(188.0,), speeds=(73.0 / 188.0,))
"""A turbopump's ball: 73 N at most."""

WHEEL = BallTraction(mass=1.289e-3, slopes=(74.3,), speeds=(1.3 / 74.3,))
"""A momentum wheel's: 1.3 N at most."""

THREE = BallTraction(mass=6.567e-3, slopes=(120.0, 50.0, 20.0), speeds=(0.1, 0.8, math.inf))
LEAD = np.linspace(-9e-5, 9e-5, 13)


def dampers(slope: float, mass: float) -> BallTraction:
    """Law of a ball of this mass on a damper."""
    return BallTraction(mass=mass, slopes=(slope,), speeds=(math.inf,))


def one_ball(traction: BallTraction, **change: object):
    """A cage of 50 g with one ball, which turns only if its inertia is given, without friction."""
    alone = {"ball_count": 1, "ball_cage_friction": 0.0, "moment_of_inertia": 1e9, "race_damping": math.inf}
    return replace(AT_REST, traction=traction, **(alone | change))


def test_an_impact_on_a_free_ball_keeps_momentum_and_energy():
    """Next to no traction: cage and ball part as two masses that strike elastically."""
    m = 6.567e-3
    cage = one_ball(dampers(1e-9, m))
    M = cage.mass
    run = followed(cage, 1.5e-3, direction=math.pi / 2, samples=200)
    # the traction takes 1e-9/m of a radian of the impact; the inertia of 1e9 kg m2 leaves 1e-13 of turning
    assert run.velocity[-1, 1] == pytest.approx(0.5 * (M - m) / (M + m), rel=1e-9)
    assert run.ball_speed[-1, 0] == pytest.approx(0.5 * 2 * M / (M + m), rel=1e-9)
    energy = run.kinetic_energy + run.spring_energy + run.ball_energy
    np.testing.assert_allclose(energy, 0.5 * M * 0.5**2, rtol=1e-9)
    momentum = M * run.velocity[:, 1] + m * run.ball_speed[:, 0]
    np.testing.assert_allclose(momentum, M * 0.5, rtol=1e-9)


def test_a_hertz_impact_has_the_force_and_the_time_of_the_closed_form():
    """5.496616 g at 0.5 m/s on K 5e8: 66.15387 N for 152.8449 us (numbers of dynamics3d.md, E7).

    Cage and ball have twice the mass each, which makes that mass of the pair, and trade their speeds.
    """
    twice = 2 * 5.496616e-3
    cage = one_ball(dampers(1e-9, twice), mass=twice, hertz_coefficient=5e8)
    run = followed(cage, 1e-3, direction=math.pi / 2, samples=100_001)
    force = -run.contact_force[:, 0] if run.contact_force.min() < 0.0 else run.contact_force[:, 0]
    assert force.max() == pytest.approx(66.15387, rel=1e-6)  # the digits; rows are 1e-4 of an impact apart
    contact = np.count_nonzero(force > 0.0) * run.time[1]
    assert contact == pytest.approx(152.8449e-6, rel=1e-3)  # it starts at 1e-5 of its depth
    assert run.ball_speed[-1, 0] == pytest.approx(0.5, rel=1e-9)


def test_a_light_ball_on_dampers_goes_to_the_ball_without_mass():
    """The difference from the damper's motion halves with the mass, within 10 %."""
    plain = replace(TURNING, pocket_clearance=4e-4)
    how = {"kick": 2.0, "direction": 0.4, "lead": LEAD, "samples": 40}
    aim = followed(plain, 4e-4, **how)
    errors = []
    for mass in (1.6e-5, 8e-6, 4e-6):
        run = followed(replace(plain, traction=dampers(plain.race_damping, mass)), 4e-4, **how)
        errors.append(np.abs(run.velocity - aim.velocity).max())
    assert errors[0] < 0.05
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.1)


def struck(law: BallTraction, mass: float, stiffness: float, speed: float) -> tuple[float, float, float]:
    """Speed of a mass after an impact on a ball of this law, the ball's then, and the time of contact."""

    def rates(_, z):
        force = stiffness * z[0]
        return [z[1] - z[2], -force / mass, (force - law.force(z[2])) / law.mass]

    def parted(t, z):
        return z[0] if t > 1e-6 else 1.0

    parted.terminal = True
    how = {"rtol": 1e-13, "atol": 1e-18, "events": parted, "method": "DOP853"}
    course = solve_ivp(rates, (0.0, 0.1), [0.0, speed, 0.0], **how)
    return course.y[1, -1], course.y[2, -1], course.t[-1]


@pytest.mark.parametrize("kick", [0.02, 0.1, 0.5, 2.0])
@pytest.mark.parametrize(("law", "mass", "stiffness"), [(CRYO, 0.025, 3e6), (WHEEL, 0.005, 1e6)])
def test_a_ring_that_may_turn_rebounds_by_the_law(law, mass, stiffness, kick):
    """One ball: the pocket's speed is that of half the ring's mass; scipy on the three equations."""
    R = AT_REST.pitch_radius
    ring = {"mass": mass, "moment_of_inertia": mass * R * R, "ball_cage_stiffness": stiffness}
    cage = one_ball(law, **ring)
    left, ball, contact = struck(law, mass / 2, stiffness, kick)
    run = followed(cage, 3e-4 / kick + contact + 1e-5, kick=kick, direction=math.pi / 2, samples=2)
    after = run.velocity[-1, 1] + R * run.rotation_rate[-1]
    assert after / kick == pytest.approx(left / kick, abs=1e-8)
    # 1e-5 s later the ball is slower by its traction alone
    how = {"rtol": 1e-12, "atol": 1e-15}
    later = solve_ivp(lambda _, u: -law.force(u[0]) / law.mass, (0, 1e-5), [ball], **how).y[0, -1]
    assert run.ball_speed[-1, 0] / kick == pytest.approx(later / kick, abs=1e-8)


def test_at_light_traction_the_cage_goes_on_with_the_ball_it_knocked():
    """1.3 N hold the ball of a wheel: its pocket rebounds from slow impacts, follows after fast."""
    R, rebounds = AT_REST.pitch_radius, []
    wheel = one_ball(WHEEL, mass=0.005, moment_of_inertia=0.005 * R * R, ball_cage_stiffness=1e6)
    for kick in (0.02, 0.1, 0.5, 2.0):
        run = followed(wheel, 4e-4 / kick + 1e-3, kick=kick, direction=math.pi / 2, samples=2001)
        parted = np.argmax((run.contact_force[:, 0] == 0.0) & (run.ball_speed[:, 0] > 0.0))
        rebounds.append(-(run.velocity[parted, 1] + R * run.rotation_rate[parted]) / kick)
        # whatever it does, the ball is ahead of its pocket then
        assert run.ball_speed[parted, 0] > -rebounds[-1] * kick
    assert rebounds[0] > 0.2
    assert rebounds[-1] < -0.3
    assert np.all(np.diff(rebounds) < 0.0)


def test_a_knocked_ball_comes_to_rest_where_its_traction_leaves_it():
    """The whole way of a coasting ball: m_e times the integral of u/F(u), to where it is put at rest."""
    cage = one_ball(WHEEL, mass=0.5 * WHEEL.mass, pocket_clearance=0.2)  # light: it rebounds
    struck_at = np.array([-0.1])  # at once, at the pocket's front
    run = followed(cage, 0.05, kick=1.0, direction=-math.pi / 2, lead=-struck_at, samples=50_001)
    free = int(np.argmax((run.contact_force[:, 0] == 0.0) & (run.ball_speed[:, 0] != 0.0)))
    u = run.ball_speed[free, 0]
    way = math.copysign(quad(lambda v: WHEEL.mass * v / WHEEL.force(v), 0.0, abs(u), epsabs=0.0)[0], u)
    assert run.ball_speed[-1, 0] == 0.0
    assert run.ball_lead[-1, 0] - run.ball_lead[free, 0] == pytest.approx(way, rel=1e-9)


PLAIN = replace(TURNING, cage_speed=669.0, inner_speed=1570.8, pocket_clearance=4e-4, traction=CRYO)
LAND = replace(PLAIN, guidance=Guidance.OUTER, land_clearance=3e-4, land_restitution=0.5)
CASES = {
    "one element": PLAIN,
    "a wheel's balls": replace(PLAIN, traction=WHEEL),
    "three elements": replace(PLAIN, traction=THREE),
    "land": LAND,
    "inner land, twice": replace(LAND, guidance=Guidance.INNER, land_count=2),
    "Hertz": replace(PLAIN, hertz_coefficient=3e8),
    "no play": replace(PLAIN, pocket_clearance=0.0),
    "ramp": replace(PLAIN, **RAMP),
    "orbital speeds": replace(PLAIN, **WAVES),
    "ramp and orbital speeds on a land": replace(LAND, **RAMP, **WAVES),
    "ramp, orbital speeds and Hertz": replace(PLAIN, hertz_coefficient=3e8, **RAMP, **WAVES),
    "no play, ramp, orbital speeds, gravity, unbalance": replace(
        PLAIN, pocket_clearance=0.0, gravity=50.0, unbalance=2e-6, **RAMP, **WAVES
    ),
    "gravity and unbalance on a land": replace(LAND, gravity=50.0, unbalance=2e-6),
    "outer race turns": replace(PLAIN, inner_speed=0.0, outer_speed=1100.0),
    "bores": replace(PLAIN, pocket_shape=PocketShape.CYLINDRICAL, pocket_axial_offset=1.2e-4),
}


def differences(cage, duration: float, kick: float) -> tuple[float, float]:
    """Largest differences of places [m] and speeds [m/s] between the engine and the other program."""
    lead, R = LEAD * (cage.pocket_clearance > 0.0), cage.pitch_radius
    ours = followed(cage, duration, kick=kick, direction=0.4, lead=lead, samples=101)
    other = inertial_balls.integrate(cage, kick=kick, direction=0.4, ball_lead=lead, times=ours.time)
    places = (ours.position - other.position, R * (ours.rotation - other.rotation))
    places += (ours.ball_lead - other.ball_lead,)
    speeds = (ours.velocity - other.velocity, R * (ours.rotation_rate - other.rate))
    speeds += (ours.ball_speed - other.ball_speed,)
    assert np.abs(ours.ball_speed).max() > 0.01 * kick  # balls do move
    return max(np.abs(d).max() for d in places), max(np.abs(d).max() for d in speeds)


@pytest.mark.parametrize("case", CASES)
def test_the_engine_moves_as_the_other_program(case):
    """A dozen hard impacts in 1 ms, with every feature: to 1e-7 of the kick, and as much of the clearance."""
    places, speeds = differences(CASES[case], 1e-3, kick=2.0)
    assert places < 5e-7 * 2e-4
    assert speeds < 1e-7 * 2.0


@pytest.mark.parametrize("case", ["one element", "land", "ramp"])
def test_the_engine_moves_as_the_other_program_for_three_turns(case):
    """28 ms from 0.5 m/s: to 1e-7 of the kick where neighbouring motions do not part."""
    places, speeds = differences(CASES[case], 0.028, kick=0.5)
    assert places < 5e-7 * 2e-4
    assert speeds < 2e-7 * 0.5


def test_without_play_it_moves_on_the_roots_of_small_motions():
    """A damper of inertia is linear: the four exponentials, for as long as it lasts."""
    law = dampers(900.0, 6.567e-3)
    cage = replace(PLAIN, pocket_clearance=0.0, traction=law, ball_cage_friction=0.1)
    run = followed(cage, 2e-3, direction=0.4, samples=200)
    roots, v, W = linear_roots(cage), 0.5 * np.exp(0.4j), cage.cage_speed
    # z and three derivatives at the kick: the balls press with q only, and q' = v; times in 1/w0
    w0 = math.sqrt(cage.ball_count * cage.ball_cage_stiffness / (2 * cage.mass))
    turn = W / w0
    begun = np.array([0.0, 1.0, -2j * turn, (-2j * turn) ** 2 + turn**2 - (1 - 0.1j)]) * v / w0
    share = np.linalg.solve(np.vander(roots / w0, increasing=True).T, begun)
    exact = np.exp(np.outer(run.time, roots)) @ share
    np.testing.assert_allclose(run.position @ [1, 1j], exact, rtol=0, atol=1e-9 * np.abs(exact).max())


def test_critical_friction_of_small_motions_is_a_root_that_neither_grows_nor_dies():
    """And that of balls without mass as these become light."""
    grip = replace(PLAIN, pocket_clearance=0.0, cage_speed=0.0, traction=dampers(900.0, 6.567e-3))
    found = linear_critical_friction(grip)
    whirl = [r for r in linear_roots(replace(grip, ball_cage_friction=found)) if abs(r.imag) > 3000.0]
    assert min(abs(r.real) for r in whirl) < 1e-8 * max(abs(r) for r in whirl)
    light = replace(grip, traction=dampers(900.0, 1e-9))
    heavy_free = replace(grip, traction=None, race_damping=900.0)
    massless = linear_critical_friction(heavy_free)
    # what mass changes is of the order k m_e/C^2, 3.7e-9 here
    assert linear_critical_friction(light) == pytest.approx(massless, rel=1e-8)


@pytest.mark.parametrize("whirl", [2.7e4, 2.9e4])
def test_a_turning_ball_set_whirls_at_the_friction_of_its_formula(whirl):
    """(omega + Omega)^2 (G - k m) = omega_0^2 G, f = k C/omega (G - k m), G = (m omega)^2 + C^2; rounding."""
    C, m, k, w0 = 900.0, 6.567e-3, PLAIN.ball_cage_stiffness, whirl_rate(PLAIN)
    G = (m * whirl) ** 2 + C * C
    turning = {
        "cage_speed": w0 * math.sqrt(G / (G - k * m)) - whirl,
        "ball_cage_friction": k * C / (whirl * (G - k * m)),
    }
    roots = linear_roots(replace(PLAIN, pocket_clearance=0.0, traction=dampers(C, m), **turning))
    assert np.abs(roots - 1j * whirl).min() < 1e-9 * whirl


def drawn(number: int):
    """A random cage among balls with inertia, of every kind of land, pocket, load and law."""
    rng = np.random.default_rng(number)
    mass, radius, speed = rng.uniform(0.01, 0.1), 0.03, rng.choice([0.0, 100.0, 700.0])
    count = int(rng.integers(1, 5))
    slopes = tuple(rng.uniform(5.0, 400.0, count).tolist())
    speeds = np.where(rng.random(count) < 0.2, np.inf, 10.0 ** rng.uniform(-2.5, 0.0, count)).tolist()
    law = BallTraction(mass=10.0 ** rng.uniform(-3.5, -1.5), slopes=slopes, speeds=tuple(speeds))
    gap, lobes, waves = rng.uniform(1e-4, 5e-4), int(rng.integers(2, 5)), rng.random() < 0.3 and speed > 0.0
    clearance = rng.choice([0.0, 1e-4, 6e-4], p=[0.15, 0.35, 0.5])
    hertz = 10.0 ** rng.uniform(8.0, 9.5) if rng.random() < 0.3 and clearance > 0.0 else None
    cage = {
        "mass": mass,
        "moment_of_inertia": mass * radius**2 * rng.uniform(0.8, 1.5),
        "pitch_radius": radius,
        "ball_count": int(rng.integers(3, 20)),
        "cage_speed": speed,
        "outer_speed": rng.choice([0.0, 1500.0]),
        "pocket_clearance": clearance,
        "ball_cage_stiffness": 10.0 ** rng.uniform(6.0, 7.0),
        "traction": law,
        "ball_cage_friction": rng.uniform(0.0, 0.4),
        "guidance": rng.choice(list(Guidance)),
        "land_clearance": 2 * gap,
        "land_friction": rng.uniform(0.0, 0.4),
        "land_restitution": rng.uniform(0.2, 1.0),
        "land_out_of_round": rng.choice([0.0, 0.5]) * gap / lobes**2,
        "land_lobes": lobes,
        "unbalance": rng.choice([0.0, 1e-6]),
        "gravity": rng.choice([0.0, 9.81]),
        "hertz_coefficient": hertz,
        "orbital_cosines": (2e-5 * speed,) if waves else (),
        "orbital_sines": (1e-5 * speed,) if waves else (),
        "ramp_time": rng.choice([0.0, 1.5e-3]),
        "ramp_start": rng.uniform(0.1, 1.0),
        "ball_diameter_scatter": rng.choice([0.0, 1e-5]) * (clearance > 0.0),
    }
    numbers = {name: value.item() if isinstance(value, np.generic) else value for name, value in cage.items()}
    return replace(TURNING, **numbers)


def test_the_ledger_closes_and_no_run_stalls():
    """100 random cages of every kind: 1e-9 of the work done, and every motion comes to its end."""
    worst = 0.0
    for number in range(100):
        how = StabilitySettings(kicks=(0.2, 2.0), runs=1, duration=0.01, seed=number)
        runs = run_ensemble(drawn(number), how)
        assert not np.any(runs.cause == 1), number
        assert np.all(np.isfinite(runs.end_energy)), number
        worst = max(worst, runs.energy_imbalance.max())
    assert worst < 1e-9


def test_threads_change_no_bit(monkeypatch):
    """Three workers, a run or a few at a time: every number of every run is the same."""
    how = StabilitySettings(kicks=(0.5, 2.0), runs=6, duration=5e-3)
    cage = replace(EVERYTHING, traction=CRYO)
    whole = run_ensemble(cage, how)
    monkeypatch.setattr(ensemble, "CHUNK_RADIANS", 500.0)
    other = run_ensemble(cage, how, jobs=3)
    for field in fields(Ensemble):
        np.testing.assert_array_equal(getattr(other, field.name), getattr(whole, field.name), field.name)


def test_a_cage_that_turns_backward_is_the_mirror_image():
    """Run as its mirror image: places, leads and speeds of the balls as the other program has them."""
    cage = replace(PLAIN, cage_speed=-669.0, inner_speed=-1570.8, **WAVES)
    run = simulate(cage, kick=2.0, duration=1e-3, until=1e-3, samples=50)
    direction = math.atan2(run.velocity[0, 1], run.velocity[0, 0])
    start = {"kick": 2.0, "direction": direction, "ball_lead": run.ball_lead[0]}
    other = inertial_balls.integrate(cage, times=run.time, **start)
    assert turned_forward(cage).cage_speed == 669.0
    np.testing.assert_allclose(run.position, other.position, atol=2e-11)
    np.testing.assert_allclose(run.ball_lead, other.ball_lead, atol=2e-11)
    np.testing.assert_allclose(run.ball_speed, other.ball_speed, atol=2e-7)


def test_a_wheel_whose_balls_are_knocked_along_settles_or_whirls():
    """Light traction in a whole ensemble: every run has an end and a ledger that closes."""
    cage = replace(TURNING, guidance=Guidance.OUTER, land_clearance=1e-3, traction=WHEEL)
    runs = run_ensemble(cage, StabilitySettings(kicks=(0.5,), runs=8, duration=0.1))
    assert runs.count(RunOutcome.UNRESOLVED)[0] == 0
    assert runs.energy_imbalance.max() < 1e-9
