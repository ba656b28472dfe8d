"""Where a cage is stable in the plane of any two parameters of a study: the stability map."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise, product
from math import comb
from typing import Annotated

import numpy as np

from separatrix.cage.disturbance import with_kicks
from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.outcome import RunOutcome
from separatrix.chain.pocket_friction import pocket_speed
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Metre, MetrePerSecond, Newton, PerSecond, Ratio, Rows, Second
from separatrix.study.candidates import require_friction
from separatrix.study.study import StabilitySettings, Study
from separatrix.verdict.critical_friction import cage_at
from separatrix.verdict.judgement import Verdict, decide, is_calm, is_clear, wilson_interval
from separatrix.verdict.long_jobs import Runner, joined, scattered
from separatrix.verdict.parameter_axes import FRICTION, KICK, RESTITUTION, MapAxis, value_in, varied

AGREEING = 6
"""A point is decided once this number of runs agree from the first on; otherwise all its runs are made."""

MOST_WRONG: Ratio = 1e-3
"""Largest probability that all the runs of such a point would have the other majority."""

MOST_LINKS = 1024  # links of the chain that are remembered
OF_THE_CAGE = (RESTITUTION, FRICTION, KICK)  # parameters that change nothing before the cage itself
NOT_RUN = "not run: interrupted"
ROUNDING = 1e-9  # share of a value below which its distance to a band is the rounding of its unit
SETTLES, WHIRLS, EITHER = -1, 1, 0  # side of one half on which P(whirl) lies


class State(Enum):
    """What became of a point of a map."""

    RUN = "run"
    REFUSED = "refused"
    NOT_RUN = "not run, for an interrupt"


@dataclass(frozen=True, slots=True, kw_only=True)
class MapPoint:
    """Result of the runs at one point of a map; None where it could not be run, with the reason."""

    x: float  # value of the parameter x, SI
    y: float  # value of the parameter y, SI
    state: State = State.NOT_RUN  # whether it was run, refused or left out
    decision: Verdict | None = None  # by the rule of `cage.judge`, from the runs that were made
    probability_whirl: Ratio | None = None  # share of the runs that whirl
    probability_low: Ratio | None = None  # lower end of its 95 % Wilson interval
    probability_high: Ratio | None = None  # upper end of its 95 % Wilson interval
    runs: int = 0  # that were made
    whirling: int = 0  # runs that whirl
    growth_rate: PerSecond | None = None  # median over the runs
    largest_offset: Metre | None = None  # of the cage centre in any run
    drift_rate: PerSecond | None = None  # median over the runs
    largest_contact_force: Newton | None = None  # between a ball and its pocket in any run
    restitution_factor: Ratio | None = None  # of the chain at this point, or of the axis
    margin: float | None = None
    """Distance along y to the nearest change of its column, positive where the motion settles, negative where
    it whirls, 0 in the band; null in a column that does not change."""
    reason: str = NOT_RUN  # of the decision, or why there is none
    notes: tuple[str, ...] = ()  # where its chain leaves the range of a model, a sentence each

    @property
    def side(self) -> int:
        """Whether more than half of the runs whirl (1), settle (-1), or neither is sure (0)."""
        if self.probability_low is None or self.probability_high is None:
            return EITHER
        return WHIRLS if self.probability_low > 0.5 else SETTLES if self.probability_high < 0.5 else EITHER


@dataclass(frozen=True, slots=True, kw_only=True)
class MapChange:
    """Between these two neighbouring decided points of a column the motion changes from rest to a whirl."""

    x: float  # value of x in this column
    y_low: float  # last point below the change
    y_high: float  # first point above the change
    whirls_above: bool  # whether the cage whirls above the band, or below it
    margin: float | None = None
    """Distance of the study's own y to this band, negative where it whirls; null if the study has none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stopping:
    """When a point is ended early, and how often that is wrong at the worst."""

    most_runs: int  # of a point
    agreeing_runs: int  # a point ends once this number of first runs agree
    wrong_side_probability: Ratio  # largest, over all points, that all the runs would have the other majority
    other_decision_probability: Ratio
    """Largest that all the runs would decide otherwise: of a point all but decided."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapQuestion:
    """The question of a map."""

    study: Study  # with a [cage]
    x: MapAxis  # another parameter than y
    y: MapAxis
    kick: MetrePerSecond  # initial disturbance of every point, unless an axis has it
    runs: int = 16  # most runs of a point


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityMap:
    """A map: its points, column after column of x, and the bands in which the answer changes."""

    x: MapAxis  # horizontal axis
    y: MapAxis  # vertical axis
    points: Annotated[tuple[MapPoint, ...], Rows("point", "point_")]  # column after column of x
    changes: Annotated[tuple[MapChange, ...], Rows("change", "change_")]
    """Bands between motion that settles and a whirl."""
    counts: Annotated[Mapping[str, int], Rows(prefix="points_")]  # points of each decision, refused, not run
    kick: MetrePerSecond  # initial disturbance of every point, unless an axis has it
    stopping: Stopping  # when a point is ended early
    duration: Second  # of a run
    ball_scatter: Ratio  # initial lead or lag of the balls, over half the pocket clearance
    complete: bool  # false if an interrupt left points out

    @property
    def notes(self) -> tuple[str, ...]:
        """Where chains of its points leave the range of a model, a sentence each."""
        return tuple(note for point in self.points for note in point.notes)


Place = tuple[int, int]  # column and row


def stability_map(question: MapQuestion, *, runner: Runner | None = None) -> StabilityMap:
    """Decide every point of a map, scattered over the plane, so that an interrupted map covers all of it.

    Run number r begins alike at every point. A point whose study is refused, or whose chain does not settle,
    is a point with that reason. The numbers do not depend on the runner.

    Raises
    ------
    InputError
        The study names no pocket friction and no axis is it, or no point at all could be run.
    Interrupted
        With the map of the points that were finished, if any was.
    """
    if FRICTION not in (question.x.parameter, question.y.parameter):
        require_friction(question.study)
    runner, (xs, ys) = runner or Runner(), (question.x.values, question.y.values)
    point, report = PointFinder(question, runner), runner.progress
    return runner.work_out(
        lambda place: point(xs[place[0]], ys[place[1]]),
        scattered(product(range(len(xs)), range(len(ys)))),
        into=lambda found: _assembled(question, found),
        progress=report and (lambda done, _: report(done, len(xs) * len(ys))),
    )


class PointFinder:
    """Runs the chain and the cage at points of a map; each link of the chain once for what changes it."""

    def __init__(self, question: MapQuestion, runner: Runner) -> None:
        self.question, self.runner = question, runner
        self._names = (question.x.parameter, question.y.parameter)
        self._agreeing = stopping(question.runs).agreeing_runs
        self._state = functools.lru_cache(maxsize=MOST_LINKS)(self._find_state)

    def __call__(self, x: float, y: float) -> MapPoint:
        """Point at (x, y), with the refusal as its reason if it cannot be run."""
        values = dict(zip(self._names, (x, y), strict=True))
        state = self._state(tuple((name, values[name]) for name in self._names if name not in OF_THE_CAGE))
        if isinstance(state, str):
            return MapPoint(x=x, y=y, state=State.REFUSED, reason=state)
        solution, cage = state
        friction, eta = values.get(FRICTION, cage.ball_cage_friction), values.get(RESTITUTION)
        if eta is None:
            cage, eta = replace(cage, ball_cage_friction=friction), solution.restitution.restitution_factor
        else:
            cage = cage_at(cage, eta, friction)
        try:
            ensemble = self._ensemble(cage, solution.study.stability, values.get(KICK, self.question.kick))
        except (InputError, ConvergenceError) as error:
            return MapPoint(x=x, y=y, state=State.REFUSED, reason=str(error))
        decision, reason = decide(cage, ensemble)
        runs, whirling = ensemble.outcome.size, int(ensemble.count(RunOutcome.WHIRLS)[0])
        low, high = wilson_interval(whirling, runs)
        calm = ensemble.drift_rate[ensemble.outcome != RunOutcome.WHIRLS]
        return MapPoint(
            x=x,
            y=y,
            state=State.RUN,
            decision=decision,
            probability_whirl=whirling / runs,
            probability_low=low,
            probability_high=high,
            runs=runs,
            whirling=whirling,
            growth_rate=float(np.median(ensemble.growth_rate)),
            largest_offset=float(ensemble.largest_offset.max()),
            drift_rate=float(np.median(calm)) if calm.size else 0.0,
            largest_contact_force=float(ensemble.largest_contact_force.max()),
            restitution_factor=eta,
            reason=reason,
            notes=(*solution.notes, *cage.notes),
        )

    def _find_state(self, values: tuple[tuple[str, float], ...]) -> tuple[Solution, MovingCage] | str:
        """Chain and cage of a study, or why there is none: a refusal is worth remembering too.

        A study without a pocket friction gets one where that is an axis.
        """
        pocket = {FRICTION: 0.0} if FRICTION in self._names else {}
        try:
            solution = solve(varied(self.question.study, {**dict(values), **pocket}))
            require_friction(solution.study)
            return solution, moving_cage(solution, solution.friction.mean if solution.friction else 0.0)
        except (InputError, ConvergenceError) as error:
            return str(error)

    def _ensemble(self, cage: MovingCage, settings: StabilitySettings, kick: MetrePerSecond) -> Ensemble:
        """Run the first few from one kick, and the others unless those agree."""
        run, first = self.runner.ensemble, self._agreeing
        ensemble = run(cage, settings, kicks=(kick,), runs=first)
        ends = np.where(is_calm(ensemble.outcome), RunOutcome.SETTLES, ensemble.outcome)
        rest = self.question.runs - first
        if rest == 0 or (ends == ends[0, 0]).all():
            return ensemble
        return joined([ensemble, run(cage, settings, kicks=(kick,), runs=rest, first_run=first)])


def stopping(runs: int) -> Stopping:
    r"""Rule by which points of this number of runs are ended early: the earliest end within `MOST_WRONG`.

    Runs are exchangeable. If :math:`K` of :math:`R` are of one kind, the first :math:`n` are all of the
    other with probability :math:`\binom{R-K}{n} / \binom{R}{n}`, which is largest for the smallest K that
    changes the answer: :math:`\lfloor R/2 \rfloor + 1` for the side.
    """

    def none_of(kind: int, first: int) -> Ratio:
        return comb(runs - kind, first) / comb(runs, first) if first < runs else 0.0

    majority = runs // 2 + 1
    enough = next(n for n in range(1, runs + 1) if none_of(majority, n) <= MOST_WRONG)
    agreeing = min(max(enough, AGREEING), runs)
    other_decision = next(k for k in range(runs + 1) if not is_clear(runs - k, runs))
    return Stopping(
        most_runs=runs,
        agreeing_runs=agreeing,
        wrong_side_probability=none_of(majority, agreeing),
        other_decision_probability=none_of(other_decision, agreeing),
    )


def _assembled(question: MapQuestion, found: Mapping[Place, MapPoint]) -> StabilityMap:
    """Map of the points found, with their margins."""
    if not any(point.runs for point in found.values()):
        where = f"The map of {question.x.parameter} and {question.y.parameter}"
        cure = f"The first was refused: {found[min(found)].reason}"
        raise InputError(where, "has no point that could be run", cure=cure)
    points: list[MapPoint] = []
    bands: list[MapChange] = []
    heights, here = question.y.values, question.y.here
    for i, x in enumerate(question.x.values):
        column = [found.get((i, j)) or MapPoint(x=x, y=y) for j, y in enumerate(heights)]
        sides = [point.side for point in column]
        along = zip(column, margins(heights, sides), strict=True)
        points += [replace(one, margin=m) if one.runs else one for one, m in along]
        for a, b in changes(sides):
            band = MapChange(x=x, y_low=heights[a], y_high=heights[b], whirls_above=sides[b] == WHIRLS)
            bands.append(band if here is None else replace(band, margin=_margin(band, here)))
    names = Counter(one.decision.name if one.decision else one.state.name.lower() for one in points)
    settings = question.study.stability
    return StabilityMap(
        x=question.x,
        y=question.y,
        points=tuple(points),
        changes=tuple(bands),
        counts={kind: names[kind] for kind in (*(v.name for v in Verdict), "refused", "not_run")},
        kick=question.kick,
        stopping=stopping(question.runs),
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        complete=len(found) == len(points),
    )


def changes(sides: Sequence[int]) -> list[tuple[int, int]]:
    """Places (last of one side, first of the other) between which a row of sides changes."""
    decided = [place for place, at in enumerate(sides) if at != EITHER]
    return [(a, b) for a, b in pairwise(decided) if sides[a] != sides[b]]


def margins(values: Sequence[float], sides: Sequence[int]) -> list[float | None]:
    """Distance of each point to the nearest band in which its row changes sides.

    Positive where the motion settles, negative where it whirls, 0 inside the band; None in a row that does
    not change, and where nothing was decided outside a band.
    """
    bands = [(values[a], values[b]) for a, b in changes(sides)]
    found: list[float | None] = []
    for value, at in zip(values, sides, strict=True):
        distance = min((max(low - value, value - high, 0.0) for low, high in bands), default=None)
        is_known = distance is not None and (at != EITHER or distance == 0.0)
        found.append(-at * distance + 0.0 if distance is not None and is_known else None)
    return found


def _margin(change: MapChange, here: float) -> float:
    """Distance of a value of y to a band; what the rounding of its unit makes is none."""
    distance = max(change.y_low - here, here - change.y_high, 0.0)
    distance *= distance > ROUNDING * abs(here)
    whirls = (here > change.y_high) == change.whirls_above and distance > 0.0
    return -distance if whirls else distance


def value_here(solution: Solution, name: str) -> float | None:
    """Value of a parameter in the study itself; None where it has none."""
    if name == RESTITUTION:
        return solution.restitution.restitution_factor
    if name == FRICTION:
        return solution.friction.mean if solution.friction else None
    if name != KICK:
        return value_in(solution.study, name)
    speed = pocket_speed(solution.bearing.cage_speed, solution.design.pocket_clearance)
    return with_kicks(solution.study.stability, speed).middle_kick
