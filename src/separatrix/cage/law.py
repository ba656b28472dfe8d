r"""The law of traction of balls with inertia, as power series of a block of balls side by side.

The races pull a ball back by :math:`F(u) = \sum_i C_i c / (1 + (c/v_i)^n)^{1/n}`, n = 2 or 4, of the creep
:math:`c = u/\lambda`. In each sum the terms that wait for the newest coefficients come last.
"""

from __future__ import annotations

import math

from separatrix.cage.records import (
    AT_KNOTS,
    BENT,
    CREEP,
    EARLY_BOUND,
    FOURTH,
    GRIP,
    IS_LINEAR,
    LANES,
    LATE_BOUND,
    ORDER,
    PLACE,
    POWERS,
    SPEED,
    SQUARE,
    TRACTION,
    WAY,
    Coefficients,
    Pace,
)
from separatrix.cage.series import AFTER, EARLY, HALF_SLOPES, HALVES, LATE
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

LAST_ROW = POWERS - 1
"""Row of a block of series that none of them reaches: their values at the end of a step."""

BENDS_NOT = 2.0**-60
"""Share by which the force of a law of traction is below that of its slope where it is called linear."""


@inlined_kernel
def blocks(used: int) -> int:
    """Number of blocks of `LANES` slots for this number of balls."""
    return (used + LANES - 1) // LANES


@inner_kernel
def coast(p: Coefficients, moving: Array, count: int, used: int, now: Pace, n: int) -> None:
    """Coefficient n of the traction on balls that move, over their mass; n + 1 of their speeds and ways.

    As if none were touched; speeds are known up to n. All of a block is read, made and written at once: a
    number that is written by itself is not read with its neighbours before it has reached the memory.
    """
    share, after, rise = 1.0 / now.share, AFTER[n], now.rise
    for b in range(blocks(used)):
        speed, way, traction = moving[b, SPEED], moving[b, WAY], moving[b, TRACTION]
        creep, place = moving[b, CREEP], moving[b, PLACE]
        u0, u1, u2, u3 = speed[n, 0], speed[n, 1], speed[n, 2], speed[n, 3]
        c0, c1, c2, c3 = u0, u1, u2, u3
        if rise != 0.0 and n > 0:
            # lambda c = u with lambda = lambda_0 + lambda' t
            c0, c1 = c0 - rise * creep[n - 1, 0], c1 - rise * creep[n - 1, 1]
            c2, c3 = c2 - rise * creep[n - 1, 2], c3 - rise * creep[n - 1, 3]
        c0, c1, c2, c3 = c0 * share, c1 * share, c2 * share, c3 * share
        creep[n, 0], creep[n, 1], creep[n, 2], creep[n, 3] = c0, c1, c2, c3
        if n == 0:
            most = max(max(abs(c0), abs(c1)), max(abs(c2), abs(c3)))
            place[IS_LINEAR, 0] = 1.0 if b * LANES >= count and is_linear(p, most) else 0.0
        if place[IS_LINEAR, 0] != 0.0:
            stop = 1.0 / p.coast_time
            f0, f1, f2, f3 = stop * c0, stop * c1, stop * c2, stop * c3
        else:
            f0, f1, f2, f3 = grip_force(p, moving[b], c0, c1, c2, c3, n)
        traction[n, 0], traction[n, 1], traction[n, 2], traction[n, 3] = f0, f1, f2, f3
        speed[n + 1, 0], speed[n + 1, 1], speed[n + 1, 2], speed[n + 1, 3] = (
            -f0 * after, -f1 * after, -f2 * after, -f3 * after)  # fmt: skip
        way[n + 1, 0], way[n + 1, 1], way[n + 1, 2], way[n + 1, 3] = (
            u0 * after, u1 * after, u2 * after, u3 * after)  # fmt: skip


@inlined_kernel
def is_linear(p: Coefficients, creep: float) -> bool:
    """Whether the law of traction of a ball that slows down from this creep is its slope, to rounding."""
    square, steepest = creep * creep, 0.0
    for e in range(p.elements):
        steepest = max(steepest, p.bends[e])
    return steepest * (square * square if p.sharp else square) < BENDS_NOT


@inlined_kernel
def grip_force(
    p: Coefficients, ball: Array, c0: float, c1: float, c2: float, c3: float, n: int
) -> tuple[float, float, float, float]:
    """Coefficient n of the traction on a block of balls, over their mass."""
    creep, square, grip = ball[CREEP], ball[SQUARE], ball[GRIP]
    f0, f1, f2, f3 = p.damper * c0, p.damper * c1, p.damper * c2, p.damper * c3
    if p.elements > 0:
        square_term(creep, square, n)
        if p.sharp:
            square_term(square, ball[FOURTH], n)
            square = ball[FOURTH]
        grip[n, 0] = grip[n, 1] = grip[n, 2] = grip[n, 3] = 0.0
        for e in range(p.elements):
            grip_term(p.bends[e], p.slopes[e], p.power, square, ball[BENT + e], grip, n)
        for i in range(1, n + 1):
            k = n - i
            f0, f1 = f0 + creep[i, 0] * grip[k, 0], f1 + creep[i, 1] * grip[k, 1]
            f2, f3 = f2 + creep[i, 2] * grip[k, 2], f3 + creep[i, 3] * grip[k, 3]
        f0, f1 = f0 + creep[0, 0] * grip[n, 0], f1 + creep[0, 1] * grip[n, 1]
        f2, f3 = f2 + creep[0, 2] * grip[n, 2], f3 + creep[0, 3] * grip[n, 3]
    return f0, f1, f2, f3


@inlined_kernel
def square_term(c: Array, square: Array, n: int) -> None:
    """Coefficient n of the squares of series, a block of them."""
    r0 = r1 = r2 = r3 = 0.0
    half = (n + 1) // 2
    for i in range(1, half):
        k = n - i
        r0, r1 = r0 + c[i, 0] * c[k, 0], r1 + c[i, 1] * c[k, 1]
        r2, r3 = r2 + c[i, 2] * c[k, 2], r3 + c[i, 3] * c[k, 3]
    r0, r1, r2, r3 = 2.0 * r0, 2.0 * r1, 2.0 * r2, 2.0 * r3
    if n % 2 == 0 and n > 0:
        r0, r1 = r0 + c[half, 0] * c[half, 0], r1 + c[half, 1] * c[half, 1]
        r2, r3 = r2 + c[half, 2] * c[half, 2], r3 + c[half, 3] * c[half, 3]
    once = 2.0 if n > 0 else 1.0
    r0, r1 = r0 + once * c[0, 0] * c[n, 0], r1 + once * c[0, 1] * c[n, 1]
    r2, r3 = r2 + once * c[0, 2] * c[n, 2], r3 + once * c[0, 3] * c[n, 3]
    square[n, 0], square[n, 1], square[n, 2], square[n, 3] = r0, r1, r2, r3


@inlined_kernel
def grip_term(
    bend: float, slope: float, power: float, square: Array, bent: Array, grip: Array, n: int
) -> None:
    """Add coefficient n of slope (1 + bend square)^-power to those of `grip`, a block of them."""
    if n == 0:
        for m in range(LANES):
            root = math.sqrt(1.0 + bend * square[0, m])
            bent[0, m] = 1.0 / (root if power == 0.5 else math.sqrt(root))
            grip[0, m] += slope * bent[0, m]
        return
    # g = w^-a has w dg/dt = -a g dw/dt, whence n w_0 g_n = -sum_(i<n) (a (n - i) + i) w_(n-i) g_i
    r0 = r1 = r2 = r3 = 0.0
    whole = -power * n
    for i in range(1, n):
        k, factor = n - i, whole - (1.0 - power) * i
        r0, r1 = r0 + factor * square[k, 0] * bent[i, 0], r1 + factor * square[k, 1] * bent[i, 1]
        r2, r3 = r2 + factor * square[k, 2] * bent[i, 2], r3 + factor * square[k, 3] * bent[i, 3]
    r0, r1 = r0 + whole * square[n, 0] * bent[0, 0], r1 + whole * square[n, 1] * bent[0, 1]
    r2, r3 = r2 + whole * square[n, 2] * bent[0, 2], r3 + whole * square[n, 3] * bent[0, 3]
    # 1/w_0 = g_0^(1/a)
    p0, p1, p2, p3 = bent[0, 0], bent[0, 1], bent[0, 2], bent[0, 3]
    p0, p1, p2, p3 = p0 * p0, p1 * p1, p2 * p2, p3 * p3
    if power != 0.5:
        p0, p1, p2, p3 = p0 * p0, p1 * p1, p2 * p2, p3 * p3
    after = AFTER[n - 1]
    r0, r1 = r0 * (bend * p0 * after), r1 * (bend * p1 * after)
    r2, r3 = r2 * (bend * p2 * after), r3 * (bend * p3 * after)
    bent[n, 0], bent[n, 1], bent[n, 2], bent[n, 3] = r0, r1, r2, r3
    r0, r1 = grip[n, 0] + slope * r0, grip[n, 1] + slope * r1
    r2, r3 = grip[n, 2] + slope * r2, grip[n, 3] + slope * r3
    grip[n, 0], grip[n, 1], grip[n, 2], grip[n, 3] = r0, r1, r2, r3


@inner_kernel
def learn_ways(moving: Array, count: int, used: int) -> None:
    """Knots of the ways of the balls that coast (`series.knots`), and bounds of what bends them."""
    for b in range(count // LANES, blocks(used)):
        c, at = moving[b, WAY], moving[b, AT_KNOTS]
        m0, m1, m2, m3 = c[0, 0], c[0, 1], c[0, 2], c[0, 3]
        l0, l1, l2, l3 = m0, m1, m2, m3
        t0 = t1 = t2 = t3 = f0 = f1 = f2 = f3 = e0 = e1 = e2 = e3 = g0 = g1 = g2 = g3 = 0.0
        for n in range(1, ORDER + 1):
            half, turn, fall, early, late = HALVES[n], HALF_SLOPES[n], 0.5 * n, EARLY[n], LATE[n]
            a0, a1, a2, a3 = c[n, 0], c[n, 1], c[n, 2], c[n, 3]
            m0, m1, m2, m3 = m0 + half * a0, m1 + half * a1, m2 + half * a2, m3 + half * a3
            t0, t1, t2, t3 = t0 + turn * a0, t1 + turn * a1, t2 + turn * a2, t3 + turn * a3
            l0, l1, l2, l3 = l0 + a0, l1 + a1, l2 + a2, l3 + a3
            f0, f1, f2, f3 = f0 + fall * a0, f1 + fall * a1, f2 + fall * a2, f3 + fall * a3
            a0, a1, a2, a3 = abs(a0), abs(a1), abs(a2), abs(a3)
            e0, e1, e2, e3 = e0 + early * a0, e1 + early * a1, e2 + early * a2, e3 + early * a3
            g0, g1, g2, g3 = g0 + late * a0, g1 + late * a1, g2 + late * a2, g3 + late * a3
        at[0, 0], at[0, 1], at[0, 2], at[0, 3] = c[0, 0], c[0, 1], c[0, 2], c[0, 3]
        at[1, 0], at[1, 1], at[1, 2], at[1, 3] = 0.5 * c[1, 0], 0.5 * c[1, 1], 0.5 * c[1, 2], 0.5 * c[1, 3]
        at[2, 0], at[2, 1], at[2, 2], at[2, 3] = m0, m1, m2, m3
        at[3, 0], at[3, 1], at[3, 2], at[3, 3] = t0, t1, t2, t3
        at[4, 0], at[4, 1], at[4, 2], at[4, 3] = l0, l1, l2, l3
        at[5, 0], at[5, 1], at[5, 2], at[5, 3] = f0, f1, f2, f3
        at[EARLY_BOUND, 0], at[EARLY_BOUND, 1], at[EARLY_BOUND, 2], at[EARLY_BOUND, 3] = e0, e1, e2, e3
        at[LATE_BOUND, 0], at[LATE_BOUND, 1], at[LATE_BOUND, 2], at[LATE_BOUND, 3] = g0, g1, g2, g3


@inlined_kernel
def lanes_at(c: Array, t: float) -> None:
    """Put the values at a time of a block of series into its last row, which no series reaches."""
    a0, a1, a2, a3 = c[ORDER, 0], c[ORDER, 1], c[ORDER, 2], c[ORDER, 3]
    for n in range(ORDER - 1, -1, -1):
        a0, a1 = a0 * t + c[n, 0], a1 * t + c[n, 1]
        a2, a3 = a2 * t + c[n, 2], a3 * t + c[n, 3]
    c[LAST_ROW, 0], c[LAST_ROW, 1], c[LAST_ROW, 2], c[LAST_ROW, 3] = a0, a1, a2, a3


@inner_kernel
def traction_power(moving: Array, used: int, t: float, later: float) -> tuple[float, float]:
    """Power that the races take from the balls that move at two times, over the mass of a ball."""
    total = total_later = 0.0
    for b in range(blocks(used)):
        speed, traction = moving[b, SPEED], moving[b, TRACTION]
        u0 = u1 = u2 = u3 = f0 = f1 = f2 = f3 = 0.0
        v0 = v1 = v2 = v3 = g0 = g1 = g2 = g3 = 0.0
        for n in range(ORDER, -1, -1):
            a0, a1, a2, a3 = speed[n, 0], speed[n, 1], speed[n, 2], speed[n, 3]
            u0, u1, u2, u3 = u0 * t + a0, u1 * t + a1, u2 * t + a2, u3 * t + a3
            v0, v1, v2, v3 = v0 * later + a0, v1 * later + a1, v2 * later + a2, v3 * later + a3
            a0, a1, a2, a3 = traction[n, 0], traction[n, 1], traction[n, 2], traction[n, 3]
            f0, f1, f2, f3 = f0 * t + a0, f1 * t + a1, f2 * t + a2, f3 * t + a3
            g0, g1, g2, g3 = g0 * later + a0, g1 * later + a1, g2 * later + a2, g3 * later + a3
        # F(u) u
        total += u0 * f0 + u1 * f1 + u2 * f2 + u3 * f3
        total_later += v0 * g0 + v1 * g1 + v2 * g2 + v3 * g3
    return total, total_later
