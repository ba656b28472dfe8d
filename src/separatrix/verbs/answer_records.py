"""What each verb answers: records of the chain and of ensembles, with what belongs beside them.

The answer of `bearing` is a `BearingState`, that of `sweep` a `Sweep`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from separatrix.cage import Cause, CourseAnalysis, History, MovingCage, RunOutcome
from separatrix.chain.ball_mobility import LinearMobility, Mobility
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState
from separatrix.chain.impact_restitution import LubricationCurve
from separatrix.chain.solution import Solution
from separatrix.chain.traction_curve import ShearField, TractionCurve
from separatrix.ground.units import (
    Kilogram,
    Metre,
    MetrePerSecond,
    MetreRadianPerSecond,
    Newton,
    PerSecond,
    Radian,
    Ratio,
    Watt,
)
from separatrix.verdict.ranking_records import Ranking
from separatrix.verdict.stability_curve import StabilityCurve
from separatrix.verdict.stability_map import StabilityMap
from separatrix.verdict.uncertain_study import UncertainStudy


@dataclass(frozen=True, slots=True, kw_only=True)
class Refusal:
    """What a verb would refuse of a study, or take long for."""

    verb: str  # that refuses the study, or takes long
    sentence: str  # why, and what to do


class FirstReached(Enum):
    """What a cage that moves from the middle reaches first."""

    POCKETS = auto()
    LAND = auto()
    BOTH = auto()


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedCage:
    """What follows of a cage from its study: its mass, and how far it may move at rest."""

    mass: Kilogram  # as stated, of its shape, or of a thin ring
    half_play: Metre  # of a ball in its pocket, each way along the circumference
    lean: Radian  # of the contact of ball and pocket, towards the bearing axis
    land_gap: Metre | None  # least radial gap of the land; null without a land
    first_reached: FirstReached | None  # pockets or land; null without a land


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckAnswer:
    """The bearing at standstill, and the running clearances of the cage; None with the reason if refused.

    The clearances are also None, without a reason, for a study that states the running ones.
    """

    refusals: tuple[Refusal, ...]  # what each verb would refuse of the study, or take long for
    speed_parameter: MetreRadianPerSecond  # bore, or pitch diameter where no bore is known, times speed
    cage: CheckedCage | None  # null without a cage
    static: BearingState | None  # contacts of the most loaded ball at standstill; null if refused
    static_reason: str  # why there are no contacts at standstill; empty if there are
    clearances: Clearances | None  # running clearances; null if refused, or if the study states them
    clearances_reason: str  # why the running clearances were refused; empty if they were not
    notes: tuple[str, ...]  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves by the study's model, by strips at other pivoting-to-rolling ratios, and the shear."""

    race_friction: Ratio  # f_BT, of ball on race
    bearing: BearingState  # equilibrium and contacts
    inner: TractionCurve  # curve of the inner race by the study's model
    outer: TractionCurve  # curve of the outer race by the study's model
    inner_others: tuple[TractionCurve, ...]  # inner race at other pivoting-to-rolling ratios
    outer_others: tuple[TractionCurve, ...]  # outer race at other pivoting-to-rolling ratios
    inner_shear: ShearField  # shear of strips in free rolling, inner race
    outer_shear: ShearField  # shear of strips in free rolling, outer race
    outside: tuple[str, ...]  # where the strips leave their range, a sentence each
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionAnswer:
    """Restitution factor, and what it would be with other films; None without a film material."""

    solution: Solution  # the chain
    impact_speed: MetrePerSecond  # of the reference disturbance
    effective_restitution_factor: Ratio
    """What an impact at that speed returns, with a ball of one state and the mass that it feels."""
    film_thickness_here: Metre  # of the study's own film
    lubrication: LubricationCurve | None  # restitution factor against the thickness of other films
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class MobilityAnswer:
    """Mobility of the most loaded ball, and its small motion between rigid bodies."""

    mobility: Mobility  # by the slip fields of the study's contacts
    rigid: LinearMobility  # small motion of the same ball between rigid bodies
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class OfCage:
    """The chain, and the cage that an answer is for."""

    solution: Solution  # the chain
    cage: MovingCage  # the cage with its pockets, land and balls, as the runs use it
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer(OfCage):
    """Stability curve of the cage."""

    curve: StabilityCurve  # critical friction against the restitution factor


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAnswer(OfCage):
    """The map, and the cage of the study itself."""

    map: StabilityMap  # the two axes, the points and the boundary between them


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationAnswer(OfCage):
    """One run of the ensemble, from one kick.

    `force_limit` is the force of a pocket beyond which its ball has no meaning: None without one.
    """

    kick: MetrePerSecond
    run: int  # number of the run in the ensemble, from 0
    given_restitution_factor: Ratio | None  # to which the races are damped; null for that of the study
    outcome_sentence: str  # where the motion ends, in words
    force_limit: Newton | None  # its friction is all that the races hold of a ball; null without such a limit
    force_exceeds_races: bool  # whether the largest force is beyond what the races hold
    drift_rate_law: PerSecond  # growth rate of the offset by the linear law
    rubbing_power: Watt  # power that rubbing on the land turns to heat at the end of the run
    history: History  # the motion, sampled
    analysis: CourseAnalysis  # means, extremes, whirl and spectra

    @property
    def whirls(self) -> bool:
        """Whether the motion lasts: it whirls, rolls in its pockets, or is kept up by the land."""
        lasts = self.history.outcome in (RunOutcome.WHIRLS, RunOutcome.ROLLS)
        return lasts or self.history.cause is Cause.LAND_FRICTION


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer(OfCage):
    """The ranking, and the cage of its reference candidate."""

    ranking: Ranking  # the candidates in each environment


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityAnswer(OfCage):
    """The uncertain study, and the cage of its reference candidate."""

    uncertain: UncertainStudy  # verdicts over the uncertain inputs, and what decides them
