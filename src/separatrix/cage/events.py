"""What ends a step: a pocket leaves its ball or meets one (in `land_events`: the land's mode changes)."""

from __future__ import annotations

import numpy as np

from separatrix.cage.series import (
    AT_END,
    EARLY,
    EARLY_BOUND,
    FALLS,
    LATE,
    LATE_BOUND,
    ORDER,
    ROUNDING,
    STAYS,
    THIRD,
    copy_column,
    earliest_zero,
    falling,
    grip_at,
    knots,
    top,
    value,
)
from separatrix.cage.slots import (
    BALLS,
    COSINE,
    DRIVE,
    ES,
    EX,
    EY,
    FELT,
    GONE,
    GX,
    GY,
    KEPT,
    LEAD,
    LIST,
    PENETRATION,
    PLAY,
    SIDE,
    SINE,
    S,
    X,
    Y,
)
from separatrix.compiled import inlined_kernel, inner_kernel

GRAINS = 8.0
"""A pocket lets go of its ball this many roundings of its place after their force is gone: a cage that comes
to rest would else touch and leave without end, at forces of some 1e-11 N."""

CHANGE, BALL, EARLY_HALF, LATE_HALF, GUESS, NOISE, START, RISE, MIDDLE, TURN, LAST, FALL = range(12)
"""Columns of a queue: what may happen (0 the ball is left, 1 and -1 met on that side), to which ball, what is
known of each half of the step, about when, and the knots."""

QUEUE = 12  # columns


NOTHING, PART, TOUCH, LAND_TOUCH, LAND_CLEAR, LAND_PRESS, LAND_LEAVE, SLIDE_STOP, SLIDE_START = range(9)


@inner_kernel
def penetration(p, pockets, w, j, c):  # type: ignore[no-untyped-def]
    """Series of the penetration of a pocket in touch."""
    if p.hertz != 0.0:
        copy_column(w, BALLS + j, c)
        return
    for n in range(1, ORDER + 1):
        c[n] = (
            pockets[PENETRATION, j] * w[n, KEPT]
            + pockets[COSINE, j] * w[n, EY]
            - pockets[SINE, j] * w[n, EX]
            + w[n, ES]
        )
    for k in range(2 * p.harmonics):
        for n in range(1, ORDER + 1):
            c[n] -= pockets[DRIVE + k, j] * w[n, FELT + k]
    c[0] = pockets[PENETRATION, j]


@inlined_kernel
def larger(a, b):  # type: ignore[no-untyped-def]
    """Larger of two numbers, without a branch."""
    return a if a > b else b


@inlined_kernel
def smaller(a, b):  # type: ignore[no-untyped-def]
    """Smaller of two numbers, without a branch."""
    return a if a < b else b


@inlined_kernel
def held(knot, row, q, cos, sin):  # type: ignore[no-untyped-def]
    """What the penetration of a linear pocket in touch is, or does, at a knot."""
    return q * knot[row, KEPT] + cos * knot[row, EY] - sin * knot[row, EX] + knot[row, ES]


@inlined_kernel
def fourths(w, a, b, c, most):  # type: ignore[no-untyped-def]
    """Bound, in each half of the step, of the fourth derivative of what any pocket makes of three columns.

    With `most` times the column of what is kept of a penetration.
    """
    early = late = 0.0
    for n in range(4, ORDER + 1):
        size = abs(w[n, a]) + abs(w[n, b]) + abs(w[n, c])
        if most > 0.0:
            size += most * abs(w[n, KEPT])
        early += EARLY[n] * size
        late += LATE[n] * size
    return early, late


@inlined_kernel
def learn_ways(w, first, waves, knot):  # type: ignore[no-untyped-def]
    """Knots of the ways that balls go by the forms of their free speeds, and bounds of what bends them."""
    knots(w, first, first + waves, knot)
    for k in range(first, first + waves):
        early = late = 0.0
        for n in range(4, ORDER + 1):
            early, late = early + EARLY[n] * abs(w[n, k]), late + LATE[n] * abs(w[n, k])
        knot[EARLY_BOUND, k], knot[LATE_BOUND, k] = early, late


@inlined_kernel
def gone(pockets, knot, row, first, waves, j):  # type: ignore[no-untyped-def]
    """How far ball j has gone at a knot by its free speed, or how fast it goes."""
    total = 0.0
    for k in range(waves):
        total += pockets[DRIVE + k, j] * knot[row, first + k]
    return total


@inlined_kernel
def bends(pockets, knot, row, first, waves, j):  # type: ignore[no-untyped-def]
    """Bound of the fourth derivative of that way in one half of the step."""
    total = 0.0
    for k in range(waves):
        total += abs(pockets[DRIVE + k, j]) * knot[row, first + k]
    return total


@inlined_kernel
def enqueue(queue, filled, change, ball, at, off, late_off, noise):  # type: ignore[no-untyped-def]
    """Queue what may fall to zero, by its knots; return how many are queued."""
    start, rise, middle, turn, last, fall = at
    tiny = ROUNDING * noise
    early = falling(start, rise, middle, turn, off, tiny)
    late = falling(middle, turn, last, fall, late_off, tiny)
    if early == STAYS and late == STAYS:
        return filled
    row = queue[filled]
    row[CHANGE], row[BALL], row[EARLY_HALF], row[LATE_HALF], row[NOISE] = change, ball, early, late, noise
    row[START], row[RISE], row[MIDDLE], row[TURN], row[LAST], row[FALL] = at
    row[GUESS] = 1.0
    if early == FALLS:
        row[GUESS] = 0.5 * start / (start - middle)
    elif early == STAYS and late == FALLS:
        row[GUESS] = 0.5 + 0.5 * middle / (middle - last)
    return filled + 1


@inlined_kernel
def leave_balls(p, pockets, touch, w, count, alike, knot, queue):  # type: ignore[no-untyped-def]
    """Queue the pockets that may leave their balls; return how many, and the most depth."""
    filled, deepest, waves = 0, 0.0, 2 * p.harmonics
    off = late_off = most = 0.0
    if alike:
        learn_ways(w, FELT, waves, knot)
        knots(w, EX, KEPT + 1, knot)
        for i in range(count):
            most = larger(most, abs(pockets[PENETRATION, touch[LIST, i]]))
        off, late_off = fourths(w, EX, EY, ES, most)
    size = abs(w[0, S]) + abs(w[0, X]) + abs(w[0, Y])
    for i in range(count):
        j = touch[LIST, i]
        q, cos, sin = pockets[PENETRATION, j], pockets[COSINE, j], pockets[SINE, j]
        sign, noise = float(touch[SIDE, j]), size + pockets[PLAY, j]
        grip = GRAINS * ROUNDING * noise - p.onset
        start = sign * q + grip
        if not alike:
            filled = enqueue(queue, filled, 0, j, (start, 0.0, start, 0.0, start, 0.0), np.inf, np.inf, noise)
            continue
        rise, middle = sign * held(knot, 0, q, cos, sin), sign * held(knot, 1, q, cos, sin) + grip
        turn, last = sign * held(knot, 2, q, cos, sin), sign * held(knot, 3, q, cos, sin) + grip
        fall, early, late = sign * held(knot, 4, q, cos, sin), off, late_off
        if waves > 0:
            rise -= sign * gone(pockets, knot, 0, FELT, waves, j)
            middle -= sign * gone(pockets, knot, 1, FELT, waves, j)
            turn -= sign * gone(pockets, knot, 2, FELT, waves, j)
            last -= sign * gone(pockets, knot, 3, FELT, waves, j)
            fall -= sign * gone(pockets, knot, 4, FELT, waves, j)
            early += bends(pockets, knot, EARLY_BOUND, FELT, waves, j)
            late += bends(pockets, knot, LATE_BOUND, FELT, waves, j)
        deepest = larger(deepest, top(start, rise, middle, turn, early))
        deepest = larger(deepest, top(middle, turn, last, fall, late))
        at = (start, rise, middle, turn, last, fall)
        filled = enqueue(queue, filled, 0, j, at, early, late, noise)
    return filled, deepest if alike else np.inf


@inlined_kernel
def knots_of(w, gx, gy, knot):  # type: ignore[no-untyped-def]
    """Centre and slip at the knots: their values at the start, then slope, value, slope, value, slope."""
    return (
        (w[0, gx], w[0, gy], w[0, S]),
        (knot[0, gx], knot[0, gy], knot[0, S]),
        (knot[1, gx], knot[1, gy], knot[1, S]),
        (knot[2, gx], knot[2, gy], knot[2, S]),
        (knot[3, gx], knot[3, gy], knot[3, S]),
        (knot[4, gx], knot[4, gy], knot[4, S]),
    )


@inlined_kernel
def place_at(cos, sin, moved):  # type: ignore[no-untyped-def]
    """How far a pocket lies along the circumference by centre and slip, or how fast it moves."""
    x, y, s = moved
    return cos * y - sin * x + s


@inlined_kernel
def places_of(pockets, j, at, knot, waves):  # type: ignore[no-untyped-def]
    """Place of a pocket against its ball at the knots."""
    cos, sin, lead = pockets[COSINE, j], pockets[SINE, j], pockets[LEAD, j]
    start, rise = place_at(cos, sin, at[0]) - lead, place_at(cos, sin, at[1])
    middle, turn = place_at(cos, sin, at[2]) - lead, place_at(cos, sin, at[3])
    last, fall = place_at(cos, sin, at[4]) - lead, place_at(cos, sin, at[5])
    if waves > 0:
        rise -= gone(pockets, knot, 0, GONE, waves, j)
        middle -= gone(pockets, knot, 1, GONE, waves, j)
        turn -= gone(pockets, knot, 2, GONE, waves, j)
        last -= gone(pockets, knot, 3, GONE, waves, j)
        fall -= gone(pockets, knot, 4, GONE, waves, j)
    return start, rise, middle, turn, last, fall


@inlined_kernel
def farthest_way(p, w, gx, gy, h):  # type: ignore[no-untyped-def]
    """Bound of the way of any pocket against its ball within a step of length `h`."""
    way = p.driven * h
    for n in range(1, ORDER + 1):
        way += abs(w[n, gx]) + abs(w[n, gy]) + abs(w[n, S])
    return way * (1.0 + 1e-9)


@inlined_kernel
def may_reach(pockets, at, way, beyond):  # type: ignore[no-untyped-def]
    """By how much every pocket may pass its play at most, by its way; return whether any may."""
    any_may = False
    for j in range(pockets.shape[1]):
        place = place_at(pockets[COSINE, j], pockets[SINE, j], at[0]) - pockets[LEAD, j]
        beyond[j] = abs(place) + way - pockets[PLAY, j]
        any_may |= beyond[j] >= 0.0
    return any_may


@inlined_kernel
def reach_balls(pockets, at, knot, off, late_off, beyond):  # type: ignore[no-untyped-def]
    """By how much every pocket may pass its play at most, by its cubics and what lies off them."""
    for j in range(pockets.shape[1]):
        start, rise, middle, turn, last, fall = places_of(pockets, j, at, knot, 0)
        one, two = start + THIRD * rise, middle - THIRD * turn
        three, four = middle + THIRD * turn, last - THIRD * fall
        high = larger(larger(larger(start, one), larger(two, three)), larger(four, last))
        low = smaller(smaller(smaller(start, one), smaller(two, three)), smaller(four, last))
        beyond[j] = larger(high, -low) + larger(off, late_off) / 384.0 - pockets[PLAY, j]


@inlined_kernel
def meet_balls(p, pockets, touch, w, h, gx, gy, alike, knot, off, late_off, beyond, queue, filled):  # type: ignore[no-untyped-def]
    """Queue the pockets that may meet their balls; return how many are queued."""
    at, waves = knots_of(w, gx, gy, knot), 2 * p.harmonics
    if not alike:
        off = late_off = np.inf
    if waves == 0:
        reach_balls(pockets, at, knot, off, late_off, beyond)
    elif may_reach(pockets, at, farthest_way(p, w, gx, gy, h), beyond):
        learn_ways(w, GONE, waves, knot)
    else:
        return filled
    size = abs(w[0, S]) + abs(w[0, gx]) + abs(w[0, gy])
    for j in range(pockets.shape[1]):
        if touch[SIDE, j] != 0 or beyond[j] < p.onset:
            continue
        lead, play = pockets[LEAD, j], pockets[PLAY, j] + p.onset
        noise = size + abs(lead)
        a, b, c, d, e, f = places_of(pockets, j, at, knot, waves)
        early, late = off, late_off
        if waves > 0:
            early += bends(pockets, knot, EARLY_BOUND, GONE, waves, j)
            late += bends(pockets, knot, LATE_BOUND, GONE, waves, j)
        for sign in (1.0, -1.0):
            gap = (play - sign * a, -sign * b, play - sign * c, -sign * d, play - sign * e, -sign * f)
            filled = enqueue(queue, filled, sign, j, gap, early, late, noise)
    return filled


@inner_kernel
def way(p, pockets, w, gx, gy, j, c):  # type: ignore[no-untyped-def]
    """Series of the way of a pocket against its ball, which it does not touch."""
    for n in range(1, ORDER + 1):
        c[n] = w[n, gy] * pockets[COSINE, j] - w[n, gx] * pockets[SINE, j] + w[n, S]
    for k in range(2 * p.harmonics):
        for n in range(1, ORDER + 1):
            c[n] -= pockets[DRIVE + k, j] * w[n, GONE + k]


@inner_kernel
def first_change(p, pockets, touch, w, gx, gy, queue, filled, c, knot):  # type: ignore[no-untyped-def]
    """Earliest of what is queued: its time, what happens, and to which ball."""
    end, kind, ball, waves = 1.0, NOTHING, -1, 2 * p.harmonics
    first, known = 0, False
    x = y = s = ex = ey = es = kept = 0.0
    for i in range(1, filled):
        if queue[i, GUESS] < queue[first, GUESS]:
            first = i
    for n in range(filled):
        row = queue[first if n == 0 else n - 1 if n <= first else n]
        early, late, j, noise = int(row[EARLY_HALF]), int(row[LATE_HALF]), int(row[BALL]), row[NOISE]
        if early == STAYS and end <= 0.5:
            continue
        side = row[CHANGE]
        sign = float(touch[SIDE, j]) if side == 0.0 else -side
        if kind != NOTHING and ((early == FALLS and end <= 0.5) or (early == STAYS and late == FALLS)):
            if not known:
                known = True
                x, y, s = value(w, gx, end), value(w, gy, end), value(w, S, end)
                ex, ey, es, kept = grip_at(w, end)
                for k in range(waves):
                    knot[AT_END, FELT + k], knot[AT_END, GONE + k] = (
                        value(w, FELT + k, end),
                        value(w, GONE + k, end),
                    )
            cos, sin = pockets[COSINE, j], pockets[SINE, j]
            if side == 0.0:
                q = pockets[PENETRATION, j]
                left = row[START] + sign * (q * (kept - 1.0) + cos * ey - sin * ex + es)
                left -= sign * gone(pockets, knot, AT_END, FELT, waves, j)
            else:
                left = pockets[PLAY, j] + p.onset + sign * (cos * y - sin * x + s - pockets[LEAD, j])
                left -= sign * gone(pockets, knot, AT_END, GONE, waves, j)
            if left > 2.0 * ROUNDING * noise:
                continue
        if side == 0.0:
            penetration(p, pockets, w, j, c)
        else:
            way(p, pockets, w, gx, gy, j, c)
        at = (row[START], row[RISE], row[MIDDLE], row[TURN], row[LAST], row[FALL])
        t = earliest_zero(c, at, sign, early, late, end, noise)
        if t < end:
            end, kind, ball, known = t, PART if side == 0.0 else TOUCH, j, False
            if side < 0.0:
                ball = j + pockets.shape[1]
    return end, kind, ball


@inlined_kernel
def pocket_change(p, pockets, touch, w, h, count, knot, off, late_off, beyond, queue, c):  # type: ignore[no-untyped-def]
    """First time a pocket leaves its ball or meets one, what happens, to which ball, and the most depth."""
    if p.gripped:
        return 1.0, NOTHING, -1, np.inf
    alike = p.hertz == 0.0
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    filled, deepest = 0, 0.0
    if count > 0:
        filled, deepest = leave_balls(p, pockets, touch, w, count, alike, knot, queue)
    if count < pockets.shape[1]:
        filled = meet_balls(
            p, pockets, touch, w, h, gx, gy, alike, knot, off, late_off, beyond, queue, filled
        )
    if filled == 0:
        return 1.0, NOTHING, -1, deepest
    end, kind, ball = first_change(p, pockets, touch, w, gx, gy, queue, filled, c, knot)
    return end, kind, ball, deepest
