"""The ranking: verdict, margin, rank and reason of each candidate in each environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from separatrix.cage import Judgement, judge
from separatrix.cage_choice import (
    other_than_candidates,
    ranking_question,
    reference_candidate,
    required_environment,
)
from separatrix.chain.restitution import SOLID_LUBRICATION_LIMIT
from separatrix.chain.solution import Solution, solve
from separatrix.draws import Case
from separatrix.limits import (
    CriticalFriction,
    GrowthCounter,
    RestitutionThreshold,
    StabilityCurve,
    Tracer,
    curve_of_points,
    restitution_threshold,
    threshold_factors,
)
from separatrix.limits.curve import OWN_DAMPING, Node, height
from separatrix.limits.threshold import rising
from separatrix.ranking.drawn import DrawnBearings, drawn_bearings
from separatrix.ranking.lowest import MeanFriction, lowest_among, measured, overall
from separatrix.ranking.order import margin_interval, ranks, same_rank
from separatrix.ranking.plausible import Moved, beyond_motion, transmitted_force, within_a_turn
from separatrix.ranking.reason import NOT_FINISHED, PAPER_STATEMENT, not_finite, not_measured, reason
from separatrix.ranking.records import (
    NotFinished,
    NotMeasured,
    OwnCurve,
    Ranked,
    RankedEnvironment,
    Ranking,
    Row,
)
from separatrix.ranking.second import Pocket, Second, is_beyond, pocket_of, second_verdict
from separatrix.runner import Runner
from separatrix.study import RankingQuestion, StabilitySettings, Study
from separatrix.units import Ratio

Key = tuple[Pocket, Ratio]
"""A pocket, and a friction: what a verdict is about."""


Piece = tuple[Pocket, Ratio | Node] | Case | Second
"""A verdict, or with the pocket a node of its curve; of drawn bearings; a second verdict."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Question:
    """Solutions by pocket, and the frictions of the candidates with them."""

    settings: StabilitySettings
    cages: Mapping[Pocket, Solution]
    tracers: Mapping[Pocket, Tracer]
    pockets: Mapping[str, Pocket]
    reference: Pocket
    drawn: DrawnBearings | None
    own: frozenset[Key]
    runner: Runner


@dataclass(frozen=True, slots=True, kw_only=True)
class _Findings:
    """What was computed, by pocket; an interrupt leaves entries out."""

    points: Mapping[Pocket, Sequence[CriticalFriction]]
    here: CriticalFriction | None
    judgements: Mapping[Key, Judgement]
    drawn: Mapping[Case, Judgement]
    seconds: Mapping[Key, Judgement]
    traced: Mapping[Pocket, bool]
    complete: bool


def rank(study: Study, *, runner: Runner | None = None) -> Ranking:
    """Rank the candidate cage materials of a study.

    Parameters
    ----------
    study : Study
        With [cage] and [ranking].
    runner : Runner, optional
        How the runs are made; the numbers do not depend on it.

    Returns
    -------
    Ranking
        For each environment and overall.

    Raises
    ------
    InputError
        The study has no candidates, or its environment or a candidate's pocket stiffness is not known.
    Interrupted
        With a ranking in which what was not finished is None, with that reason.

    Notes
    -----
    Ranked by margin: where all candidates have one restitution factor, that is the order of thresholds, as
    in the paper (its section 5, Figs 9-12). The verdict is the ensemble's at the chain's own restitution
    factor (docs/theory/ranking.md). Only there the critical friction has its band over the kicks.
    """
    asked = ranking_question(study)
    environment = required_environment(study, asked)
    question = _question(study, asked, runner or Runner())
    seen = {c.name: solve(study, c).frictions for c in asked.candidates}
    frictions = {
        place: {name: measured(f) if (f := own.get(place)) else None for name, own in seen.items()}
        for place in asked.environments
    }
    means = {name: overall(own.get(e) for e in asked.environments) for name, own in seen.items()}
    tables = (*frictions.values(), means)
    keys = sorted(
        {(question.pockets[n], f.mean) for table in tables for n, f in table.items() if f is not None}
    )
    here = {(question.pockets[n], f.mean) for n, f in frictions[environment].items() if f is not None}
    question = replace(question, tracers=_tracers(question, study.stability, keys), own=frozenset(here))

    def ranking(found: _Findings) -> Ranking:
        ranked = {name: _ranked(question, found, table, name) for name, table in frictions.items()}
        reference = question.cages[question.reference]
        return Ranking(
            environment=environment,
            candidate=reference_candidate(study, asked).name,
            restitution_factor=_eta(question, question.reference),
            restitution_factor_free_spin=reference.restitution.restitution_factor_free_spin,
            ball_cage_stiffness=question.reference.stiffness,
            pocket=reference.pocket,
            friction_scatter=asked.friction_scatter,
            solid_lubrication_limit=SOLID_LUBRICATION_LIMIT,
            paper_statement=PAPER_STATEMENT,
            environments=tuple(RankedEnvironment(name=name, materials=rows) for name, rows in ranked.items()),
            overall=_ranked(question, found, means, ""),
            stability=_curve(question, found),
            **_own_curves(question, found),
            kicks=question.settings.kicks,
            runs=question.settings.runs,
            duration=question.settings.duration,
            ball_model=reference.design.ball,
            motion_model=reference.design.motion,
            capacity=transmitted_force(reference),
            notes=_notes(study, asked, question, ranked[environment]),
            complete=found.complete,
        )

    return _compute(question, keys, ranking)


def _notes(study: Study, asked: RankingQuestion, question: _Question, rows: Sequence[Row]) -> tuple[str, ...]:
    """Sentences for under the table: whose curve it is, and where the motion leaves its model."""
    other = other_than_candidates(study, asked) if len(question.cages) > 1 else ""
    failures = question.drawn.failures if question.drawn else ()
    left_out = f"{len(failures)} of {study.stability.runs} draws of the uncertain inputs make no bearing: "
    said = [*([other] if other else []), *([left_out + failures[0]] if failures else [])]
    judged = [(row.name, row.judgement) for row in rows if not isinstance(row, NotMeasured) and row.judgement]
    moved = [Moved(n, j.largest_contact_force, j.largest_offset, j.by_kick) for n, j in judged]
    reference = question.cages[question.reference]
    return (*said, *within_a_turn(reference), *beyond_motion(reference, moved))


def _question(study: Study, asked: RankingQuestion, runner: Runner) -> _Question:
    solved = {c.name: solve(study, c) for c in asked.candidates}
    cages = {pocket_of(one): one for one in solved.values()}
    reference = pocket_of(solved[reference_candidate(study, asked).name])
    return _Question(
        settings=cages[reference].stability,
        cages=cages,
        tracers={},
        pockets={name: pocket_of(one) for name, one in solved.items()},
        reference=reference,
        drawn=drawn_bearings(study, study.stability.runs) if study.distributions else None,
        own=frozenset(),
        runner=runner,
    )


def _tracers(question: _Question, settings: StabilitySettings, keys: Sequence[Key]) -> dict[Pocket, Tracer]:
    """For each pocket: the reference's curve is shown, of the others the thresholds count."""
    factors = threshold_factors(settings)
    return {
        k: Tracer(
            GrowthCounter(one.cage_with(0.0), settings, question.runner),
            factors,
            band=False,
            frictions=None if k == question.reference else [f for pocket, f in keys if pocket == k],
        )
        for k, one in question.cages.items()
    }


def _eta(question: _Question, pocket: Pocket) -> Ratio:
    return question.cages[pocket].restitution.restitution_factor


def _compute(question: _Question, keys: Sequence[Key], ranking: Callable[[_Findings], Ranking]) -> Ranking:
    """Critical frictions and verdicts, all in one row of work for the threads, made into a ranking."""
    verdicts: list[Piece] = list(keys)  # first, so that an interrupt leaves some
    cases: list[Case] = list(question.drawn.friction) if question.drawn else []
    nodes: list[Piece] = [(k, node) for k, tracer in question.tracers.items() for node in tracer.first]

    def ranked(results: Mapping[Piece, CriticalFriction | Judgement]) -> Ranking:
        points = {k: _points_of(results, k) for k in question.cages}
        here = points[question.reference].pop((OWN_DAMPING, None), None)
        judged = {key: found for key in keys if isinstance(found := results.get(key), Judgement)}
        drawn = {case: found for case in cases if isinstance(found := results.get(case), Judgement)}
        wanted = [key for key, found in judged.items() if _wants_second(question, key, found)]
        seconds = {key: found for key in wanted if isinstance(found := results.get(Second(*key)), Judgement)}
        traced = {k: tracer.complete(points[k]) for k, tracer in question.tracers.items()}
        every = (len(judged), len(drawn), len(seconds)) == (len(keys), len(cases), len(wanted))
        return ranking(
            _Findings(
                points={k: rising(found.values()) for k, found in points.items()},
                here=here,
                judgements=judged,
                drawn=drawn,
                seconds=seconds,
                traced=traced,
                complete=here is not None and all(traced.values()) and every,
            )
        )

    return question.runner.work_out(
        lambda piece: _computed(question, piece),
        [*verdicts, *cases, (question.reference, (OWN_DAMPING, None)), *nodes],
        into=ranked,
        more=lambda piece, results: _more(question, piece, results),
    )


def _computed(question: _Question, piece: Piece) -> CriticalFriction | Judgement:
    if isinstance(piece, Case):
        if question.drawn is None:
            raise LookupError(piece)
        return question.drawn.judge(piece, question.settings.kicks, question.runner)
    if isinstance(piece, Second):
        solution = question.cages[piece.pocket]
        return second_verdict(solution, piece.friction, question.settings, question.runner)
    pocket, what = piece
    if isinstance(what, tuple):
        return question.tracers[pocket].point(what)
    cage = question.cages[pocket].cage_with(what)
    return judge(cage, question.runner.whole_ensemble(cage, question.settings))


def _more(
    question: _Question, piece: Piece, results: Mapping[Piece, CriticalFriction | Judgement]
) -> list[Piece]:
    """Nodes of the same curve that are wanted once this one is known, or a second verdict."""
    if isinstance(piece, Case | Second):
        return []
    pocket, node = piece
    found = results[piece]
    if not isinstance(node, tuple):
        second = isinstance(found, Judgement) and _wants_second(question, (pocket, node), found)
        return [Second(pocket, node)] if second else []
    wanted = question.tracers[pocket].more(node, _points_of(results, pocket))
    return [(pocket, node) for node in wanted]


def _wants_second(question: _Question, key: Key, found: Judgement) -> bool:
    """Whether a verdict of the bearing's own environment rests on forces beyond the range of its ball."""
    return key in question.own and is_beyond(question.cages[key[0]], found)


def _points_of(
    results: Mapping[Piece, CriticalFriction | Judgement], pocket: Pocket
) -> dict[Node, CriticalFriction]:
    """Points of the curve of one pocket."""
    return {
        what: found
        for piece, found in results.items()
        if isinstance(found, CriticalFriction) and not isinstance(piece, Case | Second)
        for k, what in [piece]
        if k == pocket and isinstance(what, tuple)
    }


def _curve(question: _Question, found: _Findings) -> StabilityCurve | None:
    """Stability curve of the reference cage; None if an interrupt left no point of it."""
    points, shown = found.points[question.reference], question.settings.restitution_factors
    points = [point for point in points if not shown or point.restitution_factor in shown]
    if not points:
        return None
    cage, complete = question.cages[question.reference].cage_with(0.0), found.traced[question.reference]
    return curve_of_points(
        cage,
        question.settings,
        points,
        band=False,
        here=found.here,
        complete=complete,
    )


def _own_curves(question: _Question, found: _Findings) -> dict[str, Any]:
    """Return each candidate's own curve at the nodes of all; None where all share one, or one is missing."""
    if len(question.cages) < 2 or not all(found.traced.values()):
        return {"own_eta": None, "own_curves": None}
    nodes = {
        pocket: ([point.restitution_factor for point in points], [height(point) for point in points])
        for pocket, points in found.points.items()
    }
    grid = sorted({eta for etas, _ in nodes.values() for eta in etas})
    curves = (
        OwnCurve(name=name, own_critical_friction=tuple(np.interp(grid, *nodes[pocket]).tolist()))
        for name, pocket in question.pockets.items()
    )
    return {"own_eta": tuple(grid), "own_curves": tuple(curves)}


def _ranked(
    question: _Question, found: _Findings, table: Mapping[str, MeanFriction | None], environment: str
) -> tuple[Row, ...]:
    """Rows of one environment, best first; the order of the study within a rank."""
    known = {name: friction for name, friction in table.items() if friction is not None}
    chances = lowest_among(known).probabilities
    rows = [_row(question, found, Case(n, environment), f, chances.get(n)) for n, f in known.items()]
    judged = [row for row in rows if isinstance(row, Ranked)]
    places = ranks(
        [margin_interval(row) for row in judged],
        lambda i, leader: same_rank(judged[i], judged[leader], known),
    )
    ranked = [replace(row, rank=place) for row, place in zip(judged, places, strict=True)]
    return (
        *sorted(ranked, key=lambda row: (row.rank, -row.margin, row.friction)),
        *sorted((row for row in rows if isinstance(row, NotFinished)), key=lambda row: row.friction),
        *(NotMeasured(name=n, reason=not_measured(environment)) for n, f in table.items() if f is None),
    )


def _row(
    question: _Question, found: _Findings, case: Case, friction: MeanFriction, chance: Ratio | None
) -> Ranked | NotFinished:
    """One candidate, not yet ranked."""
    pocket = question.pockets[case.candidate]
    eta = _eta(question, pocket)
    row = NotFinished(
        name=case.candidate,
        friction=friction.mean,
        friction_error=friction.error,
        friction_deviation=friction.deviation,
        probability_lowest_friction=chance,
        friction_scatter_assumed=friction.assumed,
        extrapolation=friction.extrapolation,
        ball_cage_stiffness=pocket.stiffness,
        pocket_clearance=pocket.clearance,
        land_clearance=pocket.land or None,
        restitution_factor=eta,
        reason=NOT_FINISHED,
    )
    judgement = found.judgements.get((pocket, friction.mean))
    if judgement is None:
        return row
    if broken := not_finite(judgement):
        return replace(row, reason=broken)
    drawn = found.drawn.get(case)
    second = found.seconds.get((pocket, friction.mean))
    threshold = _threshold(found, pocket, friction)
    if threshold is None:
        unfinished = f"{judgement.reason} Its threshold: {NOT_FINISHED}."
        return replace(row, judgement=judgement, over_inputs=drawn, other_ball=second, reason=unfinished)
    measured = {f.name: getattr(row, f.name) for f in fields(row) if f.name != "reason"}
    return Ranked(
        **measured | {"judgement": judgement, "over_inputs": drawn, "other_ball": second},
        reason=reason(threshold, judgement),
        restitution_threshold=threshold.value,
        restitution_threshold_low=threshold.low,
        restitution_threshold_high=threshold.high,
        margin=threshold.value - eta,
        within_reach=threshold.value >= SOLID_LUBRICATION_LIMIT,
    )


def _threshold(found: _Findings, pocket: Pocket, friction: MeanFriction) -> RestitutionThreshold | None:
    """Threshold at the mean friction, its interval widened by those at the ends of the friction's."""
    points = found.points[pocket]
    if not found.traced[pocket]:
        return None
    value, *ends = (restitution_threshold(points, f) for f in (friction.mean, *friction.interval()))
    return replace(value, low=min(t.low for t in ends), high=max(t.high for t in ends))
