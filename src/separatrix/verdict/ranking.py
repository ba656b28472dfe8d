"""The ranking: verdict, margin, rank and reason of each candidate in each environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from itertools import chain

import numpy as np

from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.impact_restitution import SOLID_LUBRICATION_LIMIT
from separatrix.chain.solution import Solution, solve
from separatrix.ground.units import Ratio
from separatrix.study.candidates import (
    other_than_candidates,
    ranking_question,
    reference_candidate,
    required_environment,
)
from separatrix.study.study import RankingQuestion, StabilitySettings, Study
from separatrix.verdict.beyond_models import (
    NOT_FINISHED,
    PAPER_STATEMENT,
    Moved,
    Pocket,
    beyond_motion,
    not_finite,
    not_measured,
    pocket_of,
    reason,
)
from separatrix.verdict.critical_friction import CriticalFriction
from separatrix.verdict.drawn_frictions import DrawnBearings, drawn_bearings
from separatrix.verdict.draws import Case
from separatrix.verdict.judgement import Judgement
from separatrix.verdict.long_jobs import Load, Runner, scattered
from separatrix.verdict.ranking_records import (
    MeanFriction,
    NotFinished,
    NotMeasured,
    OwnCurve,
    Ranked,
    RankedEnvironment,
    Ranking,
    Row,
    lowest_among,
    margin_interval,
    measured,
    overall,
    ranks,
    same_rank,
)
from separatrix.verdict.response import GrowthCounter
from separatrix.verdict.stability_curve import (
    OWN_DAMPING,
    Node,
    RestitutionThreshold,
    StabilityCurve,
    Tracer,
    curve_of_points,
    height,
    restitution_threshold,
    rising,
    threshold_factors,
)
from separatrix.verdict.which_ball import judge_solution, transmitted_force

Key = tuple[Pocket, Ratio]  # a pocket, and a friction: what a verdict is about
Piece = tuple[Pocket, Ratio | Node] | Case
"""A verdict, or with the pocket a node of its curve; or a verdict on drawn bearings."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Question:
    """Solutions by pocket, and what is to be computed with them."""

    settings: StabilitySettings
    solved: Sequence[Solution]  # of each candidate
    cages: Mapping[Pocket, Solution]
    tracers: Mapping[Pocket, Tracer]
    pockets: Mapping[str, Pocket]
    reference: Pocket
    drawn: DrawnBearings | None
    keys: Sequence[Key]  # of all verdicts
    runner: Runner


@dataclass(frozen=True, slots=True, kw_only=True)
class _Findings:
    """What was computed, by pocket; an interrupt leaves entries out."""

    points: Mapping[Pocket, Sequence[CriticalFriction]]
    here: CriticalFriction | None
    judgements: Mapping[Key, Judgement]
    drawn: Mapping[Case, Judgement]
    traced: Mapping[Pocket, bool]
    complete: bool


def rank(study: Study, *, runner: Runner | None = None) -> Ranking:
    """Rank the candidate cage materials of a study, in each environment and overall.

    Ranked by margin: where all candidates have one restitution factor, that is the order of thresholds, as
    in the paper (its section 5, Figs 9-12). The verdict is the ensemble's at the chain's own restitution
    factor (docs/theory/ranking.md). Only there the critical friction has its band over the kicks. The numbers
    do not depend on the runner.

    Raises
    ------
    InputError
        The study has no candidates, or its environment or a candidate's pocket stiffness is not known.
    Interrupted
        With a ranking in which what was not finished is None, with that reason.
    """
    asked = ranking_question(study)
    environment = required_environment(study, asked)
    solved = {one.name: solve(study, one) for one in asked.candidates}
    frictions = {
        place: {
            name: measured(f) if (f := one.frictions.get(place)) else None for name, one in solved.items()
        }
        for place in asked.environments
    }
    means = {name: overall(map(one.frictions.get, asked.environments)) for name, one in solved.items()}
    question = _question(study, asked, solved, [*frictions.values(), means], runner)

    def ranking(found: _Findings) -> Ranking:
        ranked = {name: _ranked(question, found, table, name) for name, table in frictions.items()}
        reference = question.cages[question.reference]
        own_eta, own_curves = _own_curves(question, found)
        return Ranking(
            environment=environment,
            candidate=reference_candidate(study, asked).name,
            restitution_factor=reference.restitution.restitution_factor,
            restitution_factor_free_spin=reference.restitution.restitution_factor_free_spin,
            ball_cage_stiffness=question.reference.stiffness,
            pocket=reference.pocket,
            friction_scatter=asked.friction_scatter,
            solid_lubrication_limit=SOLID_LUBRICATION_LIMIT,
            paper_statement=PAPER_STATEMENT,
            environments=tuple(RankedEnvironment(name=name, materials=rows) for name, rows in ranked.items()),
            overall=_ranked(question, found, means, ""),
            stability=_curve(question, found),
            own_eta=own_eta,
            own_curves=own_curves,
            kicks=question.settings.kicks,
            runs=question.settings.runs,
            duration=question.settings.duration,
            ball_model=reference.design.ball,
            motion_model=reference.design.motion,
            capacity=transmitted_force(reference),
            notes=_notes(study, asked, question, found, ranked[environment]),
            complete=found.complete,
        )

    return _compute(question, ranking)


def _notes(
    study: Study, asked: RankingQuestion, question: _Question, found: _Findings, rows: Sequence[Row]
) -> tuple[str, ...]:
    """Sentences for under the table: whose curve it is, and where chain and motion leave their models."""
    points = [*chain.from_iterable(found.points.values()), *([found.here] if found.here else [])]
    notes = [note for one in question.solved for note in one.notes]
    notes += [note for tracer in question.tracers.values() for note in tracer.counter.cage.notes]
    notes += [note for point in points for note in point.notes]
    notes += [other_than_candidates(study, asked)] if len(question.cages) > 1 else []
    if question.drawn and (failures := question.drawn.failures):
        share = f"{len(failures)} of {study.stability.runs}"
        notes.append(f"{share} draws of the uncertain inputs make no bearing: {failures[0]}")
    judged = [(row.name, row.judgement) for row in rows if not isinstance(row, NotMeasured) and row.judgement]
    moved = [Moved(n, j.largest_contact_force, j.largest_offset, j.by_kick) for n, j in judged]
    reference = question.cages[question.reference]
    return (*filter(None, notes), *beyond_motion(reference, moved))


def _question(
    study: Study,
    asked: RankingQuestion,
    solved: Mapping[str, Solution],
    tables: Sequence[Mapping[str, MeanFriction | None]],
    runner: Runner | None,
) -> _Question:
    """What a ranking computes for tables of mean frictions.

    The curve of the reference pocket is shown; of the others only the thresholds count.
    """
    pockets = {name: pocket_of(one) for name, one in solved.items()}
    cages = {pockets[name]: one for name, one in solved.items()}
    reference = pockets[reference_candidate(study, asked).name]
    keys = sorted({(pockets[n], f.mean) for table in tables for n, f in table.items() if f is not None})
    runner = runner or Runner()
    empty = {pocket: moving_cage(one, 0.0) for pocket, one in cages.items()}
    tracers = {
        pocket: Tracer(
            GrowthCounter(empty[pocket], study.stability, runner),
            threshold_factors(study.stability),
            band=False,
            frictions=None if pocket == reference else [f for other, f in keys if other == pocket],
        )
        for pocket in cages
    }
    return _Question(
        settings=settings_for(study.stability, empty[reference]),
        solved=[*solved.values()],
        cages=cages,
        tracers=tracers,
        pockets=pockets,
        reference=reference,
        drawn=drawn_bearings(study, study.stability.runs) if study.distributions else None,
        keys=keys,
        runner=runner,
    )


def _compute(question: _Question, ranking: Callable[[_Findings], Ranking]) -> Ranking:
    """Critical frictions and verdicts, all in one row of work for the threads, made into a ranking."""
    keys, cases = question.keys, list(question.drawn.friction) if question.drawn else []
    nodes: list[Piece] = [(k, node) for k, tracer in question.tracers.items() for node in tracer.first]

    def ranked(results: Mapping[Piece, CriticalFriction | Judgement]) -> Ranking:
        points = {k: _points_of(results, k) for k in question.cages}
        here = points[question.reference].pop((OWN_DAMPING, None), None)
        verdicts = {piece: found for piece, found in results.items() if isinstance(found, Judgement)}
        judged = {key: verdicts[key] for key in keys if key in verdicts}
        drawn = {case: verdicts[case] for case in cases if case in verdicts}
        traced = {k: tracer.complete(points[k]) for k, tracer in question.tracers.items()}
        every = (len(judged), len(drawn)) == (len(keys), len(cases))
        return ranking(
            _Findings(
                points={k: rising(found.values()) for k, found in points.items()},
                here=here,
                judgements=judged,
                drawn=drawn,
                traced=traced,
                complete=here is not None and all(traced.values()) and every,
            )
        )

    return question.runner.work_out(
        lambda piece: _computed(question, piece),
        # the longest first, as its runs wait for each other; then verdicts, so that an interrupt leaves some
        [(question.reference, (OWN_DAMPING, None)), *scattered(keys), *scattered(cases), *nodes],
        into=ranked,
        more=lambda piece, results: _more(question, piece, results),
        load=lambda piece: _load(question, piece),
    )


def _load(question: _Question, piece: Piece) -> Load:
    """Work of a piece: runs of a verdict, or those of a node."""
    if not isinstance(piece, Case) and isinstance(piece[1], tuple):
        return question.tracers[piece[0]].load(piece[1])
    return Load(len(question.settings.kicks) * question.settings.runs)


def _computed(question: _Question, piece: Piece) -> CriticalFriction | Judgement:
    if isinstance(piece, Case):
        if question.drawn is None:
            raise LookupError(piece)
        return question.drawn.judge(piece, question.settings.kicks, question.runner)
    pocket, what = piece
    if isinstance(what, tuple):
        return question.tracers[pocket].point(what)
    run = partial(question.runner.whole_ensemble, settings=question.settings)
    return judge_solution(question.cages[pocket], what, run)


def _more(
    question: _Question, piece: Piece, results: Mapping[Piece, CriticalFriction | Judgement]
) -> list[Piece]:
    """Nodes of the same curve that are wanted once this one is known."""
    if isinstance(piece, Case):
        return []
    pocket, node = piece
    if not isinstance(node, tuple):
        return []
    wanted = question.tracers[pocket].more(node, _points_of(results, pocket))
    return [(pocket, node) for node in wanted]


def _points_of(
    results: Mapping[Piece, CriticalFriction | Judgement], pocket: Pocket
) -> dict[Node, CriticalFriction]:
    """Points of the curve of one pocket."""
    return {
        what: found
        for piece, found in results.items()
        if isinstance(found, CriticalFriction) and not isinstance(piece, Case)
        for k, what in [piece]
        if k == pocket and isinstance(what, tuple)
    }


def _curve(question: _Question, found: _Findings) -> StabilityCurve | None:
    """Stability curve of the reference cage; None if an interrupt left no point of it."""
    points, shown = found.points[question.reference], question.settings.restitution_factors
    points = [point for point in points if not shown or point.restitution_factor in shown]
    if not points:
        return None
    cage, complete = question.tracers[question.reference].counter.cage, found.traced[question.reference]
    return curve_of_points(cage, question.settings, points, band=False, here=found.here, complete=complete)


def _own_curves(
    question: _Question, found: _Findings
) -> tuple[tuple[Ratio, ...], tuple[OwnCurve, ...]] | tuple[None, None]:
    """Return each candidate's own curve at the nodes of all; None where all share one, or one is missing."""
    if len(question.cages) < 2 or not all(found.traced.values()):
        return None, None
    nodes = {
        pocket: ([point.restitution_factor for point in points], [height(point) for point in points])
        for pocket, points in found.points.items()
    }
    grid = sorted({eta for etas, _ in nodes.values() for eta in etas})
    curves = (
        OwnCurve(name=name, own_critical_friction=tuple(np.interp(grid, *nodes[pocket]).tolist()))
        for name, pocket in question.pockets.items()
    )
    return tuple(grid), tuple(curves)


def _ranked(
    question: _Question, found: _Findings, table: Mapping[str, MeanFriction | None], environment: str
) -> tuple[Row, ...]:
    """Rows of one environment, best first; the order of the study within a rank."""
    known = {name: friction for name, friction in table.items() if friction is not None}
    chances = lowest_among(known)
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
    eta = question.cages[pocket].restitution.restitution_factor
    row = NotFinished(
        name=case.candidate,
        friction=friction.mean,
        friction_error=friction.error,
        friction_deviation=friction.deviation,
        probability_lowest_friction=chance,
        friction_scatter_assumed=friction.assumed,
        extrapolation=friction.extrapolation,
        cage_mass=pocket.mass,
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
    row = replace(row, judgement=judgement, over_inputs=found.drawn.get(case))
    threshold = _threshold(found, pocket, friction)
    if threshold is None:
        return replace(row, reason=f"{judgement.reason} Its threshold: {NOT_FINISHED}.")
    return Ranked(
        **{f.name: getattr(row, f.name) for f in fields(row) if f.name != "reason"},
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
