"""What the equilibrium refuses, and what it says when it cannot balance."""

import dataclasses
import math

import pytest

from separatrix.equilibrium import equilibrium
from separatrix.errors import ConvergenceError, InputError
from separatrix.study import BallBearing, KinematicModel, Material, Operation

STEEL = Material(name="steel", elastic_modulus=206e9, poisson_ratio=0.3, density=7800.0)
BEARING = BallBearing(
    ball_diameter=11.1125e-3,
    pitch_diameter=65e-3,
    ball_count=13,
    contact_angle=math.radians(25.0),
    inner_conformity=0.52,
    outer_conformity=0.52,
    ball_material=STEEL,
    ring_material=STEEL,
)
OPERATION = Operation(inner_speed=1500.0, axial_load=3000.0)


@pytest.mark.parametrize("friction", [0.0, -0.1, math.nan, math.inf])
def test_free_kinematics_need_friction(friction: float) -> None:
    """Without friction nothing turns a ball: refused with the cure."""
    with pytest.raises(InputError, match=r"must be > 0 without race control.*use race control"):
        equilibrium(BEARING, OPERATION, KinematicModel.FREE, friction)


def test_a_turning_ball_needs_a_density() -> None:
    """Centrifugal force is asked for, so mass is."""
    light = dataclasses.replace(STEEL, density=None)
    bearing = dataclasses.replace(BEARING, ball_material=light)
    with pytest.raises(InputError, match=r"ball_material needs a density \[kg/m3\]"):
        equilibrium(bearing, OPERATION, KinematicModel.OUTER_RACE_CONTROL, 0.1)
    still = Operation(inner_speed=0.0, axial_load=3000.0)
    assert equilibrium(bearing, still, KinematicModel.OUTER_RACE_CONTROL, 0.1).load_inner[0] > 0.0


@pytest.mark.parametrize("load", [{"axial_load": -3000.0}, {"axial_load": 0.0}])
def test_a_load_that_lifts_the_ring_off_is_refused(load: dict[str, float]) -> None:
    """The operation itself says that nothing presses the balls."""
    with pytest.raises(InputError, match="axial_load must be"):
        dataclasses.replace(OPERATION, **load)


TIGHT = dataclasses.replace(
    BEARING, inner_conformity=0.508, outer_conformity=0.567, contact_angle=math.radians(45.0)
)


def test_balls_beside_their_grooves_are_refused() -> None:
    """A grain of axial load at 4e6 DN and a tight inner groove: the only balance has the ball upside down."""
    operation = Operation(inner_speed=6000.0, axial_load=100.0)
    with pytest.raises(InputError, match="cannot hold the balls in their grooves at this speed") as caught:
        equilibrium(TIGHT, operation, KinematicModel.OUTER_RACE_CONTROL, 0.1)
    assert "Raise it" in str(caught.value)


@pytest.mark.parametrize("model", [KinematicModel.FREE, KinematicModel.INNER_RACE_CONTROL])
def test_a_load_that_cannot_be_carried_is_one_sentence(model: KinematicModel) -> None:
    """The same without any balance: said in one line, with a cure and how far it came."""
    operation = Operation(inner_speed=6000.0, axial_load=100.0)
    with pytest.raises(ConvergenceError) as caught:
        equilibrium(TIGHT, operation, model, 0.1)
    assert "axial load" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert caught.value.iterations > 0
    assert caught.value.residual > 0.0
