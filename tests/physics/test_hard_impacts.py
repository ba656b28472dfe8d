"""Impacts so hard and dead that a cage slides round in the polygon that its pockets leave it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST, followed

from separatrix.cage import MovingCage

DAMPING = 2000.0
STIFFNESS = 1.05 * 8.0 * DAMPING**2 / AT_REST.mass
"""Dead even where two opposite balls are struck at once: zeta, sqrt(2 k M)/4 C there, is above 1."""


def dead(balls: int, friction: float) -> MovingCage:
    """A cage that may not turn, among dampers at rest; an impact returns nothing."""
    return replace(
        AT_REST, ball_count=balls, moment_of_inertia=1e9, pocket_clearance=20e-3, race_damping=DAMPING,
        ball_cage_stiffness=STIFFNESS, ball_cage_friction=friction,
    )  # fmt: skip


def growth(balls: int, friction: float) -> float:
    """Growth of the logarithm of the speed in a turn of its direction, over the whole turns of 0.5 s.

    Later a growing one would be so fast that its impacts are no longer short.
    """
    found = followed(dead(balls, friction), 0.5, kick=3.0, samples=10_000)
    speed = found.velocity @ [1.0, 1j]
    turned = np.unwrap(np.angle(speed)) / (2.0 * math.pi)
    late = turned > turned[-1] - math.floor(turned[-1] - 1.0)  # the first impact is another one
    return float(np.polyfit(turned[late], np.log(np.abs(speed[late])), 1)[0])


@pytest.mark.parametrize(("balls", "corners", "critical"), [(11, 22, 0.1438), (12, 12, 0.2679)])
def test_a_cage_whirls_in_the_polygon_of_its_pockets_above_a_tangent(balls, corners, critical):
    """A corner turns it by 2 pi/n and leaves cos + f sin of its speed: it grows above tan(pi/n).

    2 % below and above. 1e-5 of what the corners take without friction is measured: impacts last a part of
    the way to the next corner.
    """
    angle = 2.0 * math.pi / corners
    assert critical == pytest.approx(math.tan(math.pi / corners), abs=5e-5)  # the digits given
    whole = -corners * math.log(math.cos(angle))
    for friction in (0.98 * critical, 1.02 * critical):
        lasts = corners * math.log(math.cos(angle) + friction * math.sin(angle))
        assert growth(balls, friction) == pytest.approx(lasts, abs=3e-5 * whole)
