"""Where a cage is stable in the plane of any two parameters of a study: the stability map."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from separatrix.cage.disturbance import with_kicks
from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.outcome import RunOutcome
from separatrix.chain.pocket_friction import pocket_speed
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import MetrePerSecond, Ratio
from separatrix.study.candidates import require_friction
from separatrix.study.study import StabilitySettings
from separatrix.verdict.judgement import Verdict, decide, is_calm, wilson_interval
from separatrix.verdict.long_jobs import Runner, joined, made_into
from separatrix.verdict.map_fill import (
    Filled,
    Place,
    Tally,
    changes,
    fill,
    first_look,
    further,
    margins,
    other_decision_probability,
    settled,
    wrong_side_probability,
)
from separatrix.verdict.map_records import (
    FRICTION,
    KICK,
    NOT_RUN,
    RESTITUTION,
    Inference,
    MapChange,
    MapPoint,
    MapQuestion,
    StabilityMap,
    State,
    Stopping,
    value_in,
    varied,
)
from separatrix.verdict.response import cage_at

MOST_LINKS = 1024  # links of the chain that are remembered
OF_THE_CAGE = (RESTITUTION, FRICTION, KICK)  # parameters that change nothing before the cage itself
INTERRUPTED = f"{NOT_RUN}: interrupted"
AGREED = f"{NOT_RUN}: the points around it agree"
ROUNDING = 1e-9  # share of a value below which its distance to a band is the rounding of its unit
Values = tuple[tuple[str, float], ...]  # of parameters, by their names


def stability_map(question: MapQuestion, *, runner: Runner | None = None) -> StabilityMap:
    """Decide every point of a map, coarse grid first, so that an interrupted map covers the whole plane.

    Run number r begins alike at every point. A point whose study is refused, or whose chain does not settle,
    is a point with that reason. The numbers do not depend on the runner.

    Raises
    ------
    InputError
        The study names no pocket friction and no axis is it, or no point at all could be run.
    Interrupted
        With the map of the points that were finished, if any was.
    """
    require_cage_friction(question)
    runner = runner or Runner()

    return made_into(
        lambda filled: _assembled(question, filled),
        lambda: fill(question, PointFinder(question, runner), runner),
    )


def require_cage_friction(question: MapQuestion) -> None:
    """Refuse a map whose cage has no pocket friction."""
    if FRICTION not in (question.x.parameter, question.y.parameter):
        require_friction(question.study)


class PointFinder:
    """Runs the chain and the cage at points of a map; each link of the chain once for what changes it."""

    def __init__(self, question: MapQuestion, runner: Runner) -> None:
        self.question, self.runner = question, runner
        self._names = (question.x.parameter, question.y.parameter)
        self._state = functools.lru_cache(maxsize=MOST_LINKS)(self._find_state)

    def __call__(self, at: tuple[float, float]) -> MapPoint:
        """Point at (x, y), with the refusal as its reason if it cannot be run."""
        x, y = at
        try:
            return self._run(x, y)
        except (InputError, ConvergenceError) as error:
            return MapPoint(x=x, y=y, state=State.REFUSED, reason=str(error))

    def _run(self, x: float, y: float) -> MapPoint:
        values = dict(zip(self._names, (x, y), strict=True))
        state = self._state(tuple((name, values[name]) for name in self._names if name not in OF_THE_CAGE))
        if isinstance(state, str):
            raise InputError(state.removesuffix("."), "")
        solution, cage = state
        friction, eta = values.get(FRICTION, cage.ball_cage_friction), values.get(RESTITUTION)
        if eta is None:
            cage, eta = replace(cage, ball_cage_friction=friction), solution.restitution.restitution_factor
        else:
            cage = cage_at(cage, eta, friction)
        kick = values.get(KICK, self.question.kick)
        settings = solution.study.stability
        ensemble = _decided_ensemble(cage, settings, kick, self.question.runs, self.runner)
        return replace(_judged(x, y, cage, eta, ensemble), notes=(*solution.notes, *cage.notes))

    def _find_state(self, values: Values) -> tuple[Solution, MovingCage] | str:
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


def _decided_ensemble(
    cage: MovingCage, settings: StabilitySettings, kick: MetrePerSecond, runs: int, runner: Runner
) -> Ensemble:
    """Runs from one kick: the first few, and unless those agree as many as could change the answer."""

    def run(first: int, count: int) -> Ensemble:
        return runner.ensemble(cage, settings, kicks=(kick,), runs=count, first_run=first)

    ensemble = run(0, first_look(runs))
    ends = np.where(is_calm(ensemble.outcome), RunOutcome.SETTLES, ensemble.outcome)
    if (ends == ends[0, 0]).all():
        return ensemble
    while not settled(now := _tally(ensemble), runs) and now.runs < runs:
        ensemble = joined([ensemble, run(now.runs, further(now.runs, runs))])
    return ensemble


def _tally(ensemble: Ensemble) -> Tally:
    whirls, calm = int(ensemble.count(RunOutcome.WHIRLS)[0]), int(is_calm(ensemble.outcome).sum())
    return Tally(runs=ensemble.outcome.shape[1], whirls=whirls, settles=calm)


def _judged(x: float, y: float, cage: MovingCage, eta: Ratio, ensemble: Ensemble) -> MapPoint:
    decision, reason = decide(cage, ensemble)
    now = _tally(ensemble)
    low, high = wilson_interval(now.whirls, now.runs)
    calm = ensemble.drift_rate[ensemble.outcome != RunOutcome.WHIRLS]
    return MapPoint(
        x=x,
        y=y,
        state=State.RUN,
        decision=decision,
        probability_whirl=now.whirls / now.runs,
        probability_low=low,
        probability_high=high,
        runs=now.runs,
        whirling=now.whirls,
        growth_rate=float(np.median(ensemble.growth_rate)),
        largest_offset=float(ensemble.largest_offset.max()),
        drift_rate=float(np.median(calm)) if calm.size else 0.0,
        largest_contact_force=float(ensemble.largest_contact_force.max()),
        restitution_factor=eta,
        reason=reason,
    )


def _assembled(question: MapQuestion, filled: Filled) -> StabilityMap:
    """Map of the points found, with their margins; the others have the reason why they were not run."""
    if not any(point.runs for point in filled.found.values()):
        first = filled.found[min(filled.found)]
        where = f"The map of {question.x.parameter} and {question.y.parameter}"
        cure = f"The first was refused: {first.reason}"
        raise InputError(where, "has no point that could be run", cure=cure)
    points: list[MapPoint] = []
    bands: list[MapChange] = []
    heights = question.y.values
    for i, x in enumerate(question.x.values):
        column = [filled.found.get((i, j)) or _not_run(filled, (i, j), x, y) for j, y in enumerate(heights)]
        sides = [point.side for point in column]
        along = zip(column, margins(heights, sides), strict=True)
        points += [one if m is None or not one.runs else replace(one, margin=m) for one, m in along]
        found = (
            MapChange(x=x, y_low=heights[a], y_high=heights[b], whirls_above=sides[b] > 0)
            for a, b in changes(sides)
        )
        bands += [replace(one, margin=_margin(one, question.y.here)) for one in found]
    settings = question.study.stability
    return StabilityMap(
        x=question.x,
        y=question.y,
        points=tuple(points),
        changes=tuple(bands),
        counts=counts(points),
        kick=question.kick,
        stopping=stopping(question.runs),
        inference=inference(filled) if question.adaptive else None,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        adaptive=question.adaptive,
        complete=filled.complete,
    )


def _margin(change: MapChange, here: float | None) -> float | None:
    """Distance of a value of y to a band; what the rounding of its unit makes is none."""
    if here is None:
        return None
    distance = max(change.y_low - here, here - change.y_high, 0.0)
    distance *= distance > ROUNDING * abs(here)
    whirls = (here > change.y_high) == change.whirls_above and distance > 0.0
    return -distance if whirls else distance


def _not_run(filled: Filled, place: Place, x: float, y: float) -> MapPoint:
    if place in filled.inferred:
        near = filled.inferred[place]
        return MapPoint(x=x, y=y, state=State.INFERRED, inferred_decision=near, reason=AGREED)
    return MapPoint(x=x, y=y, reason=INTERRUPTED)


def inference(filled: Filled) -> Inference:
    """How often the points around another one decided otherwise, where it was run as a check."""
    otherwise = sum(filled.found[place].decision is not near for place, near in filled.checked.items())
    total = len(filled.checked)
    low, high = wilson_interval(otherwise, total) if total else (None, None)
    return Inference(
        points=len(filled.inferred),
        checked=total,
        decided_otherwise=otherwise,
        error_low=low,
        error_high=high,
    )


def counts(points: Iterable[MapPoint]) -> dict[str, int]:
    """Points of each decision, of those refused, of those inferred, and of those not run."""
    names = Counter(_kind(point) for point in points)
    return {kind: names[kind] for kind in (*(v.name for v in Verdict), "refused", "inferred", "not_run")}


def _kind(point: MapPoint) -> str:
    return point.state.name.lower() if point.decision is None else point.decision.name


def stopping(runs: int) -> Stopping:
    """Rule by which points of this number of runs are ended early."""
    agreeing = first_look(runs)
    return Stopping(
        most_runs=runs,
        agreeing_runs=agreeing,
        wrong_side_probability=wrong_side_probability(runs, agreeing),
        other_decision_probability=other_decision_probability(runs, agreeing),
    )


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
