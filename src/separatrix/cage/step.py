"""How long a step may be: as far as the series of the motion, and of what is looked for in it, are good."""

from __future__ import annotations

import numpy as np

from separatrix.cage.series import ORDER
from separatrix.cage.slots import (
    BALLS,
    CLEAR,
    CLOCK,
    COSINE,
    DRIVE,
    ES,
    EX,
    EY,
    FELT,
    KEPT,
    LIST,
    PENETRATION,
    RELEASED,
    SINE,
    VX,
    VY,
    W,
    X,
    Y,
)
from separatrix.compiled import inlined_kernel

PRECISION, HERTZ_PRECISION = 2.0**-34, 2.0**-40
"""Share of the speeds below which the last terms of a series lie. The force of a Hertz contact has no series
about its beginning, so that near it the terms fall slowly."""

LONGEST = 1e6

RELAXED = 4.0
"""Longest step with linear pockets in touch, in units of the time in which they yield."""

SHORT = 0.2
"""Share of the distance of the centre that a way may have: its series falls by that from term to term."""


@inlined_kernel
def push_of(p, pockets, w, j, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the force of a pocket in touch."""
    if p.hertz != 0.0:
        return w[n, BALLS + pockets.shape[1] + j]
    depth = (
        pockets[PENETRATION, j] * w[n, KEPT]
        + pockets[COSINE, j] * w[n, EY]
        - pockets[SINE, j] * w[n, EX]
        + w[n, ES]
    )
    for k in range(2 * p.harmonics):
        depth -= pockets[DRIVE + k, j] * w[n, FELT + k]
    return p.stiffness * depth


@inlined_kernel
def step_length(p, pockets, touch, w, count):  # type: ignore[no-untyped-def]
    """Time for which the last terms of the series stay below `PRECISION` of the speeds.

    Of the speeds themselves, and of those that each pocket alone would give: forces of several pockets may
    balance, so that the cage does not feel that they relax.
    """
    scale = HERTZ_PRECISION if p.hertz != 0.0 else PRECISION
    scale *= abs(w[0, VX]) + abs(w[0, VY]) + abs(w[0, W]) + p.slowest
    last = max(abs(w[ORDER, VX]), abs(w[ORDER, VY]), abs(w[ORDER, W]))
    before = max(abs(w[ORDER - 1, VX]), abs(w[ORDER - 1, VY]), abs(w[ORDER - 1, W]))
    for i in range(count):
        j = touch[LIST, i]
        last = max(last, abs(push_of(p, pockets, w, j, ORDER - 1)) / ORDER)
        before = max(before, abs(push_of(p, pockets, w, j, ORDER - 2)) / (ORDER - 1))
    h = LONGEST
    if last > 0.0:
        h = min(h, (scale / last) ** (1.0 / ORDER))
    if before > 0.0:
        h = min(h, (scale / before) ** (1.0 / (ORDER - 1)))
    return h


@inlined_kernel
def distance_step(p, w, share):  # type: ignore[no-untyped-def]
    """Time for which the distance of the centre has a series: on ways in space shorter than itself."""
    turning = p.turning * share
    x, y, vx, vy = w[0, X], w[0, Y], w[0, VX], w[0, VY]
    swing = p.eccentricity * (abs(turning) + abs(w[0, W]) / p.radius)
    speed = abs(vx - turning * y) + abs(vy + turning * x) + swing + p.slowest
    pull = abs(w[1, VX] - turning * (2.0 * vy + turning * x))
    pull += abs(w[1, VY] + turning * (2.0 * vx - turning * y))
    h = SHORT * p.land_gap / speed
    return h if pull == 0.0 else min(h, SHORT * np.sqrt(2.0 * p.land_gap / pull))


@inlined_kernel
def longest_step(p, pockets, touch, w, s, count, land, now, left):  # type: ignore[no-untyped-def]
    """Time for which the series may be used: their own, and up to the next time at which something is due."""
    h = min(step_length(p, pockets, touch, w, count), left)
    if count > 0 and p.hertz == 0.0:
        # What is left of a penetration and what is new cancel: of more than this too little is left.
        h = min(h, RELAXED / (p.yielding * p.stiffness * now[0]))
    if s[CLOCK] < p.ramp_time:
        h = min(h, p.ramp_time - s[CLOCK])
    if land == RELEASED or (land == CLEAR and p.roundness != 0.0):
        h = min(h, distance_step(p, w, now[0]))
    return h
