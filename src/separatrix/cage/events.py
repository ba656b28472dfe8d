"""What ends a step: a pocket leaves its ball or meets one, or the land's mode changes."""

from __future__ import annotations

import numpy as np

from separatrix.cage.land import land_geometry
from separatrix.cage.series import (
    EARLY,
    LATE,
    MAY_FALL,
    ROUNDING,
    SPARE,
    STAYS,
    copy_column,
    earliest_zero,
    falling,
    first_zero,
    knots,
    product,
    reach,
    top,
    travel,
)
from separatrix.cage.slots import (
    BALLS,
    CLEAR,
    COSINE,
    DEPTH,
    DRIVE,
    ES,
    EX,
    EY,
    FELT,
    FORWARD,
    GONE,
    GX,
    GY,
    KEPT,
    LEAD,
    LIST,
    NORMAL,
    PENETRATION,
    PLAY,
    RELEASED,
    SIDE,
    SINE,
    SLIDING,
    STICK,
    TANGENT,
    VX,
    VY,
    S,
    W,
    X,
    Y,
)
from separatrix.compiled import inlined_kernel, inner_kernel

GRAINS = 8.0
"""A pocket lets go of its ball this many roundings of its place after their force is gone: a cage that comes
to rest would else touch and leave without end, at forces of some 1e-11 N."""

NOTHING, PART, TOUCH, LAND_TOUCH, LAND_CLEAR, LAND_PRESS, LAND_LEAVE, SLIDE_STOP, SLIDE_START = range(9)


@inner_kernel
def penetration(p, pockets, w, j, c):  # type: ignore[no-untyped-def]
    """Series of the penetration of a pocket in touch."""
    order = w.shape[0] - SPARE
    if p.hertz != 0.0:
        copy_column(w, BALLS + j, c)
        return
    for n in range(1, order + 1):
        c[n] = (
            pockets[PENETRATION, j] * w[n, KEPT]
            + pockets[COSINE, j] * w[n, EY]
            - pockets[SINE, j] * w[n, EX]
            + w[n, ES]
        )
    for k in range(2 * p.harmonics):
        for n in range(1, order + 1):
            c[n] -= pockets[DRIVE + k, j] * w[n, FELT + k]
    c[0] = pockets[PENETRATION, j]


@inlined_kernel
def held(knot, row, q, cos, sin):  # type: ignore[no-untyped-def]
    """What the penetration of a linear pocket in touch is, or does, at a knot."""
    return q * knot[row, KEPT] + cos * knot[row, EY] - sin * knot[row, EX] + knot[row, ES]


@inlined_kernel
def free(knot, row, gx, gy, cos, sin):  # type: ignore[no-untyped-def]
    """What the place of a pocket that is not in touch is, or does, at a knot."""
    return cos * knot[row, gy] - sin * knot[row, gx] + knot[row, S]


@inlined_kernel
def fourths(w, a, b, c, most):  # type: ignore[no-untyped-def]
    """Bound, in each half of the step, of the fourth derivative of what any pocket makes of three columns.

    With `most` times the column of what is kept of a penetration.
    """
    order = w.shape[0] - SPARE
    early = late = 0.0
    for n in range(4, order + 1):
        size = abs(w[n, a]) + abs(w[n, b]) + abs(w[n, c])
        if most > 0.0:
            size += most * abs(w[n, KEPT])
        early += EARLY[n] * size
        late += LATE[n] * size
    return early, late


@inlined_kernel
def leave_balls(p, pockets, touch, w, count, alike, knot, c):  # type: ignore[no-untyped-def]
    """Earliest time at which a pocket leaves its ball, what happens, to which ball, and the most depth."""
    end, kind, ball, deepest = 1.0, NOTHING, -1, 0.0
    off = late_off = most = 0.0
    if alike:
        for column in (EX, EY, ES, KEPT):
            knots(w, column, knot)
        for i in range(count):
            most = max(most, abs(pockets[PENETRATION, touch[LIST, i]]))
        off, late_off = fourths(w, EX, EY, ES, most)
    for i in range(count):
        j = touch[LIST, i]
        q, cos, sin, sign = (
            pockets[PENETRATION, j],
            pockets[COSINE, j],
            pockets[SINE, j],
            float(touch[SIDE, j]),
        )
        noise = abs(w[0, S]) + abs(w[0, X]) + abs(w[0, Y]) + pockets[PLAY, j]
        tiny, grip = ROUNDING * noise, GRAINS * ROUNDING * noise - p.onset
        start, early, late = sign * q + grip, MAY_FALL, MAY_FALL
        rise = turn = fall = 0.0
        middle = last = start
        if alike:
            rise, middle = sign * held(knot, 0, q, cos, sin), sign * held(knot, 1, q, cos, sin) + grip
            turn, last = sign * held(knot, 2, q, cos, sin), sign * held(knot, 3, q, cos, sin) + grip
            fall = sign * held(knot, 4, q, cos, sin)
            early = falling(start, rise, middle, turn, off, tiny)
            late = falling(middle, turn, last, fall, late_off, tiny)
            deepest = max(deepest, top(start, rise, middle, turn, off))
            deepest = max(deepest, top(middle, turn, last, fall, late_off))
        if early == STAYS and (late == STAYS or end <= 0.5):
            continue
        penetration(p, pockets, w, j, c)
        t = earliest_zero(c, (start, rise, middle, turn, last, fall), sign, early, late, end, noise)
        if t < end:
            end, kind, ball = t, PART, j
    return end, kind, ball, deepest if alike else np.inf


@inlined_kernel
def meet_balls(p, pockets, touch, w, gx, gy, alike, knot, c, end, kind, ball):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if a pocket meets its ball before, what it is, and of which ball."""
    off = late_off = 0.0
    most = np.inf
    if alike:
        for column in (gx, gy, S):
            knots(w, column, knot)
        off, late_off = fourths(w, gx, gy, S, 0.0)
        most = reach(w[0, gx], knot, gx) + reach(w[0, gy], knot, gy) + reach(w[0, S], knot, S)
        most += max(off, late_off) / 384.0
    for j in range(pockets.shape[1]):
        cos, sin, play = pockets[COSINE, j], pockets[SINE, j], pockets[PLAY, j] + p.onset
        u = w[0, gy] * cos - w[0, gx] * sin + w[0, S] - pockets[LEAD, j]
        if touch[SIDE, j] != 0 or abs(u) + most < play:
            continue
        noise = abs(w[0, S]) + abs(pockets[LEAD, j]) + abs(w[0, gx]) + abs(w[0, gy])
        tiny, ready = ROUNDING * noise, False
        rise = turn = fall = 0.0
        middle, last, high, low = u, u, np.inf, -np.inf
        if alike:
            rise, turn = free(knot, 0, gx, gy, cos, sin), free(knot, 2, gx, gy, cos, sin)
            middle = free(knot, 1, gx, gy, cos, sin) - pockets[LEAD, j]
            last, fall = free(knot, 3, gx, gy, cos, sin) - pockets[LEAD, j], free(knot, 4, gx, gy, cos, sin)
            high = max(top(u, rise, middle, turn, off), top(middle, turn, last, fall, late_off))
            low = -max(top(-u, -rise, -middle, -turn, off), top(-middle, -turn, -last, -fall, late_off))
        for sign in (1.0, -1.0):
            if high < play if sign > 0.0 else low > -play:
                continue
            early = late = MAY_FALL
            start, half, whole = play - sign * u, play - sign * middle, play - sign * last
            if alike:
                early = falling(start, -sign * rise, half, -sign * turn, off, tiny)
                late = falling(half, -sign * turn, whole, -sign * fall, late_off, tiny)
            if early == STAYS and (late == STAYS or end <= 0.5):
                continue
            if not ready:
                way(p, pockets, w, gx, gy, j, c)
                ready = True
            at = (start, -sign * rise, half, -sign * turn, whole, -sign * fall)
            t = earliest_zero(c, at, -sign, early, late, end, noise)
            if t < end:
                end, kind, ball = t, TOUCH, (j if sign > 0.0 else j + pockets.shape[1])
    return end, kind, ball


@inner_kernel
def way(p, pockets, w, gx, gy, j, c):  # type: ignore[no-untyped-def]
    """Series of the way of a pocket against its ball, which it does not touch."""
    order = w.shape[0] - SPARE
    for n in range(1, order + 1):
        c[n] = w[n, gy] * pockets[COSINE, j] - w[n, gx] * pockets[SINE, j] + w[n, S]
    for k in range(2 * p.harmonics):
        for n in range(1, order + 1):
            c[n] -= pockets[DRIVE + k, j] * w[n, GONE + k]


@inlined_kernel
def pocket_change(p, pockets, touch, w, count, knot, c):  # type: ignore[no-untyped-def]
    """First time a pocket leaves its ball or meets one, what happens, to which ball, and the most depth."""
    if p.gripped:
        return 1.0, NOTHING, -1, np.inf
    alike = p.hertz == 0.0 and p.harmonics == 0
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    end, kind, ball, deepest = 1.0, NOTHING, -1, 0.0
    if count > 0:
        end, kind, ball, deepest = leave_balls(p, pockets, touch, w, count, alike, knot, c)
    if count < pockets.shape[1]:
        end, kind, ball = meet_balls(p, pockets, touch, w, gx, gy, alike, knot, c, end, kind, ball)
    return end, kind, ball, deepest


@inner_kernel
def land_change(p, w, land, h, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the land's comes first, and what it is."""
    order = w.shape[0] - SPARE
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    if land == CLEAR:
        return meet_land(p, w, gx, gy, end, kind, c)
    if land == RELEASED:
        return return_land(p, w, gx, gy, h, end, kind, c)
    copy_column(w, NORMAL, c)
    t = first_zero(c, max(0.0, c[0]), 1.0, end, p.land_stiffness * p.land_gap)
    if t < end:
        end, kind = t, LAND_LEAVE
    if land == STICK:
        sign = 1.0 if w[0, TANGENT] >= 0.0 else -1.0
        for n in range(order + 1):
            c[n] = p.land_friction * w[n, NORMAL] - sign * w[n, TANGENT]
        t = first_zero(c, max(0.0, c[0]), 1.0, end, p.land_stiffness * p.land_gap)
        return (t, SLIDE_START) if t < end else (end, kind)
    sign = 1.0 if land == FORWARD else -1.0
    copy_column(w, SLIDING, c)
    # The force is a difference of places of the size of the gap, and moves the sliding by as much rounding.
    noise = abs(w[0, VX]) + abs(w[0, VY]) + abs(w[0, W]) + abs(p.ring_slide)
    noise += h * p.land_stiffness * p.land_gap * (1.0 + p.swiftness)
    t = first_zero(c, max(0.0, sign * c[0]), sign, end, noise)
    return (t, SLIDE_STOP) if t < end else (end, kind)


@inlined_kernel
def meet_land(p, w, gx, gy, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the cage meets its land before, and what it is."""
    order = w.shape[0] - SPARE
    near = np.sqrt(w[0, gx] ** 2 + w[0, gy] ** 2)
    if near + travel(w, gx) + travel(w, gy) < p.land_gap - abs(p.roundness):
        return end, kind
    if p.roundness == 0.0:
        for n in range(order + 1):
            c[n] = product(w, gx, gx, n) + product(w, gy, gy, n)
        t = first_zero(c, (p.land_gap - near) * (p.land_gap + near), -1.0, end, p.land_gap**2)
    else:
        for n in range(order + 1):
            land_geometry(p, w, gx, gy, n)
        copy_column(w, DEPTH, c)
        t = first_zero(c, -c[0], -1.0, end, p.land_gap)
    return (t, LAND_TOUCH) if t < end else (end, kind)


@inner_kernel
def return_land(p, w, gx, gy, h, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if a cage pushed off leaves its land, or is pressed again, before."""
    order = w.shape[0] - SPARE
    for n in range(order + 1):
        land_geometry(p, w, gx, gy, n)
    copy_column(w, DEPTH, c)
    t = first_zero(c, c[0], 1.0, end, p.land_gap)
    if t < end:
        end, kind = t, LAND_CLEAR
    for n in range(order):
        c[n] = p.land_stiffness * w[n, DEPTH] + p.land_damping / h * (n + 1) * w[n + 1, DEPTH]
    c[order] = 0.0
    t = first_zero(c, max(0.0, -c[0]), -1.0, end, p.land_stiffness * p.land_gap)
    return (t, LAND_PRESS) if t < end else (end, kind)
