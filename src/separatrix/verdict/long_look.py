"""A long look at a calm cage: whether friction on its land takes it over after its motion has settled."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage.ensemble import Runs
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.solution import Solution
from separatrix.ground.units import Newton, Ratio, Second
from separatrix.study.study import BallModel, StabilitySettings
from separatrix.verdict import reasons
from separatrix.verdict.judgement import (
    Judgement,
    KickCount,
    Verdict,
    is_clear,
    is_taken_by_land,
    kick_counts,
    worst,
)
from separatrix.verdict.long_jobs import Runner

LONGER, LONGEST = 10.0, 3.0
"""Time for which it is followed, all of it: so many times [stability] duration, but no more than this [s],
unless `duration` itself is longer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LongLook:
    """Runs of a cage from a disturbance, followed for long."""

    friction: Ratio  # in its pockets
    duration: Second  # for which they were followed, all of it
    count: KickCount  # where they end
    largest_land_force: Newton  # of those that whirl round the land; 0 without one
    reason: str  # the same in a sentence

    @property
    def is_clear(self) -> bool:
        """Whether the land takes over no more of them than a stable cage may have."""
        return is_clear(self.count.runs - self.count.whirls_by_land, self.count.runs)


def long_look(
    solution: Solution,
    friction: Ratio,
    settings: StabilitySettings,
    runner: Runner,
    runs: int,
    ball: BallModel | None = None,
) -> LongLook | None:
    """Follow runs from a disturbance, whose end is that of their last fifth; None without a land.

    It is that of the settings nearest to their reference. What drives a cage round its land is friction
    there, while its pockets take energy: so the candidate of least friction shows whether the others need a
    look of their own.
    """
    cage = moving_cage(solution, friction, ball)
    if np.isinf(cage.land_gap) or cage.land_friction == 0.0:
        return None
    time = max(settings.duration, min(LONGER * settings.duration, LONGEST))
    for_long = replace(settings, duration=time)
    kick = min(settings.kicks, key=lambda one: abs(math.log(one / settings.middle_kick)))
    found = runner.ensemble_of([Runs(cage, for_long, 0, runs, whole=True)], (kick,))
    return LongLook(
        friction=friction,
        duration=float(found.followed.max()),
        count=kick_counts(found)[0],
        largest_land_force=float(found.largest_land_force[reasons.driven_by_land(found)].max(initial=0.0)),
        reason=reasons.taken_by_land(cage, found),
    )


def seen_for_longer(judgement: Judgement, first: LongLook | None, own: LongLook | None) -> Judgement:
    """The judgement of a stable cage after a long look: `own`, where the `first`, at another, asks for it.

    Its runs then stand for those from their disturbance. UNSTABLE if its land surely takes over more than a
    tenth of them, UNDECIDED if it does so by their count alone, or while there is none of its own. The
    medians of the evidence stay those of the shorter runs.
    """
    if first is None or first.is_clear or judgement.verdict is not Verdict.STABLE:
        return judgement
    if own is None:
        return replace(judgement, verdict=Verdict.UNDECIDED, reason=first.reason)
    counts = tuple(own.count if one.kick == own.count.kick else one for one in judgement.by_kick)
    at = own.count if is_taken_by_land(own.count) else counts[worst(counts)]
    is_stable = is_clear(at.calm, at.runs)
    verdict = Verdict.STABLE if is_stable else Verdict.UNDECIDED
    return replace(
        judgement,
        verdict=Verdict.UNSTABLE if is_taken_by_land(own.count) else verdict,
        reason=f"{judgement.reason} {own.reason}" if is_stable else own.reason,
        largest_land_force=max(judgement.largest_land_force, own.largest_land_force),
        longest_run=own.duration,
        by_kick=counts,
        worst_kick=at.kick,
        driven_by_land=at.is_by_land,
        probability_stable=at.probability_stable,
        probability_low=at.probability_low,
        probability_high=at.probability_high,
    )
