"""The stability curve: critical friction against restitution factor, and its inverse, the threshold."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, TypeVar

from separatrix.cage.closed_forms import drift_rate_law, drifts
from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage
from separatrix.ground.units import MetrePerSecond, PerSecond, Ratio, Rows, Second
from separatrix.study.study import StabilitySettings
from separatrix.verdict.critical_friction import (
    BAND_FEW,
    BAND_MOST,
    CriticalFriction,
    LinearLimit,
    critical_friction,
    expected_runs,
    linear_limit,
)
from separatrix.verdict.long_jobs import Load, Runner
from separatrix.verdict.response import SEARCHED_FRICTION, GrowthCounter, Side

Point = TypeVar("Point")
COARSE: tuple[Ratio, ...] = (0.0, 0.25, 0.5, 0.75, 0.875, 1.0)
"""Restitution factors to begin with: closer before 1, where balls gripped by their races damp nothing, the
critical friction falls to zero and a line from 0.75 would be taken for straight."""

FIRST_THREES = ((0.0, 0.25, 0.5), (0.5, 0.75, 1.0), (0.75, 0.875, 1.0))
FINEST: Ratio = 1.0 / 32.0  # the least distance between two; all are halves of halves, so exact in binary
Bends = Callable[[Point, Point, Point], bool]
"""Whether the middle one of three points lies off the line between the others."""


def finer(eta: Ratio, found: Mapping[Ratio, Point], bends: Bends[Point]) -> list[tuple[Ratio, Ratio]]:
    """Neighbours half way between which a point is wanted once the point at `eta` is computed.

    A middle that lies off the line between its neighbours has both its sides halved. Each decision depends on
    three points only, so the points of a curve do not depend on their order.
    """
    wanted: list[tuple[Ratio, Ratio]] = []
    for low, middle, high in _threes(eta):
        known = [found[at] for at in (low, middle, high) if at in found]
        if high - middle >= 2.0 * FINEST and len(known) == 3 and bends(*known):
            halves = (low, middle), (middle, high)
            wanted += [half for half in halves if 0.5 * sum(half) not in COARSE]
    return wanted


def _threes(eta: Ratio) -> Iterator[tuple[Ratio, Ratio, Ratio]]:
    """Neighbours that `eta` completes: it is their middle, or one of the first."""
    if eta in COARSE:
        yield from (three for three in FIRST_THREES if eta in three)
        return
    gap = FINEST
    while eta % (2.0 * gap) == 0.0:
        gap *= 2.0
    yield eta - gap, eta, eta + gap


ETA = "restitution_factor"
FLAT: Ratio = 0.002  # friction by which a line may miss a point, whatever the scatter of that
OWN_DAMPING = -1.0  # in place of a restitution factor: the cage's own race damping


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCurve:
    """Stability curve, its limits, and its ensemble."""

    curve: Annotated[tuple[CriticalFriction, ...], Rows(ETA, label=ETA)]  # rising restitution factors
    here: CriticalFriction | None = None
    """The same at the cage's own race damping; None if an interrupt left it out."""
    linear_limit: Annotated[tuple[LinearLimit, ...], Rows(ETA, "linear_limit_", label=ETA)]
    """Beside each point: without clearance, ball set at rest, in closed form."""
    band_few: Ratio  # share of whirling runs at the lower end of the band
    band_most: Ratio  # share of whirling runs at the upper end of the band
    band: bool  # whether the points of `curve` have their band; `here` always has
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]  # disturbances of the runs
    middle_kick: MetrePerSecond  # of the critical friction
    runs: int  # from each disturbance
    duration: Second  # of a run
    ball_scatter: Ratio  # initial lead or lag of the balls, over half the pocket clearance
    searched_friction: Ratio  # highest friction that was searched
    drifts: bool  # whether nothing returns the cage centre: a run may settle, but no verdict is STABLE
    drift_rate_law: PerSecond  # growth of the offset by the linear law; 0 with a land or a ball set at rest
    adaptive: bool  # whether the restitution factors were chosen here
    complete: bool  # false if an interrupt left points out

    @property
    def notes(self) -> tuple[str, ...]:
        """Those of its points."""
        points = self.curve if self.here is None else (*self.curve, self.here)
        return tuple(note for point in points for note in point.notes)


def stability_curve(
    cage: MovingCage, settings: StabilitySettings, *, runner: Runner | None = None
) -> StabilityCurve:
    """Critical friction against restitution factor, and at the cage's own race damping.

    Without restitution factors in the settings they are chosen where the curve bends. The friction of the
    cage is replaced, and its race damping but for `here`. The numbers do not depend on the runner.
    `Interrupted` has the curve of the points that were finished, if any was.
    """
    runner = runner or Runner()
    tracer = Tracer(GrowthCounter(cage, settings, runner), settings.restitution_factors, band=True)

    def curve(found: dict[Node, CriticalFriction]) -> StabilityCurve:
        here = found.pop((OWN_DAMPING, None), None)
        complete = here is not None and tracer.complete(found)
        return curve_of_points(cage, settings, list(found.values()), here=here, complete=complete)

    return runner.work_out(
        tracer.point, [(OWN_DAMPING, None), *tracer.first], into=curve, more=tracer.more, load=tracer.load
    )


Node = tuple[Ratio, Ratio | None]  # a restitution factor (or `OWN_DAMPING`), and a guess of its friction


class Tracer:
    """Which points of a curve are wanted, and how one is computed.

    Parameters
    ----------
    counter : GrowthCounter
        Counts the runs of its cage.
    given : sequence of float
        Restitution factors; if none, they are halved where the curve bends by more than its scatter.
    band : bool
        Whether the points have their band; if so, its ends are followed as well.
    frictions : sequence of float, optional
        The curve is followed as finely as it bends where it passes these; by default everywhere.
    """

    def __init__(
        self,
        counter: GrowthCounter,
        given: Sequence[Ratio],
        *,
        band: bool,
        frictions: Sequence[Ratio] | None = None,
    ) -> None:
        self.counter, self.given, self.band, self.frictions = counter, tuple(given), band, frictions

    @property
    def first(self) -> list[Node]:
        """Where to begin."""
        return [(eta, None) for eta in self.given or COARSE]

    def point(self, node: Node) -> CriticalFriction:
        """Critical friction at a node; at the cage's own race damping always with its band."""
        counts, band = self.counter, self.band or node[0] == OWN_DAMPING
        eta = None if node[0] == OWN_DAMPING else node[0]
        return critical_friction(counts.cage, eta, counts.settings, counter=counts, band=band, guess=node[1])

    def load(self, node: Node) -> Load:
        """Work of a node; about as many follow as a curve begins with."""
        runs = expected_runs(self.counter.settings, band=self.band or node[0] == OWN_DAMPING)
        is_halved = node[0] in COARSE and not self.given and self.frictions is None
        return Load(runs, dear=2.0, follow=0.7 if is_halved else 0.0)

    def more(self, node: Node, found: Mapping[Node, CriticalFriction]) -> list[Node]:
        """Nodes that are wanted once this one is known."""
        if self.given or node[0] == OWN_DAMPING:
            return []
        known = {at: point for (at, _), point in found.items() if at != OWN_DAMPING}
        spans = [(known[low], known[high]) for low, high in finer(node[0], known, bends)]
        return [_between(*span) for span in spans if self._matters(*span)]

    def _matters(self, *span: CriticalFriction) -> bool:
        """Whether the curve may pass one of the frictions between two points."""
        if self.frictions is None:
            return True
        ends = [end for point in span for end in _heights(point)[0]]
        return any(min(ends) - FLAT <= friction <= max(ends) + FLAT for friction in self.frictions)

    def complete(self, found: Mapping[Node, CriticalFriction]) -> bool:
        """Whether no point is wanted that is not known."""
        known = {at for at, _ in found}
        wanted = {at for at, _ in self.first} | {at for node in found for at, _ in self.more(node, found)}
        return wanted <= known


def _between(low: CriticalFriction, high: CriticalFriction) -> Node:
    """Node half way between two points, and what a line between them lets guess of it."""
    eta = 0.5 * (low.restitution_factor + high.restitution_factor)
    if low.critical_friction is None or high.critical_friction is None:
        return eta, None
    return eta, 0.5 * (low.critical_friction + high.critical_friction)


def bends(low: CriticalFriction, middle: CriticalFriction, high: CriticalFriction) -> bool:
    """Whether the line between two points misses the middle one, or its band, by more than the scatter."""
    return any(map(_misses, _heights(low), _heights(middle), _heights(high)))


Heights = tuple[Ratio, Ratio, Ratio]  # a friction with its 95 % interval


def _misses(low: Heights, middle: Heights, high: Heights) -> bool:
    """Whether a middle lies off the line by more than both are uncertain."""
    off = middle[0] - 0.5 * (low[0] + high[0])
    of_line = 0.5 * math.hypot(low[2] - low[1], high[2] - high[1])
    return abs(off) > FLAT + 0.5 * math.hypot(middle[2] - middle[1], of_line)


def height(point: CriticalFriction) -> Ratio:
    """Critical friction, with 0 or the top of the searched range where there is none."""
    if point.critical_friction is not None:
        return point.critical_friction
    return 0.0 if point.side is Side.ABOVE else SEARCHED_FRICTION


def _heights(point: CriticalFriction) -> list[Heights]:
    """Critical friction and both ends of the band; the ends of the searched range where there is none."""
    low, high = _or(point.critical_friction_low, 0.0), _or(point.critical_friction_high, SEARCHED_FRICTION)
    rows = (
        (height(point), point.scatter_low, point.scatter_high),
        (low, point.low_scatter_low, point.low_scatter_high),
        (high, point.high_scatter_low, point.high_scatter_high),
    )
    return [(at, _or(least, at), _or(most, at)) for at, least, most in rows]


def _or(value: Ratio | None, other: Ratio) -> Ratio:
    return other if value is None else value


def curve_of_points(
    cage: MovingCage,
    settings: StabilitySettings,
    points: Iterable[CriticalFriction],
    *,
    band: bool = True,
    here: CriticalFriction | None = None,
    complete: bool = True,
) -> StabilityCurve:
    """Return the curve of the finished points, rising restitution factors first, with its limits."""
    settings = settings_for(settings, cage)
    ordered = rising(points)
    return StabilityCurve(
        curve=tuple(ordered),
        here=here,
        linear_limit=tuple(linear_limit(cage, point.restitution_factor) for point in ordered),
        band_few=BAND_FEW,
        band_most=BAND_MOST,
        band=band,
        kicks=settings.kicks,
        middle_kick=settings.middle_kick,
        runs=settings.runs,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        searched_friction=SEARCHED_FRICTION,
        drifts=drifts(cage),
        drift_rate_law=drift_rate_law(cage),
        adaptive=not settings.restitution_factors,
        complete=complete,
    )


OUTER_FACTORS: tuple[Ratio, ...] = (0.0, 0.98, 1.0)
"""Restitution factors beside those that a study gives, so that thresholds are solved over all of 0 to 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionThreshold:
    """Largest restitution factor at which the cage is stable, with the 95 % interval of the runs' scatter."""

    value: Ratio
    low: Ratio
    high: Ratio


def restitution_threshold(points: Sequence[CriticalFriction], friction: Ratio) -> RestitutionThreshold:
    """Restitution factor at which the critical friction equals `friction`, f_BC of a material [-].

    Between two points, which rise from a restitution factor of 0 to 1, the critical friction is a straight
    line. The threshold is 0 if the cage is never stable, 1 if it is stable even on balls gripped by their
    races. Where the critical friction wavers, it is the first restitution factor at which it falls below
    `friction`. The interval comes from the ends of the critical friction's own, in the same way.
    """
    value = _first_below(points, friction, lambda point: point.critical_friction)
    low = _first_below(points, friction, lambda point: point.scatter_low)
    high = _first_below(points, friction, lambda point: point.scatter_high)
    return RestitutionThreshold(value=value, low=min(low, value), high=max(high, value))


def _first_below(
    points: Sequence[CriticalFriction], friction: Ratio, end: Callable[[CriticalFriction], Ratio | None]
) -> Ratio:
    """Smallest restitution factor at which a curve through the points is below `friction`; 1 if none is."""
    before: tuple[Ratio, Ratio] | None = None
    for point in points:
        known = end(point)
        eta, f = point.restitution_factor, height(point) if known is None else known
        if f < friction or point.side is Side.ABOVE:
            if before is None or f >= before[1]:
                return eta
            return before[0] + (eta - before[0]) * (before[1] - friction) / (before[1] - f)
        before = eta, f
    return 1.0


def own_threshold(
    cage: MovingCage, settings: StabilitySettings, friction: Ratio, runner: Runner
) -> RestitutionThreshold:
    """Threshold of one friction: the curve is followed, here and now, as finely as that needs."""
    tracer = Tracer(
        GrowthCounter(cage, settings, runner), threshold_factors(settings), band=False, frictions=[friction]
    )
    found: dict[Node, CriticalFriction] = {}
    waiting = list(tracer.first)
    while waiting:
        node = waiting.pop()
        found[node] = tracer.point(node)
        waiting += [one for one in tracer.more(node, found) if one not in found and one not in waiting]
    return restitution_threshold(rising(found.values()), friction)


def rising(points: Iterable[CriticalFriction]) -> list[CriticalFriction]:
    """Return the points in the order of their restitution factors."""
    return sorted(points, key=lambda point: point.restitution_factor)


def threshold_factors(settings: StabilitySettings) -> list[Ratio]:
    """Restitution factors of the settings and those beside them, rising; none if they are to be chosen."""
    given = settings.restitution_factors
    return sorted({*given, *OUTER_FACTORS}) if given else []
