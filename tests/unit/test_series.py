"""First zeros of power series in time."""

import math

import numpy as np
import pytest

from separatrix.cage.series import NEVER, ORDER, first_zero

UP, DOWN = 0.14649358203472101, 0.15437783331594138
"""A cage that leaves its land and comes back to it, as far as it goes in the land's clearance squared."""


@pytest.mark.parametrize("start", [0.0, 2e-16, 1.4327400746438694e-15, 3e-15, 1e-13, 1e-9, 1e-3])
def test_a_zero_behind_one_within_rounding_is_met_in_time(start):
    """A gap that begins within rounding of closed, opens and closes: by the parabola's closed form."""
    c = np.zeros(ORDER + 1)
    c[1], c[2] = -UP, DOWN
    exact = (UP + math.sqrt(UP * UP + 4.0 * DOWN * start)) / (2.0 * DOWN)
    # a gap of 1.4e-15 was once met 7e-4 of the step late, deep in the land
    assert first_zero(c, start, -1.0, 1.0, 1.0) == pytest.approx(exact, abs=1e-13)


def test_a_gap_that_only_opens_is_never_met():
    """From a start within rounding and from an open one."""
    c = np.zeros(ORDER + 1)
    c[1] = -UP
    assert first_zero(c, 2e-15, -1.0, 1.0, 1.0) == NEVER
    assert first_zero(c, 0.5, -1.0, 1.0, 1.0) == NEVER
