"""The planar cage by another program: the equations as written, classical Runge-Kutta at a fixed small step.

It knows no events, takes the cage's inputs only, and shares no code with the engine but the damper of the
land (held to an integration in test_cage_motion). The land's friction is made continuous: it rises linearly
with the sliding up to `SLIP` and is then at its limit.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np

from separatrix.cage import PlanarCage
from separatrix.cage.closed_forms import rebound_damping
from separatrix.study import Guidance, PocketShape

SLIP = 2e-4
"""Sliding at which the land's friction is at its limit [m/s]."""

SOURCES = (
    *("pocket_friction", "race_dampers", "ball_drive"),
    *("land_friction", "land_damping", "gravity", "moving_frame"),
)

X, Y, VX, VY, THETA, SPIN, PHI = range(7)
WORK = 7
BALLS = WORK + len(SOURCES)


class Numbers(NamedTuple):
    """What the equations need: numbers, and arrays of the balls and of the harmonics of their speed."""

    mass: float
    inertia: float
    eccentricity: float
    radius: float
    stiffness: float  # of a pocket along the circumference, force = stiffness * approach^power
    power: float
    inward: float  # sigma f / cos psi: friction's share of the circumferential force
    race_damping: float
    gravity: float
    cage_speed: float
    ring_speed: float  # of the guiding ring, in space
    ramp_start: float
    ramp_time: float
    gap: float
    land_stiffness: float
    land_damper: float
    land_friction: float
    lobe: float  # signed for the land's side
    lobes: float
    side: float
    slip: float
    pocket_angle: np.ndarray
    cos: np.ndarray
    sin: np.ndarray
    half_play: np.ndarray
    cosines: np.ndarray
    sines: np.ndarray


@numba.njit(cache=True)
def speed_factor(t, rising, p):
    """Share of the full speed at this time, and its rate [1/s]."""
    if not rising:
        return 1.0, 0.0
    rise = (1.0 - p.ramp_start) / p.ramp_time
    return p.ramp_start + rise * t, rise


@numba.njit(cache=True)
def pocket(j, z, gx, gy, s, p, out):
    """Force on the cage (x, y, moment) from one pocket; enter its lead's rate and its works."""
    cos, sin = p.cos[j], p.sin[j]
    u = gy * cos - gx * sin + p.radius * z[THETA] - z[BALLS + j]
    drive = 0.0
    for h in range(p.cosines.size):
        at = (h + 1) * (p.pocket_angle[j] + z[PHI])
        drive += s * (p.cosines[h] * math.cos(at) + p.sines[h] * math.sin(at))
    approach = abs(u) - p.half_play[j]
    N = 0.0
    if approach > 0.0:
        N = math.copysign(p.stiffness * approach**p.power, u)
    out[BALLS + j] = N * s / p.race_damping + drive
    out[WORK + 1] -= N * N * s / p.race_damping
    out[WORK + 2] -= N * drive
    fx, fy = -p.inward * N * cos, -p.inward * N * sin
    return fx, fy, N * sin, -N * cos, -N * p.radius


@numba.njit(cache=True)
def land(z, gx, gy, vgx, vgy, s, p, out):
    """Force on the cage (x, y, moment) from the land; enter its works."""
    r = math.hypot(gx, gy)
    if r <= p.gap - abs(p.lobe):
        return 0.0, 0.0, 0.0
    nx, ny = gx / r, gy / r
    at = p.lobes * (math.atan2(gy, gx) - z[THETA])
    d = r - p.gap + p.lobe * math.cos(at)
    if d <= 0.0:
        return 0.0, 0.0, 0.0
    turn = p.lobe * p.lobes * math.sin(at)  # -dd/dpsi, and dd/dtheta
    dx, dy = nx + turn * ny / r, ny - turn * nx / r
    closing = dx * vgx + dy * vgy + turn * z[SPIN]
    F = max(0.0, p.land_stiffness * d + p.land_damper * closing)
    ring = (p.ring_speed - p.cage_speed) * s * p.radius
    surface = -ny * vgx + nx * vgy + p.side * p.radius * z[SPIN]
    T = -p.land_friction * F * min(1.0, max(-1.0, (surface - p.side * ring) / p.slip))
    out[WORK + 3] += T * surface
    out[WORK + 4] += (p.land_stiffness * d - F) * closing
    return -F * dx - T * ny, -F * dy + T * nx, -F * turn + p.side * T * p.radius


@numba.njit(cache=True)
def rates(t, rising, z, p, out):
    """Rates of the state in the turning frame, and of the works done."""
    out[:] = 0.0
    s, rise = speed_factor(t, rising, p)
    W, dW, M = p.cage_speed * s, p.cage_speed * rise, p.mass
    x, y, vx, vy, spin = z[X], z[Y], z[VX], z[VY], z[SPIN]
    ex, ey = p.eccentricity * math.cos(z[THETA]), p.eccentricity * math.sin(z[THETA])
    gx, gy, vgx, vgy = x - ex, y - ey, vx + ey * spin, vy - ex * spin
    fx, fy, moment = land(z, gx, gy, vgx, vgy, s, p, out)
    for j in range(p.pocket_angle.size):
        rubx, ruby, pushx, pushy, turn = pocket(j, z, gx, gy, s, p, out)
        fx += rubx + pushx
        fy += ruby + pushy
        moment += turn
        out[WORK] += rubx * vgx + ruby * vgy
    moment += ey * fx - ex * fy  # the forces act at the geometric centre, -e from the centre of mass
    down, across = p.gravity * math.cos(z[PHI]), -p.gravity * math.sin(z[PHI])
    pull, swing = W * W * x + dW * y, W * W * y - dW * x
    out[X], out[Y] = vx, vy
    out[VX] = 2.0 * W * vy + pull + fx / M + down
    out[VY] = -2.0 * W * vx + swing + fy / M + across
    out[THETA], out[SPIN], out[PHI] = spin, moment / p.inertia - dW, W
    out[WORK + 5] = M * (down * vx + across * vy)
    out[WORK + 6] = M * (pull * vx + swing * vy) - p.inertia * dW * spin


@numba.njit(cache=True)
def march(z, steps, h, p, rows, most):
    """Take the steps in place; fill `rows` evenly; return the mean kinetic energy of the last fifth [J].

    A run of more kinetic energy than `most` is taken to grow without end.
    """
    a, b, c, d = np.empty_like(z), np.empty_like(z), np.empty_like(z), np.empty_like(z)
    every = steps // max(1, len(rows) - 1)
    first, mean = steps - steps // 5, 0.0
    for i in range(steps):
        if len(rows) and i % every == 0:
            rows[i // every] = z
        t = i * h
        rising = t + 0.5 * h < p.ramp_time  # for the whole step: exact if the ramp lasts whole steps
        rates(t, rising, z, p, a)
        rates(t + 0.5 * h, rising, z + 0.5 * h * a, p, b)
        rates(t + 0.5 * h, rising, z + 0.5 * h * b, p, c)
        rates(t + h, rising, z + h * c, p, d)
        z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        energy = 0.5 * p.mass * (z[VX] ** 2 + z[VY] ** 2) + 0.5 * p.inertia * z[SPIN] ** 2
        if energy > most:
            return np.inf
        if i >= first:
            mean += energy
    if len(rows):
        rows[-1] = z
    return mean / max(1, steps - first)


@dataclass(frozen=True)
class Course:
    """One run, in the turning frame.

    `position` is that of the geometric centre, `velocity` of the centre of mass, `energy` of cage and
    springs, and `work` what each of `SOURCES` has done on them.
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    rate: np.ndarray
    ball_lead: np.ndarray
    energy: np.ndarray
    work: dict[str, np.ndarray]

    @property
    def imbalance(self) -> np.ndarray:
        """Energy that the works do not explain [J]."""
        return self.energy - self.energy[0] - sum(self.work.values())


def follow(
    cage,
    *,
    kick,
    direction,
    ball_lead,
    duration,
    step,
    half_play=None,
    pocket_angle=None,
    samples=4000,
    slip=SLIP,
):
    """Follow the run that starts so; `samples` divides the steps into about as many rows."""
    p = numbers(cage, half_play, pocket_angle, slip)
    every = max(1, round(duration / step / samples))
    count = max(1, round(duration / step / every))
    h = duration / (count * every)
    rows = np.empty((count + 1, BALLS + cage.ball_count))
    march(start(p, kick, direction, ball_lead), count * every, h, p, rows, math.inf)
    eccentric = p.eccentricity * np.stack([np.cos(rows[:, THETA]), np.sin(rows[:, THETA])], axis=1)
    return Course(
        time=np.arange(count + 1) * every * h,
        position=rows[:, [X, Y]] - eccentric,
        velocity=rows[:, [VX, VY]],
        rotation=rows[:, THETA],
        rate=rows[:, SPIN],
        ball_lead=rows[:, BALLS:],
        energy=energy(rows, rows[:, [X, Y]] - eccentric, p),
        work={name: rows[:, WORK + i] for i, name in enumerate(SOURCES)},
    )


def late_energy(
    cage, *, kick, direction, ball_lead, duration, step, half_play=None, pocket_angle=None, slip=SLIP
):
    """Mean kinetic energy over the last fifth of the run [J]."""
    p = numbers(cage, half_play, pocket_angle, slip)
    nothing = np.empty((0, BALLS + cage.ball_count))
    given = 0.5 * cage.mass * kick**2
    return march(start(p, kick, direction, ball_lead), round(duration / step), step, p, nothing, 1e5 * given)


def start(p, kick, direction, ball_lead):
    """State right after the kick: the geometric centre on the axis, nothing turned."""
    z = np.zeros(BALLS + len(p.pocket_angle))
    z[X] = p.eccentricity
    z[VX], z[VY] = kick * math.cos(direction), kick * math.sin(direction)
    z[BALLS:] = ball_lead
    return z


def numbers(cage: PlanarCage, half_play=None, pocket_angle=None, slip=SLIP) -> Numbers:
    """Numbers of a cage; play and angle of each pocket as given, else as designed, shape (ball,)."""
    Z = cage.ball_count
    play, psi = contact(cage)
    hertz = cage.hertz_coefficient is not None
    even = 2 * math.pi * np.arange(Z) / Z
    designed = np.array(cage.pocket_angles) if cage.pocket_angles else even
    angle = designed if pocket_angle is None else np.array(pocket_angle, dtype=float)
    stiffness = cage.land_count * cage.land_stiffness
    inner = cage.guidance is Guidance.INNER
    return Numbers(
        mass=cage.mass,
        inertia=cage.moment_of_inertia,
        eccentricity=cage.unbalance / cage.mass,
        radius=cage.pitch_radius,
        stiffness=cage.hertz_coefficient * math.cos(psi) ** 2.5
        if hertz
        else cage.ball_cage_stiffness * math.cos(psi) ** 2,
        power=1.5 if hertz else 1.0,
        inward=float(np.sign(cage.inner_speed - cage.outer_speed)) * cage.ball_cage_friction / math.cos(psi),
        race_damping=cage.race_damping,
        gravity=cage.gravity,
        cage_speed=cage.cage_speed,
        ring_speed=cage.inner_speed if inner else cage.outer_speed,
        ramp_start=cage.ramp_start,
        ramp_time=cage.ramp_time,
        gap=math.inf if cage.guidance is Guidance.BALL else cage.land_clearance / 2,
        land_stiffness=stiffness,
        land_damper=2 * rebound_damping(cage.land_restitution) * math.sqrt(stiffness * cage.mass),
        land_friction=cage.land_friction,
        lobe=cage.land_out_of_round * (-1 if inner and cage.land_lobes % 2 else 1),
        lobes=float(cage.land_lobes),
        side=-1.0 if inner else 1.0,
        slip=slip,
        pocket_angle=angle,
        cos=np.cos(angle),
        sin=np.sin(angle),
        half_play=np.full(Z, play) if half_play is None else np.array(half_play, dtype=float),
        cosines=np.array(cage.orbital_cosines, dtype=float),
        sines=np.array(cage.orbital_sines, dtype=float),
    )


def contact(cage):
    """Half play along the circumference [m], and angle of the contact's normal out of the plane [rad]."""
    c, z = cage.pocket_clearance / 2, cage.pocket_axial_offset
    if cage.pocket_shape is PocketShape.SQUARE:
        return c, 0.0
    end = c if cage.pocket_shape is PocketShape.CYLINDRICAL else cage.pocket_axial_clearance / 2
    return c - end + math.sqrt(end**2 - z**2), math.asin(z / end)


def energy(rows, centre, p):
    """Energy of the cage in the turning frame and of every spring, shape (time,) [J]."""
    kinetic = 0.5 * p.mass * (rows[:, VX] ** 2 + rows[:, VY] ** 2) + 0.5 * p.inertia * rows[:, SPIN] ** 2
    gx, gy = centre.T[:, :, np.newaxis]
    u = gy * p.cos - gx * p.sin + p.radius * rows[:, [THETA]] - rows[:, BALLS:]
    approach = np.maximum(np.abs(u) - p.half_play, 0.0)
    pockets = p.stiffness / (1 + p.power) * (approach ** (1 + p.power)).sum(axis=1)
    if math.isinf(p.gap):
        return kinetic + pockets
    angle = np.arctan2(centre[:, 1], centre[:, 0]) - rows[:, THETA]
    depth = np.hypot(*centre.T) - p.gap + p.lobe * np.cos(p.lobes * angle)
    return kinetic + pockets + 0.5 * p.land_stiffness * np.maximum(depth, 0.0) ** 2
