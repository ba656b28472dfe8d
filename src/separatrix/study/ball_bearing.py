"""The bearing of a study: its materials and its geometry, each number with the check that it must pass."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from separatrix.ground import bounds as _check
from separatrix.ground.bounds import between, must, positive
from separatrix.ground.units import (
    Kelvin,
    KilogramPerMetre3,
    Metre,
    Pascal,
    PerKelvin,
    Radian,
    Ratio,
    format_quantity,
)

MOST_BALLS = 200
ROOM: Kelvin = 293.0
"""Temperature at which parts are measured."""

_GROOVE = "If you have the groove radius, divide it by the ball diameter."
_MODULI = "Steel has about 200 GPa, PTFE 0.5 GPa."


class Expansion(NamedTuple):
    """Mean thermal expansion from 293 K to each temperature between two, and how sure it is."""

    low: Kelvin
    high: Kelvin
    mean: PerKelvin
    confidence: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """An isotropic elastic material and where its numbers come from."""

    name: str = field(metadata=must(_check.printable_text))
    elastic_modulus: Pascal = field(metadata=must(positive, 1e5, 5e12, hint=_MODULI))
    poisson_ratio: Ratio = field(metadata=must(between, 0.0, 0.5, open_high=True))
    density: KilogramPerMetre3 | None = field(default=None, metadata=must(positive, 1.0, 1e5))
    compressive_strength: Pascal | None = field(default=None, metadata=must(positive, 1e4, 1e11))
    thermal_expansion: PerKelvin | None = field(default=None, metadata=must(between, -1e-4, 1e-3))
    """Mean from 293 K to the operating temperature; None: that of `expansions`."""

    expansions: tuple[Expansion, ...] = ()
    """Of the library, by rising temperature."""

    source: str = "given in the study"
    confidence: str = "given in the study"
    record: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The whole record of the library behind it, as plain data: it goes into every result."""

    cautions: tuple[str, ...] = field(default=(), compare=False)
    """Limits of its numbers at the study's temperature, as sentences."""

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))


@dataclass(frozen=True, slots=True, kw_only=True)
class BallBearing:
    """Geometry and materials of a single-row ball bearing."""

    ball_diameter: Metre = field(metadata=must(positive, 1e-5, 10.0))
    pitch_diameter: Metre = field(metadata=must(positive, 1e-5, 100.0))
    ball_count: int = field(
        metadata=must(_check.whole, 3, MOST_BALLS, hint="Two balls cannot centre a ring.")
    )
    contact_angle: Radian = field(metadata=must(between, 0.0, math.pi / 2, open_high=True))
    inner_conformity: Ratio = field(metadata=must(between, 0.5, 0.6, open_low=True, hint=_GROOVE))
    outer_conformity: Ratio = field(metadata=must(between, 0.5, 0.6, open_low=True, hint=_GROOVE))
    ball_material: Material
    ring_material: Material
    bore: Metre | None = field(default=None, metadata=must(positive, 1e-6, 100.0))

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        _check.settle(_balls_that_do_not_fit(self))
        _check.settle(_bore_too_wide(self))

    @property
    def ball_gap(self) -> Metre:
        """Distance between the surfaces of neighbouring balls: chord of the pitch circle less a diameter."""
        return self.pitch_diameter * math.sin(math.pi / self.ball_count) - self.ball_diameter


def _balls_that_do_not_fit(bearing: BallBearing) -> _check.Problems:
    """More balls than the pitch circle holds: D must be less than the chord d_m sin(pi/Z)."""
    if bearing.ball_gap > 0.0:
        return
    most = 0
    if bearing.ball_diameter < bearing.pitch_diameter:
        most = math.ceil(math.pi / math.asin(bearing.ball_diameter / bearing.pitch_diameter)) - 1
    rule = f"must be at most {most}: more balls do not fit on the pitch circle"
    if most < 3:
        rule = "leaves no room: the balls are too large for the pitch circle"
    yield _check.problem(bearing, "ball_count", rule, "Check ball_count, ball_diameter and pitch_diameter.")


def _bore_too_wide(bearing: BallBearing) -> _check.Problems:
    """The bore lies inside the groove of the inner ring."""
    widest = bearing.pitch_diameter - bearing.ball_diameter
    if bearing.bore is not None and bearing.bore >= widest:
        rule = f"must be smaller than the groove bottom of the inner ring, {format_quantity(widest, 'm')}"
        yield _check.problem(bearing, "bore", rule)
