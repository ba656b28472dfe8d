"""The restitution factor: table of the closed form, its inverse, and the same impacts by integration."""

from math import nan, sqrt

import numpy as np
import pytest
from cages import BEARING, STEEL
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.special import beta

from separatrix import InputError, Material, ball_pocket_stiffness, damping_ratio, restitution_factor
from separatrix.chain.impact_restitution import (
    damping_for,
    damping_ratio_for,
    equal_energy_stiffness,
    hertz_coefficient,
    hertz_coefficient_for,
    hertzian_restitution_factor,
    race_damping_free_spin,
    restitution,
)
from separatrix.chain.pocket_friction import impact_force

MASS, STIFFNESS = 0.05, 3e6
DIAMETER = BEARING.ball_diameter


def polymer(elastic_modulus):
    """A cage material."""
    return Material(name="polymer", elastic_modulus=elastic_modulus, poisson_ratio=0.4)


def impact(mass, coefficient, damping, speed, power):
    """Speed after over before, and largest force: mass, spring of this power and damper in series."""

    def rates(_, state):
        force = coefficient * max(state[1], 0.0) ** power
        return [-force / mass, state[0] - force / damping]

    def parting(_, state):
        return state[1]

    parting.terminal, parting.direction = True, -1.0
    depth = (0.5 * (power + 1.0) * mass * speed**2 / coefficient) ** (1.0 / (power + 1.0))
    how = {"rtol": 1e-12, "atol": 1e-15, "method": "DOP853"}
    run = solve_ivp(rates, (0.0, 1.0), [speed, 1e-12 * depth], events=parting, dense_output=True, **how)
    top = run.t[np.argmax(run.y[1])]
    deepest = run.sol(np.linspace(0.5 * top, 2.0 * top, 10_001))[1].max()
    return -run.y[0, -1] / speed, coefficient * deepest**power


@pytest.mark.parametrize(
    ("damping", "eta"),
    [
        *((10000, 0.9410), (3979, 0.8581), (2000, 0.7367), (1200, 0.5983), (600, 0.3426), (300, 0.0703)),
        *((193.65, 0.0), (77, 0.0)),  # where nothing returns
    ],
)
def test_closed_forms_give_the_table_and_the_integrated_impact(damping, eta):
    """0.05 kg on 3e6 N/m: values computed independently; mass, spring, damper in series stepped in time."""
    zeta = damping_ratio(STIFFNESS, MASS, damping)
    assert restitution_factor(zeta) == pytest.approx(eta, abs=5e-5)  # four digits each
    back, force = impact(MASS, STIFFNESS, damping, 1.0, 1.0)
    # the integrator's 1e-12 a step, times up to a thousand steps
    assert back == pytest.approx(restitution_factor(zeta), abs=1e-9)
    # the top is flat: a step of 1e-4 of the time to it misses it by less than 1e-8 of itself
    assert impact_force(MASS, STIFFNESS, zeta, 1.0) == pytest.approx(force, rel=1e-7)


def test_nothing_returns_from_the_critical_damping_down():
    """At zeta = 1, here C = 193.65 N s/m, the spring never parts with speed."""
    assert damping_for(0.0, STIFFNESS, MASS) == pytest.approx(193.65, abs=5e-3)
    assert restitution_factor(damping_ratio(STIFFNESS, MASS, 193.64)) == 0.0
    assert restitution_factor(damping_ratio(STIFFNESS, MASS, 210.0)) > 0.0


def test_free_spin_from_the_balance_of_the_ball():
    """Force and moment on a massless ball at two contacts, solved as a 2x2 system; rounding only."""
    c_inner, c_outer = 700.0, 2100.0
    balance = np.array([[c_inner + c_outer, c_inner - c_outer], [c_inner - c_outer, c_inner + c_outer]])
    speed, _ = np.linalg.solve(balance, [1.0, 0.0])  # unit push; speed of the centre, and radius times spin
    assert race_damping_free_spin(c_inner, c_outer) == pytest.approx(1.0 / speed, rel=1e-12)


@pytest.mark.parametrize("damping", [20000.0, 2000.0, 600.0, 300.0, 150.0])
@pytest.mark.parametrize("speed", [0.1, 2.0])
def test_a_hertzian_impact_equals_the_integrated_impact_in_newtons(damping, speed):
    """In newtons and metres, by the same integrator with Hertz's contact."""
    K = hertz_coefficient(DIAMETER, STEEL, polymer(4e9))
    zeta = damping_ratio(equal_energy_stiffness(K, MASS, speed), MASS, damping)
    eta = hertzian_restitution_factor(zeta)
    # the integrator's 1e-12 a step, times up to a thousand steps
    assert impact(MASS, K, damping, speed, 1.5)[0] == pytest.approx(eta, abs=1e-9)


def test_the_limits_of_a_hertzian_impact():
    """Weakly damped 1 - eta = 1.25^0.6 B(1/2, 8/5) beta: 3.783 zeta, the linear spring pi zeta."""
    zeta = 1e-6
    slope = 2.0 * 1.25**0.6 * beta(0.5, 1.6) / sqrt(0.8 * 1.25**0.2)
    assert slope == pytest.approx(3.783, abs=5e-4)
    # the next term is of order zeta
    assert (1.0 - hertzian_restitution_factor(zeta)) / zeta == pytest.approx(slope, rel=1e-5)
    assert hertzian_restitution_factor(0.0) == 1.0
    # strongly damped: as the group to the power -5, with a constant of the impact's last part; never quite 0
    group = 2.0 / sqrt(0.8 * 1.25**0.2)
    ends = [hertzian_restitution_factor(zeta) * (group * zeta) ** 5 for zeta in (2.3, 2.7, 3.0, 100.0)]
    assert ends == pytest.approx([0.67929306] * 4, abs=5e-9)  # digits of the docs
    assert restitution_factor(2.3) == 0.0


def test_a_given_stiffness_and_its_hertz_coefficient_store_alike():
    """There and back, and the same as the stiffness from the materials; rounding only."""
    K = hertz_coefficient_for(3e6, MASS, 0.5)
    assert equal_energy_stiffness(K, MASS, 0.5) == pytest.approx(3e6, rel=1e-12)
    k = ball_pocket_stiffness(DIAMETER, STEEL, polymer(4e9), cage_mass=MASS, impact_speed=0.5)
    there = hertz_coefficient(DIAMETER, STEEL, polymer(4e9))
    assert hertz_coefficient_for(k, MASS, 0.5) == pytest.approx(there, rel=1e-12)


@pytest.mark.parametrize(("eta", "damping"), [(1.0, 0.0), (1.2, -1.0), (-0.1, nan), (nan, nan)])
def test_what_makes_no_impact_is_refused(eta, damping):
    """The inverse exists for 0 <= eta < 1 only; a massless ball held by nothing takes no impact."""
    with pytest.raises(InputError, match="restitution_factor must lie in 0 <= eta < 1"):
        damping_ratio_for(eta)
    with pytest.raises(InputError, match="restitution_factor"):
        damping_for(eta, 3e6, 0.05)
    with pytest.raises(InputError, match=r"race_damping must be > 0 \[N s/m\]"):
        damping_ratio(3e6, 0.05, damping)


# The restitution factor for inputs nobody thought of.

positive = st.floats(1e-3, 1e5)


@given(st.floats(1e-6, 0.9999), st.floats(1e5, 1e8), st.floats(1e-3, 1.0))
def test_the_inverse_undoes_the_factor(eta, stiffness, mass):
    """From eta to C_mu and back; tolerance: rounding, magnified by 1/(1-eta) near 1."""
    damping = damping_for(eta, stiffness, mass)
    assert restitution_factor(damping_ratio(stiffness, mass, damping)) == pytest.approx(eta, rel=1e-9)


@given(positive, positive, st.floats(1.01, 10.0))
def test_more_damping_returns_more(inner, outer, factor):
    """The paper, section 2.1.1: eta near one is insufficient lubrication, a ball gripped by its races."""
    held = {"ball_cage_stiffness": 3e6, "cage_mass": 0.05}
    less = restitution(inner, outer, **held)
    more = restitution(factor * inner, factor * outer, **held)
    assert more.restitution_factor >= less.restitution_factor
    assert more.restitution_factor_free_spin >= less.restitution_factor_free_spin
    assert 0.0 <= less.restitution_factor_free_spin <= less.restitution_factor + 1e-15 < 1.0


@given(st.floats(1e-6, 1e3), st.floats(1.01, 100.0))
def test_a_hertzian_impact_returns_between_all_and_nothing(zeta, factor):
    """Strictly between 0 and 1, less for more damping, and beside the linear one as the docs say."""
    less, more = hertzian_restitution_factor(factor * zeta), hertzian_restitution_factor(zeta)
    assert 0.0 < less < more < 1.0
    assert -0.0428 < more - restitution_factor(zeta) < 0.0227
