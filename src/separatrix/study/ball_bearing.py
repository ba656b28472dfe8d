"""The bearing of a study: its materials and its geometry, the schema of [bearing]."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from typing import Any, ClassVar, NamedTuple

from separatrix.ground.schema import Fault, Faults, between, check, key, one_of, positive, record
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
MODULI = "Steel has about 200 GPa, PTFE 0.5 GPa."


class Expansion(NamedTuple):
    """Mean thermal expansion from 293 K to each temperature between two, and how sure it is."""

    low: Kelvin
    high: Kelvin
    mean: PerKelvin
    confidence: str


NAMELESS = "given in the study"
"""Name of a material in place that has none."""

MODULUS = positive(1e5, 5e12)
POISSON = between(0.0, 0.5, open_high=True)


@record
class Material:
    """An isotropic elastic material and where its numbers come from."""

    elastic_modulus: Pascal = key(MODULUS, hint=MODULI, example='"200 GPa"')
    poisson_ratio: Ratio = key(POISSON, example="0.285")
    density: KilogramPerMetre3 | None = key(positive(1.0, 1e5), default=None, example='"7650 kg/m3"')
    thermal_expansion: PerKelvin | None = key(between(-1e-4, 1e-3), default=None)
    """Mean from 293 K to the operating temperature; without it that of the library."""

    compressive_strength: Pascal | None = key(positive(1e4, 1e11), default=None, certain=True)
    name: str = key(default=NAMELESS)
    source: str = key(default=NAMELESS, letters=(1, 20_000))
    confidence: str = key(default=NAMELESS, letters=(1, 2000))
    expansions: tuple[Expansion, ...] = ()
    """Of the library, by rising temperature."""

    record: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The whole record of the library behind it, as plain data: it goes into every result."""

    cautions: tuple[str, ...] = field(default=(), compare=False)
    """Limits of its numbers at the study's temperature, as sentences."""


GEOMETRY = (
    *("bore", "ball_count", "ball_diameter", "pitch_diameter", "contact_angle", "radial_clearance"),
    *("inner_conformity", "outer_conformity"),
)
"""Keys that a designation may fill; one in a variant replaces those of the study that it extends."""


@record
class BallBearing:
    """Geometry and materials of a single-row ball bearing."""

    RULES: ClassVar = (one_of("contact_angle", "radial_clearance", required=True),)
    REPLACED: ClassVar = {"designation": GEOMETRY}

    designation: str | None = key(default=None, without="not given: the geometry is")
    """Name of a bearing of the library, which fills the geometry below as far as its source states it."""

    ball_diameter: Metre = key(positive(1e-5, 10.0), example='"11.1125 mm"')
    pitch_diameter: Metre = key(positive(1e-5, 100.0), example='"65 mm"')
    """Of the circle through the centres of the balls."""

    ball_count: int = key(between(3, MOST_BALLS), hint="Two balls cannot centre a ring.", example="13")
    contact_angle: Radian | None = key(
        between(0.0, math.pi / 2, open_high=True), default=None, example='"25 deg"'
    )
    """Without load; or give radial_clearance."""

    radial_clearance: Metre | None = key(default=None, without="not given: contact_angle is")
    """Diametral, without load; gives the angle acos(1 - clearance / (2 (f_i + f_o - 1) D))."""

    inner_conformity: Ratio = key(between(0.5, 0.6, open_low=True), hint=_GROOVE, example="0.52")
    """Groove radius over ball diameter."""

    outer_conformity: Ratio = key(between(0.5, 0.6, open_low=True), hint=_GROOVE, example="0.52")
    bore: Metre | None = key(
        positive(1e-6, 100.0),
        default=None,
        example='"50 mm"',
        without="not given; only the DN figure needs it",
    )
    ball_material: Material = key(named="bearing material", example='"440C"')
    ring_material: Material = key(named="bearing material", example='"440C"')
    record: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The library's whole record of the designation."""

    @property
    def free_angle(self) -> Radian:
        """Contact angle without load: cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D)."""
        if self.contact_angle is not None:
            return self.contact_angle
        return 2.0 * math.asin(math.sqrt(0.5 * (self.radial_clearance or 0.0) / self._room))

    @property
    def free_clearance(self) -> Metre:
        """Diametral play of the bearing without load, P_d = 2 (f_i + f_o - 1) D (1 - cos(angle))."""
        if self.radial_clearance is not None:
            return self.radial_clearance
        return 2.0 * self._room * math.sin(0.5 * (self.contact_angle or 0.0)) ** 2

    @property
    def _room(self) -> Metre:
        return _room(self.ball_diameter, self.inner_conformity, self.outer_conformity)

    @property
    def ball_gap(self) -> Metre:
        """Distance between the surfaces of neighbouring balls: chord of the pitch circle less a diameter."""
        return self.pitch_diameter * math.sin(math.pi / self.ball_count) - self.ball_diameter


def _room(ball_diameter: Metre, inner_conformity: Ratio, outer_conformity: Ratio) -> Metre:
    return 2.0 * (inner_conformity + outer_conformity - 1.0) * ball_diameter


@check(BallBearing)
def _clearance_below_that_of_90_degrees(
    radial_clearance: Metre, ball_diameter: Metre, inner_conformity: Ratio, outer_conformity: Ratio
) -> Faults:
    room = _room(ball_diameter, inner_conformity, outer_conformity)
    if not 0.0 <= radial_clearance < room:
        most = format_quantity(room, "m")
        rule = f"must be >= 0 and < {most}, where the free contact angle reaches 90 deg"
        yield Fault("radial_clearance", rule)


@check(BallBearing)
def _balls_that_fit(ball_diameter: Metre, pitch_diameter: Metre, ball_count: int) -> Faults:
    """More balls than the pitch circle holds: D must be less than the chord d_m sin(pi/Z)."""
    if pitch_diameter * math.sin(math.pi / ball_count) > ball_diameter:
        return
    most = 0
    if ball_diameter < pitch_diameter:
        most = math.ceil(math.pi / math.asin(ball_diameter / pitch_diameter)) - 1
    rule = f"must be at most {most}: more balls do not fit on the pitch circle"
    if most < 3:
        rule = "leaves no room: the balls are too large for the pitch circle"
    yield Fault("ball_count", rule, "Check ball_count, ball_diameter and pitch_diameter.")


@check(BallBearing)
def _bore_inside_the_groove(bore: Metre, pitch_diameter: Metre, ball_diameter: Metre) -> Faults:
    widest = pitch_diameter - ball_diameter
    if bore >= widest:
        rule = f"must be smaller than the groove bottom of the inner ring, {format_quantity(widest, 'm')}"
        yield Fault("bore", rule)
