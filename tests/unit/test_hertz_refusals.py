"""What `contact_ellipse` refuses, and what it says."""

import math

import pytest

from separatrix.chain.hertz import contact_ellipse
from separatrix.errors import InputError


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ((-1.0, 200.0, 10.0, 1e11), "load must be finite and >= 0 [N]; got -1."),
        ((math.nan, 200.0, 10.0, 1e11), "load must be finite"),
        (
            (1.0, 200.0, 0.0, 1e11),
            "curvature_transverse must be finite and > 0 [1/m]; got 0. The groove radius",
        ),
        ((1.0, 10.0, 200.0, 1e11), "Swap the two"),
        ((1.0, math.inf, 200.0, 1e11), "curvature_rolling must lie from 200 up [1/m]; got inf."),
        ((1.0, 200.0, 10.0, 0.0), "contact_modulus must be finite and > 0 [Pa]; got 0."),
    ],
)
def test_a_wrong_number_is_refused_with_rule_and_value(
    numbers: tuple[float, float, float, float], words: str
) -> None:
    """One sentence: where, rule, unit, value, cure."""
    with pytest.raises(InputError) as caught:
        contact_ellipse(*numbers)
    assert words in str(caught.value)


def test_no_load_gives_an_ellipse_of_no_size() -> None:
    """A ball that does not touch has lengths, pressure and stiffness 0, and no NaN."""
    ellipse = contact_ellipse(0.0, 200.0, 10.0, 1e11)
    sizes = (
        ellipse.semi_major,
        ellipse.semi_minor,
        ellipse.max_pressure,
        ellipse.approach,
        ellipse.stiffness,
    )
    assert sizes == (0.0,) * 5
