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
    judge,
    transmitted_force,
    worst,
)
from separatrix.verdict.long_jobs import Runner

LONGER, LONGEST = 10.0, 3.0
"""Time for which it is followed, all of it: so many times [stability] duration, but no more than this [s],
unless `duration` itself is longer."""

LARGEST = ("largest_offset", "largest_contact_force", "largest_land_force", "longest_run")
"""Evidence of any run, and so of the long ones, too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LongLook:
    """Runs of a cage from a disturbance, followed for long."""

    friction: Ratio  # in its pockets
    duration: Second  # for which they were followed, all of it
    count: KickCount  # where they end
    largest_land_force: Newton  # any run
    reason: str  # the same in a sentence


def long_look(
    solution: Solution,
    friction: Ratio,
    settings: StabilitySettings,
    runner: Runner,
    runs: int,
    ball: BallModel | None = None,
) -> Judgement | None:
    """Follow runs from a disturbance, whose end is that of their last fifth; None without a land.

    It is that of the settings nearest to their reference. What drives a cage round its land is friction
    there, while its pockets take energy: so the candidate of least friction shows whether the others need a
    look of their own. The reason says how many the land takes over.
    """
    cage = moving_cage(solution, friction, ball)
    if np.isinf(cage.land_gap) or cage.land_friction == 0.0:
        return None
    time = max(settings.duration, min(LONGER * settings.duration, LONGEST))
    for_long = replace(settings, duration=time)
    kick = min(settings.kicks, key=lambda one: abs(math.log(one / settings.middle_kick)))
    found = runner.ensemble_of([Runs(cage, for_long, 0, runs, whole=True)], (kick,))
    judged = judge(cage, found, capacity=transmitted_force(solution))
    return replace(judged, reason=reasons.taken_by_land(cage, found))


def is_left_alone(look: Judgement) -> bool:
    """Whether the land takes over no more runs of a long look than a stable cage may have."""
    return is_clear(look.worst.runs - look.worst.whirls_by_land, look.worst.runs)


def look_record(look: Judgement, friction: Ratio) -> LongLook:
    """What is kept of a long look at a cage of this friction."""
    return LongLook(
        friction=friction,
        duration=look.longest_run,
        count=look.worst,
        largest_land_force=look.largest_land_force,
        reason=look.reason,
    )


def seen_for_longer(judgement: Judgement, first: Judgement | None, own: Judgement | None) -> Judgement:
    """The judgement of a stable cage after a long look: `own`, where the `first`, at another, asks for it.

    Its runs then stand for those from their disturbance. UNSTABLE, with the evidence of these runs, if its
    land surely takes over more than a tenth of them; UNDECIDED if it does so by their count alone, or while
    there is none of its own.
    """
    if first is None or is_left_alone(first) or judgement.verdict is not Verdict.STABLE:
        return judgement
    if own is None:
        return replace(judgement, verdict=Verdict.UNDECIDED, reason=first.reason)
    counts = tuple(own.worst if one.kick == own.worst_kick else one for one in judgement.by_kick)
    is_taken = is_taken_by_land(own.worst)
    at = own.worst if is_taken else counts[worst(counts)]
    is_stable = is_clear(at.calm, at.runs)
    verdict = Verdict.STABLE if is_stable else Verdict.UNDECIDED
    return replace(
        own if is_taken else judgement,
        verdict=Verdict.UNSTABLE if is_taken else verdict,
        reason=f"{judgement.reason} {own.reason}" if is_stable else own.reason,
        ball=judgement.ball,
        ball_reason=judgement.ball_reason,
        duration=judgement.duration,
        by_kick=counts,
        worst_kick=at.kick,
        driven_by_land=at.is_by_land,
        probability_stable=at.probability_stable,
        probability_low=at.probability_low,
        probability_high=at.probability_high,
        **{name: max(getattr(judgement, name), getattr(own, name)) for name in LARGEST},
    )
