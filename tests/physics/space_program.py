"""A plain program for the cage in space: exact rotations, a fixed frame, one small step after another.

It shares nothing with the package's engine but the physics: rotation matrices instead of first-order tilts,
the frame of the housing instead of one that turns, scipy's integrator instead of series, forces that begin
and end without being located in time.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from separatrix.cage import MovingCage
from separatrix.ground.units import Array


def ring_axes(angle: float) -> tuple[Array, Array]:
    """Outward and along the orbit at an azimuth; axes (x, y, z) with z along the bearing."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c, s, 0.0]), np.array([-s, c, 0.0])


def bore_contact(
    centre: Array, turned: Rotation, angle: float, radius: float, ball: Array
) -> tuple[float, float, Array]:
    """Offset of a ball's centre from the axis of its bore, height along it, and direction of the offset."""
    axis = turned.apply(ring_axes(angle)[0])
    away = ball - centre - radius * axis
    height = float(away @ axis)
    across = away - height * axis
    offset = float(np.linalg.norm(across))
    return offset, height, across / offset


def sliding(
    centre_speed: Array, spin: Array, centre: Array, ball: Array, ball_speed: Array, ball_spin: Array,
    direction: Array, ball_radius: float,
) -> tuple[float, Array]:  # fmt: skip
    """Rate at which a ball comes off the wall, and the sliding of its surface on the cage's, in space."""
    point = ball + ball_radius * direction
    cage_speed = centre_speed + np.cross(spin, point - centre)
    surface = ball_speed + np.cross(ball_spin, ball_radius * direction)
    relative = surface - cage_speed
    normal = float(relative @ direction)
    return -normal, relative - normal * direction


class SmallSteps:
    """A cage in space with bores and dampers, in the frame of the housing.

    State: centre (3), rotation vector's quaternion (4), velocity (3), spin in space (3), then for every ball
    its lead and its place along the groove.
    """

    def __init__(self, cage: MovingCage) -> None:
        self.cage, self.plane = cage, cage
        self.angles = np.array(cage.ball_angles)
        across = cage.transverse
        self.inertia = np.diag([across, across, cage.moment_of_inertia])

    def forces(self, t: float, state: Array) -> tuple[Array, Array, Array]:
        """Force and moment on the cage, and the rates of the balls, shape (ball, 2)."""
        cage, plane, D = self.cage, self.plane, self.cage.ball_diameter
        r, v, w = state[:3], state[7:10], state[10:13]
        turned = Rotation.from_quat(state[3:7])
        balls = state[13:].reshape(-1, 2)
        force, moment, rates = np.zeros(3), np.zeros(3), np.zeros_like(balls)
        for j, phi in enumerate(self.angles):
            lead, axial = balls[j]
            out, along = ring_axes(phi + plane.cage_speed * t)
            ball = plane.pitch_radius * out + lead * along + np.array([0.0, 0.0, axial])
            offset, _, away = bore_contact(r, turned, phi, plane.pitch_radius, ball)
            depth = offset - plane.pocket_clearance / 2.0
            pull = np.zeros(3)
            if depth > 0.0:
                push = plane.ball_cage_stiffness * depth
                ball_speed = plane.cage_speed * np.cross([0.0, 0.0, 1.0], ball)
                spin = cage.ball_spin[0] * np.array([0.0, 0.0, 1.0])
                spin = spin + cage.ball_spin[1] * out + cage.ball_spin[2] * along
                spin = spin + np.array([0.0, 0.0, plane.cage_speed])
                _, slip = sliding(v, w, r, ball, ball_speed, spin, away, D / 2.0)
                rub = plane.ball_cage_friction * push * slip / math.sqrt(slip @ slip + cage.pivot_speed**2)
                pull = push * away + rub
                force += pull
                moment += np.cross(ball - r, push * away) + np.cross(ball + cage.lever * away - r, rub)
            rates[j, 0] = -pull @ along / plane.race_damping
            rates[j, 1] = (-pull[2] - cage.groove_stiffness * axial) / cage.groove_damping
        return force, moment, rates

    def rates(self, t: float, state: Array) -> Array:
        """Time derivative of the state."""
        force, moment, balls = self.forces(t, state)
        turned = Rotation.from_quat(state[3:7])
        w = state[10:13]
        local = turned.inv().apply(w)
        own = turned.inv().apply(moment) - np.cross(local, self.inertia @ local)
        twist = turned.apply(np.linalg.solve(self.inertia, own))
        x, y, z, s = state[3:7]
        spin = 0.5 * np.array(
            [s * w[0] + w[1] * z - w[2] * y, s * w[1] + w[2] * x - w[0] * z, s * w[2] + w[0] * y - w[1] * x,
             -w[0] * x - w[1] * y - w[2] * z]
        )  # fmt: skip
        return np.concatenate([state[7:10], spin, force / self.plane.mass, twist, balls.ravel()])

    def run(self, speed: Array, spin: Array, leads: Array, times: Array, step: float) -> Array:
        """States in the frame that turns with the balls: x, y, z, tilt about x, y and z, at all times."""
        W = self.plane.cage_speed
        start = np.concatenate([np.zeros(3), [0.0, 0.0, 0.0, 1.0], speed, [*spin[:2], spin[2] + W]])
        start = np.concatenate([start, np.stack([leads, 0.0 * leads], 1).ravel()])
        found = solve_ivp(
            self.rates, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-13,
            max_step=step,
        )  # fmt: skip
        rows = []
        for t, state in zip(times, found.y.T, strict=True):
            back = Rotation.from_rotvec([0.0, 0.0, -W * t])
            tilt = (back * Rotation.from_quat(state[3:7])).as_rotvec()
            rows.append(np.concatenate([back.apply(state[:3]), tilt]))
        return np.array(rows)
