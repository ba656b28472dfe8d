"""Where a cage is stable in the plane of any two parameters of a study: the stability map."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np

from separatrix.cage import Ensemble, PlanarCage, RunOutcome, Verdict, judge, run_ensemble, wilson_interval
from separatrix.chain import (
    CageState,
    TractionState,
    cage_state,
    known_friction,
    pocket_friction,
    traction_state,
)
from separatrix.errors import ConvergenceError, InputError
from separatrix.stability.growth import cage_at
from separatrix.stability.map_grid import Place, near_a_change, rounds
from separatrix.stability.map_parameters import (
    FRICTION,
    KICK,
    RESTITUTION,
    changes_traction,
    value_in,
    varied,
)
from separatrix.stability.map_pool import work_in_batches
from separatrix.stability.map_records import (
    NOT_RUN,
    MapChange,
    MapPoint,
    MapQuestion,
    StabilityMap,
    Stopping,
)
from separatrix.stability.map_rule import (
    changes,
    first_look,
    margins,
    other_decision_probability,
    wrong_side_probability,
)
from separatrix.stability.pool import Progress
from separatrix.study import StabilitySettings, Study
from separatrix.units import MetrePerSecond, Ratio

MOST_LINKS = 1024
"""Links of the chain that are remembered."""

OF_THE_CAGE = (RESTITUTION, FRICTION, KICK)
"""Parameters that change nothing before the cage itself."""

INTERRUPTED = f"{NOT_RUN}: interrupted"
AGREED = f"{NOT_RUN}: the points around it agree"


Values = tuple[tuple[str, float], ...]
Known = Mapping[tuple[float, float], MapPoint]
Keep = Callable[[list[MapPoint]], None]


def stability_map(
    question: MapQuestion,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    known: Known | None = None,
    keep: Keep | None = None,
) -> StabilityMap:
    """Decide every point of a map, coarse grid first, so that an interrupted map covers the whole plane.

    Run number r begins alike at every point. A point whose study is refused, or whose chain does not settle,
    is a point with that reason.

    Parameters
    ----------
    question : MapQuestion
        What is asked.
    jobs : int
        Threads; the numbers do not depend on it.
    progress : callable, optional
        Called with (done, total) points.
    known : mapping, optional
        Points by (x, y) that were finished before.
    keep : callable, optional
        Called with the points that have just been finished, in this thread.

    Raises
    ------
    InputError
        The study names no pocket friction and no axis is it, or no point at all could be run.
    KeyboardInterrupt
        Interrupted before the first point was finished; later the finished points are returned.
    """
    require_friction(question)
    grid = {(i, j): (x, y) for i, x in enumerate(question.x.values) for j, y in enumerate(question.y.values)}
    found = {place: known[at] for place, at in grid.items() if known and at in known}
    finder = PointFinder(question)
    complete = _fill(question, finder, grid, found, _Say(len(grid), progress, keep), jobs)
    if not found:
        raise KeyboardInterrupt
    _refuse_if_nothing_ran(question, found)
    return _assembled(question, found, complete=complete)


def require_friction(question: MapQuestion) -> None:
    """Refuse a map whose cage has no pocket friction."""
    if FRICTION not in (question.x.parameter, question.y.parameter):
        pocket_friction(question.study)


@dataclass(frozen=True, slots=True)
class _Say:
    """Whom to tell of finished points."""

    total: int
    progress: Progress | None
    keep: Keep | None

    def __call__(self, batch: list[tuple[Place, MapPoint]], done: int) -> None:
        if self.keep is not None:
            self.keep([point for _, point in batch])
        if self.progress is not None:
            self.progress(done, self.total)


def _fill(
    question: MapQuestion,
    finder: Callable[[tuple[float, float]], MapPoint],
    grid: Mapping[Place, tuple[float, float]],
    found: dict[Place, MapPoint],
    say: _Say,
    jobs: int,
) -> bool:
    """Compute the points that are wanted and not found yet, round by round; False after an interrupt."""

    def compute(place: Place) -> tuple[Place, MapPoint]:
        return place, finder(grid[place])

    def take(batch: list[tuple[Place, MapPoint]]) -> None:
        found.update(batch)
        say(batch, len(found))

    for coarser, places in rounds(len(question.x.values), len(question.y.values)):
        wanted = [p for p in places if p not in found]
        if question.adaptive and coarser is not None:
            decisions = {p: point.decision for p, point in found.items()}
            wanted = [p for p in wanted if near_a_change(p, coarser, decisions)]
        if not work_in_batches(compute, wanted, take, jobs=jobs):
            return False
    return True


def _refuse_if_nothing_ran(question: MapQuestion, found: Mapping[Place, MapPoint]) -> None:
    """A map without a single run is no answer: say why the first point was refused."""
    if any(point.runs for point in found.values()):
        return
    first = found[min(found)]
    where = f"The map of {question.x.parameter} and {question.y.parameter}"
    raise InputError(where, "has no point that could be run", cure=f"The first was refused: {first.reason}")


class PointFinder:
    """Runs the chain and the cage at points of a map; each link of the chain once for what changes it."""

    def __init__(self, question: MapQuestion) -> None:
        self.question = question
        self._names = (question.x.parameter, question.y.parameter)
        self._traction = functools.lru_cache(maxsize=MOST_LINKS)(self._find_traction)
        self._state = functools.lru_cache(maxsize=MOST_LINKS)(self._find_state)

    def __call__(self, at: tuple[float, float]) -> MapPoint:
        """Point at (x, y), with the refusal as its reason if it cannot be run."""
        x, y = at
        try:
            return self._run(x, y)
        except (InputError, ConvergenceError) as error:
            return MapPoint(x=x, y=y, reason=str(error))

    def _run(self, x: float, y: float) -> MapPoint:
        values = dict(zip(self._names, (x, y), strict=True))
        of_the_chain = tuple((name, values[name]) for name in self._names if name not in OF_THE_CAGE)
        state, settings = _found(self._state(of_the_chain))
        cage, eta = _cage_of(state, values)
        ensemble = decided_ensemble(cage, settings, values.get(KICK, self.question.kick), self.question.runs)
        return _judged(x, y, cage, eta, ensemble)

    def _varied(self, values: Values) -> Study:
        """Study with these values; one without a pocket friction gets one, for it is an axis."""
        study = functools.reduce(lambda found, item: varied(found, *item), values, self.question.study)
        return study if FRICTION not in self._names else varied(study, FRICTION, 0.0)

    def _find_state(self, values: Values) -> tuple[CageState, StabilitySettings] | str:
        """Cage and ensemble of a study, or why there is none: a refusal is worth remembering too."""
        of_traction = tuple(item for item in values if changes_traction(item[0]))
        try:
            study = self._varied(values)
            return cage_state(study, traction=_found(self._traction(of_traction))), study.stability
        except (InputError, ConvergenceError) as error:
            return str(error)

    def _find_traction(self, values: Values) -> TractionState | str:
        try:
            return traction_state(self._varied(values))
        except (InputError, ConvergenceError) as error:
            return str(error)


Link = TypeVar("Link")


def _found(link: Link | str) -> Link:
    """Return a link of the chain, or raise the refusal it was."""
    if isinstance(link, str):
        raise InputError(link.removesuffix("."), "")
    return link


def _cage_of(state: CageState, values: Mapping[str, float]) -> tuple[PlanarCage, Ratio]:
    """Cage with the friction and restitution factor of a point, and that restitution factor."""
    friction = values.get(FRICTION, state.cage.ball_cage_friction)
    eta = values.get(RESTITUTION)
    if eta is not None:
        return cage_at(state.cage, eta, friction), eta
    return replace(state.cage, ball_cage_friction=friction), state.restitution.restitution.restitution_factor


def decided_ensemble(
    cage: PlanarCage, settings: StabilitySettings, kick: MetrePerSecond, runs: int
) -> Ensemble:
    """Runs from one kick: the first few, and the others unless those agree."""
    first = first_look(runs)
    ensemble = run_ensemble(cage, settings, kicks=(kick,), runs=first, growth_only=True)
    outcomes = ensemble.outcome
    if first == runs or (outcomes == outcomes[0, 0]).all():
        return ensemble
    others = run_ensemble(cage, settings, kicks=(kick,), runs=runs - first, first_run=first, growth_only=True)
    return joined(ensemble, others)


def joined(first: Ensemble, others: Ensemble) -> Ensemble:
    """One ensemble of the runs of two, from the same kicks."""

    def column(name: str) -> Any:
        one, other = getattr(first, name), getattr(others, name)
        return np.concatenate((one, other), axis=1) if np.ndim(one) > 1 else one

    return Ensemble(**{f.name: column(f.name) for f in fields(Ensemble)})


def _judged(x: float, y: float, cage: PlanarCage, eta: Ratio, ensemble: Ensemble) -> MapPoint:
    found = judge(cage, ensemble)
    grown, runs = int(ensemble.count(RunOutcome.GROWS)[0]), ensemble.outcome.shape[1]
    low, high = wilson_interval(grown, runs)
    return MapPoint(
        x=x,
        y=y,
        decision=found.verdict,
        probability_grow=grown / runs,
        probability_low=low,
        probability_high=high,
        runs=runs,
        grown=grown,
        growth_rate=growth_rate(ensemble),
        restitution_factor=eta,
        reason=found.reason,
    )


def growth_rate(ensemble: Ensemble) -> float:
    """Median growth rate of the runs [1/s]."""
    return float(np.median(ensemble.growth_rate))


def _assembled(question: MapQuestion, found: Mapping[Place, MapPoint], *, complete: bool) -> StabilityMap:
    """Map of the points found, with their margins; the others say why they were not run."""
    why = AGREED if complete else INTERRUPTED
    points: list[MapPoint] = []
    bands: list[MapChange] = []
    heights = question.y.values
    for i, x in enumerate(question.x.values):
        column = [found.get((i, j)) or MapPoint(x=x, y=y, reason=why) for j, y in enumerate(heights)]
        sides = [point.side for point in column]
        along = zip(column, margins(heights, sides), strict=True)
        points += [replace(point, margin=margin if point.runs else None) for point, margin in along]
        bands += [
            MapChange(x=x, y_low=heights[a], y_high=heights[b], grows_above=sides[b] > 0)
            for a, b in changes(sides)
        ]
    settings = question.study.stability
    return StabilityMap(
        x=question.x,
        y=question.y,
        points=tuple(points),
        changes=tuple(bands),
        counts=counts(points),
        kick=question.kick,
        stopping=stopping(question.runs),
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        adaptive=question.adaptive,
        complete=complete,
    )


def counts(points: Iterable[MapPoint]) -> dict[str, int]:
    """Points of each decision, of those refused, and of those not run."""
    names = Counter(_kind(point) for point in points)
    return {kind: names[kind] for kind in (*(v.name for v in Verdict), "refused", "not_run")}


def _kind(point: MapPoint) -> str:
    if point.decision is not None:
        return point.decision.name
    return "not_run" if point.reason.startswith(NOT_RUN) else "refused"


def stopping(runs: int) -> Stopping:
    """Rule by which points of so many runs are ended early."""
    agreeing = first_look(runs)
    return Stopping(
        most_runs=runs,
        agreeing_runs=agreeing,
        wrong_side_probability=wrong_side_probability(runs, agreeing),
        other_decision_probability=other_decision_probability(runs, agreeing),
    )


def value_here(study: Study, state: CageState, name: str) -> float | None:
    """Value of a parameter in the study itself; None where it has none."""
    if name == RESTITUTION:
        return state.restitution.restitution.restitution_factor
    if name == FRICTION:
        return known_friction(study)
    return study.stability.middle_kick if name == KICK else value_in(study, name)
