"""What each verb answers: records of the chain and of ensembles, with what belongs beside them.

The answer of `bearing` is a `BearingState`, that of `sweep` a `Sweep`.
"""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.cage import History, PlanarCage, SpaceAnalysis, SpaceHistory
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState
from separatrix.chain.film_curves import ExactFilms, WearCurve
from separatrix.chain.lubrication import LubricationCurve
from separatrix.chain.mobility import Impacts, LinearMobility, Mobility
from separatrix.chain.models import ModelComparison
from separatrix.chain.shown_traction import ExactArea
from separatrix.chain.solution import Solution
from separatrix.chain.traction import ShearField, TractionCurve
from separatrix.explore.records import UncertainStudy
from separatrix.limits import StabilityCurve
from separatrix.limits.map_records import StabilityMap
from separatrix.ranking import Ranking
from separatrix.units import Metre, MetrePerSecond, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckAnswer:
    """The bearing at standstill, and the running clearances of the cage; None with the reason if refused.

    The clearances are also None, without a reason, for a study that states the running ones.
    """

    static: BearingState | None
    static_reason: str = ""
    clearances: Clearances | None = None
    clearances_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves by the study's model and the other one, by strips at other pivoting-to-rolling ratios.

    And models side by side, and the shear of strips in free rolling. None where there is no exact answer.
    """

    race_friction: Ratio
    bearing: BearingState
    comparison: ModelComparison
    inner: TractionCurve
    outer: TractionCurve
    inner_strips: TractionCurve
    outer_strips: TractionCurve
    inner_exact: TractionCurve | None
    outer_exact: TractionCurve | None
    inner_area: ExactArea | None
    outer_area: ExactArea | None
    inner_others: tuple[TractionCurve, ...]
    outer_others: tuple[TractionCurve, ...]
    inner_shear: ShearField
    outer_shear: ShearField


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionAnswer:
    """Restitution factor, and what it would be with other films; None without a film material.

    `exact_films` are of a study with the exact model, `wear` of one with a worn band.
    """

    solution: Solution
    film_thickness: Metre
    lubrication: LubricationCurve | None
    exact_films: ExactFilms | None
    wear: WearCurve | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MobilityAnswer:
    """Mobility of the most loaded ball, its small motion between rigid bodies, and the cage's impacts on it.

    `impacts` is None, with the reason, for a study whose cage has no stiffness, or without a cage.
    """

    solution: Solution
    mobility: Mobility
    rigid: LinearMobility
    impacts: Impacts | None
    impacts_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class OfCage:
    """The chain, and the cage that an answer is for."""

    solution: Solution
    cage: PlanarCage


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer(OfCage):
    """Stability curve of the cage."""

    curve: StabilityCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAnswer(OfCage):
    """The map, and the cage of the study itself."""

    map: StabilityMap


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationAnswer(OfCage):
    """One run of the ensemble, from one kick."""

    history: History
    kick: MetrePerSecond
    run: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceSimulationAnswer(OfCage):
    """One run of a cage in space, from one kick."""

    history: SpaceHistory
    analysis: SpaceAnalysis
    kick: MetrePerSecond
    run: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer(OfCage):
    """The ranking, and the cage of its reference candidate."""

    ranking: Ranking


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityAnswer(OfCage):
    """The uncertain study, and the cage of its reference candidate.

    `film_thickness` (None if the races are bare) and `race_friction` are those of the study.
    """

    uncertain: UncertainStudy
    film_thickness: Metre | None
    race_friction: Ratio
