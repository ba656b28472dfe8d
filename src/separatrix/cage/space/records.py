"""What the kernels of the motion in space work on: numbers of a cage, series of a step, state of a run.

The coefficients of one power of time lie side by side, the series of a quantity is a column: one array for
the cage, one for its balls, one for the contacts of its pockets and one for the strips of its lands. Times
are in the engine's unit, forces over the mass that moves across the axis, tilts times the pitch radius, so
that they are lengths.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from separatrix.ball_traction import MOST_ELEMENTS
from separatrix.cage.closed_forms import moving_mass, rebound_damping, time_unit
from separatrix.cage.ending import Look, Memory
from separatrix.cage.records import HARMONICS, POWERS, Evidence, Whole, dtype_of, records
from separatrix.cage.space_body import SpaceBody, pocket_plays
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape
from separatrix.study import Guidance
from separatrix.units import Array, MetrePerSecond

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage

X, Y, Z, S, A, B, VX, VY, VZ, VS, VA, VB = range(12)
"""Of the cage: centre of mass, slip of rotation, tilt about x and y times R; and their rates."""

GX, GY, GA, GB, COS, SIN, FORCE_X, FORCE_Y, MOMENT_A, MOMENT_B = range(12, 22)
"""Geometric centre and tilt; cosine and sine of the rotation; force of the contacts across the axis, and
their moments about x and y."""

FRAME = 22
"""First column of cosine and sine of the turning of the frame and of its multiples, and after them of the
ways that free balls go by these."""

CAGE_COLUMNS = FRAME + 4 * HARMONICS
GONE = FRAME + 2 * HARMONICS

LEAD, SPEED, AXIAL, SLOW, ALONG, GIVE, HOLD = range(7)
"""Of a ball: its place along the orbit against its free one, the rate of that, its place along the groove;
its speed over the share of the full speed; the forces that move it along the orbit and the groove, and the
races' force along the orbit."""

DZ, DT, CR, CZ, CT = range(7, 12)
"""Of a pocket against its ball: along axis and orbit; and the pocket's velocity: out, axial, along."""

ELEMENTS = 13
"""First of two columns for each element of the law of traction: 1 + (u/v)^n and its power -1/n; before it the
square of u over the share of the speed."""

BALL_COLUMNS = ELEMENTS + 2 * MOST_ELEMENTS

STATE = 3
"""Columns of a ball that are its state: the first ones."""

FZ, FT, RUB_R, RUB_Q, SPIN, LEAN, PUSH, SLIDE = range(8)
DEPTH, FAR, PZ, PT, SLIDE_R, SLIDE_Q, SHARE, HERE_Z, HERE_T, PER_FAR, PER_SLIDE, WAY = range(8, 20)
"""Of a contact in a pocket: force along the axis and the orbit; friction outward and across; couples of the
friction about the axis and the orbit's direction; normal force, and the size of the sliding. Then
penetration, distance of the ball from the middle of the round part, direction of the force on the cage,
sliding outward and across, friction over it, and the ball against the middle of the round part. Of the last
three only the first coefficient is used: the inverse of the distance and of the sliding, and a bound of how
far the penetration goes in a step."""

CONTACT_COLUMNS = 20

LX, LY, FAR_L, NX, NY, DEPTH_L, PUSH_L, AROUND, BESIDE, SLIDE_L, SHARE_L, RUB_T, RUB_Z = range(13)
"""Of a strip of a land: the cage's centre at its height, its distance and direction, depth, force; sliding
around and along the axis and its size; friction over it; friction both ways."""

STRIP_COLUMNS = 13

NONE, ROUND_END, FLAT_BACK, FLAT_FRONT, GRIPPED = 0, 2, -1, 1, 3
"""What a contact of a pocket is: not touching, the round part, a flat on the side of -1 or +1, both flats."""

CLEAR, PRESSED, RELEASED = range(3)

CONTACTS, BALLS, LAST = range(3)
"""Of `Parts.listed`: how many contacts touch, how many balls move, the last power of the series."""

STRIPS = 3
"""Gauss strips of a land of some width: they hold its force and moment while all of it touches."""


class Numbers(NamedTuple):
    """Numbers of one cage and one kick."""

    unit: float  # of time [s]
    radius: float  # R
    turning: float  # Omega
    spin_inertia: float  # J_p / (M R^2)
    tilt_inertia: float  # J_t / (M R^2)
    axial_swiftness: float  # mass across the axis over that along it; 0 where held
    tilt_swiftness: float  # 1 / tilt_inertia; 0 where held
    stiffness: float  # k
    around: float  # radius of the round part less that of the ball; or half the play of flats
    apart: float  # offset of the round parts
    beside: float  # half the play along the axis of flats
    is_round: bool  # a bore, or round ends
    is_slot: bool  # elongated
    grips: bool
    grips_axially: bool
    friction: float
    spin_z: float  # ball's spin times half its diameter
    spin_r: float
    spin_t: float
    pivoting: float  # square of the pivoting speed
    lever: float  # of the pocket's friction over R
    yielding: float  # 1 / C_mu of a damper; 0 with traction
    groove_yielding: float  # 1 / c_g
    groove_stiffness: float
    ball_mass: float  # m_e over the mass; 0: damper
    elements: int
    sharp: bool  # the law has the power 4, else 2
    power: float  # its inverse
    still: float  # speed below which a ball is at rest
    resting: float  # place along the groove that is none
    slowest: float  # speed whose rounding is of no interest
    gravity: float
    axial_gravity: float
    eccentricity: float
    leaning: float  # dynamic unbalance times R
    land_gap: float
    land_friction: float
    land_lever: float  # q R_L / R
    ring_slide: float  # q (omega_ring - Omega) R_L
    harmonics: int
    ramp_time: float
    ramp_start: float
    needs_rotation: bool
    needs_frame: bool
    fastest: float


class Parts(NamedTuple):
    """Arrays of one cage: of balls, contacts (two a ball) and strips of lands, and the series of a step."""

    cosine: Array  # direction of each pocket
    sine: Array
    play: Array  # what each pocket has more than the nominal half clearance
    drive: Array  # free speed, shape (2 harmonic, ball)
    slope: Array  # of each element of the law of traction
    steep: Array  # 1 / v_i^n
    height: Array  # of each strip over the pockets, over R
    strip_stiffness: Array
    strip_damping: Array
    kind: Whole  # what each contact is, shape (2 ball,): along the orbit, and along the axis
    region: Whole  # of a slot: which part of it the ball is in: -1, 0, 1
    moving: Whole  # whether a ball moves against its free orbit or its groove
    mode: Whole  # of each strip
    cage: Array  # series, shape (power, column)
    ball: Array  # shape (ball, power, column)
    contact: Array  # shape (2 ball, power, column)
    strip: Array  # shape (strip, power, column)
    touching: Whole  # contacts that touch, in order
    active: Whole  # balls that move, in order
    listed: Whole  # how many of both, and the last power of the series of a step
    c: Array  # room for a series
    here: Array  # values at a time: of the cage, a ball, a contact, a strip, shape (4, column)


class Motion:
    """State of a run, and what is counted."""

    x: float
    y: float
    z: float
    s: float
    a: float
    b: float
    vx: float
    vy: float
    vz: float
    vs: float
    va: float
    vb: float
    clock: float
    reach: float  # how long a step may last before an event ends it, from the last ones


class Works:
    """Work done by each source (a sink is negative), and the sum of the magnitudes."""

    pocket_friction: float
    races: float  # traction or dampers
    grooves: float
    ball_drive: float
    land_friction: float
    land_damping: float
    gravity: float
    moving_frame: float
    gross: float


class SpaceLook(Look):
    """Tally of a look in space: integrals over its time unless stated."""

    tilt: float
    tilt_squared: float
    tilt_swept: float
    tilt_max: float  # largest squared
    together: float  # offset times tilt's lean, along and across it: the phase of the cone
    crossed: float
    axial: float
    axial_squared: float
    axial_low: float  # extremes
    axial_high: float
    strikes: float  # number
    pocket_heat: float
    land_heat: float


class SpaceEvidence(Evidence):
    """Evidence of a run in space, as `Evidence`."""

    largest_tilt: float
    mean_tilt: float
    cone_speed: float
    cone_phase: float
    axial_low: float
    axial_high: float
    axial_place: float
    axial_spread: float
    strike_rate: float


class Books(NamedTuple):
    """What runs keep while they run: the last row of each, and one more of the looks, stays zero."""

    state: Sequence[Motion]  # 2
    works: Sequence[Works]  # of the run and of a step, and zero
    memory: Sequence[Memory]  # 2
    looks: Sequence[SpaceLook]


def books_for(most: int) -> Books:
    """Books of runs with at most `most` looks."""
    return Books(records(Motion, 2), records(Works, 3), records(Memory, 2), records(SpaceLook, most + 2))


def body_of(cage: PlanarCage) -> SpaceBody:
    """What the cage has in space.

    Raises
    ------
    InputError
        It has none.
    """
    if cage.space is None:
        raise InputError("PlanarCage.space", "is missing: the cage has no body in space")
    return cage.space


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
        is_round=round_,
        is_slot=cage.pocket_shape is PocketShape.ELONGATED,
        grips=not round_ and around == 0.0,
        grips_axially=not round_ and beside == 0.0,
        friction=cage.ball_cage_friction,
        spin_z=spin[0],
        spin_r=spin[1],
        spin_t=spin[2],
        pivoting=(max(body.pivot_speed, LEAST_PIVOT) * T) ** 2,
        lever=body.lever / R,
        yielding=M / (cage.race_damping * T) if law is None else 0.0,
        groove_yielding=M / (body.groove_damping * T),
        groove_stiffness=body.groove_stiffness * T * T / M,
        ball_mass=0.0 if law is None else law.mass / M,
        elements=0 if law is None else len(law.slopes),
        sharp=law is not None and law.sharpness == 4,
        power=1.0 / (2 if law is None else law.sharpness),
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


LEAST_PIVOT = 1e-9
"""Pivoting speed that keeps a friction finite where nothing slides [m/s]."""

STILL_PLAY = 1e-9
"""Share of the clearance that a ball that is called at rest would still have gone."""


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
        region=np.zeros(Z, np.int64),
        moving=np.zeros(Z, np.int64),
        mode=np.zeros(heights.size, np.int64),
        cage=np.zeros((POWERS, CAGE_COLUMNS)),
        ball=np.zeros((Z, POWERS, BALL_COLUMNS)),
        contact=np.zeros((2 * Z, POWERS, CONTACT_COLUMNS)),
        strip=np.zeros((heights.size, POWERS, STRIP_COLUMNS)),
        touching=np.zeros(2 * Z, np.int64),
        active=np.zeros(Z, np.int64),
        listed=np.zeros(3, np.int64),
        c=np.zeros(POWERS),
        here=np.zeros((4, CAGE_COLUMNS)),
    )
