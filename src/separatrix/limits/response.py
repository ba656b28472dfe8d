"""At which friction a counted probability passes a target: a response curve fitted to few runs.

Near its target P is taken as logistic in the logarithm of friction. Place and slope are not known; both are
summed over on a grid, weighted with the probability of the counts. So the estimate has an interval from the
first run on, and the next runs are counted where it says that the target lies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from separatrix.limits.growth import Count
from separatrix.units import Array, Ratio

SEARCHED_FRICTION: Ratio = 1.0
"""Critical friction is looked for from 0 up to here."""

_STEPS_A_DECADE = 24  # neighbours differ by 10 %, well inside the band
LADDER: tuple[Ratio, ...] = (
    0.0,
    *(SEARCHED_FRICTION * 10 ** (-i / _STEPS_A_DECADE) for i in range(2 * _STEPS_A_DECADE + 12, -1, -1)),
)
"""Frictions at which runs are counted."""

LAST = len(LADDER) - 1
STEP = math.log(10.0) / _STEPS_A_DECADE
BATCH = 8
"""Runs counted at a time, or a twelfth of all if that is more."""

TURNS = 40
"""Counts for one crossing at most, where a dozen do: a centre may move away from what was counted before."""

NEAR = 4.0
"""Steps of the ladder on either side in which P is taken as logistic: a factor of 1.5."""

SLOPES: Array = np.geomspace(3.0, 100.0, 13)
"""Slopes of logit P in ln f that are thought possible, equally likely each; measured ones lie between."""

PLACES: Array = np.linspace(-1.3 * NEAR, 1.3 * NEAR, 81) * STEP
EITHER_SIDE = (0.1, 0.9)
ENDS_95 = (0.025, 0.975)

Look = Callable[[Ratio, int, int], Count]
"""Whirling runs at a friction: number of the first run, and how many."""


class Side(Enum):
    """Why there is no crossing: P is above the target everywhere, or below it."""

    ABOVE = "above"
    BELOW = "below"


@dataclass(frozen=True, slots=True)
class Crossing:
    """Friction at which P rises through its target, with the 95 % interval that the counts leave."""

    value: Ratio
    low: Ratio
    high: Ratio


class Response:
    """Counts on the ladder for one restitution factor and kick; no run is counted twice.

    Parameters
    ----------
    look : callable
        Counts runs.
    runs : int
        Runs of the settings: the scale of what a side of the ladder may cost.
    """

    def __init__(self, look: Look, runs: int) -> None:
        self.counts: dict[int, Count] = {}
        self._look, self._runs, self._next = look, runs, 0

    def add(self, cell: int, runs: int) -> Count:
        """Count more runs at a place of the ladder."""
        found = self._look(LADDER[cell], self._next, runs)
        self._next += runs
        self.counts[cell] = self.counts.get(cell, Count(0, 0)) + found
        return self.counts[cell]

    def first(self, cell: int) -> Count:
        """Return what is known at a place, after a first look."""
        return self.counts.get(cell) or self.add(cell, min(BATCH, self._runs))

    def reaches(self, cell: int, target: Ratio) -> bool:
        """True if P reaches the target at an end of the ladder; a first look that agrees is enough."""
        count = self.first(cell)
        while 0 < count.whirling < count.runs < self._runs:
            low, high = count.interval()
            if not low <= target <= high:
                break
            count = self.add(cell, min(count.runs, self._runs - count.runs))
        return count.share >= target

    def crossing(self, target: Ratio, runs: int, guess: Ratio) -> Crossing | Side:
        """Friction at which P passes the target, or the side on which P lies all along.

        Both ends of the ladder are looked at first, since P need not rise. Where P wavers through the target
        more than once, one of the crossings is found.

        Parameters
        ----------
        target : float
            The probability looked for [-].
        runs : int
            Runs to be spent near the crossing.
        guess : float
            A friction near it; it changes the time, and the result only within its interval.
        """
        if self.reaches(0, target):
            return Side.ABOVE
        if not self.reaches(LAST, target):
            return Side.BELOW
        low, high = self._bracket(target, cell_of(guess))
        if low == 0:
            return Crossing(0.5 * LADDER[1], 0.0, LADDER[1])
        return self._refined(target, runs, 0.5 * (math.log(LADDER[low]) + math.log(LADDER[high])))

    def _bracket(self, target: Ratio, start: int) -> tuple[int, int]:
        """Places not far apart, P below the target at the first and not at the second."""
        low = high = start
        step = 2
        if self.first(start).share >= target:
            while low > 0 and self.first(low).share >= target:
                low, high, step = max(0, low - step), low, 2 * step
        else:
            while high < LAST and self.first(high).share < target:
                low, high, step = high, min(LAST, high + step), 2 * step
        while high - low > (NEAR if low > 0 else 1):  # what is further off tells nothing of the middle
            middle = (low + high) // 2
            low, high = (low, middle) if self.first(middle).share >= target else (middle, high)
        return low, high

    def _refined(self, target: Ratio, runs: int, centre: float) -> Crossing:
        """Count where the target may lie, in turn on either side of it, until the runs are spent."""
        for turn in range(TURNS):
            near = self._near(centre)
            place = centre + PLACES
            weight = posterior(near, place, target)
            centre = quantile(place, weight, 0.5)
            jump = self._jump(centre, target)
            if jump is not None:
                return jump
            if sum(count.runs for count in self._near(centre).values()) >= runs:
                break
            wanted = math.exp(quantile(place, weight, EITHER_SIDE[turn % 2]))
            self.add(cell_of(wanted), max(min(BATCH, runs), runs // 12))
        low, high = (math.exp(quantile(place, weight, q)) for q in ENDS_95)
        return Crossing(math.exp(centre), low, min(high, SEARCHED_FRICTION))

    def _near(self, centre: float) -> dict[float, Count]:
        """Counts around a logarithm of friction."""
        return {
            math.log(LADDER[cell]): count
            for cell, count in sorted(self.counts.items())
            if cell > 0 and abs(math.log(LADDER[cell]) - centre) <= (NEAR + 0.01) * STEP
        }

    def _jump(self, centre: float, target: Ratio) -> Crossing | None:
        """Return the whole cell if P jumps inside it from none to all: nothing more is known of it."""
        high = next((i for i in range(1, LAST) if math.log(LADDER[i]) > centre), LAST)
        below, above = (self.counts.get(i, Count(0, 0)) for i in (high - 1, high))
        agree = below.unanimous(target) and above.unanimous(target)
        if high == 1 or not agree or below.share >= above.share:
            return None
        low, top = LADDER[high - 1], LADDER[high]
        return Crossing(math.sqrt(low * top), low, top)


def cell_of(friction: Ratio) -> int:
    """Place of the ladder nearest to a friction, neither its first nor its last."""
    steps = round(math.log(max(friction, LADDER[1]) / SEARCHED_FRICTION) / STEP)
    return min(max(LAST + steps, 1), LAST - 1)


def posterior(counts: Mapping[float, Count], place: Array, target: Ratio) -> Array:
    """Probability that P passes the target at each place, from counts against ln f; shape (place,) [-]."""
    if not counts:
        return np.full(place.size, 1.0 / place.size)
    x = np.array(list(counts))
    whirling = np.array([count.whirling for count in counts.values()], dtype=np.float64)
    runs = np.array([count.runs for count in counts.values()], dtype=np.float64)
    logit = math.log(target / (1.0 - target)) + SLOPES[:, None] * (x - place[:, None])[:, None, :]
    likelihood = whirling * logit - runs * np.logaddexp(0.0, logit)
    total = likelihood.sum(axis=-1)
    weight = np.exp(total - total.max()).sum(axis=-1)
    return np.asarray(weight / weight.sum())


def quantile(place: Array, weight: Array, share: Ratio) -> float:
    """Place below which a share of the weight lies."""
    return float(np.interp(share, np.cumsum(weight) - 0.5 * weight, place))
