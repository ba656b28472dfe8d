"""Motion of the cage in the plane from event to event, each mode by its series."""

from __future__ import annotations

import numpy as np

from separatrix.cage.events import (
    LAND_CLEAR,
    LAND_LEAVE,
    LAND_PRESS,
    LAND_TOUCH,
    NOTHING,
    PART,
    QUEUE,
    SLIDE_START,
    TOUCH,
    fourths,
    pocket_change,
)
from separatrix.cage.evidence import enter_step, enter_work, record
from separatrix.cage.expand import expand
from separatrix.cage.land import land_geometry, slide_speed
from separatrix.cage.land_events import land_change
from separatrix.cage.series import (
    KNOT_ROWS,
    ORDER,
    ROUNDING,
    grip_at,
    knots,
    motion_at,
    slope,
    stretch,
    value,
)
from separatrix.cage.slots import (
    BACKWARD,
    BALLS,
    CLEAR,
    CLOCK,
    COS,
    COSINE,
    DEPTH,
    DRIVE,
    EX,
    FELT,
    FORWARD,
    FRAME,
    GONE,
    GX,
    GY,
    HARMONICS,
    KEPT,
    LAND_HITS,
    LEAD,
    LIST,
    NORMAL,
    NX,
    PENETRATION,
    PLAY,
    RELEASED,
    SIDE,
    SIN,
    SINE,
    SLIDING,
    STEPS,
    STICK,
    TANGENT,
    VX,
    VY,
    WORKS,
    S,
    W,
    X,
    Y,
)
from separatrix.cage.step import longest_step
from separatrix.compiled import inlined_kernel, inner_kernel, kernel

HOLD = 1e-9
"""Share by which the friction asked of a sticking land may pass what it can hold, by rounding."""

MOST_STEPS, HERTZ_STEPS = 200.0, 30.0
"""Steps in the time of a radian of the fastest motion: a run that asks for more stands still in time."""


@inlined_kernel
def speed_share(p, clock):  # type: ignore[no-untyped-def]
    """Share of the full speed at a time, and its rate."""
    if clock >= p.ramp_time:
        return 1.0, 0.0
    rise = (1.0 - p.ramp_start) / p.ramp_time
    return p.ramp_start + rise * clock, rise


@inner_kernel
def frame_angle(p, clock):  # type: ignore[no-untyped-def]
    """Angle by which the frame has turned."""
    ramped = min(clock, p.ramp_time)
    angle = p.turning * (clock - ramped)
    if ramped > 0.0:
        rise = (1.0 - p.ramp_start) / p.ramp_time
        angle += p.turning * ramped * (p.ramp_start + 0.5 * rise * ramped)
    return angle


@inlined_kernel
def load_state(p, pockets, touch, s, w, count):  # type: ignore[no-untyped-def]
    """First coefficients of the series from the state."""
    for i in range(6):
        w[0, i] = s[i]
    if p.needs_rotation:
        theta = s[S] / p.radius
        w[0, COS], w[0, SIN] = np.cos(theta), np.sin(theta)
    if p.eccentricity != 0.0:
        w[0, GX] = w[0, X] - p.eccentricity * w[0, COS]
        w[0, GY] = w[0, Y] - p.eccentricity * w[0, SIN]
    if p.needs_frame:
        angle = frame_angle(p, s[CLOCK])
        for h in range(max(1, p.harmonics)):
            w[0, FRAME + 2 * h] = np.cos((h + 1) * angle)
            w[0, FRAME + 2 * h + 1] = np.sin((h + 1) * angle)
    if p.hertz != 0.0:
        for i in range(count):
            w[0, BALLS + touch[LIST, i]] = pockets[PENETRATION, touch[LIST, i]]


@inlined_kernel
def rescale(p, w, balls, count, h, pressed):  # type: ignore[no-untyped-def]
    """Make the step the unit of time of all series that are looked at."""
    stretch(w, X, W + 1, h)
    if count > 0:
        stretch(w, EX, KEPT + 1, h)
    if p.eccentricity != 0.0:
        stretch(w, GX, GY + 1, h)
    if p.needs_rotation:
        stretch(w, COS, SIN + 1, h)
    if p.needs_frame:
        stretch(w, FRAME, FRAME + 6 * HARMONICS, h)
    if p.hertz != 0.0 and count > 0:
        stretch(w, BALLS, BALLS + 2 * balls, h)
    if pressed:
        stretch(w, NX, SLIDING + 1, h)


@inner_kernel
def settle_stick(p, pockets, touch, w, count, now, sums):  # type: ignore[no-untyped-def]
    """Mode of a land on which nothing slides: it sticks if its friction can hold, else it starts to slide."""
    expand(p, pockets, touch, w, count, STICK, now, sums)
    if abs(w[0, TANGENT]) <= p.land_friction * max(0.0, w[0, NORMAL]) * (1.0 + HOLD):
        return STICK
    return BACKWARD if w[0, TANGENT] > 0.0 else FORWARD


@inner_kernel
def first_sliding(p, w, now):  # type: ignore[no-untyped-def]
    """Speed at which the cage's surface slides on the ring's, from the first coefficients."""
    gx, gy, vx, vy = w[0, X], w[0, Y], w[0, VX], w[0, VY]
    if p.eccentricity != 0.0:
        gx, gy = w[0, GX], w[0, GY]
        rate = p.eccentricity * w[0, W] / p.radius
        vx, vy = vx + rate * w[0, SIN], vy - rate * w[0, COS]
    r = np.sqrt(gx * gx + gy * gy)
    return (gx * vy - gy * vx) / r + p.land_side * (w[0, W] - p.ring_slide * now[0])


@inner_kernel
def land_after(p, pockets, touch, w, count, now, kind, sums):  # type: ignore[no-untyped-def]
    """Mode of the land after a change; the series' first coefficients hold the state."""
    if kind == LAND_CLEAR:
        return CLEAR
    if kind == LAND_LEAVE:
        gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
        land_geometry(p, w, gx, gy, 0)
        return RELEASED if w[0, DEPTH] > ROUNDING * p.land_gap else CLEAR
    if kind == SLIDE_START:
        return BACKWARD if w[0, TANGENT] > 0.0 else FORWARD
    if kind in (LAND_TOUCH, LAND_PRESS):
        sliding = first_sliding(p, w, now)
        if abs(sliding) > ROUNDING * (abs(w[0, W]) + abs(p.ring_slide)):
            return FORWARD if sliding > 0.0 else BACKWARD
    return settle_stick(p, pockets, touch, w, count, now, sums)


@inlined_kernel
def kinetic(p, s):  # type: ignore[no-untyped-def]
    """Kinetic energy of the cage in the turning frame, over its mass."""
    return 0.5 * (s[VX] * s[VX] + s[VY] * s[VY] + p.inertia * s[W] * s[W])


@inner_kernel
def land_energy(p, pockets, touch, s, w, count):  # type: ignore[no-untyped-def]
    """Energy in the land's spring, over the mass."""
    load_state(p, pockets, touch, s, w, count)
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    land_geometry(p, w, gx, gy, 0)
    return 0.5 * p.land_stiffness * w[0, DEPTH] ** 2


@inner_kernel
def place_of(p, pockets, s, j):  # type: ignore[no-untyped-def]
    """Place of pocket j along the circumference, against a ball without lead."""
    x, y = s[X], s[Y]
    if p.eccentricity != 0.0:
        x -= p.eccentricity * np.cos(s[S] / p.radius)
        y -= p.eccentricity * np.sin(s[S] / p.radius)
    return y * pockets[COSINE, j] - x * pockets[SINE, j] + s[S]


@inlined_kernel
def finish_step(p, pockets, touch, w, s, count, h, end, after):  # type: ignore[no-untyped-def]
    """State at the end of a step, from its series."""
    s[X], s[Y], s[VX], s[VY], s[S], s[W] = after
    s[CLOCK] += end * h
    if count > 0 and p.hertz == 0.0:
        ex, ey, es, kept = grip_at(w, end)
    for i in range(count):
        j = touch[LIST, i]
        if p.hertz != 0.0:
            pockets[PENETRATION, j] = value(w, BALLS + j, end)
        else:
            pockets[PENETRATION, j] = (
                pockets[PENETRATION, j] * kept + ey * pockets[COSINE, j] - ex * pockets[SINE, j] + es
            )
            for k in range(2 * p.harmonics):
                pockets[PENETRATION, j] -= pockets[DRIVE + k, j] * value(w, FELT + k, end)
    for k in range(2 * p.harmonics):
        gone = value(w, GONE + k, end)
        for j in range(pockets.shape[1]):
            if touch[SIDE, j] == 0:
                pockets[LEAD, j] += pockets[DRIVE + k, j] * gone


@inner_kernel
def change_pocket(p, pockets, touch, w, s, mode, hits, kind, ball, h, end):  # type: ignore[no-untyped-def]
    """Put a ball on the list of those in touch (beyond the balls: on the negative side), or take it off."""
    if kind == TOUCH:
        j = ball % pockets.shape[1]
        touch[SIDE, j] = 1 if ball < pockets.shape[1] else -1
        pockets[PENETRATION, j] = (
            place_of(p, pockets, s, j) - pockets[LEAD, j] - touch[SIDE, j] * pockets[PLAY, j]
        )
        if p.hertz != 0.0:
            pockets[PENETRATION, j] = touch[SIDE, j] * p.onset
        touch[LIST, mode[0]] = j
        mode[0] += 1
        hits[j] += 1
        return
    pockets[LEAD, ball] = (
        place_of(p, pockets, s, ball) - touch[SIDE, ball] * pockets[PLAY, ball] - pockets[PENETRATION, ball]
    )
    if p.hertz != 0.0:
        follows = s[VY] * pockets[COSINE, ball] - s[VX] * pockets[SINE, ball] + s[W]
        for k in range(2 * p.harmonics):
            follows -= pockets[DRIVE + k, ball] * slope(w, GONE + k, end) / h
        if touch[SIDE, ball] * follows > 0.0:
            # The pocket follows more slowly than the force at the onset drives the ball: without a distance
            # between the two it would meet the ball at once, and again without end.
            pockets[LEAD, ball] += 0.5 * touch[SIDE, ball] * p.onset
    touch[SIDE, ball] = 0
    kept = 0
    for i in range(mode[0]):
        if touch[LIST, i] != ball:
            touch[LIST, kept] = touch[LIST, i]
            kept += 1
    mode[0] = kept


@kernel
def make_room(balls):  # type: ignore[no-untyped-def]
    """Arrays that `advance` works in."""
    return (
        np.zeros(8 + 6 * HARMONICS),
        np.zeros(ORDER + 1),
        np.zeros(WORKS),
        np.zeros((KNOT_ROWS, BALLS)),
        np.zeros(balls),
        np.zeros((2 * balls, QUEUE)),
    )


@inner_kernel
def advance(  # type: ignore[no-untyped-def]
    p, pockets, touch, s, w, mode, ledger, tally, hits, length, ceiling, rows, room
):
    """Advance the cage by a time, in place.

    Parameters
    ----------
    p, pockets, touch
        The cage, and numbers by ball as in `slots`.
    s, w : ndarray
        State as in `slots`, and series.
    mode : ndarray
        How many pockets touch their balls, mode of the land, and rows of history filled.
    ledger, tally, hits : ndarray
        Work since the start, integrals of this look, and impacts of every pocket.
    length, ceiling : float
        Time to advance, and the kinetic energy above which to stop.
    rows : ndarray
        History; the slot of the time of an unfilled row holds the time from which it is due.

    Returns
    -------
    bool
        False if more events came than any motion has: the run cannot go on.
    """
    done, taken = 0.0, 0
    most = MOST_STEPS * (1.0 + length * p.fastest) * (HERTZ_STEPS if p.hertz != 0.0 else 1.0)
    sums, c, work, knot, beyond, queue = room
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    while done < length and kinetic(p, s) < ceiling:
        taken += 1
        if taken > most:
            return False
        now = speed_share(p, s[CLOCK])
        count, land = mode[0], mode[1]
        pressed = land != CLEAR and land != RELEASED
        load_state(p, pockets, touch, s, w, count)
        expand(p, pockets, touch, w, count, land, now, sums)
        if pressed and land != STICK:
            for n in range(ORDER + 1):
                w[n, SLIDING] = slide_speed(p, w, gx, gy, now, n)
        h = longest_step(p, pockets, touch, w, s, count, land, now, length - done)
        rescale(p, w, pockets.shape[1], count, h, pressed)
        knots(w, X, Y + 1, knot)
        knots(w, S, S + 1, knot)
        if p.eccentricity != 0.0:
            knots(w, GX, GY + 1, knot)
        off, late_off = fourths(w, gx, gy, S, 0.0)
        end, kind, ball, deepest = pocket_change(
            p, pockets, touch, w, h, count, knot, off, late_off, beyond, queue, c
        )
        if p.land_side != 0.0:
            end, kind = land_change(p, w, land, h, end, kind, knot, max(off, late_off), c)
        if rows.shape[0] > mode[2]:
            mode[2] = record(
                p, pockets, touch, w, s, count, land, now, h, end, sums, ledger, rows, mode[2], work
            )
        enter_work(p, pockets, touch, w, count, land, now, h, end, sums, ledger, work)
        after = motion_at(w, end)
        enter_step(p, pockets, touch, w, count, land, deepest, h, end, after, tally, c)
        finish_step(p, pockets, touch, w, s, count, h, end, after)
        done = length if kind == NOTHING and h == length - done else done + end * h
        if kind in (PART, TOUCH):
            change_pocket(p, pockets, touch, w, s, mode, hits, kind, ball, h, end)
        elif kind != NOTHING:
            load_state(p, pockets, touch, s, w, count)
            mode[1] = land_after(p, pockets, touch, w, count, now, kind, sums)
            tally[LAND_HITS] += kind == LAND_TOUCH
    tally[STEPS] += taken
    return True
