"""Mass and inertia of a cage from its shape, and whether it can be in its bearing."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.schema import Fault, Faults
from separatrix.ground.units import Kilogram, KilogramMetre2, Metre, format_quantity
from separatrix.study.ball_bearing import BallBearing
from separatrix.study.cage_design import SIGMAS, CageDesign, Guidance, PocketShape, least_step

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


# ---- the cage in its bearing

WIDEST = 4.0
"""Width that no bearing of one row has, in balls: beyond it a land or a mass is not on the cage."""

MOST_ADDED = 100.0
"""Mass of the fluid over that of the cage. A liquid that leaves a gap g at both sides of a land of width L
adds pi rho R L^3/(12 g): 70 cages half a ball thick, two balls wide and as dense, if g is a ball's 200th."""


def bars_are_left(cage: CageDesign, bearing: BallBearing) -> Faults:
    """A clearance of the pockets that leaves bars between them."""
    gap = bearing.ball_gap
    if cage.pocket_clearance >= gap:
        rule = f"must be smaller than the gap between balls, {format_quantity(gap, 'm')}"
        yield Fault(("cage", "pocket_clearance"), rule, "It is the clearance of one ball, stop to stop.")


def ring_between_rings(cage: CageDesign, bearing: BallBearing) -> Faults:
    """The ring lies between the grooves, and the walls of its pockets reach the equator of the balls."""
    if not cage.has_shape:
        return
    inner, outer, width = cage.inner_diameter or 0.0, cage.outer_diameter or 0.0, cage.width or 0.0
    pitch, ball = bearing.pitch_diameter, bearing.ball_diameter
    bottom, top = ("bottom of the inner groove", pitch - ball), ("bottom of the outer groove", pitch + ball)
    # a wall touches its ball up to half a pocket's length in front of it, where the ring's surface is lower
    half = (ball + cage.pocket_clearance + SIGMAS * cage.ball_diameter_scatter) / 2.0
    nearest = ("least at which a pocket's wall reaches the ball", 2.0 * math.hypot(pitch / 2.0, half))
    limits = {
        "inner_diameter": (inner, bottom, ("pitch diameter", pitch)),
        "outer_diameter": (outer, nearest, top),
    }
    short = "The walls of the pockets reach the equator of the balls."
    for key, (size, low, high) in limits.items():
        if not low[1] < size < high[1]:
            ends = (f"the {what}, {format_quantity(bound, 'm')}" for what, bound in (low, high))
            is_short = size >= high[1] if key == "inner_diameter" else size <= low[1]
            cure = short if is_short else "Beyond it is the ring."
            yield Fault(("cage", key), f"must lie between {' and '.join(ends)}", cure)
    least_bore = (ball + cage.pocket_clearance) / math.sin(math.pi / bearing.ball_count)
    if inner <= least_bore < pitch:
        rule = f"must be > {format_quantity(least_bore, 'm', 4)}, where bars are left between pockets"
        yield Fault(("cage", "inner_diameter"), rule, "A smaller pocket_clearance leaves more.")
    if width <= ball + cage.pocket_clearance:
        least = format_quantity(ball + cage.pocket_clearance, "m")
        yield Fault(("cage", "width"), f"must be larger than a pocket, {least}", "Pockets are holes.")


def lands_between_rings(cage: CageDesign, bearing: BallBearing) -> Faults:
    """Lands are on the cage, and those of the rings between the grooves; both are closer than a ball."""
    if (cage.land_clearance or 0.0) >= bearing.ball_diameter:  # it would lose its balls first
        rule = f"must be smaller than a ball, {format_quantity(bearing.ball_diameter, 'm')}"
        cure = 'It is the diametral clearance; for a cage without a land give guidance = "ball".'
        yield Fault(("cage", "land_clearance"), rule, cure)
    low, high = bearing.pitch_diameter - bearing.ball_diameter, bearing.pitch_diameter + bearing.ball_diameter
    is_outer, stated = cage.guidance is Guidance.OUTER, cage.land_diameter
    if stated is not None:
        ends, where = (low, high), "the bottoms of the grooves"
        if cage.has_shape:
            ends = cage.inner_diameter or low, cage.outer_diameter or high
            where = "the surfaces of the cage"
        if not ends[0] <= stated <= ends[1]:
            between = " and ".join(format_quantity(end, "m") for end in ends)
            yield Fault(("cage", "land_diameter"), f"must lie between {where}, {between}")
            return
    land = stated or (cage.outer_diameter if is_outer else cage.inner_diameter)
    if land is not None and cage.land_clearance is not None and cage.guidance is not Guidance.BALL:
        most = high - land if is_outer else land - low
        if 0.0 < most <= cage.land_clearance:
            left = format_quantity(most, "m")
            rule = f"must be smaller than what is left to the bottom of the groove, {left}"
            yield Fault(("cage", "land_clearance"), rule, "The land of the ring is beside its groove.")
    most, width = WIDEST * bearing.ball_diameter, (cage.land_spacing or 0.0) + cage.land_width
    if cage.width is None and width > most:
        key = "land_spacing" if (cage.land_spacing or 0.0) > cage.land_width else "land_width"
        rule = f"must leave all lands within {WIDEST:g} balls, {format_quantity(most, 'm')}"
        yield Fault(("cage", key), rule, "No bearing of one row is so wide.")


def body_that_can_be(cage: CageDesign, bearing: BallBearing) -> Faults:
    """Unbalance, fluid, and inertias that a body of this mass and size can have."""
    density = cage.material.density if cage.material else None
    if cage.mass is None and not (cage.has_shape and density is not None):
        return
    body = cage_inertia(cage, bearing)
    mass, pitch, ball = body.mass, bearing.pitch_diameter, bearing.ball_diameter
    if cage.unbalance >= mass * pitch / 2.0:
        rule = f"must be smaller than mass times pitch radius, {format_quantity(mass * pitch / 2.0, 'kg m')}"
        yield Fault(("cage", "unbalance"), rule, "It is mass times eccentricity.")
    if cage.added_mass > MOST_ADDED * mass:
        rule = f"must be at most {MOST_ADDED:g} times that of the cage, {format_quantity(mass, 'kg')}"
        yield Fault(("cage", "added_mass"), rule)
    if cage.moment_of_inertia is not None:
        least, most = (mass * (edge / 2.0) ** 2 for edge in (pitch - ball, pitch + ball))
        if not least <= cage.moment_of_inertia <= most:
            ends = " and ".join(format_quantity(value, "kg m2", 4) for value in (least, most))
            cure = "All of the mass would be beside a groove; left out, the inertia follows the mass."
            yield Fault(("cage", "moment_of_inertia"), f"must lie between {ends}", cure)
            return
    flat, wide = body.moment_of_inertia / 2.0, cage.width or WIDEST * ball
    bounds = flat * (1.0 - 1e-9), flat + mass * (wide / 2.0) ** 2
    if cage.transverse_inertia is not None and not bounds[0] <= cage.transverse_inertia <= bounds[1]:
        low, high = (format_quantity(value, "kg m2", 4) for value in (flat, bounds[1]))
        rule = f"must lie between {low}, half that about the axis, and {high}"
        cure = f"A flat ring has half of it, one with its mass {format_quantity(wide, 'm')} apart the most."
        yield Fault(("cage", "transverse_inertia"), rule, cure)


def pockets_for_balls(cage: CageDesign, bearing: BallBearing) -> Faults:
    """Uneven pockets: one for each ball, and a bar between any two."""
    across = min(cage.inner_diameter or math.inf, bearing.pitch_diameter)
    room = (bearing.ball_diameter + cage.pocket_clearance) / across
    if not 0.0 < room < math.sin(math.pi / bearing.ball_count):
        return  # overlapping already when even
    needed = 2.0 * math.asin(room)
    most = (1.0 - needed * bearing.ball_count / (2.0 * math.pi)) / 2.0
    if cage.pocket_spacing_scatter >= most:
        rule = (
            f"must be < {most:.4g}, where two neighbours that come close leave no bar between their pockets"
        )
        yield Fault(("cage", "pocket_spacing_scatter"), rule, "Fewer balls leave more room.")
    if cage.pocket_angles and len(cage.pocket_angles) != bearing.ball_count:
        rule = f"must hold one angle for each of the {bearing.ball_count} balls"
        cure = "Leave it out for evenly spaced pockets."
        yield Fault(("cage", "pocket_angles"), rule, cure, str(len(cage.pocket_angles)))
    elif cage.pocket_angles:
        step, i = least_step(cage.pocket_angles)
        if step <= needed:
            pockets = f"{i + 1} and {(i + 1) % len(cage.pocket_angles) + 1}"
            least = f"must be more than {format_quantity(needed, 'rad')} apart"
            rule = f"leave no bar between pockets {pockets}: {least}"
            yield Fault(("cage", "pocket_angles"), rule, got=format_quantity(step, "rad"))
