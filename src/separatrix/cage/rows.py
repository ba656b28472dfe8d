"""Where a quantity stands in the engine's arrays, and the numbers that are exact in every precision.

A quantity of 16 runs stands in 16 neighbouring numbers, its lanes: `array[X + l]` is x of the run in lane l.
So the innermost loop of every equation is over lanes, and the compiler puts them side by side into registers.
An array of one run has them at `of(X)`. SI units throughout.
"""

from __future__ import annotations

import numpy as np

LANES = 16


def _places(count: int, first: int = 0) -> range:
    return range(first * LANES, (first + count) * LANES, LANES)


def of(place: int) -> int:
    """Place of a quantity among those of one run."""
    return place // LANES


ZERO, HALF, ONE, TWO = (np.float32(x) for x in (0.0, 0.5, 1.0, 2.0))
"""Of single precision, so that they never widen an expression in it."""

TINY = np.float32(1e-30)
"""Below the square of any length or speed that counts: a root of it is no division by zero."""

DAMPER, ONE_STATE, FREE = 0, 1, 2
"""Levels of the ball: the paper's damper; inertia and saturating traction; its three spins too."""

# Numbers of a run.
(
    STEP, PER_MASS, PER_AXIAL_MASS, PER_TURNING, PER_TILTING, MASS, AXIAL_MASS, POLAR, TRANSVERSE, RADIUS,
    PER_RADIUS, ORBIT, RAMP_RATE, GRAVITY, AXIAL_GRAVITY, ECCENTRICITY, LEAN,
    SWIRL, SWIRL_PULL, FLUID_DECAY, FLUID_LAG, CAPACITY_MEAN, SLOPE_MEAN,
    STIFFNESS, HERTZ, BESIDE, WRAPPED, OUTWARD, OFFSET, FRICTION, LEVER, SPIN_Z, SPIN_R, SPIN_T, PIVOT,
    MARGIN_IN, MARGIN_OUT, PER_DAMPING, PER_GROOVE, GROOVE_STIFFNESS, SLOPE, PER_KNEE,
    PER_BALL_MASS, HELD_RATE, DECAY_HALF, GAIN_HALF, DECAY, GAIN_FIRST, GAIN_MIDDLE, GAIN_LAST,
    LAND_GAP, LOBE, LOBE_SLOPE, LAND_FRICTION, LAND_STOPS, LAND_LEVER, RING_SLIDE,
    PER_OWN_MASS, PER_OWN_INERTIA, INNER,
) = _places(60)  # fmt: skip
HELD_NUMBERS = of(GAIN_LAST - DECAY_HALF) + 1
RACE_ROWS = 12 * LANES
OUTER = INNER + RACE_ROWS
NUMBERS = OUTER + RACE_ROWS

# Numbers of a ball with its pocket, of a strip of the land, of a harmonic of the orbital speeds.
# Beside them what is kept of a pocket from step to step: its force, heat, whether it touches, impacts and
# heat of a look.
(
    COSINE, SINE, AROUND, APART, BY_SIZE, OWN_SPEED, CAPACITY_SHARE, SLOPE_SHARE, KNEE_SHARE,
    FORCE, HEAT, TOUCHING, HITS, RUBBED, BALL_ROWS,
) = _places(15)  # fmt: skip
HEIGHT, STRIP_STIFFNESS, STRIP_DAMPING, STRIP_NUMBERS = _places(4)
(
    ORBIT_COSINE, ORBIT_SINE, CAPACITY_COSINE, CAPACITY_SINE, SLOPE_COSINE, SLOPE_SINE, HARMONIC_NUMBERS,
) = _places(7)  # fmt: skip

# State of a cage; those from `Z` on in space only. Works are of forces on cage and pocket springs since the
# last look.
(
    X, Y, S, VX, VY, VS, POCKET_WORK, LAND_WORK, LAND_PRESS_WORK, BALL_WORK, FRAME_WORK, TURN_COSINE,
    TURN_SINE, RAMP, Z, TX, TY, VZ, WX, WY, SPACE_STATES,
) = _places(21)  # fmt: skip
PLANE_STATES = Z

# State of a ball: its lead, in space its place along the groove, its speed, its three spins.
LEAD, GROOVE = _places(2)

# What the forces of a moment add up to.
(
    FX, FY, FS, FZ, MX, MY, RUB, DRIVE, LX, LY, LS, LZ, LMX, LMY, LAND_RUB, LAND_PRESS, LAND_N, LAND_HEAT,
    GX, GY, GVX, GVY, GA, GB, GWA, GWB, TURN, PER_RAMP, RAMP_NOW,
    ONE_COSINE, ONE_SINE, LOBES_COSINE, LOBES_SINE, SUMS,
) = _places(34)  # fmt: skip

# What is watched of a run, as a sum over the steps of a look.
(
    ENERGY, OFFSET_MEAN, OFFSET_SQUARE, SWEPT, CURL, SPEED_SQUARE, PRESSED, HEATED, STRIKES,
    TILT_SQUARE, CONE, MEAN_X, MEAN_Y,
    WORK_POCKET, WORK_LAND, WORK_PRESS, WORK_BALL, WORK_FRAME, RUBBING, LOOK_COLUMNS,
) = _places(20)  # fmt: skip
WATCHED = WORK_POCKET  # those before are summed up step by step

# What is watched of a run as an extreme or a count over all of it; after the sums, in one array.
(
    PEAK_FORCE, PEAK_LAND, PEAK_OFFSET, PEAK_TILT, AXIAL_LOW, AXIAL_HIGH, LAND_STRIKES, LAND_TOUCHED,
    LEFT_STEP, LEFT_BALL, EXTREMES_END,
) = _places(11, of(WATCHED))  # fmt: skip


def ball_states(ball: int, *, space: bool) -> int:
    """Numbers of the state of a ball."""
    return (2 if space else 1) + (0, 1, 4)[ball]


def cage_states(*, space: bool) -> int:
    """Numbers of the state of a cage."""
    return of(SPACE_STATES if space else PLANE_STATES)
