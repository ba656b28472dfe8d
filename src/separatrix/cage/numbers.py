"""The numbers of a run as the engine takes them, from the moving cage and a start; the length of a step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.cage import outcome, rows
from separatrix.cage.ball import slip_field
from separatrix.cage.closed_forms import (
    axial_half_play,
    drifts,
    drive_energy,
    moving_mass,
    rebound_damping,
    room,
    time_unit,
)
from separatrix.cage.rows import of
from separatrix.study.cage_design import Guidance, PocketShape

if TYPE_CHECKING:
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.chain.race_traction import SlipField
    from separatrix.ground.units import Array, Metre, MetrePerSecond, NewtonPerMetre, Second

NOWHERE: Metre = 1e6
"""Where something is that is never met: finite, so that a difference of two is a number."""

LEAST_PIVOT = 3e-3
"""Least pivoting speed, as a share of the orbital speed of the balls (of the disturbance, where these are at
rest): below it friction would turn round within a step."""

GAUSS = 3
"""Strips of a land of some width: they hold its force and moment while all of it touches."""

LOOK, TURNS = 150.0, 0.25
"""Length of a look, in radians of the motion with one ball in touch, and at least this share of a turn of the
ball set; a slow one has at most ten times the former."""

LADDER = 1.1
"""Steps of a look are a power of this, so that runs of many cages have few lengths and share a queue."""

FOLLOWED = 160
"""Looks for which a motion is followed whose end is not plain, at least: 1.5 s of the shipped cage."""

BRIEF: Second = 0.02
"""A duration below this, a fifteenth of the default, asks for a preview, with fewer looks: 20 or more."""

ADRIFT = 10.0
"""Mean offset, in half clearances of the pockets, at which a cage without a land has left them."""


class Kind(NamedTuple):
    """What runs of one queue have alike: they are compiled for, or have as many numbers of."""

    ball: int
    space: bool
    level: bool  # its contacts are linear, along the orbit: the quick equations of pockets
    lobes: int
    balls: int
    strips: int
    harmonics: int
    steps: int


class Numbers(NamedTuple):
    """Rows of a run but for what its start draws: `numbers`, strips, harmonics, limits."""

    kind: Kind
    numbers: Array
    strips: Array
    waves: Array
    limits: Array


def ball_level(cage: MovingCage) -> int:
    """Level of the ball of this cage."""
    if cage.free_ball is not None:
        return rows.FREE
    return rows.DAMPER if cage.traction is None else rows.ONE_STATE


def look_time(cage: MovingCage) -> Second:
    """Length of a look [s]."""
    least = LOOK * time_unit(cage)
    turn = 2.0 * math.pi / abs(cage.cage_speed) if cage.cage_speed else 0.0
    return min(max(least, TURNS * turn), 10.0 * least)


def pocket_rectangle(cage: MovingCage) -> tuple[Metre, Metre, Metre]:
    """Half-lengths of the pocket's rectangle along orbit and axis, and how far its wall is outside it [m]."""
    half, end = cage.pocket_clearance / 2.0, axial_half_play(cage)
    if cage.pocket_shape is PocketShape.SQUARE:
        return half, end if cage.is_in_space else NOWHERE, 0.0
    return half - end, 0.0, end


def land_strips(cage: MovingCage) -> Array:
    """Height, stiffness and damping of the strips of all lands, shape (strip, 3)."""
    if cage.guidance is Guidance.BALL:
        return np.zeros((0, of(rows.STRIP_NUMBERS)))
    zeta, K, n = rebound_damping(cage.land_restitution), cage.land_stiffness, cage.land_count
    if not cage.is_in_space:
        return np.array([[0.0, n * K, 2.0 * zeta * math.sqrt(n * K * moving_mass(cage))]])
    spacing = (cage.land_spacing or 0.0) if n == 2 else 0.0
    middles = np.array((-0.5 * spacing, 0.5 * spacing))[:n]
    at, weight = np.polynomial.legendre.leggauss(GAUSS if cage.land_width > 0.0 else 1)
    heights, share = (middles[:, None] + 0.5 * cage.land_width * at).ravel(), np.tile(0.5 * weight, n)
    return np.stack([heights, K * share, 2.0 * zeta * math.sqrt(K * moving_mass(cage)) * share], axis=1)


def waves_of(cage: MovingCage) -> Array:
    """Cosines and sines of what balls have around, shape (harmonic, 6): orbital speed, capacity, slope."""
    orbit = np.array([cage.orbital_cosines, cage.orbital_sines]).T
    each = [orbit, *(np.reshape(one[1:], (-1, 2)) for one in (cage.capacity_waves, cage.slope_waves))]
    found = np.zeros((max(map(len, each)), 3, 2))
    for i, one in enumerate(each):
        found[: len(one), i] = one
    return found.reshape(-1, 6)


def numbers_of(
    cage: MovingCage,
    kick: MetrePerSecond,
    duration: Second,
    *,
    least: Second = 0.0,
    refine: int = 1,
    whole: bool = False,
) -> Numbers:
    """Rows of a run of a cage that turns forward, from a disturbance [m/s].

    `least`: time to which it is followed even where its end is plain before; `refine`: steps in one of the
    usual length. `whole`: no end but a run-away is plain before `duration` is over.
    """
    look = look_time(cage)
    fewest = look / step_length(cage, kick)
    steps = refine * math.ceil(LADDER ** math.ceil(math.log(fewest, LADDER)))
    step = look / steps
    n, given = np.zeros(of(rows.NUMBERS)), _of_cage(cage, kick, step) | _of_ball(cage, step)
    n[[of(row) for row in given]] = list(given.values())
    strips, waves = land_strips(cage), waves_of(cage)
    kind = Kind(
        ball=ball_level(cage),
        space=cage.is_in_space,
        level=not (cage.is_in_space or cage.is_wrapped or cage.pocket_axial_offset or cage.hertz_coefficient),
        lobes=cage.land_lobes if cage.land_out_of_round > 0.0 else 0,
        balls=cage.ball_count,
        strips=len(strips),
        harmonics=len(waves),
        steps=steps,
    )
    limits = _limits(cage, kick, duration, least, look)
    limits[outcome.FROM] = limits[outcome.MOST] if whole else limits[outcome.FROM]
    return Numbers(kind, n, strips, waves.ravel(), limits)


def _of_cage(cage: MovingCage, kick: MetrePerSecond, step: Second) -> dict[int, float]:
    M, R = moving_mass(cage), cage.pitch_radius
    share = cage.added_mass / M
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    reach = R if cage.land_radius is None else cage.land_radius
    _, beside, _ = pocket_rectangle(cage)
    outward, inward = cage.wall_margins
    stopped = 1.0 / M + reach * reach / cage.moment_of_inertia
    if cage.is_in_space:
        stopped += (reach * reach + land_reach(cage) ** 2) / cage.transverse
    # an inner land is touched opposite to the cage's offset, where an odd number of lobes has turned its sign
    lobe = cage.land_out_of_round * (side if cage.land_lobes % 2 else 1.0)
    return {
        rows.STEP: step,
        rows.PER_MASS: 1.0 / M,
        rows.PER_AXIAL_MASS: 0.0 if cage.is_axially_held else 1.0 / cage.mass,
        rows.PER_TURNING: R * R / cage.moment_of_inertia,
        rows.PER_TILTING: 0.0 if cage.is_tilt_held else 1.0 / cage.transverse,
        rows.MASS: M,
        rows.AXIAL_MASS: cage.mass,
        rows.POLAR: cage.moment_of_inertia,
        rows.TRANSVERSE: cage.transverse,
        rows.RADIUS: R,
        rows.PER_RADIUS: 1.0 / R,
        rows.ORBIT: cage.cage_speed,
        rows.RAMP_RATE: (1.0 - cage.ramp_start) / cage.ramp_time if cage.ramp_time > 0.0 else 0.0,
        rows.GRAVITY: cage.gravity * cage.mass / M,
        rows.AXIAL_GRAVITY: 0.0 if cage.is_axially_held else cage.axial_gravity,
        rows.ECCENTRICITY: cage.unbalance / M,
        rows.LEAN: cage.dynamic_unbalance,
        rows.CAPACITY_MEAN: cage.capacity_waves[0] if cage.capacity_waves else 1.0,
        rows.SLOPE_MEAN: cage.slope_waves[0] if cage.slope_waves else 1.0,
        rows.SWIRL: share * cage.fluid_speed,
        rows.SWIRL_PULL: share * cage.fluid_speed * (cage.fluid_speed - 2.0 * cage.cage_speed),
        rows.FLUID_DECAY: cage.fluid_damping / M,
        rows.FLUID_LAG: cage.cage_speed - cage.fluid_speed,
        rows.STIFFNESS: cage.ball_cage_stiffness if cage.hertz_coefficient is None else 0.0,
        rows.HERTZ: cage.hertz_coefficient or 0.0,
        rows.BESIDE: beside,
        rows.WRAPPED: float(cage.is_wrapped),
        rows.OUTWARD: cage.pocket_radial_offset,
        rows.OFFSET: cage.pocket_axial_offset,
        rows.FRICTION: cage.ball_cage_friction,
        rows.LEVER: cage.lever,
        rows.SPIN_Z: cage.spin[0],
        rows.SPIN_R: cage.spin[1],
        rows.SPIN_T: cage.spin[2],
        rows.PIVOT: max(cage.pivot_speed, LEAST_PIVOT * (abs(cage.cage_speed) * R or kick)) ** 2,
        rows.MARGIN_IN: min(outward, NOWHERE),
        rows.MARGIN_OUT: min(inward, NOWHERE),
        rows.LAND_GAP: min(cage.land_gap, NOWHERE),
        rows.LOBE: lobe,
        rows.LOBE_SLOPE: lobe * cage.land_lobes,
        rows.LAND_FRICTION: cage.land_friction,
        rows.LAND_STOPS: cage.land_friction * stopped * step,
        rows.LAND_LEVER: side * reach / R,
        rows.RING_SLIDE: side * (cage.guiding_ring_speed - cage.cage_speed) * reach,
    }


def _of_ball(cage: MovingCage, step: Second) -> dict[int, float]:
    law, ball, found = cage.traction, cage.free_ball, {rows.GROOVE_STIFFNESS: cage.groove_stiffness}
    found[rows.PER_DAMPING], found[rows.PER_GROOVE] = 1.0 / cage.race_damping, 1.0 / cage.groove_damping
    if law is not None:
        rate = law.slope / law.mass
        found |= {rows.SLOPE: law.slope, rows.PER_KNEE: 1.0 / law.speed, rows.PER_BALL_MASS: 1.0 / law.mass}
        found |= {rows.HELD_RATE: rate} | _in_rows(rows.DECAY_HALF, exact_decay(rate, step))
    if ball is not None:
        side = cage.lever * cage.spin[2]
        found |= {rows.PER_OWN_MASS: 1.0 / ball.mass, rows.PER_OWN_INERTIA: 1.0 / ball.inertia}
        found |= _in_rows(rows.INNER, _race_numbers(ball.inner, side))
        found |= _in_rows(rows.OUTER, _race_numbers(ball.outer, side))
    return found


def _in_rows(first: int, values: tuple[float, ...]) -> dict[int, float]:
    return dict(zip(range(first, first + rows.LANES * len(values), rows.LANES), values, strict=True))


def _race_numbers(race: SlipField, side: MetrePerSecond) -> tuple[float, ...]:
    """Numbers of a race, and what its strips give at free rolling, which is subtracted for ever."""
    field = race.slip, race.pivoting, race.heathcote, race.axis_ratio**2 / 4.0, race.elastic_slip**2
    slip, pivoting, heathcote, wide, creep = (np.float64(x) for x in field)
    strips = slip_field.py_func  # type: ignore[attr-defined]
    at_rest = (float(x) for x in strips(slip, pivoting, np.float64(side), heathcote, wide, creep))
    return race.normal_axial, race.normal_radial, race.limit, race.semi_major, *field, *at_rest


def _limits(cage: MovingCage, kick: MetrePerSecond, duration: Second, least: Second, look: Second) -> Array:
    """Limits of a run: see `outcome`."""
    drive, M = drive_energy(cage), moving_mass(cage)
    kicked, turning = 0.5 * M * kick**2, 0.5 * M * (cage.cage_speed * room(cage)) ** 2
    pressed = 0.5 * cage.ball_cage_stiffness * cage.half_play**2
    still = outcome.STILL * min(kicked, pressed or kicked)
    found = np.zeros(outcome.LIMITS)
    ramp = math.ceil(cage.ramp_time / look)
    found[outcome.DRIVE] = drive
    found[outcome.RESTING] = max(outcome.REST * drive, still)
    found[outcome.GROWS] = outcome.GROWN * (kicked + drive + turning)
    fewest = max(2 * outcome.TEN, math.ceil(FOLLOWED * min(1.0, duration / BRIEF)))
    found[outcome.MOST] = ramp + max(fewest, math.ceil(duration / look))
    found[outcome.LEAST] = math.ceil(least / look)
    found[outcome.FROM] = ramp
    found[outcome.IS_ADRIFT] = float(drifts(cage))
    found[outcome.FAR] = ADRIFT * cage.half_play if drifts(cage) and cage.half_play > 0.0 else NOWHERE
    found[outcome.RAMP_TIME], found[outcome.RAMP_START] = cage.ramp_time, cage.ramp_start
    found[outcome.TURNS_AT] = cage.cage_speed
    return found


def exact_decay(rate: float, step: float) -> tuple[float, float, float, float, float, float]:
    """Decay over half a step with its gain, over a step; gains of first, middle and last rate [-], [s]."""
    half = -0.5 * rate * step
    f1, f2, f3 = (_phi(n, 2.0 * half) for n in (1, 2, 3))
    first, middle, last = f1 - 3.0 * f2 + 4.0 * f3, 2.0 * f2 - 4.0 * f3, 4.0 * f3 - f2
    held = math.exp(half), 0.5 * step * _phi(1, half), math.exp(2.0 * half)
    return *held, step * first, step * middle, step * last


def _phi(n: int, z: float) -> float:
    """phi_n(z) = sum of z^i / (i + n)!: (e^z - 1)/z, ((e^z - 1)/z - 1)/z, ..."""
    if abs(z) < 1.0:
        return sum(z**i / math.factorial(i + n) for i in range(20))
    value = math.exp(z)
    for i in range(n):
        value = (value - 1.0 / math.factorial(i)) / z
    return value


LONGEST: Second = 20e-6
CONTACT, LAND, SWING, DECAYS = 0.45, 0.3, 0.65, 1.2
"""Radians of a contact of cage and ball, of one with a land, and of a ball between pocket and races, and time
constants of a relaxation, that a step may have at most: shares and margins do not move at an eighth of it
(docs/theory/cage.md). A cage that whirls on its land passes a contact faster than it would vibrate there."""

FREE_RATE = 10.0
"""Time constants of the fastest motion of a free ball's spin in a step. Shares of runs are those at 2.5; at
20 a whirl is fed a third less, at 30 it dies (docs/theory/cage.md)."""


def step_length(cage: MovingCage, kick: MetrePerSecond) -> Second:
    """Length of the step: the least of 20 us and shares of the shortest contact, relaxation, period."""
    M, k = cage.mass, pocket_stiffness(cage, kick)
    turning = cage.pitch_radius**2 / cage.moment_of_inertia
    grips = cage.half_play == 0.0
    levers = (1.0 / M + turning) * (cage.ball_count / 2.0 if grips else 1.0)
    if cage.is_in_space:
        levers += cage.pitch_radius**2 / cage.transverse * (cage.ball_count / 2.0 if grips else 1.0)
    steps = [LONGEST, CONTACT / math.sqrt(k * levers)]
    if cage.free_ball is not None:
        steps += [
            FREE_RATE / cage.free_ball.fastest_rate,
            SWING / math.sqrt(k * (levers + 1.0 / cage.free_ball.mass)),
        ]
        steps[-2] *= cage.ramp_start if cage.ramp_time > 0.0 else 1.0
    elif cage.traction is not None:
        steps.append(SWING / math.sqrt(k * (levers + 1.0 / cage.traction.mass)))
        if cage.ramp_time > 0.0:  # in a ramp the races hold a ball harder at first
            beyond = (1.0 / cage.ramp_start - 1.0) * cage.traction.slope / cage.traction.mass
            steps.append(DECAYS / max(beyond, 1e-30))
    else:
        steps.append(DECAYS * cage.race_damping / k)
    if cage.is_in_space and math.isfinite(cage.groove_damping):
        steps.append(DECAYS * cage.groove_damping / (k + cage.groove_stiffness))
    if cage.guidance is not Guidance.BALL:
        K = cage.land_count * cage.land_stiffness
        squared = K / M + (K * land_reach(cage) ** 2 / cage.transverse if cage.is_in_space else 0.0)
        damping = rebound_damping(cage.land_restitution)
        steps.append(LAND / math.sqrt(squared) * (1.0 if damping < 1.0 else 1.0 / (2.0 * damping)))
    return min(steps)


def pocket_stiffness(cage: MovingCage, kick: MetrePerSecond) -> NewtonPerMetre:
    """Stiffness of a pocket as deep as in a strong impact, of four times the energy of the start."""
    if cage.hertz_coefficient is None:
        return cage.ball_cage_stiffness
    K, energy = (
        cage.hertz_coefficient,
        2.0 * moving_mass(cage) * max(kick, abs(cage.cage_speed) * cage.half_play) ** 2,
    )
    return 1.5 * K * math.sqrt((2.5 * energy / K) ** 0.4)


def land_reach(cage: MovingCage) -> Metre:
    """Height of the outermost strip of a land over the pockets [m]."""
    return 0.5 * (cage.land_spacing or 0.0) + 0.5 * cage.land_width
