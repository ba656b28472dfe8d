"""A study with its uncertain inputs drawn: verdicts, what decides them, and what would have to be better.

A case is counted no longer than its verdict is open. For the friction that a new material may have,
P(settles) is followed with the same counts and the same search as the critical friction of one cage
(`crossing`), at the share of bearings that may fail.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated

import numpy as np

from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import MovingCage
from separatrix.chain.pocket_friction import with_scatter
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, MetrePerSecond, Ratio, Rows
from separatrix.study.candidates import ranking_question, reference_candidate, required_environment
from separatrix.study.distribution import LogNormal, described
from separatrix.study.study import BallModel, Study
from separatrix.verdict.beyond_models import (
    NOT_FINISHED,
    Moved,
    Pocket,
    beyond_motion,
    not_finite,
    not_measured,
    pocket_of,
)
from separatrix.verdict.crossing import SEARCHED_FRICTION, Count, Response, Side, ends_of, outermost
from separatrix.verdict.draws import Case, DrawnBearings, drawn_bearings
from separatrix.verdict.drivers import Drivers, TestGain, drivers, fitted, next_tests, reducible_shares
from separatrix.verdict.judgement import (
    CLEAR,
    FEW,
    Judgement,
    KickCount,
    Verdict,
    is_calm,
    judge,
    judge_by_ball,
    transmitted_force,
    wilson_interval,
)
from separatrix.verdict.long_jobs import Load, Runner, joined, scattered
from separatrix.verdict.ranking_records import MeanFriction, NotMeasured, overall

FEWEST = 64  # bearings below which no probability is worth a table
BLOCK = 64  # bearings after which a case is judged
RISK: Ratio = 1e-3
"""Probability, at each judgement, that a case is ended whose true share lies on the other side of a limit."""

NORMAL = 3.2905  # normal quantile of that probability, on both sides together
PROBABILITY: Ratio = 0.95  # wanted share of bearings that settle
RUNS = 128  # scale of the bearings counted for an allowed friction
Counted = tuple[Judgement, Ensemble]


@dataclass(frozen=True, slots=True, kw_only=True)
class InputRow:
    """One uncertain input with its distribution."""

    name: str  # its key in the study
    unit: str  # of mean and standard deviation, SI
    distribution: str  # in words
    source: str  # study, measured, or assumed (a guess)
    mean: float  # of the distribution
    standard_deviation: float  # of the distribution


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainMaterial:
    """One measured candidate in one environment, or over all of them."""

    name: str  # of the candidate
    friction: Ratio  # mean of the friction of a new cage
    friction_deviation: Ratio  # standard deviation of the friction of a new cage
    friction_scatter_assumed: bool  # whether that is the default, a guess
    extrapolation: tuple[str, ...]  # in what respect the friction is extrapolated beyond its tests
    restitution_factor: Ratio  # median over the bearings
    restitution_factor_low: Ratio  # 5 % quantile of the bearings
    restitution_factor_high: Ratio  # 95 % quantile of the bearings
    judgement: Judgement | None = None  # each run with its own bearing; null where `reason` states why
    reason: str  # a sentence with the numbers


@dataclass(frozen=True, slots=True, kw_only=True)
class NotDrawn(NotMeasured):
    """A candidate without a measured friction in this environment."""


UncertainRow = UncertainMaterial | NotDrawn


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainEnvironment:
    """The candidates in one environment, best first; those not measured come last."""

    name: str  # medium and counterface
    materials: Annotated[tuple[UncertainRow, ...], Rows("material", "material_", label="name")]
    """A row for each candidate, best first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AllowedFriction:
    """Largest pocket friction of a new material at which a bearing settles with a probability."""

    names: tuple[str, ...]  # candidates whose pockets it is for
    probability: Ratio  # wanted, to settle
    scatter: Ratio  # assumed of a new cage, as a share of the mean
    friction: Ratio | None  # largest mean friction; null where `reason` states why
    friction_low: Ratio | None  # lower end of the 95 % interval
    friction_high: Ratio | None  # upper end of the 95 % interval
    reason: str  # why there is no limit; empty if there is


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainStudy:
    """Answer of `sensitivity`; a case whose verdict is decided early has fewer runs."""

    bearings: int  # drawn for each case
    failed: int  # of these, that do not make a bearing
    stopped_risk: Ratio  # largest probability that an ended case would decide otherwise
    default_scatter: Ratio  # of an unrepeated friction test, as a share of the mean
    environment: str  # the bearing's own
    inputs: Annotated[tuple[InputRow, ...], Rows("input", "input_", label="name")]
    """A row for each uncertain input."""
    environments: Annotated[tuple[UncertainEnvironment, ...], Rows("environment", label="name")]
    """The candidates in each."""
    overall: Annotated[tuple[UncertainRow, ...], Rows("material", "overall_", label="name")]
    """With the mean friction over all environments."""
    drivers: tuple[Drivers, ...]  # inputs that decide each case
    undecided: tuple[str, ...]  # cases without a verdict
    next_tests: tuple[TestGain, ...]  # best first
    allowed_friction: tuple[AllowedFriction, ...]  # of a new material
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    runs: int  # of each bearing, from each disturbance
    notes: tuple[str, ...]  # what was left out and why, a sentence each
    complete: bool  # false if an interrupt left something out


def uncertain_study(study: Study, bearings: int, *, runner: Runner | None = None) -> UncertainStudy:
    """Draw bearings from the uncertain inputs of a study and judge the cages of every candidate.

    Their number is best a power of two, and at least `FEWEST`. A friction without stated scatter has the
    study's default one, a guess. The numbers do not depend on the runner.

    Raises
    ------
    InputError
        Too few bearings, no candidates, or no draw makes a bearing.
    Interrupted
        With the answer to what was finished, if anything was.
    """
    ranking_question(study)
    if bearings < FEWEST:
        cure = "Powers of two spread most evenly: 512."
        raise InputError("--samples", f"must be at least {FEWEST}", got=str(bearings), cure=cure)
    drawn, runner = drawn_bearings(study, bearings), runner or Runner()
    alike: dict[Pocket, list[str]] = {}
    for name in dict.fromkeys(case.candidate for case in drawn.friction):
        alike.setdefault(pocket_of(drawn.central[name]), []).append(name)
    pieces: list[Case | Pocket] = scattered([*drawn.friction, *alike])

    def compute(piece: Case | Pocket) -> Counted | AllowedFriction:
        if isinstance(piece, Case):
            return counted(drawn, piece, runner)
        return allowed_friction(drawn, alike[piece], runner)

    def answer(found: Mapping[Case | Pocket, Counted | AllowedFriction]) -> UncertainStudy:
        judged = {case: one for case in drawn.friction if isinstance(one := found.get(case), tuple)}
        allowed = [one for pocket in alike if isinstance(one := found.get(pocket), AllowedFriction)]
        complete = len(found) == len(pieces)
        return replace(_answer(study, drawn, judged, allowed, bearings), complete=complete)

    def load(piece: Case | Pocket) -> Load:
        """Work of a piece, in runs: for a pocket a search from each kick."""
        return Load(len(drawn.kicks) * (len(drawn.runs) if isinstance(piece, Case) else 2 * RUNS))

    return runner.work_out(compute, pieces, into=answer, load=load)


def _answer(
    study: Study,
    drawn: DrawnBearings,
    judged: Mapping[Case, Counted],
    allowed: Sequence[AllowedFriction],
    asked: int,
) -> UncertainStudy:
    """Record of what was computed, as if nothing was left out."""
    ranking = ranking_question(drawn.study)
    decided = {case: _drivers(drawn, case, one) for case, one in judged.items() if case.environment}
    undecided = [case for case in decided if judged[case][0].verdict is Verdict.UNDECIDED]
    environment = required_environment(study, ranking)
    own = _rows(drawn, environment, judged)
    moved = [
        Moved(row.name, found.largest_contact_force, found.largest_offset, found.by_kick)
        for row in own
        if isinstance(row, UncertainMaterial) and (found := row.judgement)
    ]
    central = drawn.central[reference_candidate(study, ranking).name]
    open_cases = {case: judged[case] for case in undecided if decided[case].shares}
    failed = len(drawn.failures)
    notes = (
        [f"{failed} of {asked} draws make no bearing and are left out: {drawn.failures[0]}"] if failed else []
    )
    chain = (note for one in drawn.central.values() for note in one.notes)
    return UncertainStudy(
        bearings=asked,
        failed=failed,
        stopped_risk=RISK,
        default_scatter=ranking.friction_scatter,
        environment=environment,
        inputs=tuple(
            InputRow(
                name=one.key,
                unit=one.unit,
                distribution=one.distribution.text or described(one.distribution, one.unit),
                source=one.source,
                mean=one.distribution.mean,
                standard_deviation=one.distribution.standard_deviation,
            )
            for one in drawn.inputs
        ),
        environments=tuple(
            UncertainEnvironment(name=place, materials=_rows(drawn, place, judged))
            for place in ranking.environments
        ),
        overall=_rows(drawn, "", judged),
        drivers=tuple(decided.values()),
        undecided=tuple(map(_words, undecided)),
        next_tests=_next_tests(drawn, open_cases),
        allowed_friction=tuple(allowed),
        kicks=drawn.kicks,
        runs=sum(ensemble.outcome.size for _, ensemble in judged.values()),
        notes=(*chain, *notes, *beyond_motion(central, moved)),
        complete=True,
    )


def _rows(drawn: DrawnBearings, environment: str, judged: Mapping[Case, Counted]) -> tuple[UncertainRow, ...]:
    """Rows of an environment: verdicts first that are better, then the larger P(stable)."""
    ranking = ranking_question(drawn.study)
    means: dict[str, MeanFriction | None] = {}
    for candidate in ranking.candidates:
        places = (environment,) if environment else ranking.environments
        cases = [Case(candidate.name, place) for place in places]
        known = [drawn.stated[case] for case in cases if case in drawn.stated]
        means[candidate.name] = overall(with_scatter(one, ranking.friction_scatter) for one in known)
    measured = {name: one for name, one in means.items() if one is not None}
    rows = [_row(drawn, Case(n, environment), f, judged) for n, f in measured.items()]
    others = (NotDrawn(name=n, reason=not_measured(environment)) for n in means if n not in measured)
    return (*sorted(rows, key=_best_first), *others)


def _row(
    drawn: DrawnBearings,
    case: Case,
    mean: MeanFriction,
    judged: Mapping[Case, Counted],
) -> UncertainMaterial:
    """One candidate in one environment."""
    factors = [one[case.candidate].restitution.restitution_factor for one in drawn.solved]
    eta, eta_low, eta_high = np.quantile(factors, (0.5, 0.05, 0.95)).tolist()
    judgement = judged[case][0] if case in judged else None
    broken = not_finite(judgement) if judgement else NOT_FINISHED
    return UncertainMaterial(
        name=case.candidate,
        friction=mean.mean,
        friction_deviation=float(np.std(drawn.friction[case])),
        friction_scatter_assumed=mean.assumed,
        extrapolation=mean.extrapolation,
        restitution_factor=eta,
        restitution_factor_low=eta_low,
        restitution_factor_high=eta_high,
        judgement=None if broken else judgement,
        reason=broken or (judgement.reason if judgement else ""),
    )


def _best_first(row: UncertainMaterial) -> tuple[int, float, float]:
    order = {Verdict.STABLE: 0, Verdict.UNDECIDED: 1, Verdict.UNSTABLE: 2}
    if row.judgement is None:
        return 3, 0.0, row.friction
    return order[row.judgement.verdict], -row.judgement.probability_stable, row.friction


def _columns(drawn: DrawnBearings, case: Case) -> list[int]:
    """Inputs that may matter to a case: all but the frictions and materials of others."""
    own = (f"ranking.{case.candidate}.{case.environment}", f"ranking.{case.candidate}.material.")
    return [
        i
        for i, one in enumerate(drawn.inputs)
        if not one.key.startswith("ranking.") or one.key == own[0] or one.key.startswith(own[1])
    ]


def _drivers(drawn: DrawnBearings, case: Case, found: Counted) -> Drivers:
    """What decides a case, by a regression of its runs."""
    settled, columns = settles(found[1], found[0]), _columns(drawn, case)
    names = [drawn.inputs[i].key for i in columns]
    return drivers(case, names, drawn.scores[: settled.size, columns], settled)


def _next_tests(drawn: DrawnBearings, cases: Mapping[Case, Counted]) -> tuple[TestGain, ...]:
    """What measuring each input would settle of these cases."""
    asked = {}
    for case, (judged, found) in cases.items():
        settled, columns = settles(found, judged), _columns(drawn, case)
        scores = drawn.scores[: settled.size]
        b = np.zeros(1 + len(drawn.inputs))
        b[[0, *(1 + i for i in columns)]] = fitted(scores[:, columns], settled)
        asked[_words(case)] = (b, scores)
    return next_tests(drawn.inputs, reducible_shares(drawn.study, drawn.inputs), asked)


def _words(case: Case) -> str:
    return f"{case.candidate} in {case.environment}"


def counted(bearings: DrawnBearings, case: Case, runner: Runner) -> Counted:
    """Verdict on a case by the ball that decides, and the runs behind it: see `counted_among`."""
    ran: list[Ensemble] = []

    def judged(cage: MovingCage) -> Judgement:
        found, runs = counted_among(bearings, case, runner, cage)
        ran.append(runs)
        return found

    return judge_by_ball(bearings.central[case.candidate], bearings.central_friction(case), judged), ran[-1]


def counted_among(bearings: DrawnBearings, case: Case, runner: Runner, cage: MovingCage) -> Counted:
    """Run the bearings of a case in blocks, among such balls as the central `cage` has.

    All have run in the end, or the verdict is decided. A kick from which significantly more bearings settle
    than from the worst is not run further; its count stays in the judgement, whose other evidence is that of
    the kicks that are left.
    """
    capacity = transmitted_force(bearings.central[case.candidate])
    ball = None if cage.free_ball is None else BallModel.FREE
    parts: list[Ensemble] = []
    left_out: list[KickCount] = []
    total, kicks = len(bearings.runs), list(bearings.kicks)
    for first in range(0, total, BLOCK):
        places = range(first, min(first + BLOCK, total))
        parts.append(bearings.ensemble(case, kicks, places, runner, ball=ball))
        found = joined(parts)
        judged = judge(cage, found, capacity=capacity)
        if is_plain(judged):
            break
        better = [one for one in judged.by_kick if settles_more(one, judged)]
        if better:
            left_out += better
            kept = [i for i, one in enumerate(judged.by_kick) if one not in better]
            kicks = [kicks[i] for i in kept]
            by_kick = {f.name for f in fields(found) if np.ndim(getattr(found, f.name)) > 0}
            found = replace(found, **{name: getattr(found, name)[kept] for name in by_kick})
            judged, parts = judge(cage, found, capacity=capacity), [found]
    counts = sorted((*left_out, *judged.by_kick), key=lambda one: one.kick)
    return replace(judged, by_kick=tuple(counts)), found


def settles_more(count: KickCount, judged: Judgement) -> bool:
    """Whether significantly more settle or roll from a kick than from the worst; most, in their pockets."""
    worst = next(one for one in judged.by_kick if one.kick == judged.worst_kick)
    low = wilson_interval(count.calm, count.runs, NORMAL)[0]
    return 2 * count.kept_by_land <= count.runs and low > max(
        FEW, wilson_interval(worst.calm, worst.runs, NORMAL)[1]
    )


def is_plain(judged: Judgement) -> bool:
    """Whether the shares behind a verdict lie beyond its limits by more than `RISK` leaves open."""
    worst = next(count for count in judged.by_kick if count.kick == judged.worst_kick)
    if judged.verdict is Verdict.STABLE:
        return all(wilson_interval(one.calm, one.runs, NORMAL)[0] >= CLEAR for one in judged.by_kick)
    return judged.verdict is Verdict.UNSTABLE and wilson_interval(worst.whirls, worst.runs, NORMAL)[0] > FEW


def settles(found: Ensemble, judged: Judgement) -> Array:
    """1 for each bearing that settles or rolls from the worst kick, else 0; shape (bearing,)."""
    at = found.kicks.tolist().index(judged.worst_kick)
    return is_calm(found.outcome[at]).astype(np.float64)


def allowed_friction(bearings: DrawnBearings, names: Sequence[str], runner: Runner) -> AllowedFriction:
    """Largest mean friction of a new material, with the default scatter, in the pockets of some candidates.

    From the worst kick the share of bearings that do not settle then passes what may fail.
    """
    own = next(case for case in bearings.friction if case.candidate == names[0])
    scatter, total = ranking_question(bearings.study).friction_scatter, len(bearings.runs)
    shares = np.ones(total)
    if scatter > 0.0:
        random = np.random.default_rng((bearings.study.stability.seed, total))
        law = LogNormal(mean=1.0, standard_deviation=scatter)
        shares = law.quantile((random.permutation(total) + 0.5) / total)

    def response(kick: MetrePerSecond) -> Response:
        def look(friction: Ratio, first: int, runs: int) -> Count:
            def changed(place: int, cage: MovingCage) -> MovingCage:
                return replace(cage, ball_cage_friction=friction * float(shares[place]))

            places = [place % total for place in range(first, first + runs)]
            ran = bearings.ensemble(own, (kick,), places, runner, changed)
            return Count(int(np.count_nonzero(~is_calm(ran.outcome))), runs)

        return Response(look, RUNS)

    responses = {kick: response(kick) for kick in bearings.kicks}
    found, _ = outermost(responses, 1.0 - PROBABILITY, RUNS, 0.1)
    value, low, high = ends_of(found)
    reasons = {
        Side.ABOVE: "fewer settle even without pocket friction",
        Side.BELOW: f"more settle at every friction up to {SEARCHED_FRICTION:g}",
    }
    return AllowedFriction(
        names=tuple(names),
        probability=PROBABILITY,
        scatter=scatter,
        friction=value,
        friction_low=low,
        friction_high=high,
        reason=reasons[found] if isinstance(found, Side) else "",
    )
