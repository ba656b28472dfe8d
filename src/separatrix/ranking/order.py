"""Ranks with ties: within the scatter nobody is first."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from separatrix.ranking.lowest import may_be_lower
from separatrix.units import Ratio

if TYPE_CHECKING:
    from separatrix.ranking.friction import MeanFriction
    from separatrix.ranking.records import RankedMaterial

Interval = tuple[Ratio, Ratio, Ratio]
"""A margin with the low and the high end of its scatter."""


def ranks(
    margins: Sequence[Interval | None], tied: Callable[[int, int], bool] | None = None
) -> list[int | None]:
    """Rank of each margin, the largest first; None stays None.

    The best one leads the first group. Whoever cannot be told from the leader is tied with it; the best of
    the others leads the next group, and so on. Tied ones share the lowest rank (1, 1, 3). Groups are told by
    their leader, so being tied is transitive: a chain of small steps does not tie the first with the last.

    Parameters
    ----------
    margins : sequence
        (value, low, high) of each candidate, or None [-].
    tied : callable, optional
        Whether the first of two cannot be told from the second, its leader; by default if their intervals
        meet.
    """
    alike = tied or (lambda i, leader: meet(margins[i], margins[leader]))
    order = sorted((i for i, t in enumerate(margins) if t is not None), key=lambda i: _best_first(margins, i))
    found: list[int | None] = [None] * len(margins)
    leader, rank = None, 0
    for place, i in enumerate(order, start=1):
        if leader is None or not alike(i, leader):
            leader, rank = i, place
        found[i] = rank
    return found


def _best_first(margins: Sequence[Interval | None], i: int) -> tuple[float, float]:
    found = margins[i]
    return (0.0, 0.0) if found is None else (-found[0], -found[2])


def meet(other: Interval | None, leader: Interval | None) -> bool:
    """Whether the interval of the smaller margin reaches that of its leader."""
    return other is not None and leader is not None and other[2] >= leader[1]


def same_rank(row: RankedMaterial, leader: RankedMaterial, known: Mapping[str, MeanFriction]) -> bool:
    """Whether a row and the leader of its group do not differ beyond their scatter.

    On one curve the order of thresholds is the order of frictions whatever the curve, so frictions tell;
    with another pocket stiffness there are another curve and eta, and the intervals of the margins tell.
    """
    if row.margin == leader.margin:
        return True
    if row.ball_cage_stiffness == leader.ball_cage_stiffness:
        return may_be_lower(known[row.name], known[leader.name])
    return meet(margin_interval(row), margin_interval(leader))


def margin_interval(row: RankedMaterial) -> Interval | None:
    """Margin with the ends of its interval, those of the threshold less the restitution factor."""
    low, high, eta = row.restitution_threshold_low, row.restitution_threshold_high, row.restitution_factor
    if row.margin is None or low is None or high is None or eta is None:
        return None
    return row.margin, low - eta, high - eta
