"""Speed of the equilibrium, warm: 10 balls at 50 000 rpm. Run with `make bench`."""

import math

import pytest

from separatrix.chain.equilibrium import equilibrium
from separatrix.chain.hertz import contact_ellipse
from separatrix.study.study import BallBearing, KinematicModel, Material, Operation

STEEL = Material(name="440C", elastic_modulus=199.948e9, poisson_ratio=0.25, density=7750.37)
BEARING = BallBearing(
    ball_diameter=7.938e-3,
    pitch_diameter=38.5e-3,
    ball_count=10,
    contact_angle=math.radians(20.0),
    inner_conformity=0.56,
    outer_conformity=0.52,
    ball_material=STEEL,
    ring_material=STEEL,
)
SPEED = 50_000 * 2.0 * math.pi / 60.0
AXIAL = Operation(inner_speed=SPEED, axial_load=2670.0)
COMBINED = Operation(inner_speed=SPEED, axial_load=2670.0, radial_load=800.0, moment=1.0)


@pytest.mark.parametrize("operation", [AXIAL, COMBINED], ids=["axial", "combined"])
@pytest.mark.parametrize("model", KinematicModel, ids=lambda model: model.value)
def test_equilibrium(benchmark, model, operation) -> None:
    """One bearing, once compiled."""
    equilibrium(BEARING, operation, model, 0.1)
    benchmark(equilibrium, BEARING, operation, model, 0.1)


def test_ellipse(benchmark) -> None:
    """One Hertz contact."""
    benchmark(contact_ellipse, 600.0, 300.0, 20.0, 110e9)
