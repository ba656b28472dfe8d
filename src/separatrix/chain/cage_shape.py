"""Mass and inertia of a study's cage, and what it has in space."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.cage.space_body import SpaceBody
from separatrix.cage_body import RingBody, ring_body
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape
from separatrix.units import Kilogram, KilogramMetre2, MetrePerSecond, NewtonPerMetre

if TYPE_CHECKING:
    from separatrix.chain.contacts import BearingState
    from separatrix.chain.mobility import Mobility
    from separatrix.study import BallBearing, CageDesign, StabilitySettings

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
    if shape is None and design.moment_of_inertia is not None:
        transverse = design.moment_of_inertia / 2.0
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


def space_body(
    design: CageDesign,
    bearing: BallBearing,
    state: BearingState,
    mobility: Mobility,
    settings: StabilitySettings,
    *,
    stiffness: NewtonPerMetre,
    inertia: CageInertia,
    impact_speed: MetrePerSecond,
) -> SpaceBody:
    """What the cage has in space: inertia, the spin of the balls, the yielding of their grooves, lands.

    The balls spin as on average; the pivoting speed is that of a contact as wide as in an impact at the
    impact speed: 8/(3 pi) times its radius and the ball's spin (Contensou).
    """
    spin = state.equilibrium.ball_spin.mean(axis=0)
    depth = impact_speed * math.sqrt(inertia.mass / 2.0 / stiffness)
    radius = math.sqrt(bearing.ball_diameter / 2.0 * depth)
    spacing = design.land_spacing or 0.0
    square = design.pocket_shape is PocketShape.SQUARE
    outer = design.outer_diameter if design.guidance.value == "outer" else design.inner_diameter
    land = design.land_diameter or outer
    return SpaceBody(
        transverse_inertia=inertia.transverse_inertia,
        ball_spin=(float(spin[0]), float(spin[1]), float(spin[2])),
        ball_diameter=bearing.ball_diameter,
        axial_play=design.pocket_clearance / 2.0 if square else math.inf,
        groove_damping=mobility.groove_damping,
        groove_stiffness=mobility.groove_stiffness,
        pivot_speed=8.0 / (3.0 * math.pi) * radius * math.hypot(*spin),
        land_heights=(-spacing / 2.0, spacing / 2.0) if design.land_count == 2 else (0.0,),
        land_width=design.land_width,
        land_radius=land / 2.0 if land is not None else None,
        axial_gravity=design.axial_gravity,
        dynamic_unbalance=design.dynamic_unbalance,
        added_mass=design.added_mass,
        axial_kick=settings.axial_kick,
        tilt_kick=settings.tilt_kick,
    )
