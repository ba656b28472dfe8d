"""Counting the bearings of a case that settle, no longer than its verdict is open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from separatrix.cage import Ensemble, Judgement, KickCount, RunOutcome, Verdict, judge, wilson_interval
from separatrix.cage.verdict import CLEAR, FEW
from separatrix.draws import Case
from separatrix.ranking.drawn import DrawnBearings
from separatrix.runner import Runner, joined
from separatrix.units import MetrePerSecond, Ratio

BLOCK = 64
"""Bearings after which a case is looked at."""

RISK: Ratio = 1e-3
"""Probability, at each look, that a case is ended whose true share lies on the other side of a limit."""

NORMAL = 3.2905
"""Normal quantile of that probability, on both sides together."""


def counted(
    bearings: DrawnBearings, case: Case, kicks: Sequence[MetrePerSecond], runner: Runner
) -> tuple[Judgement, Ensemble]:
    """Run the bearings of a case in blocks, until all have run or the verdict is plain.

    A kick from which plainly more bearings settle than from the worst is not run further; its count stays in
    the judgement, whose other evidence is that of the kicks that are left.

    Raises
    ------
    Interrupted
        The work was interrupted.
    """
    parts: list[Ensemble] = []
    left_out: list[KickCount] = []
    total, kicks = len(bearings.runs), list(kicks)
    for first in range(0, total, BLOCK):
        parts.append(bearings.ensemble(case, kicks, range(first, min(first + BLOCK, total)), runner))
        found = joined(parts)
        judged = judge(bearings.cage(case), found)
        if is_plain(judged):
            break
        better = [one for one in judged.by_kick if settles_more(one, judged)]
        if better:
            left_out += better
            kept = [i for i, one in enumerate(judged.by_kick) if one not in better]
            kicks = [kicks[i] for i in kept]
            found = of_kicks(found, kept)
            judged, parts = judge(bearings.cage(case), found), [found]
    counts = sorted((*left_out, *judged.by_kick), key=lambda one: one.kick)
    return replace(judged, by_kick=tuple(counts)), found


def settles_more(count: KickCount, judged: Judgement) -> bool:
    """Whether plainly more bearings settle from a kick than from the worst, most do, and in their pockets."""
    worst = next(one for one in judged.by_kick if one.kick == judged.worst_kick)
    low = wilson_interval(count.settles, count.runs, NORMAL)[0]
    return 2 * count.kept_by_land <= count.runs and low > max(
        FEW, wilson_interval(worst.settles, worst.runs, NORMAL)[1]
    )


def of_kicks(found: Ensemble, places: Sequence[int]) -> Ensemble:
    """Return the runs from some of the kicks."""
    rows = list(places)
    arrays = {name: value[rows] for name in FIELDS if np.ndim(value := getattr(found, name)) > 0}
    return replace(found, **arrays)


FIELDS = tuple(one.name for one in fields(Ensemble))


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
