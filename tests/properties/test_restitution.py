"""The restitution factor for inputs nobody thought of."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from separatrix.chain.impact_restitution import (
    damping_for,
    damping_ratio,
    hertzian_restitution_factor,
    restitution,
    restitution_factor,
)

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
