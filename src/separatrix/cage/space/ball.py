r"""A ball that a pocket pushes, as power series: along its orbit, and along its grooves.

Along the orbit it is a damper, :math:`C_\mu\dot y = F_t`, or has traction, :math:`m_e\dot u = F_t - F(u)`
with :math:`F(u) = \sum_i C_i u/(1 + (u/v_i)^n)^{1/n}`. Along its grooves :math:`c_g\dot x + k_g x = F_z`.
In a ramp the races yield by the share of the speed: :math:`F(u/\lambda)`, :math:`c_g/\lambda`.
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
    # r = u / lambda; w = 1 + (r/v)^n, g = w^-a, a = 1/n: k w_0 g_k = -sum_(i<k) (a (k - i) + i) w_(k-i) g_i
    ball = parts.ball[j]
    ball[n, SLOW] = ball[n, SPEED] / now.share
    if n > 0:
        ball[n, SLOW] -= now.rise * ball[n - 1, SLOW] / now.share
    square = 0.0
    for m in range(n + 1):
        square += ball[m, SLOW] * ball[n - m, SLOW]
    ball[n, ELEMENTS - 1] = square
    if p.sharp:
        square = 0.0
        for m in range(n + 1):
            square += ball[m, ELEMENTS - 1] * ball[n - m, ELEMENTS - 1]
    total = 0.0
    for k in range(p.elements):
        w, g = ELEMENTS + 2 * k, ELEMENTS + 2 * k + 1
        ball[n, w] = parts.steep[k] * square
        if n == 0:
            ball[0, w] += 1.0
            root = math.sqrt(ball[0, w])
            ball[0, g] = 1.0 / (math.sqrt(root) if p.sharp else root)
        else:
            power = 0.0
            for m in range(n):
                power -= (p.power * (n - m) + m) * ball[n - m, w] * ball[m, g]
            ball[n, g] = power / (n * ball[0, w])
        force = 0.0
        for m in range(n + 1):
            force += ball[m, g] * ball[n - m, SLOW]
        total += parts.slope[k] * force
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
