"""What a test rig sees of a running cage: torque, how it goes with speed, and the line of a whirl.

A stable cage leaves the torque to the balls on their races, which in a slow bearing does not depend on speed
(in a fast one centrifugal load adds to it); an unstable one adds friction that grows with speed: the torque
may go as speed squared (Lewis and others, ESTL, 44th Aerospace Mechanisms Symposium 2018, p. 523).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage import Cause, History, MovingCage, RunOutcome
from separatrix.cage.course import FEWEST
from separatrix.chain.heat_balance import HeatBalance, heat_balance
from separatrix.chain.solution import Solution
from separatrix.ground.units import Hertz, NewtonMetre, RadianPerSecond, Ratio, Watt

SLOWER: Ratio = 0.8
"""Share of the speeds of the second run, for the exponent of the torque."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigSigns:
    """Torque of the running bearing and its signs, by one run and one at lower speed."""

    bearing_torque: (
        NewtonMetre  # of the shaft: friction of races, pockets and lands, and the fluid of [cooling]
    )
    cage_torque: NewtonMetre  # the part of it by friction at pockets and lands
    pocket_heat: Watt  # of friction in all pockets at the end of the run
    pocket_share: Ratio  # of it in all power that the shaft gives
    housing_frequency: Hertz | None
    """Highest line of the speed of the cage's centre, seen from the housing; null without a whirl."""
    slower_outcome: RunOutcome  # of the same run where all speeds are 0.8 of these
    slower_torque: NewtonMetre  # of that run
    torque_exponent: Ratio | None  # of torque against speed between both; null where one of them whirls alone
    race_exponent: Ratio  # the same of the friction of balls on races by itself
    heat: HeatBalance | None  # with the fluid; null without [cooling]


Followed = tuple[Solution, MovingCage, History]
"""A chain, its cage, and a run of it."""


def lasts(history: History) -> bool:
    """Whether a motion lasts: it whirls, rolls in its pockets, or is kept up by the land."""
    return history.outcome in (RunOutcome.WHIRLS, RunOutcome.ROLLS) or history.cause is Cause.LAND_FRICTION


def slower(solution: Solution) -> Solution:
    """The same chain at lower speeds."""
    study, at = solution.study, solution.study.operation
    on = replace(at, inner_speed=SLOWER * at.inner_speed, outer_speed=SLOWER * at.outer_speed)
    return Solution(study=replace(study, operation=on), candidate=solution.candidate)


def rig_signs(this: Followed, other: Followed) -> RigSigns:
    """Signs of a run; `other` is the same of the `slower` chain."""
    (torque, of_cage, pockets, heat), (less, *_) = _torque(*this), _torque(*other)
    _, cage, history = this
    return RigSigns(
        bearing_torque=torque,
        cage_torque=of_cage,
        pocket_heat=pockets,
        pocket_share=pockets / (torque * _ring_speed(this[0])),
        housing_frequency=housing_line(cage, history) if lasts(history) else None,
        slower_outcome=other[2].outcome,
        slower_torque=less,
        torque_exponent=_exponent(torque, less) if lasts(history) == lasts(other[2]) else None,
        race_exponent=_exponent(*(one.bearing.equilibrium.friction_torque for one in (this[0], other[0]))),
        heat=heat,
    )


def housing_line(cage: MovingCage, history: History) -> Hertz:
    """Frequency of the highest line in the spectrum of the centre's velocity, seen from the housing."""
    here = (history.time >= history.judged_from) & (history.time <= history.followed)
    here = here if here.sum() >= FEWEST else np.ones(here.size, dtype=bool)
    time, turn = history.time[here], 1j * cage.cage_speed
    place, velocity = (one[here] @ np.array([1.0, 1.0j]) for one in (history.position, history.velocity))
    seen = (velocity + turn * place) * np.exp(turn * time)
    lines = np.abs(np.fft.fft((seen - seen.mean()) * np.hanning(time.size)))
    return float(abs(np.fft.fftfreq(time.size, time[1] - time[0])[lines.argmax()]))


def _exponent(torque: NewtonMetre, less: NewtonMetre) -> Ratio:
    return math.log(torque / less) / -math.log(SLOWER)


def _torque(
    solution: Solution, cage: MovingCage, history: History
) -> tuple[NewtonMetre, NewtonMetre, Watt, HeatBalance | None]:
    """Torque of the shaft, the cage's part of it, heat of the pockets, balance with the fluid if any."""
    pockets = cage.ball_cage_friction * history.pocket_sliding
    land = cage.land_friction * history.rubbing_force * history.rubbing_speed
    of_cage = (pockets + land) / _ring_speed(solution)
    heat = heat_balance(solution.study, solution.bearing, pocket_power=pockets, land_power=land)
    own = solution.bearing.equilibrium.friction_torque + of_cage
    return heat.shaft_torque if heat else own, of_cage, pockets, heat


def _ring_speed(solution: Solution) -> RadianPerSecond:
    return abs(solution.study.operation.inner_speed - solution.study.operation.outer_speed)
