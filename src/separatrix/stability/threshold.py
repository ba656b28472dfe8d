"""The restitution factor at which a cage of given pocket friction starts to be unstable."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from separatrix.cage import PlanarCage
from separatrix.stability.crossing import Side
from separatrix.stability.curve import SEARCHED_FRICTION, CriticalFriction, critical_friction
from separatrix.stability.growth import GrowthCounter
from separatrix.stability.pool import Progress, work_through
from separatrix.study import StabilitySettings
from separatrix.units import Ratio

OUTER_FACTORS: tuple[Ratio, ...] = (0.0, 0.98, 1.0)
"""Restitution factors beside those of the settings, so that thresholds are solved over all of 0 to 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionThreshold:
    """Largest restitution factor at which the cage is stable, with the 95 % interval of the runs' scatter."""

    value: Ratio
    low: Ratio
    high: Ratio


def restitution_threshold(points: Sequence[CriticalFriction], friction: Ratio) -> RestitutionThreshold:
    """Restitution factor at which the critical friction equals `friction`.

    Parameters
    ----------
    points : sequence of CriticalFriction
        From 0 to 1, rising: `threshold_points`. Between two of them the critical friction is a straight line.
    friction : float
        f_BC of the material [-].

    Returns
    -------
    RestitutionThreshold
        0 if the cage is never stable, 1 if it is stable even on balls gripped by their races. Where the
        critical friction wavers, the first restitution factor at which it falls below `friction`. The
        interval comes from the ends of the critical friction's own, in the same way.
    """
    value = _first_below(points, friction, lambda point: point.critical_friction)
    low = _first_below(points, friction, lambda point: point.scatter_low)
    high = _first_below(points, friction, lambda point: point.scatter_high)
    return RestitutionThreshold(value=value, low=min(low, value), high=max(high, value))


def _first_below(
    points: Sequence[CriticalFriction], friction: Ratio, height: Callable[[CriticalFriction], Ratio | None]
) -> Ratio:
    """Smallest restitution factor at which a curve through the points is below `friction`; 1 if none is."""
    before: tuple[Ratio, Ratio] | None = None
    for point in points:
        eta, f = point.restitution_factor, _height(point, height(point))
        if f < friction or point.side is Side.ABOVE:
            if before is None:
                return eta
            return (
                before[0] + (eta - before[0]) * (before[1] - friction) / (before[1] - f)
                if f < before[1]
                else eta
            )
        before = eta, f
    return 1.0


def _height(point: CriticalFriction, value: Ratio | None) -> Ratio:
    """Critical friction, with 0 or the top of the searched range where there is none."""
    if value is not None:
        return value
    return 0.0 if point.side is Side.ABOVE else SEARCHED_FRICTION


def threshold_points(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    counter: GrowthCounter | None = None,
) -> list[CriticalFriction]:
    """Critical friction, without its band, from a restitution factor of 0 to 1.

    Raises
    ------
    KeyboardInterrupt
        Interrupted: a threshold needs all the points.
    """
    counts = counter or GrowthCounter(cage, settings)
    etas = threshold_factors(settings)
    points = work_through(
        lambda eta: critical_friction(cage, eta, settings, counter=counts, band=False),
        etas,
        jobs=jobs,
        progress=progress,
    )
    finished = [point for point in points if point is not None]
    if len(finished) < len(etas):
        raise KeyboardInterrupt
    return finished


def threshold_factors(settings: StabilitySettings) -> list[Ratio]:
    """Restitution factors of the settings and those beside them, rising."""
    return sorted({*settings.restitution_factors, *OUTER_FACTORS})
