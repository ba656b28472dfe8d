"""The ranking: verdict, margin, rank and reason of each candidate in each environment."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import partial
from math import inf, log
from typing import Any, NamedTuple, TypeVar

from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.rows import LANES
from separatrix.chain.impact_restitution import SOLID_LUBRICATION_LIMIT
from separatrix.chain.solution import Solution, solve
from separatrix.ground.units import Ratio, format_number
from separatrix.study.candidates import (
    other_than_candidates,
    ranking_question,
    reference_candidate,
    required_environment,
)
from separatrix.study.study import BallModel, RankingQuestion, StabilitySettings, Study
from separatrix.verdict.beyond_models import (
    NOT_FINISHED,
    PAPER_STATEMENT,
    Change,
    Effect,
    Moved,
    Pocket,
    beyond_motion,
    effects_on,
    not_finite,
    not_measured,
    pocket_of,
    reason,
)
from separatrix.verdict.critical_friction import (
    CageLimit,
    SafetyFactor,
    cage_limit,
    free_work,
    safety_factor,
    spread,
)
from separatrix.verdict.draws import Case, DrawnBearings, drawn_bearings
from separatrix.verdict.judgement import (
    CLEAR,
    Judgement,
    Verdict,
    is_mostly,
    judge_solution,
    transmitted_force,
    whirls_too_often,
)
from separatrix.verdict.long_jobs import Load, Runner, scattered
from separatrix.verdict.long_look import is_left_alone, long_look, look_record, seen_for_longer
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
from separatrix.verdict.reasons import ends
from separatrix.verdict.stability_curve import (
    CriticalFriction,
    RestitutionThreshold,
    StabilityCurve,
    critical_friction,
    curve_of_points,
    expected_load,
    restitution_threshold,
    threshold_factors,
)


class Asked(NamedTuple):
    """A verdict: on a pocket with a friction, by the study's model or by the paper's."""

    pocket: Pocket
    friction: Ratio
    is_paper: bool = False


@dataclass(frozen=True, slots=True)
class Knot:
    """A point of a pocket's curve, by the paper's model; None is the cage's own race damping."""

    pocket: Pocket
    restitution_factor: Ratio | None


@dataclass(frozen=True, slots=True)
class Limit:
    """Critical friction of a pocket's cage by the study's model, or with an effect on it."""

    pocket: Pocket
    effect: str = ""


@dataclass(frozen=True, slots=True)
class Longer:
    """A long look at a cage."""

    pocket: Pocket
    friction: Ratio
    runs: int
    is_free: bool = False  # among free balls


Piece = Asked | Knot | Limit | Longer | Case
"""What is computed in one go, a case for a verdict on drawn bearings."""

PieceOfPocket = TypeVar("PieceOfPocket", Knot, Limit)

Findings = Mapping[Piece, Any]
"""What was computed: a `Judgement`, also of a long look, a `CriticalFriction` of a knot, a `CageLimit`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Question:
    """Solutions by pocket, and what is to be computed with them."""

    settings: StabilitySettings
    solved: Sequence[Solution]  # of each candidate
    cages: Mapping[Pocket, Solution]
    is_paper: bool  # whether the study's model is the paper's
    spreads: Mapping[str, float]  # by candidate: what uncertain inputs do to its critical friction
    paper: Mapping[Pocket, Solution]  # of the same cages by the paper's model
    paper_cages: Mapping[Pocket, MovingCage]
    factors: Sequence[Ratio]  # restitution factors of the curves
    pockets: Mapping[str, Pocket]
    reference: Pocket
    environment: str  # the bearing's own
    effects: Mapping[str, Change]  # on the reference cage, by name
    drawn: DrawnBearings | None
    keys: Sequence[Asked]  # of all verdicts by the study's model
    beside: Sequence[Asked]  # of those by the paper's, in the bearing's own environment
    longer: Longer | None  # of the least friction in any environment; None in the paper's model
    runner: Runner

    @property
    def pieces(self) -> list[Piece]:
        """What is wanted: the longest first, as its runs wait for each other; then some of each kind.

        So an interrupt leaves verdicts, and what is left can be estimated.
        """
        cases = scattered(self.drawn.friction) if self.drawn else []
        knots = scattered(_knots(self, {}))  # two at a time: they are many, and verdicts may take long
        kinds: list[Sequence[Piece]] = [_limits(self, {}), knots[::2], knots[1::2]]
        kinds += [scattered(self.keys), scattered(self.beside), cases]
        in_turn = itertools.chain.from_iterable(itertools.zip_longest(*kinds))
        first = (self.longer, Knot(self.reference, None), *in_turn)
        return [piece for piece in first if piece is not None]


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
    tables = [frictions[environment], *frictions.values(), means]
    question = _question(study, asked, solved, tables, runner or Runner())
    pieces = question.pieces

    def ranking(found: Findings) -> Ranking:
        ranked = {name: _ranked(question, found, table, name) for name, table in frictions.items()}
        reference = question.cages[question.reference]
        look = found.get(question.longer) if question.longer else None
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
            effects=tuple(_effects(question, found)),
            long_look=look_record(look, question.longer.friction) if question.longer and look else None,
            capacity=transmitted_force(reference),
            notes=_notes(study, asked, question, found, ranked[environment]),
            complete={*pieces, *_between(question, found)} <= {*found},
        )

    return question.runner.work_out(
        partial(_computed, question),
        pieces,
        into=ranking,
        more=lambda _, found: _between(question, found),
        load=partial(_load, question),
    )


def _notes(
    study: Study, asked: RankingQuestion, question: _Question, found: Findings, rows: Sequence[Row]
) -> tuple[str, ...]:
    """Sentences for under the table: whose curve it is, and where chain and motion leave their models."""
    knots = [Knot(pocket, eta) for pocket in question.cages for eta in (*question.factors, None)]
    limits = (one for piece, one in found.items() if isinstance(piece, Limit) and not piece.effect)
    points = (found[knot] for knot in knots if knot in found)
    cages = question.paper_cages.values()
    notes = [note for one in (*question.solved, *limits, *cages, *points) for note in one.notes]
    notes += [other_than_candidates(study, asked)] if len(question.cages) > 1 else []
    if question.drawn and (failures := question.drawn.failures):
        share = f"{len(failures)} of {study.stability.runs}"
        notes.append(f"{share} draws of the uncertain inputs make no bearing: {failures[0]}")
    judged = [(row.name, row.judgement) for row in rows if not isinstance(row, NotMeasured) and row.judgement]
    moved = [Moved(n, j.largest_contact_force, j.largest_offset) for n, j in judged]
    reference = question.cages[question.reference]
    return (*beyond_motion(reference, moved), *filter(None, notes))


def _question(
    study: Study,
    asked: RankingQuestion,
    solved: Mapping[str, Solution],
    tables: Sequence[Mapping[str, MeanFriction | None]],
    runner: Runner,
) -> _Question:
    """What a ranking computes for tables of mean frictions, that of the bearing's own environment first."""
    pockets = {name: pocket_of(one) for name, one in solved.items()}
    cages = {pockets[name]: one for name, one in solved.items()}
    is_paper = study.cage is not None and study.cage.is_of_paper
    paper = {pocket: one.paper for pocket, one in cages.items()}
    reference = pockets[reference_candidate(study, asked).name]
    every = {(pockets[n], f.mean) for table in tables for n, f in table.items() if f is not None}
    keys = [Asked(*each) for each in sorted(every)]
    own = sorted({Asked(pockets[n], f.mean, True) for n, f in tables[0].items() if f is not None})
    least = min(keys, key=lambda one: one.friction) if keys and not is_paper else None
    paper_cages = {pocket: moving_cage(one, 0.0) for pocket, one in paper.items()}
    drawn = drawn_bearings(study, study.stability.runs) if study.distributions else None
    spreads = {}
    if drawn and not is_paper:
        spreads = {name: spread([own[name] for own in drawn.solved]) for name in solved}
    return _Question(
        settings=settings_for(study.stability, paper_cages[reference]),
        solved=[*solved.values()],
        cages=cages,
        is_paper=is_paper,
        spreads=spreads,
        paper=paper,
        paper_cages=paper_cages,
        factors=threshold_factors(study.stability),
        pockets=pockets,
        reference=reference,
        environment=required_environment(study, asked),
        effects={} if is_paper else dict(effects_on(cages[reference], moving_cage(cages[reference], 0.0))),
        drawn=drawn,
        keys=keys,
        beside=[] if is_paper else own,
        longer=least and Longer(least.pocket, least.friction, LANES),
        runner=runner,
    )


def _between(question: _Question, found: Findings) -> list[Piece]:
    """Critical frictions that are wanted, by the study's model and on the paper's curves, and long looks."""
    return [*_limits(question, found), *_knots(question, found), *_longer(question, found)]


def _longer(question: _Question, found: Findings) -> list[Longer]:
    """Long looks at stable cages, where that at the least friction finds that the land takes it over."""
    first = found.get(question.longer) if question.longer else None
    if first is None or is_left_alone(first):
        return []
    stable = [key for key in question.keys if key in found and found[key].verdict is Verdict.STABLE]
    return [_own_look(question, key, found[key]) for key in stable]


def _own_look(question: _Question, key: Asked, judgement: Judgement) -> Longer:
    return Longer(key.pocket, key.friction, question.settings.runs, judgement.ball == "free")


def _limits(question: _Question, found: Findings) -> list[Limit]:
    """Critical frictions that are wanted by the study's model, those with effects too."""
    if question.is_paper:
        return []
    return [
        *_not_between(question, found, Limit),
        *(Limit(question.reference, effect) for effect in question.effects),
    ]


def _knots(question: _Question, found: Findings) -> list[Knot]:
    """Points of the paper's curves that are wanted: all of the reference cage's."""
    own = [Knot(question.reference, eta) for eta in question.factors]
    others = (
        _not_between(question, found, partial(Knot, restitution_factor=eta)) for eta in question.factors
    )
    return [*own, *itertools.chain.from_iterable(others)]


def _not_between(
    question: _Question, found: Findings, piece: Callable[[Pocket], PieceOfPocket]
) -> list[PieceOfPocket]:
    """Pieces of pockets that differ in stiffness alone: of the ends; of all, if these say nothing of them."""
    wanted: list[PieceOfPocket] = []
    for alike in sorted({_alike(question, one) for one in question.cages}):
        ends = dict.fromkeys((alike[0], alike[-1]))
        soft, stiff = found.get(piece(alike[0])), found.get(piece(alike[-1]))
        is_open = soft is not None and stiff is not None and soft.between(stiff, 0.5) is None
        wanted += map(piece, alike if is_open else ends)
    return wanted


def _alike(question: _Question, pocket: Pocket) -> tuple[Pocket, ...]:
    """Pockets that differ from this one in stiffness alone, the softest first."""
    alike = (one for one in question.cages if one._replace(stiffness=pocket.stiffness) == pocket)
    return tuple(sorted(alike))


def _of_pocket(question: _Question, found: Findings, piece: Callable[[Pocket], Piece], pocket: Pocket) -> Any:
    """What was found of a pocket, its own or that between those of the ends; None if not finished."""
    alike = _alike(question, pocket)
    soft, own, stiff = (found.get(piece(one)) for one in (alike[0], pocket, alike[-1]))
    if own is not None or soft is None or stiff is None:
        return own
    share = log(pocket.stiffness / alike[0].stiffness) / log(alike[-1].stiffness / alike[0].stiffness)
    return soft.between(stiff, share)


def _load(question: _Question, piece: Piece) -> Load:
    """Work of a piece: runs of a verdict, of a limit, or those of a point."""
    if isinstance(piece, Knot):
        eta = piece.restitution_factor
        return expected_load(question.settings, eta, band=eta is None)
    kicks, settings = len(question.settings.kicks), question.settings
    if isinstance(piece, Longer):
        return Load(piece.runs, dear=20.0)
    if not isinstance(piece, Limit):
        return Load(kicks * settings.runs)
    free = free_work(question.cages[piece.pocket], settings, max(key.friction for key in question.keys))
    return Load(kicks * expected_load(settings, band=False).runs * (1.0 + free), 3.0, free > 0.0)


def _computed(question: _Question, piece: Piece) -> object:
    settings, runner = question.settings, question.runner
    if isinstance(piece, Case):
        return question.drawn and question.drawn.judge(piece, settings.kicks, runner)
    if isinstance(piece, Knot):
        cage, eta = question.paper_cages[piece.pocket], piece.restitution_factor
        stated = question.paper[piece.pocket].study.stability
        return critical_friction(cage, eta, stated, runner=runner, band=eta is None)
    if isinstance(piece, Limit):
        solution = question.cages[piece.pocket]
        highest = max(key.friction for key in question.keys)
        if not piece.effect:
            return cage_limit(solution, settings, runner, highest=highest)
        few = replace(settings, runs=max(1, settings.runs // 2))
        change = question.effects[piece.effect].values
        return cage_limit(solution, few, runner, highest=highest, change=change)
    if isinstance(piece, Longer):
        solution, ball = question.cages[piece.pocket], BallModel.FREE if piece.is_free else None
        return long_look(solution, piece.friction, settings, runner, piece.runs, ball)
    solved = question.paper if piece.is_paper else question.cages
    run = partial(runner.whole_ensemble, settings=settings)
    return judge_solution(solved[piece.pocket], piece.friction, run)


def _points(question: _Question, found: Findings, pocket: Pocket) -> list[CriticalFriction]:
    """Finished points of the curve of a pocket, rising restitution factors first."""
    pieces = (partial(Knot, restitution_factor=eta) for eta in question.factors)
    points = (_of_pocket(question, found, piece, pocket) for piece in pieces)
    return [point for point in points if point is not None]


def _curve(question: _Question, found: Findings) -> StabilityCurve | None:
    """Stability curve of the reference cage; None if an interrupt left no point of it."""
    points, shown = _points(question, found, question.reference), question.settings.restitution_factors
    complete, here = len(points) == len(question.factors), found.get(Knot(question.reference, None))
    points = [point for point in points if not shown or point.restitution_factor in shown]
    if not points:
        return None
    cage = question.paper_cages[question.reference]
    return curve_of_points(cage, question.settings, points, band=False, here=here, complete=complete)


def _ranked(
    question: _Question, found: Findings, table: Mapping[str, MeanFriction | None], environment: str
) -> tuple[Row, ...]:
    """Rows of one environment, best first; the order of the study within a rank."""
    known = {name: friction for name, friction in table.items() if friction is not None}
    rows = [_row(question, found, n, environment, f) for n, f in known.items()]
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


def _row(
    question: _Question, found: Findings, name: str, environment: str, friction: MeanFriction
) -> Ranked | NotFinished:
    """One candidate, not yet ranked."""
    pocket = question.pockets[name]
    eta = question.cages[pocket].restitution.restitution_factor
    values: dict[str, Any] = {
        "name": name,
        "friction": friction.mean,
        "friction_error": friction.error,
        "friction_deviation": friction.deviation,
        "friction_scatter_assumed": friction.assumed,
        "extrapolation": friction.extrapolation,
        "cage_mass": pocket.mass,
        "ball_cage_stiffness": pocket.stiffness,
        "pocket_clearance": pocket.clearance,
        "land_clearance": pocket.land or None,
        "restitution_factor": eta,
    }
    limit = _of_pocket(question, found, Limit, pocket)
    values |= _safety(limit, friction, question.spreads.get(name, 0.0))
    judgement = found.get(key := Asked(pocket, friction.mean))
    if judgement is None:
        return NotFinished(**values, reason=NOT_FINISHED)
    first = found.get(question.longer) if question.longer else None
    judgement = seen_for_longer(judgement, first, found.get(_own_look(question, key, judgement)))
    if broken := not_finite(judgement):
        return NotFinished(**values, reason=broken)
    values["judgement"] = judgement = beyond_critical(in_a_window(judgement, values), values)
    if judgement.is_by_land:
        values |= asdict(SafetyFactor())
    values["over_inputs"] = found.get(Case(name)) if environment == question.environment else None
    threshold = _threshold(question, found, pocket, friction)
    by_paper = Asked(pocket, friction.mean, True)
    papers = judgement if question.is_paper else found.get(by_paper)
    is_missing = papers is None and by_paper in question.beside
    if threshold is None or is_missing or (limit is None and not question.is_paper):
        missing = "threshold" if question.is_paper else "critical friction, or the paper's answer"
        return NotFinished(**values, reason=f"{judgement.reason} Its {missing}: {NOT_FINISHED}.")
    return Ranked(
        **values,
        reason=reason(threshold, judgement) if question.is_paper else judgement.reason,
        restitution_threshold=threshold.value,
        restitution_threshold_low=threshold.low,
        restitution_threshold_high=threshold.high,
        margin=threshold.value - eta,
        paper_verdict=None if papers is None else papers.verdict,
        paper_probability_stable=None if papers is None else papers.probability_stable,
    )


def in_a_window(judgement: Judgement, safety: Mapping[str, Any]) -> Judgement:
    """The judgement; UNDECIDED of a stable cage that less friction makes whirl, beyond their scatter."""
    high = safety.get("safety_factor_high")
    if judgement.verdict is not Verdict.STABLE or high is None or high >= 1.0:
        return judgement
    lower = f"half the runs whirl at a friction of {format_number(safety['own_critical_friction'], 3)}"
    reason = f"{judgement.reason} But {lower}: it is stable in a window, which a friction that falls leaves."
    return replace(judgement, verdict=Verdict.UNDECIDED, reason=reason)


def beyond_critical(judgement: Judgement, safety: Mapping[str, Any]) -> Judgement:
    """The judgement; UNSTABLE of an undecided cage that is not STABLE by its runs, nor by its safety factor.

    Surely more than a tenth of the runs whirl, and half of them may do so at its friction or less; or more
    than a tenth whirl, and half surely do so at less.
    """
    count = judgement.worst
    ends_of_factor = (safety.get(f"safety_factor_{end}") for end in ("low", "high"))
    low, high = (inf if end is None else end for end in ends_of_factor)
    is_beyond = low <= 1.0 and whirls_too_often(count)
    is_beyond |= (
        high < 1.0 and is_mostly(count.runs, count.runs) and count.whirls > (1.0 - CLEAR) * count.runs
    )
    if judgement.verdict is not Verdict.UNDECIDED or count.is_by_land or not is_beyond:
        return judgement
    critical = format_number(safety["own_critical_friction"], 3)
    said = f"Of {count.runs} runs from {count.kick:g} m/s {ends(count)}, and half whirl at a friction of "
    reason = f"{said}{critical}: neither calls it stable."
    return replace(judgement, verdict=Verdict.UNSTABLE, reason=reason)


def _safety(limit: CageLimit | None, friction: MeanFriction, spread: float) -> dict[str, Any]:
    """Critical friction and safety factor, as fields of a row; none without a limit."""
    if limit is None:
        return {}
    own = {f.name: getattr(limit, f.name) for f in fields(limit) if f.name not in ("notes", "steepness")}
    return own | asdict(safety_factor(limit, friction.mean, friction.interval(), spread))


def _effects(question: _Question, found: Findings) -> Iterator[Effect]:
    """Yield the critical frictions of the reference cage with what else moves them."""
    for name, change in question.effects.items():
        if limit := found.get(Limit(question.reference, name)):
            yield Effect(name=name, change=change.words, **limit.own)


def _threshold(
    question: _Question, found: Findings, pocket: Pocket, friction: MeanFriction
) -> RestitutionThreshold | None:
    """Threshold at the mean friction, its interval widened by those at the ends of the friction's."""
    points = _points(question, found, pocket)
    if len(points) < len(question.factors):
        return None
    value, *ends = (restitution_threshold(points, f) for f in (friction.mean, *friction.interval()))
    return replace(value, low=min(t.low for t in ends), high=max(t.high for t in ends))
