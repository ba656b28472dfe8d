"""The restitution factor at which a cage of given pocket friction starts to be unstable."""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.cage import PlanarCage
from separatrix.stability.crossing import Crossing, Side, find_crossing, interval
from separatrix.stability.growth import Count, GrowthCounter
from separatrix.study import StabilitySettings
from separatrix.units import Ratio

RESTITUTION_GRID: tuple[Ratio, ...] = (*(i / 50 for i in range(50)), 0.99, 0.995, 1.0)
"""Restitution factors at which runs are counted; between two of them the shares are joined by a line."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionThreshold:
    """Largest restitution factor at which the cage is stable, with the 95 % interval of the runs' scatter."""

    value: Ratio
    low: Ratio
    high: Ratio
    reason: str


def restitution_threshold(
    cage: PlanarCage, friction: Ratio, settings: StabilitySettings, *, counter: GrowthCounter | None = None
) -> RestitutionThreshold:
    """Restitution factor at which half the runs grow from the middle kick.

    It is where the critical friction equals `friction`.

    Parameters
    ----------
    cage : PlanarCage
        Its race damping and friction are replaced.
    friction : float
        f_BC of the material [-].
    settings : StabilitySettings
        Kicks, runs and seed.
    counter : GrowthCounter, optional
        To share counts with other questions about the same cage and settings.

    Returns
    -------
    RestitutionThreshold
        Solved over all of 0 to 1: 0 if the cage is never stable, 1 if it is stable even on gripped balls.
        The interval holds the points at which the count of runs does not tell P(grow) from one half.
    """
    counts = counter or GrowthCounter(cage, settings)
    kick = settings.middle_kick

    def count(eta: Ratio, target: Ratio | None) -> Count:
        return counts.count(eta, friction, kick, target=target)

    found = find_crossing(count, RESTITUTION_GRID, 0.5, start=len(RESTITUTION_GRID) // 2)
    if isinstance(found, Side):
        reason = _ALL[found].format(friction=friction)
        found = Crossing(0.0, 0) if found is Side.ABOVE else Crossing(1.0, len(RESTITUTION_GRID) - 2)
    else:
        reason = f"half the runs grow at a restitution factor of {found.value:.2f}"
    low, high = interval(count, RESTITUTION_GRID, found, 0.5)
    return RestitutionThreshold(value=found.value, low=low, high=high, reason=reason)


_ALL = {
    Side.ABOVE: "with a pocket friction of {friction:.3g} most runs grow at any restitution factor",
    Side.BELOW: "with a pocket friction of {friction:.3g} most runs die at any restitution factor",
}
