"""The ranking: verdict, margin, rank and reason of each candidate in each environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import partial
from itertools import chain
from math import log
from typing import Any, NamedTuple

from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.impact_restitution import SOLID_LUBRICATION_LIMIT
from separatrix.chain.solution import Solution, solve
from separatrix.ground.units import Metre, Ratio
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
from separatrix.verdict.critical_friction import CriticalFriction, expected_runs
from separatrix.verdict.drawn_frictions import DrawnBearings, drawn_bearings
from separatrix.verdict.draws import Case
from separatrix.verdict.judgement import Judgement
from separatrix.verdict.long_jobs import Load, Runner, scattered
from separatrix.verdict.ranking_records import (
    MeanFriction,
    NotFinished,
    NotMeasured,
    Ranked,
    RankedEnvironment,
    Ranking,
    Row,
    margin_interval,
    measured,
    overall,
    ranks,
    safety_interval,
    same_rank,
)
from separatrix.verdict.response import GrowthCounter
from separatrix.verdict.safety_factor import (
    WIDE,
    CageLimit,
    between,
    cage_limit,
    ends_of_each,
    safety_factor,
    spread,
)
from separatrix.verdict.stability_curve import (
    OWN_DAMPING,
    Node,
    RestitutionThreshold,
    StabilityCurve,
    Tracer,
    curve_of_points,
    restitution_threshold,
    rising,
    threshold_factors,
)
from separatrix.verdict.which_ball import judge_solution, transmitted_force


class Asked(NamedTuple):
    """A verdict: on a pocket with a friction, by the study's model or by the paper's."""

    pocket: Pocket
    friction: Ratio
    is_paper: bool = False


class Knot(NamedTuple):
    """A point of a pocket's curve, by the paper's model."""

    pocket: Pocket
    node: Node


class Limit(NamedTuple):
    """Critical friction of a pocket's cage by the study's model; with another land clearance, if given."""

    pocket: Pocket
    land_clearance: Metre | None = None


Piece = Asked | Knot | Limit | Case
"""What is computed in one go; a case is a verdict on drawn bearings."""
Found = Judgement | CriticalFriction | CageLimit


@dataclass(frozen=True, slots=True, kw_only=True)
class _Question:
    """Solutions by pocket, and what is to be computed with them."""

    settings: StabilitySettings
    solved: Sequence[Solution]  # of each candidate
    cages: Mapping[Pocket, Solution]
    is_paper: bool  # whether the study's model is the paper's
    spreads: Mapping[str, float]  # by candidate: what uncertain inputs do to its critical friction
    paper: Mapping[Pocket, Solution]  # the same by the paper's model
    tracers: Mapping[Pocket, Tracer]
    pockets: Mapping[str, Pocket]
    reference: Pocket
    ends: Sequence[tuple[Pocket, ...]]  # of the pockets that differ in stiffness alone
    wide: Limit | None  # on a land that leaves the reference cage to its pockets, if its own does not
    drawn: DrawnBearings | None
    keys: Sequence[Asked]  # of all verdicts by the study's model
    beside: Sequence[Asked]  # of those by the paper's, in the bearing's own environment
    runner: Runner


@dataclass(frozen=True, slots=True, kw_only=True)
class _Findings:
    """What was computed, by pocket; an interrupt leaves entries out."""

    points: Mapping[Pocket, Sequence[CriticalFriction]]
    here: CriticalFriction | None
    limits: Mapping[Limit, CageLimit]
    judgements: Mapping[Asked, Judgement]
    drawn: Mapping[Case, Judgement]
    traced: Mapping[Pocket, bool]
    complete: bool


def rank(study: Study, *, runner: Runner | None = None) -> Ranking:
    """Rank the candidate cage materials of a study, in each environment and overall.

    Ranked by safety factor, the critical friction of the candidate's cage over its friction. In the paper's
    model by margin: where all candidates have one restitution factor, that is the order of thresholds, as in
    the paper (its section 5, Figs 9-12). Curve, threshold and margin are always the paper's
    (docs/theory/ranking.md). The numbers do not depend on the runner.

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
    question = _question(study, asked, solved, [frictions[environment], *frictions.values(), means], runner)

    def ranking(found: _Findings) -> Ranking:
        ranked = {name: _ranked(question, found, table, name) for name, table in frictions.items()}
        reference = question.cages[question.reference]
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
            kicks=question.settings.kicks,
            runs=question.settings.runs,
            duration=question.settings.duration,
            ball_model=reference.design.ball_model,
            motion_model=reference.design.motion_model,
            **_on_a_wide_land(question, found),
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
    notes += [note for limit in found.limits.values() for note in limit.notes]
    notes += [note for tracer in question.tracers.values() for note in tracer.counter.cage.notes]
    notes += [note for point in points for note in point.notes]
    notes += [other_than_candidates(study, asked)] if len(question.cages) > 1 else []
    if question.drawn and (failures := question.drawn.failures):
        share = f"{len(failures)} of {study.stability.runs}"
        notes.append(f"{share} draws of the uncertain inputs make no bearing: {failures[0]}")
    judged = [(row.name, row.judgement) for row in rows if not isinstance(row, NotMeasured) and row.judgement]
    frictions = {row.name: row.friction for row in rows if not isinstance(row, NotMeasured)}
    moved = [Moved(n, j.largest_contact_force, j.largest_offset, j.by_kick, frictions[n]) for n, j in judged]
    reference = question.cages[question.reference]
    return (*filter(None, notes), *beyond_motion(reference, moved))


def _question(
    study: Study,
    asked: RankingQuestion,
    solved: Mapping[str, Solution],
    tables: Sequence[Mapping[str, MeanFriction | None]],
    runner: Runner | None,
) -> _Question:
    """What a ranking computes for tables of mean frictions, that of the bearing's own environment first.

    The curve of the reference pocket is shown; of the others only the thresholds count.
    """
    pockets = {name: pocket_of(one) for name, one in solved.items()}
    cages = {pockets[name]: one for name, one in solved.items()}
    is_paper = study.cage is not None and study.cage.is_of_paper
    paper = {pocket: one.paper for pocket, one in cages.items()}
    reference = pockets[reference_candidate(study, asked).name]
    every = {(pockets[n], f.mean) for table in tables for n, f in table.items() if f is not None}
    keys = [Asked(*each) for each in sorted(every)]
    own = {Asked(pockets[n], f.mean, True) for n, f in tables[0].items() if f is not None}
    runner = runner or Runner()
    empty = {pocket: moving_cage(one, 0.0) for pocket, one in paper.items()}
    tracers = {
        pocket: Tracer(
            GrowthCounter(empty[pocket], study.stability, runner),
            threshold_factors(study.stability),
            band=False,
            frictions=None if pocket == reference else [key.friction for key in keys if key.pocket == pocket],
        )
        for pocket in cages
    }
    is_by_land = 0.0 < reference.land < reference.clearance
    drawn = drawn_bearings(study, study.stability.runs) if study.distributions else None
    spreads = {}
    if drawn and not is_paper:
        spreads = {name: spread([own[name] for own in drawn.solved]) for name in solved}
    return _Question(
        settings=settings_for(study.stability, empty[reference]),
        solved=[*solved.values()],
        cages=cages,
        is_paper=is_paper,
        spreads=spreads,
        paper=paper,
        tracers=tracers,
        pockets=pockets,
        reference=reference,
        ends=ends_of_each(cages),
        wide=Limit(reference, WIDE * reference.clearance) if is_by_land and not is_paper else None,
        drawn=drawn,
        keys=keys,
        beside=[] if is_paper else sorted(own),
        runner=runner,
    )


def _compute(question: _Question, ranking: Callable[[_Findings], Ranking]) -> Ranking:
    """Critical frictions and verdicts, all in one row of work for the threads, made into a ranking."""
    keys, cases = question.keys, list(question.drawn.friction) if question.drawn else []
    nodes = [Knot(pocket, node) for pocket, tracer in question.tracers.items() for node in tracer.first]
    limits = _limits(question, {})
    verdicts: list[Asked | Case] = [*keys, *question.beside, *cases]

    def ranked(results: Mapping[Piece, Found]) -> Ranking:
        points = {k: _points_of(results, k) for k in question.cages}
        here = points[question.reference].pop((OWN_DAMPING, None), None)
        judged = {one: found for one, found in results.items() if isinstance(found, Judgement)}
        traced = {k: tracer.complete(points[k]) for k, tracer in question.tracers.items()}
        known = {one: f for one, f in results.items() if isinstance(one, Limit) and isinstance(f, CageLimit)}
        every = len(judged) == len(verdicts) and {*_limits(question, known)} <= {*known}
        return ranking(
            _Findings(
                points={k: rising(found.values()) for k, found in points.items()},
                here=here,
                limits=known,
                judgements={one: found for one, found in judged.items() if isinstance(one, Asked)},
                drawn={one: found for one, found in judged.items() if isinstance(one, Case)},
                traced=traced,
                complete=here is not None and all(traced.values()) and every,
            )
        )

    own = Knot(question.reference, (OWN_DAMPING, None))
    # the longest first, as its runs wait for each other; then verdicts, so that an interrupt leaves some
    judged: list[Piece] = [*scattered(keys), *scattered(question.beside), *scattered(cases)]
    pieces: list[Piece] = [*limits, own, *judged, *nodes]
    return question.runner.work_out(
        lambda piece: _computed(question, piece),
        pieces,
        into=ranked,
        more=lambda piece, results: _more(question, piece, results),
        load=lambda piece: _load(question, piece),
    )


def _limits(question: _Question, known: Mapping[Limit, CageLimit]) -> list[Limit]:
    """Critical frictions that are wanted: of pockets that differ in stiffness alone those of the ends.

    If the ends say nothing of those between them, all. The reference cage's on a wide land too, if its land
    stops it before its pockets do.
    """
    if question.is_paper:
        return []
    wanted = []
    for ends in question.ends:
        limits = [Limit(one) for one in ends]
        soft, stiff = known.get(limits[0]), known.get(limits[-1])
        is_open = soft is not None and stiff is not None and between(soft, stiff, 0.5) is None
        alike = {one for one in question.cages if one._replace(stiffness=ends[0].stiffness) == ends[0]}
        wanted += [Limit(one) for one in sorted(alike)] if is_open else limits
    return [*wanted, *([question.wide] if question.wide else [])]


def _limit_of(question: _Question, found: _Findings, pocket: Pocket) -> CageLimit | None:
    """Critical friction of a pocket, its own or that between those of the ends; None if not finished."""
    if own := found.limits.get(Limit(pocket)):
        return own
    first, last = next(
        (ends[0], ends[-1])
        for ends in question.ends
        if pocket._replace(stiffness=ends[0].stiffness) == ends[0]
    )
    soft, stiff = found.limits.get(Limit(first)), found.limits.get(Limit(last))
    if soft is None or stiff is None or first == last:
        return None
    share = log(pocket.stiffness / first.stiffness) / log(last.stiffness / first.stiffness)
    return between(soft, stiff, share)


def _load(question: _Question, piece: Piece) -> Load:
    """Work of a piece: runs of a verdict, of a limit, or those of a node."""
    if isinstance(piece, Knot):
        return question.tracers[piece.pocket].load(piece.node)
    kicks = len(question.settings.kicks)
    if isinstance(piece, Limit):
        return Load(kicks * expected_runs(question.settings, band=False))
    return Load(kicks * question.settings.runs)


def _computed(question: _Question, piece: Piece) -> Found:
    settings, runner = question.settings, question.runner
    if isinstance(piece, Case):
        if question.drawn is None:
            raise LookupError(piece)
        return question.drawn.judge(piece, settings.kicks, runner)
    if isinstance(piece, Knot):
        return question.tracers[piece.pocket].point(piece.node)
    if isinstance(piece, Limit):
        solution = question.cages[piece.pocket]
        highest = max(key.friction for key in question.keys)
        return cage_limit(solution, settings, runner, highest=highest, land_clearance=piece.land_clearance)
    solved = question.paper if piece.is_paper else question.cages
    run = partial(runner.whole_ensemble, settings=settings)
    return judge_solution(solved[piece.pocket], piece.friction, run)


def _more(question: _Question, piece: Piece, results: Mapping[Piece, Found]) -> list[Piece]:
    """Nodes of the same curve, and limits between two, that are wanted once this one is known."""
    if isinstance(piece, Limit):
        known = {one: f for one, f in results.items() if isinstance(one, Limit) and isinstance(f, CageLimit)}
        return [one for one in _limits(question, known) if one not in known]
    if not isinstance(piece, Knot):
        return []
    wanted = question.tracers[piece.pocket].more(piece.node, _points_of(results, piece.pocket))
    return [Knot(piece.pocket, node) for node in wanted]


def _points_of(results: Mapping[Piece, Found], pocket: Pocket) -> dict[Node, CriticalFriction]:
    """Points of the curve of one pocket."""
    return {
        one.node: found
        for one, found in results.items()
        if isinstance(one, Knot) and isinstance(found, CriticalFriction) and one.pocket == pocket
    }


def _curve(question: _Question, found: _Findings) -> StabilityCurve | None:
    """Stability curve of the reference cage; None if an interrupt left no point of it."""
    points, shown = found.points[question.reference], question.settings.restitution_factors
    points = [point for point in points if not shown or point.restitution_factor in shown]
    if not points:
        return None
    cage, complete = question.tracers[question.reference].counter.cage, found.traced[question.reference]
    return curve_of_points(cage, question.settings, points, band=False, here=found.here, complete=complete)


def _ranked(
    question: _Question, found: _Findings, table: Mapping[str, MeanFriction | None], environment: str
) -> tuple[Row, ...]:
    """Rows of one environment, best first; the order of the study within a rank."""
    known = {name: friction for name, friction in table.items() if friction is not None}
    rows = [_row(question, found, Case(n, environment), f) for n, f in known.items()]
    judged = [row for row in rows if isinstance(row, Ranked)]
    interval = margin_interval if question.is_paper else safety_interval
    places = ranks(
        [interval(row) for row in judged],
        lambda i, leader: same_rank(judged[i], judged[leader], known, interval),
    )
    ranked = [replace(row, rank=place) for row, place in zip(judged, places, strict=True)]
    return (
        *sorted(ranked, key=lambda row: (row.rank, -safety_interval(row)[0], -row.margin, row.friction)),
        *sorted((row for row in rows if isinstance(row, NotFinished)), key=lambda row: row.friction),
        *(NotMeasured(name=n, reason=not_measured(environment)) for n, f in table.items() if f is None),
    )


def _row(question: _Question, found: _Findings, case: Case, friction: MeanFriction) -> Ranked | NotFinished:
    """One candidate, not yet ranked."""
    pocket = question.pockets[case.candidate]
    eta = question.cages[pocket].restitution.restitution_factor
    row = NotFinished(
        name=case.candidate,
        friction=friction.mean,
        friction_error=friction.error,
        friction_deviation=friction.deviation,
        friction_scatter_assumed=friction.assumed,
        extrapolation=friction.extrapolation,
        cage_mass=pocket.mass,
        ball_cage_stiffness=pocket.stiffness,
        pocket_clearance=pocket.clearance,
        land_clearance=pocket.land or None,
        restitution_factor=eta,
        reason=NOT_FINISHED,
    )
    judgement = found.judgements.get(Asked(pocket, friction.mean))
    if judgement is None:
        return row
    if broken := not_finite(judgement):
        return replace(row, reason=broken)
    row = replace(row, judgement=judgement, over_inputs=found.drawn.get(case))
    threshold = _threshold(found, pocket, friction)
    limit = _limit_of(question, found, pocket)
    by_paper = Asked(pocket, friction.mean, True)
    papers = judgement if question.is_paper else found.judgements.get(by_paper)
    is_missing = papers is None and by_paper in question.beside
    if threshold is None or is_missing or (limit is None and not question.is_paper):
        missing = "threshold" if question.is_paper else "critical friction, or the paper's answer"
        return replace(row, reason=f"{judgement.reason} Its {missing}: {NOT_FINISHED}.")
    return Ranked(
        **{f.name: getattr(row, f.name) for f in fields(row) if f.name != "reason"},
        reason=reason(threshold, judgement) if question.is_paper else judgement.reason,
        restitution_threshold=threshold.value,
        restitution_threshold_low=threshold.low,
        restitution_threshold_high=threshold.high,
        margin=threshold.value - eta,
        paper_verdict=None if papers is None else papers.verdict,
        paper_probability_stable=None if papers is None else papers.probability_stable,
        **_safety(limit, friction, question.spreads.get(row.name, 0.0)),
    )


def _safety(limit: CageLimit | None, friction: MeanFriction, spread: float) -> dict[str, Any]:
    """Critical friction and safety factor, as fields of a row; none without a limit."""
    if limit is None:
        return {}
    own = {f.name: getattr(limit, f.name) for f in fields(limit) if f.name != "notes"}
    return own | asdict(safety_factor(limit, friction.mean, friction.interval(), spread))


def _on_a_wide_land(question: _Question, found: _Findings) -> dict[str, Any]:
    """Critical friction on a land that leaves the cage to its pockets, as fields; none if not asked."""
    if question.wide is None or question.wide not in found.limits:
        return {}
    limit = found.limits[question.wide].own
    values = {name.replace("own", "wide_land"): value for name, value in limit.items()}
    return {"wide_land_clearance": question.wide.land_clearance, **values}


def _threshold(found: _Findings, pocket: Pocket, friction: MeanFriction) -> RestitutionThreshold | None:
    """Threshold at the mean friction, its interval widened by those at the ends of the friction's."""
    points = found.points[pocket]
    if not found.traced[pocket]:
        return None
    value, *ends = (restitution_threshold(points, f) for f in (friction.mean, *friction.interval()))
    return replace(value, low=min(t.low for t in ends), high=max(t.high for t in ends))
