r"""A ball that a pocket pushes, as power series: along its orbit, and along its grooves.

Along the orbit it is a damper, :math:`C_\mu\dot y = F_t`, or has traction, :math:`m_e\dot u = F_t - F(u)`
with :math:`F(u) = \sum_i C_i u/(1 + (u/v_i)^n)^{1/n}`. Along its grooves :math:`c_g\dot x + k_g x = F_z`.
In a ramp the races yield by the share of the speed: :math:`F(u/\lambda)`, :math:`c_g/\lambda`.

A ball whose races stop it much faster than anything else moves creeps: :math:`F(u) = F_t` at once, until the
force is near the capacity. With :math:`x = F_t/C`, :math:`u = \lambda x/(1 - (x/v)^n)^{1/n}`.
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
from separatrix.units import Array


@inlined_kernel
def squared(c: Array, column: int, n: int) -> float:
    """Coefficient n of the square of a series."""
    total = 0.0
    for m in range(n + 1):
        total += c[m, column] * c[n - m, column]
    return float(total)


@inlined_kernel
def traction(p: Numbers, parts: Parts, j: int, now: Pace, n: int) -> float:
    """Coefficient n of the races' force on a ball."""
    # r = u / lambda; w = 1 + (r/v)^n, g = w^-a, a = 1/n: k w_0 g_k = -sum_(i<k) (a (k - i) + i) w_(k-i) g_i
    ball = parts.ball[j]
    ball[n, SLOW] = ball[n, SPEED] / now.share
    if n > 0:
        ball[n, SLOW] -= now.rise * ball[n - 1, SLOW] / now.share
    slow = ball[n, SLOW]
    square = even_power(p, ball, SLOW, n)
    total = 0.0
    for k in range(p.elements):
        lower_root(p, ball, ELEMENTS + 2 * k, parts.steep[k] * square, n)
        force = 0.0
        for m in range(1, n):
            force += ball[m, ELEMENTS + 2 * k + 1] * ball[n - m, SLOW]
        force += ball[0, ELEMENTS + 2 * k + 1] * slow
        if n > 0:
            force += ball[n, ELEMENTS + 2 * k + 1] * ball[0, SLOW]
        total += parts.slope[k] * force
    return total


@inlined_kernel
def even_power(p: Numbers, ball: Array, column: int, n: int) -> float:
    """Coefficient n of the second or fourth power of a series of a ball."""
    square = squared(ball, column, n)
    ball[n, ELEMENTS - 1] = square
    return squared(ball, ELEMENTS - 1, n) if p.sharp else square


@inlined_kernel
def lower_root(p: Numbers, ball: Array, w: int, here: float, n: int) -> None:
    """Coefficient n of 1 + a series, whose own is `here`; in the next column of its power -1/2 or -1/4."""
    g = w + 1
    if n == 0:
        root = math.sqrt(1.0 + here)
        ball[0, w], ball[0, g] = 1.0 + here, 1.0 / (math.sqrt(root) if p.sharp else root)
        return
    power = 0.0
    for m in range(1, n):
        power -= (p.power * (n - m) + m) * ball[n - m, w] * ball[m, g]
    ball[n, w] = here
    ball[n, g] = (power - p.power * n * here * ball[0, g]) / (n * ball[0, w])


@inlined_kernel
def creep(p: Numbers, parts: Parts, j: int, n: int) -> float:
    """Coefficient n of the speed, over the share of the full speed, of a ball whose races hold its force."""
    ball = parts.ball[j]
    # (x/v)^n = (F_t/C v)^n
    steep = parts.steep[0] / (parts.slope[0] ** 4 if p.sharp else parts.slope[0] ** 2)
    lower_root(p, ball, ELEMENTS, -steep * even_power(p, ball, ALONG, n), n)
    total = 0.0
    for m in range(n + 1):
        total += ball[m, ELEMENTS + 1] * ball[n - m, ALONG]
    return float(total / parts.slope[0])


@inlined_kernel
def move_ball(p: Numbers, parts: Parts, j: int, now: Pace, along: float, axial: float, n: int) -> None:
    """Coefficient n + 1 of a ball's motion, from the force on it along the orbit and the axis."""
    ball, after = parts.ball[j], 1.0 / (n + 1.0)
    ball[n, ALONG] = along
    if p.ball_mass == 0.0:
        ball[n, SPEED] = p.yielding * now.share * along
        if n > 0:
            ball[n, SPEED] += p.yielding * now.rise * ball[n - 1, ALONG]
    elif parts.creeping[j] != 0:
        ball[n, HOLD], ball[n, SLOW] = along, creep(p, parts, j, n)
        ball[n, SPEED] = now.share * ball[n, SLOW]
        if n > 0:
            ball[n, SPEED] += now.rise * ball[n - 1, SLOW]
    else:
        ball[n, HOLD] = traction(p, parts, j, now, n)
        ball[n + 1, SPEED] = (along - ball[n, HOLD]) / p.ball_mass * after
    ball[n + 1, LEAD] = ball[n, SPEED] * after
    ball[n, GIVE] = axial - p.groove_stiffness * ball[n, AXIAL]
    rate = now.share * ball[n, GIVE]
    if n > 0:
        rate += now.rise * ball[n - 1, GIVE]
    ball[n + 1, AXIAL] = p.groove_yielding * rate * after
