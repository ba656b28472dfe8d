r"""A ball whose pocket's round edge has two points that are as near to it: it is wedged between them.

The edge touches at its nearest point. As soon as another point is as near, both touch, each by a spring of
half the stiffness: stored energy is that of the one before, and the ball is held between them. A point of the
two that comes free, or that is no longer a minimum of the distance, leaves all energy to the other. So
:math:`\sum k_i\,\delta_i^2` never changes but by work, and a contact has less than the stiffness :math:`k`
only from there until it comes free.

The second point is on the same round part, in the other contact of the ball (`Parts.paired`), or one is on a
round end of a slot and the other on its flat.
"""

from __future__ import annotations

import math

from separatrix.cage.space.edge_points import (
    GONE_ANGLE,
    SAME,
    follow_minimum,
    is_single,
    next_minimum,
    slope_at,
    squared_at,
)
from separatrix.cage.space.records import (
    CONTACTS,
    DEPTH,
    DT,
    DZ,
    EDGE_R,
    EDGE_T,
    EDGE_Z,
    GX,
    GY,
    IN_Z,
    LAST,
    NONE,
    OUTER_CLEAR,
    OUTER_RIM,
    RIM_COS,
    RIM_SIN,
    RIMS,
    Numbers,
    Parts,
)
from separatrix.cage.space.rim import find_round, is_on_round, place_edge
from separatrix.cage.space.rim_events import met_kind, place_ball, region_of
from separatrix.compiled import inner_kernel
from separatrix.units import Array

FLAT = 2
"""What stands for the region of a point on a flat; those of the round parts are -1, 0 and 1."""

SHALLOW = 1e-8
"""Depth over the ball's radius up to which the energy of a spring is none."""

AGREES = 1e-9
"""Difference of two depths over the ball's radius up to which they are of one point."""


FIRM = 0.001
"""Least curvature of the squared distance at one of two points, over that where no edge pulls it around."""


@inner_kernel
def mark_points(parts: Parts, t: float) -> None:
    """Keep where on round edges the contacts of a step have come to at its end."""
    last, count = parts.listed[LAST], parts.listed[CONTACTS]
    for a in range(count - parts.listed[RIMS], count):
        e = parts.rim[parts.touching[a]]
        sine, cosine = e[last, RIM_SIN], e[last, RIM_COS]
        for n in range(last - 1, -1, -1):
            sine, cosine = sine * t + e[n, RIM_SIN], cosine * t + e[n, RIM_COS]
        e[0, RIM_SIN], e[0, RIM_COS] = sine, cosine


@inner_kernel
def tend_edges(p: Numbers, parts: Parts) -> None:
    """Find between steps which points of the round edges of all pockets touch."""
    if not p.is_round:
        return
    for j in range(parts.moving.size):
        one, two = parts.kind[2 * j] >= OUTER_RIM, parts.kind[2 * j + 1] >= OUTER_RIM
        if not (one or two):
            continue
        place_ball(parts, j)
        height = p.radius - parts.cage[0, GX] * parts.cosine[j] - parts.cage[0, GY] * parts.sine[j]
        if one and two:
            keep_both(p, parts, j, height)
        else:
            seek_another(p, parts, j, 2 * j if one else 2 * j + 1, height)


@inner_kernel
def edge_of(p: Numbers, parts: Parts, i: int) -> float:
    """Radius of the surface that ends the wall at a contact's edge."""
    return float(p.outer_edge if parts.kind[i] % 2 == 0 else p.inner_edge)


@inner_kernel
def followed(p: Numbers, parts: Parts, i: int, height: float) -> float:
    """Angle of the point of a contact on a round edge, from where it was; `GONE_ANGLE` if it is no more."""
    j, e = i // 2, parts.rim[i, 0]
    region = float(parts.region[j])
    t, z, radius = region * p.apart - parts.ball[j, 0, DT], -parts.ball[j, 0, DZ], radius_of(p, parts, j)
    angle, middle = math.atan2(e[RIM_SIN], e[RIM_COS]), -region * p.apart
    return float(follow_minimum(t, z, height, radius, middle, edge_of(p, parts, i), angle))


@inner_kernel
def radius_of(p: Numbers, parts: Parts, j: int) -> float:
    """Radius of the round part of a pocket."""
    return float(p.ball_radius + p.around + parts.play[j])


@inner_kernel
def depth_on_round(
    p: Numbers, parts: Parts, j: int, height: float, edge: float, region: int, angle: float
) -> float:
    """Depth of a ball at a point of a round edge; -inf where the wall does not end before the ball."""
    t, z, middle = region * p.apart - parts.ball[j, 0, DT], -parts.ball[j, 0, DZ], -region * p.apart
    radius = radius_of(p, parts, j)
    place = middle + radius * math.cos(angle)
    level = math.sqrt((edge - place) * (edge + place))
    if (level > height) != (edge == p.inner_edge):
        return -math.inf
    return float(p.ball_radius - math.sqrt(squared_at(t, z, height, radius, middle, edge, angle)))


@inner_kernel
def is_firm(p: Numbers, parts: Parts, j: int, height: float, edge: float, region: int, angle: float) -> bool:
    """Whether the distance rises beside a minimum on a round edge as much as is needed to follow it."""
    t, z, middle = region * p.apart - parts.ball[j, 0, DT], -parts.ball[j, 0, DZ], -region * p.apart
    _, slope = slope_at(t, z, height, radius_of(p, parts, j), middle, edge, angle)
    return bool(slope > FIRM * math.hypot(t, z))


@inner_kernel
def depth_on_flat(p: Numbers, parts: Parts, j: int, height: float, edge: float) -> float:
    """Depth of a ball at the edge of a slot's flat; -inf where the nearest point is not on it."""
    t, z = -parts.ball[j, 0, DT], -parts.ball[j, 0, DZ]
    far = math.hypot(t, height)
    if abs(t) * edge > p.apart * far or (edge > far) != (edge == p.inner_edge):
        return -math.inf
    beside = p.ball_radius + p.beside - abs(z)
    return float(p.ball_radius - math.hypot(beside, edge - far))


@inner_kernel
def another_point(
    p: Numbers, parts: Parts, j: int, height: float, edge: float, mine: int, angle: float
) -> tuple[float, int, float]:
    """Depth, region and angle of the deepest point of an edge beside the contact's own."""
    best, where, there = -math.inf, FLAT, GONE_ANGLE
    t, z, radius = -parts.ball[j, 0, DT], -parts.ball[j, 0, DZ], radius_of(p, parts, j)
    for region in range(-1, 2):
        if (region == 0) == p.is_slot or (mine != FLAT and region != mine):
            continue
        from_middle, middle = t + region * p.apart, -region * p.apart
        if is_single(from_middle, z, height, radius, middle, edge) and mine == region:
            continue
        but = angle if mine == region else GONE_ANGLE
        found = next_minimum(from_middle, z, height, radius, middle, edge, -float(region), but)
        if found != GONE_ANGLE and is_firm(p, parts, j, height, edge, region, found):
            depth = depth_on_round(p, parts, j, height, edge, region, found)
            if depth > best:
                best, where, there = depth, region, found
    if p.is_slot and mine != FLAT:
        depth = depth_on_flat(p, parts, j, height, edge)
        if depth > best:
            best, where, there = depth, FLAT, GONE_ANGLE
    return best, where, there


@inner_kernel
def is_plain(p: Numbers, parts: Parts, j: int, height: float, edge: float) -> bool:
    """Whether a ball has one nearest point on an edge for certain."""
    t, z = abs(parts.ball[j, 0, DT]), parts.ball[j, 0, DZ]
    return bool(is_single(max(0.0, t - p.apart), z, height, radius_of(p, parts, j), p.apart, edge))


@inner_kernel
def seek_another(p: Numbers, parts: Parts, j: int, i: int, height: float) -> None:
    """Let a ball on one point of an edge touch another too, where that is as near."""
    edge, depth = edge_of(p, parts, i), parts.contact[i, 0, DEPTH]
    if is_plain(p, parts, j, height, edge):
        return
    mine, angle, is_gone = FLAT, GONE_ANGLE, False
    if i % 2 == 0:
        mine, angle = parts.region[j], followed(p, parts, i, height)
        is_gone = angle == GONE_ANGLE
        if not is_gone:
            here = depth_on_round(p, parts, j, height, edge, mine, angle)
            is_gone = here > -math.inf and abs(here - depth) > AGREES * p.ball_radius
    best, where, there = another_point(p, parts, j, height, edge, mine, angle)
    if best <= depth + AGREES * p.ball_radius:
        return
    kind, stiff = parts.kind[i], parts.stiff[i]
    is_clear = kind >= OUTER_CLEAR
    if is_gone or is_clear:
        parts.kind[i] = NONE
        put(parts, j, kind, where, there, best, 0)
        k = 2 * j + 1 if where == FLAT else 2 * j
        if where == FLAT:
            parts.region[j] = 0
        parts.stiff[k] = stiff if is_clear else stiff_for(p, stiff * depth * depth, best)
        return
    both = 0.5 * stiff
    if best > SHALLOW * p.ball_radius:
        both = stiff * depth * depth / (depth * depth + best * best)
    parts.stiff[i] = both
    pairs = mine != FLAT and where == mine
    if pairs:
        parts.rim[i, 0, RIM_SIN], parts.rim[i, 0, RIM_COS] = math.sin(angle), math.cos(angle)
        parts.paired[j] = 1
    put(parts, j, kind, where, there, best, 1 if pairs else 0)
    parts.stiff[2 * j + 1 if pairs or where == FLAT else 2 * j] = both


@inner_kernel
def put(parts: Parts, j: int, kind: int, where: int, angle: float, depth: float, second: int) -> None:
    """Let a contact of a ball be at a point of an edge: on a flat, or first or second on a round part."""
    i = 2 * j + 1 if where == FLAT else 2 * j + second
    parts.kind[i], parts.contact[i, 0, DEPTH] = kind, depth
    if where != FLAT:
        parts.region[j] = where
        parts.rim[i, 0, RIM_SIN], parts.rim[i, 0, RIM_COS] = math.sin(angle), math.cos(angle)


@inner_kernel
def stiff_for(p: Numbers, twice_energy: float, depth: float) -> float:
    """Stiffness of a spring that holds an energy at a depth; the usual one where both are next to nothing."""
    if depth <= SHALLOW * p.ball_radius:
        return float(p.stiffness)
    return twice_energy / (depth * depth)


@inner_kernel
def twice_energy_of(parts: Parts, i: int) -> float:
    """Twice the energy of a contact's spring."""
    return float(parts.stiff[i] * parts.contact[i, 0, DEPTH] ** 2)


@inner_kernel
def keep_both(p: Numbers, parts: Parts, j: int, height: float) -> None:
    """Drop one of two points of an edge that is no minimum of the distance any more."""
    gone = -1
    for i in range(2 * j, 2 * j + 2):
        if not is_on_round(p, parts, i):
            continue
        angle, depth = followed(p, parts, i, height), -math.inf
        if angle != GONE_ANGLE and is_firm(p, parts, j, height, edge_of(p, parts, i), parts.region[j], angle):
            depth = depth_on_round(p, parts, j, height, edge_of(p, parts, i), parts.region[j], angle)
        is_same = abs(depth - parts.contact[i, 0, DEPTH]) <= AGREES * p.ball_radius
        if not is_same and (gone < 0 or parts.contact[i, 0, DEPTH] < parts.contact[gone, 0, DEPTH]):
            gone = i
    if gone < 0 and parts.paired[j] != 0:
        one, two = parts.rim[2 * j, 0], parts.rim[2 * j + 1, 0]
        sine = one[RIM_SIN] * two[RIM_COS] - one[RIM_COS] * two[RIM_SIN]
        if abs(sine) < 2.0 * SAME and one[RIM_COS] * two[RIM_COS] + one[RIM_SIN] * two[RIM_SIN] > 0.0:
            gone = 2 * j + 1
    if gone >= 0:
        leave_to_other(p, parts, gone)


@inner_kernel
def leave_to_other(p: Numbers, parts: Parts, gone: int) -> None:
    """Leave the energy of one of a ball's two points to the other."""
    j, other = gone // 2, gone + 1 - 2 * (gone % 2)
    energy = twice_energy_of(parts, gone) + twice_energy_of(parts, other)
    parts.stiff[other] = stiff_for(p, energy, parts.contact[other, 0, DEPTH])
    parts.kind[gone] = NONE
    if parts.paired[j] != 0:
        if other % 2 == 1:
            exchange(parts, j)
        parts.paired[j] = 0
    elif other % 2 == 1:
        parts.region[j] = 0


@inner_kernel
def exchange(parts: Parts, j: int) -> None:
    """Exchange the two contacts of a ball."""
    one, two = 2 * j, 2 * j + 1
    parts.kind[one], parts.kind[two] = parts.kind[two], parts.kind[one]
    parts.stiff[one], parts.stiff[two] = parts.stiff[two], parts.stiff[one]
    swap(parts.contact[one, 0], parts.contact[two, 0], DEPTH)
    swap(parts.rim[one, 0], parts.rim[two, 0], RIM_SIN)
    swap(parts.rim[one, 0], parts.rim[two, 0], RIM_COS)


@inner_kernel
def swap(one: Array, two: Array, column: int) -> None:
    """Exchange a column of two rows."""
    one[column], two[column] = two[column], one[column]


@inner_kernel
def come_to_edge(p: Numbers, parts: Parts, i: int) -> None:
    """Find the nearest point of an edge that a contact has come to, and its depth."""
    j, e = i // 2, parts.rim[i]
    if not is_on_round(p, parts, i):
        return
    place_ball(parts, j)
    place_edge(p, parts, i, 0)
    e[0, RIM_SIN] = e[0, RIM_COS] = 0.0
    find_round(p, parts, i, edge_of(p, parts, i))
    square = e[0, EDGE_Z] ** 2 + e[0, EDGE_R] ** 2 + e[0, EDGE_T] ** 2
    parts.contact[i, 0, DEPTH] = p.ball_radius - math.sqrt(square)


@inner_kernel
def change_edge(p: Numbers, parts: Parts, which: int, becomes: int) -> None:
    """Change the kind of a contact at an edge: to the edge, clear of it, to the wall, or to nothing."""
    j, other = which // 2, which + 1 - 2 * (which % 2)
    if not p.is_round or parts.kind[which] < OUTER_RIM or parts.kind[other] < OUTER_RIM:
        before = parts.kind[which]
        if before >= OUTER_CLEAR and becomes != NONE and becomes < OUTER_RIM:
            # Clear of the edge it cannot touch the wall: its nearest point moves faster than its series
            becomes = met_kind(p, parts, which, becomes)
        parts.kind[which] = becomes
        if becomes == NONE and p.is_slot:
            parts.region[j] = region_of(p, parts, j)
        if becomes >= OUTER_CLEAR or (becomes >= OUTER_RIM and before < OUTER_RIM):
            come_to_edge(p, parts, which)
        return
    if becomes == NONE or becomes >= OUTER_CLEAR:
        leave_to_other(p, parts, which)
        return
    # The wall is the nearest there
    was_paired = parts.paired[j] != 0
    leave_to_other(p, parts, other)
    at = 2 * j if was_paired else which
    parts.kind[at] = becomes


@inner_kernel
def pass_edge(p: Numbers, parts: Parts, which: int, becomes: int) -> None:
    """Let a contact at the edge of a slot pass between its flat and its round end."""
    j, other = which // 2, which + 1 - 2 * (which % 2)
    if parts.kind[other] < OUTER_RIM:
        parts.kind[other], parts.kind[which] = parts.kind[which], NONE
        parts.contact[other, 0, DEPTH] = parts.contact[which, 0, DEPTH]
        parts.stiff[other] = parts.stiff[which]
        parts.region[j] = becomes
        if other % 2 == 0:
            parts.rim[other, 0, RIM_SIN], parts.rim[other, 0, RIM_COS] = (
                math.copysign(1.0, parts.rim[which, 0, IN_Z]),
                0.0,
            )
    elif parts.paired[j] != 0:
        if which % 2 == 0:
            exchange(parts, j)
        parts.paired[j] = 0
    else:
        leave_to_other(p, parts, which)
