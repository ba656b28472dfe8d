"""What ends a step: a pocket leaves its ball or meets one, or the land's mode changes."""

from __future__ import annotations

import numpy as np

from separatrix.cage.land import land_geometry
from separatrix.cage.series import ORDER, copy_column, first_zero, product, travel
from separatrix.cage.slots import (
    BALLS,
    CLEAR,
    DEPTH,
    ES,
    EX,
    EY,
    FELT,
    FORWARD,
    GONE,
    GX,
    GY,
    KEPT,
    NORMAL,
    RELEASED,
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
from separatrix.compiled import kernel

NOTHING, PART, TOUCH, LAND_TOUCH, LAND_CLEAR, LAND_PRESS, LAND_LEAVE, SLIDE_STOP, SLIDE_START = range(9)


@kernel
def penetration(p, cos, sin, w, q, j, c):  # type: ignore[no-untyped-def]
    """Series of the penetration of a pocket in touch."""
    if p.hertz != 0.0:
        copy_column(w, BALLS + j, c)
        return
    for n in range(1, ORDER + 1):
        c[n] = q[j] * w[n, KEPT] + cos[j] * w[n, EY] - sin[j] * w[n, EX] + w[n, ES]
    for k in range(2 * p.harmonics):
        for n in range(1, ORDER + 1):
            c[n] -= p.drive[k, j] * w[n, FELT + k]
    c[0] = q[j]


@kernel
def pocket_change(p, cos, sin, half, lead, q, w, side, active, count, c):  # type: ignore[no-untyped-def]
    """Earliest time at which a pocket leaves its ball or meets one, what happens, and to which ball."""
    end, kind, ball = 1.0, NOTHING, -1
    if p.gripped:
        return end, kind, ball
    if count > 0:
        felt = 0.0
        kept = 1.0
        if p.hertz == 0.0 and p.harmonics == 0:
            felt = travel(w, EX) + travel(w, EY) + travel(w, ES)
            kept = travel(w, KEPT)
        for i in range(count):
            j = active[i]
            if abs(q[j]) * (1.0 - kept) > felt:
                continue
            penetration(p, cos, sin, w, q, j, c)
            t = first_zero(c, side[j] * q[j] - p.onset, float(side[j]), end, 0.0)
            if t < end:
                end, kind, ball = t, PART, j
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    far = travel(w, gx) + travel(w, gy) + travel(w, S)
    for j in range(cos.size):
        if side[j] != 0:
            continue
        u = w[0, gy] * cos[j] - w[0, gx] * sin[j] + w[0, S] - lead[j]
        play = half[j] + p.onset
        if abs(u) + far < play and p.harmonics == 0:
            continue
        for n in range(1, ORDER + 1):
            c[n] = w[n, gy] * cos[j] - w[n, gx] * sin[j] + w[n, S]
        for k in range(2 * p.harmonics):
            for n in range(1, ORDER + 1):
                c[n] -= p.drive[k, j] * w[n, GONE + k]
        noise = abs(w[0, S]) + abs(lead[j]) + abs(w[0, gx]) + abs(w[0, gy])
        for sign in (1.0, -1.0):
            t = first_zero(c, play - sign * u, -sign, end, noise)
            if t < end:
                end, kind, ball = t, TOUCH, (j if sign > 0.0 else j + cos.size)
    return end, kind, ball


@kernel
def land_change(p, w, land, h, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the land's comes first, and what it is."""
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
        for n in range(ORDER + 1):
            c[n] = p.land_friction * w[n, NORMAL] - sign * w[n, TANGENT]
        t = first_zero(c, max(0.0, c[0]), 1.0, end, p.land_stiffness * p.land_gap)
        return (t, SLIDE_START) if t < end else (end, kind)
    sign = 1.0 if land == FORWARD else -1.0
    copy_column(w, SLIDING, c)
    noise = abs(w[0, VX]) + abs(w[0, VY]) + abs(w[0, W]) + abs(p.ring_slide)
    t = first_zero(c, max(0.0, sign * c[0]), sign, end, noise)
    return (t, SLIDE_STOP) if t < end else (end, kind)


@kernel
def meet_land(p, w, gx, gy, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the cage meets its land before, and what it is."""
    near = np.sqrt(w[0, gx] ** 2 + w[0, gy] ** 2)
    if near + travel(w, gx) + travel(w, gy) < p.land_gap - abs(p.roundness):
        return end, kind
    if p.roundness == 0.0:
        for n in range(ORDER + 1):
            c[n] = product(w, gx, gx, n) + product(w, gy, gy, n)
        t = first_zero(c, (p.land_gap - near) * (p.land_gap + near), -1.0, end, p.land_gap**2)
    else:
        for n in range(ORDER + 1):
            land_geometry(p, w, gx, gy, n)
        copy_column(w, DEPTH, c)
        t = first_zero(c, -c[0], -1.0, end, p.land_gap)
    return (t, LAND_TOUCH) if t < end else (end, kind)


@kernel
def return_land(p, w, gx, gy, h, end, kind, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if a cage pushed off leaves its land, or is pressed again, before."""
    for n in range(ORDER + 1):
        land_geometry(p, w, gx, gy, n)
    copy_column(w, DEPTH, c)
    t = first_zero(c, c[0], 1.0, end, p.land_gap)
    if t < end:
        end, kind = t, LAND_CLEAR
    for n in range(ORDER):
        c[n] = p.land_stiffness * w[n, DEPTH] + p.land_damping / h * (n + 1) * w[n + 1, DEPTH]
    c[ORDER] = 0.0
    t = first_zero(c, max(0.0, -c[0]), -1.0, end, p.land_stiffness * p.land_gap)
    return (t, LAND_PRESS) if t < end else (end, kind)
