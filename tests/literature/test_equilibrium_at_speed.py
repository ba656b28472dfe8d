"""Equilibrium at 10 000 rpm under outer race control, by another program (ADORE.jl).

Source: sources/adore_7210b.txt. Its equilibrium has the equations of Jones and Harris as ours does: this
finds errors of ours, and is not evidence for the equations. The orbit of its run in time, 4274 rpm, belongs
to another state and is not compared (docs/validation.md).

Tolerances. Stiffness: rounding, both have the exact Hertz solution. Angle: theirs rounds the corner of the
law of contact over 1e-9 m, 3e-8 of a load; we differ by 3e-8 deg. 1e-6 deg is far below what an error of ours
would do: the centrifugal force times 2 or 1/2 moves it by 4.3 or -2.6 deg, the gyroscopic moment with the
wrong sign or absent by -4.1 or -2.0 deg, curvatures held at 40 deg by 0.002 deg. Approach: half of the
printed digit.
"""

import math

import pytest

from separatrix.chain.equilibrium import contact, equilibrium
from separatrix.chain.hertz import contact_ellipse, contact_modulus, race_curvatures
from separatrix.study.study import BallBearing, KinematicModel, Material, Operation, Race

STEEL = Material(name="steel", elastic_modulus=208e9, poisson_ratio=0.3, density=7800.0)
SIZE_7210B = BallBearing(
    ball_diameter=12.7e-3, pitch_diameter=70e-3, ball_count=16, contact_angle=math.radians(40.0),
    inner_conformity=0.52, outer_conformity=0.52, ball_material=STEEL, ring_material=STEEL,
)  # fmt: skip
OPERATION = Operation(inner_speed=10_000.0 * math.pi / 30.0, axial_load=2000.0)


@pytest.mark.parametrize(
    ("race", "stiffness"), [(Race.INNER, 3.2685945789285957e10), (Race.OUTER, 3.399924401045262e10)]
)
def test_contact_stiffness_at_the_free_angle(race: Race, stiffness: float) -> None:
    """Load over approach^1.5, which also shows that both grooves have 52 %."""
    curvatures = race_curvatures(SIZE_7210B, race, SIZE_7210B.contact_angle)
    ellipse = contact_ellipse(100.0, *curvatures, contact_modulus(STEEL, STEEL))
    assert ellipse.load / ellipse.approach**1.5 == pytest.approx(stiffness, rel=1e-12)


def test_angle_and_approach_under_outer_race_control() -> None:
    """Inner angle and mean of both approaches, as printed."""
    result = equilibrium(SIZE_7210B, OPERATION, KinematicModel.OUTER_RACE_CONTROL, 0.1)
    assert math.degrees(result.contact_angle_inner[0]) == pytest.approx(48.45720483982172, abs=1e-6)
    approach = sum(contact(result, SIZE_7210B, race, 0).approach for race in Race) / 2.0
    assert approach == pytest.approx(3.19e-6, abs=0.005e-6)
