"""Critical pocket friction against restitution factor, with its band: the stability curve (paper, Fig. 2)."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

from separatrix.cage import PlanarCage, linear_critical_friction
from separatrix.stability.crossing import Counter, Crossing, Side, find_crossing, interval, reaches
from separatrix.stability.growth import Count, GrowthCounter, cage_at
from separatrix.stability.pool import Progress, work_through
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, Ratio, Second

SEARCHED_FRICTION: Ratio = 1.0
"""Critical friction is looked for from 0 up to here."""

_STEPS_A_DECADE = 24  # neighbours differ by 10 %, well inside the band
FRICTION_GRID: tuple[Ratio, ...] = (
    0.0,
    *(SEARCHED_FRICTION * 10 ** (-i / _STEPS_A_DECADE) for i in range(2 * _STEPS_A_DECADE + 12, -1, -1)),
)
"""Frictions at which runs are counted; between two of them the shares are joined by a line."""

BAND_CELLS = 4
"""A guess of how far the band's ends lie from its middle; it costs or saves time only."""

Found = tuple[Crossing | Side, Ratio, MetrePerSecond]
"""Where P crosses a target, from which kick."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalFriction:
    """Critical friction at one restitution factor; None where there is none, with the reason.

    Attributes
    ----------
    restitution_factor : float
        eta [-].
    critical_friction : float or None
        Friction at which half the runs grow from the middle kick [-].
    critical_friction_low, critical_friction_high : float or None
        Smallest friction at which one run in ten grows from some kick, and largest at which nine in ten
        grow from every kick: the band [-].
    scatter_low, scatter_high : float or None
        95 % interval of `critical_friction` from the number of runs [-].
    side : Side or None
        Where `critical_friction` is None: whether P(grow) lies above one half throughout, or below.
    reason : str or None
        Why something is None.
    """

    restitution_factor: Ratio
    critical_friction: Ratio | None = None
    critical_friction_low: Ratio | None = None
    critical_friction_high: Ratio | None = None
    scatter_low: Ratio | None = None
    scatter_high: Ratio | None = None
    side: Side | None = None
    reason: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearLimit:
    """Critical friction without clearance in a ball set at rest, in closed form."""

    restitution_factor: Ratio
    critical_friction: Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCurve:
    """Stability curve, the linear limit beside it, and the ensemble it holds for.

    `complete` is False if an interrupt left points out.
    """

    curve: tuple[CriticalFriction, ...]
    linear_limit: tuple[LinearLimit, ...]
    kicks: tuple[MetrePerSecond, ...]
    middle_kick: MetrePerSecond
    runs: int
    duration: Second
    ball_scatter: Ratio
    searched_friction: Ratio
    complete: bool


def stability_curve(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    counter: GrowthCounter | None = None,
) -> StabilityCurve:
    """Critical friction at each restitution factor of the settings.

    Parameters
    ----------
    cage : PlanarCage
        Its race damping and friction are replaced.
    settings : StabilitySettings
        Restitution factors, kicks, runs and seed.
    jobs : int
        Threads; the numbers do not depend on it.
    progress : callable, optional
        Called with (done, total) points.
    counter : GrowthCounter, optional
        To share counts with other questions about the same cage and settings.

    Raises
    ------
    KeyboardInterrupt
        Interrupted before the first point was finished; later the finished points are returned.
    """
    counts = counter or GrowthCounter(cage, settings)
    etas = settings.restitution_factors
    points = work_through(
        lambda eta: critical_friction(cage, eta, settings, counter=counts), etas, jobs=jobs, progress=progress
    )
    finished = [point for point in points if point is not None]
    if etas and not finished:
        raise KeyboardInterrupt
    return curve_of_points(cage, settings, finished)


def curve_of_points(
    cage: PlanarCage, settings: StabilitySettings, points: Sequence[CriticalFriction]
) -> StabilityCurve:
    """Return the curve of the points that were finished, rising restitution factors first."""
    rising = sorted(points, key=lambda point: point.restitution_factor)
    return StabilityCurve(
        curve=tuple(rising),
        linear_limit=tuple(linear_limit(cage, point.restitution_factor) for point in rising),
        kicks=settings.kicks,
        middle_kick=settings.middle_kick,
        runs=settings.runs,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        searched_friction=SEARCHED_FRICTION,
        complete=len(points) == len(settings.restitution_factors),
    )


def linear_limit(cage: PlanarCage, restitution_factor: Ratio) -> LinearLimit:
    """Critical friction of the linear law, 2 zeta sqrt(2/Z), at one restitution factor."""
    critical = linear_critical_friction(cage_at(cage, restitution_factor, 0.0))
    return LinearLimit(restitution_factor=restitution_factor, critical_friction=critical)


def critical_friction(
    cage: PlanarCage,
    restitution_factor: Ratio,
    settings: StabilitySettings,
    *,
    counter: GrowthCounter | None = None,
    band: bool = True,
) -> CriticalFriction:
    """Friction at which half the runs grow from the middle kick, and the band over all kicks.

    Parameters
    ----------
    cage : PlanarCage
        Its race damping and friction are replaced.
    restitution_factor : float
        Nominal, of the whole cage mass [-].
    settings : StabilitySettings
        Kicks, runs and seed.
    counter : GrowthCounter, optional
        To share counts with other questions about the same cage and settings.
    band : bool
        Whether the band is wanted; its ends are counted with half the runs.
    """
    counts = counter or GrowthCounter(cage, settings)
    middle = _counter(counts, restitution_factor, settings.middle_kick, settings.runs)
    half = max(1, settings.runs // 2)
    at = {kick: _counter(counts, restitution_factor, kick, half) for kick in sorted(settings.kicks)}
    start = _guess(cage, restitution_factor)
    found = find_crossing(middle, FRICTION_GRID, 0.5, start)
    low, high = (None, None)
    if isinstance(found, Crossing):
        low, high = interval(middle, FRICTION_GRID, found, 0.5)
        start = found.cell
    ends = [(found, 0.5, settings.middle_kick)]
    ends += [_first(at, 0.1, start), _last(at, 0.9, start)] if band else []
    values = [end[0].value if isinstance(end[0], Crossing) else None for end in ends] + [None, None]
    return CriticalFriction(
        restitution_factor=restitution_factor,
        critical_friction=values[0],
        critical_friction_low=values[1],
        critical_friction_high=values[2],
        scatter_low=low,
        scatter_high=high,
        side=found if isinstance(found, Side) else None,
        reason=_reason(ends),
    )


def _guess(cage: PlanarCage, eta: Ratio) -> int:
    """Cell of the friction grid to start from, by the linear law; it costs or saves time only."""
    limit = linear_limit(cage, min(eta, 0.9)).critical_friction
    return min(max(bisect_left(FRICTION_GRID, 0.8 * limit), 1), len(FRICTION_GRID) - 2)


def _reason(ends: Sequence[Found]) -> str | None:
    """Return why a crossing is missing; None if none is."""
    reasons = [_REASONS[side].format(target, kick) for side, target, kick in ends if isinstance(side, Side)]
    return "; ".join(dict.fromkeys(reasons)) or None


_REASONS = {
    Side.ABOVE: "from {1:g} m/s a share of {0:g} of the runs grows even without pocket friction",
    Side.BELOW: f"from {{1:g}} m/s less than {{0:g}} of the runs grow up to friction {SEARCHED_FRICTION:g}",
}


def _counter(counts: GrowthCounter, eta: Ratio, kick: MetrePerSecond, most: int) -> Counter:
    def count(friction: Ratio, target: Ratio | None) -> Count:
        return counts.count(eta, friction, kick, target=target, most=most)

    return count


def _first(at: dict[MetrePerSecond, Counter], target: Ratio, start: int) -> Found:
    """Smallest crossing of the target over the kicks; ABOVE if one is above it without friction."""
    for kick, count in at.items():
        if reaches(count, FRICTION_GRID[0], target):
            return Side.ABOVE, target, kick
    best: Found = (Side.BELOW, target, max(at))
    for kick in sorted(at, reverse=True):
        known = best[0]
        cell = known.cell if isinstance(known, Crossing) else start - BAND_CELLS
        if isinstance(known, Crossing) and at[kick](FRICTION_GRID[cell], target).share < target:
            continue  # this kick needs more friction than the best one
        best = _better(best, (find_crossing(at[kick], FRICTION_GRID, target, cell), target, kick), sign=1)
    return best


def _last(at: dict[MetrePerSecond, Counter], target: Ratio, start: int) -> Found:
    """Largest crossing of the target over the kicks; BELOW if one is below it at the top."""
    for kick, count in at.items():
        if not reaches(count, FRICTION_GRID[-1], target):
            return Side.BELOW, target, kick
    best: Found = (Side.ABOVE, target, min(at))
    for kick in sorted(at):
        known = best[0]
        cell = known.cell if isinstance(known, Crossing) else start + BAND_CELLS
        if isinstance(known, Crossing) and at[kick](FRICTION_GRID[cell + 1], target).share >= target:
            continue  # this kick needs less friction than the best one
        best = _better(best, (find_crossing(at[kick], FRICTION_GRID, target, cell), target, kick), sign=-1)
    return best


def _better(best: Found, other: Found, *, sign: int) -> Found:
    """Return the one with the smaller value (sign 1) or the larger (-1); a crossing beats none."""
    if not isinstance(other[0], Crossing):
        return best
    if not isinstance(best[0], Crossing) or sign * other[0].value < sign * best[0].value:
        return other
    return best
