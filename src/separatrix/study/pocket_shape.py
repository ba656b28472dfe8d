"""Effect of a pocket's shape on its clearances: along the circumference, and the lean of the contact.

A cage that is offset from its balls along the bearing axis meets them with another part of its pockets: in
a round one there is less clearance, and the contact leans towards the axis.
"""

from __future__ import annotations

import math
from typing import Protocol

from separatrix.ground.schema import Spelled
from separatrix.ground.units import Metre, Ratio


class PocketShape(Spelled):
    """Wall of a pocket, seen along the radius; a spherical one wraps its ball, and so guides the cage."""

    SQUARE = "square"
    CYLINDRICAL = "cylindrical"
    ELONGATED = "elongated"
    SPHERICAL = "spherical"


class Pocket(Protocol):
    """A record with the pocket of a cage: `CageDesign`, or `MovingCage`."""

    @property
    def pocket_shape(self) -> PocketShape:
        """Shape of the pocket's wall, seen along the radius."""

    @property
    def pocket_clearance(self) -> Metre:
        """Clearance along the circumference, stop to stop, of a cage that is level with its balls [m]."""

    @property
    def pocket_axial_clearance(self) -> Metre | None:
        """Play along the bearing axis, stop to stop; of an elongated pocket [m]."""

    @property
    def pocket_axial_offset(self) -> Metre:
        """Distance of the cage from the plane of the balls, along the bearing axis [m]."""


def end_half_play(pocket: Pocket) -> Metre:
    """Half the clearance along the axis, and around a pocket's round end [m]; inf if square."""
    if pocket.pocket_shape is PocketShape.SQUARE:
        return math.inf
    if pocket.pocket_shape is not PocketShape.ELONGATED:
        return pocket.pocket_clearance / 2.0
    return (pocket.pocket_axial_clearance or 0.0) / 2.0


def half_play(pocket: Pocket) -> Metre:
    r"""Half the clearance of a ball along the circumference, :math:`c_p`, after shape and axial offset [m].

    Square: :math:`c`. Bore or sphere: :math:`\sqrt{c^2 - z^2}`. Elongated, with round ends:
    :math:`c - c_a + \sqrt{c_a^2 - z^2}`.
    """
    c, z, c_a = pocket.pocket_clearance / 2.0, pocket.pocket_axial_offset, end_half_play(pocket)
    if z == 0.0 or math.isinf(c_a):
        return c
    return c - c_a + math.sqrt((c_a - z) * (c_a + z))


def tilt(pocket: Pocket) -> tuple[Ratio, Ratio]:
    r"""Cosine and sine of :math:`\psi`, the lean of the contact from the circumference to the axis [-]."""
    z, c_a = pocket.pocket_axial_offset, end_half_play(pocket)
    sine = z / c_a if z != 0.0 else 0.0
    return math.sqrt((1.0 - sine) * (1.0 + sine)), sine


def edge_level(radius: Metre, along: Metre) -> Metre:
    """Height over the axis of the cage of an edge at a radius, at a place along the orbit [m]."""
    return math.sqrt(max(0.0, (radius - along) * (radius + along)))
