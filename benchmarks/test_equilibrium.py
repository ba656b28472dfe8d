"""Speed of the equilibrium, warm: 10 balls at 50 000 rpm. Run with `make bench`."""

import math

import pytest

from separatrix.chain.equilibrium import equilibrium
from separatrix.chain.hertz import contact_ellipse
from separatrix.study.reading import read_study
from separatrix.study.study import KinematicModel, Operation

BEARING = read_study("le7").bearing
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
