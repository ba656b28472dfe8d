"""Mobility of a ball: rates, dampings and impacts against an independent program, and limits.

The numbers marked "dynamics3d" are those of our notes on bearing dynamics, sections 2.2 and 3 (E2, E11):
computed by us with separate small programs, rigid Coulomb contacts with a slip speed of 1e-4 w d_m/4. They
are printed to 4 to 6 digits; 1e-3 covers the quadrature of theirs and of ours.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from mobile_balls import NAMES, held, impact, modes_of, records, study_of
from scipy.interpolate import CubicSpline
from scipy.optimize import root

from separatrix import BallTraction, InputError, SlipLaw, solve
from separatrix.chain import contacts
from separatrix.chain.ball_mobility import (
    balanced,
    fitted_law,
    groove,
    held_ball,
    mobility,
    modes,
    pitch_angle,
    pocket_friction_effect,
    pushed,
)
from separatrix.chain.contacts import Rolling, race_tracks
from separatrix.chain.grooved_ball import slip_coefficients, touch
from separatrix.chain.race_traction import exact_slope
from separatrix.chain.slip_friction import friction_resultants
from separatrix.ground.units import Array
from separatrix.study.study import KinematicModel, TractionModel, TractionSettings, Wear, Worn

FOUR_RATES = {
    "cryo": (666.06, 31384.0, 178112.0, 347702.0), "wheel 2000": (62.755, 263886.0, 720685.0, 1742155.0),
}  # fmt: skip


@pytest.mark.parametrize("name", FOUR_RATES)
def test_four_rates(name):
    """Orbit, pivoting attitude and two rates of spin (dynamics3d 2.2); dampings rise with what is held."""
    found = modes_of(name)
    assert found.rates.real == pytest.approx(FOUR_RATES[name], rel=1e-3)
    assert found.rates.imag == pytest.approx(0.0, abs=1e-6)
    assert found.relaxed <= found.held <= found.locked
    assert found.mass > held(name).problem.ball_mass  # the spin that follows adds to it


NUMBERS = {  # of dynamics3d: what they are, how near, and those of the bearings
    "C_eff, spin free (2.2)": (
        lambda name: modes_of(name).relaxed, {"rel": 1e-4}, {"cryo": 175.83, "wheel 2000": 283.35}
    ),
    "C_locked, spin held (2.2)": (
        lambda name: modes_of(name).locked, {"rel": 1e-4}, {"cryo": 368.37, "wheel 2000": 283.45}
    ),
    "C_f, attitude held (2.2)": (
        lambda name: modes_of(name).held, {"rel": 1e-3}, {"cryo": 206.1, "wheel 6000": 74.3}
    ),
    "m_e, C_f over the second rate (2.2)": (
        lambda name: modes_of(name).mass, {"rel": 1e-3}, {"cryo": 6.567e-3, "wheel 6000": 1.289e-3}
    ),
    "k of the speed (F/C_eff)(1 + k f) of a push from the front (E2)": (
        lambda name: pocket_friction_effect(held(name)), {"abs": 1e-4},
        dict(zip(NAMES, (0.79192, 0.73517, -0.12903, 0.98216), strict=True)),
    ),
    "damping along the groove (2.2)": (lambda name: groove(held(name))[0], {"rel": 1e-3}, {"cryo": 766.2}),
    "the same, which by another quadrature is wider": (
        lambda name: groove(held(name))[0], {"rel": 4e-3},
        {"le7": 395.0, "wheel 2000": 728.8, "wheel 6000": 312.8},
    ),
    "stiffness along the groove, with the friction that turns with the angle (2.2)": (
        lambda name: groove(held(name))[1], {"rel": 4e-3}, {"cryo": 5.047e6}
    ),
    "race friction times both loads (F2)": (
        lambda name: held(name).capacity, {"rel": 1e-3}, {"cryo": 95.70, "le7": 135.5, "wheel 2000": 1.331}
    ),
    "pitch of the spin axis, to two digits (1.5, E9)": (
        lambda name: math.degrees(pitch_angle(held(name))), {"abs": 6e-3},
        {"cryo": 25.44303, "le7": 18.59, "wheel 6000": 14.00},
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", NUMBERS)
def test_numbers_of_dynamics3d(what):
    """Each of another program."""
    found, near, expected = NUMBERS[what]
    assert {name: found(name) for name in expected} == pytest.approx(expected, **near)


def test_modes_are_those_of_the_motion():
    """Y(i omega) by its modes, and by solving (i omega M - S) x = e_1; 1/Re Y of dynamics3d E11."""
    found = modes_of("cryo")
    for frequency, damping in ((300.0, 202.92), (1000.0, 213.61), (2891.0, 271.59)):
        s = 2j * math.pi * frequency
        x = np.linalg.solve(s * found.masses - found.slopes, np.eye(4)[0])
        response = np.sum(found.shares * found.rates / (s + found.rates))
        assert response == pytest.approx(x[0], rel=1e-9)
        assert 1.0 / response.real == pytest.approx(damping, rel=1e-4)


def test_a_ball_with_creep_in_two_contacts():
    """Contact angle 0: rates [3.5 S -+ sqrt(2.25 S^2 + 10 D^2)]/2m, u/F = (1/C_i + 1/C_o)/4 (E2)."""
    inner, outer, mass, radius = 65.58149, 290.99772, 5.496616e-3, 5.55625e-3
    S, D = inner + outer, inner - outer
    slopes = -np.array(((S, radius * D), (radius * D, radius**2 * S)))
    found = modes(slopes, np.diag((mass, 0.4 * mass * radius**2)))
    assert found.rates.real == pytest.approx((32460.24, 194593.50), rel=1e-6)  # the digits of the notes
    # a sum of two shares: rounding
    assert 1.0 / found.relaxed == pytest.approx(0.25 * (1.0 / inner + 1.0 / outer), rel=1e-12)


def relaxed_push(name: str, speeds: Array) -> Array:
    """F(u) with the contact plane where it was and all spin relaxed, rising speeds; Newton on the spin."""
    ball, forces = held(name), []
    state, spin = ball.state.copy(), ball.state[3:] / ball.state[3]

    def couples(spin: Array, row: slice = slice(3, 6)) -> Array:
        return np.asarray(balanced(ball, np.append(state[:3], spin * ball.state[3]))[0][row])

    for speed in speeds:
        state[2] = ball.state[2] + speed / ball.units[0]
        spin = root(couples, spin, tol=1e-12).x
        assert np.abs(couples(spin)).max() < 1e-6
        forces.append(-couples(spin, slice(2, 3))[0])
    return np.array(forces)


def test_push_with_the_contact_angles_held():
    """F(u) of dynamics3d E11, printed to 0.01 N; at .137 m/s it has 23.10 N, and this 23.04."""
    printed = (0.02, 0.0636, 0.297, 0.642, 1.39, 3.0)
    speeds = np.unique(np.append(np.linspace(0.1, 2.9, 57), printed))
    forces = relaxed_push("cryo", speeds)[np.isin(speeds, printed)]
    assert forces == pytest.approx([3.73, 11.48, 41.61, 62.19, 71.86, 72.88], abs=0.011)


RING = {"cryo": (12.5e-3, 3e6), "wheel 6000": (2.5e-3, 1e6)}
"""Mass that an impact feels, M/2 of a ring free to turn, and stiffness of the pocket."""


def by_fields(name: str, speed: float, sense: float = 1.0) -> tuple[float, float, float]:
    """The same by the whole slip fields, the place of the ball between its grooves following at once."""
    ball = held(name)
    inverse, state = np.linalg.inv(ball.masses), ball.state.copy()

    def moved(x: Array, force: float) -> Array:
        state[2:] = ball.state[2:] + sense * x / ball.units
        for _ in range(2):  # what the second step leaves is of fourth order
            balance, slopes = balanced(ball, state)
            step = np.linalg.solve(slopes[:2, :2], balance[:2])
            state[:2] -= step
        return inverse @ (sense * (balance[2:] - slopes[2:, :2] @ step) + np.eye(4)[0] * force)

    return impact(moved, 4, RING[name], speed, rtol=1e-5, atol=1e-12)


def test_push_begins_with_the_linear_law():
    """F/u is C_f with the attitude held, and C_eff with all spin relaxed, as u falls."""
    ball, found = held("cryo"), modes_of("cryo")
    small = np.array((1e-5,))
    assert pushed(ball, found, small)[0] / 1e-5 == pytest.approx(found.held, rel=1e-5)
    relaxed = pushed(ball, found._replace(right=None, left=None), small)[0] / 1e-5
    assert relaxed == pytest.approx(found.relaxed, rel=5e-5)


def moved(name, *, model=None, film=None, **operation):
    """Mobility of a bearing with another operation, kinematic model or film."""
    bearing, usual, own_model, own_film, traction, _ = records(name)
    asked = Rolling(bearing, replace(usual, **operation), model or own_model, film or own_film, traction)
    return mobility(asked)


@pytest.mark.parametrize("name", NAMES)
def test_push_saturates_below_the_capacity_and_the_law_of_traction_with_it(name):
    """At six times the speed of capacity over C_f all slips, and spin takes some of the friction."""
    found = moved(name)
    # The law has the exact slope at rest, and is 2 % of the capacity from the slip fields at most.
    for force in (found.force_forward, found.force_backward):
        assert 0.85 < force[-1] / found.capacity < 1.0
    assert found.force_forward[0] / found.speed[0] == pytest.approx(found.linear.damping, rel=0.02)
    assert found.traction.slope == pytest.approx(found.linear.damping, rel=1e-12)
    assert found.traction.mass == found.linear.effective_mass
    assert found.law_error < 0.02
    off = np.abs(found.force_law - 0.5 * (found.force_forward + found.force_backward)).max()
    assert found.law_error == pytest.approx(off / found.capacity)


def test_law_finds_its_own_speed():
    """A curve that is such a law is met to the tolerance of the search."""
    made = BallTraction(mass=1e-3, slope=200.0, speed=0.4)
    u = np.geomspace(1e-3, 5.0, 40)
    law = fitted_law(u, made.force(u), slope=made.slope, mass=1e-3)
    assert law.slope == made.slope
    assert law.force(u) == pytest.approx(made.force(u), rel=1e-7)


@pytest.mark.parametrize(("name", "factor"), [("cryo", 0.17275), ("wheel 6000", 0.3204)])
def test_return_of_a_gentle_impact(name, factor):
    """By four linear modes (dynamics3d E11), and the slip fields of a weak impact from either side."""
    found, ring = modes_of(name), RING[name]
    S, per_force = (np.linalg.solve(found.masses, one) for one in (found.slopes, np.eye(4)[0]))
    assert impact(lambda x, N: S @ x + per_force * N, 4, ring, 0.01)[0] == pytest.approx(factor, abs=6e-5)
    knee = held(name).capacity / found.held
    for sense in (1.0, -1.0):
        assert by_fields(name, 1e-3 * knee, sense)[0] == pytest.approx(factor, abs=1e-3)


RELAXED = [
    ("cryo", 6.567e-3, (0.1479, 0.1319, 0.0396, -0.1589)),
    ("wheel 6000", 1.289e-3, (0.2323, -0.1224, -0.2730, -0.3063)),
]


@pytest.mark.parametrize(("name", "mass", "returns"), RELAXED)
def test_return_with_the_quasi_steady_push(name, mass, returns):
    """E11: m_e u' = N - F(u) from .02 to 2 m/s; its slow impacts differ, as docs/validation.md says."""
    u = np.append(0.0, np.geomspace(1e-4, 2.0, 120))
    law, ring = CubicSpline(u, relaxed_push(name, u)), RING[name]
    for speed, factor, off in zip((0.02, 0.1, 0.5, 2.0), returns, (0.02, 3e-3, 3e-4, 3e-4), strict=True):
        found = impact(lambda x, N: (N - law(x)) / mass, 1, ring, speed)[0]
        assert found == pytest.approx(factor, abs=off)


def test_peak_and_duration_of_an_impact():
    """Cryo at .5 m/s: 65.90 N by the linear modes (dynamics3d E11); 184.2 us in a weak impact."""
    assert by_fields("cryo", 0.5)[1] == pytest.approx(65.9, rel=2e-3)
    assert by_fields("cryo", 1e-3)[2] == pytest.approx(184.2e-6, rel=2e-3)


@pytest.mark.parametrize("name", ["cryo", "wheel 6000"])
def test_one_state_reproduces_an_impact(name):
    """m_e u' = N - F(u): within 0.02 below the capacity; up to four times it within 0.08 (why: the page)."""
    found, (mass, k) = mobility(records(name), SlipLaw.RIGID), RING[name]
    at, law = found.capacity / math.sqrt(k * mass), found.traction
    for over, error in ((0.1, 0.02), (0.5, 0.02), (1.0, 0.04), (4.0, 0.08)):
        both = np.mean([by_fields(name, over * at, sense)[0] for sense in (1.0, -1.0)])
        one = impact(lambda x, N: (N - law.force(x)) / law.mass, 1, (mass, k), over * at)[0]
        assert one == pytest.approx(both, abs=error)


# The slip law, and which ball.


def test_elastic_creep_meets_the_spin_moment_of_the_exact_contact():
    """At the same spin the outer pivoting moment is met within 1 % by elastic creep; rigid, it is 4 % off."""
    asked = study_of("cryo")
    tracks = race_tracks(asked.bearing, asked.film, records("cryo").state)
    outer = exact_slope(tracks[1], TractionSettings(model=TractionModel.EXACT))
    exact = abs(outer.solution.spin_moment)
    rigid, elastic = (_outer_moment(law) for law in (SlipLaw.RIGID, SlipLaw.ELASTIC))
    assert elastic == pytest.approx(exact, rel=0.01)
    assert rigid == pytest.approx(exact, rel=0.06)
    assert rigid > 1.03 * exact


def _outer_moment(law: SlipLaw) -> float:
    """Pivoting moment of the outer contact at the spin of the rigid equilibrium, without a traction force."""
    ball, rigid = held("cryo", law), held("cryo")
    p, out, c = ball.problem, np.empty((5, 7)), np.empty(4)
    at = touch(p, 1.0, rigid.state[0], rigid.state[1])
    slip_coefficients(p, 1.0, at, rigid.state, c, np.empty(2))
    c[3] = 0.0
    a = at.major_coefficient * at.load ** (1.0 / 3.0)
    radius = 2.0 * 0.52 * p.ball_diameter / (2.0 * 0.52 + 1.0)
    sizes = a, a * at.axis_ratio, 0.5 * p.ball_diameter, radius
    for _ in range(30):
        friction_resultants(c, *sizes, ball.slips[1], rigid.nodes, out)
        c[2] -= out[2, 0] / out[2, 3]
    return abs(p.friction * at.load * out[0, 0])


def test_slip_speeds_are_those_of_the_elastic_creep():
    """v_e = f V/alpha_0: a contact that only creeps would carry all its friction there."""
    found = mobility(records("cryo")).linear
    assert found.slip_speed_inner == pytest.approx(0.1 * 25.0098 / 66.340, rel=1e-3)
    assert found.slip_speed_outer == pytest.approx(0.1 * 25.1133 / 75.584, rel=1e-3)
    rigid = 1e-4 * 0.25 * 0.065 * 1500.0 * math.pi / 3.0
    found = mobility(records("cryo"), SlipLaw.RIGID).linear
    assert found.slip_speed_outer == pytest.approx(rigid)  # rounding


def test_a_bearing_that_turns_the_other_way_is_the_same():
    """Mirrored: the same rates and the same law."""
    one, two = moved("cryo"), moved("cryo", inner_speed=-study_of("cryo").operation.inner_speed)
    assert two.linear.rates == pytest.approx(one.linear.rates, rel=1e-6)
    assert two.force_forward[-8:] == pytest.approx(one.force_forward[-8:], rel=1e-6)
    assert one.force_forward[-8:] != pytest.approx(one.force_backward[-8:], rel=1e-2)
    # the outer ring turns: the ball settles, with as many positive rates
    found = moved("cryo", inner_speed=0.0, outer_speed=study_of("cryo").operation.inner_speed).linear
    assert np.all(found.rates > 0.0)
    assert 0.0 < found.damping_relaxed <= found.damping


def test_race_control_gives_the_place_and_friction_the_spin():
    """Outer race control puts the ball a degree elsewhere; its mobility is that of friction all the same."""
    one, two = (moved("le7", model=model) for model in (None, KinematicModel.OUTER_RACE_CONTROL))
    assert two.linear.damping == pytest.approx(one.linear.damping, rel=0.02)


def test_a_ball_off_the_inner_race_is_refused(monkeypatch):
    """Nothing turns it there."""
    given, state = records("cryo"), records("cryo").state
    lifted = replace(state, inner=replace(state.inner, load=0.0))
    monkeypatch.setattr(contacts, "bearing_state", lambda *_: lifted)
    with pytest.raises(InputError, match="must press a ball on both races"):
        held_ball.__wrapped__(given, SlipLaw.RIGID)


def test_a_radial_bearing_has_no_pitch():
    """Contact angle 0: pivoting does not take part, C_f is C_eff; no gyroscopic mode is left out."""
    film = replace(study_of("cryo").film, material=None, thickness=None)
    found = moved("cryo", film=film, axial_load=0.0, radial_load=1000.0).linear
    assert found.damping == pytest.approx(found.damping_relaxed, rel=1e-6)
    assert found.pitch_angle == pytest.approx(0.0, abs=1e-6)


def test_a_worn_film_is_noted():
    """Its friction is not in the slip fields."""
    study = study_of("cryo")
    worn = replace(study.film, wear=Wear(width=0.2e-3, friction=0.3, races=Worn.INNER))
    solution = solve(replace(study, film=worn))
    assert np.isfinite(solution.mobility.force_law).all()
    assert any(note.startswith("The film is worn: the mobility") for note in solution.notes)
