"""A free ball, as the engine has it: spin-up, pivoting and sliding.

E1 and E3 are numbers of dynamics3d.md. The engine integrates a contact in six strips, each with one
mean slip: exact where the slip is the same everywhere, within some percent where it pivots.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from test_ball_closed_cases import PIVOTING

from separatrix.cage.ball import race_force, slip_field
from separatrix.cage.rows import LANES, RACE_ROWS

M, RADIUS, ORBIT, SPEED, Q, MU = 2.029805e-3, 3.969e-3, 19.25e-3, 50_000 * math.pi / 30.0, 600.0, 0.1
V, J = SPEED * (ORBIT - RADIUS), 0.4 * M * RADIUS**2


def race(outward: float) -> np.ndarray:
    """Numbers of a race at no contact angle, a point; 1e-5 of V rounds Coulomb."""
    numbers = np.zeros((RACE_ROWS // LANES, LANES))
    numbers[1], numbers[2], numbers[8] = outward, MU * Q, (1e-5 * V) ** 2
    return numbers.ravel()


def test_a_ball_is_spun_up_by_the_driving_race():
    """E1: u = (10/7)(mu Q/m) t up to V/2 at 7 m V/(20 mu Q); the other race rolls, and carries 3/7 mu Q.

    From rest, which is V/2 below free rolling. The rolling race creeps by some 5e-6 of V.
    """
    inner, outer = race(-1.0), race(1.0)

    def forces(y):
        return [race_force.py_func(p, 0, 0, y[0], y[1], 0.0, 0.0, RADIUS) for p in (inner, outer)]

    def rates(_, y):
        (f, couple, *_), (g, other, *_) = forces(y)
        return np.array([(f + g) / M, (couple + other) / J])

    end = 7.0 * M * V / (20.0 * MU * Q)
    times = np.array((0.5, 1.1)) * end
    start = np.array([-0.5 * V, 0.5 * V / RADIUS])
    how = {"method": "Radau", "rtol": 1e-9, "atol": (1e-6, 1e-4), "t_eval": times}
    speed, turn = solve_ivp(rates, (0.0, times[-1]), start, **how).y
    assert speed[0] + 0.5 * V == pytest.approx(10.0 / 7.0 * MU * Q / M * times[0], rel=1e-5)
    assert abs(speed[1]) < 1e-5 * V
    (driven, *_), (rolled, *_) = forces((speed[0], turn[0]))
    assert driven == pytest.approx(MU * Q, rel=1e-8)
    assert rolled == pytest.approx(3.0 / 7.0 * MU * Q, rel=1e-5)


@pytest.mark.parametrize(("slide", "force", "moment"), PIVOTING)
def test_sliding_and_pivoting_share_the_friction(slide, force, moment):
    """E3, a circular contact in six strips: 7.7 % of the force and 15.4 % of the moment are their error."""
    found = slip_field.py_func(np.float64(slide), 1.0, 0.0, 0.0, 0.25, 1e-18)
    assert found[0] == pytest.approx(force, rel=0.08)
    assert found[1] == pytest.approx(moment, rel=0.16)
