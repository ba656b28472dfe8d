"""Mass and inertia of a cage from its shape: a ring with a pocket for each ball."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.units import Kilogram, KilogramMetre2, Metre
from separatrix.study.ball_bearing import BallBearing
from separatrix.study.cage_design import CageDesign
from separatrix.study.pocket_shape import PocketShape

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


NO_MASS = "Give it, or inner_diameter, outer_diameter and width and a material with its density."


@dataclass(frozen=True, slots=True, kw_only=True)
class CageInertia:
    """Mass of a cage, and its moments of inertia about its axis and about a diameter."""

    mass: Kilogram
    moment_of_inertia: KilogramMetre2
    transverse_inertia: KilogramMetre2


def cage_inertia(design: CageDesign, bearing: BallBearing) -> CageInertia:
    """Mass and inertia as stated, else by the shape of the ring with its pockets, else of a thin ring.

    Raises
    ------
    InputError
        The mass is neither stated nor known from a shape and a density.
    """
    shape, mass = ring_of(design, bearing), design.mass
    if mass is None:
        density = design.material.density if design.material else None
        if shape is None or density is None:
            raise InputError("[cage] mass", "is missing", cure=NO_MASS)
        mass = density * shape.volume
    thin = mass * (bearing.pitch_diameter / 2.0) ** 2
    axial, transverse = shape.inertia(mass) if shape is not None else (thin, thin / 2.0)
    if design.moment_of_inertia is not None:  # what the mass has along the axis stays as it is
        transverse += (design.moment_of_inertia - axial) / 2.0
    return CageInertia(
        mass=mass,
        moment_of_inertia=design.moment_of_inertia or axial,
        transverse_inertia=design.transverse_inertia or transverse,
    )


def ring_of(design: CageDesign, bearing: BallBearing) -> RingBody | None:
    """Shape of the ring with its pockets; None where it is not given."""
    if design.inner_diameter is None or design.outer_diameter is None or design.width is None:
        return None
    across = design.pocket_axial_clearance or design.pocket_clearance
    return ring_body(
        inner_radius=design.inner_diameter / 2.0,
        outer_radius=design.outer_diameter / 2.0,
        width=design.width,
        pocket_count=bearing.ball_count,
        pocket_along=bearing.ball_diameter + design.pocket_clearance,
        pocket_across=bearing.ball_diameter + across,
        pocket_shape=design.pocket_shape,
    )
