"""The ranking: verdict, margin, rank and reason of each candidate in each environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from separatrix.cage import Judgement, judge, run_ensemble
from separatrix.chain import CageState, cage_state, traction_state
from separatrix.errors import InputError
from separatrix.ranking.friction import MeanFriction, measured, overall
from separatrix.ranking.order import Interval, ranks
from separatrix.ranking.reason import NOT_FINISHED, PAPER_STATEMENT, not_measured, reason
from separatrix.ranking.records import RankedEnvironment, RankedMaterial, Ranking
from separatrix.restitution import SOLID_LUBRICATION_LIMIT
from separatrix.stability import (
    CriticalFriction,
    GrowthCounter,
    RestitutionThreshold,
    StabilityCurve,
    critical_friction,
    curve_of_points,
    restitution_threshold,
    threshold_factors,
)
from separatrix.stability.pool import Progress, work_through
from separatrix.study import Candidate, RankingQuestion, StabilitySettings, Study
from separatrix.units import NewtonPerMetre, Ratio

Key = tuple[NewtonPerMetre, Ratio]
"""Pocket stiffness, and a friction (for a verdict) or a restitution factor (for a point of the curve)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Question:
    """Cages by pocket stiffness, and the frictions of the candidates with them."""

    settings: StabilitySettings
    cages: Mapping[NewtonPerMetre, CageState]
    counters: Mapping[NewtonPerMetre, GrowthCounter]
    stiffness: Mapping[str, NewtonPerMetre]
    reference: NewtonPerMetre


@dataclass(frozen=True, slots=True, kw_only=True)
class _Findings:
    """What was computed, by pocket stiffness; an interrupt leaves entries out."""

    points: Mapping[NewtonPerMetre, Sequence[CriticalFriction]]
    judgements: Mapping[Key, Judgement]
    complete: bool


def rank(study: Study, *, jobs: int = 1, progress: Progress | None = None) -> Ranking:
    """Rank the candidate cage materials of a study.

    Parameters
    ----------
    study : Study
        With [cage] and [ranking].
    jobs : int
        Threads; the numbers do not depend on it.
    progress : callable, optional
        Called with (done, total) pieces of work.

    Returns
    -------
    Ranking
        For each environment and overall; what an interrupt left out is None, with that reason.

    Raises
    ------
    InputError
        The study has no candidates, or a candidate's pocket stiffness is not known.

    Notes
    -----
    Ranked by restitution threshold, as the paper does (its section 5, Figs 9-12); the verdict is the
    ensemble's at the chain's own restitution factor (docs/theory/ranking.md).
    """
    asked = ranking_question(study)
    question = _question(study, asked)
    frictions = {
        environment: {c.name: _measured(c, environment) for c in asked.candidates}
        for environment in asked.environments
    }
    means = {c.name: overall(c.friction.get(e) for e in asked.environments) for c in asked.candidates}
    tables = (*frictions.values(), means)
    keys = sorted(
        {(question.stiffness[n], f.mean) for table in tables for n, f in table.items() if f is not None}
    )
    found = _compute(question, keys, jobs=jobs, progress=progress)
    return Ranking(
        restitution_factor=_eta(question, question.reference),
        restitution_factor_free_spin=(
            question.cages[question.reference].restitution.restitution.restitution_factor_free_spin
        ),
        ball_cage_stiffness=question.reference,
        solid_lubrication_limit=SOLID_LUBRICATION_LIMIT,
        paper_statement=PAPER_STATEMENT,
        environments=tuple(
            RankedEnvironment(name=name, materials=_ranked(question, found, table, name))
            for name, table in frictions.items()
        ),
        overall=_ranked(question, found, means, ""),
        stability=_curve(question, found),
        kicks=study.stability.kicks,
        runs=study.stability.runs,
        duration=study.stability.duration,
        complete=found.complete,
    )


def ranking_question(study: Study) -> RankingQuestion:
    """Return what a study wants ranked.

    Raises
    ------
    InputError
        Nothing.
    """
    if study.ranking is None or not study.ranking.candidates:
        cure = 'Write friction = "pin-on-disk-77K" there, or [[ranking.candidates]].'
        raise InputError(study.name, "lacks the section [ranking] with candidate materials", cure=cure)
    return study.ranking


def _measured(candidate: Candidate, environment: str) -> MeanFriction | None:
    friction = candidate.friction.get(environment)
    return None if friction is None else measured(friction)


def _question(study: Study, asked: RankingQuestion) -> _Question:
    traction = traction_state(study)
    states = {c.name: cage_state(study, material=c.material, traction=traction) for c in asked.candidates}
    cages = {state.cage.ball_cage_stiffness: state for state in states.values()}
    return _Question(
        settings=study.stability,
        cages=cages,
        counters={k: GrowthCounter(state.cage, study.stability) for k, state in cages.items()},
        stiffness={name: state.cage.ball_cage_stiffness for name, state in states.items()},
        reference=states[asked.candidates[0].name].cage.ball_cage_stiffness,
    )


def _eta(question: _Question, stiffness: NewtonPerMetre) -> Ratio:
    return question.cages[stiffness].restitution.restitution.restitution_factor


def _compute(question: _Question, keys: Sequence[Key], *, jobs: int, progress: Progress | None) -> _Findings:
    """Critical frictions and verdicts, all in one row of work for the threads."""
    nodes = [(k, eta) for k in question.cages for eta in threshold_factors(question.settings)]
    work: list[Callable[[], object]] = [
        *(lambda node=node: _point(question, node) for node in nodes),
        *(lambda key=key: _judgement(question, key) for key in keys),
    ]
    results = work_through(lambda piece: piece(), work, jobs=jobs, progress=progress)
    points = {n: r for n, r in zip(nodes, results, strict=False) if isinstance(r, CriticalFriction)}
    judged = {key: r for key, r in zip(keys, results[len(nodes) :], strict=True) if isinstance(r, Judgement)}
    return _Findings(points=_by_cage(question, points), judgements=judged, complete=None not in results)


def _by_cage(
    question: _Question, points: Mapping[Key, CriticalFriction]
) -> dict[NewtonPerMetre, list[CriticalFriction]]:
    return {k: [point for (stiffness, _), point in points.items() if stiffness == k] for k in question.cages}


def _point(question: _Question, node: Key) -> CriticalFriction:
    """Critical friction at one restitution factor; with its band where the curve shows it."""
    stiffness, eta = node
    shown = stiffness == question.reference and eta in question.settings.restitution_factors
    cage = question.cages[stiffness].cage
    return critical_friction(cage, eta, question.settings, counter=question.counters[stiffness], band=shown)


def _judgement(question: _Question, key: Key) -> Judgement:
    cage = replace(question.cages[key[0]].cage, ball_cage_friction=key[1])
    return judge(cage, run_ensemble(cage, question.settings))


def _curve(question: _Question, found: _Findings) -> StabilityCurve | None:
    """Stability curve of the reference cage; None if an interrupt left no point of it."""
    shown = question.settings.restitution_factors
    points = [point for point in found.points[question.reference] if point.restitution_factor in shown]
    cage = question.cages[question.reference].cage
    return curve_of_points(cage, question.settings, points) if points else None


def _ranked(
    question: _Question, found: _Findings, table: Mapping[str, MeanFriction | None], environment: str
) -> tuple[RankedMaterial, ...]:
    """Rows of one environment, best first; the order of the study within a rank."""
    rows = [_row(question, found, name, friction, environment) for name, friction in table.items()]
    places = ranks([_scatter(row) for row in rows])
    ranked = [replace(row, rank=place) for row, place in zip(rows, places, strict=True)]
    return tuple(sorted(ranked, key=_best_first))


def _best_first(row: RankedMaterial) -> tuple[int, float, float]:
    last = row.rank is None
    return (
        10**9 if row.rank is None else row.rank,
        0.0 if last else -(row.restitution_threshold or 0.0),
        row.friction or 0.0,
    )


def _scatter(row: RankedMaterial) -> Interval | None:
    value, low, high = (
        row.restitution_threshold,
        row.restitution_threshold_low,
        row.restitution_threshold_high,
    )
    return None if value is None or low is None or high is None else (value, low, high)


def _row(
    question: _Question, found: _Findings, name: str, friction: MeanFriction | None, environment: str
) -> RankedMaterial:
    """One candidate, not yet ranked."""
    if friction is None:
        return RankedMaterial(name=name, reason=not_measured(environment))
    stiffness = question.stiffness[name]
    eta = _eta(question, stiffness)
    row = RankedMaterial(
        name=name,
        friction=friction.mean,
        friction_error=friction.error,
        ball_cage_stiffness=stiffness,
        restitution_factor=eta,
        reason=NOT_FINISHED,
    )
    threshold = _threshold(question, found, stiffness, friction)
    judgement = found.judgements.get((stiffness, friction.mean))
    if threshold is None or judgement is None:
        return row
    return replace(
        row,
        restitution_threshold=threshold.value,
        restitution_threshold_low=threshold.low,
        restitution_threshold_high=threshold.high,
        margin=threshold.value - eta,
        probability_stable=judgement.probability_stable,
        probability_low=judgement.probability_low,
        probability_high=judgement.probability_high,
        verdict=judgement.verdict.name,
        within_reach=threshold.value >= SOLID_LUBRICATION_LIMIT,
        reason=reason(friction.mean, threshold, eta, judgement),
        energy_growth=judgement.energy_growth,
        largest_offset=judgement.largest_offset,
        drift_rate=judgement.drift_rate,
        largest_contact_force=judgement.largest_contact_force,
        whirl_frequency=judgement.whirl_frequency,
        whirl_direction=judgement.whirl_direction,
        energy_imbalance=judgement.energy_imbalance,
        duration=judgement.duration,
        runs=judgement.runs,
    )


def _threshold(
    question: _Question, found: _Findings, stiffness: NewtonPerMetre, friction: MeanFriction
) -> RestitutionThreshold | None:
    """Threshold at the mean friction, its interval widened by those at the ends of the friction's."""
    points = found.points[stiffness]
    if len(points) < len(threshold_factors(question.settings)):
        return None
    value, *ends = (restitution_threshold(points, f) for f in (friction.mean, *friction.interval()))
    return replace(value, low=min(t.low for t in ends), high=max(t.high for t in ends))
