"""A plain cage has a kernel of its own, which computes to the last bit what the general one does."""

from dataclasses import fields, replace

import numpy as np
import pytest
from cages import AT_REST, ON_A_LAND, RAMP, TURNING, WAVES

from separatrix import StabilitySettings, run_ensemble
from separatrix.ball_traction import BallTraction
from separatrix.cage import inputs
from separatrix.cage.inputs import coefficients
from separatrix.cage.records import PLAIN

FEW = StabilitySettings(kicks=(0.1, 2.0), runs=4, duration=0.02)

PARTS = {
    "hertz_coefficient": 3e8,
    "traction": BallTraction(mass=6e-3, slopes=(188.0,), speeds=(0.4,)),
    "pocket_clearance": 0.0,
    "unbalance": 1e-6,
    "gravity": 9.81,
    "land_out_of_round": 2e-5,
}


def has_plain_numbers(cage):
    """Whether the numbers of a cage have the type for which the plain kernel is compiled."""
    return PLAIN in coefficients(cage, 0.5).dtype.names


@pytest.mark.parametrize("cage", [AT_REST, TURNING, ON_A_LAND], ids=["at rest", "turning", "on a land"])
@pytest.mark.parametrize("friction", [0.05, 0.3])
def test_both_kernels_compute_the_same_bits(cage, friction, monkeypatch):
    """Every number of every run, settling and whirling."""
    cage = replace(cage, ball_cage_friction=friction)
    assert has_plain_numbers(cage)
    plain = run_ensemble(cage, FEW)
    monkeypatch.setattr(inputs, "is_plain", lambda _: False)
    assert not has_plain_numbers(cage)
    general = run_ensemble(cage, FEW)
    for field in fields(plain):
        np.testing.assert_array_equal(getattr(plain, field.name), getattr(general, field.name), field.name)


@pytest.mark.parametrize("part", [*({name: value} for name, value in PARTS.items()), WAVES, RAMP], ids=str)
def test_a_cage_with_any_other_part_is_not_plain(part):
    """Its kernel would leave that part out."""
    assert has_plain_numbers(ON_A_LAND)
    assert not has_plain_numbers(replace(ON_A_LAND, **part))
