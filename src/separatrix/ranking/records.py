"""The records of a ranking."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from separatrix.cage import Judgement
from separatrix.chain.pocket import PocketConditions
from separatrix.limits.curve import StabilityCurve
from separatrix.study import BallModel, MotionModel
from separatrix.units import Metre, MetrePerSecond, Newton, NewtonPerMetre, Ratio, Rows, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class NotMeasured:
    """A candidate without a measured friction in this environment."""

    name: str  # of the candidate
    reason: str  # which test is missing


@dataclass(frozen=True, slots=True, kw_only=True)
class NotFinished:
    """A candidate that has no rank, because of an interrupt or a number that is not finite.

    `judgement` is None if it has no verdict either; `reason` states what is missing. The other fields are
    those of `Ranked`.
    """

    name: str  # of the candidate
    friction: Ratio  # mean, as the cage sees it
    friction_error: Ratio | None  # standard error of the mean
    friction_deviation: Ratio | None  # standard deviation of a new sample about the mean
    probability_lowest_friction: Ratio | None = None  # that no other candidate's mean friction is lower
    friction_scatter_assumed: bool  # whether the scatter is that assumed for an unrepeated test
    extrapolation: tuple[str, ...]  # in what respect friction is extrapolated, in words
    ball_cage_stiffness: NewtonPerMetre  # of its own pocket
    pocket_clearance: Metre  # running, along the circumference
    land_clearance: Metre | None  # running, diametral; null without a land
    restitution_factor: Ratio  # of the chain with its pocket
    judgement: Judgement | None = None  # null if it has no verdict either
    over_inputs: Judgement | None = None  # with uncertain inputs drawn; null without
    other_ball: Judgement | None = None  # by the other model of a ball; null without
    reason: str  # what is missing


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranked:
    """One candidate in one environment, or for its mean friction over all of them."""

    name: str  # of the candidate
    friction: Ratio  # mean, as the cage sees it
    friction_error: Ratio | None  # standard error of the mean
    friction_deviation: Ratio | None
    """Of a new sample about the mean, larger where extrapolated; null overall."""
    probability_lowest_friction: Ratio | None = None
    """That no other candidate's mean friction is lower; null without another."""
    friction_scatter_assumed: bool  # whether the scatter is that assumed for an unrepeated test
    extrapolation: tuple[str, ...]  # in what respect friction is extrapolated, in words
    ball_cage_stiffness: NewtonPerMetre  # of its own pocket
    pocket_clearance: Metre  # running, along the circumference
    land_clearance: Metre | None  # running, diametral; null without a land
    restitution_factor: Ratio  # of the chain with its pocket
    restitution_threshold: Ratio  # largest restitution factor at which it is stable
    restitution_threshold_low: Ratio  # lower end of its 95 % interval
    restitution_threshold_high: Ratio  # upper end of its 95 % interval
    margin: Ratio  # threshold less the restitution factor
    rank: int = 0  # by margin; those within the scatter of the best one share its rank
    within_reach: bool  # whether the threshold reaches what the paper grants solid lubrication
    judgement: Judgement  # verdict and evidence at the central values of the study
    over_inputs: Judgement | None = None
    """Each run with its own bearing drawn from the uncertain inputs; null without them."""
    other_ball: Judgement | None = None
    """By the other model of a ball, where a pocket is pressed with more than a tenth of the races'
    capacity."""
    reason: str  # a sentence with the numbers


Row = Ranked | NotFinished | NotMeasured


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnCurve:
    """Critical friction with a candidate's own pocket, at each of `Ranking.own_eta` [-].

    0 where half the runs whirl without friction, the top of the searched frictions where none is enough.
    """

    name: str  # of the candidate
    own_critical_friction: Annotated[tuple[Ratio, ...], ("own_eta",)]
    """0: whirls without friction; the top of the search: none is enough."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedEnvironment:
    """The candidates in one environment, best first; then those not finished, and those not measured."""

    name: str  # medium and counterface
    materials: Annotated[tuple[Row, ...], Rows("material", "material_", label="name")]
    """A row for each candidate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranking:
    """Answer of a ranking, with the chain and the stability curve of `candidate`.

    That is the cage's material, or the first candidate where the study does not name it. Beyond a tenth of
    `capacity` each candidate has a second verdict, by the other model of the ball.
    """

    environment: str  # the bearing's own, of the headline
    candidate: str  # whose pocket the chain and the curve are for
    restitution_factor: Ratio
    restitution_factor_free_spin: Ratio  # of the chain, the ball free to spin in the impact
    ball_cage_stiffness: NewtonPerMetre  # of the pocket of `candidate`
    pocket: PocketConditions  # sliding speed and pressure at which friction is taken
    friction_scatter: Ratio  # assumed for an unrepeated test, as a share of the mean
    solid_lubrication_limit: Ratio  # largest restitution factor with solid lubrication, by the paper
    paper_statement: str  # what the paper grants solid lubrication, in words
    environments: Annotated[tuple[RankedEnvironment, ...], Rows("environment", label="name")]
    """The candidates in each."""
    overall: Annotated[tuple[Row, ...], Rows("material", "overall_", label="name")]
    """The candidates with their mean friction over the environments."""
    stability: Annotated[StabilityCurve | None, Rows()]
    """Critical friction against restitution factor; null if left out."""
    own_eta: tuple[Ratio, ...] | None  # restitution factors of the own curves
    own_curves: Annotated[tuple[OwnCurve, ...] | None, Rows("material", label="name")]
    """A curve for each candidate; null where all have one stiffness."""
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    runs: int  # from each kick
    duration: Second  # of a run
    ball_model: BallModel  # damper or traction
    motion_model: MotionModel  # plane or space
    capacity: Newton  # most that the races can transmit to the most loaded ball
    notes: tuple[str, ...] = ()  # where the motion leaves the range of the model, a sentence each
    complete: bool  # false if an interrupt left something out
