"""What the kernels of the motion in space work on: numbers of a cage, series of a step, state of a run.

The coefficients of one power of time lie side by side, the series of a quantity is a column: one array for
the cage, one for its balls, one for the contacts of its pockets and one for the strips of its lands. Times
are in the engine's unit, forces over the mass that moves across the axis, tilts times the pitch radius, so
that they are lengths.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from separatrix.ball_traction import MOST_ELEMENTS
from separatrix.cage.ending import Look, Memory
from separatrix.cage.records import HARMONICS, Evidence, Whole, records
from separatrix.cage.space_body import SpaceBody
from separatrix.errors import InputError
from separatrix.units import Array

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

EDGE_Z, EDGE_R, EDGE_T, AWAY, TO_Z, TO_R, TO_T, HEIGHT, IN_Z, IN_T, PLACE = range(11)
RIM_SIN, RIM_COS, LEVEL, RATIO, SWEPT, SLIP_Z, SLIP_R, SLIP_T, CLOSING, RIM_Z, RIM_R, RIM_T = range(11, 23)
"""Of a contact at an edge: the nearest point of the edge from the ball's centre, its distance and direction;
height of the ball over the axis of the cage, its place in the pocket (of a round part: from the middle of
that), and where along the orbit a wall would touch. Then sine and cosine of the place on a round edge,
the height of the edge, the ball's over it, and the place along the orbit times the sine; sliding, speed of
the pocket against the ball, friction. Of flats along the orbit `LEVEL` is the distance of the ball from the
axis of the cage, `RATIO` the radius of the edge over it less one, and `SWEPT` the place along the orbit."""

RIM_COLUMNS = 23

LX, LY, FAR_L, NX, NY, DEPTH_L, PUSH_L, AROUND, BESIDE, SLIDE_L, SHARE_L, RUB_T, RUB_Z = range(13)
"""Of a strip of a land: the cage's centre at its height, its distance and direction, depth, force; sliding
around and along the axis and its size; friction over it; friction both ways."""

STRIP_COLUMNS = 13

NONE, ROUND_END, FLAT_BACK, FLAT_FRONT, GRIPPED = 0, 2, -1, 1, 3
OUTER_RIM, INNER_RIM, OUTER_CLEAR, INNER_CLEAR = 4, 5, 6, 7
"""What a contact of a pocket is: not touching, the round part, a flat on the side of -1 or +1, both flats;
the edge of the wall at the outer or inner surface of the cage; that edge near its ball, but clear of it."""

CLEAR, PRESSED, RELEASED = range(3)

CONTACTS, BALLS, LAST, RIMS = range(4)
"""Of `Parts.listed`: how many contacts touch, how many balls move, the last power of the series; how many of
the contacts, the last ones, are at an edge or near it."""


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
    ball_radius: float
    inner_edge: float  # radii between which the pockets have walls
    outer_edge: float
    margin: float  # offset of the cage from which on a ball may touch an edge; inf if there are none
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
    slides_from: float  # force on a ball from which it has inertia, below it creeps with the force; 0: always
    knee: float  # speed at which traction bends from creep to sliding
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
    stiff: Array  # of each contact: k, or what keeps its energy where two points of an edge touch
    paired: Whole  # whether both contacts of a ball are on the round edge of its pocket
    region: Whole  # of a slot: which part of it the ball is in: -1, 0, 1
    moving: Whole  # whether a ball moves against its free orbit or its groove
    creeping: Whole  # whether its speed along the orbit follows the force on it at once
    mode: Whole  # of each strip
    cage: Array  # series, shape (power, column)
    ball: Array  # shape (ball, power, column)
    contact: Array  # shape (2 ball, power, column)
    strip: Array  # shape (strip, power, column)
    rim: Array  # of contacts at an edge, shape (2 ball, power, column); no balls where there are none
    touching: Whole  # contacts that touch, in order, and then those at an edge
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
