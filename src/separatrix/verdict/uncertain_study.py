r"""A study with its uncertain inputs drawn: verdicts in its own environment, and what decides them.

A case is counted no longer than its verdict is open. Its runs are described by a regression

.. math:: \operatorname{logit} P(\text{settles}) = b_0 + \sum_i b_i z_i

with the draws :math:`z_i` as standard normal numbers. The inputs are independent, so :math:`b_i^2` is what
input i adds to the variance of the logit, beside the :math:`\pi^2/3` of a logistic variable that is the
chance of the single run: its disturbance and the leads of its balls. The regression is tested on bearings
that it was not fitted to.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated

import numpy as np
from scipy.special import expit, stdtrit, xlogy

from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import MovingCage
from separatrix.chain.pocket_friction import with_scatter
from separatrix.ground.units import Array, MetrePerSecond, Ratio, Rows
from separatrix.study.candidates import ranking_question, reference_candidate, required_environment
from separatrix.study.study import Study
from separatrix.study.uncertain import described
from separatrix.verdict.beyond_models import (
    NOT_FINISHED,
    Moved,
    beyond_motion,
    not_finite,
    not_measured,
)
from separatrix.verdict.draws import Case, DrawnBearings, drawn_bearings
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
from separatrix.verdict.ranking_records import NotMeasured, measured


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Part of a variance that one input brings, and its 95 % interval [-]."""

    name: str  # the input; chance is that of the single run
    share: Ratio  # of the variance
    share_low: Ratio  # lower end of the 95 % interval
    share_high: Ratio  # upper end of the 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Drivers:
    """Which inputs decide whether a bearing with a candidate's cage settles."""

    name: str  # of the candidate
    shares: tuple[Share, ...]
    """Of the variance of the logit of P(settles), largest first, chance last; empty where `reason` states
    why."""
    reason: str  # why there are no shares; empty otherwise
    skill: Ratio | None  # part of the deviance that the fit removes, on bearings left out


PRIOR = 3.0  # standard deviation of the coefficients beforehand: a separation by one input alone stays finite
FOLDS = 8  # parts of the bearings, each left out of one fit
FEWEST = 30  # bearings of the rarer outcome below which the inputs are not compared
LEAST_SKILL: Ratio = 0.02  # part of the deviance below which the inputs explain nothing that counts
CHANCE = "chance of the single run"
CHANCE_VARIANCE = math.pi**2 / 3.0


def drivers(name: str, names: Sequence[str], scores: Array, settled: Array) -> Drivers:
    """Shares of the inputs in the variance of a candidate's logit, with the skill on bearings left out.

    `names` are the inputs, `scores` their draws as standard normal numbers, shape (bearing, input); `settled`
    is 1 where the bearing settles, shape (bearing,).
    """
    rare = int(min(settled.sum(), settled.size - settled.sum()))
    skill: Ratio | None = None
    shares: tuple[Share, ...] = ()
    reason = f"{rare} of {settled.size} bearings end otherwise: too few to compare; draw more"
    if rare >= FEWEST and names:
        of_mean = _deviance(np.full(settled.size, settled.mean()), settled)
        skill = 1.0 - _deviance(_left_out(scores, settled), settled) / of_mean
        shares = _shares(names, scores, settled) if skill >= LEAST_SKILL else ()
        reason = f"the inputs explain {max(0.0, 100.0 * skill):.1f} % of the deviance only"
    return Drivers(
        name=name,
        shares=shares,
        reason="" if shares else reason,
        skill=skill,
    )


def fitted(scores: Array, settled: Array) -> Array:
    """Coefficients of the regression, the constant first, shape (1 + input,): Newton's steps."""
    design = np.column_stack((np.ones(len(scores)), scores))
    penalty = np.full(design.shape[1], PRIOR**-2)
    penalty[0] = 0.0
    share = np.clip(settled.mean(), 0.5 / settled.size, 1.0 - 0.5 / settled.size)
    b = np.zeros(design.shape[1])
    b[0] = math.log(share / (1.0 - share))
    for _ in range(MOST_STEPS):
        p = expit(design @ b)
        gradient = design.T @ (settled - p) - penalty * b
        curvature = (design.T * (p * (1.0 - p))) @ design + np.diag(penalty)
        step = np.linalg.solve(curvature, gradient)
        b += step * min(1.0, LONGEST_STEP / max(np.abs(step).max(), 1e-300))
        if np.abs(step).max() < 1e-10:
            break
    return b


MOST_STEPS, LONGEST_STEP = 100, 2.0


def _left_out(scores: Array, settled: Array) -> Array:
    """Prediction for each bearing by a fit to the others, shape (bearing,)."""
    fold = np.arange(settled.size) % FOLDS
    found = np.empty(settled.size)
    for k in range(FOLDS):
        b = fitted(scores[fold != k], settled[fold != k])
        found[fold == k] = expit(b[0] + scores[fold == k] @ b[1:])
    return found


def _deviance(predicted: Array, settled: Array) -> float:
    return float(-2.0 * np.sum(xlogy(settled, predicted) + xlogy(1.0 - settled, 1.0 - predicted)))


def _shares(names: Sequence[str], scores: Array, settled: Array) -> tuple[Share, ...]:
    """Share of each input, largest first, and of chance; intervals by the jackknife over the folds."""
    fold = np.arange(settled.size) % FOLDS
    whole = _parts(fitted(scores, settled))
    others = np.array([_parts(fitted(scores[fold != k], settled[fold != k])) for k in range(FOLDS)])
    scatter = np.sqrt((FOLDS - 1.0) / FOLDS * np.sum((others - others.mean(axis=0)) ** 2, axis=0))
    half = float(stdtrit(FOLDS - 1, 0.975)) * scatter
    rows = [
        Share(name=name, share=float(x), share_low=max(0.0, float(x - h)), share_high=min(1.0, float(x + h)))
        for name, x, h in zip((*names, CHANCE), whole, half, strict=True)
    ]
    return (*sorted(rows[:-1], key=lambda one: -one.share), rows[-1])


def _parts(b: Array) -> Array:
    """Shares of the inputs and of chance in the variance of the logit."""
    parts = np.append(b[1:] ** 2, CHANCE_VARIANCE)
    return np.asarray(parts / parts.sum())


BLOCK = 64  # bearings after which a case is judged
RISK: Ratio = 1e-3
"""Probability, at each judgement, that a case is ended whose true share lies on the other side of a limit."""

NORMAL = 3.2905  # normal quantile of that probability, on both sides together
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
    """One measured candidate."""

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
    """A candidate without a measured friction in the bearing's environment."""


UncertainRow = UncertainMaterial | NotDrawn


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainStudy:
    """Answer of `sensitivity`; a case whose verdict is decided early has fewer runs."""

    bearings: int  # drawn for each case
    failed: int  # of these, that do not make a bearing
    stopped_risk: Ratio  # largest probability that an ended case would decide otherwise
    default_scatter: Ratio  # of an unrepeated friction test, as a share of the mean
    environment: str  # the bearing's own, of all rows
    inputs: Annotated[tuple[InputRow, ...], Rows("input", "input_", label="name")]
    """A row for each uncertain input."""
    materials: Annotated[tuple[UncertainRow, ...], Rows("material", "material_", label="name")]
    """A row for each candidate, best first; those not measured come last."""
    drivers: tuple[Drivers, ...]  # inputs that decide each case
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    runs: int  # of each bearing, from each disturbance
    notes: tuple[str, ...]  # what was left out and why, a sentence each
    complete: bool  # false if an interrupt left something out


def uncertain_study(study: Study, bearings: int, *, runner: Runner | None = None) -> UncertainStudy:
    """Draw bearings from the uncertain inputs of a study and judge the cages of every candidate.

    Their number is best a power of two. A friction without stated scatter has the
    study's default one, a guess. The numbers do not depend on the runner.

    Raises
    ------
    InputError
        No candidates, or no draw makes a bearing.
    Interrupted
        With the answer to what was finished, if anything was.
    """
    required_environment(study, ranking_question(study))
    drawn, runner = drawn_bearings(study, bearings), runner or Runner()
    return runner.work_out(
        lambda case: counted(drawn, case, runner),
        scattered(drawn.friction),
        into=lambda judged: _answer(drawn, judged, bearings),
        load=lambda _: Load(len(drawn.kicks) * min(BLOCK, len(drawn.runs))),  # most are plain after one
    )


def _answer(drawn: DrawnBearings, judged: Mapping[Case, Counted], asked: int) -> UncertainStudy:
    """Record of what was computed."""
    ranking = ranking_question(drawn.study)
    rows = _rows(drawn, judged)
    moved = [
        Moved(row.name, found.largest_contact_force, found.largest_offset)
        for row in rows
        if isinstance(row, UncertainMaterial) and (found := row.judgement)
    ]
    central = drawn.central[reference_candidate(drawn.study, ranking).name]
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
        environment=required_environment(drawn.study, ranking),
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
        materials=rows,
        drivers=tuple(_drivers(drawn, case, judged[case]) for case in drawn.friction if case in judged),
        kicks=drawn.kicks,
        runs=sum(ensemble.outcome.size for _, ensemble in judged.values()),
        notes=(*chain, *notes, *beyond_motion(central, moved)),
        complete=len(judged) == len(drawn.friction),
    )


def _rows(drawn: DrawnBearings, judged: Mapping[Case, Counted]) -> tuple[UncertainRow, ...]:
    """A row for each candidate: verdicts first that are better, then the larger P(stable)."""
    ranking = ranking_question(drawn.study)
    rows = [_row(drawn, case, judged) for case in drawn.stated]
    reason = not_measured(required_environment(drawn.study, ranking))
    others = (one.name for one in ranking.candidates if Case(one.name) not in drawn.stated)
    return (*sorted(rows, key=_best_first), *(NotDrawn(name=one, reason=reason) for one in others))


def _row(drawn: DrawnBearings, case: Case, judged: Mapping[Case, Counted]) -> UncertainMaterial:
    """One measured candidate."""
    mean = measured(with_scatter(drawn.stated[case], ranking_question(drawn.study).friction_scatter))
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


def _drivers(drawn: DrawnBearings, case: Case, found: Counted) -> Drivers:
    """What decides a case, by a regression of its runs on all inputs but those of other candidates."""
    own = f"ranking.{case.candidate}."
    columns = [
        i
        for i, one in enumerate(drawn.inputs)
        if not one.key.startswith("ranking.") or one.key.startswith(own)
    ]
    settled, names = settles(found[1], found[0]), [drawn.inputs[i].key for i in columns]
    return drivers(case.candidate, names, drawn.scores[: settled.size, columns], settled)


def counted(bearings: DrawnBearings, case: Case, runner: Runner) -> Counted:
    """Verdict on a case by the ball that decides, and the runs behind it: see `counted_among`."""
    ran: list[Ensemble] = []

    def judged(cage: MovingCage) -> Judgement:
        found, runs = counted_among(bearings, case, runner, cage)
        ran.append(runs)
        return found

    return judge_by_ball(bearings.central[case.candidate], bearings.stated[case].mean, judged), ran[-1]


def counted_among(bearings: DrawnBearings, case: Case, runner: Runner, cage: MovingCage) -> Counted:
    """Run the bearings of a case in blocks, among such balls as the central `cage` has.

    All have run in the end, or the verdict is decided. A kick from which significantly more bearings settle
    than from the worst is not run further; its count stays in the judgement, whose other evidence is that of
    the kicks that are left.
    """
    capacity = transmitted_force(bearings.central[case.candidate])
    parts: list[Ensemble] = []
    left_out: list[KickCount] = []
    total, kicks = len(bearings.runs), list(bearings.kicks)
    for first in range(0, total, BLOCK):
        places = range(first, min(first + BLOCK, total))
        parts.append(bearings.ensemble(case, kicks, places, runner, cage))
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
    """Whether significantly more settle or roll from a kick than from the worst."""
    worst = next(one for one in judged.by_kick if one.kick == judged.worst_kick)
    low = wilson_interval(count.calm, count.runs, NORMAL)[0]
    return low > max(FEW, wilson_interval(worst.calm, worst.runs, NORMAL)[1])


def is_plain(judged: Judgement) -> bool:
    """Whether the shares behind a verdict lie beyond its limits by more than `RISK` leaves open."""
    worst = next(count for count in judged.by_kick if count.kick == judged.worst_kick)
    if judged.verdict is Verdict.STABLE:
        return all(wilson_interval(one.calm, one.runs, NORMAL)[0] >= CLEAR for one in judged.by_kick)
    few = 1.0 - CLEAR if judged.is_by_land else FEW
    return judged.verdict is Verdict.UNSTABLE and wilson_interval(worst.whirls, worst.runs, NORMAL)[0] > few


def settles(found: Ensemble, judged: Judgement) -> Array:
    """1 for each bearing that settles or rolls from the worst kick, else 0; shape (bearing,)."""
    at = found.kicks.tolist().index(judged.worst_kick)
    return is_calm(found.outcome[at]).astype(np.float64)
