"""What is asked: one bearing, its operating point, film, cage and candidate cage materials. SI inside.

Every record is frozen and checks itself when built; what computes with it trusts it. A number may be given
as text with its unit, ``CageDesign(mass="25 g", ...)``: the record holds it in SI.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from separatrix.friction.prediction import FRICTION_LIMIT as FRICTION_LIMIT
from separatrix.friction.prediction import Friction as Friction
from separatrix.ground import bounds as _check
from separatrix.ground.bounds import between, increasing, must, not_negative, positive, whole
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Kelvin,
    MetrePerSecond,
    Newton,
    NewtonMetre,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    shown,
)
from separatrix.study.ball_bearing import MOST_BALLS as MOST_BALLS
from separatrix.study.ball_bearing import BallBearing as BallBearing
from separatrix.study.ball_bearing import Material as Material
from separatrix.study.cage_design import BallModel as BallModel
from separatrix.study.cage_design import CageDesign as CageDesign
from separatrix.study.cage_design import ClearanceState as ClearanceState
from separatrix.study.cage_design import Guidance as Guidance
from separatrix.study.cage_design import MotionModel as MotionModel
from separatrix.study.cage_design import PocketContact as PocketContact
from separatrix.study.cage_in_bearing import cage_in_bearing, pockets_for_balls
from separatrix.study.distribution import Distribution
from separatrix.study.film import ContactPressure as ContactPressure
from separatrix.study.film import Film as Film
from separatrix.study.film import PressureSlip as PressureSlip
from separatrix.study.film import TractionModel as TractionModel
from separatrix.study.film import TractionSettings as TractionSettings
from separatrix.study.film import Wear as Wear
from separatrix.study.film import Worn as Worn
from separatrix.study.pocket_shape import PocketShape as PocketShape

LEAST_KICK: MetrePerSecond = 1e-9
"""Kicks are larger: the energy of a weaker one is lost in rounding."""

MOST_KICK: MetrePerSecond = 1e4
NO_KICK = "A kick of zero starts no motion."
_LIFTS = "A load the other way lifts the inner ring off its balls; turn the bearing round."
_START = "It is the share of the speed at which the ramp begins; at rest the balls would not roll."


class Race(Enum):
    """One of the two raceways."""

    INNER = "inner"
    OUTER = "outer"


class KinematicModel(Enum):
    """How the ball's spin axis is found."""

    FREE = "free"
    OUTER_RACE_CONTROL = "outer race control"
    INNER_RACE_CONTROL = "inner race control"


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """Speeds and loads on the inner ring.

    The rings are held parallel, or at the angle `tilt`. With a `moment`, 0 included, the inner ring tilts
    until the balls balance it.
    """

    inner_speed: RadianPerSecond = field(metadata=must(between, -1e6, 1e6))
    axial_load: Newton = field(metadata=must(not_negative, 1e9, hint=_LIFTS))
    outer_speed: RadianPerSecond = field(default=0.0, metadata=must(between, -1e6, 1e6))
    radial_load: Newton = field(
        default=0.0, metadata=must(not_negative, 1e9, hint="Its direction is the x axis: give its size.")
    )
    moment: NewtonMetre | None = field(default=None, metadata=must(between, -1e9, 1e9))
    tilt: Radian | None = field(default=None, metadata=must(between, -0.1, 0.1))
    temperature: Kelvin | None = field(default=None, metadata=must(positive, 1e-3, 5000.0))
    fluid: str | None = field(default=None, metadata=must(_check.printable_text))
    ramp_time: Second = field(
        default=0.0, metadata=must(not_negative, 1e4, hint="Leave it out for a bearing at speed.")
    )
    ramp_start: Ratio = field(default=0.1, metadata=must(between, 0.0, 1.0, open_low=True, hint=_START))

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        _check.settle(_loads(self))

    @property
    def is_tilt_held(self) -> bool:
        """Whether the housing and shaft hold the rings at an angle; else the inner ring tilts freely."""
        return self.moment is None


def _loads(operation: Operation) -> _check.Problems:
    """A held tilt takes any moment; without a load, even with a tilt, nothing is pressed together."""
    if operation.tilt is not None and operation.moment is not None:
        yield _check.problem(operation, "tilt", "and moment exclude each other", "Give one of the two.")
    if not any((operation.axial_load, operation.radial_load, operation.moment)):
        rule = "must be > 0 when there is no radial load or moment: nothing presses the balls"
        yield _check.problem(operation, "axial_load", rule, "Give the preload.")


def evenly_spaced(low: float, high: float, count: int) -> tuple[float, ...]:
    """`count` numbers from `low` to `high`, both included, rounded to 12 decimals so that 0.15 is 0.15."""
    steps = count - 1
    return tuple(round((low * (steps - i) + high * i) / steps, 12) for i in range(count))


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilitySettings:
    """The ensemble behind every verdict, and the curve's restitution factors; without any they are chosen.

    Without kicks they scale with the bearing; `cage.settings_for` puts numbers in their place.
    """

    kicks: tuple[MetrePerSecond, ...] = field(
        default=(), metadata=must(increasing, LEAST_KICK, MOST_KICK, most=20, hint=NO_KICK)
    )
    reference_kick: MetrePerSecond | None = field(
        default=None, metadata=must(positive, 1e-6, 1e3, hint=NO_KICK)
    )
    """The kick of critical friction and threshold, and what default kicks scale with."""

    runs: int = field(default=64, metadata=must(whole, 1, 1_000_000))
    duration: Second = field(
        default=0.3, metadata=must(positive, 1e-9, 1e4, hint="Some tenths of a second show the motion.")
    )
    ball_scatter: Ratio = field(default=0.3, metadata=must(between, 0.0, 1.0))
    axial_kick: Ratio = field(default=0.0, metadata=must(between, 0.0, 10.0))
    """Speed along the axis at the start of a run in space, over its kick."""

    tilt_kick: Ratio = field(default=0.0, metadata=must(between, 0.0, 10.0))
    """Speed of the rim by tilting at the start of a run in space, over its kick."""

    restitution_factors: tuple[Ratio, ...] = field(default=(), metadata=must(increasing, 0.0, 1.0, most=1000))
    seed: int = field(default=1, metadata=must(whole, 0, 2**63 - 1))

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))

    @property
    def middle_kick(self) -> MetrePerSecond:
        """The reference kick of settings whose defaults have numbers (`cage.settings_for`)."""
        if self.reference_kick is None:
            raise InputError("StabilitySettings.reference_kick", "is not known before the cage's speed is")
        return self.reference_kick


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A candidate cage material with its friction in each environment; None where it was not measured."""

    name: str = field(metadata=must(_check.printable_text))
    friction: Mapping[str, Friction | None]
    material: Material | None = None

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        if all(value is None for value in self.friction.values()):
            raise InputError("Candidate.friction", f'of "{self.name}" has no measured value')


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingQuestion:
    """Which candidates to rank, in which environments."""

    environments: tuple[str, ...]
    candidates: tuple[Candidate, ...]
    environment: str | None = None
    """The bearing's own: the headline of a ranking, and the column of the cage's friction."""

    friction_scatter: Ratio = field(default=0.09, metadata=must(between, 1e-3, 1.0, hint="0.09 is 9 %."))
    """Standard deviation that an unrepeated test is assumed to have, as a share of its mean: a guess."""

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        _check.settle(_names_of_question(self))


def _names_of_question(question: RankingQuestion) -> _check.Problems:
    """Results are keyed by names, so these differ; every environment is one of the question."""
    for key, names in (
        ("candidates", [candidate.name for candidate in question.candidates]),
        ("environments", list(question.environments)),
    ):
        if not names:
            yield InputError(f"RankingQuestion.{key}", "must not be empty")
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield InputError(f"RankingQuestion.{key}", "must have different names", f'"{name}" twice')
    for candidate in question.candidates:
        for name in sorted(set(candidate.friction) - set(question.environments)):
            rule = f'of "{candidate.name}" must be in the environments of the question'
            yield InputError("RankingQuestion.candidates", rule, f'"{name}"')
    if question.environment is not None and question.environment not in question.environments:
        cure = f"Known: {'; '.join(question.environments)}."
        rule = "must be one in which candidates were measured"
        yield InputError("RankingQuestion.environment", rule, shown(question.environment), cure)


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Everything that was asked, resolved: library names are replaced by their records."""

    name: str = field(metadata=must(_check.printable_text))
    title: str = field(metadata=must(_check.printable_text))
    bearing: BallBearing
    operation: Operation
    film: Film
    kinematics: KinematicModel = KinematicModel.FREE
    traction: TractionSettings = field(default_factory=TractionSettings)
    cage: CageDesign | None = None
    stability: StabilitySettings = field(default_factory=StabilitySettings)
    ranking: RankingQuestion | None = None
    origins: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)
    """Where each value was given: "bearing.ball_diameter" to "case.toml, line 4"; the absent are defaults."""

    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    """Distributions of uncertain inputs by name (`study_numbers`); the records hold the means."""

    records: Mapping[str, Any] = field(default_factory=dict, compare=False, repr=False)
    """Whole records of the library that are not materials: "operation.fluid", "ranking.friction"."""

    def __post_init__(self) -> None:
        checks = [_check.each_field(self), _turning_balls(self), _stiffness_of_unknown_origin(self)]
        checks.append(_coated_pressure(self))
        if self.cage is not None:
            checks += [cage_in_bearing(self.cage, self.bearing), pockets_for_balls(self.cage, self.bearing)]
        _check.settle(*checks)


def _turning_balls(study: Study) -> _check.Problems:
    """A turning ball needs its density, and without race control it is friction that turns it."""
    turns = study.operation.inner_speed != 0.0 or study.operation.outer_speed != 0.0
    if turns and study.bearing.ball_material.density is None:
        rule = "needs a density, for the centrifugal force of the balls"
        yield InputError("BallBearing.ball_material", rule, cure='Add density = "7650 kg/m3" or the like.')
    if study.kinematics is KinematicModel.FREE and study.film.race_friction == 0.0:
        cure = "Without friction nothing turns the balls; choose a race control model."
        yield InputError("Film.race_friction", 'must be > 0 for the "free" kinematics', "0", cure)


def _coated_pressure(study: Study) -> _check.Problems:
    """The pressure of coated contacts is that of a whole film."""
    if study.traction.pressure is ContactPressure.COATED and study.film.wear is not None:
        rule = 'must be "hertz" where the film is worn: a film whose thickness varies is in series'
        yield InputError("TractionSettings.pressure", rule, '"coated"')


def _stiffness_of_unknown_origin(study: Study) -> _check.Problems:
    """Without a stiffness, the cage or every candidate needs a material, for the modulus of the pocket."""
    cage, candidates = study.cage, study.ranking.candidates if study.ranking else ()
    if cage is None or cage.ball_cage_stiffness is not None or cage.material is not None:
        return
    bare = [candidate.name for candidate in candidates if candidate.material is None]
    if bare or not candidates:
        who = f'the candidate "{bare[0]}"' if bare else "the cage"
        rule = f"is missing, and {who} has no material to compute it from"
        yield InputError("CageDesign.ball_cage_stiffness", rule, cure="Give the stiffness or the material.")


def chosen_models(models: Mapping[str, str]) -> dict[str, Enum]:
    """Models of a cage by the keys of a study file, `motion` and `ball`, as the command line names them.

    Raises
    ------
    InputError
        A model is not known.
    """
    chosen: dict[str, Enum] = {}
    for name, kind in (("motion", MotionModel), ("ball", BallModel)):
        known = {str(one.value): one for one in kind}
        if name in models and models[name] not in known:
            raise InputError(f"--{name}", f"must be one of {', '.join(known)}", shown(models[name]))
        if name in models:
            chosen[name] = known[models[name]]
    return chosen


def with_models(study: Study, models: Mapping[str, str]) -> Study:
    """Return the study with other models of its cage.

    Raises
    ------
    InputError
        A model is not known, or the cage cannot have it.
    """
    chosen = chosen_models(models)
    if study.cage is None:
        raise InputError(study.name, "lacks the section [cage]")
    origins = {f"cage.{name}": f"--{name} {value.value}" for name, value in chosen.items()}
    cage = replace(study.cage, **chosen)  # type: ignore[arg-type]  # the enums of these fields
    return replace(study, cage=cage, origins={**study.origins, **origins})


SECTIONS: dict[str, type] = {
    "bearing": BallBearing,
    "operation": Operation,
    "film": Film,
    "traction": TractionSettings,
    "cage": CageDesign,
    "stability": StabilitySettings,
}
"""Sections of a study file whose keys are the fields of a record."""

_HEAD_OF = {record.__name__: f"[{section}] " for section, record in SECTIONS.items()} | {
    "RankingQuestion": "[ranking] ",
    "Friction": "[ranking] ",
    "Wear": "[film] wear.",
}


def key_of(path: str) -> str:
    """Name in a study file of a field of a record: ``CageDesign.mass`` is ``[cage] mass``."""
    record, _, key = path.partition(".")
    return f"{_HEAD_OF[record]}{key}" if record in _HEAD_OF else path
