"""Which ball a verdict rests on: the one of the study, or one state until free balls have to be asked.

The critical friction with one state is 0.74 to 1.00 of that among free balls (ten bearings, the worse of two
speeds): its STABLE is safe, its UNSTABLE may be too early. They agree while the friction of a sustained whirl
stays below a quarter of what the races hold.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from separatrix.cage.closed_forms import felt_mass
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.pocket_friction import REFERENCE
from separatrix.study.study import BallModel
from separatrix.verdict.judgement import Judgement, Verdict, judge

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.chain.solution import Solution
    from separatrix.ground.units import Newton, Ratio

ENOUGH: Ratio = 0.25
"""Friction of a sustained whirl over what the races hold, up to which the ball of one state decides alone."""


def transmitted_force(solution: Solution) -> Newton:
    """Largest force that the races can transmit to the most loaded ball, f_BT (Q_i + Q_o) [N]."""
    contacts = solution.bearing
    return solution.study.film.race_friction * (contacts.inner.ellipse.load + contacts.outer.ellipse.load)


def whirl_share(cage: MovingCage, capacity: Newton) -> Ratio:
    r"""Friction of a sustained whirl over what the races hold [-].

    :math:`f N / f_{BT}(Q_i + Q_o)` with the force :math:`N = 2.5\,\Omega c_p \sqrt{k m}` of an impact, whose
    mass m is that which it feels.
    """
    speed = REFERENCE * abs(cage.cage_speed) * cage.half_play
    return cage.ball_cage_friction * speed * math.sqrt(cage.ball_cage_stiffness * felt_mass(cage)) / capacity


def asks_free_balls(level: BallModel, first: Judgement, share: Ratio) -> bool:
    """Whether free balls decide, after a verdict with one state."""
    return level is BallModel.AUTO and first.verdict is not Verdict.STABLE and share > ENOUGH


def with_reason(
    level: BallModel, found: Judgement, share: Ratio, first: Judgement | None = None
) -> Judgement:
    """Return the verdict with the reason why its ball decided; `first`: with one state, if free balls did."""
    if level is not BallModel.AUTO:
        return found
    part = f"{100.0 * share:.2g} % of what the races hold"
    if first is not None:
        because = f"friction of a whirl reaches {part}; with one state the verdict is {first.verdict.name}"
    elif share > ENOUGH:
        because = "a cage that is stable with one state is stable among free balls"
    else:
        because = f"friction of a whirl reaches {part}: below {100.0 * ENOUGH:g} % one state is enough"
    return replace(found, ball_reason=f"{because[0].upper()}{because[1:]}.")


def judge_solution(solution: Solution, friction: Ratio, run: Callable[[MovingCage], Ensemble]) -> Judgement:
    """Judge the cage of a solved study at a friction by the ball that decides.

    Parameters
    ----------
    solution : Solution
        Of the chain.
    friction : float
        Ball on cage [-].
    run : callable
        Runs the ensemble of a cage, always with the same settings.
    """
    level, capacity = solution.design.ball_model, transmitted_force(solution)
    cage = moving_cage(solution, friction)
    found, share = judge(cage, run(cage), capacity=capacity), whirl_share(cage, capacity)
    if not asks_free_balls(level, found, share):
        return with_reason(level, found, share)
    free = moving_cage(solution, friction, BallModel.FREE)
    return with_reason(level, judge(free, run(free), capacity=capacity), share, found)
