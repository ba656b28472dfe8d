"""Where a counted probability crosses a target on a fixed grid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

from separatrix.stability.growth import Count
from separatrix.units import Ratio

Counter = Callable[[Ratio, Ratio | None], Count]
"""Count at a coordinate; with a target, only as many runs as tell on which side of it P lies."""


class Side(Enum):
    """Why there is no crossing: P is above the target everywhere, or below it."""

    ABOVE = "above"
    BELOW = "below"


@dataclass(frozen=True, slots=True)
class Crossing:
    """P crosses its target at `value`, between two neighbours `cell`, `cell` + 1 of the grid."""

    value: Ratio
    cell: int


def find_crossing(counter: Counter, grid: Sequence[Ratio], target: Ratio, start: int = 0) -> Crossing | Side:
    """Crossing of P upward through the target, or the side on which P lies all along.

    Both ends are looked at first, since P need not rise; then the grid is searched outward from `start`
    and halved. Where P wavers through the target by chance, one of the crossings is found.

    Parameters
    ----------
    counter : callable
        Counts at a coordinate.
    grid : sequence of float
        Rising coordinates.
    target : float
        The probability looked for [-].
    start : int
        A guess of the cell; it changes the time, and the result only where P wavers.
    """

    def above(i: int) -> bool:
        return counter(grid[i], target).share >= target

    last = len(grid) - 1
    if reaches(counter, grid[0], target):
        return Side.ABOVE
    if not reaches(counter, grid[last], target):
        return Side.BELOW
    low, high = _bracket(above, min(max(start, 1), last - 1), last)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if above(middle) else (middle, high)
    return _settled(counter, grid, target, low)


def reaches(counter: Counter, at: Ratio, target: Ratio) -> bool:
    """True if P reaches the target at a coordinate; a first look in which all runs agree is enough."""
    look = counter(at, 0.5)
    if look.grown in (0, look.runs):
        return look.grown > 0
    return counter(at, target).share >= target


def _settled(counter: Counter, grid: Sequence[Ratio], target: Ratio, cell: int) -> Crossing | Side:
    """Crossing in the cell at whose ends P lies on either side of the target by all the runs."""
    last = len(grid) - 1
    while cell > 0 and counter(grid[cell], None).share >= target:
        cell -= 1
    while cell + 1 < last and counter(grid[cell + 1], None).share < target:
        cell += 1
    shares = counter(grid[cell], None).share, counter(grid[cell + 1], None).share
    if cell == 0 and shares[0] >= target:
        return Side.ABOVE
    if shares[1] < target:
        return Side.BELOW
    return Crossing(_between(grid[cell], grid[cell + 1], shares, target), cell)


def _bracket(above: Callable[[int], bool], start: int, last: int) -> tuple[int, int]:
    """Neighbours of `start`, ever further, of which P is below at the first and above at the second."""
    low = high = start
    step = 1
    if above(start):
        while low > 0 and above(low):
            low, high, step = max(0, low - step), low, 2 * step
    else:
        while high < last and not above(high):
            low, high, step = high, min(last, high + step), 2 * step
    return low, high


def _between(low: Ratio, high: Ratio, shares: tuple[Ratio, Ratio], target: Ratio) -> Ratio:
    """Coordinate at which the line between two shares has the target; the middle if it has not."""
    rise = shares[1] - shares[0]
    part = (target - shares[0]) / rise if rise > 0.0 else 0.5
    return low + min(max(part, 0.0), 1.0) * (high - low)


def interval(
    counter: Counter, grid: Sequence[Ratio], crossing: Crossing, target: Ratio
) -> tuple[Ratio, Ratio]:
    """Coordinates between which the target lies inside the 95 % interval of the counts, around a crossing.

    Where P jumps past the target within one cell, the whole cell counts: nothing is known of the inside.
    """
    low, high, last = crossing.cell, crossing.cell + 1, len(grid) - 1

    def ends(i: int) -> tuple[Ratio, Ratio]:
        return counter(grid[i], None).interval()

    while low > 0 and ends(low)[1] >= target:
        low -= 1
    while high < last and ends(high)[0] <= target:
        high += 1
    below, above = grid[low], grid[high]
    if ends(low + 1)[0] <= target:
        below = _between(grid[low], grid[low + 1], (ends(low)[1], ends(low + 1)[1]), target)
    if ends(high - 1)[1] >= target:
        above = _between(grid[high - 1], grid[high], (ends(high - 1)[0], ends(high)[0]), target)
    return min(below, crossing.value), max(above, crossing.value)
