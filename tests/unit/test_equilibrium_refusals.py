"""What the equilibrium refuses, and what it says when it cannot balance."""

import dataclasses
import math

import numpy as np
import pytest
from cages import BEARING as TURBOPUMP
from cages import STEEL_218

from separatrix.chain.equilibrium import equilibrium
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.study.study import KinematicModel, Operation

STEEL = dataclasses.replace(STEEL_218, elastic_modulus=206e9)
BEARING = dataclasses.replace(TURBOPUMP, outer_conformity=0.52, ball_material=STEEL, ring_material=STEEL)
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


@pytest.mark.parametrize("model", list(KinematicModel))
def test_balls_beside_their_grooves_are_refused(model: KinematicModel) -> None:
    """A grain of axial load at 4e6 DN and a tight inner groove: the ball climbs its groove to the edge."""
    tight = {"inner_conformity": 0.508, "outer_conformity": 0.567, "contact_angle": math.radians(45.0)}
    bearing, operation = (
        dataclasses.replace(BEARING, **tight),
        Operation(inner_speed=6000.0, axial_load=100.0),
    )
    with pytest.raises(InputError, match=r"out of their grooves: a contact angle .*raise the axial load"):
        equilibrium(bearing, operation, model, 0.1)


def test_a_contact_wider_than_its_groove_is_refused() -> None:
    """Grooves that hug the balls make long ellipses: over 90 deg from the bottom there is no groove."""
    hugging = dataclasses.replace(BEARING, inner_conformity=0.5005, outer_conformity=0.5005)
    with pytest.raises(InputError, match="press balls over the edges of their grooves"):
        equilibrium(hugging, Operation(inner_speed=10.0, axial_load=1e5), KinematicModel.FREE, 0.1)


def test_balls_that_touch_nothing_have_nominal_angles() -> None:
    """A ball on the far side of a radial load does not touch the missing upper half of the inner groove.

    The groove was a full circle: such a ball reported an inner angle of 180 deg.
    """
    sizes = {"ball_diameter": 1.0906e-3, "pitch_diameter": 61.72e-3, "ball_count": 160}
    grooves = {"contact_angle": math.radians(79.0), "inner_conformity": 0.6, "outer_conformity": 0.51}
    bearing = dataclasses.replace(BEARING, **sizes, **grooves)
    operation = Operation(inner_speed=0.0, outer_speed=10472.0, axial_load=0.0, radial_load=500.0)
    result = equilibrium(bearing, operation, KinematicModel.OUTER_RACE_CONTROL, 2.0)
    assert not result.inner_contact.all()
    assert result.outer_contact.all()
    assert abs(result.contact_angle_inner).max() < 0.5 * math.pi


@pytest.mark.parametrize("model", [KinematicModel.FREE, KinematicModel.INNER_RACE_CONTROL])
def test_a_load_that_cannot_be_carried_is_one_sentence(model: KinematicModel) -> None:
    """A ring that weighs next to nothing and may tilt: said in one line, with a cure and how far it came."""
    afloat = Operation(inner_speed=1500.0, axial_load=1e-6, radial_load=5e-6, moment=0.0)
    with pytest.raises(ConvergenceError, match=r"^[^\n]*axial load[^\n]*$") as caught:
        equilibrium(BEARING, afloat, model, 0.1)
    assert min(caught.value.iterations, caught.value.residual) > 0


@pytest.mark.parametrize("radial", [0.0, 1e-6, 1000.0])
def test_a_load_of_a_micronewton_is_carried(radial: float) -> None:
    """The normal loads and the friction carry it; none drowns in the tolerance of a larger load."""
    operation = Operation(inner_speed=1500.0, axial_load=1e-6, radial_load=radial)
    result = equilibrium(BEARING, operation, KinematicModel.OUTER_RACE_CONTROL, 0.1)
    carried = float((result.load_inner * np.sin(result.contact_angle_inner)).sum())
    assert carried == pytest.approx(1e-6, rel=1e-3)  # what `LEAST` accepts
