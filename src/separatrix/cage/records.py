"""What the kernels work on: numbers of one cage, state and series of a step, and what a run leaves behind.

A kernel reads and writes fields by name. A record is one row of a structured array: kernels take its address.
Lengths are in metres, times in the engine's unit (`time_unit`), forces over the mass, so that a force and an
acceleration have the unit of a length. Symbols are those of docs/theory/cage.md.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cache
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar, cast, get_type_hints

import numpy as np
from numpy.typing import NDArray

from separatrix.units import Array

ORDER = 14
"""Terms of a series beyond the first; the step is so short that the last ones are small beside the speeds."""

POWERS = ORDER + 3
"""Rows of a series: the first, its terms, and two that a sticking land needs."""

HARMONICS = 4
"""Harmonics of the balls' uneven orbital speed, at most."""

WAVES = 2 * HARMONICS
"""Cosines and sines of these."""

KNOT_ROWS, EARLY_BOUND, LATE_BOUND, AT_END = 9, 6, 7, 8
"""Rows of knots of a wave: its six knots (`series.knots`), bounds of the fourth derivative in
each half of the step, and the value at an event."""

SPEED, WAY, TRACTION, CREEP, SQUARE, FOURTH, GRIP, DEPTH, PLACE, AT_KNOTS, BENT = range(11)
"""Series of a ball with inertia: u, what it goes by u while it coasts, F(u) / m_e, the creep u / lambda, its
square and fourth power, F over the creep, its penetration, and from `BENT` on (1 + (creep / v_i)^n)^(-1/n) of
each element. Not series: `AT_KNOTS`, six knots of the way and two bounds, as `KNOT_ROWS`; and `PLACE`, with
four rows:"""

IS_TOUCHED, COSINE, SINE, IS_LINEAR = range(4)
"""1 in touch, else 0; the direction of its pocket; 1 where all of the block slow down by a linear law."""

LANES = 4
"""Balls whose series are made side by side."""

CLEAR, RELEASED, STICK, FORWARD, BACKWARD = range(5)
"""Modes of the land: not touched; dented but without force; touched and sticking, or sliding either way."""

Whole = NDArray[np.int64]
Value = TypeVar("Value")
Record = TypeVar("Record")


class Coefficients(NamedTuple):
    """Numbers of one cage and one kick."""

    unit: float  # of time [s]
    inertia: float  # J / (M R^2)
    swiftness: float  # its inverse
    radius: float  # R
    turning: float  # Omega
    stiffness: float  # k of a linear pocket
    hertz: float  # K of a Hertz pocket; 0: linear
    onset: float
    yielding: float  # 1 / C_mu
    friction: float  # sigma f over the cosine of the contact's tilt
    slowest: float  # speed whose rounding is of no interest
    gravity: float
    eccentricity: float  # of the centre of mass
    land_side: float  # q: 1 outer, -1 inner, 0 without a land
    land_gap: float  # c_g
    land_stiffness: float  # K of the land
    land_damping: float  # c of the land
    land_friction: float  # mu
    ring_slide: float  # (omega_ring - Omega) R
    roundness: float  # positive takes from the gap where the cosine is positive
    lobes: int
    harmonics: int
    driven: float  # bound on the free speed of any ball
    ramp_time: float
    ramp_start: float
    needs_rotation: bool
    needs_frame: bool
    gripped: bool  # no clearance: both sides of a pocket touch its ball
    fastest: float  # bound on the rate of the motion in contact
    own: bool  # a pocket in touch has a series of its own: a Hertz spring, or a ball with inertia
    inertial: bool  # balls have inertia and a law of traction
    lightness: float  # M / m_e
    damper: float  # elements of infinite speed: sum of C_i, over m_e
    elements: int  # of a finite speed
    sharp: bool  # the law has the power 4, else 2
    power: float  # its inverse
    slopes: Array  # their C_i over m_e, and 1 / v_i^n
    bends: Array
    coast_end: float  # speed at which a ball that coasts is put to rest
    coast_time: float  # m_e / sum of C_i: it comes to rest at this time times its speed


class Terms(Generic[Value]):
    """Power series of a step. In a record: the coefficients of one power of time.

    In the array of all powers (`Series`) a field is the column of one quantity.
    """

    x: Value  # centre of mass, in the turning frame
    y: Value
    vx: Value
    vy: Value
    s: Value  # slip of rotation, R theta
    vs: Value
    ex: Value  # speeds filtered by the yielding of the balls: what a ball in touch feels of the motion;
    # with inertia x and y are the sums of N_j e_r (fields of their own cost 2 % of the speed)
    ey: Value
    es: Value
    kept: Value  # e(t): the share that is left of a penetration
    gx: Value  # geometric centre, where the cage has an unbalance
    gy: Value
    fx: Value  # forces of the contacts, and their torque over M R
    fy: Value
    torque: Value
    frame_x: Value  # accelerations by the turning frame and gravity
    frame_y: Value
    frame_s: Value
    cos: Value  # of theta
    sin: Value
    distance: Value  # |r|, its direction n = r / |r|, and the depth delta in the land
    nx: Value
    ny: Value
    depth: Value
    normal: Value  # P, the tangential force, and the sliding v_s
    tangent: Value
    sliding: Value
    turn_cos: Value  # of the angle of n against the cage
    turn_sin: Value
    lobe_cos: Value  # of that angle times the number of lobes; the sine over the distance
    lobe_sin: Value
    tilt: Value
    pushed: Value
    frame: Array  # cosine and sine of the turning of the frame and of its multiples
    felt: Array  # what a ball in touch, and a free one, has gone by a free speed of that form
    gone: Array


class Series(Terms[Array]):
    """All powers: `w[n].x` is a coefficient, `w.x` the series of one quantity."""

    if TYPE_CHECKING:  # numba reads both from the structured array

        def __getitem__(self, n: int) -> Terms[float]: ...


class Balls(NamedTuple):
    """Balls and their pockets, shape (ball,) unless stated."""

    cosine: Array  # direction phi_j of the pocket
    sine: Array
    play: Array  # c_p
    lead: Array  # y_j of a ball that does not touch
    penetration: Array  # q_j of one that does
    drive: Array  # free speed, shape (2 harmonic, ball)
    side: Whole  # side on which the pocket touches its ball: 1, -1; 0 not; 2 both
    touching: Whole  # balls in touch, `State.touching` of them
    depth: Array  # own series of the penetration and the force of pockets in touch, shape (power, ball)
    force: Array
    own_speed: Array  # u_j, speed of a ball with inertia beyond its free orbit; 0: it rests there
    coasting: Whole  # balls that move there and touch nothing, `State.coasting` of them
    slot: Whole  # place of a ball that moves so in `moving`: those in touch, then those that coast
    moving: Array  # series of their motion, shape (block, quantity, power, lane)


class Pace(NamedTuple):
    """Share of the full speed in a ramp, and its rate."""

    share: float
    rise: float


class State:
    """State of a run."""

    x: float
    y: float
    vx: float
    vy: float
    s: float
    vs: float
    clock: float
    touching: int  # balls in touch
    coasting: int  # balls that move on their own
    land: int  # mode of the land
    rows: int  # rows of history filled


class Ledger:
    """Work done on the cage by each source (a sink is negative), and the sum of the magnitudes."""

    pocket_friction: float
    race_dampers: float
    ball_drive: float
    land_friction: float
    land_damping: float
    gravity: float
    moving_frame: float
    unbalance: float
    gross: float


SOURCES = tuple(name for name in Ledger.__annotations__ if name != "gross")


class Evidence:
    """Evidence of a run in SI units, but for forces, energies and powers, which are over the mass."""

    outcome: int
    cause: int
    end_energy: float
    growth_rate: float
    largest_offset: float
    drift_rate: float
    whirl_frequency: float
    whirl_direction: int
    largest_contact_force: float
    largest_land_force: float
    energy_imbalance: float
    mean_offset: float
    offset_spread: float
    orbit_speed: float
    land_impacts: int
    rows: int
    followed: float
    judged_from: float
    pocket_power: float
    land_power: float
    rubbing_force: float
    rubbing_speed: float


class Row:
    """A row of a history: geometric centre, velocity, slip and its rate, clock, then as named."""

    x: float
    y: float
    vx: float
    vy: float
    s: float
    vs: float
    clock: float
    pocket_energy: float
    land_energy: float
    land_force: float


class Samples(NamedTuple):
    """Rows of a history; the clock of a row that is not filled is the time from which it is due."""

    row: Sequence[Row]
    work: Sequence[Ledger]
    lead: Array  # of every ball, shape (row, ball)
    force: Array
    speed: Array  # beyond its free orbit


class Candidate:
    """What may end a step: a pocket that may leave its ball (change 0), or meet it on a side (1, -1)."""

    change: int
    ball: int
    early_half: int  # what it does in each half of the step
    late_half: int
    guess: float  # about when
    noise: float
    start: float  # knots
    rise: float
    middle: float
    turn: float
    last: float
    fall: float


class Sums:
    """Sums over the pockets in touch: of directions and their products, and of penetrations."""

    cc: float
    cs: float
    ss: float
    c: float
    s: float
    qc: float
    qs: float
    q: float
    drive_c: Array  # of the free speeds of each wave times the directions
    drive_s: Array
    drive: Array


class Points:
    """The motion at the points of a step (`work`), side by side; and power there times the point's weight."""

    SIZE = 12

    t: Array
    x: Array
    y: Array
    vx: Array
    vy: Array
    vs: Array
    ex: Array
    ey: Array
    es: Array
    kept: Array
    gx: Array
    gy: Array
    gvx: Array  # velocity of the geometric centre
    gvy: Array
    rubbing: Array  # of friction in the pockets, of the races' dampers, of the turning of the frame
    yielding: Array
    driving: Array


class Room(NamedTuple):
    """Where `advance` keeps what it needs within a step."""

    sums: Sums
    points: Points
    c: Array  # a series, shape (power,)
    work: Ledger
    felt: Array  # knots of the waves, shape (KNOT_ROWS, wave)
    gone: Array
    beyond: Array  # shape (ball,)
    depths: Array  # bound of the penetration of each ball in touch, shape (ball,)
    queue: Sequence[Candidate]
    lobes: Array  # powers of the lobes, shape (power, 2 lobe)


PLAIN = "plain"
"""Field that the numbers of a plain cage have beyond those of `Coefficients`: it makes their type another."""


def plain_dtype() -> np.dtype[np.void]:
    """Type of the record of a plain cage, see `features`."""
    usual = dtype_of(Coefficients)
    return np.dtype([*((name, usual[name]) for name in usual.names or ()), (PLAIN, np.bool_)])


@cache
def dtype_of(kind: Hashable) -> np.dtype[np.void]:
    """Type of the structured array of a record; an array within it has the length `WAVES`, or its `SIZE`."""
    length = getattr(kind, "SIZE", WAVES)
    fields: list[tuple[str, object, tuple[int, ...]]] = []
    for name, hint in get_type_hints(kind).items():
        whole = {int: np.int64, bool: np.bool_}.get(hint, np.float64)
        fields.append((name, whole, (length,) if hint == Array else ()))
    return np.dtype(fields)


def records(kind: type[Record], count: int) -> Sequence[Record]:
    """Array of records, all zero."""
    return cast("Sequence[Record]", np.zeros(count, dtype_of(cast("Hashable", kind))))


def series() -> Series:
    """Room for the series of a step."""
    return cast("Series", np.zeros(POWERS, dtype_of(Terms)))


def samples_for(rows: int, balls: int) -> Samples:
    """Rows of a history, all zero."""
    return Samples(
        row=records(Row, rows),
        work=records(Ledger, rows),
        lead=np.zeros((rows, balls)),
        force=np.zeros((rows, balls)),
        speed=np.zeros((rows, balls)),
    )


def room_for(balls: int, lobes: int) -> Room:
    """Room for the steps of a cage with this number of balls, and of lobes of its land."""
    return Room(
        sums=records(Sums, 1)[0],
        points=records(Points, 1)[0],
        c=np.zeros(ORDER + 1),
        work=records(Ledger, 1)[0],
        felt=np.zeros((KNOT_ROWS, WAVES)),
        gone=np.zeros((KNOT_ROWS, WAVES)),
        beyond=np.zeros(balls),
        depths=np.zeros(balls),
        queue=records(Candidate, 2 * balls),
        lobes=np.zeros((POWERS, 2 * lobes)),
    )
