"""Where running-in ends: the longest tail of a test whose mean agrees with that of each later part of it.

No shape of running-in is assumed. Let the tail begin at some span. Its mean is compared with the means of all
shorter tails. Without running-in they differ by noise alone, and the variance of the difference of two nested
means is the difference of their variances. The noise is taken from the shorter, later tail, by its lowest
cosines, so that neighbouring values may be alike and running-in is not part of it. The steady part begins at
the earliest place where no difference exceeds noise and `WORTH` together: the method of Lepski [1]_, which
keeps as much of a series as its bias allows. What the later tails still differ by goes into the error. A test
that as a whole is a straight line and noise has a drift, and no running-in.

References
----------
.. [1] O. V. Lepskii, "On a problem of adaptive estimation in Gaussian white noise", Theory of Probability and
   its Applications 35 (1991) 454-466.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import dct
from scipy.ndimage import median_filter
from scipy.special import stdtrit

from separatrix.friction.reduction.steady import steady_mean
from separatrix.units import Array, Ratio

METHOD = "longest tail whose mean agrees with that of each later part"
PLACES = 96  # places where the steady part may begin, at most
LATEST = 0.75  # share of the test beyond which no steady part begins
COSINES = 8  # cosines from which the noise of a tail is estimated
CHANCE = 1e-3
"""Probability with which the difference of two tails exceeds noise on one side without running-in."""

WORTH = 0.0075  # change of the mean, as a share of it, for which nothing is cut
SEEN = 0.05
"""Deviation of the first part of a tail, as a share of friction, that is cut however short that part is."""

STRETCH = 1.3  # factor by which the place found may move up to where the differences are noise alone
NOISE = 2.0  # squares of standard errors that are noise in a difference: the rest of it is what may be left
LEVEL = 0.02  # what may be left, as a share of the mean, from which a steady part is not level
OUTLIER = 6.0
"""Standard deviations from its neighbours at which a single span is a spike, which is not running-in."""

DRIFT = 0.01  # probability without a drift below which a tail still drifts
EVEN = 3.0
"""Ratio of the power at the lowest cosines to that at the next from which friction wanders or bends."""

FEWEST = 12  # spans below which running-in is not looked for
ROUNDING = 1e-12  # share of friction below which differences are those of rounding


@dataclass(frozen=True, slots=True, kw_only=True)
class RunIn:
    """End of running-in, as a share of the stretch that was looked at."""

    end: Ratio
    rest: Ratio
    """Largest difference between the mean behind the end and that of a later part, less its noise [-]."""
    ends: bool
    """Whether an earlier place than the latest will do, and friction does not go on changing behind it."""
    level: bool  # whether what may be left is at most `LEVEL` of the mean


def run_in(values: Array) -> RunIn:
    """Return where running-in ends, from means over equal spans, shape (span,)."""
    n = values.size
    if n < FEWEST or np.ptp(values) <= ROUNDING * np.abs(values).max():
        return RunIn(end=0.0, rest=0.0, ends=True, level=True)
    # spikes of one or two spans are replaced by the median of their neighbours
    middle = median_filter(values, 5, mode="nearest")
    excess = np.abs(values - middle)
    scatter = 1.4826 * float(np.median(excess))
    values = np.where(excess > OUTLIER * scatter, middle, values) if scatter > 0.0 else values
    line = _without_line(values)
    power = dct(line, type=2, norm="ortho")[1:] ** 2
    even = power[:COSINES].mean() <= EVEN * power[COSINES : 4 * COSINES].mean()  # no slow wander, no curve
    straight = _Tails(line, _without_line)
    if even and straight.first(straight.noise) == 0:
        return straight.from_place(0, abs(float(values.mean())))
    tails = _Tails(values, _without_level)
    first = tails.first(tails.noise + tails.worth)
    if first:
        reach = int(np.searchsorted(tails.starts, STRETCH * tails.starts[first] + 1, side="right")) - 1
        first = max(first, min(tails.first(tails.noise), reach))
    found = tails.from_place(first, abs(float(tails.means[first])))
    return replace(found, ends=False) if first and _goes_on(values, int(tails.starts[first])) else found


def _goes_on(values: Array, start: int) -> bool:
    """Return whether the tail still drifts away from what was before it, more than noise and `LEVEL` make."""
    tail = steady_mean(values[start:])
    away = tail.change * (tail.mean - float(values[:start].mean())) > 0.0
    return away and tail.change_chance < DRIFT and abs(tail.change) > LEVEL * abs(tail.mean)


class _Tails:
    """The means of all tails of a series, their differences, and what noise makes of those."""

    def __init__(self, values: Array, without: Callable[[Array], Array]) -> None:
        n = values.size
        self.starts = np.unique(np.linspace(0.0, min(LATEST * n, n - COSINES), PLACES + 1).astype(int))
        self.left = (n - self.starts).astype(float)
        self.share = self.starts / n
        self.means = np.cumsum(values[::-1])[::-1][self.starts] / self.left
        self.difference = np.abs(self.means[:, None] - self.means[None, :])
        shorter = np.maximum(1.0 / self.left[None, :] - 1.0 / self.left[:, None], 0.0)
        tails = (dct(without(values[start:]), type=2, norm="ortho") for start in self.starts.tolist())
        densities = np.array([float((tail[1 : COSINES + 1] ** 2).mean()) for tail in tails])
        self.variance = shorter * densities
        self.noise = float(stdtrit(min(COSINES, n - 1), 1.0 - CHANCE)) * np.sqrt(self.variance)

    @property
    def worth(self) -> Array:
        """Differences for which nothing is cut, shape (place, later place)."""
        part = 1.0 - self.left[None, :] / self.left[:, None]
        return np.asarray(np.minimum(WORTH, SEEN * part) * np.abs(self.means))

    def first(self, limit: Array) -> int:
        """Return the first tail that agrees with all later ones within a limit; the last always does."""
        earlier = np.tril(np.ones_like(limit, dtype=bool))
        return int(np.argmax((earlier | (self.difference <= limit)).all(axis=1)))

    def from_place(self, place: int, mean: float) -> RunIn:
        """Return the end of running-in at a place."""
        square = (self.difference[place] ** 2 - NOISE * self.variance[place])[place:]
        rest = float(np.sqrt(max(0.0, float(square.max()))))
        ends = place < self.starts.size - 1
        return RunIn(end=float(self.share[place]), rest=rest, ends=ends, level=rest <= LEVEL * mean)


def _without_level(values: Array) -> Array:
    return np.asarray(values - values.mean())


def _without_line(values: Array) -> Array:
    x = np.arange(values.size) - (values.size - 1) / 2.0
    return np.asarray(values - values.mean() - x * (x @ values) / (x @ x))
