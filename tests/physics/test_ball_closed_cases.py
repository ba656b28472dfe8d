"""A ball between its races against motions that have closed forms: spin-up, pocket friction, pivoting.

By the slip fields of the mobility, whose contacts can be made as small as a point. E1 to E3 are numbers of
dynamics3d.md; they have six or seven digits.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from separatrix.chain.ball_mobility import HeldBall, balanced, modes
from separatrix.chain.grooved_ball import Problem
from separatrix.chain.hertz import approach_coefficient
from separatrix.chain.slip_friction import chebyshev_nodes, friction_resultants

M, RADIUS, ORBIT, SPEED, Q, MU = 2.029805e-3, 3.969e-3, 19.25e-3, 50_000 * math.pi / 30.0, 600.0, 0.1
HARD = 1e17
"""Modulus of contacts 3 um long [Pa]: the height of the groove's surface varies by 1e-10 of the radius."""


def loaded_ball() -> HeldBall:
    """A ball at rest between grooves at no contact angle that press it with Q; 1e-7 of V rounds Coulomb."""
    f, gamma = 0.53, RADIUS / ORBIT
    lengths = []
    for side in (-1.0, 1.0):
        curved = 1.0 / (RADIUS * (1.0 + side * gamma))
        stiffness = approach_coefficient(curved, (2.0 - 1.0 / f) / (2.0 * RADIUS), HARD, 0.0)[0]
        lengths.append((f - 0.5) * 2.0 * RADIUS + (Q / stiffness) ** (2.0 / 3.0))
    problem = Problem(
        ball_diameter=2.0 * RADIUS, pitch_diameter=2.0 * ORBIT, inner_conformity=f, outer_conformity=f,
        modulus=HARD, ball_mass=M, ball_inertia=0.4 * M * RADIUS**2,
        outer_speed=0.0, speed=SPEED, inner_share=0.0, friction=MU,
    )  # fmt: skip
    slip = 1e-7 * (ORBIT - RADIUS)
    return HeldBall(
        problem=problem, rings=np.array((0.0, sum(lengths))), state=np.array((0.0, lengths[1], *(0.0,) * 4)),
        slips=(slip, slip), nodes=chebyshev_nodes(2), capacity=2.0 * MU * Q,
    )  # fmt: skip


def test_a_ball_is_spun_up_by_the_driving_race():
    """E1: u = (10/7)(mu Q/m) t up to V/2 at 7 m V/(20 mu Q); heat is half the work, as in a ring.

    Motion to 1e-6, energies to twice that: the outer race creeps by 1e-7 of V, the contacts curve by 1e-10 of
    the radius, and scipy's integrator keeps 1e-8; the inputs' own numbers to the seven digits given.
    """
    ball, V = loaded_ball(), SPEED * (ORBIT - RADIUS)
    lightness = np.linalg.inv(ball.masses)[:2, :2]

    def state(y):
        return ball.state + np.array((0.0, 0.0, *(y[:2] / ball.units[:2]), 0.0, 0.0))

    def rates(_, y):
        return np.append(lightness @ balanced(ball, state(y))[0][2:4], y[0] / ORBIT)

    def slopes(_, y):
        J = np.zeros((3, 3))
        J[:2, :2] = lightness @ (balanced(ball, state(y))[1][2:4, 2:4] / ball.units[:2])
        J[2, 0] = 1.0 / ORBIT
        return J

    end = 7.0 * M * V / (20.0 * MU * Q)
    assert (V, end) == pytest.approx((80.011129, 9.473741e-4), rel=1e-7)
    times = np.array((0.5, 1.0, 1.05)) * end
    how = {"method": "Radau", "jac": slopes, "rtol": 1e-9, "atol": (1e-9, 1e-6, 1e-12), "t_eval": times}
    u, spin, swept = solve_ivp(rates, (0.0, times[-1]), np.zeros(3), **how).y
    assert u[0] == pytest.approx(10.0 / 7.0 * MU * Q / M * times[0], rel=1e-6)
    assert u[2] / ORBIT == pytest.approx(2078.2111, rel=1e-6)
    assert swept[1] == pytest.approx(0.984422, rel=1e-6)
    absolute, J = spin[2] + u[2] / ORBIT, 0.4 * M * RADIUS**2
    kinetic = 0.5 * M * u[2] ** 2 + 0.5 * J * absolute**2
    driven = 0.5 * (M * u[2] - J * absolute / RADIUS)  # impulse of the inner race's friction
    assert (kinetic, V * driven, V * driven - kinetic) == pytest.approx(
        (2.274014, 4.548028, 2.274014), rel=2e-6
    )


C_i, C_o, M_B, R_B = 65.58149, 290.99772, 5.496616e-3, 5.55625e-3
"""Creep of both contacts, mass and radius of the ball of E2."""


def creeping():
    """Modes of a ball that creeps in two contacts."""
    S, D = C_i + C_o, C_i - C_o
    slopes = -np.array(((S, R_B * D), (R_B * D, R_B**2 * S)))
    return modes(slopes, np.diag((M_B, 0.4 * M_B * R_B**2)))


def test_a_ball_with_creep_in_two_contacts():
    """Contact angle 0: rates [3.5 S -+ sqrt(2.25 S^2 + 10 D^2)]/2m, u/F = (1/C_i + 1/C_o)/4 (E2)."""
    found = creeping()
    assert found.rates.real == pytest.approx((32460.24, 194593.50), rel=1e-6)
    assert 1.0 / found.relaxed == pytest.approx(0.25 * (1.0 / C_i + 1.0 / C_o), rel=1e-12)


@pytest.mark.parametrize(("sense", "damping"), [(1.0, 190.0508), (-1.0, 245.0634)])
def test_pocket_friction_of_a_ball_with_creep(sense, damping):
    """E2: C = 4/[(1 +- f)/C_i + (1 -+ f)/C_o] at no contact angle, + from the front, f .2; to the digits."""
    found, f = creeping(), 0.2
    # the spin counts against the orbit; -1 from the front comes with a couple of -f R that brakes it
    u = np.linalg.solve(-found.slopes, (1.0, sense * f * R_B))[0]
    assert 1.0 / u == pytest.approx(damping, rel=5e-7)


PIVOTING = [
    (0.01, 0.01178068, 0.58898972),
    (0.1, 0.11751520, 0.58318023),
    (0.25, 0.28992237, 0.55309595),
    (0.5, 0.55223308, 0.45559229),
    (1.0, 0.88357293, 0.22089323),
    (2.0, 0.97427858, 0.10190933),
    (5.0, 0.99598266, 0.04011545),
]
"""v/(a w), F/(mu N), M/(mu N a) of E3 by quadrature about the instant centre; the notes have the same six
digits, but for two forces: .117516 and .289921."""


def pivot(slide: float, spin: float = 1.0) -> tuple[float, float]:
    """Force and moment of a circular contact of unit radius, extrapolated from two grids."""
    found, out = [], np.empty((5, 7))
    for cells in (100, 200):
        c = np.array((spin, 0.0, slide, 0.0))
        friction_resultants(c, 1.0, 1.0, 50.0, 1e13, 1e-9, chebyshev_nodes(cells // 2), out)
        found.append(out[[2, 0], 0].copy())
    force, moment = (4.0 * found[1] - found[0]) / 3.0
    return float(force), float(moment)


@pytest.mark.parametrize(("slide", "force", "moment"), PIVOTING)
def test_sliding_and_pivoting_share_the_friction(slide, force, moment):
    """E3, Contensou: on a circular Hertz contact; 4e-6 is what the extrapolation leaves."""
    assert pivot(slide) == pytest.approx((force, moment), abs=4e-6)


def test_a_pivoting_ball_stops():
    """E3: after 16 J w/(3 pi mu N a), .716749 s, as the moment does not depend on the spin."""
    moments = [pivot(0.0, spin)[1] for spin in (1.0, 1e-3)]
    assert moments == pytest.approx([3.0 * math.pi / 16.0] * 2, rel=3e-6)
    assert 4.222e-9 * 1000.0 / (0.1 * 1.0 * 1e-4 * moments[0]) == pytest.approx(0.716749, rel=3e-6)
