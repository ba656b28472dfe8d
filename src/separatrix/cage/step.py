"""How long a step may be: as long as its series tell the motion, and to the next time something is due."""

from __future__ import annotations

import math

from separatrix.cage.features import (
    harmonics,
    has_hertz_pockets,
    has_inertia,
    has_own_series,
    is_out_of_round,
    is_ramped,
)
from separatrix.cage.records import CLEAR, ORDER, RELEASED, Balls, Coefficients, Pace, Series, State
from separatrix.cage.traction import fastest_ball
from separatrix.compiled import inlined_kernel

PRECISION, HERTZ_PRECISION = 2.0**-34, 2.0**-40
"""Share of the speeds below which the last terms of a series must be. The force of a Hertz contact has no
series about its beginning, so that near it the terms fall slowly."""

LONGEST = 1e6
"""Step in space where nothing limits it."""

RELAXED = 4.0
"""Longest step with linear pockets in touch, in units of the time in which they yield."""

SLOWED = 5.0
"""Longest step with balls that move, in units of the time in which the slope of their traction stops them: a
series of 14 terms still damps what it no longer resolves."""

SHORT = 0.2
"""Share of the distance of the centre that a way may have: its series falls by that from term to term."""


@inlined_kernel
def push_of(p: Coefficients, balls: Balls, w: Series, j: int, n: int) -> float:
    """Coefficient n of the force of a pocket in touch."""
    if has_own_series(p):
        return float(balls.force[n, j])
    depth: float = (
        balls.penetration[j] * w[n].kept + balls.cosine[j] * w[n].ey - balls.sine[j] * w[n].ex + w[n].es
    )
    for k in range(2 * harmonics(p)):
        depth -= balls.drive[k, j] * w[n].felt[k]
    return p.stiffness * depth


@inlined_kernel
def step_length(p: Coefficients, balls: Balls, w: Series, state: State, most: float) -> float:
    """Time, up to the most, for which the last terms of the series stay below `PRECISION` of the speeds.

    Of the speeds themselves, and of those that each pocket alone would give: forces of several pockets may
    balance, so that the cage does not feel that they relax.
    """
    start, at_end, one_before = w[0], w[ORDER], w[ORDER - 1]
    speed = abs(start.vx) + abs(start.vy) + abs(start.vs) + p.slowest
    last = max(abs(at_end.vx), abs(at_end.vy), abs(at_end.vs))
    before = max(abs(one_before.vx), abs(one_before.vy), abs(one_before.vs))
    for i in range(state.touching):
        j = balls.touching[i]
        last = max(last, abs(push_of(p, balls, w, j, ORDER - 1)) / ORDER)
        before = max(before, abs(push_of(p, balls, w, j, ORDER - 2)) / (ORDER - 1))
    if has_inertia(p):
        moves, ends, ends_before = fastest_ball(balls.moving, state.touching + state.coasting)
        speed, last, before = max(speed, moves), max(last, ends), max(before, ends_before)
    scale = (HERTZ_PRECISION if has_hertz_pockets(p) else PRECISION) * speed
    # |v_n| h^n = scale, for the last two terms
    h, power = most, most ** (ORDER - 1)
    if last * power * h > scale:
        h = (scale / last) ** (1.0 / ORDER)
        power = h ** (ORDER - 1)
    if before * power > scale:
        h = (scale / before) ** (1.0 / (ORDER - 1))
    return h


@inlined_kernel
def distance_step(p: Coefficients, w: Series, share: float) -> float:
    """Time for which the distance of the centre has a series: on ways in space shorter than itself."""
    turning, start = p.turning * share, w[0]
    x, y, vx, vy = start.x, start.y, start.vx, start.vy
    swing = p.eccentricity * (abs(turning) + abs(start.vs) / p.radius)
    # Velocity and acceleration in space: v + Omega x r, dv/dt + 2 Omega x v + Omega x (Omega x r)
    speed = abs(vx - turning * y) + abs(vy + turning * x) + swing + p.slowest
    pull = abs(w[1].vx - turning * (2.0 * vy + turning * x))
    pull += abs(w[1].vy + turning * (2.0 * vx - turning * y))
    h = SHORT * p.land_gap / speed
    return h if pull == 0.0 else min(h, SHORT * math.sqrt(2.0 * p.land_gap / pull))


@inlined_kernel
def longest_step(p: Coefficients, balls: Balls, w: Series, state: State, now: Pace, left: float) -> float:
    """Time for which the series may be used: their own, and up to the next time at which something is due."""
    h = left
    if state.touching > 0 and not has_own_series(p):
        # What is left of a penetration and what is new cancel: of more than this too little is left.
        h = min(h, RELAXED / (p.yielding * p.stiffness * now.share))
    if has_inertia(p) and state.touching + state.coasting > 0:
        # Of a speed that has decayed to less a series of this length has nothing left
        h = min(h, SLOWED * p.coast_time * now.share)
    if is_ramped(p) and state.clock < p.ramp_time:
        h = min(h, p.ramp_time - state.clock)
    if state.land == RELEASED or (state.land == CLEAR and is_out_of_round(p)):
        h = min(h, distance_step(p, w, now.share))
    return step_length(p, balls, w, state, h)
