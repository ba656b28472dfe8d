"""Counting the drawn bearings that settle: for a verdict, and for the friction that they can have.

A case is counted no longer than its verdict is open. For a friction, P(settles) is
followed with the same counts and the same search as the critical friction of one cage (`limits.response`), at
the share of bearings that may fail.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace

import numpy as np

from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import MovingCage
from separatrix.ground.units import Array, MetrePerSecond, Ratio
from separatrix.study.distribution import LogNormal
from separatrix.study.study import BallModel
from separatrix.verdict.drawn_frictions import DrawnBearings
from separatrix.verdict.draws import Case
from separatrix.verdict.judgement import CLEAR, FEW, Judgement, KickCount, Verdict, is_calm, wilson_interval
from separatrix.verdict.long_jobs import Runner, joined
from separatrix.verdict.response import (
    SEARCHED_FRICTION,
    Count,
    Crossing,
    Response,
    Side,
    ends_of,
)
from separatrix.verdict.uncertain_records import AllowedFriction

BLOCK = 64  # bearings after which a case is judged
RISK: Ratio = 1e-3
"""Probability, at each judgement, that a case is ended whose true share lies on the other side of a limit."""

NORMAL = 3.2905  # normal quantile of that probability, on both sides together


def counted(bearings: DrawnBearings, case: Case, runner: Runner) -> tuple[Judgement, Ensemble]:
    """Verdict on a case by the ball that decides, and the runs behind it: see `counted_among`."""
    ran: list[Ensemble] = []

    def judged(ball: BallModel | None) -> Judgement:
        found, runs = counted_among(bearings, case, runner, ball)
        ran.append(runs)
        return found

    return bearings.by_ball(case, judged), ran[-1]


def counted_among(
    bearings: DrawnBearings, case: Case, runner: Runner, ball: BallModel | None
) -> tuple[Judgement, Ensemble]:
    """Run the bearings of a case in blocks, until all have run or the verdict is decided.

    A kick from which significantly more bearings settle than from the worst is not run further; its count
    stays in the judgement, whose other evidence is that of the kicks that are left.
    """
    parts: list[Ensemble] = []
    left_out: list[KickCount] = []
    total, kicks = len(bearings.runs), list(bearings.kicks)
    for first in range(0, total, BLOCK):
        places = range(first, min(first + BLOCK, total))
        parts.append(bearings.ensemble(case, kicks, places, runner, ball=ball))
        found = joined(parts)
        judged = bearings.judged(case, found, ball)
        if is_plain(judged):
            break
        better = [one for one in judged.by_kick if settles_more(one, judged)]
        if better:
            left_out += better
            kept = [i for i, one in enumerate(judged.by_kick) if one not in better]
            kicks = [kicks[i] for i in kept]
            by_kick = {f.name for f in fields(found) if np.ndim(getattr(found, f.name)) > 0}
            found = replace(found, **{name: getattr(found, name)[kept] for name in by_kick})
            judged, parts = bearings.judged(case, found, ball), [found]
    counts = sorted((*left_out, *judged.by_kick), key=lambda one: one.kick)
    return replace(judged, by_kick=tuple(counts)), found


def settles_more(count: KickCount, judged: Judgement) -> bool:
    """Whether significantly more settle or roll from a kick than from the worst; most, in their pockets."""
    worst = next(one for one in judged.by_kick if one.kick == judged.worst_kick)
    low = wilson_interval(count.calm, count.runs, NORMAL)[0]
    return 2 * count.kept_by_land <= count.runs and low > max(
        FEW, wilson_interval(worst.calm, worst.runs, NORMAL)[1]
    )


def is_plain(judged: Judgement) -> bool:
    """Whether the shares behind a verdict lie beyond its limits by more than `RISK` leaves open."""
    worst = next(count for count in judged.by_kick if count.kick == judged.worst_kick)
    if judged.verdict is Verdict.STABLE:
        return all(wilson_interval(one.calm, one.runs, NORMAL)[0] >= CLEAR for one in judged.by_kick)
    return judged.verdict is Verdict.UNSTABLE and wilson_interval(worst.whirls, worst.runs, NORMAL)[0] > FEW


def settles(found: Ensemble, judged: Judgement) -> Array:
    """1 for each bearing that settles or rolls from the worst kick, else 0; shape (bearing,)."""
    at = found.kicks.tolist().index(judged.worst_kick)
    return is_calm(found.outcome[at]).astype(np.float64)


PROBABILITY: Ratio = 0.95  # wanted share of bearings that settle
RUNS = 96  # bearings counted near the answer
# cage of a bearing at a value that is searched, by its place
Changed = Callable[[Ratio, int, MovingCage], MovingCage]


def allowed_friction(
    bearings: DrawnBearings, names: Sequence[str], scatter: Ratio, runner: Runner
) -> AllowedFriction:
    """Largest mean friction of a new material with this scatter, in the pockets of some candidates."""
    own = next(case for case in bearings.friction if case.candidate == names[0])
    law = LogNormal(mean=1.0, standard_deviation=scatter) if scatter > 0.0 else None
    total = len(bearings.runs)
    random = np.random.default_rng((bearings.study.stability.seed, total))
    places = (random.permutation(total) + 0.5) / total
    shares = np.ones(total) if law is None else law.quantile(places)

    def at(friction: Ratio, place: int, cage: MovingCage) -> MovingCage:
        return replace(cage, ball_cage_friction=friction * float(shares[place]))

    found = _worst_crossing(bearings, own, at, 0.1, runner)
    value, low, high = ends_of(found)
    reasons = {
        Side.ABOVE: "fewer settle even without pocket friction",
        Side.BELOW: f"more settle at every friction up to {SEARCHED_FRICTION:g}",
    }
    return AllowedFriction(
        names=tuple(names),
        probability=PROBABILITY,
        scatter=scatter,
        friction=value,
        friction_low=low,
        friction_high=high,
        reason=reasons[found] if isinstance(found, Side) else "",
    )


def _worst_crossing(
    bearings: DrawnBearings, case: Case, at: Changed, guess: Ratio, runner: Runner
) -> Crossing | Side:
    """Least value over the kicks at which the share of bearings that do not settle passes what may fail.

    ABOVE where more fail from one kick throughout.
    """
    total, found = len(bearings.runs), []
    for kick in bearings.kicks:

        def look(value: Ratio, first: int, runs: int, kick: MetrePerSecond = kick) -> Count:
            places = [place % total for place in range(first, first + runs)]
            ran = bearings.ensemble(case, (kick,), places, runner, lambda place, cage: at(value, place, cage))
            return Count(int(np.count_nonzero(~is_calm(ran.outcome))), runs)

        found.append(Response(look, RUNS).crossing(1.0 - PROBABILITY, RUNS, guess))
    if Side.ABOVE in found:
        return Side.ABOVE
    crossings = [one for one in found if isinstance(one, Crossing)]
    return min(crossings, key=lambda one: one.value) if crossings else Side.BELOW
