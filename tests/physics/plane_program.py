# ruff: noqa: E501, F841 - a draft
"""The cage in the plane by another program: the frame of the housing, complex numbers, scipy's DOP853.

It takes the inputs of a cage and shares no code with the engine but the damper of the land, which
test_cage_closed_cases holds to an integration. What it has of the engine's model: a pocket acts along the orbit of its
ball, friction acts along the true sliding, and is in proportion to it below the pivoting speed.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from separatrix.cage import MovingCage
from separatrix.cage.closed_forms import rebound_damping
from separatrix.study import Guidance, PocketShape
from separatrix.units import Array

LEAST_PIVOT = 3e-3
"""Least pivoting speed of the engine over the initial disturbance."""


class Course(NamedTuple):
    """A run at its times, seen from the ball set: centre [m], rotation [rad], leads [m], balls' own speeds [m/s]."""

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
    """Half the clearance along the orbit, cosine and sine of the lean: of a straight wall that ends in an arc."""
    c, z = cage.pocket_clearance / 2.0, cage.pocket_axial_offset
    if cage.pocket_shape is PocketShape.SQUARE:
        return c, 1.0, 0.0
    arc = c if cage.pocket_shape is PocketShape.CYLINDRICAL else (cage.pocket_axial_clearance or 0.0) / 2.0
    lean = math.asin(z / arc) if z else 0.0
    return c - arc + arc * math.cos(lean), math.cos(lean), math.sin(lean)


def integrate(
    cage: MovingCage, *, kick: float, direction: float, ball_lead: Array, times: Array, rtol: float = 1e-10
) -> Course:
    """Follow the cage from its initial disturbance; where it is at these times, the first of which is 0."""
    R, Z, M, f = cage.pitch_radius, cage.ball_count, cage.mass + cage.added_mass, cage.ball_cage_friction
    at, swing, lever = np.exp(1j * np.array(cage.ball_angles)), cage.unbalance / M, cage.lever
    pivot, (half, cosine, sine) = max(cage.pivot_speed, LEAST_PIVOT * kick), outline(cage)
    land = cage.land_count * cage.land_stiffness
    land_damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(land * M)
    gap = math.inf if cage.guidance is Guidance.BALL else (cage.land_clearance or 0.0) / 2.0
    side, law = (-1.0 if cage.guidance is Guidance.INNER else 1.0), cage.traction
    reach = R if cage.land_radius is None else cage.land_radius
    ring = cage.inner_speed if cage.guidance is Guidance.INNER else cage.outer_speed

    def pockets(s: float, g: complex, vg: complex, slip: float, rate: float, lead: Array, u: Array) -> Array:
        """Force of each pocket along radius and orbit, and its moment, shape (3, ball)."""
        along = (g * at.conj()).imag + slip - lead
        depth = cosine * np.maximum(np.abs(along) - half, 0.0)
        push = (
            cage.ball_cage_stiffness * depth
            if cage.hertz_coefficient is None
            else cage.hertz_coefficient * depth**1.5
        )
        out = np.zeros((3, Z))
        for j in np.flatnonzero(push):  # axes: outward, along the orbit, along the axis
            n = np.array([0.0, -math.copysign(cosine, along[j]), -sine])
            here, spin = vg * at[j].conj(), s * np.array([cage.spin[1], cage.spin[2], cage.spin[0]])
            wall = np.array([here.real, here.imag + R * rate, 0.0]) + np.cross([0.0, 0.0, rate], lever * n)
            slide = np.array([0.0, u[j], 0.0]) + np.cross(spin, lever * n) - wall
            slide -= (slide @ n) * n
            force = push[j] * (n + f * slide / math.sqrt(slide @ slide + pivot**2))
            out[:, j] = force[0], force[1], R * force[1] - lever * n[1] * force[0]
        return out

    def land_force(s: float, g: complex, vg: complex, turned: float, rate: float) -> tuple[complex, float]:
        """Force of the land and its moment about the geometric centre."""
        n = g / max(abs(g), 1e-30)
        around, lobes = (vg * n.conjugate()).imag, cage.land_lobes * (np.angle(n) - turned)
        depth = abs(g) - gap + cage.land_out_of_round * math.cos(lobes)
        steep = cage.land_lobes * cage.land_out_of_round * math.sin(lobes)
        closing = (vg * n.conjugate()).real - steep * (around / max(abs(g), 1e-30) - rate)
        push = max(0.0, land * depth + land_damping * closing) if depth > 0.0 else 0.0
        slide = around + side * reach * (rate - s * (ring - cage.cage_speed))
        rub = -cage.land_friction * push * slide / math.hypot(slide, pivot)
        return (-push + 1j * (rub + push * steep / max(abs(g), 1e-30))) * n, side * reach * rub - push * steep

    def rates(t: float, y: Array) -> Array:
        s, passed = speed_share(cage, t)
        W, turn = s * cage.cage_speed, np.exp(1j * cage.cage_speed * passed)
        centre, v, theta, spin = complex(*y[:2]), complex(*y[2:4]), y[4], y[5]
        lead, own, e = y[6 : 6 + Z], np.zeros(Z), swing * np.exp(1j * theta)
        for h, (A, B) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
            wave = (at * turn) ** h
            own += s * (A * wave.real + B * wave.imag)
        u = own if law is None else own + y[6 + Z :]
        g, turned, rate = (centre - e) / turn, theta - cage.cage_speed * passed, spin - W
        vg = (v - 1j * spin * e) / turn - 1j * W * g
        radial, along, moments = pockets(s, g, vg, R * turned, rate, lead, u)
        pressed, moment = land_force(s, g, vg, turned, rate)
        force = np.sum((radial + 1j * along) * at) + pressed
        moment += moments.sum() - ((e / turn).conjugate() * force).imag
        pull = force * turn / M + cage.gravity * cage.mass / M
        yields = own - s * along / cage.race_damping if law is None else u
        slower = [] if law is None else (-along - law.force(y[6 + Z :] / s)) / law.mass
        return np.concatenate(
            [[v.real, v.imag, pull.real, pull.imag, spin, moment / cage.moment_of_inertia], yields, slower]
        )

    s, W = speed_share(cage, 0.0)[0], speed_share(cage, 0.0)[0] * cage.cage_speed
    begun = kick * np.exp(1j * direction) + 1j * W * swing
    start = np.concatenate(
        [[swing, 0.0, begun.real, begun.imag, 0.0, W], ball_lead, np.zeros(0 if law is None else Z)]
    )
    size = np.concatenate(
        [[1e-4] * 2, [kick] * 2, [1e-4 / R, kick / R], [1e-4] * Z, [kick] * (len(start) - 6 - Z)]
    )
    how = {"rtol": rtol, "atol": rtol * size, "max_step": 1e-5, "t_eval": times}
    y = solve_ivp(rates, (0.0, times[-1]), start, "DOP853", **how).y
    passed = np.array([speed_share(cage, t)[1] for t in times])
    centre = (y[0] + 1j * y[1] - swing * np.exp(1j * y[4])) * np.exp(-1j * cage.cage_speed * passed)
    speeds = np.zeros((len(times), Z)) if law is None else y[6 + Z :].T
    return Course(
        np.stack([centre.real, centre.imag], 1), y[4] - cage.cage_speed * passed, y[6 : 6 + Z].T, speeds
    )
