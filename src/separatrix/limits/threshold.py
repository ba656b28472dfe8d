"""The restitution factor at which a cage of given pocket friction starts to be unstable."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from separatrix.cage import PlanarCage
from separatrix.limits.curve import Node, Tracer, height
from separatrix.limits.growth import GrowthCounter
from separatrix.limits.point import CriticalFriction
from separatrix.limits.response import Side
from separatrix.runner import Runner
from separatrix.study import StabilitySettings
from separatrix.units import Ratio

OUTER_FACTORS: tuple[Ratio, ...] = (0.0, 0.98, 1.0)
"""Restitution factors beside those that a study gives, so that thresholds are solved over all of 0 to 1."""


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
    points: Sequence[CriticalFriction], friction: Ratio, end: Callable[[CriticalFriction], Ratio | None]
) -> Ratio:
    """Smallest restitution factor at which a curve through the points is below `friction`; 1 if none is."""
    before: tuple[Ratio, Ratio] | None = None
    for point in points:
        known = end(point)
        eta, f = point.restitution_factor, height(point) if known is None else known
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


def threshold_points(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    runner: Runner | None = None,
) -> list[CriticalFriction]:
    """Critical friction, without its band, from a restitution factor of 0 to 1.

    Raises
    ------
    Interrupted
        A threshold needs all the points.
    """
    runner = runner or Runner()
    tracer = Tracer(GrowthCounter(cage, settings, runner), threshold_factors(settings), band=False)
    return runner.work_out(
        tracer.point, tracer.first, into=lambda found: rising(found.values()), more=tracer.more
    )


def own_threshold(
    cage: PlanarCage, settings: StabilitySettings, friction: Ratio, runner: Runner
) -> RestitutionThreshold:
    """Threshold of one friction: the curve is followed, here and now, as finely as that needs.

    Raises
    ------
    Interrupted
        A threshold needs all the points.
    """
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
