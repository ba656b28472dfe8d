"""From the cage of a study to the cage that moves."""

from __future__ import annotations

import math
import warnings
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from separatrix.cage import PlanarCage
from separatrix.cage.space_body import SpaceBody
from separatrix.errors import ValidityWarning
from separatrix.study import Guidance
from separatrix.units import MetrePerSecond, NewtonPerMetre, format_quantity

if TYPE_CHECKING:
    from separatrix.cage_body import CageInertia
    from separatrix.chain.contacts import BearingState
    from separatrix.chain.mobility import Mobility
    from separatrix.study import BallBearing, CageDesign, StabilitySettings


_NOT_COPIED = {
    *("mass", "moment_of_inertia", "ball_cage_stiffness", "ball_cage_friction"),  # the chain computes these
    "clearances",  # these are the running ones
    *("material", "material_name", "pocket_contact", "impact_speed"),  # they are in the pocket's stiffness
    *("inner_diameter", "outer_diameter", "width", "transverse_inertia"),  # these are in the inertia
    *("ball", "motion"),  # the models, in `traction` and `space`
    *("land_spacing", "land_width", "land_diameter", "dynamic_unbalance", "axial_gravity", "added_mass"),
}


def as_designed(design: CageDesign) -> dict[str, Any]:
    """What the moving cage takes from the design as it is: all other fields, under the same names."""
    return {f.name: getattr(design, f.name) for f in fields(design) if f.name not in _NOT_COPIED}


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
    outer = design.outer_diameter if design.guidance is Guidance.OUTER else design.inner_diameter
    land = design.land_diameter or outer
    return SpaceBody(
        transverse_inertia=inertia.transverse_inertia,
        ball_spin=(float(spin[0]), float(spin[1]), float(spin[2])),
        ball_diameter=bearing.ball_diameter,
        axial_play=(design.pocket_axial_clearance or design.pocket_clearance) / 2.0,
        groove_damping=mobility.linear.groove_damping,
        groove_stiffness=mobility.linear.groove_stiffness,
        pivot_speed=8.0 / (3.0 * math.pi) * radius * math.hypot(*spin),
        land_heights=(-spacing / 2.0, spacing / 2.0) if design.land_count == 2 else (0.0,),
        land_width=design.land_width,
        land_radius=land / 2.0 if land is not None else None,
        inner_radius=design.inner_diameter / 2.0 if design.inner_diameter else None,
        outer_radius=design.outer_diameter / 2.0 if design.outer_diameter else None,
        axial_gravity=design.axial_gravity,
        dynamic_unbalance=design.dynamic_unbalance,
        added_mass=design.added_mass,
        axial_kick=settings.axial_kick,
        tilt_kick=settings.tilt_kick,
    )


def warn_if_balls_are_driven(cage: PlanarCage) -> None:
    """Warn where free balls would lead and lag by more than their clearance."""
    if cage.lead_amplitude > cage.half_play:
        lead, clearance = (format_quantity(x, "m", 3) for x in (cage.lead_amplitude, cage.half_play))
        warnings.warn(
            f"Unconstrained, the balls would lead and lag by up to {lead} under this load, more than half "
            f"their clearance in a pocket, {clearance}: the cage has to drive them, which adds load and "
            "wear.",
            ValidityWarning,
            stacklevel=4,
        )
