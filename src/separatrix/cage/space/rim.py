r"""A ball at the edge of its pocket's wall, as power series: where it touches, the force, and the friction.

A wall ends where it meets the cylinder of the cage's outer or inner surface, of radius :math:`\rho`. There
the nearest point of that edge, :math:`a` from the ball's centre, presses by :math:`N = k(h - |a|)` along
:math:`n = a/|a|`. With the ball at (z, t) in its pocket, at the height :math:`V = R - r\cdot e_r` over the
axis of the cage, :math:`a` has these parts along the axis, outward, and along the orbit:

- a round part of radius c about :math:`t_0`: :math:`(c\sin\beta - z,\; u - V,\; X - t)`, with :math:`X = t_0
  + c\cos\beta` and :math:`u^2 = \rho^2 - X^2`, where :math:`(t - t_0)\sin\beta - z\cos\beta + X\sin\beta
  \,(1 - V/u) = 0` makes it the nearest;
- a flat across the orbit: :math:`(0,\; u - V,\; X - t)`, with :math:`X = \pm c`;
- a flat along the orbit: :math:`(\pm c - z,\; wV,\; wt)`, with :math:`w = \rho/L - 1` and
  :math:`L^2 = V^2 + t^2`.
"""

from __future__ import annotations

import math

from separatrix.cage.records import Pace
from separatrix.cage.space.edge_points import GONE_ANGLE, follow_minimum, nearest
from separatrix.cage.space.records import (
    AWAY,
    CLOSING,
    CR,
    CT,
    CZ,
    DEPTH,
    DT,
    DZ,
    EDGE_R,
    EDGE_T,
    EDGE_Z,
    FT,
    FZ,
    GX,
    GY,
    HEIGHT,
    IN_T,
    IN_Z,
    LEAN,
    LEVEL,
    OUTER_CLEAR,
    PLACE,
    PUSH,
    RATIO,
    RIM_COS,
    RIM_R,
    RIM_SIN,
    RIM_T,
    RIM_Z,
    RUB_Q,
    RUB_R,
    SHARE,
    SLIDE,
    SLIP_R,
    SLIP_T,
    SLIP_Z,
    SPIN,
    SWEPT,
    TO_R,
    TO_T,
    TO_Z,
    Numbers,
    Parts,
)
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inner_kernel
def is_on_round(p: Numbers, parts: Parts, i: int) -> bool:
    """Whether a contact is on the round part of its pocket."""
    return bool(p.is_round and (i % 2 == 0 or parts.paired[i // 2] != 0))


@inner_kernel
def product(c: Array, a: int, b: int, n: int) -> float:
    """Coefficient n of the product of two series, without their first and last terms."""
    total = 0.0
    for m in range(1, n):
        total += c[m, a] * c[n - m, b]
    return total


@inner_kernel
def whole(c: Array, a: int, b: int, n: int) -> float:
    """Coefficient n of the product of two series."""
    if n == 0:
        return float(c[0, a] * c[0, b])
    return float(product(c, a, b, n) + c[0, a] * c[n, b] + c[n, a] * c[0, b])


@inner_kernel
def place_edge(p: Numbers, parts: Parts, i: int, n: int) -> None:
    """Coefficient n of a ball's place in its pocket, and of where a wall would touch it along the orbit."""
    j = i // 2
    e, ball, cage = parts.rim[i], parts.ball[j], parts.cage
    e[n, HEIGHT] = -(cage[n, GX] * parts.cosine[j] + cage[n, GY] * parts.sine[j])
    e[n, IN_Z], e[n, IN_T] = -ball[n, DZ], -ball[n, DT]
    is_round = is_on_round(p, parts, i)
    if not is_round:
        e[n, PLACE] = e[n, IN_T] if i % 2 == 1 else 0.0
    if n > 0:
        return
    e[0, HEIGHT] += p.radius
    if is_round:
        e[0, IN_T] += parts.region[j] * p.apart
    elif i % 2 == 0:
        e[0, PLACE] = math.copysign(p.ball_radius + p.around + parts.play[j], e[0, IN_T])


@inner_kernel
def find_round(p: Numbers, parts: Parts, i: int, edge: float) -> None:
    """First coefficients of the nearest point of a round edge; that from before, where it is known."""
    e, radius = parts.rim[i], p.ball_radius + p.around + parts.play[i // 2]
    middle = -parts.region[i // 2] * p.apart
    t, z, height, angle = e[0, IN_T], e[0, IN_Z], e[0, HEIGHT], GONE_ANGLE
    if e[0, RIM_SIN] != 0.0 or e[0, RIM_COS] != 0.0:
        angle = math.atan2(e[0, RIM_SIN], e[0, RIM_COS])
        last = angle
        angle = follow_minimum(t, z, height, radius, middle, edge, angle)
        if angle == GONE_ANGLE and parts.paired[i // 2] != 0:
            angle = last
    if angle == GONE_ANGLE:
        angle = nearest(t, z, height, radius, middle, edge, -float(parts.region[i // 2]))
    e[0, RIM_SIN], e[0, RIM_COS] = math.sin(angle), math.cos(angle)
    e[0, PLACE] = middle + radius * e[0, RIM_COS]
    e[0, LEVEL] = math.sqrt((edge - e[0, PLACE]) * (edge + e[0, PLACE]))
    e[0, RATIO], e[0, SWEPT] = e[0, HEIGHT] / e[0, LEVEL], e[0, PLACE] * e[0, RIM_SIN]
    e[0, EDGE_Z], e[0, EDGE_R] = radius * e[0, RIM_SIN] - e[0, IN_Z], e[0, LEVEL] - e[0, HEIGHT]
    e[0, EDGE_T] = radius * e[0, RIM_COS] - e[0, IN_T]


@inner_kernel
def expand_round_edge(p: Numbers, parts: Parts, i: int, n: int) -> None:
    """Coefficient n > 0 of the nearest point of a round edge."""
    e, radius = parts.rim[i], p.ball_radius + p.around + parts.play[i // 2]
    S, C, X, u, v, Y = e[0, RIM_SIN], e[0, RIM_COS], e[0, PLACE], e[0, LEVEL], e[0, RATIO], e[0, SWEPT]
    # S_n = g S + C phi and C_n = g C - S phi keep S^2 + C^2 = 1; all else is linear in phi, with these slopes
    dX = -radius * S
    du = -X * dX / u
    dv, dY = -v * du / u, X * C + S * dX
    slope = e[0, IN_T] * C + e[0, IN_Z] * S + (1.0 - v) * dY - Y * dv
    g = -0.5 * (product(e, RIM_SIN, RIM_SIN, n) + product(e, RIM_COS, RIM_COS, n))
    place = radius * g * C
    level = -(0.5 * (product(e, LEVEL, LEVEL, n) + product(e, PLACE, PLACE, n)) + X * place) / u
    ratio = (e[n, HEIGHT] - product(e, RATIO, LEVEL, n) - v * level) / u
    swept = product(e, PLACE, RIM_SIN, n) + X * g * S + S * place
    lack = e[n, IN_T] * S - e[n, IN_Z] * C + g * (e[0, IN_T] * S - e[0, IN_Z] * C)
    lack += product(e, IN_T, RIM_SIN, n) - product(e, IN_Z, RIM_COS, n) - product(e, SWEPT, RATIO, n)
    lack += swept * (1.0 - v) - Y * ratio
    phi = -lack / slope
    e[n, RIM_SIN], e[n, RIM_COS] = g * S + C * phi, g * C - S * phi
    e[n, PLACE], e[n, LEVEL] = place + dX * phi, level + du * phi
    e[n, RATIO], e[n, SWEPT] = ratio + dv * phi, swept + dY * phi
    e[n, EDGE_Z], e[n, EDGE_R] = radius * e[n, RIM_SIN] - e[n, IN_Z], e[n, LEVEL] - e[n, HEIGHT]
    e[n, EDGE_T] = e[n, PLACE] - e[n, IN_T]


@inner_kernel
def expand_flat_edge(p: Numbers, parts: Parts, i: int, edge: float, n: int) -> None:
    """Coefficient n of the nearest point of the edge of a flat."""
    e = parts.rim[i]
    if i % 2 == 0:
        e[n, EDGE_Z], e[n, EDGE_R], e[n, EDGE_T] = 0.0, -e[n, HEIGHT], e[n, PLACE] - e[n, IN_T]
        if n == 0:
            e[0, EDGE_R] += math.sqrt((edge - e[0, PLACE]) * (edge + e[0, PLACE]))
        return
    e[n, EDGE_Z] = -e[n, IN_Z]
    if n == 0:
        e[0, EDGE_Z] += math.copysign(p.ball_radius + p.beside, e[0, IN_Z])
        e[0, LEVEL] = math.hypot(e[0, HEIGHT], e[0, IN_T])
        e[0, RATIO] = (edge - e[0, LEVEL]) / e[0, LEVEL]
    else:
        square = whole(e, HEIGHT, HEIGHT, n) + whole(e, IN_T, IN_T, n)
        e[n, LEVEL] = 0.5 * (square - product(e, LEVEL, LEVEL, n)) / e[0, LEVEL]
        lag = e[n, LEVEL] * (1.0 + e[0, RATIO]) + product(e, LEVEL, RATIO, n)
        e[n, RATIO] = -lag / e[0, LEVEL]
    e[n, EDGE_R], e[n, EDGE_T] = whole(e, RATIO, HEIGHT, n), whole(e, RATIO, IN_T, n)
    e[n, SWEPT] = e[n, IN_T] + e[n, EDGE_T]


@inner_kernel
def expand_rim(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of the penetration of an edge, of its force, its friction and their couples."""
    c, e, kind = parts.contact[i], parts.rim[i], parts.kind[i]
    edge = p.outer_edge if kind % 2 == 0 else p.inner_edge
    place_edge(p, parts, i, n)
    if not is_on_round(p, parts, i):
        expand_flat_edge(p, parts, i, edge, n)
    elif n == 0:
        find_round(p, parts, i, edge)
    else:
        expand_round_edge(p, parts, i, n)
    square = whole(e, EDGE_Z, EDGE_Z, n) + whole(e, EDGE_R, EDGE_R, n) + whole(e, EDGE_T, EDGE_T, n)
    if n == 0:
        e[0, AWAY] = math.sqrt(square)
        c[0, DEPTH] = p.ball_radius - e[0, AWAY]
    else:
        e[n, AWAY] = 0.5 * (square - product(e, AWAY, AWAY, n)) / e[0, AWAY]
        c[n, DEPTH] = -e[n, AWAY]
    for k in range(3):
        lag = e[n, EDGE_Z + k]
        if n > 0:
            lag -= product(e, AWAY, TO_Z + k, n) + e[n, AWAY] * e[0, TO_Z + k]
        e[n, TO_Z + k] = lag / e[0, AWAY]
    c[n, PUSH] = parts.stiff[i] * c[n, DEPTH]
    if kind >= OUTER_CLEAR:
        c[n, FZ] = c[n, FT] = c[n, RUB_R] = c[n, RUB_Q] = c[n, SPIN] = c[n, LEAN] = c[n, SLIDE] = 0.0
    else:
        slide(p, parts, i, now, n)
        press_edge(p, c, e, n)


@inlined_kernel
def slide(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of the sliding of the ball's surface on the edge: h O x n - v + (v n) n."""
    e, ball = parts.rim[i], parts.ball[i // 2]
    closing = 0.0
    for m in range(n + 1):
        closing += ball[m, CZ] * e[n - m, TO_Z] + ball[m, CR] * e[n - m, TO_R] + ball[m, CT] * e[n - m, TO_T]
    e[n, CLOSING] = closing
    z, r, t = now.share * e[n, TO_Z], now.share * e[n, TO_R], now.share * e[n, TO_T]
    if n > 0:
        z, r, t = (
            z + now.rise * e[n - 1, TO_Z],
            r + now.rise * e[n - 1, TO_R],
            t + now.rise * e[n - 1, TO_T],
        )
    e[n, SLIP_Z] = p.spin_r * t - p.spin_t * r - ball[n, CZ] + whole(e, CLOSING, TO_Z, n)
    e[n, SLIP_R] = p.spin_t * z - p.spin_z * t - ball[n, CR] + whole(e, CLOSING, TO_R, n)
    e[n, SLIP_T] = p.spin_z * r - p.spin_r * z - ball[n, CT] + whole(e, CLOSING, TO_T, n)


@inlined_kernel
def press_edge(p: Numbers, c: Array, e: Array, n: int) -> None:
    """Coefficient n of force and friction of an edge, in the directions and about the axes of the pocket."""
    square = whole(e, SLIP_Z, SLIP_Z, n) + whole(e, SLIP_R, SLIP_R, n) + whole(e, SLIP_T, SLIP_T, n)
    if n == 0:
        c[0, SLIDE] = math.sqrt(square + p.pivoting)
        c[0, SHARE] = p.friction * c[0, PUSH] / c[0, SLIDE]
    else:
        c[n, SLIDE] = 0.5 * (square - product(c, SLIDE, SLIDE, n)) / c[0, SLIDE]
        lag = product(c, SLIDE, SHARE, n) + c[n, SLIDE] * c[0, SHARE]
        c[n, SHARE] = (p.friction * c[n, PUSH] - lag) / c[0, SLIDE]
    for k in range(3):
        rub = push = 0.0
        for m in range(n + 1):
            rub += c[m, SHARE] * e[n - m, SLIP_Z + k]
            push += c[m, PUSH] * e[n - m, TO_Z + k]
        e[n, RIM_Z + k] = rub
        if k == 0:
            c[n, FZ] = push + rub
        elif k == 1:
            c[n, RUB_R] = push + rub
        else:
            c[n, FT] = push + rub
    c[n, SPIN] = whole(e, TO_R, RIM_T, n) - whole(e, TO_T, RIM_R, n)
    c[n, RUB_Q] = whole(e, TO_Z, RIM_T, n) - whole(e, TO_T, RIM_Z, n)
    c[n, LEAN] = whole(e, TO_Z, RIM_R, n) - whole(e, TO_R, RIM_Z, n)
