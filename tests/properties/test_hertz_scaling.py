"""Scaling of Hertz contacts for loads and shapes that nobody chose."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from separatrix.chain.hertz import contact_ellipse

ROUNDING = 1e-11  # cube roots and the root of the shape, both to about 1e-15, over many magnitudes


@given(
    load=st.floats(1e-3, 1e6),
    curvature=st.floats(1.0, 1e4),
    ratio=st.floats(1.0, 1e7),
    factor=st.floats(1e-3, 1e3),
)
def test_load_scaling(load: float, curvature: float, ratio: float, factor: float) -> None:
    """At fixed shape, lengths and pressure grow as Q^(1/3), approach as Q^(2/3), stiffness as Q^(1/3)."""
    one = contact_ellipse(load, curvature, curvature / ratio, 110e9)
    two = contact_ellipse(load * factor, curvature, curvature / ratio, 110e9)
    third = factor ** (1.0 / 3.0)
    assert two.semi_major == pytest.approx(one.semi_major * third, rel=ROUNDING)
    assert two.semi_minor == pytest.approx(one.semi_minor * third, rel=ROUNDING)
    assert two.max_pressure == pytest.approx(one.max_pressure * third, rel=ROUNDING)
    assert two.approach == pytest.approx(one.approach * third**2, rel=ROUNDING)
    assert two.stiffness == pytest.approx(one.stiffness * third, rel=ROUNDING)
    assert one.semi_minor <= one.semi_major
