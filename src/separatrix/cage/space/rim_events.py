"""What an edge of a pocket adds to the ends of a step: a ball passes from the wall to it, meets or leaves it.

A ball that is farther from the middle of its pocket than its clearance, but beyond the end of the wall, is
`OUTER_CLEAR` or `INNER_CLEAR` until the edge touches it: its nearest point then has a series.
"""

from __future__ import annotations

import math

from separatrix.cage.series import NEVER, ROUNDING, first_zero
from separatrix.cage.space.events import GRAINS, MEET, end_at, own_way, scaled
from separatrix.cage.space.records import (
    AXIAL,
    CONTACTS,
    DEPTH,
    DT,
    DZ,
    FLAT_BACK,
    FLAT_FRONT,
    GA,
    GB,
    GRIPPED,
    GX,
    GY,
    HEIGHT,
    IN_T,
    IN_Z,
    INNER_RIM,
    LAST,
    LEAD,
    NONE,
    OUTER_CLEAR,
    OUTER_RIM,
    PLACE,
    PT,
    RIM_COS,
    ROUND_END,
    SWEPT,
    WAY,
    Numbers,
    Parts,
    S,
    Z,
)
from separatrix.cage.space.rim import is_on_round, place_edge
from separatrix.compiled import inner_kernel
from separatrix.units import Array

EDGE, PASS = 5, 6
"""Events beside those of `events`: a contact changes its kind, or passes between a flat and a round end."""

CLEARING = OUTER_CLEAR - OUTER_RIM


@inner_kernel
def scaled_sum(e: Array, a: int, b: int, last: int, h: float, c: Array) -> float:
    """Sum of the squares of two series with the step as unit of time, without its first coefficient."""
    power = 1.0
    for n in range(last + 1):
        total = 0.0
        for m in range(n + 1):
            total += e[m, a] * e[n - m, a] + e[m, b] * e[n - m, b]
        c[n] = total * power
        power *= h
    end_at(c, last)
    return float(e[0, a] * e[0, a] + e[0, b] * e[0, b])


@inner_kernel
def wall_end(p: Numbers, parts: Parts, i: int, h: float, end: float) -> tuple[float, int]:
    """When a wall that touches its ball ends there, up to a time, and at which edge."""
    e, c, last, becomes = parts.rim[i], parts.c, parts.listed[LAST], NONE
    for n in range(last + 1):
        place_edge(p, parts, i, n)
        if i % 2 == 0 and p.is_round:
            radius = p.ball_radius + p.around + parts.play[i // 2]
            e[n, PLACE] = radius * parts.contact[i, n, PT]
            if n == 0:
                e[0, PLACE] -= parts.region[i // 2] * p.apart
    here = scaled_sum(e, HEIGHT, PLACE, last, h, c)
    time = NEVER
    if p.outer_edge < math.inf:
        t = first_zero(c, p.outer_edge**2 - here, -1.0, end, here)
        if t < end:
            time, end, becomes = t, t, OUTER_RIM
    t = first_zero(c, here - p.inner_edge**2, 1.0, end, here)
    if t < end:
        time, becomes = t, INNER_RIM
    return time, becomes


@inner_kernel
def met_kind(p: Numbers, parts: Parts, i: int, kind: int) -> int:
    """What a contact becomes that a wall would meet now: that wall, or the edge beyond which the ball is."""
    j, cage = i // 2, parts.cage[0]
    if math.hypot(cage[GX], cage[GY]) < p.margin:
        return kind
    place_ball(parts, j)
    place_edge(p, parts, i, 0)
    e = parts.rim[i, 0]
    if i % 2 == 0 and p.is_round:
        radius = p.ball_radius + p.around + parts.play[j]
        e[PLACE] = radius * e[IN_T] / math.hypot(e[IN_Z], e[IN_T]) - parts.region[j] * p.apart
    here = math.hypot(e[HEIGHT], e[PLACE])
    if p.inner_edge <= here <= p.outer_edge:
        return kind
    return CLEARING + (OUTER_RIM if here > p.outer_edge else INNER_RIM)


@inner_kernel
def place_ball(parts: Parts, j: int) -> None:
    """Place of a pocket against its ball now, from the first coefficients of the cage."""
    cos, sin, cage, ball = parts.cosine[j], parts.sine[j], parts.cage[0], parts.ball[j, 0]
    ball[DT] = cage[GY] * cos - cage[GX] * sin + cage[S] - ball[LEAD]
    ball[DZ] = cage[Z] - (cage[GB] * cos - cage[GA] * sin) - ball[AXIAL]


@inner_kernel
def region_of(p: Numbers, parts: Parts, j: int) -> int:
    """Part of a slot in which its ball is."""
    place_ball(parts, j)
    along = parts.ball[j, 0, DT]
    return 0 if abs(along) <= p.apart else (1 if along > 0.0 else -1)


@inner_kernel
def rim_event(
    p: Numbers, parts: Parts, h: float, end: float, event: int, which: int, becomes: int
) -> tuple[float, int, int, int]:
    """Earliest change up to a time, if that of a contact near an edge comes before."""
    cage, last = parts.cage, parts.listed[LAST]
    far = math.hypot(cage[0, GX], cage[0, GY]) + own_way(cage, last, GX, h) + own_way(cage, last, GY, h)
    for a in range(parts.listed[CONTACTS]):
        i = parts.touching[a]
        if parts.kind[i] >= OUTER_RIM:
            end, event, which, becomes = edge_event(p, parts, i, h, end, event, which, becomes)
        elif far >= p.margin and parts.kind[i] != GRIPPED:
            t, kind = wall_end(p, parts, i, h, end)
            if t < end:
                end, event, which, becomes = t, EDGE, i, kind
    return end, event, which, becomes


@inner_kernel
def edge_event(
    p: Numbers, parts: Parts, i: int, h: float, end: float, event: int, which: int, becomes: int
) -> tuple[float, int, int, int]:
    """Earliest change up to a time, if that of a contact at an edge comes before."""
    e, c, last, j, kind = parts.rim[i], parts.c, parts.listed[LAST], i // 2, parts.kind[i]
    is_clear, side = kind >= OUTER_CLEAR, 1.0 if kind % 2 == 0 else -1.0
    is_round, column = is_on_round(p, parts, i), IN_Z if i % 2 == 1 else IN_T
    edge = p.outer_edge if kind % 2 == 0 else p.inner_edge
    play = p.beside if i % 2 == 1 and not is_round else p.around + parts.play[j]
    depth, noise = parts.contact[i, 0, DEPTH], e[0, HEIGHT]
    parts.contact[i, 0, WAY] = scaled(parts.contact[i], last, DEPTH, h, c)
    if is_clear:
        t = first_zero(c, -depth, -1.0, end, noise)
    else:
        t = first_zero(c, depth + GRAINS * ROUNDING * noise, 1.0, end, noise)
    if t < end:
        end, which = t, i
        event, becomes = (MEET, kind - CLEARING) if is_clear else (EDGE, kind + CLEARING)
    # Back on the wall
    here = scaled_sum(e, HEIGHT, PLACE, last, h, c)
    t = first_zero(c, side * (here - edge * edge), side, end, here)
    if t < end:
        flat = FLAT_FRONT if e[0, column] < 0.0 else FLAT_BACK
        end, event, which, becomes = t, EDGE, i, ROUND_END if is_round else flat
    if is_clear:
        if is_round:
            far = math.hypot(e[0, IN_Z], e[0, IN_T])
            scaled_sum(e, IN_Z, IN_T, last, h, c)
            t = first_zero(c, (far - play) * (far + play), 1.0, end, play * play)
        else:
            scaled(e, last, column, h, c)
            t = first_zero(c, abs(c[0]) - play, math.copysign(1.0, c[0]), end, noise)
        if t < end:
            end, event, which, becomes = t, EDGE, i, NONE
    if p.is_slot and is_round:
        scaled(e, last, RIM_COS, h, c)
        toward = -float(parts.region[j])
        t = first_zero(c, toward * c[0], toward, end, 1.0)
        if t < end:
            end, event, which, becomes = t, PASS, i, 0
    elif p.is_slot:
        scaled(e, last, SWEPT, h, c)
        for toward in (1.0, -1.0):
            t = first_zero(c, p.apart - toward * c[0], -toward, end, noise)
            if t < end:
                end, event, which, becomes = t, PASS, i, -int(toward)
    return end, event, which, becomes
