"""Ranks with ties: within the scatter nobody is first."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from separatrix.ranking.lowest import may_be_lower
from separatrix.units import Ratio

if TYPE_CHECKING:
    from separatrix.ranking.lowest import MeanFriction
    from separatrix.ranking.records import Ranked

Interval = tuple[Ratio, Ratio, Ratio]
"""A margin with the low and the high end of its scatter."""


def ranks(margins: Sequence[Interval], tied: Callable[[int, int], bool] | None = None) -> list[int]:
    """Rank of each margin, the largest first.

    The best one leads the first group. Whoever cannot be told from the leader is tied with it; the best of
    the others leads the next group, and so on. Tied ones share the lowest rank (1, 1, 3). Groups are told by
    their leader, so being tied is transitive: a chain of small steps does not tie the first with the last.

    Parameters
    ----------
    margins : sequence
        (value, low, high) of each candidate [-].
    tied : callable, optional
        Whether the first of two cannot be told from the second, its leader; by default if their intervals
        meet.
    """
    alike = tied or (lambda i, leader: meet(margins[i], margins[leader]))
    order = sorted(range(len(margins)), key=lambda i: (-margins[i][0], -margins[i][2]))
    found = [0] * len(margins)
    leader, rank = None, 0
    for place, i in enumerate(order, start=1):
        if leader is None or not alike(i, leader):
            leader, rank = i, place
        found[i] = rank
    return found


def meet(other: Interval, leader: Interval) -> bool:
    """Whether the interval of the smaller margin reaches that of its leader."""
    return other[2] >= leader[1]


POCKET = ("ball_cage_stiffness", "pocket_clearance", "land_clearance")
"""What candidates with one curve have alike."""


def same_rank(row: Ranked, leader: Ranked, known: Mapping[str, MeanFriction]) -> bool:
    """Whether a row and the leader of its group do not differ beyond their scatter.

    On one curve the order of thresholds is the order of frictions whatever the curve, so frictions decide;
    with another pocket there are another curve and eta, and the intervals of the margins decide.
    """
    if row.margin == leader.margin:
        return True
    if all(getattr(row, name) == getattr(leader, name) for name in POCKET):
        return may_be_lower(known[row.name], known[leader.name])
    return meet(margin_interval(row), margin_interval(leader))


def margin_interval(row: Ranked) -> Interval:
    """Margin with the ends of its interval, those of the threshold less the restitution factor."""
    eta = row.restitution_factor
    return row.margin, row.restitution_threshold_low - eta, row.restitution_threshold_high - eta
