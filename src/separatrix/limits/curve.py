"""Critical pocket friction against restitution factor, with its band: the stability curve (paper, Fig. 2)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, TypeVar

from separatrix.cage import PlanarCage, settings_for
from separatrix.cage.closed_forms import drift_rate_law, drifts
from separatrix.limits.growth import GrowthCounter
from separatrix.limits.limits import HardLimit, LinearLimit, closed_hard_limit, hard_limit, linear_limit
from separatrix.limits.point import BAND_FEW, BAND_MOST, CriticalFriction, critical_friction
from separatrix.limits.response import SEARCHED_FRICTION, Side
from separatrix.runner import Runner
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, PerSecond, Ratio, Rows, Second

Point = TypeVar("Point")

COARSE: tuple[Ratio, ...] = (0.0, 0.25, 0.5, 0.75, 0.875, 1.0)
"""Restitution factors to begin with: closer before 1, where balls gripped by their races damp nothing, the
critical friction falls to zero and a line from 0.75 would be taken for straight."""

FIRST_THREES = ((0.0, 0.25, 0.5), (0.5, 0.75, 1.0), (0.75, 0.875, 1.0))
FINEST: Ratio = 1.0 / 32.0
"""The least distance between two; all are halves of halves, so exact in binary."""

Bends = Callable[[Point, Point, Point], bool]
"""Whether the middle one of three points lies off the line between the others."""


def finer(eta: Ratio, found: Mapping[Ratio, Point], bends: Bends[Point]) -> list[tuple[Ratio, Ratio]]:
    """Neighbours half way between which a point is wanted once the point at `eta` is known.

    A middle that lies off the line between its neighbours has both its sides halved. What is answered for
    three points depends on these three only, so the points of a curve do not depend on their order.
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

FLAT: Ratio = 0.002
"""Friction by which a line may miss a point however well that is known."""

OWN_DAMPING = -1.0
"""Stands in the row of work for the cage's own race damping, beside restitution factors from 0 to 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCurve:
    """Stability curve, its limits, and the ensemble it holds for.

    Attributes
    ----------
    curve : tuple of CriticalFriction
        Rising restitution factors.
    here : CriticalFriction or None
        The same at the cage's own race damping; None if an interrupt left it out.
    linear_limit : tuple of LinearLimit
        Beside each point: without clearance, ball set at rest, in closed form.
    hard_limit : tuple of HardLimit
        Beside each point: walls instead of springs, ball set at rest, even pockets; empty without clearance.
    hard_limit_closed : float or None
        Where dead hard impacts begin to whirl, tan(pi/2Z) for odd Z, tan(pi/Z) for even [-].
    band_few, band_most : float
        Shares of whirling runs at the ends of the band [-].
    band : bool
        Whether the points of `curve` have their band; `here` always has.
    kicks, middle_kick, runs, duration, ball_scatter
        The ensemble.
    searched_friction : float
        The friction up to which was looked [-].
    drifts : bool
        Whether nothing holds the cage centre: below the curve a kick settles, but no verdict there is STABLE.
    drift_rate_law : float
        Rate of that drift by the linear law, at any friction, with the cage's own race damping; 0 with a land
        or a ball set at rest [1/s].
    adaptive : bool
        Whether the restitution factors were chosen here.
    complete : bool
        False if an interrupt left points out.
    """

    curve: Annotated[tuple[CriticalFriction, ...], Rows(ETA, label=ETA)]
    here: CriticalFriction | None = None
    linear_limit: Annotated[tuple[LinearLimit, ...], Rows(ETA, "linear_limit_", label=ETA)]
    hard_limit: Annotated[tuple[HardLimit, ...], Rows(ETA, "hard_limit_", label=ETA)] = ()
    hard_limit_closed: Ratio | None = None
    band_few: Ratio
    band_most: Ratio
    band: bool
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]
    middle_kick: MetrePerSecond
    runs: int
    duration: Second
    ball_scatter: Ratio
    searched_friction: Ratio
    drifts: bool
    drift_rate_law: PerSecond
    adaptive: bool
    complete: bool


def stability_curve(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    runner: Runner | None = None,
) -> StabilityCurve:
    """Critical friction against restitution factor, and at the cage's own race damping.

    Parameters
    ----------
    cage : PlanarCage
        Its friction is replaced; its race damping but for `here`.
    settings : StabilitySettings
        Kicks, runs and seed; restitution factors, or none: then they are chosen where the curve bends.
    runner : Runner, optional
        How the runs are made; the numbers do not depend on it.

    Raises
    ------
    Interrupted
        With the curve of the points that were finished, if any was.
    """
    runner = runner or Runner()
    tracer = Tracer(GrowthCounter(cage, settings, runner), settings.restitution_factors, band=True)

    def curve(found: dict[Node, CriticalFriction]) -> StabilityCurve:
        here = found.pop((OWN_DAMPING, None), None)
        complete = here is not None and tracer.complete(found)
        return curve_of_points(cage, settings, list(found.values()), here=here, complete=complete)

    return runner.work_out(tracer.point, [*tracer.first, (OWN_DAMPING, None)], into=curve, more=tracer.more)


Node = tuple[Ratio, Ratio | None]
"""A restitution factor (or `OWN_DAMPING`), and a guess of its critical friction."""


class Tracer:
    """Which points of a curve are wanted, and how one is computed.

    Parameters
    ----------
    counter : GrowthCounter
        Counts the runs, and knows cage and settings.
    given : sequence of float
        Restitution factors; if none, they are chosen: halves, ever finer where the curve bends by more than
        its scatter.
    band : bool
        Whether the points have their band; if so, its ends are followed as well.
    frictions : sequence of float, optional
        Where the curve passes these it is followed as finely as it bends, elsewhere it is left coarse; by
        default it is fine everywhere.
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
        ends = [end for point in span for end in _curve(point)]
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
    return any(_misses(ends(low), ends(middle), ends(high)) for ends in (_curve, _band_low, _band_high))


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


Heights = tuple[Ratio, Ratio, Ratio]
"""A friction with its 95 % interval."""


def _curve(point: CriticalFriction) -> Heights:
    at = height(point)
    return at, _or(point.scatter_low, at), _or(point.scatter_high, at)


def _band_low(point: CriticalFriction) -> Heights:
    at = _or(point.critical_friction_low, 0.0)
    return at, _or(point.low_scatter_low, at), _or(point.low_scatter_high, at)


def _band_high(point: CriticalFriction) -> Heights:
    at = _or(point.critical_friction_high, SEARCHED_FRICTION)
    return at, _or(point.high_scatter_low, at), _or(point.high_scatter_high, at)


def _or(value: Ratio | None, other: Ratio) -> Ratio:
    return other if value is None else value


def curve_of_points(
    cage: PlanarCage,
    settings: StabilitySettings,
    points: Iterable[CriticalFriction],
    *,
    band: bool = True,
    here: CriticalFriction | None = None,
    complete: bool = True,
) -> StabilityCurve:
    """Return the curve of the finished points, rising restitution factors first, with its limits."""
    settings = settings_for(settings, cage)
    rising = sorted(points, key=lambda point: point.restitution_factor)
    etas = [point.restitution_factor for point in rising]
    hard = [hard_limit(cage, eta, settings) for eta in etas]
    return StabilityCurve(
        curve=tuple(rising),
        here=here,
        linear_limit=tuple(linear_limit(cage, eta) for eta in etas),
        hard_limit=tuple(limit for limit in hard if limit is not None),
        hard_limit_closed=closed_hard_limit(cage.ball_count),
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
