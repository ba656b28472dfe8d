"""Motion of the cage in the plane by small steps: exact free motion, and contact forces as kicks.

One step is kick, drift, kick (Strang): the drift is the exact free motion in the turning frame, the balls yield
exactly under an even motion of the cage, and the land acts as an impulse in the middle of the drift. The error is of
second order in the step. Where nothing touches, many steps are taken at once, exactly.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.cage.land import land_impulse, rebound_damping
from separatrix.cage.pocket import kernel, relaxation, settle
from separatrix.study import Guidance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, Second

STEPS_PER_RADIAN = 6.0
UNITS = 4
CALM_AFTER, CALM_STRIDE = 100, 3
LONGEST_FLIGHT = 1024

# Slots of the state: centre of mass, its velocity, rotation against the ball set and its rate, step counter.
X, Y, VX, VY, THETA, SPIN, STEP = range(7)
STATE = 7
# Slots of the ledger: work done on the cage since the start [J].
POCKET_FRICTION, RACE_DAMPERS, LAND, GRAVITY, MOVING_FRAME, UNBALANCE, GROSS, STORED = range(8)
LEDGER = 8
# Slots of the tally of one window: time integrals, and extremes.
KINETIC, OFFSET_X, OFFSET_Y, TURNING, SPEED_SQUARED, OFFSET_MAX, FORCE_MAX, LAND_MAX = range(8)
TALLY = 8


class Coefficients(NamedTuple):
    """Numbers of one cage as the kernel wants them; `dt` and what follows from it included."""

    unit: float
    mass: float
    inertia: float
    radius: float
    turning: float
    stiffness: float
    yielding: float  # 1 / C_mu
    half_play: float
    friction: float  # sigma f
    longest_flight: float
    land_side: float
    land_gap: float
    land_stiffness: float
    land_damping: float
    land_friction: float
    ring_slide: float
    eccentricity: float
    gravity: float


class Press(NamedTuple):
    """What the balls' forces on their pockets sum to."""

    cos: float  # sums of N cos, N sin and N [N]
    sin: float
    total: float
    edge_cos: float  # the same of what a touch or a parting inside the step takes off the trapezium rule
    edge_sin: float
    edge: float
    squares: float  # sum of N^2 [N2]
    reach: float  # largest excursion |u| of a ball in its pocket [m]
    peak: float  # largest |N| [N]
    touching: int
    changes: int  # balls that touched or parted inside the step


def unit_step(cage: PlanarCage) -> Second:
    """Unit of time of which every step is a multiple: a quarter of the step with all balls in touch [s]."""
    return _step(_contact_rate(cage, cage.ball_count)) / UNITS


def step_counts(cage: PlanarCage, unit: Second) -> NDArray[np.int64]:
    """Units in a step, by the number of balls in touch, shape (ball + 1,).

    One more ball than touches at the start may touch within the step; the land may as well.
    """
    rates = [_contact_rate(cage, min(n + 1, cage.ball_count)) for n in range(cage.ball_count + 1)]
    return np.array([max(1, int(_step(rate) / unit * (1 + 1e-9))) for rate in rates])


def _step(rate_squared: float) -> Second:
    return 1.0 / (STEPS_PER_RADIAN * math.sqrt(rate_squared))


def _contact_rate(cage: PlanarCage, touching: int) -> float:
    """Bound on the squared rate of the fastest motion with this many balls in touch, and the land [1/s2]."""
    turning, k = cage.pitch_radius**2 / cage.moment_of_inertia, cage.ball_cage_stiffness
    few = touching * k * (turning + 1.0 / cage.mass)
    rate = min(few, cage.ball_count * k * max(turning, 0.5 / cage.mass))
    if cage.guidance is not Guidance.BALL:
        rate += cage.land_stiffness / cage.mass
    return rate


def _longest_flight(cage: PlanarCage, unit: Second) -> Second:
    """Longest step without touch: the frame turns by no more than a tenth of a radian in it [s]."""
    turning = 0.1 / abs(cage.cage_speed) if cage.cage_speed else math.inf
    return min(turning, LONGEST_FLIGHT * unit)


def coefficients(cage: PlanarCage, dt: Second) -> Coefficients:
    """Kernel's numbers of a cage at a step."""
    k, m = cage.ball_cage_stiffness, cage.mass
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    return Coefficients(
        unit=dt,
        mass=m,
        inertia=cage.moment_of_inertia,
        radius=cage.pitch_radius,
        turning=cage.cage_speed,
        stiffness=k,
        yielding=1.0 / cage.race_damping,
        half_play=cage.half_play,
        friction=cage.friction_sense * cage.ball_cage_friction,
        longest_flight=_longest_flight(cage, dt),
        land_side=side,
        land_gap=cage.land_gap,
        land_stiffness=cage.land_stiffness,
        land_damping=2.0 * rebound_damping(cage.land_restitution) * math.sqrt(cage.land_stiffness * m),
        land_friction=cage.land_friction,
        ring_slide=(cage.guiding_ring_speed - cage.cage_speed) * cage.pitch_radius,
        eccentricity=cage.unbalance / m,
        gravity=cage.gravity,
    )


def ball_directions(count: int) -> tuple[Array, Array]:
    """Cosines and sines of the balls' angles, shape (ball,) each [-]."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return np.cos(angle), np.sin(angle)


@kernel
def pace(p, count):  # type: ignore[no-untyped-def]
    """Time of a number of unit steps with what follows from it: relaxation, and the turn of the frame in it."""
    dt = count * p.unit
    a = p.stiffness * p.yielding * dt
    kept, followed = relaxation(a)
    angle = p.turning * dt
    return dt, a, kept, followed, np.cos(angle), np.sin(angle), np.cos(0.5 * angle), np.sin(0.5 * angle)


@kernel
def fly(p, t, s, dt, c, i):  # type: ignore[no-untyped-def]
    """Advance the free motion exactly: a straight line (or gravity's parabola) in space, seen in the turning frame."""
    W = p.turning
    ux, uy = s[VX] - W * s[Y], s[VY] + W * s[X]
    x, y = s[X] + ux * dt, s[Y] + uy * dt
    if p.gravity != 0.0:
        gx, gy = p.gravity * np.cos(W * t), -p.gravity * np.sin(W * t)
        x, y = x + 0.5 * gx * dt * dt, y + 0.5 * gy * dt * dt
        ux, uy = ux + gx * dt, uy + gy * dt
    s[X], s[Y] = c * x + i * y, c * y - i * x
    s[VX] = c * ux + i * uy + W * s[Y]
    s[VY] = c * uy - i * ux - W * s[X]
    s[THETA] += s[SPIN] * dt


@kernel
def centre(p, s):  # type: ignore[no-untyped-def]
    """Geometric centre of the cage, which the unbalance parts from its centre of mass [m]."""
    e = p.eccentricity
    if e == 0.0:
        return s[X], s[Y]
    return s[X] - e * np.cos(s[THETA]), s[Y] - e * np.sin(s[THETA])


@kernel
def drift(p, t, s, ledger, dt, c, i):  # type: ignore[no-untyped-def]
    """Advance the free motion and enter the work of gravity, moving frame and unbalance."""
    W2 = p.mass * p.turning * p.turning
    x, y = s[X], s[Y]
    cx, cy = centre(p, s)
    fly(p, t, s, dt, c, i)
    dx, dy = s[X] - x, s[Y] - y
    frame = 0.5 * W2 * ((s[X] + x) * dx + (s[Y] + y) * dy)
    unbalance = 0.0
    if p.eccentricity != 0.0:
        nx, ny = centre(p, s)
        unbalance = frame - 0.5 * W2 * ((nx + cx) * dx + (ny + cy) * dy)
        frame -= unbalance
    pull = 0.0
    if p.gravity != 0.0:
        middle = p.turning * (t + 0.5 * dt)
        pull = p.mass * p.gravity * (np.cos(middle) * dx - np.sin(middle) * dy)
    ledger[MOVING_FRAME] += frame
    ledger[UNBALANCE] += unbalance
    ledger[GRAVITY] += pull
    ledger[GROSS] += abs(frame) + abs(unbalance) + abs(pull)


@kernel
def lean(p, s, impulse_x, impulse_y, moment):  # type: ignore[no-untyped-def]
    """Kick the cage with an impulse at its geometric centre and a moment about that; return the work done."""
    e = p.eccentricity
    if e != 0.0:
        moment -= e * (np.cos(s[THETA]) * impulse_y - np.sin(s[THETA]) * impulse_x)
    dvx, dvy, dw = impulse_x / p.mass, impulse_y / p.mass, moment / p.inertia
    work = impulse_x * (s[VX] + 0.5 * dvx) + impulse_y * (s[VY] + 0.5 * dvy) + moment * (s[SPIN] + 0.5 * dw)
    s[VX] += dvx
    s[VY] += dvy
    s[SPIN] += dw
    return work


@kernel
def press(p, cos, sin, s, seat, lead, load, a, kept, followed):  # type: ignore[no-untyped-def]
    """Let every ball yield to the cage's new place; return what its forces sum to.

    Parameters
    ----------
    cos, sin : ndarray
        Directions of the balls, shape (ball,) [-].
    s : ndarray
        State of the cage.
    seat : ndarray
        Circumferential place of each pocket, w = r.e_t + R theta, shape (ball,) [m]; brought up to date.
    lead, load : ndarray
        Lead y of each ball [m] and force N of the pocket on it [N], shape (ball,); brought up to date.

    Returns
    -------
    Press
        What the forces sum to at the end of the step.
    """
    x, y = centre(p, s)
    turned = p.radius * s[THETA]
    c = p.half_play
    sum_cos = sum_sin = total = squares = reach = peak = 0.0
    edge_cos = edge_sin = edge = 0.0
    touching = changes = 0
    for j in range(cos.size):
        w = y * cos[j] - x * sin[j] + turned
        old, new = seat[j] - lead[j], w - lead[j]
        seat[j] = w
        n = 0.0
        if c == 0.0:
            q = old * kept + (new - old) * followed
            lead[j] = w - q
            n = p.stiffness * q
        elif abs(old) > c or abs(new) > c:
            side = 1.0 if (old > c or (new > c and old >= -c)) else -1.0
            q, gave, share = settle(side * old - c, side * new - c, a, kept, followed)
            lead[j] += side * gave
            n = side * p.stiffness * q
            if share < 1.0:
                miss = (n + load[j]) * (share - 1.0)
                edge_cos += miss * cos[j]
                edge_sin += miss * sin[j]
                edge += miss
                changes += 1
        reach = max(reach, abs(w - lead[j]))
        load[j] = n
        if n != 0.0:
            sum_cos += n * cos[j]
            sum_sin += n * sin[j]
            total += n
            squares += n * n
            peak = max(peak, abs(n))
            touching += 1
    return Press(sum_cos, sum_sin, total, edge_cos, edge_sin, edge, squares, reach, peak, touching, changes)


@kernel
def kick(p, s, ledger, sum_cos, sum_sin, total, dt):  # type: ignore[no-untyped-def]
    """Kick the cage with the pockets' forces over a time: -N e_t and the moment -N R, and friction -sigma f N e_r."""
    f = p.friction
    normal = lean(p, s, sum_sin * dt, -sum_cos * dt, -total * p.radius * dt)
    rubbed = lean(p, s, -f * sum_cos * dt, -f * sum_sin * dt, 0.0)
    ledger[POCKET_FRICTION] += rubbed
    ledger[GROSS] += abs(rubbed)
    return normal


@kernel
def clear_time(p, s, reach, longest):  # type: ignore[no-untyped-def]
    """Time in which nothing can touch, from the gaps left and a bound on the speed; at most `longest` [s]."""
    x, y = centre(p, s)
    gap = min(p.half_play - reach, p.land_gap - np.sqrt(x * x + y * y))
    if gap <= 0.0:
        return 0.0
    W = abs(p.turning)
    ux, uy = s[VX] - p.turning * s[Y], s[VY] + p.turning * s[X]
    speed = 1.1 * np.sqrt(ux * ux + uy * uy) + W * np.sqrt(s[X] * s[X] + s[Y] * s[Y])
    speed += abs(s[SPIN]) * (p.radius + p.eccentricity) + 1.1 * p.gravity * longest
    return min(longest, gap / speed) if speed > 0.0 else longest


@kernel
def strike_land(p, t, s, ledger, tally, dt, c, i):  # type: ignore[no-untyped-def]
    """Drift one step with the land's impulse in its middle; c and i turn the frame by half the step."""
    half = 0.5 * dt
    drift(p, t, s, ledger, half, c, i)
    x, y = centre(p, s)
    e = p.eccentricity
    vx, vy = s[VX], s[VY]
    if e != 0.0:
        vx, vy = vx + e * s[SPIN] * np.sin(s[THETA]), vy - e * s[SPIN] * np.cos(s[THETA])
    px, py, moment, normal = land_impulse(p, x, y, vx, vy, s[SPIN], dt)
    if normal > 0.0:
        work = lean(p, s, px, py, moment)
        ledger[LAND] += work
        ledger[GROSS] += abs(work)
        tally[LAND_MAX] = max(tally[LAND_MAX], normal / dt)
    drift(p, t + half, s, ledger, half, c, i)


@kernel
def near_land(p, s, dt):  # type: ignore[no-untyped-def]
    """Whether the cage may touch its land within a step."""
    x, y = centre(p, s)
    reach = (abs(s[VX]) + abs(s[VY]) + p.eccentricity * abs(s[SPIN]) + p.gravity * dt) * dt
    return p.land_side != 0.0 and np.sqrt(x * x + y * y) + 1.5 * reach > p.land_gap


@kernel
def enter(p, s, tally, before_vx, before_vy, before_energy, peak, dt):  # type: ignore[no-untyped-def]
    """Enter one step into the tally of its window."""
    x, y = centre(p, s)
    now = s[VX] * s[VX] + s[VY] * s[VY]
    energy = 0.5 * (p.mass * now + p.inertia * s[SPIN] * s[SPIN])
    cross = before_vx * s[VY] - before_vy * s[VX]
    dot = before_vx * s[VX] + before_vy * s[VY]
    tally[KINETIC] += 0.5 * (before_energy + energy) * dt
    tally[OFFSET_X] += x * dt
    tally[OFFSET_Y] += y * dt
    if dot != 0.0:
        tally[TURNING] += cross * (1.0 - (cross / dot) ** 2 / 6.0) if abs(cross) < abs(dot) else cross
    tally[SPEED_SQUARED] += now * dt
    tally[OFFSET_MAX] = max(tally[OFFSET_MAX], x * x + y * y)
    tally[FORCE_MAX] = max(tally[FORCE_MAX], peak)
    return energy


@kernel
def advance(p, cos, sin, counts, s, seat, lead, load, ledger, tally, steps):  # type: ignore[no-untyped-def]
    """Advance the cage by a number of steps, in place.

    Parameters
    ----------
    p : Coefficients
        The cage and its step.
    cos, sin, seat, lead, load : ndarray
        As in `press`; `load` must belong to the state.
    s, ledger, tally : ndarray
        State, work since the start, and integrals of this window: the slots named above.
    steps : int
        How many; never more are taken, so the work is bounded.
    """
    f = press(p, cos, sin, s, seat, lead, load, 0.0, 1.0, 1.0)
    energy = 0.5 * (p.mass * (s[VX] ** 2 + s[VY] ** 2) + p.inertia * s[SPIN] ** 2)
    done, was_count, calm = 0, -1, 0
    now = pace(p, 1)
    while done < steps:
        t = s[STEP] * p.unit
        count = counts[f.touching] * (CALM_STRIDE if calm > CALM_AFTER else 1)
        if f.touching == 0:
            count = max(count, int(clear_time(p, s, f.reach, p.longest_flight) / p.unit))
        count = min(count, steps - done)
        if count != was_count:
            now = pace(p, count)
            was_count = count
        dt, a, kept, followed, c, i, c_half, i_half = now
        vx, vy, was = s[VX], s[VY], f.squares
        if f.touching > 0:
            kick(p, s, ledger, f.cos, f.sin, f.total, 0.5 * dt)
        if near_land(p, s, dt):
            strike_land(p, t, s, ledger, tally, dt, c_half, i_half)
        else:
            drift(p, t, s, ledger, dt, c, i)
        f = press(p, cos, sin, s, seat, lead, load, a, kept, followed)
        calm = calm + 1 if f.changes == 0 and f.touching > 0 else 0
        if f.touching > 0 or f.changes > 0:
            kick(p, s, ledger, f.cos + f.edge_cos, f.sin + f.edge_sin, f.total + f.edge, 0.5 * dt)
        lost = 0.5 * (was + f.squares) * p.yielding * dt
        ledger[RACE_DAMPERS] -= lost
        ledger[GROSS] += lost
        energy = enter(p, s, tally, vx, vy, energy, f.peak, dt)
        done += count
        s[STEP] += count
    ledger[STORED] = 0.5 * f.squares / p.stiffness
