"""The land that guides a cage: a one-sided spring and damper with dry friction, as power series."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage.series import product
from separatrix.cage.slots import (
    COS,
    DEPTH,
    DISTANCE,
    FX,
    FY,
    LOBE_COS,
    LOBE_SIN,
    NORMAL,
    NX,
    NY,
    PUSHED,
    SIN,
    TANGENT,
    TILT,
    TORQUE,
    TURN_COS,
    TURN_SIN,
    W,
)
from separatrix.compiled import inner_kernel

if TYPE_CHECKING:
    from separatrix.units import Ratio

LOWEST_RESTITUTION = 1e-4


def rebound(damping_ratio: Ratio) -> Ratio:
    r"""Restitution of a mass on a spring and a parallel damper that can push but not pull [-].

    The impact ends when the force is back at zero, before the spring is. With :math:`\beta = \zeta\omega` and
    :math:`\Omega = \omega\sqrt{|1-\zeta^2|}` (Schwager and Poeschel 2007, with their :math:`\omega_0` as unit
    of time).
    """
    zeta = damping_ratio
    if zeta == 0.0:
        return 1.0
    if zeta < 1.0:
        root = math.sqrt(1.0 - zeta * zeta)
        turned = math.atan2(2.0 * zeta * root, 2.0 * zeta * zeta - 1.0)
        return math.exp(-zeta / root * turned)
    if zeta == 1.0:
        return math.exp(-2.0)
    root = math.sqrt(zeta * zeta - 1.0)
    return math.exp(-zeta / root * 2.0 * math.log(zeta + root))


@lru_cache(maxsize=64)
def rebound_damping(restitution: Ratio) -> Ratio:
    """Damping ratio of the land whose `rebound` is this [-]; below 1e-4 that of 1e-4, hardly other than 0."""
    if restitution >= 1.0:
        return 0.0
    target = max(restitution, LOWEST_RESTITUTION)
    low, high = 0.0, 100.0
    while low < (middle := 0.5 * (low + high)) < high:  # down to neighbouring numbers
        low, high = (middle, high) if rebound(middle) > target else (low, middle)
    return low


@inner_kernel
def land_geometry(p, w, gx, gy, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the centre's distance, its direction and the depth in the land."""
    if n == 0:
        w[0, DISTANCE] = np.sqrt(w[0, gx] * w[0, gx] + w[0, gy] * w[0, gy])
        w[0, NX], w[0, NY] = w[0, gx] / w[0, DISTANCE], w[0, gy] / w[0, DISTANCE]
    else:
        square = product(w, gx, gx, n) + product(w, gy, gy, n)
        for i in range(1, n):
            square -= w[i, DISTANCE] * w[n - i, DISTANCE]
        w[n, DISTANCE] = square / (2.0 * w[0, DISTANCE])
        along, across = w[n, gx], w[n, gy]
        for i in range(1, n + 1):
            along -= w[i, DISTANCE] * w[n - i, NX]
            across -= w[i, DISTANCE] * w[n - i, NY]
        w[n, NX], w[n, NY] = along / w[0, DISTANCE], across / w[0, DISTANCE]
    w[n, DEPTH] = w[n, DISTANCE]
    if n == 0:
        w[0, DEPTH] -= p.land_gap
    if p.roundness != 0.0:
        lobes(p, w, n)
        w[n, DEPTH] += p.roundness * w[n, LOBE_COS]


@inner_kernel
def lobes(p, w, n):  # type: ignore[no-untyped-def]
    """Coefficient n of cosine and sine of the lobes' angle, and of that sine over the distance."""
    w[n, TURN_COS] = product(w, NX, COS, n) + product(w, NY, SIN, n)
    w[n, TURN_SIN] = product(w, NY, COS, n) - product(w, NX, SIN, n)
    last = p.lobe_rows + 2 * (p.lobes - 1)
    w[n, p.lobe_rows], w[n, p.lobe_rows + 1] = w[n, TURN_COS], w[n, TURN_SIN]
    for row in range(p.lobe_rows + 2, last + 2, 2):
        w[n, row] = product(w, row - 2, TURN_COS, n) - product(w, row - 1, TURN_SIN, n)
        w[n, row + 1] = product(w, row - 1, TURN_COS, n) + product(w, row - 2, TURN_SIN, n)
    w[n, LOBE_COS], w[n, LOBE_SIN] = w[n, last], w[n, last + 1]
    tilt = w[n, LOBE_SIN]
    for i in range(1, n + 1):
        tilt -= w[i, DISTANCE] * w[n - i, TILT]
    w[n, TILT] = tilt / w[0, DISTANCE]


@inner_kernel
def push_land(p, w, n):  # type: ignore[no-untyped-def]
    """Add coefficient n of the land's normal force to that of the forces and of the torque over M R."""
    w[n, NORMAL] = p.land_stiffness * w[n, DEPTH] + p.land_damping * (n + 1) * w[n + 1, DEPTH]
    w[n, FX] -= product(w, NORMAL, NX, n)
    w[n, FY] -= product(w, NORMAL, NY, n)
    if p.roundness != 0.0:
        lean(p, w, n)


@inner_kernel
def lean(p, w, n):  # type: ignore[no-untyped-def]
    """Turn the normal force by the slope of the lobes: it is along the gradient of the depth."""
    a = p.roundness * p.lobes
    w[n, PUSHED] = product(w, NORMAL, TILT, n)
    w[n, FX] -= a * product(w, PUSHED, NY, n)
    w[n, FY] += a * product(w, PUSHED, NX, n)
    w[n, TORQUE] -= a * product(w, NORMAL, LOBE_SIN, n) / p.radius


@inner_kernel
def rub_land(p, w, n):  # type: ignore[no-untyped-def]
    """Add coefficient n of the land's friction to that of the forces and of the torque over M R."""
    w[n, FX] -= product(w, TANGENT, NY, n)
    w[n, FY] += product(w, TANGENT, NX, n)
    w[n, TORQUE] += p.land_side * w[n, TANGENT]


@inner_kernel
def slide_speed(p, w, gx, gy, now, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the speed of the cage's surface on the ring's, from places up to n + 1."""
    speed = p.land_side * w[n, W]
    if n < 2:
        speed -= p.land_side * p.ring_slide * now[n]
    for i in range(n + 1):
        m = n - i + 1
        speed += m * (w[i, NX] * w[m, gy] - w[i, NY] * w[m, gx])
    return speed
