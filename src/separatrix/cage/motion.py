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
    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, Second

STEPS_PER_RADIAN = 4.0
LONGEST_FLIGHT = 256

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

    dt: float
    mass: float
    inertia: float
    radius: float
    turning: float
    stiffness: float
    yielding: float  # 1 / C_mu
    half_play: float
    friction: float  # sigma f
    relax: float
    land_side: float
    land_gap: float
    land_stiffness: float
    land_damping: float
    land_friction: float
    ring_slide: float
    eccentricity: float
    gravity: float


def longest_step(cage: PlanarCage) -> Second:
    """Step that resolves the fastest contact motion: a quarter of its time per radian [s]."""
    turning = cage.pitch_radius**2 / cage.moment_of_inertia
    rate = cage.ball_count * cage.ball_cage_stiffness * max(turning, 0.5 / cage.mass)
    if cage.guidance is not Guidance.BALL:
        rate = max(rate, cage.land_stiffness / cage.mass)
    return 1.0 / (STEPS_PER_RADIAN * math.sqrt(rate))


def coefficients(cage: PlanarCage, dt: Second) -> Coefficients:
    """Kernel's numbers of a cage at a step."""
    k, m = cage.ball_cage_stiffness, cage.mass
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    return Coefficients(
        dt=dt,
        mass=m,
        inertia=cage.moment_of_inertia,
        radius=cage.pitch_radius,
        turning=cage.cage_speed,
        stiffness=k,
        yielding=1.0 / cage.race_damping,
        half_play=cage.half_play,
        friction=cage.friction_sense * cage.ball_cage_friction,
        relax=k * dt / cage.race_damping,
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
def fly(p, t, s, dt):  # type: ignore[no-untyped-def]
    """Advance the free motion exactly: a straight line (or gravity's parabola) in space, seen in the turning frame."""
    W = p.turning
    ux, uy = s[VX] - W * s[Y], s[VY] + W * s[X]
    x, y = s[X] + ux * dt, s[Y] + uy * dt
    if p.gravity != 0.0:
        gx, gy = p.gravity * np.cos(W * t), -p.gravity * np.sin(W * t)
        x, y = x + 0.5 * gx * dt * dt, y + 0.5 * gy * dt * dt
        ux, uy = ux + gx * dt, uy + gy * dt
    if W != 0.0:
        c, i = np.cos(W * dt), np.sin(W * dt)
        x, y = c * x + i * y, c * y - i * x
        ux, uy = c * ux + i * uy, c * uy - i * ux
    s[X], s[Y] = x, y
    s[VX], s[VY] = ux + W * y, uy - W * x
    s[THETA] += s[SPIN] * dt


@kernel
def centre(p, s):  # type: ignore[no-untyped-def]
    """Geometric centre of the cage, which the unbalance parts from its centre of mass [m]."""
    e = p.eccentricity
    if e == 0.0:
        return s[X], s[Y]
    return s[X] - e * np.cos(s[THETA]), s[Y] - e * np.sin(s[THETA])


@kernel
def drift(p, t, s, ledger, dt):  # type: ignore[no-untyped-def]
    """Advance the free motion and enter the work of gravity, moving frame and unbalance."""
    W2 = p.mass * p.turning * p.turning
    x, y = s[X], s[Y]
    cx, cy = centre(p, s)
    fly(p, t, s, dt)
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
def press(p, cos, sin, s, seat, lead, load):  # type: ignore[no-untyped-def]
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
    tuple of float
        Sums of N cos, N sin and N [N], of N^2 [N2], and the largest excursion |u| of a ball in its pocket [m].
    """
    x, y = centre(p, s)
    turned = p.radius * s[THETA]
    kept, followed = relaxation(p.relax)
    c = p.half_play
    sum_cos = sum_sin = total = squares = reach = 0.0
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
            q, gave = settle(side * old - c, side * new - c, p.relax, kept, followed)
            lead[j] += side * gave
            n = side * p.stiffness * q
        reach = max(reach, abs(w - lead[j]))
        load[j] = n
        sum_cos += n * cos[j]
        sum_sin += n * sin[j]
        total += n
        squares += n * n
    return sum_cos, sum_sin, total, squares, reach


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
def flight_steps(p, s, reach, limit):  # type: ignore[no-untyped-def]
    """Steps for which nothing can touch, from the gaps left and a bound on the speed."""
    x, y = centre(p, s)
    r = np.sqrt(x * x + y * y)
    gap = min(p.half_play - reach, p.land_gap - r)
    W = abs(p.turning)
    limit = min(limit, LONGEST_FLIGHT)
    if W > 0.0:
        limit = min(limit, int(0.1 / (W * p.dt)))
    if gap <= 0.0 or limit < 2:
        return 1
    ux, uy = s[VX] - p.turning * s[Y], s[VY] + p.turning * s[X]
    rim = np.sqrt(s[X] * s[X] + s[Y] * s[Y])
    speed = 1.1 * np.sqrt(ux * ux + uy * uy) + W * rim
    speed += abs(s[SPIN]) * (p.radius + p.eccentricity) + 1.1 * p.gravity * limit * p.dt
    if speed * p.dt * limit <= gap:
        return limit
    return max(1, int(gap / (speed * p.dt)))


@kernel
def strike_land(p, t, s, ledger, tally):  # type: ignore[no-untyped-def]
    """Drift one step with the land's impulse in its middle."""
    half = 0.5 * p.dt
    drift(p, t, s, ledger, half)
    x, y = centre(p, s)
    e = p.eccentricity
    vx, vy = s[VX], s[VY]
    if e != 0.0:
        vx, vy = vx + e * s[SPIN] * np.sin(s[THETA]), vy - e * s[SPIN] * np.cos(s[THETA])
    px, py, moment, normal = land_impulse(p, x, y, vx, vy, s[SPIN])
    if normal > 0.0:
        work = lean(p, s, px, py, moment)
        ledger[LAND] += work
        ledger[GROSS] += abs(work)
        tally[LAND_MAX] = max(tally[LAND_MAX], normal / p.dt)
    drift(p, t + half, s, ledger, half)


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
def advance(p, cos, sin, s, seat, lead, load, ledger, tally, steps):  # type: ignore[no-untyped-def]
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
    sum_cos = sum_sin = total = squares = reach = peak = 0.0
    for j in range(cos.size):
        n = load[j]
        sum_cos += n * cos[j]
        sum_sin += n * sin[j]
        total += n
        squares += n * n
        reach = max(reach, abs(seat[j] - lead[j]))
    energy = 0.5 * (p.mass * (s[VX] ** 2 + s[VY] ** 2) + p.inertia * s[SPIN] ** 2)
    done = 0
    while done < steps:
        t = s[STEP] * p.dt
        count = flight_steps(p, s, reach, steps - done) if squares == 0.0 else 1
        dt = count * p.dt
        vx, vy, was = s[VX], s[VY], squares
        if count == 1:
            kick(p, s, ledger, sum_cos, sum_sin, total, 0.5 * dt)
            if p.land_side != 0.0:
                strike_land(p, t, s, ledger, tally)
            else:
                drift(p, t, s, ledger, dt)
        else:
            drift(p, t, s, ledger, dt)
        sum_cos, sum_sin, total, squares, reach = press(p, cos, sin, s, seat, lead, load)
        if squares > 0.0 or was > 0.0:
            kick(p, s, ledger, sum_cos, sum_sin, total, 0.5 * dt)
            lost = 0.5 * (was + squares) * p.yielding * dt
            ledger[RACE_DAMPERS] -= lost
            ledger[GROSS] += lost
            peak = np.max(np.abs(load))
        energy = enter(p, s, tally, vx, vy, energy, peak, dt)
        peak = 0.0
        done += count
        s[STEP] += count
    ledger[STORED] = 0.5 * squares / p.stiffness
