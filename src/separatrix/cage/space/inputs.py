"""Numbers of one cage in space and one kick, and room for its parts, as the kernels want them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

import numpy as np

from separatrix.cage.closed_forms import moving_mass, rebound_damping, time_unit
from separatrix.cage.records import POWERS, dtype_of
from separatrix.cage.space.records import (
    BALL_COLUMNS,
    CAGE_COLUMNS,
    CONTACT_COLUMNS,
    RIM_COLUMNS,
    STRIP_COLUMNS,
    Numbers,
    Parts,
    body_of,
)
from separatrix.cage.space_body import pocket_plays, wall_margin
from separatrix.pocket_shape import PocketShape
from separatrix.study import Guidance

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, MetrePerSecond, Newton

STRIPS = 3
"""Gauss strips of a land of some width: they hold its force and moment while all of it touches."""


def land_strips(cage: PlanarCage) -> tuple[Array, Array]:
    """Heights of the strips of all lands, and the share of a land's stiffness that each has."""
    if cage.guidance is Guidance.BALL:
        return np.zeros(0), np.zeros(0)
    body = body_of(cage)
    heights = np.array(body.land_heights)
    if body.land_width == 0.0:
        return heights, np.ones(heights.size)
    at, weight = np.polynomial.legendre.leggauss(STRIPS)
    strips = heights[:, None] + 0.5 * body.land_width * at
    return strips.ravel(), np.tile(0.5 * weight, heights.size)


def numbers(cage: PlanarCage, kick: MetrePerSecond) -> Numbers:
    """Numbers of a cage as a record that kernels take by its address."""
    body, T, R = body_of(cage), time_unit(cage), cage.pitch_radius
    M, D = moving_mass(cage), body.ball_diameter
    around, apart, beside = pocket_plays(cage, body)
    law, harmonics = cage.traction, len(cage.orbital_cosines)
    round_, spin = cage.pocket_shape is not PocketShape.SQUARE, [0.5 * D * T * w for w in body.ball_spin]
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    reach = R if body.land_radius is None else body.land_radius
    given = Numbers(
        unit=T,
        radius=R,
        turning=cage.cage_speed * T,
        spin_inertia=cage.moment_of_inertia / (M * R * R),
        tilt_inertia=body.transverse_inertia / (M * R * R),
        axial_swiftness=0.0 if body.is_axially_held else M / cage.mass,
        tilt_swiftness=0.0 if body.is_tilt_held else M * R * R / body.transverse_inertia,
        stiffness=cage.ball_cage_stiffness * T * T / M,
        around=around,
        apart=apart,
        beside=beside,
        ball_radius=D / 2.0,
        inner_edge=body.edges[0],
        outer_edge=body.edges[1],
        margin=wall_margin(cage, body),
        is_round=round_,
        is_slot=cage.pocket_shape is PocketShape.ELONGATED,
        grips=not round_ and around == 0.0,
        grips_axially=not round_ and beside == 0.0,
        friction=cage.ball_cage_friction,
        spin_z=spin[0],
        spin_r=spin[1],
        spin_t=spin[2],
        pivoting=(max(body.pivot_speed, LEAST_PIVOT * kick) * T) ** 2,
        lever=body.lever / R,
        yielding=M / (cage.race_damping * T) if law is None else 0.0,
        groove_yielding=M / (body.groove_damping * T),
        groove_stiffness=body.groove_stiffness * T * T / M,
        ball_mass=0.0 if law is None else law.mass / M,
        elements=0 if law is None else len(law.slopes),
        sharp=law is not None and law.sharpness == 4,
        power=1.0 / (2 if law is None else law.sharpness),
        slides_from=slides_from(cage) * T * T / M,
        knee=knee_speed(cage) * T,
        still=STILL_PLAY * max(cage.pocket_clearance, 1e-9) * (law.slope / law.mass if law else 0.0) * T,
        resting=STILL_PLAY * max(cage.pocket_clearance, 1e-9),
        slowest=1e-2 * kick * T,
        gravity=cage.gravity * cage.mass / M * T * T,
        axial_gravity=body.axial_gravity * T * T if not body.is_axially_held else 0.0,
        eccentricity=cage.unbalance / M,
        leaning=body.dynamic_unbalance * R,
        land_gap=cage.land_gap,
        land_friction=cage.land_friction,
        land_lever=side * reach / R,
        ring_slide=side * (cage.guiding_ring_speed - cage.cage_speed) * reach * T,
        harmonics=harmonics,
        ramp_time=cage.ramp_time / T,
        ramp_start=cage.ramp_start,
        needs_rotation=cage.unbalance != 0.0 or body.dynamic_unbalance != 0.0,
        needs_frame=harmonics > 0 or cage.gravity > 0.0,
        fastest=fastest_in_space(cage) * T,
    )
    return cast("Numbers", np.array([tuple(given)], dtype_of(Numbers))[0])


LEAST_PIVOT = 3e-3
"""Pivoting speed, as a share of the kick, from which on a motion has steps that can be waited for where its
sliding passes through zero or a contact sticks: the friction's own rate is that of the contact over it."""

STILL_PLAY = 1e-9
"""Share of the clearance that a ball that is called at rest would still have gone."""


KNEE = 0.9
"""Share of the races' capacity up to which a ball creeps: there it has 1.2 times the law's speed."""

STIFF = 2e-3
"""sqrt(k m_e) / C, the time in which the races stop a ball over that of its swing on its pocket, below
which its speed follows the force at once."""


def slides_from(cage: PlanarCage) -> Newton:
    """Force on a ball from which its inertia counts; 0 where it always does."""
    law = cage.traction
    if law is None or len(law.slopes) > 1:
        return 0.0
    is_stiff = math.sqrt(cage.ball_cage_stiffness * law.mass) < STIFF * law.slope
    return KNEE * law.capacity if is_stiff else 0.0


def knee_speed(cage: PlanarCage) -> MetrePerSecond:
    """Speed at which the races hold the share `KNEE` of their capacity; 0 without a law of traction."""
    law = cage.traction
    if law is None:
        return 0.0
    rise: float = (1.0 - KNEE**law.sharpness) ** (1.0 / law.sharpness)
    return KNEE * max(law.speeds) / rise


def fastest_in_space(cage: PlanarCage) -> float:
    """Bound on the rates of any motion in contact [1/s]."""
    body = body_of(cage)
    M, R, k, Z = cage.mass, cage.pitch_radius, cage.ball_cage_stiffness, cage.ball_count
    levers = 2.0 / M + R * R / cage.moment_of_inertia + R * R / body.transverse_inertia
    squared, rate = Z * k * levers, k / cage.race_damping
    if cage.traction is not None:
        squared += k / cage.traction.mass
        rate = cage.traction.slope / cage.traction.mass
    rate += (k + body.groove_stiffness) / body.groove_damping
    heights, share = land_strips(cage)
    if heights.size:
        K = cage.land_stiffness * float(np.sum(share * (1.0 / M + heights**2 / body.transverse_inertia)))
        squared += K
        rate += 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(K)
    spin = cage.moment_of_inertia / body.transverse_inertia * abs(cage.cage_speed)
    return math.sqrt(squared) + rate + 2.0 * abs(cage.cage_speed) + spin


def parts_of(cage: PlanarCage) -> Parts:
    """Room for the parts of a cage."""
    T, M = time_unit(cage), moving_mass(cage)
    Z, angles, waves = cage.ball_count, np.array(cage.ball_angles), []
    for h, (a, b) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
        c, s = np.cos(h * angles), np.sin(h * angles)
        waves += [a * c + b * s, b * c - a * s]
    law = cage.traction
    slopes = np.array(law.slopes if law else ()) * T / M
    speeds = np.array(law.speeds if law else ()) * T
    heights, share = land_strips(cage)
    K = cage.land_stiffness * share
    whole = max(1.0, float(np.sum(share)))
    damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(cage.land_stiffness * whole * M)
    return Parts(
        cosine=np.cos(angles),
        sine=np.sin(angles),
        play=np.zeros(Z),
        drive=np.array(waves).reshape(len(waves), Z) * T,
        slope=slopes,
        steep=1.0 / speeds ** (2 if law is None else law.sharpness),
        height=heights / cage.pitch_radius,
        strip_stiffness=K * T * T / M,
        strip_damping=damping * share / whole * T / M,
        kind=np.zeros(2 * Z, np.int64),
        stiff=np.full(2 * Z, cage.ball_cage_stiffness * T * T / M),
        paired=np.zeros(Z, np.int64),
        region=np.zeros(Z, np.int64),
        moving=np.zeros(Z, np.int64),
        creeping=np.zeros(Z, np.int64),
        mode=np.zeros(heights.size, np.int64),
        cage=np.zeros((POWERS, CAGE_COLUMNS)),
        ball=np.zeros((Z, POWERS, BALL_COLUMNS)),
        contact=np.zeros((2 * Z, POWERS, CONTACT_COLUMNS)),
        strip=np.zeros((heights.size, POWERS, STRIP_COLUMNS)),
        rim=np.zeros((2 * Z if wall_margin(cage, body_of(cage)) < math.inf else 0, POWERS, RIM_COLUMNS)),
        touching=np.zeros(2 * Z, np.int64),
        active=np.zeros(Z, np.int64),
        listed=np.zeros(4, np.int64),
        c=np.zeros(POWERS),
        here=np.zeros((4, CAGE_COLUMNS)),
    )
