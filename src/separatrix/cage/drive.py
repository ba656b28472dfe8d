"""What moves a cage without any kick, and the room that its centre has."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from separatrix.cage.linear import drift_law
from separatrix.units import Joule, Metre

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage


def room(cage: PlanarCage) -> Metre:
    """Offset that the cage centre has: to its land, or half its pockets' play without a land [m]."""
    return cage.half_play if math.isinf(cage.land_gap) else cage.land_gap


def drive_energy(cage: PlanarCage) -> Joule:
    r"""Kinetic energy that the frame and the loads can give the cage over its room, without any kick [J].

    .. math:: \tfrac12 M (\Omega w)^2 + 2 w (M g + U \Omega^2) + \tfrac12 (M + J/R^2) (2 V)^2

    with the room :math:`w`: the depth of the centrifugal potential, which is also the energy, in the turning
    frame, of a cage that rests on its land at a place fixed in space; the fall across the room under
    gravity and unbalance; and an impact of balls that lead and lag at speeds up to V.
    """
    w, M, speed = room(cage), cage.mass, cage.cage_speed
    fall = 2.0 * w * (M * cage.gravity + cage.unbalance * speed**2)
    pairs = zip(cage.orbital_cosines, cage.orbital_sines, strict=True)
    V = sum(math.hypot(*pair) for pair in pairs)
    struck = M + cage.moment_of_inertia / cage.pitch_radius**2
    return 0.5 * M * (speed * w) ** 2 + fall + 0.5 * struck * (2.0 * V) ** 2


def drifts(cage: PlanarCage) -> bool:
    """Whether nothing holds the cage centre: no land, and the turning of the ball set or gravity moves it."""
    return math.isinf(cage.land_gap) and (cage.cage_speed != 0.0 or cage.gravity > 0.0)


def drift_rate_law(cage: PlanarCage) -> float:
    """Rate at which the linear law has a landless cage drift [1/s]; 0 for one that a land holds."""
    return drift_law(cage) if math.isinf(cage.land_gap) else 0.0
