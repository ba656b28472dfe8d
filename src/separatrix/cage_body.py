"""Mass and inertia of a cage from its shape: a ring with a pocket for each ball."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.pocket_shape import PocketShape
from separatrix.units import Kilogram, KilogramMetre2, Metre

NODES = 40
"""Gauss points across a pocket, in the axial and in the tangential direction: exact to 1e-6 of its volume."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RingBody:
    """Volume of a body [m3], and its moments of inertia about its centre over the density [m5]."""

    volume: float
    axial: float
    transverse: float

    def inertia(self, mass: Kilogram) -> tuple[KilogramMetre2, KilogramMetre2]:
        """Moments of inertia about the axis and about a diameter, of this mass [kg m2]."""
        return mass * self.axial / self.volume, mass * self.transverse / self.volume


def ring_body(
    *,
    inner_radius: Metre,
    outer_radius: Metre,
    width: Metre,
    pocket_count: int = 0,
    pocket_along: Metre = 0.0,
    pocket_across: Metre = 0.0,
    pocket_shape: PocketShape = PocketShape.CYLINDRICAL,
) -> RingBody:
    """Shape of a ring with radial pockets, evenly spaced, in its middle plane.

    Parameters
    ----------
    inner_radius, outer_radius, width : float
        Of the ring [m].
    pocket_count : int
        Number of pockets.
    pocket_along, pocket_across : float
        Size of a pocket along the circumference and along the axis [m].
    pocket_shape : PocketShape
        Bore, slot with round ends along the circumference, or rectangle.
    """
    r_i, r_o, w = inner_radius, outer_radius, width
    volume = math.pi * (r_o**2 - r_i**2) * w
    axial = volume * (r_o**2 + r_i**2) / 2.0
    transverse = volume * (3.0 * (r_o**2 + r_i**2) + w**2) / 12.0
    if pocket_count:
        # over the pocket's opening, t along the circumference and z along the axis, the wall lies between
        # the radii sqrt(r_i^2 - t^2) and sqrt(r_o^2 - t^2)
        at, weight = np.polynomial.legendre.leggauss(NODES)
        z, half = 0.5 * pocket_across * at, np.full(NODES, 0.5 * pocket_along)
        if pocket_shape is not PocketShape.SQUARE:
            half = 0.5 * (pocket_along - pocket_across) + np.sqrt((0.5 * pocket_across) ** 2 - z**2)
        t = half[:, None] * at
        area = (0.5 * pocket_across * weight * half)[:, None] * weight
        low, high = np.sqrt(r_i**2 - t**2), np.sqrt(r_o**2 - t**2)
        depth, second = high - low, (high**3 - low**3) / 3.0
        removed, out = pocket_count * area * depth, pocket_count * area * second
        volume -= float(removed.sum())
        axial -= float((out + removed * t**2).sum())
        # pockets all around: half of what they lack about the axis, and their height twice
        transverse -= float((0.5 * (out + removed * t**2) + removed * z[:, None] ** 2).sum())
    return RingBody(volume=volume, axial=axial, transverse=transverse)
