r"""A ball that a pocket pushes, as power series: along its orbit, and along its grooves.

Along the orbit it is a damper, :math:`C_\mu\dot y = F_t`, or has traction, :math:`m_e\dot u = F_t - F(u)`
with :math:`F(u) = \sum_i C_i u/\sqrt{1 + (u/v_i)^2}`. Along its grooves :math:`c_g\dot x + k_g x = F_z`. In a
ramp the races yield by the share of the speed: :math:`F(u/\lambda)`, :math:`c_g/\lambda`.
"""

from __future__ import annotations

import math

from separatrix.cage.records import Pace
from separatrix.cage.space.records import (
    ALONG,
    AXIAL,
    ELEMENTS,
    GIVE,
    HOLD,
    LEAD,
    SLOW,
    SPEED,
    Numbers,
    Parts,
)
from separatrix.compiled import inlined_kernel


@inlined_kernel
def traction(p: Numbers, parts: Parts, j: int, now: Pace, n: int) -> float:
    """Coefficient n of the races' force on a ball."""
    # r = u / lambda; w = 1 + (r/v)^2, g = w^(-1/2): w_0 n g_n = sum_(i<n) (-(n - i)/2 - i) w_(n-i) g_i
    ball = parts.ball[j]
    ball[n, SLOW] = ball[n, SPEED] / now.share
    if n > 0:
        ball[n, SLOW] -= now.rise * ball[n - 1, SLOW] / now.share
    slow = ball[n, SLOW]
    square = 2.0 * slow * ball[0, SLOW] if n > 0 else slow * slow
    for m in range(1, n):
        square += ball[m, SLOW] * ball[n - m, SLOW]
    total = 0.0
    for k in range(p.elements):
        w, g = ELEMENTS + 2 * k, ELEMENTS + 2 * k + 1
        here = parts.steep[k] * square
        if n == 0:
            ball[0, w] = 1.0 + here
            ball[0, g] = 1.0 / math.sqrt(ball[0, w])
            total += parts.slope[k] * ball[0, g] * slow
            continue
        power = force = 0.0
        for m in range(1, n):
            power -= 0.5 * (n + m) * ball[n - m, w] * ball[m, g]
            force += ball[m, g] * ball[n - m, SLOW]
        ball[n, w] = here
        ball[n, g] = (power - 0.5 * n * here * ball[0, g]) / (n * ball[0, w])
        total += parts.slope[k] * (force + ball[0, g] * slow + ball[n, g] * ball[0, SLOW])
    return total


@inlined_kernel
def move_ball(p: Numbers, parts: Parts, j: int, now: Pace, along: float, axial: float, n: int) -> None:
    """Coefficient n + 1 of a ball's motion, from the force on it along the orbit and the axis."""
    ball, after = parts.ball[j], 1.0 / (n + 1.0)
    ball[n, ALONG] = along
    if p.ball_mass == 0.0:
        ball[n, SPEED] = p.yielding * now.share * along
        if n > 0:
            ball[n, SPEED] += p.yielding * now.rise * ball[n - 1, ALONG]
    else:
        ball[n, HOLD] = traction(p, parts, j, now, n)
        ball[n + 1, SPEED] = (along - ball[n, HOLD]) / p.ball_mass * after
    ball[n + 1, LEAD] = ball[n, SPEED] * after
    ball[n, GIVE] = axial - p.groove_stiffness * ball[n, AXIAL]
    rate = now.share * ball[n, GIVE]
    if n > 0:
        rate += now.rise * ball[n - 1, GIVE]
    ball[n + 1, AXIAL] = p.groove_yielding * rate * after
