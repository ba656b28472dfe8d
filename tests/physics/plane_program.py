"""The cage in the plane by another program: the frame of the housing, complex numbers, scipy's DOP853.

It shares no code with the engine but the damper of the land, which test_cage_closed_cases judges. Of the
engine's model it has that a pocket acts in the plane of orbit and axis of its ball, and that friction acts
along the true sliding and, in a pocket, is in proportion to it below the pivoting speed. A fluid that moves
with the cage is at rest in a frame that turns at its own speed, where it has added mass and damping.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from separatrix import BallTraction, Guidance, MovingCage, PocketShape
from separatrix.cage.closed_forms import rebound_damping
from separatrix.ground.units import Array

SMOOTH = 1e-4
"""Sliding on the land below which its friction is in proportion to it, for the integrator [m/s]."""


class Course(NamedTuple):
    """A run at its times, seen from the ball set: centre, rotation, leads, balls' own speeds; SI units."""

    position: Array
    rotation: Array
    ball_lead: Array
    ball_speed: Array


def speed_share(cage: MovingCage, t: float) -> tuple[float, float]:
    """Share of the full speed, in a ramp and after, and its integral over time [s]."""
    if cage.ramp_time == 0.0:
        return 1.0, t
    rise, ramped = (1.0 - cage.ramp_start) / cage.ramp_time, min(t, cage.ramp_time)
    return cage.ramp_start + rise * ramped, cage.ramp_start * ramped + 0.5 * rise * ramped**2 + t - ramped


def outline(cage: MovingCage) -> tuple[float, float, float]:
    """Half-lengths of a rectangle along orbit and axis, and of the circle that rolls round it [m]."""
    c = cage.pocket_clearance / 2.0
    if cage.pocket_shape is PocketShape.SQUARE:
        return c, math.inf, 0.0
    end = (cage.pocket_axial_clearance or 0.0) / 2.0 if cage.pocket_shape is PocketShape.ELONGATED else c
    return c - end, 0.0, end


class Plane:
    """Equations of a cage and its balls."""

    # State: centre, its velocity, angle and spin of the cage, leads, and speeds of balls of one state.

    def __init__(self, cage: MovingCage) -> None:
        self.cage, self.at = cage, np.exp(1j * np.array(cage.ball_angles))
        self.mass, self.outline = cage.mass + cage.added_mass, outline(cage)
        self.swing = cage.unbalance / self.mass
        self.land = cage.land_count * cage.land_stiffness
        self.land_damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(self.land * self.mass)
        self.gap = math.inf if cage.guidance is Guidance.BALL else (cage.land_clearance or 0.0) / 2.0
        self.side = -1.0 if cage.guidance is Guidance.INNER else 1.0
        self.reach = cage.pitch_radius if cage.land_radius is None else cage.land_radius
        ring = cage.inner_speed if cage.guidance is Guidance.INNER else cage.outer_speed
        self.ring = ring - cage.cage_speed

    def held(self, law: BallTraction, u: Array, turn: complex) -> Array:
        """Traction of every ball at its azimuth [N]."""
        shares = []
        for waves in (self.cage.capacity_waves, self.cage.slope_waves):
            pairs = enumerate(zip(waves[1::2], waves[2::2], strict=True), start=1)
            around = sum(complex(a, -b) * (self.at * turn) ** h for h, (a, b) in pairs)
            shares.append(np.maximum(waves[0] + np.real(around), 0.02) if waves else np.ones(len(u)))
        most, slope = shares[0] * law.capacity, shares[1] * law.slope
        return slope * u / (1.0 + (slope * u / most) ** 4) ** 0.25

    def pockets(
        self, s: float, g: complex, vg: complex, turned: float, rate: float, lead: Array, u: Array
    ) -> Array:
        """Force of each pocket on the cage along radius and orbit [N], and its moment, shape (3, ball)."""
        cage, R, lever = self.cage, self.cage.pitch_radius, self.cage.lever
        apart, beside, around = self.outline
        t = (g * self.at.conj()).imag + R * turned - lead
        t, z = t - np.clip(t, -apart, apart), cage.pocket_axial_offset
        z -= min(max(z, -beside), beside)
        r = cage.is_wrapped * ((g * self.at.conj()).real + cage.pocket_radial_offset)
        off = np.sqrt(t**2 + z**2 + r**2)
        depth, out = np.maximum(off - around, 0.0), np.zeros((3, len(t)))
        for j in np.flatnonzero(depth):  # axes: outward, along the orbit, along the axis
            n = -np.array([r[j], t[j], z]) / off[j]
            push = (
                cage.ball_cage_stiffness * depth[j]
                if cage.hertz_coefficient is None
                else cage.hertz_coefficient * depth[j] ** 1.5
            )
            here, spin = vg * self.at[j].conj(), s * np.array([cage.spin[1], cage.spin[2], cage.spin[0]])
            wall = np.array([here.real, here.imag + R * rate, 0.0]) + np.cross([0.0, 0.0, rate], lever * n)
            slide = np.array([0.0, u[j], 0.0]) + np.cross(spin, lever * n) - wall
            slide -= (slide @ n) * n
            rub = cage.ball_cage_friction * slide / math.sqrt(slide @ slide + cage.pivot_speed**2)
            force = push * (n + rub)
            couple = lever * push * (n[0] * rub[1] - n[1] * rub[0])
            out[:, j] = force[0], force[1], R * force[1] + couple
        return out

    def land_force(
        self, s: float, g: complex, vg: complex, turned: float, rate: float
    ) -> tuple[complex, float]:
        """Force of the land on the cage [N] and its moment about the geometric centre [N m]."""
        cage, off = self.cage, max(abs(g), 1e-30)
        n = g / off
        away, around = (vg * n.conjugate()).real, (vg * n.conjugate()).imag
        lobes = cage.land_lobes * (np.angle(self.side * n) - turned)
        depth = abs(g) - self.gap + cage.land_out_of_round * math.cos(lobes)
        steep = cage.land_lobes * cage.land_out_of_round * math.sin(lobes)
        closing = away - steep * (around / off - rate)
        push = max(0.0, self.land * depth + self.land_damping * closing) if depth > 0.0 else 0.0
        slide = around + self.side * self.reach * (rate - s * self.ring)
        rub = -cage.land_friction * push * slide / math.hypot(slide, SMOOTH)
        moment = self.side * self.reach * rub - push * steep
        return (-push + 1j * (rub + push * steep / off)) * n, moment

    def rates(self, t: float, y: Array) -> Array:
        """Time derivative of the state."""
        cage, law, Z = self.cage, self.cage.traction, self.cage.ball_count
        s, passed = speed_share(cage, t)
        W, turn = s * cage.cage_speed, np.exp(1j * cage.cage_speed * passed)
        centre, v, theta, spin = complex(*y[:2]), complex(*y[2:4]), y[4], y[5]
        lead, own, e = y[6 : 6 + Z], np.zeros(Z), self.swing * np.exp(1j * theta)
        for h, (A, B) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
            wave = (self.at * turn) ** h
            own += s * (A * wave.real + B * wave.imag)
        u = own if law is None else own + y[6 + Z :]
        g, turned, rate = (centre - e) / turn, theta - cage.cage_speed * passed, spin - W
        vg = (v - 1j * spin * e) / turn - 1j * W * g
        radial, along, moments = self.pockets(s, g, vg, turned, rate, lead, u)
        pressed, moment = self.land_force(s, g, vg, turned, rate)
        force = np.sum((radial + 1j * along) * self.at) + pressed
        moment += moments.sum() - ((e / turn).conjugate() * force).imag
        F = cage.fluid_speed * s
        rise = (1.0 - cage.ramp_start) / cage.ramp_time if 0.0 < cage.ramp_time > t else 0.0
        carried = cage.added_mass * (2j * F * v + (F * F + 1j * cage.fluid_speed * rise) * centre)
        carried -= s * cage.fluid_damping * (v - 1j * F * centre)
        pull = (force * turn + carried + cage.gravity * cage.mass) / self.mass
        leads = own - s * along / cage.race_damping if law is None else u
        slower = [] if law is None else (-along - self.held(law, y[6 + Z :] / s, turn)) / law.mass
        body = [v.real, v.imag, pull.real, pull.imag, spin, moment / cage.moment_of_inertia]
        return np.concatenate([body, leads, slower])


def integrate(
    cage: MovingCage, *, kick: float, direction: float, ball_lead: Array, times: Array, rtol: float = 1e-7
) -> Course:
    """Follow the cage from its initial disturbance; where it is at these times, the first of which is 0."""
    R, Z, plane = cage.pitch_radius, cage.ball_count, Plane(cage)
    W, swing = speed_share(cage, 0.0)[0] * cage.cage_speed, plane.swing
    begun = kick * np.exp(1j * direction) + 1j * W * swing
    own = np.zeros(0 if cage.traction is None else Z)
    start = np.concatenate([[swing, 0.0, begun.real, begun.imag, 0.0, W], ball_lead, own])
    sizes = [[1e-4] * 2, [kick] * 2, [1e-4 / R, kick / R], [1e-4] * Z, [kick] * len(own)]
    how = {"rtol": rtol, "atol": rtol * np.concatenate(sizes), "max_step": 2e-5, "t_eval": times}
    y = solve_ivp(plane.rates, (0.0, times[-1]), start, "DOP853", **how).y
    turned = cage.cage_speed * np.array([speed_share(cage, t)[1] for t in times])
    centre = (y[0] + 1j * y[1] - swing * np.exp(1j * y[4])) * np.exp(-1j * turned)
    speeds = y[6 + Z :].T if len(own) else np.zeros((len(times), Z))
    return Course(np.stack([centre.real, centre.imag], 1), y[4] - turned, y[6 : 6 + Z].T, speeds)
