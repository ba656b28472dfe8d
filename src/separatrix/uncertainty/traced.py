"""The traced stability curve of every kick: lines over the restitution factor, with the runs' own scatter."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from separatrix.cage import PlanarCage, wilson_interval
from separatrix.cage.drive import drifts
from separatrix.stability import SEARCHED_FRICTION, Count, CriticalFriction, GrowthCounter, Tracer
from separatrix.stability.pool import Progress, work_out
from separatrix.stability.response import ENDS_95, NEAR, PLACES, STEP, posterior, quantile
from separatrix.stability.threshold import rising, threshold_factors
from separatrix.study import StabilitySettings
from separatrix.units import Array, MetrePerSecond, Ratio

FEW: Ratio = 0.1
"""Share of whirling runs up to which a kick is said to die: nine in ten die (`cage.verdict`)."""

HALF: Ratio = 0.5
RUNS = 64
"""Runs of a kick behind a verdict, at least: what "clearly more than half of them grow" means."""

Z_95 = 1.959963984540054


def clear_share(runs: int) -> Ratio:
    """Smallest share of so many runs whose Wilson interval lies above one half [-]: 40 of 64."""
    most = max(runs, RUNS)
    return next(n for n in range(most // 2, most + 1) if wilson_interval(n, most)[0] > HALF) / most


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TracedBoundary:
    """Frictions at which few, half and clearly more than half of the runs whirl, at each kick.

    Attributes
    ----------
    restitution_factors : ndarray
        Rising, from 0 to 1, shape (node,) [-].
    kicks : tuple of float
        As in the settings [m/s].
    middle : int
        Which of them defines the threshold.
    targets : tuple of float
        Shares of whirling runs: `FEW`, `HALF`, and `clear_share` [-].
    friction : ndarray
        At which the share is reached, shape (kick, target, node) [-]: 0 where it is reached without
        friction, `SEARCHED_FRICTION` where it is reached nowhere.
    error : ndarray
        Standard deviation of its logarithm, from the number of runs, same shape [-].
    drifts : bool
        Whether nothing holds the cage centre: such a cage is never STABLE.
    runs : int
        Runs that were counted.
    """

    restitution_factors: Array
    kicks: tuple[MetrePerSecond, ...]
    middle: int
    targets: tuple[Ratio, Ratio, Ratio]
    friction: Array
    error: Array
    drifts: bool
    runs: int

    def lines(self, draw: Array | None = None) -> Array:
        """Lines as they are, or as they may be: `draw` holds standard normal numbers, shape (kick, node)."""
        if draw is None:
            return self.friction
        return np.asarray(self.friction * np.exp(self.error * draw[:, None, :]))


def traced_boundary(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    counter: GrowthCounter | None = None,
) -> TracedBoundary:
    """Trace the curve with its band over restitution factors from 0 to 1.

    The points of the reference kick are those of `rank` and `stability`, so that the thresholds agree.

    Raises
    ------
    KeyboardInterrupt
        Interrupted: the lines need all points.
    """
    counts = counter or GrowthCounter(cage, settings)
    tracer = Tracer(counts, threshold_factors(settings), band=True)
    found = work_out(
        tracer.point, tracer.first, more=tracer.more, jobs=jobs, progress=progress, stop=counts.stop
    )
    if not tracer.complete(found):
        raise KeyboardInterrupt
    return boundary_of_points(rising(found.values()), counts)


def boundary_of_points(points: Sequence[CriticalFriction], counter: GrowthCounter) -> TracedBoundary:
    """Return the lines through finished points, from the runs that were counted for them."""
    settings = counter.settings
    targets = (FEW, HALF, clear_share(settings.runs))
    shape = (len(settings.kicks), len(targets), len(points))
    friction, error, runs = np.zeros(shape), np.zeros(shape), 0
    for j, point in enumerate(points):
        for i, kick in enumerate(settings.kicks):
            counts = counter.counts(point.restitution_factor, kick)
            runs += sum(count.runs for count in counts.values())
            for t, known in enumerate((point.kick_low[i], point.kick_critical_friction[i], None)):
                middle = point.kick_critical_friction[i] if t == len(targets) - 1 else None
                friction[i, t, j], error[i, t, j] = _place(counts, targets[t], known, middle)
    return TracedBoundary(
        restitution_factors=np.array([point.restitution_factor for point in points]),
        kicks=settings.kicks,
        middle=settings.kicks.index(settings.middle_kick),
        targets=targets,
        friction=np.maximum.accumulate(friction, axis=1),
        error=error,
        drifts=drifts(counter.cage),
        runs=runs,
    )


def _place(
    counts: Mapping[Ratio, Count], target: Ratio, known: Ratio | None, near: Ratio | None
) -> tuple[Ratio, float]:
    """Friction at which the share is reached and the scatter of its logarithm; `near` is a guess of it."""
    if known is None and near is None:
        alone = counts.get(0.0)
        return (0.0 if alone is not None and alone.share >= target else SEARCHED_FRICTION), 0.0
    centre = math.log(near if known is None else known)  # type: ignore[arg-type]
    close = {
        math.log(f): count
        for f, count in counts.items()
        if f > 0.0 and abs(math.log(f) - centre) <= (NEAR + 0.01) * STEP
    }
    place = centre + PLACES
    weight = posterior(close, place, target)
    low, high = (quantile(place, weight, q) for q in ENDS_95)
    value = math.exp(quantile(place, weight, 0.5)) if known is None else known
    return value, (high - low) / (2.0 * Z_95)
