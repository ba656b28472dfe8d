"""A long look at a calm cage: whether friction on its land takes it over after its motion has settled."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage.closed_forms import drive_energy
from separatrix.cage.ensemble import Runs
from separatrix.cage.moving_cage import moving_cage
from separatrix.cage.outcome import Cause
from separatrix.cage.rows import LANES
from separatrix.chain.solution import Solution
from separatrix.ground.units import MetrePerSecond, Newton, Ratio, Second
from separatrix.study.study import StabilitySettings
from separatrix.verdict import reasons
from separatrix.verdict.judgement import Judgement, Verdict, is_clear
from separatrix.verdict.long_jobs import Runner

LONGER, LONGEST = 10.0, 3.0
"""Time for which it is followed, all of it: so many times [stability] duration, but no more than this [s],
unless `duration` itself is longer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LongLook:
    """Runs of the cage of least friction, which its pockets leave calm if they do any, followed for long."""

    friction: Ratio  # in its pockets
    kick: MetrePerSecond  # that they begin with
    runs: int  # followed
    duration: Second  # for which they were followed, all of it
    on_land: int  # of them end whirling round the land, with more energy than frame and loads can give
    largest_land_force: Newton  # of those; 0 without one
    reason: str  # the same in a sentence


def long_look(
    solution: Solution, friction: Ratio, settings: StabilitySettings, runner: Runner
) -> LongLook | None:
    """Follow runs from the reference disturbance, whose end is that of their last fifth; None without a land.

    What drives a cage round its land is friction there, while its pockets take energy: so one friction in
    the pockets does for all candidates on that land.
    """
    cage, kick = moving_cage(solution, friction), settings.middle_kick
    if np.isinf(cage.land_gap) or cage.land_friction == 0.0:
        return None
    time = max(settings.duration, min(LONGER * settings.duration, LONGEST))
    for_long = replace(settings, duration=time)
    found = runner.ensemble_of([Runs(cage, for_long, 0, LANES, whole=True)], (kick,))
    taken = (found.cause == Cause.LAND_FRICTION) & (found.end_energy > drive_energy(cage))
    return LongLook(
        friction=friction,
        kick=kick,
        runs=LANES,
        duration=float(found.followed.max()),
        on_land=int(np.count_nonzero(taken)),
        largest_land_force=float(found.largest_land_force[taken].max(initial=0.0)),
        reason=reasons.taken_by_land(cage, found, taken),
    )


def seen_for_longer(judgement: Judgement, look: LongLook | None) -> Judgement:
    """The judgement; UNDECIDED of a stable cage whose land takes over more than a tenth of long runs."""
    is_calm = look is None or is_clear(look.runs - look.on_land, look.runs)
    if look is None or is_calm or judgement.verdict is not Verdict.STABLE:
        return judgement
    return replace(judgement, verdict=Verdict.UNDECIDED, reason=look.reason)
