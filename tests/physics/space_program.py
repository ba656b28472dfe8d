"""A plain program for the cage in space: exact rotations, a fixed frame, one small step after another.

It shares nothing with the package's engine but the physics: rotation matrices instead of first-order tilts,
the frame of the housing instead of one that turns, scipy's integrator instead of series, forces that begin
and end without being located in time.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from separatrix.cage import MovingCage
from separatrix.ground.units import Array

AXIS = np.array([0.0, 0.0, 1.0])


def outward(angle: Array) -> Array:
    """Directions at these azimuths; axes (x, y, z) with z along the bearing, shape (ball, 3)."""
    return np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)


def along(one: Array, other: Array) -> Array:
    """Scalar product of each pair of rows, as a column."""
    return np.sum(one * other, axis=1, keepdims=True)


class SmallSteps:
    """A cage in space with bores or spheres and dampers, in the frame of the housing.

    State: centre (3), rotation vector's quaternion (4), velocity (3), spin in space (3), then for every ball
    its lead and its place along the groove.
    """

    def __init__(self, cage: MovingCage) -> None:
        self.cage, self.angles = cage, np.array(cage.ball_angles)
        self.inertia = np.diag([cage.transverse, cage.transverse, cage.moment_of_inertia])

    def forces(self, t: float, state: Array) -> tuple[Array, Array, Array]:
        """Force and moment on the cage, and the rates of the balls, shape (ball, 2)."""
        cage, R, W = self.cage, self.cage.pitch_radius, self.cage.cage_speed
        r, v, w = state[:3], state[7:10], state[10:13]
        lead, axial = state[13:].reshape(-1, 2).T[:, :, None]
        out = outward(self.angles + W * t)
        forward = np.cross(AXIS, out)
        ball = R * out + lead * forward + axial * AXIS
        bore = Rotation.from_quat(state[3:7]).apply(outward(self.angles))
        away = ball - r - R * bore
        away -= 0.0 if cage.is_wrapped else along(away, bore) * bore
        offset = np.linalg.norm(away, axis=1, keepdims=True)
        away /= np.maximum(offset, 1e-30)
        push = cage.ball_cage_stiffness * np.maximum(offset - cage.pocket_clearance / 2.0, 0.0)
        touched = cage.ball_diameter / 2.0 * away
        about = cage.ball_spin[0] * AXIS + cage.ball_spin[1] * out + cage.ball_spin[2] * forward + W * AXIS
        slip = W * np.cross(AXIS, ball) + np.cross(about, touched) - v - np.cross(w, ball + touched - r)
        slip -= along(slip, away) * away
        rub = cage.ball_cage_friction * push * slip / np.sqrt(along(slip, slip) + cage.pivot_speed**2)
        pull = push * away + rub
        moment = np.cross(ball - r, push * away) + np.cross(ball + cage.lever * away - r, rub)
        orbit = -along(pull, forward) / cage.race_damping
        groove = (-pull[:, 2:] - cage.groove_stiffness * axial) / cage.groove_damping
        return pull.sum(axis=0), moment.sum(axis=0), np.hstack([orbit, groove])

    def rates(self, t: float, state: Array) -> Array:
        """Time derivative of the state."""
        force, moment, balls = self.forces(t, state)
        turned, w = Rotation.from_quat(state[3:7]), state[10:13]
        local = turned.inv().apply(w)
        own = turned.inv().apply(moment) - np.cross(local, self.inertia @ local)
        twist = turned.apply(np.linalg.solve(self.inertia, own))
        q, s = state[3:6], state[6]
        spin = 0.5 * np.append(s * w + np.cross(w, q), -w @ q)
        return np.concatenate([state[7:10], spin, force / self.cage.mass, twist, balls.ravel()])

    def run(self, speed: Array, spin: Array, leads: Array, times: Array, step: float) -> Array:
        """States in the frame that turns with the balls: x, y, z, tilt about x, y and z, at all times."""
        W = self.cage.cage_speed
        start = np.concatenate(
            [[0.0] * 6, [1.0], speed, spin + W * AXIS, np.outer(leads, [1.0, 0.0]).ravel()]
        )
        how = {"method": "DOP853", "t_eval": times, "rtol": 1e-7, "atol": 1e-11, "max_step": step}
        found = solve_ivp(self.rates, (0.0, times[-1]), start, **how)
        back = Rotation.from_rotvec(-W * times[:, None] * AXIS)
        tilt = (back * Rotation.from_quat(found.y[3:7].T)).as_rotvec()
        return np.hstack([back.apply(found.y[:3].T), tilt])
