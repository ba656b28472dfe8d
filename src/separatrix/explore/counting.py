"""Counting the bearings of a case that settle, no longer than its verdict is open."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event

from separatrix.cage import Ensemble, Judgement, RunOutcome, Verdict, judge, wilson_interval
from separatrix.cage.verdict import CLEAR, FEW
from separatrix.ranking.drawn import Case, DrawnBearings
from separatrix.stability.whole import joined
from separatrix.units import MetrePerSecond, Ratio

BLOCK = 64
"""Bearings after which a case is looked at."""

RISK: Ratio = 1e-3
"""Probability, at each look, that a case is ended whose true share lies on the other side of a limit."""

NORMAL = 3.2905
"""Normal quantile of that probability, on both sides together."""


def counted(
    bearings: DrawnBearings, case: Case, kicks: Sequence[MetrePerSecond], stop: Event
) -> tuple[Judgement, Ensemble]:
    """Run the bearings of a case in blocks, until all have run or the verdict is plain.

    Raises
    ------
    Stopped
        `stop` was set before the end.
    """
    parts: list[Ensemble] = []
    total = len(bearings.runs)
    for first in range(0, total, BLOCK):
        parts.append(bearings.ensemble(case, kicks, range(first, min(first + BLOCK, total)), stop))
        found = joined(parts)
        judged = judge(bearings.cage(case), found)
        if is_plain(judged):
            break
    return judged, found


def is_plain(judged: Judgement) -> bool:
    """Whether the shares behind a verdict lie beyond its limits by more than `RISK` leaves open."""
    worst = next(count for count in judged.by_kick if count.kick == judged.worst_kick)
    if judged.verdict is Verdict.STABLE:
        return all(wilson_interval(one.settles, one.runs, NORMAL)[0] >= CLEAR for one in judged.by_kick)
    return judged.verdict is Verdict.UNSTABLE and wilson_interval(worst.whirls, worst.runs, NORMAL)[0] > FEW


def settles(found: Ensemble, judged: Judgement) -> list[bool]:
    """Whether each bearing settles from the worst kick."""
    at = found.kicks.tolist().index(judged.worst_kick)
    return [bool(one == RunOutcome.SETTLES) for one in found.outcome[at]]
