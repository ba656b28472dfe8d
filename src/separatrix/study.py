"""What is asked: one bearing, its operating point, film, cage and candidate cage materials. SI inside.

Every record is frozen and checks itself when built; what computes with it trusts it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """An isotropic elastic material and where its numbers come from."""

    name: str
    elastic_modulus: Pascal
    poisson_ratio: Ratio
    density: KilogramPerMetre3 | None = None
    source: str = "given in the study"
    confidence: str = "given in the study"


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """Speeds and loads on the inner ring. With `tilt` the rings are held at that angle and `moment` is 0."""

    inner_speed: RadianPerSecond
    axial_load: Newton
    outer_speed: RadianPerSecond = 0.0
    radial_load: Newton = 0.0
    moment: NewtonMetre = 0.0
    tilt: Radian | None = None
    temperature: Kelvin | None = None
    fluid: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """Solid lubricant on the races; without material and thickness the races are bare."""

    race_friction: Ratio
    material: Material | None = None
    thickness: Metre | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CageDesign:
    """The cage: inertia, pockets and guidance."""

    mass: Kilogram
    pocket_clearance: Metre
    material: Material | None = None
    ball_cage_stiffness: NewtonPerMetre | None = None
    ball_cage_friction: Ratio | None = None
    guidance: Guidance = Guidance.BALL
    land_clearance: Metre | None = None
    land_friction: Ratio = 0.1
    land_stiffness: NewtonPerMetre = 1e7
    land_restitution: Ratio = 0.5
    moment_of_inertia: KilogramMetre2 | None = None
    unbalance: KilogramMetre = 0.0
    gravity: MetrePerSecond2 = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilitySettings:
    """The ensemble behind every verdict, and the grid of the stability curve."""

    kicks: tuple[MetrePerSecond, ...] = (0.1, 0.5, 2.0)
    runs: int = 64
    duration: Second = 0.3
    ball_scatter: Ratio = 0.3
    restitution_factors: tuple[Ratio, ...] = tuple(0.05 * i for i in range(1, 20))
    seed: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Friction:
    """A measured ball/cage friction: its mean and, if known, its scatter."""

    mean: Ratio
    standard_deviation: Ratio | None = None
    count: int | None = None
    source: str = "given in the study"


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A candidate cage material with its friction in each environment; None where it was not measured."""

    name: str
    friction: Mapping[str, Friction | None]
    material: Material | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingQuestion:
    """Which candidates to rank, in which environments."""

    environments: tuple[str, ...]
    candidates: tuple[Candidate, ...]


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
