"""Cages and bearings from which the tests of several files start, and short ways to run a cage."""

import math
from dataclasses import replace

import numpy as np

from separatrix.cage import History, PlanarCage, follow
from separatrix.study import BallBearing, Guidance, Material

AT_REST = PlanarCage(
    mass=0.05, moment_of_inertia=0.05 * 0.0325**2, ball_count=11, pitch_radius=0.0325, cage_speed=0.0,
    inner_speed=1500.0, outer_speed=0.0, pocket_clearance=6e-4, ball_cage_stiffness=3e6, race_damping=2000.0,
    ball_cage_friction=0.1,
)  # fmt: skip
"""A thin ring in a ball set at rest, without a land."""

SMALL = replace(AT_REST, moment_of_inertia=0.05 * 0.03**2, pitch_radius=0.03, inner_speed=1000.0)
"""The same in a smaller bearing."""

TURNING = PlanarCage(
    mass=0.025, moment_of_inertia=0.025 * 0.0325**2, ball_count=13, pitch_radius=0.0325, cage_speed=670.0,
    inner_speed=1570.0, outer_speed=0.0, pocket_clearance=6e-4, ball_cage_stiffness=3e6, race_damping=800.0,
    ball_cage_friction=0.12,
)  # fmt: skip
"""A thin ring of 25 g in a turbopump's ball set, without a land."""

ON_A_LAND = replace(TURNING, guidance=Guidance.OUTER, land_clearance=1e-3)

STEEL = Material(name="440C", elastic_modulus=205e9, poisson_ratio=0.285, density=7650.0)
BEARING = BallBearing(
    ball_diameter=11.1125e-3, pitch_diameter=65e-3, ball_count=13, contact_angle=math.radians(25.0),
    inner_conformity=0.52, outer_conformity=0.53, ball_material=STEEL, ring_material=STEEL,
)  # fmt: skip
"""A turbopump's bearing."""

STEEL_218 = Material(name="steel", elastic_modulus=206.84e9, poisson_ratio=0.3, density=7800.0)
BEARING_218 = BallBearing(
    ball_diameter=22.23e-3, pitch_diameter=125.26e-3, ball_count=16, contact_angle=math.radians(40.0),
    inner_conformity=0.523167, outer_conformity=0.523167, ball_material=STEEL_218, ring_material=STEEL_218,
)  # fmt: skip
"""The bearing of the rolling-bearing books."""


def damping_of(eta: float) -> float:
    """C_mu at which `AT_REST` has this nominal restitution factor (physics of Eq. 17 as modelled)."""
    zeta = -math.log(eta) / math.hypot(math.pi, math.log(eta))
    return math.sqrt(AT_REST.ball_cage_stiffness * AT_REST.mass) / (2 * zeta)


def followed(
    cage: PlanarCage,
    duration: float,
    *,
    kick: float = 0.5,
    direction: float = 0.0,
    lead=None,
    samples: int = 9,
) -> History:
    """Follow a run to its whole duration, its balls in the middle of their pockets unless they lead."""
    lead = np.zeros(cage.ball_count) if lead is None else lead
    whole = {"duration": duration, "until": duration, "samples": samples}
    return follow(cage, kick=kick, direction=direction, ball_lead=lead, **whole)
