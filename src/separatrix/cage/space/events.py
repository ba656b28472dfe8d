"""What ends a step in space: a pocket meets or leaves its ball, or a strip of a land the cage."""

from __future__ import annotations

import math

from separatrix.cage.records import ORDER
from separatrix.cage.series import ROUNDING, first_zero
from separatrix.cage.space.land import place_strip
from separatrix.cage.space.records import (
    ALONG,
    AXIAL,
    BALLS,
    CLEAR,
    DEPTH,
    DEPTH_L,
    DT,
    DZ,
    FLAT_BACK,
    FLAT_FRONT,
    GA,
    GB,
    GONE,
    GRIPPED,
    GX,
    GY,
    LAST,
    LEAD,
    LX,
    LY,
    NONE,
    OUTER_RIM,
    PRESSED,
    PUSH_L,
    ROUND_END,
    SPEED,
    WAY,
    Numbers,
    Parts,
    S,
    Z,
)
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

GRAINS = 8.0
"""A pocket leaves its ball this many roundings of its place after their force is gone, as in the plane."""

NOTHING, LEAVE, MEET, REGION, STRIP = range(5)
SLIDE_OFF, SLOWED = 7, 8
"""Beside those of `rim_events`: a ball that creeps slides off, or one that slides is as slow as the knee of
its traction. The series of a ball that is many times as fast does not know the knee, and would pass it."""

AT_KNEE = 1.001
"""Speed over that of the knee from which a ball is not there yet."""


@inner_kernel
def at_time(c: Array, last: int, t: float, columns: int, out: Array) -> None:
    """Values at a time of the first columns of an array of series, which end at a power."""
    whole = columns - columns % 4
    for k in range(0, whole, 4):
        a0, a1, a2, a3 = c[last, k], c[last, k + 1], c[last, k + 2], c[last, k + 3]
        for n in range(last - 1, -1, -1):
            a0, a1 = a0 * t + c[n, k], a1 * t + c[n, k + 1]
            a2, a3 = a2 * t + c[n, k + 2], a3 * t + c[n, k + 3]
        out[k], out[k + 1], out[k + 2], out[k + 3] = a0, a1, a2, a3
    for k in range(whole, columns):
        a0 = c[last, k]
        for n in range(last - 1, -1, -1):
            a0 = a0 * t + c[n, k]
        out[k] = a0


@inner_kernel
def scaled(series: Array, last: int, column: int, h: float, c: Array) -> float:
    """Copy a series with the step as its unit of time; return a bound of its way in the step."""
    c[0] = series[0, column]
    way, power = 0.0, h
    for n in range(1, last + 1):
        c[n] = series[n, column] * power
        way += abs(c[n])
        power *= h
    end_at(c, last)
    return way


@inlined_kernel
def end_at(c: Array, last: int) -> None:
    """Set to zero what follows the last power of a series."""
    for n in range(last + 1, ORDER + 1):
        c[n] = 0.0


@inlined_kernel
def place_free(p: Numbers, parts: Parts, j: int, last: int) -> None:
    """Series of the place of a pocket against a ball, up to a power; a moving ball has its own already."""
    cos, sin, cage, ball = parts.cosine[j], parts.sine[j], parts.cage, parts.ball[j]
    for n in range(last + 1):
        along = cage[n, GY] * cos - cage[n, GX] * sin + cage[n, S]
        for k in range(2 * p.harmonics):
            along -= parts.drive[k, j] * cage[n, GONE + k]
        ball[n, DT] = along
        ball[n, DZ] = cage[n, Z] - (cage[n, GB] * cos - cage[n, GA] * sin)
    ball[0, DT] -= ball[0, LEAD]
    ball[0, DZ] -= ball[0, AXIAL]


@inlined_kernel
def ways(p: Numbers, parts: Parts, h: float) -> tuple[float, float]:
    """Bounds of the way of any pocket against a ball at rest within a step, along orbit and axis."""
    cage, last = parts.cage, parts.listed[LAST]
    along = axial = 0.0
    power = 1.0
    for n in range(1, last + 1):
        power *= h
        along += (abs(cage[n, GX]) + abs(cage[n, GY]) + abs(cage[n, S])) * power
        axial += (abs(cage[n, Z]) + abs(cage[n, GA]) + abs(cage[n, GB])) * power
    for k in range(2 * p.harmonics):
        most = own_way(cage, last, GONE + k, h)
        largest = 0.0
        for j in range(parts.moving.size):
            largest = max(largest, abs(parts.drive[k, j]))
        along += most * largest
    return along, axial


@inner_kernel
def own_way(c: Array, last: int, column: int, h: float) -> float:
    """Bound of the way of one series within a step."""
    total, power = 0.0, 1.0
    for n in range(1, last + 1):
        power *= h
        total += abs(c[n, column]) * power
    return total


@inner_kernel
def meet_round(p: Numbers, parts: Parts, j: int, h: float, end: float) -> float:
    """When the round part of a pocket meets its ball, up to a time."""
    ball, c, last = parts.ball[j], parts.c, parts.listed[LAST]
    shift, radius = parts.region[j] * p.apart, p.around + parts.play[j]
    power = 1.0
    for n in range(last + 1):
        square = 0.0
        for m in range(n + 1):
            square += ball[m, DZ] * ball[n - m, DZ] + ball[m, DT] * ball[n - m, DT]
        c[n] = (square - 2.0 * shift * ball[n, DT]) * power
        power *= h
    end_at(c, last)
    far = math.sqrt(ball[0, DZ] ** 2 + (ball[0, DT] - shift) ** 2)
    return first_zero(c, (radius - far) * (radius + far), -1.0, end, radius * radius)


@inner_kernel
def meet_flat(
    ball: Array, column: int, play: float, side: float, end: float, noise: float, c: Array
) -> float:
    """When a flat on one side meets its ball, up to a time; `c` is their place with the step as unit."""
    return first_zero(c, play - side * ball[0, column], -side, end, noise)


@inlined_kernel
def pocket_event(p: Numbers, parts: Parts, h: float) -> tuple[float, int, int, int]:
    """First change of a pocket within a step: when, what, which contact or ball, and what it becomes."""
    end, event, which, becomes = 1.0, NOTHING, -1, NONE
    along, axial = ways(p, parts, h)
    last, c = parts.listed[LAST], parts.c
    size = abs(parts.cage[0, S]) + abs(parts.cage[0, GX]) + abs(parts.cage[0, GY]) + p.around + p.apart
    for j in range(parts.moving.size):
        ball, moves = parts.ball[j], parts.moving[j] != 0
        one, two = parts.kind[2 * j], parts.kind[2 * j + 1]
        noise = size + abs(ball[0, LEAD])
        for i in (2 * j, 2 * j + 1):
            if parts.kind[i] != NONE and parts.kind[i] < OUTER_RIM:
                parts.contact[i, 0, WAY] = scaled(parts.contact[i], last, DEPTH, h, c)
                start = parts.contact[i, 0, DEPTH] + GRAINS * ROUNDING * noise
                if start > parts.contact[i, 0, WAY] or parts.kind[i] == GRIPPED:
                    continue
                t = first_zero(c, start, 1.0, end, noise)
                if t < end:
                    end, event, which, becomes = t, LEAVE, i, NONE
        if one == ROUND_END and not p.is_slot:
            continue
        if not moves:
            place_free(p, parts, j, 0)
        radius = p.around + parts.play[j]
        reach_t, reach_z = abs(ball[0, DT]) + along, abs(ball[0, DZ]) + axial
        if not moves:
            if p.is_round and not p.is_slot and reach_t**2 + reach_z**2 < radius**2:
                continue
            if not p.is_round and reach_t < radius and reach_z < p.beside:
                continue
            place_free(p, parts, j, last)
        reach_t = abs(ball[0, DT]) + own_way(ball, last, DT, h)
        reach_z = abs(ball[0, DZ]) + own_way(ball, last, DZ, h)
        if p.is_round:
            curved = parts.region[j] != 0 or not p.is_slot
            if curved and one == NONE and (p.is_slot or reach_t**2 + reach_z**2 >= radius**2):
                t = meet_round(p, parts, j, h, end)
                if t < end:
                    end, event, which, becomes = t, MEET, 2 * j, ROUND_END
            if p.is_slot and max(one, two) < OUTER_RIM:
                for side in (1.0, -1.0):
                    region = parts.region[j]
                    if region == side or (region == 0 and reach_t > p.apart):
                        # into the round part, or back from it between the flats
                        sign = side if region == 0 else -side
                        scaled(ball, last, DT, h, c)
                        start = p.apart - side * ball[0, DT] if region == 0 else side * ball[0, DT] - p.apart
                        t = first_zero(c, start, -sign, end, noise)
                        if t < end:
                            end, event, which, becomes = t, REGION, j, int(side) if region == 0 else 0
        elif one == NONE and reach_t >= radius:
            scaled(ball, last, DT, h, c)
            for side in (1.0, -1.0):
                t = meet_flat(ball, DT, radius, side, end, noise, c)
                if t < end:
                    end, event, which = t, MEET, 2 * j
                    becomes = FLAT_FRONT if side > 0.0 else FLAT_BACK
        flats = not p.is_round or (p.is_slot and parts.region[j] == 0)
        if flats and two == NONE and reach_z >= p.beside:
            scaled(ball, last, DZ, h, c)
            for side in (1.0, -1.0):
                t = meet_flat(ball, DZ, p.beside, side, end, noise, c)
                if t < end:
                    end, event, which = t, MEET, 2 * j + 1
                    becomes = FLAT_FRONT if side > 0.0 else FLAT_BACK
    return end, event, which, becomes


@inlined_kernel
def slide_event(
    p: Numbers, parts: Parts, share: float, h: float, end: float, event: int, which: int, becomes: int
) -> tuple[float, int, int, int]:
    """Earliest change up to a time, if before it a ball that creeps slides off or one that slides is slow."""
    c, last = parts.c, parts.listed[LAST]
    for b in range(parts.listed[BALLS]):
        j = parts.active[b]
        if p.knee == 0.0:
            continue
        if parts.creeping[j] == 0:
            speed = parts.ball[j, 0, SPEED]
            room = abs(speed) - share * p.knee
            if abs(speed) > AT_KNEE * share * p.knee and own_way(parts.ball[j], last, SPEED, h) > room:
                scaled(parts.ball[j], last, SPEED, h, c)
                t = first_zero(c, room, math.copysign(1.0, speed), end, share * p.knee)
                if t < end:
                    end, event, which, becomes = t, SLOWED, j, NONE
            continue
        way = scaled(parts.ball[j], last, ALONG, h, c)
        for side in (1.0, -1.0):
            room = p.slides_from - side * c[0]
            if way < room:
                continue
            t = first_zero(c, room, -side, end, p.slides_from)
            if t < end:
                end, event, which, becomes = t, SLIDE_OFF, j, NONE
    return end, event, which, becomes


@inlined_kernel
def strip_event(
    p: Numbers, parts: Parts, h: float, end: float, event: int, which: int, becomes: int
) -> tuple[float, int, int, int]:
    """Earliest change up to a time, if that of a strip of a land comes before."""
    c, gap, last = parts.c, p.land_gap, parts.listed[LAST]
    for i in range(parts.mode.size):
        strip = parts.strip[i]
        if parts.mode[i] == CLEAR:
            for n in range(last + 1):
                place_strip(parts, i, n)
            far = math.hypot(strip[0, LX], strip[0, LY])
            if far + own_way(strip, last, LX, h) + own_way(strip, last, LY, h) < gap:
                continue
            power = 1.0
            for n in range(last + 1):
                square = 0.0
                for m in range(n + 1):
                    square += strip[m, LX] * strip[n - m, LX] + strip[m, LY] * strip[n - m, LY]
                c[n] = square * power
                power *= h
            end_at(c, last)
            t = first_zero(c, (gap - far) * (gap + far), -1.0, end, gap * gap)
            if t < end:
                end, event, which, becomes = t, STRIP, i, PRESSED
            continue
        stiffness, damping = parts.strip_stiffness[i], parts.strip_damping[i]
        if parts.mode[i] == PRESSED:
            scaled(strip, last, PUSH_L, h, c)
            t = first_zero(c, max(0.0, c[0]), 1.0, end, stiffness * gap)
            if t < end:
                end, event, which, becomes = t, STRIP, i, RELEASED_OR_CLEAR
            continue
        scaled(strip, last, DEPTH_L, h, c)
        t = first_zero(c, c[0], 1.0, end, gap)
        if t < end:
            end, event, which, becomes = t, STRIP, i, CLEAR
        # Pressed again where K delta + c d(delta)/dt is back at zero
        power = 1.0
        for n in range(last):
            c[n] = power * (stiffness * strip[n, DEPTH_L] + damping * (n + 1) * strip[n + 1, DEPTH_L])
            power *= h
        end_at(c, last - 1)
        t = first_zero(c, max(0.0, -c[0]), -1.0, end, stiffness * gap)
        if t < end:
            end, event, which, becomes = t, STRIP, i, PRESSED
    return end, event, which, becomes


RELEASED_OR_CLEAR = 3
"""A strip whose force is gone: dented still, or not."""
