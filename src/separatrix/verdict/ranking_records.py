"""Records of a ranking: mean frictions, rows, and ranks with ties."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot, inf, log, sqrt
from typing import Annotated

from separatrix.chain.pocket_friction import PocketConditions, standard_error
from separatrix.ground.units import (
    Kilogram,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    Ratio,
    Rows,
    Second,
)
from separatrix.study.study import BallModel, Friction, MotionModel
from separatrix.verdict.beyond_models import Effect
from separatrix.verdict.judgement import Judgement, Verdict
from separatrix.verdict.long_look import LongLook
from separatrix.verdict.stability_curve import StabilityCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class NotMeasured:
    """A candidate without a measured friction in this environment."""

    name: str  # of the candidate
    reason: str  # which test is missing


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredCandidate:
    """A candidate with a friction, in one environment or over all of them."""

    name: str  # of the candidate
    friction: Ratio  # mean, as the cage sees it
    friction_error: Ratio | None  # standard error of the mean
    friction_deviation: Ratio | None
    """Of a new sample about the mean, larger where extrapolated; null overall."""
    friction_scatter_assumed: bool  # whether the scatter is that assumed for an unrepeated test
    extrapolation: tuple[str, ...]  # in what respect friction is extrapolated, in words
    cage_mass: Kilogram  # of a shape that of its material
    ball_cage_stiffness: NewtonPerMetre  # of its own pocket
    pocket_clearance: Metre  # running, along the circumference
    land_clearance: Metre | None  # running, diametral; null without a land
    restitution_factor: Ratio  # of the chain with its pocket
    own_critical_friction: Ratio | None = None
    """At which pockets whirl half the runs from the worst disturbance, by its own race damping; null in the
    paper's model, and where no friction that was searched is enough."""
    own_critical_friction_low: Ratio | None = None  # of its 95 % interval, from the number of runs
    own_critical_friction_high: Ratio | None = None  # upper end of it
    critical_kick: MetrePerSecond | None = None  # disturbance from which the critical friction is lowest
    critical_ball: str | None = None  # that decided the critical friction
    estimated_critical_friction: Ratio | None = None  # by the closed law, to check the order
    safety_factor: Ratio | None = None
    """Critical friction over friction; null as the critical friction is, and where the land drives it."""
    safety_factor_low: Ratio | None = None  # of its 95 % interval, with the scatter of friction and inputs
    safety_factor_high: Ratio | None = None  # upper end of it


@dataclass(frozen=True, slots=True, kw_only=True)
class NotFinished(MeasuredCandidate):
    """A candidate that has no rank, because of an interrupt or a number that is not finite."""

    judgement: Judgement | None = None  # null if it has no verdict either
    over_inputs: Judgement | None = None  # with uncertain inputs drawn; null without
    reason: str  # what is missing


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranked(MeasuredCandidate):
    """A candidate with its threshold and rank."""

    restitution_threshold: Ratio  # largest restitution factor at which it is stable
    restitution_threshold_low: Ratio  # lower end of its 95 % interval
    restitution_threshold_high: Ratio  # upper end of its 95 % interval
    margin: Ratio  # threshold less the restitution factor
    paper_verdict: Verdict | None  # by the paper's model, in the bearing's own environment; else null
    paper_probability_stable: Ratio | None  # the same
    rank: int = 0  # by safety factor, in the paper's model by margin; a tie within the scatter of the best
    judgement: Judgement  # verdict and evidence at the central values of the study
    over_inputs: Judgement | None = None
    """Each run with its own bearing drawn from the uncertain inputs; null without them."""
    reason: str  # a sentence with the numbers


Row = Ranked | NotFinished | NotMeasured


@dataclass(frozen=True, slots=True, kw_only=True)
class RankedEnvironment:
    """The candidates in one environment, best first; then those not finished, and those not measured."""

    name: str  # medium and counterface
    materials: Annotated[tuple[Row, ...], Rows("material", "material_", label="name")]
    """A row for each candidate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranking:
    """Answer of a ranking, with the chain and the stability curve of `candidate`.

    That is the cage's material, or the first candidate where the study does not name it.
    """

    environment: str  # the bearing's own, of the headline
    candidate: str  # whose pocket the chain and the curve are for
    restitution_factor: Ratio  # eta of the chain, for the bearing's own candidate
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
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    runs: int  # from each disturbance
    duration: Second  # of a run
    ball_model: BallModel  # that the study asks for; a verdict states the one that decided
    motion_model: MotionModel  # plane or space
    effects: Annotated[tuple[Effect, ...], Rows("effect", "effect_", label="name")]
    """What else moves the critical friction of the cage of `candidate`, as its inputs allow."""
    long_look: LongLook | None  # at a calm cage on its land; null without a land, and in the paper's model
    capacity: Newton  # most that the races can transmit to the most loaded ball
    notes: tuple[str, ...] = ()  # where the motion leaves the range of the model, a sentence each
    complete: bool  # false if an interrupt left something out


@dataclass(frozen=True, slots=True)
class MeanFriction:
    """Mean friction with its scatter, and what to report with it."""

    mean: Ratio
    error: Ratio | None = None  # standard error, with that of extrapolation; None if the scatter is unknown
    deviation: Ratio | None = None  # standard deviation of a new sample
    assumed: bool = False  # whether the scatter was not measured
    extrapolation: tuple[str, ...] = ()

    def interval(self) -> tuple[Ratio, Ratio]:
        """95 % interval of the mean; the mean twice if its scatter is not known."""
        half = 1.96 * (self.error or 0.0)
        return max(0.0, self.mean - half), self.mean + half


def measured(friction: Friction) -> MeanFriction:
    """Mean and standard error of one measurement, with the widening for what was not tested."""
    error = standard_error(friction)
    return MeanFriction(
        friction.mean,
        None if error is None else hypot(error, friction.widening),
        friction.standard_deviation,
        friction.assumed_scatter,
        friction.extrapolation,
    )


def overall(frictions: Iterable[Friction | None]) -> MeanFriction | None:
    """Mean over the measured environments, each counting once; None if there is none."""
    found = [measured(friction) for friction in frictions if friction is not None]
    if not found:
        return None
    mean = sum(one.mean for one in found) / len(found)
    errors = [one.error for one in found if one.error is not None]
    return MeanFriction(
        mean,
        sqrt(sum(e * e for e in errors)) / len(found) if errors else None,
        assumed=any(one.assumed for one in found),
        extrapolation=tuple(dict.fromkeys(text for one in found for text in one.extrapolation)),
    )


TIED_FROM: Ratio = 0.05  # probability of being below the leader from which a candidate is tied with it
_LEAST_ERROR = 1e-9


def may_be_lower(one: MeanFriction, leader: MeanFriction) -> bool:
    """Whether a mean friction lies below a leader's with a probability of `TIED_FROM` or more."""
    from scipy.special import ndtr

    (mean, error), (least, other) = _log(one), _log(leader)
    return bool(ndtr((least - mean) / hypot(other, error)) >= TIED_FROM)


def _log(friction: MeanFriction) -> tuple[float, float]:
    """Logarithm of a mean, and its standard error; the least of either instead of 0."""
    mean = max(friction.mean, 1e-300)
    return log(mean), max((friction.error or 0.0) / mean, _LEAST_ERROR)


Interval = tuple[Ratio, Ratio, Ratio]  # a margin with the low and the high end of its scatter


def ranks(margins: Sequence[Interval], tied: Callable[[int, int], bool]) -> list[int]:
    """Rank of each margin, the largest first.

    The best one leads the first group. Those that do not differ from it beyond their scatter are tied with
    it; the best of the others leads the next group, and so on. Tied ones share the lowest rank (1, 1, 3).
    As only the leader is compared, a chain of small steps does not tie the first with the last. `tied`
    compares a candidate with its leader.
    """
    order = sorted(range(len(margins)), key=lambda i: (-margins[i][0], -margins[i][2]))
    found = [0] * len(margins)
    leader, rank = None, 0
    for place, i in enumerate(order, start=1):
        if leader is None or not tied(i, leader):
            leader, rank = i, place
        found[i] = rank
    return found


def meet(other: Interval, leader: Interval) -> bool:
    """Whether the interval of the smaller margin reaches that of its leader."""
    return other[2] >= leader[1]


POCKET = ("cage_mass", "ball_cage_stiffness", "pocket_clearance", "land_clearance")  # alike on one curve


def same_rank(
    row: Ranked,
    leader: Ranked,
    known: Mapping[str, MeanFriction],
    interval: Callable[[Ranked], Interval],
) -> bool:
    """Whether a row and the leader of its group do not differ beyond their scatter.

    Of one cage the order is that of frictions, whatever its critical friction or curve is, so frictions
    decide; with another pocket the intervals of safety factors or margins decide. One that its land makes
    unstable ties with none that it does not.
    """
    if interval(row)[0] == interval(leader)[0]:
        return True
    if row.judgement.is_by_land != leader.judgement.is_by_land:
        return False
    if all(getattr(row, name) == getattr(leader, name) for name in POCKET):
        return may_be_lower(known[row.name], known[leader.name])
    return meet(interval(row), interval(leader))


def safety_interval(row: Ranked) -> Interval:
    """Safety factor with the ends of its interval; infinite of a friction of 0, 0 where the land drives."""
    low, high = row.safety_factor_low, row.safety_factor_high
    if row.judgement.is_by_land:
        return 0.0, 0.0, 0.0
    if low is None:
        return inf, inf, inf
    value = low if row.safety_factor is None else row.safety_factor
    return value, low, inf if high is None else high


def margin_interval(row: Ranked) -> Interval:
    """Margin with the ends of its interval, those of the threshold less the restitution factor."""
    eta = row.restitution_factor
    return row.margin, row.restitution_threshold_low - eta, row.restitution_threshold_high - eta
