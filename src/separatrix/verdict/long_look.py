"""A long look at a calm cage: whether friction on its land takes it over after its motion has settled."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from separatrix.cage.ensemble import Runs
from separatrix.cage.moving_cage import MovingCage, moving_cage
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

LARGEST = (
    *("largest_offset", "largest_contact_force", "largest_land_force", "largest_tilt", "axial_travel"),
    *("force_exceeds_races", "left_pocket", "energy_imbalance", "longest_run"),
)
"""Evidence of any run, and so of the long ones, too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LongLook:
    """Runs of a cage from a disturbance, followed for long."""

    friction: Ratio  # in its pockets
    duration: Second  # for which they were followed, all of it
    count: KickCount  # where they end
    largest_land_force: Newton  # any run
    takes_over: bool  # whether the land takes over more runs than a stable cage may have
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
    look of their own. The reason says how many runs end whirling round the land.
    """
    cage = moving_cage(solution, friction, ball)
    if not has_land_friction(cage):
        return None
    time = max(settings.duration, min(LONGER * settings.duration, LONGEST))
    for_long = replace(settings, duration=time)
    kick = min(settings.kicks, key=lambda one: abs(math.log(one / settings.middle_kick)))
    found = runner.ensemble_of([Runs(cage, for_long, 0, runs, whole=True)], (kick,))
    judged = judge(cage, found, capacity=transmitted_force(solution))
    return replace(judged, reason=reasons.taken_by_land(cage, found))


def has_land_friction(cage: MovingCage) -> bool:
    """Whether there is a land whose friction could drive the cage."""
    return cage.land_gap < math.inf and cage.land_friction > 0.0


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
        takes_over=not is_left_alone(look),
        reason=look.reason,
    )


def seen_for_longer(judgement: Judgement, first: Judgement | None, own: Judgement | None) -> Judgement:
    """The judgement of a stable cage after a long look: `own`, where the `first`, at another, asks for it.

    Its runs then stand for those from their disturbance. UNSTABLE, with the evidence of these runs, if its
    land surely takes over more than a tenth of them; UNDECIDED if it does so by their count alone, or while
    there is none of its own. The medians of these and of a STABLE one stay those of the shorter runs.
    """
    if first is None or is_left_alone(first) or judgement.verdict is not Verdict.STABLE:
        return judgement
    if own is None:
        return replace(judgement, verdict=Verdict.UNDECIDED, reason=first.reason, driven_by_land=True)
    counts = tuple(own.worst if one.kick == own.worst_kick else one for one in judgement.by_kick)
    is_taken = is_taken_by_land(own.worst)
    at = own.worst if is_taken else counts[worst(counts)]
    is_stable = is_clear(at.calm, at.runs)
    verdict = Verdict.STABLE if is_stable else Verdict.UNDECIDED
    of_any_run = {name: (getattr(judgement, name), getattr(own, name)) for name in LARGEST}
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
        **{name: max(each) for name, each in of_any_run.items() if None not in each},
    )
