r"""What ends a step: a pocket leaves its ball or meets one (`land`: the mode of the land changes).

The place of pocket j against its ball is :math:`u_j = r\cdot e_t + s - y_j`; it meets the ball where
:math:`|u_j| = c_p`, and leaves it where its penetration :math:`q_j` is back at zero. Both are known at the
knots of a step from those of a few series, so that most are seen to stay without being followed.
"""

from __future__ import annotations

import numpy as np

from separatrix.cage.features import harmonics, has_hertz_pockets, has_inertia, has_own_series, is_gripped
from separatrix.cage.law import learn_ways
from separatrix.cage.records import (
    AT_END,
    EARLY_BOUND,
    LATE_BOUND,
    ORDER,
    Balls,
    Candidate,
    Coefficients,
    Room,
    Series,
    State,
)
from separatrix.cage.series import (
    FALLS,
    ROUNDING,
    STAYS,
    THIRD,
    Knots,
    Place,
    bends,
    centre,
    copy_column,
    earliest_zero,
    falling,
    fourths,
    gone_at,
    grip_at,
    knots,
    larger,
    smaller,
    top,
    value,
)
from separatrix.cage.traction import own_left_at, subtract_way, way_knots
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

GRAINS = 8.0
"""A pocket leaves its ball this many roundings of its place after their force is gone: a cage that comes to
rest would else touch and leave without end, at forces of some 1e-11 N."""

NOTHING, PART, TOUCH, LAND_TOUCH, LAND_CLEAR, LAND_PRESS, LAND_LEAVE, SLIDE_STOP, SLIDE_START = range(9)


@inlined_kernel
def penetration(p: Coefficients, balls: Balls, w: Series, j: int, c: Array) -> None:
    """Series of the penetration of a pocket in touch."""
    if has_own_series(p):
        copy_column(balls.depth[:, j], c)
        return
    # q_j(t) = q_j(0) e(t) + E_y cos phi_j - E_x sin phi_j + E_s - sum_k V_jk felt_k
    q, cos, sin = balls.penetration[j], balls.cosine[j], balls.sine[j]
    for n in range(1, ORDER + 1):
        c[n] = q * w[n].kept + cos * w[n].ey - sin * w[n].ex + w[n].es
    for k in range(2 * harmonics(p)):
        for n in range(1, ORDER + 1):
            c[n] -= balls.drive[k, j] * w[n].felt[k]
    c[0] = q


@inlined_kernel
def way(p: Coefficients, balls: Balls, w: Series, j: int, c: Array) -> None:
    """Series of the way of a pocket against its ball, which it does not touch."""
    # u_j(t) - u_j(0) = y cos phi_j - x sin phi_j + s - sum_k V_jk gone_k
    gx, gy = centre(p, w)
    for n in range(1, ORDER + 1):
        c[n] = gy[n] * balls.cosine[j] - gx[n] * balls.sine[j] + w[n].s
    for k in range(2 * harmonics(p)):
        for n in range(1, ORDER + 1):
            c[n] -= balls.drive[k, j] * w[n].gone[k]
    if has_inertia(p):
        subtract_way(balls, j, c)


@inlined_kernel
def held(q: float, cos: float, sin: float, ex: float, ey: float, es: float, kept: float) -> float:
    """What the penetration of a linear pocket in touch is, or does, at a knot."""
    return q * kept + cos * ey - sin * ex + es


@inlined_kernel
def learn_wave(c: Array, k: int, waves: Array) -> None:
    """Knots of the way that balls go by one wave of their free speeds, and bounds of what bends it."""
    waves[0, k], waves[1, k], waves[2, k], waves[3, k], waves[4, k], waves[5, k] = knots(c)
    waves[EARLY_BOUND, k], waves[LATE_BOUND, k] = bends(c)


@inlined_kernel
def bend_of(p: Coefficients, balls: Balls, bound: Array, j: int) -> float:
    """Bound of the fourth derivative of that way in one half of the step."""
    total = 0.0
    for k in range(2 * harmonics(p)):
        total += abs(balls.drive[k, j]) * bound[k]
    return total


@inlined_kernel
def enqueue(
    room: Room, filled: int, change: int, ball: int, at: Knots, off: float, late_off: float, noise: float
) -> int:
    """Queue what may fall to zero, by its knots; return how many are queued."""
    start, rise, middle, turn, last, fall = at
    tiny = ROUNDING * noise
    early = falling(start, rise, middle, turn, off, tiny)
    late = falling(middle, turn, last, fall, late_off, tiny)
    if early == STAYS and late == STAYS:
        return filled
    row = room.queue[filled]
    row.change, row.ball, row.early_half, row.late_half, row.noise = change, ball, early, late, noise
    row.start, row.rise, row.middle, row.turn, row.last, row.fall = at
    row.guess = 1.0
    if early == FALLS:
        row.guess = 0.5 * start / (start - middle)
    elif early == STAYS and late == FALLS:
        row.guess = 0.5 + 0.5 * middle / (middle - last)
    return filled + 1


@inlined_kernel
def leave_balls(p: Coefficients, balls: Balls, w: Series, count: int, room: Room) -> tuple[int, float]:
    """Queue the pockets that may leave their balls; return how many, and the largest penetration."""
    filled, deepest, most, waves = 0, 0.0, 0.0, 2 * harmonics(p)
    size = abs(w[0].s) + abs(w[0].x) + abs(w[0].y)
    if has_own_series(p):
        return leave_own(p, balls, count, size, room)
    ex, ey, es, kept = knots(w.ex), knots(w.ey), knots(w.es), knots(w.kept)
    for k in range(waves):
        learn_wave(w.felt[:, k], k, room.felt)
    for i in range(count):
        most = larger(most, abs(balls.penetration[balls.touching[i]]))
    off, late_off = fourths(w.ex, w.ey, w.es, w.kept, most)
    for i in range(count):
        j = balls.touching[i]
        q, cos, sin = balls.penetration[j], balls.cosine[j], balls.sine[j]
        sign, noise = float(balls.side[j]), size + balls.play[j]
        grip = GRAINS * ROUNDING * noise
        start = sign * q + grip
        rise = sign * held(q, cos, sin, ex[1], ey[1], es[1], kept[1])
        middle = sign * held(q, cos, sin, ex[2], ey[2], es[2], kept[2]) + grip
        turn = sign * held(q, cos, sin, ex[3], ey[3], es[3], kept[3])
        last = sign * held(q, cos, sin, ex[4], ey[4], es[4], kept[4]) + grip
        fall = sign * held(q, cos, sin, ex[5], ey[5], es[5], kept[5])
        early, late = off, late_off
        if waves > 0:
            rise -= sign * gone_at(p, balls, room.felt[1], j)
            middle -= sign * gone_at(p, balls, room.felt[2], j)
            turn -= sign * gone_at(p, balls, room.felt[3], j)
            last -= sign * gone_at(p, balls, room.felt[4], j)
            fall -= sign * gone_at(p, balls, room.felt[5], j)
            early += bend_of(p, balls, room.felt[EARLY_BOUND], j)
            late += bend_of(p, balls, room.felt[LATE_BOUND], j)
        most = larger(top(start, rise, middle, turn, early), top(middle, turn, last, fall, late))
        room.depths[i], deepest = most, larger(deepest, most)
        at = (start, rise, middle, turn, last, fall)
        filled = enqueue(room, filled, 0, j, at, early, late, noise)
    return filled, deepest


@inner_kernel
def leave_own(p: Coefficients, balls: Balls, count: int, size: float, room: Room) -> tuple[int, float]:
    """Queue the pockets with series of their own that may leave; how many, and the largest penetration."""
    filled, deepest, c = 0, 0.0, room.c
    for i in range(count):
        j = balls.touching[i]
        sign, noise = float(balls.side[j]), size + balls.play[j]
        grip = GRAINS * ROUNDING * noise - p.onset
        start = sign * balls.penetration[j] + grip
        if has_hertz_pockets(p):
            at = (start, 0.0, start, 0.0, start, 0.0)
            filled, deepest = enqueue(room, filled, 0, j, at, np.inf, np.inf, noise), np.inf
            room.depths[i] = np.inf
            continue
        copy_column(balls.depth[:, j], c)
        _, b, d, e, f, g = knots(c)
        at = (start, sign * b, sign * d + grip, sign * e, sign * f + grip, sign * g)
        early, late = bends(c)
        most = larger(top(at[0], at[1], at[2], at[3], early), top(at[2], at[3], at[4], at[5], late))
        room.depths[i], deepest = most, larger(deepest, most)
        filled = enqueue(room, filled, 0, j, at, early, late, noise)
    return filled, deepest


@inlined_kernel
def place_at(cos: float, sin: float, x: float, y: float, s: float) -> float:
    """Place of a pocket along the circumference by centre and slip, or its speed."""
    return cos * y - sin * x + s


@inlined_kernel
def places_of(balls: Balls, j: int, x: Knots, y: Knots, s: Knots) -> Knots:
    """Place of a pocket against its ball at the knots, but for its ball's free speed."""
    cos, sin, lead = balls.cosine[j], balls.sine[j], balls.lead[j]
    start, rise = place_at(cos, sin, x[0], y[0], s[0]) - lead, place_at(cos, sin, x[1], y[1], s[1])
    middle, turn = place_at(cos, sin, x[2], y[2], s[2]) - lead, place_at(cos, sin, x[3], y[3], s[3])
    last, fall = place_at(cos, sin, x[4], y[4], s[4]) - lead, place_at(cos, sin, x[5], y[5], s[5])
    return start, rise, middle, turn, last, fall


@inlined_kernel
def farthest_way(p: Coefficients, w: Series, h: float) -> float:
    """Bound of the way of any pocket against its ball within a step of length `h`."""
    gx, gy = centre(p, w)
    total = p.driven * h
    for n in range(1, ORDER + 1):
        total += abs(gx[n]) + abs(gy[n]) + abs(w[n].s)
    return total * (1.0 + 1e-9)


@inlined_kernel
def may_reach(balls: Balls, x: float, y: float, s: float, most: float, beyond: Array) -> bool:
    """By how much every pocket may exceed its clearance at most, by its way; return whether any may."""
    any_may = False
    for j in range(balls.play.size):
        place = place_at(balls.cosine[j], balls.sine[j], x, y, s) - balls.lead[j]
        beyond[j] = abs(place) + most - balls.play[j]
        any_may |= beyond[j] >= 0.0
    return any_may


@inlined_kernel
def reach_balls(
    balls: Balls, x: Knots, y: Knots, s: Knots, off: float, late_off: float, beyond: Array
) -> None:
    """By how much every pocket may exceed its clearance at most, by its cubics and their error."""
    for j in range(balls.play.size):
        start, rise, middle, turn, last, fall = places_of(balls, j, x, y, s)
        one, two = start + THIRD * rise, middle - THIRD * turn
        three, four = middle + THIRD * turn, last - THIRD * fall
        high = larger(larger(larger(start, one), larger(two, three)), larger(four, last))
        low = smaller(smaller(smaller(start, one), smaller(two, three)), smaller(four, last))
        beyond[j] = larger(high, -low) + larger(off, late_off) / 384.0 - balls.play[j]


@inlined_kernel
def meet_balls(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    h: float,
    x: Knots,
    y: Knots,
    s: Knots,
    off: float,
    late_off: float,
    room: Room,
    filled: int,
) -> int:
    """Queue the pockets that may meet their balls; return how many are queued."""
    waves, inertial = 2 * harmonics(p), has_inertia(p)
    if has_hertz_pockets(p):
        off = late_off = np.inf
    if waves == 0:
        reach_balls(balls, x, y, s, off, late_off, room.beyond)
    elif may_reach(balls, x[0], y[0], s[0], farthest_way(p, w, h), room.beyond) or state.coasting > 0:
        for k in range(waves):
            learn_wave(w.gone[:, k], k, room.gone)
    else:
        return filled
    for i in range(state.coasting if inertial else 0):
        room.beyond[balls.coasting[i]] = np.inf
    if inertial and state.coasting > 0:
        learn_ways(balls.moving, state.touching, state.touching + state.coasting)
    size = abs(s[0]) + abs(x[0]) + abs(y[0])
    for j in range(balls.play.size):
        if balls.side[j] != 0 or room.beyond[j] < p.onset:
            continue
        lead, play = balls.lead[j], balls.play[j] + p.onset
        noise = size + abs(lead)
        a, b, c, d, e, f = places_of(balls, j, x, y, s)
        early, late = off, late_off
        if waves > 0:
            b -= gone_at(p, balls, room.gone[1], j)
            c -= gone_at(p, balls, room.gone[2], j)
            d -= gone_at(p, balls, room.gone[3], j)
            e -= gone_at(p, balls, room.gone[4], j)
            f -= gone_at(p, balls, room.gone[5], j)
            early += bend_of(p, balls, room.gone[EARLY_BOUND], j)
            late += bend_of(p, balls, room.gone[LATE_BOUND], j)
        if inertial and balls.own_speed[j] != 0.0:
            _, one, two, three, four, five, more, later = way_knots(balls, j)
            b, c, d, e, f = b - one, c - two, d - three, e - four, f - five
            early, late = early + more, late + later
        for side in (1, -1):
            sign = float(side)
            gap = (play - sign * a, -sign * b, play - sign * c, -sign * d, play - sign * e, -sign * f)
            filled = enqueue(room, filled, side, j, gap, early, late, noise)
    return filled


@inlined_kernel
def place_all(p: Coefficients, w: Series, t: float, room: Room) -> Place:
    """Centre, slip and what pockets in touch follow, at a time; the waves go into their row `AT_END`."""
    for k in range(2 * harmonics(p)):
        room.felt[AT_END, k] = value(w.felt[:, k], t)
        room.gone[AT_END, k] = value(w.gone[:, k], t)
    gx, gy = centre(p, w)
    ex, ey, es, kept = grip_at(w, t)
    return value(gx, t), value(gy, t), value(w.s, t), ex, ey, es, kept


@inlined_kernel
def left_at(p: Coefficients, balls: Balls, row: Candidate, now: Place, t: float, room: Room) -> float:
    """What is queued, from the motion at a time by `place_all`: falls to zero at its event."""
    j = row.ball
    if has_own_series(p):
        return own_left_at(p, balls, row, now, t, room)
    x, y, s, ex, ey, es, kept = now
    cos, sin = balls.cosine[j], balls.sine[j]
    if row.change == 0:
        sign = float(balls.side[j])
        left: float = row.start + sign * (balls.penetration[j] * (kept - 1.0) + cos * ey - sin * ex + es)
        return left - sign * gone_at(p, balls, room.felt[AT_END], j)
    sign = -float(row.change)
    left = balls.play[j] + p.onset + sign * (cos * y - sin * x + s - balls.lead[j])
    return left - sign * gone_at(p, balls, room.gone[AT_END], j)


@inlined_kernel
def first_change(p: Coefficients, balls: Balls, w: Series, room: Room, filled: int) -> tuple[float, int, int]:
    """Earliest of what is queued: its time, what happens, and to which ball.

    A ball that is met on its negative side has its number plus that of the balls.
    """
    end, kind, ball = 1.0, NOTHING, -1
    first, known = 0, False
    then = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(1, filled):
        if room.queue[i].guess < room.queue[first].guess:
            first = i
    for n in range(filled):
        row = room.queue[first if n == 0 else n - 1 if n <= first else n]
        early, late = row.early_half, row.late_half
        if early == STAYS and end <= 0.5:
            continue
        if kind != NOTHING and ((early == FALLS and end <= 0.5) or (early == STAYS and late == FALLS)):
            if not known:
                known, then = True, place_all(p, w, end, room)
            if left_at(p, balls, row, then, end, room) > 2.0 * ROUNDING * row.noise:
                continue
        if row.change == 0:
            sign = float(balls.side[row.ball])
            penetration(p, balls, w, row.ball, room.c)
        else:
            sign = -float(row.change)
            way(p, balls, w, row.ball, room.c)
        at = (row.start, row.rise, row.middle, row.turn, row.last, row.fall)
        t = earliest_zero(room.c, at, sign, early, late, end, row.noise)
        if t < end:
            end, kind, ball, known = t, PART if row.change == 0 else TOUCH, row.ball, False
            if row.change < 0:
                ball += balls.play.size
    return end, kind, ball


@inlined_kernel
def pocket_change(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    h: float,
    x: Knots,
    y: Knots,
    s: Knots,
    off: float,
    late_off: float,
    room: Room,
) -> tuple[float, int, int, float]:
    """First time a pocket leaves its ball or meets one, what happens, to which ball, and the most depth."""
    if is_gripped(p):
        room.depths[:] = np.inf
        return 1.0, NOTHING, -1, np.inf
    filled, deepest, count = 0, 0.0, state.touching
    if count > 0:
        filled, deepest = leave_balls(p, balls, w, count, room)
    if count < balls.play.size:
        filled = meet_balls(p, balls, w, state, h, x, y, s, off, late_off, room, filled)
    if filled == 0:
        return 1.0, NOTHING, -1, deepest
    end, kind, ball = first_change(p, balls, w, room, filled)
    return end, kind, ball, deepest
