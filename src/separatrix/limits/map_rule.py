"""When a point of a map is decided, how often that is wrong, and where a map's answer changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import comb

from separatrix.cage import wilson_interval
from separatrix.cage.verdict import CLEAR, FEW
from separatrix.units import Ratio

AGREEING = 6
"""A point is decided once this number of runs agree from the first on; otherwise when it is settled."""

LOOK_AFTER = 2
"""Runs after which a point is looked at again, whose first runs did not agree; more for a very long one."""

MOST_WRONG: Ratio = 1e-3
"""Largest probability that all the runs of such a point would have the other majority."""

SETTLES, WHIRLS, EITHER = -1, 1, 0


def first_look(runs: int) -> int:
    """Runs after which a point is looked at: the fewest that keep to `MOST_WRONG`, and to `AGREEING`."""
    enough = next(n for n in range(1, runs + 1) if wrong_side_probability(runs, n) <= MOST_WRONG)
    return min(max(enough, AGREEING), runs)


def wrong_side_probability(runs: int, agreeing: int) -> Ratio:
    r"""Largest probability that a point which is ended early would lie on the other side with all its runs.

    Runs are exchangeable. If :math:`K` of :math:`R` are of one kind, the first :math:`n` are all of the
    other with probability :math:`\binom{R-K}{n} / \binom{R}{n}`, which is largest for the smallest
    majority, :math:`K = \lfloor R/2 \rfloor + 1`.

    Parameters
    ----------
    runs : int
        R, all the runs of a point.
    agreeing : int
        n, runs that agree before it is ended.
    """
    return _all_of_the_others(runs, runs // 2 + 1, agreeing)


def other_decision_probability(runs: int, agreeing: int) -> Ratio:
    """Largest probability that a point which is ended early would be decided otherwise with all its runs.

    Most of these are points that all the runs would leave undecided.
    """
    if agreeing >= runs:
        return 0.0
    calm = max(_all_of_the_others(runs, k, agreeing) for k in range(runs + 1) if not _is_calm(runs - k, runs))
    wild = max(_all_of_the_others(runs, k, agreeing) for k in range(runs + 1) if not _is_wild(runs - k, runs))
    return max(calm, wild)


def _all_of_the_others(runs: int, kind: int, agreeing: int) -> Ratio:
    """Probability that none of the first `agreeing` of `runs` is one of the `kind`; 0 if all are made."""
    return comb(runs - kind, agreeing) / comb(runs, agreeing) if agreeing < runs else 0.0


def _is_calm(settles: int, runs: int) -> bool:
    return settles / runs >= CLEAR and wilson_interval(settles, runs)[0] > FEW


def _is_wild(whirls: int, runs: int) -> bool:
    return wilson_interval(whirls, runs)[0] > FEW


@dataclass(frozen=True, slots=True, kw_only=True)
class Tally:
    """What the runs of a point did: how many were made, whirl, and settle."""

    runs: int
    whirls: int
    settles: int


def settled(now: Tally, most: int) -> bool:
    """Whether decision and side of a point are the same however the rest of its `most` runs end.

    This is exact: shares only rise with the runs that do so. A point that may still become STABLE is not
    settled, for that asks for more than counts.
    """
    left = most - now.runs
    calmest = Tally(runs=most, whirls=now.whirls, settles=now.settles + left)
    wildest = Tally(runs=most, whirls=now.whirls + left, settles=now.settles)
    if _is_calm(calmest.settles, most):
        return left == 0
    return _answer(now) == _answer(calmest) == _answer(wildest)


def _answer(tally: Tally) -> tuple[int, bool]:
    """Side of one half, and whether the point is unstable."""
    return side(*wilson_interval(tally.whirls, tally.runs)), _is_wild(tally.whirls, tally.runs)


def further(made: int, most: int) -> int:
    """Runs to make before a point is looked at again."""
    return min(max(LOOK_AFTER, made // 8), most - made)


def side(low: Ratio | None, high: Ratio | None) -> int:
    """Return the side of one half on which the interval of P(whirl) lies: SETTLES, WHIRLS, or EITHER."""
    if low is None or high is None:
        return EITHER
    return WHIRLS if low > 0.5 else SETTLES if high < 0.5 else EITHER


def changes(sides: Sequence[int]) -> list[tuple[int, int]]:
    """Places (last of one side, first of the other) between which a row of sides changes."""
    decided = [place for place, at in enumerate(sides) if at != EITHER]
    return [(a, b) for a, b in pairwise(decided) if sides[a] != sides[b]]


def margins(values: Sequence[float], sides: Sequence[int]) -> list[float | None]:
    """Distance of each point to the nearest band in which its row changes sides.

    Positive where the motion settles, negative where it whirls, 0 inside the band; None in a row that does
    not change, and where nothing was decided outside a band.
    """
    bands = [(values[a], values[b]) for a, b in changes(sides)]
    return [_margin(value, at, bands) for value, at in zip(values, sides, strict=True)]


def _margin(value: float, at: int, bands: Sequence[tuple[float, float]]) -> float | None:
    if not bands:
        return None
    distance = min(max(low - value, value - high, 0.0) for low, high in bands)
    if at == EITHER:
        return 0.0 if distance == 0.0 else None
    return -at * distance + 0.0
