"""Critical friction of a cage from its worst disturbance, and the safety factor of a material against it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from separatrix.cage.closed_forms import moving_mass
from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.chain.solution import Solution
from separatrix.ground.units import MetrePerSecond, Ratio
from separatrix.study.study import BallModel, StabilitySettings
from separatrix.verdict.crossing import (
    SEARCHED_FRICTION,
    Side,
    ends_of,
    notes_of,
    outermost,
    powers_between,
    responses,
)
from separatrix.verdict.judgement import ENOUGH, NORMAL_95, transmitted_force, whirl_share
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.reasons import ball_words

HAND: Ratio = 0.42
"""Critical friction over sqrt(2 k M/Z)/C, within 0.1 for turbopumps (15 bearings, docs/theory/ranking.md)."""

AMPLE: Ratio = 1.5
"""Safety factor by balls of one state from which free balls are not asked."""

POWERS = (
    "own_critical_friction",
    "own_critical_friction_low",
    "own_critical_friction_high",
    "estimated_critical_friction",
)
"""What a power of stiffness gives between two."""

TINY: Ratio = 1e-12
"""Least friction whose logarithm is taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CageLimit:
    """Critical friction of a cage at its own race damping, among the balls of its model.

    Where no searched friction makes half the runs whirl, the value is None and `low` is the highest that was
    searched; it is 0 where they whirl without friction.
    """

    own_critical_friction: Ratio | None
    """At which half the runs whirl, from the disturbance from which that is lowest."""
    own_critical_friction_low: Ratio  # of its 95 % interval, from the number of runs
    own_critical_friction_high: Ratio | None  # upper end of it
    critical_kick: MetrePerSecond  # disturbance from which the critical friction is lowest
    critical_ball: str  # that decided the critical friction
    estimated_critical_friction: Ratio  # by the closed law, to check the order
    steepness: float | None = None  # slope of the logit of P(whirl) in ln f there
    notes: tuple[str, ...] = ()  # on runs that do not show where they end

    @property
    def own(self) -> dict[str, Any]:
        """Critical friction with the ends of its interval, by their names."""
        return {name: getattr(self, name) for name in POWERS[:3]}

    def between(self, stiff: CageLimit, share: Ratio) -> CageLimit | None:
        """That of a pocket a share of the way to the stiffer one of `stiff`; None if one has no value."""
        values = powers_between(self, stiff, share, POWERS)
        if not all(values.values()):
            return None
        balls = dict.fromkeys((self.critical_ball, stiff.critical_ball))
        nearer = stiff if share > 0.5 else self
        return replace(nearer, critical_ball=" and ".join(balls), notes=(), **values)


@dataclass(frozen=True, slots=True, kw_only=True)
class SafetyFactor:
    """Critical friction over the friction in the pocket, with its 95 % interval."""

    safety_factor: Ratio | None = None  # critical friction over friction; null beyond what was searched
    safety_factor_low: Ratio | None = None  # of its 95 % interval
    safety_factor_high: Ratio | None = None  # upper end of it


def cage_limit(
    solution: Solution,
    settings: StabilitySettings,
    runner: Runner,
    *,
    highest: Ratio = inf,
    change: Mapping[str, Any] | None = None,
) -> CageLimit:
    """Critical friction of a solved study's cage, by the ball that its model asks for.

    With the ball "auto", by balls of one state, which may be up to a quarter too low but not too high; by
    free balls where the friction of a whirl there exceeds a quarter of what the races hold, unless the
    critical friction is `AMPLE` times the `highest` friction that it will be compared with.
    `change` has other values of fields of the cage.
    """

    def cage(friction: Ratio, ball: BallModel | None = None) -> MovingCage:
        return replace(moving_cage(solution, friction, ball), **(change or {}))

    found = _limit(cage(0.0), settings, runner)
    if solution.design.ball_model is not BallModel.AUTO:
        return found
    at = found.own_critical_friction
    if at is None or at >= AMPLE * highest or whirl_share(cage(at), transmitted_force(solution)) <= ENOUGH:
        return found
    return _limit(cage(0.0, BallModel.FREE), settings, runner, at)


def _limit(
    cage: MovingCage, settings: StabilitySettings, runner: Runner, guess: Ratio | None = None
) -> CageLimit:
    estimate, settings = hand_estimate(cage), settings_for(settings, cage)
    counts = responses(cage, settings, settings.kicks, runner)
    found, kick = outermost(counts, 0.5, settings.runs, estimate if guess is None else guess)
    value, low, high = ends_of(found)
    if isinstance(found, Side):
        value, low, high = (0.0, 0.0, 0.0) if found is Side.ABOVE else (None, SEARCHED_FRICTION, None)
    return CageLimit(
        steepness=counts[kick].steepness(value, 0.5) if value else None,
        own_critical_friction=value,
        own_critical_friction_low=low or 0.0,
        own_critical_friction_high=high,
        critical_kick=kick,
        critical_ball=ball_words(cage),
        estimated_critical_friction=estimate,
        notes=notes_of(counts),
    )


def hand_estimate(cage: MovingCage) -> Ratio:
    """Critical friction by the closed law, 0.42 sqrt(2 k M/Z)/C with C of a slow push [-]."""
    stiff = 2.0 * cage.ball_cage_stiffness * moving_mass(cage) / cage.ball_count
    return HAND * math.sqrt(stiff) / cage.slow_damping


def spread(drawn: Sequence[Solution]) -> float:
    """Half the 95 % interval of what uncertain inputs do to the logarithm of the critical friction [-].

    By the closed law, which follows mass, stiffness and damping of the drawn cages.
    """
    logs = [math.log(hand_estimate(moving_cage(one, 0.0))) for one in drawn]
    return NORMAL_95 * float(np.std(logs, ddof=1)) if len(logs) > 1 else 0.0


def safety_factor(
    limit: CageLimit, friction: Ratio, interval: tuple[Ratio, Ratio], spread: float = 0.0
) -> SafetyFactor:
    """Safety factor of a friction in the pocket; without friction the factor has no value.

    Deviations of the logarithms add as squares. `spread` is half the 95 % interval of what uncertain inputs
    do to the logarithm of the critical friction. Beyond what was searched only the lower end is known, and
    of a friction whose interval begins at 0.
    """
    value = limit.own_critical_friction
    low, high = limit.own_critical_friction_low, limit.own_critical_friction_high
    least, most = interval
    if value == 0.0:
        return SafetyFactor(safety_factor=0.0, safety_factor_low=0.0, safety_factor_high=0.0)
    if friction <= 0.0:
        return SafetyFactor()
    if value is None:
        return SafetyFactor(safety_factor_low=low / most)

    def reach(of_limit: Ratio, of_friction: Ratio) -> float:
        ratios = (max(of_limit, TINY) / value, of_friction / friction)
        return math.hypot(*map(math.log, ratios), spread)

    factor, upper = value / friction, value if high is None else high
    return SafetyFactor(
        safety_factor=factor,
        safety_factor_low=factor * math.exp(-reach(low, most)),
        safety_factor_high=factor * math.exp(reach(upper, least)) if least > 0.0 else None,
    )
