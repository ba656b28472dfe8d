r"""One step of sixteen runs by classical Runge-Kutta, and the length of a step.

The speed of a ball of one state is stiff in a slow bearing: there :math:`C_f/m_e` is far above every other
rate. Its linear part is taken exactly (exponential time differencing of order 4, Cox and Matthews 2002),
which is classical Runge-Kutta where that rate is small.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from separatrix.cage.closed_forms import moving_mass, rebound_damping
from separatrix.cage.rows import *
from separatrix.ground.compiled import inlined
from separatrix.study.cage_design import Guidance

if TYPE_CHECKING:
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.ground.units import Metre, MetrePerSecond, NewtonPerMetre, Second


@inlined
def stage_end(stage, s, t, d, q, h, sixth):
    """State `t` of the next stage, from the rates `d` of this one; after the last, `s` and `t`.

    `h`: length of the step, as often as there are numbers in the state, so that one loop does; `sixth`: 1/6
    in the precision of the state.
    """
    if stage < 3:
        keep, gain = ZERO if stage == 0 else ONE, ONE if stage == 0 else TWO
        ahead = ONE if stage == 2 else HALF
        for e in range(s.size):
            q[e] = keep * q[e] + gain * d[e]
            t[e] = s[e] + ahead * h[e] * d[e]
    else:
        for e in range(s.size):
            s[e] += sixth * h[e] * (q[e] + d[e])
            t[e] = s[e]


@inlined
def held_stage_end(stage, s, t, d, first, middle, held):
    """The same where balls have one state, whose decay is exact; `held`: gains of every number of the state.

    A number that does not decay takes the step of `stage_end`.
    """
    half, gain, whole, by_first, by_middle, by_last = held[0], held[1], held[2], held[3], held[4], held[5]
    for e in range(s.size):
        rate = d[e]
        if stage == 0:
            first[e] = rate
            t[e] = half[e] * s[e] + gain[e] * rate
        elif stage == 1:
            middle[e] = rate
            t[e] = half[e] * s[e] + gain[e] * rate
        elif stage == 2:
            middle[e] += rate
            t[e] = half[e] * (half[e] * s[e] + gain[e] * first[e]) + gain[e] * (TWO * rate - first[e])
        else:
            s[e] = whole[e] * s[e] + (by_first[e] * first[e] + by_middle[e] * middle[e] + by_last[e] * rate)
            t[e] = s[e]


def exact_decay(rate: float, step: float) -> tuple[float, float, float, float, float, float]:
    """Decay over half a step with its gain, over a step; gains of first, middle and last rate [-], [s]."""
    half = -0.5 * rate * step
    f1, f2, f3 = (_phi(n, 2.0 * half) for n in (1, 2, 3))
    first, middle, last = f1 - 3.0 * f2 + 4.0 * f3, 2.0 * f2 - 4.0 * f3, 4.0 * f3 - f2
    held = math.exp(half), 0.5 * step * _phi(1, half), math.exp(2.0 * half)
    return *held, step * first, step * middle, step * last


def _phi(n: int, z: float) -> float:
    """phi_n(z) = sum of z^i / (i + n)!: (e^z - 1)/z, ((e^z - 1)/z - 1)/z, ..."""
    if abs(z) < 1.0:
        return sum(z**i / math.factorial(i + n) for i in range(20))
    value = math.exp(z)
    for i in range(n):
        value = (value - 1.0 / math.factorial(i)) / z
    return value


LONGEST: Second = 20e-6
CONTACT, LAND, SWING, DECAYS = 0.45, 0.3, 0.65, 1.2
"""Radians of a contact of cage and ball, of one with a land, and of a ball between pocket and races, and time
constants of a relaxation, that a step may have at most: shares and margins do not move at an eighth of it
(docs/theory/cage.md). A cage that whirls on its land passes a contact faster than it would vibrate there."""

FREE_RATE = 2.5
"""Time constants of the fastest motion of a free ball's spin in a step; 2.78 is where the method is no longer
stable."""


def step_length(cage: MovingCage, kick: MetrePerSecond) -> Second:
    """Length of the step: the least of 20 us and shares of the shortest contact, relaxation, period."""
    M, k = cage.mass, pocket_stiffness(cage, kick)
    turning = cage.pitch_radius**2 / cage.moment_of_inertia
    grips = cage.half_play == 0.0
    levers = (1.0 / M + turning) * (cage.ball_count / 2.0 if grips else 1.0)
    if cage.is_in_space:
        levers += cage.pitch_radius**2 / cage.transverse * (cage.ball_count / 2.0 if grips else 1.0)
    steps = [LONGEST, CONTACT / math.sqrt(k * levers)]
    if cage.free_ball is not None:
        steps += [
            FREE_RATE / cage.free_ball.fastest_rate,
            SWING / math.sqrt(k * (levers + 1.0 / cage.free_ball.mass)),
        ]
        steps[-2] *= cage.ramp_start if cage.ramp_time > 0.0 else 1.0
    elif cage.traction is not None:
        steps.append(SWING / math.sqrt(k * (levers + 1.0 / cage.traction.mass)))
        if cage.ramp_time > 0.0:  # in a ramp the races hold a ball harder at first
            beyond = (1.0 / cage.ramp_start - 1.0) * cage.traction.slope / cage.traction.mass
            steps.append(DECAYS / max(beyond, 1e-30))
    else:
        steps.append(DECAYS * cage.race_damping / k)
    if cage.is_in_space and math.isfinite(cage.groove_damping):
        steps.append(DECAYS * cage.groove_damping / (k + cage.groove_stiffness))
    if cage.guidance is not Guidance.BALL:
        K = cage.land_count * cage.land_stiffness
        squared = K / M + (K * land_reach(cage) ** 2 / cage.transverse if cage.is_in_space else 0.0)
        damping = rebound_damping(cage.land_restitution)
        steps.append(LAND / math.sqrt(squared) * (1.0 if damping < 1.0 else 1.0 / (2.0 * damping)))
    return min(steps)


def pocket_stiffness(cage: MovingCage, kick: MetrePerSecond) -> NewtonPerMetre:
    """Stiffness of a pocket as deep as in a strong impact, of four times the energy of the start."""
    if cage.hertz_coefficient is None:
        return cage.ball_cage_stiffness
    K, energy = (
        cage.hertz_coefficient,
        2.0 * moving_mass(cage) * max(kick, abs(cage.cage_speed) * cage.half_play) ** 2,
    )
    return 1.5 * K * math.sqrt((2.5 * energy / K) ** 0.4)


def land_reach(cage: MovingCage) -> Metre:
    """Height of the outermost strip of a land over the pockets [m]."""
    return 0.5 * (cage.land_spacing or 0.0) + 0.5 * cage.land_width
