"""What each verb answers: records, the chain's and those of the ensembles, with what belongs beside them.

The answer of `bearing` is a `BearingState`, that of `sweep` a `Sweep`.
"""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.cage import History
from separatrix.chain import BearingState, CageState, RestitutionState
from separatrix.explore.records import UncertainStudy
from separatrix.lubrication import LubricationCurve
from separatrix.ranking import Ranking
from separatrix.stability import StabilityCurve
from separatrix.stability.map_records import StabilityMap
from separatrix.traction import ShearField, TractionCurve
from separatrix.units import Metre, MetrePerSecond, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckAnswer:
    """The bearing at standstill; None with the reason if its balance was not found."""

    static: BearingState | None
    static_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves, as they are and at other pivoting-to-rolling ratios, and shear in free rolling."""

    race_friction: Ratio
    bearing: BearingState
    inner: TractionCurve
    outer: TractionCurve
    inner_others: tuple[TractionCurve, ...]
    outer_others: tuple[TractionCurve, ...]
    inner_shear: ShearField
    outer_shear: ShearField


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionAnswer:
    """Restitution factor, and what it would be with other films; None without a film material."""

    state: RestitutionState
    film_thickness: Metre
    lubrication: LubricationCurve | None


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer:
    """Stability curve of the cage that the chain gives."""

    cage: CageState
    curve: StabilityCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationAnswer:
    """One run of the ensemble, from one kick."""

    cage: CageState
    history: History
    kick: MetrePerSecond
    run: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer:
    """The ranking, and the cage of its reference candidate for the numbers of the chain."""

    cage: CageState
    ranking: Ranking


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAnswer:
    """The map, and the cage of the study itself."""

    cage: CageState
    map: StabilityMap


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityAnswer:
    """The uncertain study, and the cage of its reference candidate for the numbers of the chain.

    `film_thickness` (None if the races are bare) and `race_friction` are those of the study.
    """

    cage: CageState
    uncertain: UncertainStudy
    film_thickness: Metre | None
    race_friction: Ratio
