"""Rough interface in series: its compliance rises where the pressure falls."""

import math
from dataclasses import replace

import numpy as np
import pytest
from exact_cases import MU, P0, body, contact, ellipse, kalker, saturation
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from separatrix.chain.exact.rolling import ContactProblem, rolling_contact
from separatrix.chain.exact.slip import FrictionLaw, rough_compliance

quick = settings(max_examples=12)
B = 0.2


def alone(columns, *, friction):
    """Rough interface between rigid bodies."""
    stiff, law = (body(0.25, G=1e9),) * 2, FrictionLaw(coefficient=friction)
    problem = ContactProblem(ellipse=ellipse(B), bodies=stiff, friction=law, roughness=1.0)
    return rolling_contact(problem, columns=columns, rows=columns)


def test_rough_interface_alone_in_stick():
    """Traction p xi d/l, d the distance from the leading edge: force 9 pi/32 N b xi/l to 0.3/n^1.5."""
    for columns in (20, 40):
        force = -kalker(alone(columns, friction=1e9), xi=1.0).force
        exact = 9.0 * math.pi / 32.0 * ellipse(B).load * B
        assert force == pytest.approx(exact, rel=0.3 / columns**1.5)


@pytest.mark.parametrize("creep", [0.5, 1.0, 3.0])
def test_rough_interface_alone_slips_at_one_distance(creep):
    """Traction mu p min(1, xi d/(mu l)) in every row, whatever the pressure; 0.1 % at 40 x 40 cells."""

    def row(y):
        end = B * math.sqrt(1.0 - y * y)

        def traction(x):
            p = P0 * math.sqrt(max(1.0 - (x / B) ** 2 - y * y, 0.0))
            return MU * p * min(1.0, creep * (end - x) / B)

        return quad(traction, -end, end, limit=100)[0]

    exact = 2.0 * quad(row, 0.0, 1.0, limit=100)[0]
    found = kalker(alone(40, friction=MU), xi=creep * MU / B)
    assert -found.force == pytest.approx(exact, rel=1e-3)
    assert found.stick_share == pytest.approx(1.0 if creep < 0.6 else 2.0 / math.pi / creep, abs=0.04)


shape = st.floats(-1.0, 0.5).map(lambda x: 10.0**x)
size = st.floats(-2.0, 1.2).map(lambda x: 10.0**x)


@quick
@given(shape, st.floats(0.0, 0.5), st.integers(6, 18), st.floats(-9.0, 0.0), size, size)
def test_roughness_softens(b, nu, cells, logarithm, xi, spin):
    """Whatever the contact: finite, within the bound, and sticking less the rougher it is."""
    made = contact(b, nu, columns=cells, rows=cells, roughness=10.0**logarithm)
    one = kalker(made, xi * saturation(nu), phi=spin * saturation(nu))
    assert np.isfinite(one.traction).all()
    assert (np.hypot(*one.traction) <= made.bound * (1.0 + 1e-9)).all()
    sticking = [
        -kalker(contact(b, nu, columns=cells, rows=cells, friction=1e6, roughness=r), 1e-6).force
        for r in (0.0, made.problem.roughness, 2.0 * made.problem.roughness)
    ]
    assert sticking[0] > sticking[1] > sticking[2] > 0.0


def test_edges_without_pressure():
    """Cells that the pressure leaves out are neither nan nor infinitely soft, with cohesion too."""
    made = contact(B, columns=12, rows=12, roughness=1e-4)
    pressure = made.pressure.copy()
    pressure[:, :6] = 0.0
    L = rough_compliance(made.grid, pressure, 1e-4)
    assert np.isfinite(L).all()
    assert L.max() == pytest.approx(1e-4 / (1e-6 * pressure[made.grid.fraction == 1.0].max()), rel=0.2)
    sticky = replace(made.problem, friction=FrictionLaw(coefficient=MU, cohesion=0.1 * P0))
    assert math.isfinite(kalker(rolling_contact(sticky, columns=12, rows=12), xi=1e-3).force)
