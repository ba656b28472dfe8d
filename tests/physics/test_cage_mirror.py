"""A bearing that turns backward and its mirror image move alike, by the second road, with every input on.

Tolerance: both runs take the same steps of mirrored states, so they differ by rounding, which some impacts
raise by a few powers of ten.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import small_step
from cages import EVERYTHING

from separatrix.cage.planar import turned_forward
from separatrix.study import Guidance

BACKWARD = replace(
    EVERYTHING,
    ball_count=7,
    cage_speed=-669.0,
    inner_speed=-1570.8,
    guidance=Guidance.INNER,
    land_clearance=3e-4,
    land_out_of_round=1e-5,
    gravity=50.0,
    hertz_coefficient=None,
    pocket_angles=(0.1, 1.0, 1.8, 2.9, 3.7, 4.5, 5.4),
)
LEAD = np.array([-9e-5, -3e-5, 5e-5, 9e-5, 0.0, 2e-5, -6e-5])


def course(cage, direction, lead):
    """Three milliseconds after a kick of 0.5 m/s."""
    return small_step.follow(cage, kick=0.5, direction=direction, ball_lead=lead, duration=3e-3, step=5e-7)


def seen_from_the_other_side(lead):
    """Ball j of the image is ball -j, and leads where that one lags."""
    return -np.roll(lead[..., ::-1], 1, axis=-1)


@pytest.mark.parametrize("contact", [{}, {"hertz_coefficient": 5e8}], ids=["linear", "hertz"])
def test_the_mirror_image_moves_as_the_bearing_does_seen_from_the_other_side(contact):
    """Kick, leads, angles, orbital speeds, friction, land, lobes, unbalance, gravity and ramp mirrored."""
    cage = replace(BACKWARD, **contact)
    there = course(cage, 0.7, LEAD)
    image = course(turned_forward(cage), -0.7, seen_from_the_other_side(LEAD))
    assert np.hypot(*there.position.T).max() > 1.4e-4  # the land has been met
    assert image.position * [1.0, -1.0] == pytest.approx(there.position, abs=1e-10)
    assert image.rotation == pytest.approx(-there.rotation, abs=1e-10 / 0.0325)
    assert seen_from_the_other_side(image.ball_lead) == pytest.approx(there.ball_lead, abs=1e-10)


@pytest.mark.parametrize("field", ["pocket_angles", "orbital_cosines"])
def test_without_the_mirroring_of_a_field_it_would_not(field):
    """What the test above would see: more than a micrometre within the same time."""
    there = course(BACKWARD, 0.7, LEAD)
    half = replace(turned_forward(BACKWARD), **{field: getattr(BACKWARD, field)})
    image = course(half, -0.7, seen_from_the_other_side(LEAD))
    assert np.abs(image.position * [1.0, -1.0] - there.position).max() > 1e-6
    assert math.isfinite(image.rotation[-1])
