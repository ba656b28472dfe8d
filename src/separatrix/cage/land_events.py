"""What ends a step at the land: it is met, left or pressed again, or its sliding stops or starts."""

from __future__ import annotations

import numpy as np

from separatrix.cage.events import (
    LAND_CLEAR,
    LAND_LEAVE,
    LAND_PRESS,
    LAND_TOUCH,
    SLIDE_START,
    SLIDE_STOP,
    larger,
)
from separatrix.cage.land import land_geometry
from separatrix.cage.series import ORDER, THIRD, copy_column, first_zero, product
from separatrix.cage.slots import (
    CLEAR,
    DEPTH,
    FORWARD,
    GX,
    GY,
    NORMAL,
    RELEASED,
    SLIDING,
    STICK,
    TANGENT,
    VX,
    VY,
    W,
    X,
    Y,
)
from separatrix.compiled import inlined_kernel, inner_kernel


@inner_kernel
def land_change(p, w, land, h, end, kind, knot, off, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the land's comes first, and what it is."""
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    if land == CLEAR:
        return meet_land(p, w, gx, gy, end, kind, knot, off, c)
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
    # The force is a difference of places of the size of the gap, and moves the sliding by as much rounding.
    noise = abs(w[0, VX]) + abs(w[0, VY]) + abs(w[0, W]) + abs(p.ring_slide)
    noise += h * p.land_stiffness * p.land_gap * (1.0 + p.swiftness)
    t = first_zero(c, max(0.0, sign * c[0]), sign, end, noise)
    return (t, SLIDE_STOP) if t < end else (end, kind)


@inlined_kernel
def farthest(w, gx, gy, knot):  # type: ignore[no-untyped-def]
    """Bound on the distance of the centre by its knots, without what lies off the cubics between them."""
    x, y = w[0, gx], w[0, gy]
    square = x * x + y * y
    x, y = x + THIRD * knot[0, gx], y + THIRD * knot[0, gy]
    square = larger(square, x * x + y * y)
    for row, side in ((1, -THIRD), (1, THIRD), (3, -THIRD), (3, 0.0)):
        x, y = knot[row, gx] + side * knot[row + 1, gx], knot[row, gy] + side * knot[row + 1, gy]
        square = larger(square, x * x + y * y)
    return np.sqrt(square)


@inlined_kernel
def meet_land(p, w, gx, gy, end, kind, knot, off, c):  # type: ignore[no-untyped-def]
    """Earliest change up to a time, if the cage meets its land before, and what it is."""
    near = np.sqrt(w[0, gx] ** 2 + w[0, gy] ** 2)
    if farthest(w, gx, gy, knot) < (p.land_gap - abs(p.roundness) - off / 384.0):
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


@inner_kernel
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
