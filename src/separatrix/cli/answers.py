"""What each verb computes: the chain's record, and the curves that only its figures need."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from separatrix.chain import BearingState, CageState, RaceContact, RestitutionState, TractionState
    from separatrix.ranking import Ranking
    from separatrix.stability import StabilityCurve
    from separatrix.study import Study
    from separatrix.traction import TractionCurve

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """How the computing is to be done: threads, and whom to tell how far it is."""

    jobs: int
    progress: Callable[[int, int], None] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves of both races, and the same contacts at several pivoting-to-rolling ratios."""

    state: TractionState
    inner_by_ratio: tuple[TractionCurve, ...]
    outer_by_ratio: tuple[TractionCurve, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer:
    """Stability curve of the cage that the chain gives."""

    cage: CageState
    curve: StabilityCurve


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer:
    """The ranking, and the cage of its first candidate for the numbers of the chain."""

    cage: CageState
    ranking: Ranking


def nothing(study: Study, work: Work) -> None:
    """Compute nothing: the answer is the study itself."""


def bearing(study: Study, work: Work) -> BearingState:  # noqa: ARG001
    """Ball equilibrium and the contacts of the most loaded ball."""
    from separatrix.chain import bearing_state

    return bearing_state(study)


def traction(study: Study, work: Work) -> TractionAnswer:  # noqa: ARG001
    """Traction curves, as they are and at other pivoting-to-rolling ratios."""
    from separatrix.chain import traction_state

    state = traction_state(study)
    return TractionAnswer(
        state=state,
        inner_by_ratio=curves_by_ratio(study, state.bearing.inner, state.inner),
        outer_by_ratio=curves_by_ratio(study, state.bearing.outer, state.outer),
    )


def curves_by_ratio(study: Study, at: RaceContact, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves of one contact at `SPIN_ROLL_RATIOS`, at the creep increments of `curve`."""
    from dataclasses import replace

    from separatrix.traction import film_compliance, traction_curve

    return tuple(
        traction_curve(
            at.ellipse,
            replace(at.creep, spin=ratio * at.ellipse.curvature_rolling),
            race_friction=study.film.race_friction,
            film_compliance=film_compliance(study.film),
            creep_increments=curve.creep_increment,
        )
        for ratio in SPIN_ROLL_RATIOS
    )


def restitution(study: Study, work: Work) -> RestitutionState:  # noqa: ARG001
    """Restitution factor from the traction slopes."""
    from separatrix.chain import restitution_state

    return restitution_state(study)


def stability(study: Study, work: Work) -> StabilityAnswer:
    """Critical friction against restitution factor."""
    from separatrix.chain import cage_state
    from separatrix.stability import stability_curve

    state = cage_state(study)
    curve = stability_curve(state.cage, study.stability, jobs=work.jobs, progress=work.progress)
    return StabilityAnswer(cage=state, curve=curve)


def rank(study: Study, work: Work) -> RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    from separatrix.chain import cage_state
    from separatrix.ranking import rank, ranking_question

    first = ranking_question(study).candidates[0]
    state = cage_state(study, material=first.material)
    return RankingAnswer(cage=state, ranking=rank(study, jobs=work.jobs, progress=work.progress))
