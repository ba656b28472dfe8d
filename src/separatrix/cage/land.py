"""The land that guides a cage: a one-sided spring and damper with dry friction, as an impulse over a step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from separatrix.compiled import kernel

if TYPE_CHECKING:
    from separatrix.units import Ratio

LOWEST_RESTITUTION = 1e-4


def rebound(damping_ratio: Ratio) -> Ratio:
    r"""Restitution of a mass on a spring and a parallel damper that can push but not pull [-].

    The blow ends when the force is back at zero, before the spring is. With :math:`\beta = \zeta\omega` and
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


def rebound_damping(restitution: Ratio) -> Ratio:
    """Damping ratio of the land whose `rebound` is this [-]; below 1e-4 that of 1e-4, hardly other than 0."""
    if restitution >= 1.0:
        return 0.0
    target = max(restitution, LOWEST_RESTITUTION)
    return float(brentq(lambda zeta: rebound(zeta) - target, 0.0, 100.0, xtol=1e-14))


@kernel
def land_impulse(p, x, y, vx, vy, spin, dt):  # type: ignore[no-untyped-def]
    r"""Impulse of the land on the cage over one step, from the state at its middle.

    Normal: :math:`F = \max(0, K\delta + c\dot\delta)`, implicit in the damper, with the part of the step in
    touch. Friction: opposite to the sliding of the cage's surface on the ring's, at most mu times the normal
    impulse and no more than what stops the sliding (exact stick).

    Returns
    -------
    tuple of float
        Impulse x and y [N s], its moment about the cage centre [N m s] and the normal impulse [N s].
    """
    r = np.sqrt(x * x + y * y)
    depth = r - p.land_gap
    if r == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    nx, ny = x / r, y / r
    closing = nx * vx + ny * vy
    reach = 0.5 * closing * dt
    first, last = depth - reach, depth + reach
    if first <= 0.0 and last <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    share, mean = 1.0, depth
    if first < 0.0 or last < 0.0:
        deepest = max(first, last)
        share = deepest / abs(last - first)
        mean = 0.5 * deepest * share
    damping = p.land_damping * share * dt
    normal = (p.land_stiffness * mean * dt + damping * closing) / (1.0 + 0.5 * damping * p.lightness)
    if normal <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    # Outer land: the cage touches on the side of its offset; inner land: on the opposite side.
    side = p.land_side
    sliding = -ny * vx + nx * vy + side * (spin * p.radius - p.ring_slide)
    yielding = p.lightness + p.radius * p.radius * p.swiftness
    limit = p.land_friction * normal
    tangent = -min(max(sliding / yielding, -limit), limit)
    return -normal * nx - tangent * ny, -normal * ny + tangent * nx, side * tangent * p.radius, normal
