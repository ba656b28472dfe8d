"""Records of a stability map: what is asked, its points, the bands between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from separatrix.cage import Verdict
from separatrix.errors import InputError
from separatrix.limits.map_rule import side
from separatrix.study import Study
from separatrix.units import Metre, MetrePerSecond, Newton, PerSecond, Ratio, Rows, Second

NOT_RUN = "not run"


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAxis:
    """One parameter of a map: its name and SI unit, its rising values, and its value in the study."""

    parameter: str  # its name in a study file
    unit: str  # of the values, SI
    values: tuple[float, ...]  # rising
    here: float | None = None  # its value in the study; null if there is none


@dataclass(frozen=True, slots=True, kw_only=True)
class MapPoint:
    """What the runs at one point of a map say; None where it could not be run, with the reason.

    Attributes
    ----------
    x, y : float
        Values of the two parameters [SI].
    decision : Verdict or None
        By the rule of `cage.judge`, from the runs that were made.
    probability_whirl, probability_low, probability_high : float or None
        Share of the runs that whirl, and its 95 % Wilson interval [-].
    runs, whirling : int
        Runs that were made, and those among them that whirl.
    growth_rate : float or None
        Median over the runs [1/s].
    largest_offset, largest_contact_force : float or None
        Of the cage centre [m], and between a ball and its pocket [N], in any run as far as it was run.
    drift_rate : float or None
        Median over the runs [1/s].
    restitution_factor : float or None
        Eta of the chain at this point, or that of the axis [-].
    margin : float or None
        Distance along y to the nearest band in which the column changes from motion that settles to a
        whirl, in the unit of y: positive where it settles, negative where it whirls, 0 in the band; None in
        a column that does not change.
    inferred_decision : Verdict or None
        Decision of the points around it, where an adaptive map did not run it.
    reason : str
        Of the decision, or why there is none.
    """

    x: float
    y: float
    decision: Verdict | None = None
    probability_whirl: Ratio | None = None
    probability_low: Ratio | None = None
    probability_high: Ratio | None = None
    runs: int = 0
    whirling: int = 0
    growth_rate: PerSecond | None = None
    largest_offset: Metre | None = None
    drift_rate: PerSecond | None = None
    largest_contact_force: Newton | None = None
    restitution_factor: Ratio | None = None
    margin: float | None = None
    inferred_decision: Verdict | None = None
    reason: str = NOT_RUN

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Stopping:
    """When a point is ended early, and how often that is wrong at the worst.

    Attributes
    ----------
    most_runs, agreeing_runs : int
        A point has `most_runs`, fewer if the first `agreeing_runs` all agree, or once nothing that the
        others do could change its answer.
    wrong_side_probability : float
        Largest probability, over all points, that all the runs would have the other majority [-].
    other_decision_probability : float
        Largest probability that all the runs would give another decision: that of a point which is all but
        decided [-].
    """

    most_runs: int
    agreeing_runs: int
    wrong_side_probability: Ratio
    other_decision_probability: Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class Inference:
    """How often an adaptive map is wrong about a point that it did not run, counted in this map.

    Attributes
    ----------
    points : int
        Points that were not run, because those around them agree.
    checked, decided_otherwise : int
        Points evenly taken from those and run nevertheless, and how many of them have another decision.
    error_low, error_high : float or None
        95 % Wilson interval of the share that is decided otherwise; None if none was checked [-].
    """

    points: int
    checked: int
    decided_otherwise: int
    error_low: Ratio | None
    error_high: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MapQuestion:
    """What a map is asked for.

    Parameters
    ----------
    study : Study
        With a [cage].
    x, y : MapAxis
        Two different parameters.
    kick : float
        Of every point, unless an axis is [m/s].
    runs : int
        Most runs of a point.
    adaptive : bool
        Run only the points near a change of the answer, from a coarse grid on, and a sample of the others.
    """

    study: Study
    x: MapAxis
    y: MapAxis
    kick: MetrePerSecond
    runs: int = 16
    adaptive: bool = False

    def __post_init__(self) -> None:
        if self.x.parameter == self.y.parameter:
            raise InputError("The map", "needs two different parameters", got=f"{self.x.parameter} twice")
        if not 0.0 < self.kick < 1e4:
            raise InputError("The kick of a map", "must be > 0 and < 10000 [m/s]", f"{self.kick:g}")
        if not 1 <= self.runs <= 1_000_000:
            raise InputError("The runs of a map", "must lie between 1 and 1000000", got=str(self.runs))


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityMap:
    """A map: its points, column after column of x, and the bands in which the answer changes.

    `counts` has the number of points of each decision, of those refused, inferred, and not run;
    `inference` is None where every point is run; `complete` is False if an interrupt left points out.
    """

    x: MapAxis  # horizontal axis
    y: MapAxis  # vertical axis
    points: tuple[MapPoint, ...]  # column after column of x
    changes: Annotated[tuple[MapChange, ...], Rows("change", "change_")]
    """Bands between motion that settles and a whirl."""
    counts: Annotated[Mapping[str, int], Rows(prefix="points_")]
    """Points of each decision, refused, inferred, not run."""
    kick: MetrePerSecond  # of every point, unless an axis is the kick
    stopping: Stopping  # when a point is ended early
    inference: Inference | None  # errors of the points that were not run; null if all were
    duration: Second  # of a run
    ball_scatter: Ratio
    adaptive: bool  # whether only points near a change were run
    complete: bool  # false if an interrupt left points out
