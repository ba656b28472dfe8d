"""What a fluid takes from a bearing: how fast it turns among the balls, and how the parts give it heat."""

from __future__ import annotations

from typing import ClassVar

from separatrix.ground.schema import all_or_none, between, key, not_negative, positive, record
from separatrix.ground.units import (
    JoulePerKilogramKelvin,
    KilogramPerSecond,
    Ratio,
    WattPerKelvin,
    WattPerMetreKelvin,
)

_CONDUCTANCE = positive(1e-9, 1e9)
_TEMPERATURES = ("flow", "race_conductance", "inner_cooling", "outer_cooling", "ball_cooling")


@record
class Cooling:
    """The fluid that flows through the bearing, and the conductances between it and the parts.

    Conductances are those of all balls together.
    """

    RULES: ClassVar = (all_or_none(*_TEMPERATURES), all_or_none("steel_conductivity", "steel_heat_capacity"))

    swirl: Ratio = key(between(0.0, 1.0), example="0.4")
    """Speed of the fluid among the balls: 0 with the outer ring, 1 with the inner ring."""

    flow: KilogramPerSecond | None = key(
        positive(1e-9, 1e4), default=None, example='"50 g/s"', without="not given: no temperatures"
    )
    """Of coolant through the bearing, which comes at the temperature of [operation]."""

    race_conductance: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"5 W/K"')
    """Between the balls and either ring, through their contacts."""

    inner_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"20 W/K"')
    """Between the inner ring and the coolant."""

    outer_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"30 W/K"')
    """Between the outer ring and the coolant."""

    ball_cooling: WattPerKelvin | None = key(_CONDUCTANCE, default=None, example='"25 W/K"')
    """Between the balls and the coolant."""

    cage_cooling: WattPerKelvin = key(
        not_negative(1e9), default=0.0, example='"10 W/K"', needs=("flow", "there are no temperatures")
    )
    """Between the cage and the coolant; 0 leaves the cage's temperature out."""

    steel_conductivity: WattPerMetreKelvin | None = key(
        positive(1e-3, 1e5), default=None, example='"12 W/(m K)"', without="not given: no flash temperatures"
    )
    """Of balls and rings at their temperature."""

    steel_heat_capacity: JoulePerKilogramKelvin | None = key(
        positive(1e-3, 1e6), default=None, example='"180 J/kg/K"'
    )
    """The same."""
