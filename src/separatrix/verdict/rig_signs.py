"""What a test rig sees of a running cage: torque, how it grows with speed, and the frequency of a whirl.

A stable cage leaves the torque to the balls on their races, which in a slow bearing does not depend on speed
(in a fast one centrifugal load adds to it); an unstable one adds friction that grows with speed: the torque
may go as speed squared (Lewis and others, ESTL, 44th Aerospace Mechanisms Symposium 2018, p. 523).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage import History, MovingCage, RunOutcome
from separatrix.chain.heat_balance import HeatBalance, heat_balance
from separatrix.chain.solution import Solution
from separatrix.ground.units import Hertz, NewtonMetre, RadianPerSecond, Ratio, Watt

KILOHERTZ: Hertz = 1000.0
"""Middle of a third octave."""

SLOWER: Ratio = 0.8
"""Share of the speeds of the second run, for the exponent of the torque."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigSigns:
    """Torque of the running bearing and its signs, by one run and one at lower speed."""

    bearing_torque: NewtonMetre  # of the shaft: races, pockets, lands, and the fluid of [cooling]
    cage_torque: NewtonMetre  # the part of it by friction at pockets and lands
    pocket_heat: Watt  # of friction in all pockets at the end of the run
    pocket_share: Ratio  # of it in all power that the shaft gives
    housing_frequency: Hertz | None
    """Middle of the third octave with most of the centre's motion, in the housing: of a whirl, or of a cage
    that has settled off the axis and turns; null of another one."""
    housing_share: Ratio | None  # of its power that lies there: a line where it is most
    signs_outcome: RunOutcome  # of the run that these signs are of
    signs_with_free_balls: bool  # whether its balls are free, since its forces exceed what the races hold
    slower_outcome: RunOutcome  # of the same run where all speeds are 0.8 of these
    slower_torque: NewtonMetre  # of that run
    torque_exponent: Ratio | None  # of torque against speed between both; null where one of them whirls alone
    race_exponent: Ratio  # the same without the cage: of balls on races and of the fluid
    heat: HeatBalance | None  # with the fluid; null without [cooling]


Followed = tuple[Solution, MovingCage, History]
"""A chain, its cage, and a run of it."""


def lasts(history: History) -> bool:
    """Whether a motion lasts: it whirls, or rolls in its pockets."""
    return history.outcome in (RunOutcome.WHIRLS, RunOutcome.ROLLS)


def slower(solution: Solution) -> Solution:
    """The same chain at lower speeds."""
    study, at = solution.study, solution.study.operation
    on = replace(at, inner_speed=SLOWER * at.inner_speed, outer_speed=SLOWER * at.outer_speed)
    return Solution(study=replace(study, operation=on), candidate=solution.candidate)


def rig_signs(this: Followed, other: Followed) -> RigSigns:
    """Signs of a run, one that lasts followed until it has grown; `other` is that of the `slower` chain."""
    (torque, of_cage, pockets, heat), (less, cage_less, *_) = shaft_torque(*this), shaft_torque(*other)
    _, cage, history = this
    line, share = heard(cage, history)
    return RigSigns(
        bearing_torque=torque,
        cage_torque=of_cage,
        pocket_heat=pockets,
        pocket_share=pockets / (torque * _ring_speed(this[0])),
        housing_frequency=line,
        housing_share=share,
        signs_outcome=history.outcome,
        signs_with_free_balls=cage.free_ball is not None,
        slower_outcome=other[2].outcome,
        slower_torque=less,
        torque_exponent=_exponent(torque, less) if lasts(history) == lasts(other[2]) else None,
        race_exponent=_exponent(torque - of_cage, less - cage_less),
        heat=heat,
    )


def loudest(cage: MovingCage, history: History) -> tuple[Hertz, Ratio]:
    """Middle of the third octave with most of the centre's motion, seen from the housing, and its share.

    Of the power of the velocity in the second half of the run, when a whirl has grown.
    """
    here = history.time >= 0.5 * history.time[-1]
    time, turn = history.time[here], 1j * cage.cage_speed
    place, velocity = (one[here] @ np.array([1.0, 1.0j]) for one in (history.position, history.velocity))
    seen = (velocity + turn * place) * np.exp(turn * time)
    power = np.abs(np.fft.fft((seen - seen.mean()) * np.hanning(time.size))) ** 2
    frequency = np.abs(np.fft.fftfreq(time.size, time[1] - time[0]))
    bands = np.round(3.0 * np.log2(np.maximum(frequency, 1.0) / KILOHERTZ)).astype(int)
    each, place_of = np.unique(bands, return_inverse=True)
    powers = np.bincount(place_of, power)
    most = int(powers.argmax())
    return float(KILOHERTZ * 2.0 ** (each[most] / 3.0)), float(powers[most] / power.sum())


def heard(cage: MovingCage, history: History) -> tuple[Hertz, Ratio] | tuple[None, None]:
    """The loudest third octave of a motion that lasts; of another one only if the turning cage makes it.

    That is the case where more than half of the power is at the speed of the cage: its centre has come to
    rest among the balls, off the axis.
    """
    own = abs(cage.cage_speed) / (2.0 * math.pi)
    if not history.position[-1].any():
        return None, None
    line, share = loudest(cage, history)
    is_turn = share > 0.5 and own > 0.0 and abs(math.log2(line / own)) <= 1.0 / 6.0
    return (line, share) if is_turn or lasts(history) else (None, None)


def _exponent(torque: NewtonMetre, less: NewtonMetre) -> Ratio:
    return math.log(torque / less) / -math.log(SLOWER)


def shaft_torque(
    solution: Solution, cage: MovingCage, history: History
) -> tuple[NewtonMetre, NewtonMetre, Watt, HeatBalance | None]:
    """Torque of the shaft, the cage's part of it, heat of the pockets, balance with the fluid if any."""
    pressed, speed = history.pocket_sliding, history.rubbing_speed
    force = history.rubbing_force
    if lasts(history):  # means of the whole run: that by which it was judged has hardly begun to whirl
        pressed = float(history.pocket_rubbing.sum() / history.time[-1])
        force = float(history.land_force.mean())
        radius = cage.land_radius or cage.pitch_radius
        speed = speed or abs(cage.guiding_ring_speed - cage.cage_speed) * radius
    pockets, land = cage.ball_cage_friction * pressed, cage.land_friction * force * speed
    of_cage = (pockets + land) / _ring_speed(solution)
    heat = heat_balance(solution.study, solution.bearing, pocket_power=pockets, land_power=land)
    own = solution.bearing.equilibrium.friction_torque + of_cage
    return heat.shaft_torque if heat else own, of_cage, pockets, heat


def _ring_speed(solution: Solution) -> RadianPerSecond:
    return abs(solution.study.operation.inner_speed - solution.study.operation.outer_speed)
