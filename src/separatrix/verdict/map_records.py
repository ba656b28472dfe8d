"""What a stability map can vary, and its records: question, points, bands between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated

from separatrix.ground.errors import InputError
from separatrix.ground.schema import keys_of
from separatrix.ground.units import Metre, MetrePerSecond, Newton, PerSecond, Ratio, Rows, Second
from separatrix.study.keys import SECTIONS, SETTINGS, WHOLE, numbers_of, with_values
from separatrix.study.study import Film, Study, Wear
from separatrix.verdict.judgement import Verdict

RESTITUTION, FRICTION, KICK = "restitution_factor", "ball_cage_friction", "kick"
RACE_FRICTION = "film.race_friction"
THICKNESS = "film.thickness"  # of a film; a map may begin at 0, where the races are bare
SHORT = {"cage.ball_cage_friction": FRICTION}  # so that one parameter has one name
LONG = {name: key for key, name in SHORT.items()}
_OF_FILM = ("film.elastic_modulus", "film.poisson_ratio")


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that a map varies: its name in a study file, and the SI unit it is written in."""

    name: str  # as in a study file
    unit: str  # in which values are written, SI

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers only."""
        return self.unit == WHOLE


def parameters() -> dict[str, Parameter]:
    """Every parameter a map can vary, by name."""
    names = {RESTITUTION: "-", FRICTION: "-", KICK: "m/s"}
    for section, record in SECTIONS.items():
        names |= {f"{section}.{key}": unit for key, unit in numbers_of(record).items()}
    names |= {f"film.wear.{key}": unit for key, unit in numbers_of(Wear).items()}
    left = {name: unit for name, unit in names.items() if name not in (*SETTINGS, *SHORT)}
    return {name: Parameter(name, unit) for name, unit in left.items()}


def other_keys() -> list[str]:
    """Keys of a study that no map can vary: texts, lists, and how the ensemble is drawn."""
    known = parameters()
    keys = [f"{section}.{name}" for section, record in SECTIONS.items() for name in keys_of(record)]
    return [key for key in keys if key not in known and key not in SHORT]


def varied(study: Study, values: Mapping[str, float]) -> Study:
    """Return the study with other values of some parameters, all at once; `InputError` if it is refused.

    Restitution factor and kick are not keys of a study; the map gives them to the cage and to its runs. A
    film of zero thickness is bare races.
    """
    keys = {LONG.get(name, name): value for name, value in values.items() if name not in (RESTITUTION, KICK)}
    for key in keys:
        section = key.partition(".")[0]
        if key in _OF_FILM and study.film.body is None:
            raise InputError("[film]", "has no material whose properties could vary")
        if key.startswith("film.wear.") and study.film.wear is None:
            raise InputError("[film]", "has no wear that could vary")
        if getattr(study, section, study) is None:
            raise InputError(f"[{section}]", "is missing")
    if keys.get(THICKNESS) == 0.0:
        keys = {
            key: value for key, value in keys.items() if not key.startswith("film.") or key == RACE_FRICTION
        }
        study = replace(study, film=Film(race_friction=study.film.race_friction))
    return with_values(study, keys) if keys else study


def value_in(study: Study, name: str) -> float | None:
    """Value of a key in the study; None where it has none, or is not one of its keys."""
    value: object = study
    for step in name.split("."):
        value = getattr(value, step, None)
    return value if isinstance(value, int | float) else None


NOT_RUN = "not run"


class State(Enum):
    """What became of a point of a map."""

    RUN = "run"
    REFUSED = "refused"
    INFERRED = "inferred: the points around it agree"
    NOT_RUN = "not run, for an interrupt"


SETTLES, WHIRLS, EITHER = -1, 1, 0  # side of one half on which P(whirl) lies


def side(low: Ratio | None, high: Ratio | None) -> int:
    """Return the side of one half on which the interval of P(whirl) lies: SETTLES, WHIRLS, or EITHER."""
    if low is None or high is None:
        return EITHER
    return WHIRLS if low > 0.5 else SETTLES if high < 0.5 else EITHER


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAxis:
    """One parameter of a map: its name and SI unit, its rising values, and its value in the study."""

    parameter: str  # its name in a study file
    unit: str  # of the values, SI
    values: tuple[float, ...]  # rising
    here: float | None = None  # its value in the study; null if there is none


@dataclass(frozen=True, slots=True, kw_only=True)
class MapPoint:
    """Result of the runs at one point of a map; None where it could not be run, with the reason."""

    x: float  # value of the parameter x, SI
    y: float  # value of the parameter y, SI
    state: State = State.NOT_RUN  # whether it was run, refused, inferred or left out
    decision: Verdict | None = None  # by the rule of `cage.judge`, from the runs that were made
    probability_whirl: Ratio | None = None  # share of the runs that whirl
    probability_low: Ratio | None = None  # lower end of its 95 % Wilson interval
    probability_high: Ratio | None = None  # upper end of its 95 % Wilson interval
    runs: int = 0  # that were made
    whirling: int = 0  # runs that whirl
    growth_rate: PerSecond | None = None  # median over the runs
    largest_offset: Metre | None = None  # of the cage centre in any run
    drift_rate: PerSecond | None = None  # median over the runs
    largest_contact_force: Newton | None = None  # between a ball and its pocket in any run
    restitution_factor: Ratio | None = None  # of the chain at this point, or of the axis
    margin: float | None = None
    """Distance along y to the nearest change of its column, positive where the motion settles, negative where
    it whirls, 0 in the band; null in a column that does not change."""
    inferred_decision: Verdict | None = None  # of the points around it, which an adaptive map did not run
    reason: str = NOT_RUN  # of the decision, or why there is none
    notes: tuple[str, ...] = ()  # where its chain leaves the range of a model, a sentence each

    @property
    def side(self) -> int:
        """Whether more than half of the runs whirl (1), settle (-1), or neither is sure (0)."""
        return side(self.probability_low, self.probability_high)


@dataclass(frozen=True, slots=True, kw_only=True)
class MapChange:
    """Between these two neighbouring decided points of a column the motion changes from rest to a whirl."""

    x: float  # value of x in this column
    y_low: float  # last point below the change
    y_high: float  # first point above the change
    whirls_above: bool  # whether the cage whirls above the band, or below it
    margin: float | None = None
    """Distance of the study's own y to this band, negative where it whirls; null if the study has none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stopping:
    """When a point is ended early, and how often that is wrong at the worst."""

    most_runs: int  # of a point
    agreeing_runs: int
    """A point ends once this number of first runs agree, or once the others cannot change its answer."""
    wrong_side_probability: Ratio  # largest, over all points, that all the runs would have the other majority
    other_decision_probability: Ratio
    """Largest that all the runs would decide otherwise: of a point all but decided."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inference:
    """How often an adaptive map is wrong about a point that it did not run, counted in this map."""

    points: int  # points that were not run, because those around them agree
    checked: int  # points evenly taken from those and run nevertheless
    decided_otherwise: int  # of these, with another decision
    error_low: Ratio | None  # lower end of the 95 % Wilson interval of that share; null if none was checked
    error_high: Ratio | None  # upper end of it


@dataclass(frozen=True, slots=True, kw_only=True)
class MapQuestion:
    """The question of a map."""

    study: Study  # with a [cage]
    x: MapAxis  # another parameter than y
    y: MapAxis
    kick: MetrePerSecond  # initial disturbance of every point, unless an axis has it
    runs: int = 16  # most runs of a point
    adaptive: bool = False  # only points near a change of the answer are run, and a sample of the others


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityMap:
    """A map: its points, column after column of x, and the bands in which the answer changes."""

    x: MapAxis  # horizontal axis
    y: MapAxis  # vertical axis
    points: Annotated[tuple[MapPoint, ...], Rows("point", "point_")]  # column after column of x
    changes: Annotated[tuple[MapChange, ...], Rows("change", "change_")]
    """Bands between motion that settles and a whirl."""
    counts: Annotated[Mapping[str, int], Rows(prefix="points_")]
    """Points of each decision, refused, inferred, not run."""
    kick: MetrePerSecond  # initial disturbance of every point, unless an axis has it
    stopping: Stopping  # when a point is ended early
    inference: Inference | None  # errors of the points that were not run; null if all were
    duration: Second  # of a run
    ball_scatter: Ratio  # initial lead or lag of the balls, over half the pocket clearance
    adaptive: bool  # whether only points near a change were run
    complete: bool  # false if an interrupt left points out
