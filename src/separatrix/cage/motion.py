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
    SLIDE_START,
    TOUCH,
    land_change,
    pocket_change,
)
from separatrix.cage.evidence import enter_step, enter_work, record
from separatrix.cage.expand import expand
from separatrix.cage.land import land_geometry, slide_speed
from separatrix.cage.series import ORDER, ROUNDING, body_values, stretch, value
from separatrix.cage.slots import (
    BACKWARD,
    BALLS,
    BODY,
    CLEAR,
    CLOCK,
    COS,
    DEPTH,
    ES,
    EX,
    EY,
    FELT,
    FORWARD,
    FRAME,
    GONE,
    GX,
    GY,
    HARMONICS,
    KEPT,
    LAND_HITS,
    NORMAL,
    NX,
    RELEASED,
    SIN,
    SLIDING,
    STEPS,
    STICK,
    TANGENT,
    VX,
    VY,
    S,
    W,
    X,
    Y,
)
from separatrix.compiled import kernel

PRECISION = 2.0**-53
LONGEST = 1e6
HOLD = 1e-9
"""Share by which the friction asked of a sticking land may pass what it can hold, by rounding."""

MOST_STEPS, HERTZ_STEPS = 200.0, 30.0
"""Steps in the time of a radian of the fastest motion: a run that asks for more stands still in time."""


@kernel
def speed_share(p, clock):  # type: ignore[no-untyped-def]
    """Share of the full speed at a time, and its rate."""
    if clock >= p.ramp_time:
        return 1.0, 0.0
    rise = (1.0 - p.ramp_start) / p.ramp_time
    return p.ramp_start + rise * clock, rise


@kernel
def frame_angle(p, clock):  # type: ignore[no-untyped-def]
    """Angle by which the frame has turned."""
    ramped = min(clock, p.ramp_time)
    angle = p.turning * (clock - ramped)
    if ramped > 0.0:
        rise = (1.0 - p.ramp_start) / p.ramp_time
        angle += p.turning * ramped * (p.ramp_start + 0.5 * rise * ramped)
    return angle


@kernel
def load_state(p, s, q, w, active, count):  # type: ignore[no-untyped-def]
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
            w[0, BALLS + active[i]] = q[active[i]]


@kernel
def step_length(p, w):  # type: ignore[no-untyped-def]
    """Time for which the series gives the speeds to the last bit."""
    scale = PRECISION * (abs(w[0, VX]) + abs(w[0, VY]) + abs(w[0, W]) + p.slowest)
    last = max(abs(w[ORDER, VX]), abs(w[ORDER, VY]), abs(w[ORDER, W]))
    before = max(abs(w[ORDER - 1, VX]), abs(w[ORDER - 1, VY]), abs(w[ORDER - 1, W]))
    h = LONGEST
    if last > 0.0:
        h = min(h, (scale / last) ** (1.0 / ORDER))
    if before > 0.0:
        h = min(h, (scale / before) ** (1.0 / (ORDER - 1)))
    return h


@kernel
def rescale(p, w, balls, count, h, pressed):  # type: ignore[no-untyped-def]
    """Make the step the unit of time of all series that are looked at."""
    stretch(w, 0, BODY, h)
    if p.needs_rotation:
        stretch(w, COS, SIN + 1, h)
    if p.needs_frame:
        stretch(w, FRAME, FRAME + 6 * HARMONICS, h)
    if p.hertz != 0.0 and count > 0:
        stretch(w, BALLS, BALLS + 2 * balls, h)
    if pressed:
        stretch(w, NX, SLIDING + 1, h)


@kernel
def settle_stick(p, cos, sin, q, w, side, active, count, now, sums):  # type: ignore[no-untyped-def]
    """Mode of a land on which nothing slides: it sticks if its friction can hold, else it starts to slide."""
    expand(p, cos, sin, q, w, side, active, count, STICK, now, sums)
    if abs(w[0, TANGENT]) <= p.land_friction * w[0, NORMAL] * (1.0 + HOLD):
        return STICK
    return BACKWARD if w[0, TANGENT] > 0.0 else FORWARD


@kernel
def first_sliding(p, w, now):  # type: ignore[no-untyped-def]
    """Speed at which the cage's surface slides on the ring's, from the first coefficients."""
    gx, gy, vx, vy = w[0, X], w[0, Y], w[0, VX], w[0, VY]
    if p.eccentricity != 0.0:
        gx, gy = w[0, GX], w[0, GY]
        rate = p.eccentricity * w[0, W] / p.radius
        vx, vy = vx + rate * w[0, SIN], vy - rate * w[0, COS]
    r = np.sqrt(gx * gx + gy * gy)
    return (gx * vy - gy * vx) / r + p.land_side * (w[0, W] - p.ring_slide * now[0])


@kernel
def land_after(p, cos, sin, q, w, side, active, count, now, kind, sums):  # type: ignore[no-untyped-def]
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
    return settle_stick(p, cos, sin, q, w, side, active, count, now, sums)


@kernel
def kinetic(p, s):  # type: ignore[no-untyped-def]
    """Kinetic energy of the cage in the turning frame, over its mass."""
    return 0.5 * (s[VX] * s[VX] + s[VY] * s[VY] + p.inertia * s[W] * s[W])


@kernel
def place_of(p, cos, sin, s, j):  # type: ignore[no-untyped-def]
    """Place of pocket j along the circumference, against a ball without lead."""
    x, y = s[X], s[Y]
    if p.eccentricity != 0.0:
        x -= p.eccentricity * np.cos(s[S] / p.radius)
        y -= p.eccentricity * np.sin(s[S] / p.radius)
    return y * cos[j] - x * sin[j] + s[S]


@kernel
def finish_step(p, cos, sin, w, s, lead, q, side, active, count, h, end, ends):  # type: ignore[no-untyped-def]
    """State at the end of a step, from its series."""
    body_values(w, end, ends)
    for i in range(6):
        s[i] = ends[i]
    s[CLOCK] += end * h
    for i in range(count):
        j = active[i]
        if p.hertz != 0.0:
            q[j] = value(w, BALLS + j, end)
        else:
            q[j] = q[j] * ends[KEPT] + ends[EY] * cos[j] - ends[EX] * sin[j] + ends[ES]
            for k in range(2 * p.harmonics):
                q[j] -= p.drive[k, j] * value(w, FELT + k, end)
    for k in range(2 * p.harmonics):
        gone = value(w, GONE + k, end)
        for j in range(lead.size):
            if side[j] == 0:
                lead[j] += p.drive[k, j] * gone


@kernel
def change_pocket(p, cos, sin, half, s, lead, q, side, active, mode, hits, kind, ball):  # type: ignore[no-untyped-def]
    """Put a ball on the list of those in touch (beyond the balls: on the negative side), or take it off."""
    if kind == TOUCH:
        j = ball % side.size
        side[j] = 1 if ball < side.size else -1
        q[j] = place_of(p, cos, sin, s, j) - lead[j] - side[j] * half[j]
        if p.hertz != 0.0:
            q[j] = side[j] * p.onset
        active[mode[0]] = j
        mode[0] += 1
        hits[j] += 1
        return
    lead[ball] = place_of(p, cos, sin, s, ball) - side[ball] * half[ball] - q[ball]
    side[ball] = 0
    kept = 0
    for i in range(mode[0]):
        if active[i] != ball:
            active[kept] = active[i]
            kept += 1
    mode[0] = kept


@kernel
def longest_step(p, w, s, land, left):  # type: ignore[no-untyped-def]
    """Time for which the series may be used: their own, and up to the next time at which something is due."""
    h = min(step_length(p, w), left)
    if s[CLOCK] < p.ramp_time:
        h = min(h, p.ramp_time - s[CLOCK])
    if land == RELEASED or (land == CLEAR and p.roundness != 0.0):
        # The distance of the centre has a series only for ways shorter than itself.
        h = min(h, 0.2 * p.land_gap / (abs(w[0, VX]) + abs(w[0, VY]) + p.slowest))
    return h


@kernel
def advance(  # type: ignore[no-untyped-def]
    p, cos, sin, half, s, lead, q, w, side, active, mode, ledger, tally, hits, length, ceiling, rows, books
):
    """Advance the cage by a time, in place.

    Parameters
    ----------
    p, cos, sin, half
        The cage, and its pockets' directions and half play.
    s, lead, q : ndarray
        State as in `slots`; lead of each ball that does not touch, and penetration of each that does [m].
    w, side, active, mode : ndarray
        Series; side on which each pocket touches; list of those; number of those, mode of the land, and rows
        of history filled.
    ledger, tally, hits : ndarray
        Work since the start, integrals of this window, and impacts of every pocket.
    length, ceiling : float
        Time to advance, and the kinetic energy above which to stop.
    rows : ndarray
        History; the slot of the time of an unfilled row holds the time from which it is due.
    books : bool
        Whether the ledger is kept.

    Returns
    -------
    bool
        False if more events came than any motion has: the run cannot go on.
    """
    done, taken = 0.0, 0
    most = MOST_STEPS * (1.0 + length * p.fastest) * (HERTZ_STEPS if p.hertz != 0.0 else 1.0)
    sums, ends, c = np.zeros(8 + 6 * HARMONICS), np.zeros(BODY), np.zeros(ORDER + 1)
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    while done < length and kinetic(p, s) < ceiling:
        taken += 1
        if taken > most:
            return False
        now = speed_share(p, s[CLOCK])
        count, land = mode[0], mode[1]
        pressed = land != CLEAR and land != RELEASED
        load_state(p, s, q, w, active, count)
        expand(p, cos, sin, q, w, side, active, count, land, now, sums)
        if pressed and land != STICK:
            for n in range(ORDER + 1):
                w[n, SLIDING] = slide_speed(p, w, gx, gy, now, n)
        h = longest_step(p, w, s, land, length - done)
        rescale(p, w, cos.size, count, h, pressed)
        end, kind, ball = pocket_change(p, cos, sin, half, lead, q, w, side, active, count, c)
        if p.land_side != 0.0:
            end, kind = land_change(p, w, land, h, end, kind, c)
        if rows.shape[0] > mode[2]:
            mode[2] = record(p, cos, sin, half, w, s, lead, q, side, active, count, land, now, h, end,
                             sums, ledger, rows, mode[2])  # fmt: skip
        if books:
            enter_work(p, cos, sin, w, q, active, count, land, now, h, end, sums, ledger)
        enter_step(p, cos, sin, w, q, side, active, count, pressed, h, end, tally, c)
        finish_step(p, cos, sin, w, s, lead, q, side, active, count, h, end, ends)
        done = length if kind == NOTHING and h == length - done else done + end * h
        if kind in (PART, TOUCH):
            change_pocket(p, cos, sin, half, s, lead, q, side, active, mode, hits, kind, ball)
        elif kind != NOTHING:
            load_state(p, s, q, w, active, count)
            mode[1] = land_after(p, cos, sin, q, w, side, active, count, now, kind, sums)
            tally[LAND_HITS] += kind == LAND_TOUCH
    tally[STEPS] += taken
    return True
