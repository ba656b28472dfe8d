r"""The points of a round edge that are nearest to a ball: one, or two where the ball is near its evolute.

With the ball at (z, t) from the middle of a round part, and :math:`s = u - V` the edge's height over it, the
distance has one minimum where :math:`\sqrt{t^2 + z^2} > 2\,b\,|s|/u`: the edge pulls the nearest point around
by an angle whose sine is at most half then. Closer in there may be two, and the ball is wedged between them.
"""

from __future__ import annotations

import math

from separatrix.cage.series import ROUNDING
from separatrix.compiled import inner_kernel

MOST_TURNS = 100
"""Of the search for a nearest point, whose every step halves at least where it may be."""

CELLS = 90
"""Parts of the circle in each of which a search looks for one minimum."""

GONE_ANGLE = 10.0
"""What stands for the angle of a point that does not exist."""


@inner_kernel
def slope_at(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, angle: float
) -> tuple[float, float]:
    """Half the slope of the squared distance over the radius, by the angle on a round edge, and its own."""
    sine, cosine = math.sin(angle), math.cos(angle)
    place = middle + radius * cosine
    level = math.sqrt((edge - place) * (edge + place))
    swept, over = place * sine, 1.0 - height / level
    slope = t * cosine + z * sine + (place * cosine - radius * sine * sine) * over
    slope += swept * height * place * radius * sine / level**3
    return t * sine - z * cosine + swept * over, slope


@inner_kernel
def squared_at(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, angle: float
) -> float:
    """Square of the distance of a point of a round edge from a ball."""
    along, axial = radius * math.cos(angle), radius * math.sin(angle)
    place = middle + along
    up = math.sqrt((edge - place) * (edge + place)) - height
    return (along - t) ** 2 + (axial - z) ** 2 + up * up


@inner_kernel
def minimum_between(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, low: float, high: float
) -> float:
    """Angle of the minimum of the distance between two angles, from falling to rising."""
    angle = 0.5 * (low + high)
    for _ in range(MOST_TURNS):
        f, slope = slope_at(t, z, height, radius, middle, edge, angle)
        if f > 0.0:
            high = angle
        else:
            low = angle
        other = angle - f / slope if slope > 0.0 else low - 1.0
        if not low < other < high:
            other = 0.5 * (low + high)
        if abs(other - angle) <= ROUNDING:
            break
        angle = other
    return angle


@inner_kernel
def is_single(t: float, z: float, height: float, radius: float, middle: float, edge: float) -> bool:
    """Whether a round edge has one nearest point for certain, by the bound of this module."""
    half = radius + abs(middle)
    low = math.sqrt((edge - half) * (edge + half))
    return math.hypot(t, z) * low >= 2.0 * half * max(abs(edge - height), abs(low - height))


@inner_kernel
def next_minimum(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, side: float, but: float
) -> float:
    """Angle of the deepest minimum on a round edge, other than one at an angle; `GONE_ANGLE` if none.

    `side` is 0 for a whole circle, else the direction along the orbit of the half of it that is edge.
    """
    turn = 2.0 * math.pi if side == 0.0 else math.pi
    first = -0.5 * turn if side >= 0.0 else 0.5 * math.pi
    best, found, cell = math.inf, GONE_ANGLE, turn / CELLS
    before, _ = slope_at(t, z, height, radius, middle, edge, first)
    for k in range(CELLS):
        low, high = first + k * cell, first + (k + 1) * cell
        after, _ = slope_at(t, z, height, radius, middle, edge, high)
        if before <= 0.0 < after:
            angle = minimum_between(t, z, height, radius, middle, edge, low, high)
            if but == GONE_ANGLE or abs(math.sin(0.5 * (angle - but))) > SAME:
                here = squared_at(t, z, height, radius, middle, edge, angle)
                if here < best:
                    best, found = here, angle
        before = after
    return found


SAME = 1e-4
"""Half the angle up to which two points of an edge are one."""


@inner_kernel
def nearest(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, side: float
) -> float:
    """Angle on a round edge of the point that is nearest to a ball, on the whole circle or a half of it."""
    if not is_single(t, z, height, radius, middle, edge):
        angle = next_minimum(t, z, height, radius, middle, edge, side, GONE_ANGLE)
        if angle != GONE_ANGLE:
            return angle
    angle = math.atan2(z, t)
    return float(_from(t, z, height, radius, middle, edge, angle))


@inner_kernel
def _from(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, angle: float
) -> float:
    """Angle of a minimum within a right angle of an angle, from which Newton's method starts."""
    low, high = angle - 0.5 * math.pi, angle + 0.5 * math.pi
    return float(minimum_between(t, z, height, radius, middle, edge, low, high))


@inner_kernel
def follow_minimum(
    t: float, z: float, height: float, radius: float, middle: float, edge: float, angle: float
) -> float:
    """Angle of the minimum that was at an angle a moment before; `GONE_ANGLE` if it is no more."""
    for _ in range(MOST_TURNS):
        f, slope = slope_at(t, z, height, radius, middle, edge, angle)
        if slope <= 0.0:
            return GONE_ANGLE
        step = f / slope
        if abs(step) > NEARBY:
            return GONE_ANGLE
        angle -= step
        if abs(step) <= ROUNDING:
            break
    return angle


NEARBY = 0.05
"""Largest step from where a minimum was."""
