"""What is asked: one bearing, its operating point, film, cage and candidate cage materials. SI inside.

Every record is frozen and checks itself when built; what computes with it trusts it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from separatrix import _cage_rules, _check, _rules
from separatrix.distribution import Distribution
from separatrix.errors import InputError
from separatrix.measured_friction import FRICTION_LIMIT as FRICTION_LIMIT
from separatrix.measured_friction import Friction as Friction
from separatrix.units import (
    Kelvin,
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    KilogramPerMetre3,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    Newton,
    NewtonMetre,
    NewtonPerMetre,
    Pascal,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
)

MOST_BALLS = 200
LEAST_KICK: MetrePerSecond = 1e-9
"""Kicks are larger: the energy of a weaker one is lost in rounding."""

MOST_KICK: MetrePerSecond = 1e4
NO_KICK = "A kick of zero starts no motion."
_START_HINT = "It is the share of the speed at which the ramp begins; at rest the balls would not roll."


class Race(Enum):
    """One of the two raceways."""

    INNER = "inner"
    OUTER = "outer"


class KinematicModel(Enum):
    """How the ball's spin axis is found."""

    FREE = "free"
    OUTER_RACE_CONTROL = "outer race control"
    INNER_RACE_CONTROL = "inner race control"


class Guidance(Enum):
    """What guides the cage; BALL means it has no land."""

    OUTER = "outer"
    INNER = "inner"
    BALL = "ball"


class PocketShape(Enum):
    """Wall of a pocket, seen along the radius."""

    SQUARE = "square"
    CYLINDRICAL = "cylindrical"
    ELONGATED = "elongated"


class PocketContact(Enum):
    """How the force between ball and pocket grows: with the approach, or with its power 1.5."""

    LINEAR = "linear"
    HERTZ = "hertz"


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """An isotropic elastic material and where its numbers come from."""

    name: str
    elastic_modulus: Pascal
    poisson_ratio: Ratio
    density: KilogramPerMetre3 | None = None
    compressive_strength: Pascal | None = None
    source: str = "given in the study"
    confidence: str = "given in the study"
    record: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The whole record of the library behind it, as plain data: it goes into every result."""

    cautions: tuple[str, ...] = field(default=(), compare=False)
    """What must be said of its numbers at the study's temperature."""

    def __post_init__(self) -> None:
        _check.settle(
            _check.printable_text(self, "name"),
            _check.positive(
                self, "elastic_modulus", 1e5, 5e12, hint="Steel has about 200 GPa, PTFE 0.5 GPa."
            ),
            _check.between(self, "poisson_ratio", 0.0, 0.5, open_high=True),
            _check.positive(self, "density", 1.0, 1e5),
            _check.positive(self, "compressive_strength", 1e4, 1e11),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class BallBearing:
    """Geometry and materials of a single-row ball bearing."""

    ball_diameter: Metre
    pitch_diameter: Metre
    ball_count: int
    contact_angle: Radian
    inner_conformity: Ratio
    outer_conformity: Ratio
    ball_material: Material
    ring_material: Material
    bore: Metre | None = None

    def __post_init__(self) -> None:
        groove = "If you have the groove radius, divide it by the ball diameter."
        _check.settle(
            _check.positive(self, "ball_diameter", 1e-5, 10.0),
            _check.positive(self, "pitch_diameter", 1e-5, 100.0),
            _check.whole(self, "ball_count", 3, MOST_BALLS, hint="Two balls cannot centre a ring."),
            _check.between(self, "contact_angle", 0.0, math.pi / 2, open_high=True),
            _check.between(self, "inner_conformity", 0.5, 0.6, open_low=True, hint=groove),
            _check.between(self, "outer_conformity", 0.5, 0.6, open_low=True, hint=groove),
            _check.positive(self, "bore", 1e-6, 100.0),
        )
        _check.settle(_rules.balls_that_do_not_fit(self))
        _check.settle(_rules.bore_too_wide(self))

    @property
    def ball_gap(self) -> Metre:
        """Distance between the surfaces of neighbouring balls: chord of the pitch circle less a diameter."""
        return self.pitch_diameter * math.sin(math.pi / self.ball_count) - self.ball_diameter


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """Speeds and loads on the inner ring.

    The rings are held parallel, or at the angle `tilt`. With a `moment`, 0 included, the inner ring tilts
    until the balls balance it.
    """

    inner_speed: RadianPerSecond
    axial_load: Newton
    outer_speed: RadianPerSecond = 0.0
    radial_load: Newton = 0.0
    moment: NewtonMetre | None = None
    tilt: Radian | None = None
    temperature: Kelvin | None = None
    fluid: str | None = None
    ramp_time: Second = 0.0
    ramp_start: Ratio = 0.1

    def __post_init__(self) -> None:
        lifts = "A load the other way lifts the inner ring off its balls; turn the bearing round."
        _check.settle(
            _check.between(self, "inner_speed", -1e6, 1e6),
            _check.between(self, "outer_speed", -1e6, 1e6),
            _check.not_negative(self, "axial_load", 1e9, hint=lifts),
            _check.not_negative(self, "radial_load", 1e9, hint="Its direction is the x axis: give its size."),
            _check.between(self, "moment", -1e9, 1e9),
            _check.between(self, "tilt", -0.1, 0.1),
            _check.positive(self, "temperature", 1e-3, 5000.0),
            _check.printable_text(self, "fluid"),
            _check.not_negative(self, "ramp_time", 1e4, hint="Leave it out for a bearing at speed."),
            _check.between(self, "ramp_start", 0.0, 1.0, open_low=True, hint=_START_HINT),
        )
        _check.settle(_rules.moment_and_tilt(self), _rules.nothing_presses(self))

    @property
    def is_tilt_held(self) -> bool:
        """Whether the housing and shaft hold the rings at an angle; else the inner ring tilts freely."""
        return self.moment is None


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """Solid lubricant on the races; without material and thickness the races are bare."""

    race_friction: Ratio
    material: Material | None = None
    thickness: Metre | None = None

    def __post_init__(self) -> None:
        _check.settle(
            _check.between(self, "race_friction", 0.0, FRICTION_LIMIT),
            _check.positive(
                self, "thickness", 1e-10, 1e-2, hint="For bare races leave material and thickness out."
            ),
        )
        if (self.material is None) != (self.thickness is None):
            missing = "material" if self.material is None else "thickness"
            cure = "Give both, or neither for bare races."
            raise InputError(
                f"Film.{missing}", "is missing: a film needs its material and its thickness", cure=cure
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class CageDesign:
    """The cage: inertia, pockets and guidance."""

    mass: Kilogram
    pocket_clearance: Metre
    material: Material | None = None
    material_name: str | None = None
    """Candidate of the ranking that the cage is made of; by default the one named like `material`."""

    ball_cage_stiffness: NewtonPerMetre | None = None
    impact_speed: MetrePerSecond | None = None
    """Speed at which a Hertz pocket's stiffness is taken; by default 2.5 times the pocket speed."""

    ball_cage_friction: Ratio | None = None
    pocket_shape: PocketShape = PocketShape.SQUARE
    pocket_axial_clearance: Metre | None = None
    pocket_axial_offset: Metre = 0.0
    pocket_contact: PocketContact = PocketContact.LINEAR
    pocket_angles: tuple[Radian, ...] = ()
    pocket_spacing_scatter: Ratio = 0.0
    pocket_position_scatter: Metre = 0.0
    ball_diameter_scatter: Metre = 0.0
    guidance: Guidance = Guidance.BALL
    land_clearance: Metre | None = None
    land_friction: Ratio = 0.1
    land_stiffness: NewtonPerMetre = 1e7
    land_restitution: Ratio = 0.5
    land_count: int = 1
    land_out_of_round: Metre = 0.0
    land_lobes: int = 2
    moment_of_inertia: KilogramMetre2 | None = None
    unbalance: KilogramMetre = 0.0
    gravity: MetrePerSecond2 = 0.0

    def __post_init__(self) -> None:
        _check.settle(
            _check.positive(self, "mass", 1e-9, 1e4),
            _check.positive(self, "ball_cage_stiffness", 1.0, 1e12),
            _check.positive(self, "impact_speed", 1e-6, 1e3),
            _check.between(self, "ball_cage_friction", 0.0, FRICTION_LIMIT),
            _check.one_of(self, "pocket_contact", PocketContact),
            *_cage_rules.pocket_fields(self),
            *_cage_rules.land_fields(self),
            _check.positive(self, "land_clearance", 1e-9, 1.0),
            _check.between(self, "land_friction", 0.0, FRICTION_LIMIT),
            _check.positive(self, "land_stiffness", 1.0, 1e12),
            _check.positive(self, "moment_of_inertia", 1e-18, 1e4),
            _check.not_negative(self, "unbalance", 1e2),
            _check.not_negative(self, "gravity", 1e4),
        )
        gripped = self.pocket_contact is PocketContact.HERTZ
        _check.settle(_rules.land(self), *_cage_rules.together(self, hertz=gripped))


def evenly_spaced(low: float, high: float, count: int) -> tuple[float, ...]:
    """`count` numbers from `low` to `high`, both included, rounded to 12 decimals so that 0.15 is 0.15."""
    steps = count - 1
    return tuple(round((low * (steps - i) + high * i) / steps, 12) for i in range(count))


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilitySettings:
    """The ensemble behind every verdict, and the curve's restitution factors; without any they are chosen.

    Without kicks they scale with the bearing; `cage.settings_for` puts numbers in their place.
    """

    kicks: tuple[MetrePerSecond, ...] = ()
    reference_kick: MetrePerSecond | None = None
    """The kick of critical friction and threshold, and what default kicks scale with."""

    runs: int = 64
    duration: Second = 0.3
    ball_scatter: Ratio = 0.3
    restitution_factors: tuple[Ratio, ...] = ()
    seed: int = 1

    def __post_init__(self) -> None:
        _check.settle(
            _rules.rising(self, "kicks", LEAST_KICK, MOST_KICK, least=0, most=20, hint=NO_KICK),
            _check.positive(self, "reference_kick", 1e-6, 1e3, hint=NO_KICK),
            _check.whole(self, "runs", 1, 1_000_000),
            _check.positive(self, "duration", 1e-9, 1e4, hint="Some tenths of a second show the motion."),
            _check.between(self, "ball_scatter", 0.0, 1.0),
            _rules.rising(self, "restitution_factors", 0.0, 1.0, least=0, most=1000),
            _check.whole(self, "seed", 0, 2**63 - 1),
        )

    @property
    def middle_kick(self) -> MetrePerSecond:
        """The reference kick of settings whose defaults have numbers (`cage.settings_for`)."""
        if self.reference_kick is None:
            raise InputError("StabilitySettings.reference_kick", "is not known before the cage's speed is")
        return self.reference_kick


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A candidate cage material with its friction in each environment; None where it was not measured."""

    name: str
    friction: Mapping[str, Friction | None]
    material: Material | None = None

    def __post_init__(self) -> None:
        _check.settle(_check.printable_text(self, "name"), _rules.nothing_measured(self))


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingQuestion:
    """Which candidates to rank, in which environments."""

    environments: tuple[str, ...]
    candidates: tuple[Candidate, ...]
    environment: str | None = None
    """The bearing's own: the headline of a ranking, and the column of the cage's friction."""

    friction_scatter: Ratio = 0.09
    """Standard deviation that an unrepeated test is assumed to have, as a share of its mean: a guess."""

    def __post_init__(self) -> None:
        _check.settle(
            _check.between(self, "friction_scatter", 1e-3, 1.0, hint="0.09 stands for 9 %."),
        )
        _check.settle(
            _rules.named_twice(self),
            _rules.unknown_environments(self),
            _rules.environment_of_a_candidate(self),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Everything that was asked, resolved: library names are replaced by their records."""

    name: str
    title: str
    bearing: BallBearing
    operation: Operation
    film: Film
    kinematics: KinematicModel = KinematicModel.FREE
    cage: CageDesign | None = None
    stability: StabilitySettings = field(default_factory=StabilitySettings)
    ranking: RankingQuestion | None = None
    origins: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)
    """Where each value was given: "bearing.ball_diameter" to "case.toml, line 4"; the absent are defaults."""
    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    """What is known of uncertain numbers, by their names (`study_numbers`); the records hold the means."""

    records: Mapping[str, Any] = field(default_factory=dict, compare=False, repr=False)
    """Whole records of the library that are no material: "operation.fluid", "ranking.friction"."""

    def __post_init__(self) -> None:
        _check.settle(
            _check.printable_text(self, "name"),
            _check.printable_text(self, "title"),
            _rules.no_density(self),
            _rules.free_kinematics_without_friction(self),
            _rules.pockets_that_overlap(self),
            _rules.pockets_for_balls(self),
            _rules.land_wider_than_a_ball(self),
            _rules.unbalance_beyond_the_cage(self),
            _rules.stiffness_of_unknown_origin(self),
        )
