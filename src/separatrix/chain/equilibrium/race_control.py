"""Ball kinematics under outer or inner race control (Jones), and the ball equilibrium that follows.

Speeds are in units of (inner - outer) ring speed, relative to the outer ring: `orbit` m is
(w_m - w_o)/(w_i - w_o), and `spin` is the ball's spin in the frame that turns with its orbit.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.groove import Touch, touch
from separatrix.chain.equilibrium.problem import Problem, Work
from separatrix.compiled import kernel
from separatrix.units import Array

STEEPEST = 1.4
"""Largest contact angle for which kinematics are asked [rad]."""


@kernel
def controlled_kinematics(
    p: Problem, angle_i: float, angle_o: float, share: float
) -> tuple[float, float, float]:
    """Orbit m and spin (axial, radial) for rolling at both races without spin at the controlling one.

    `share` 0 is outer race control, 2 inner; between them the pitch angle is too. No groove reaches to 80
    degrees: beyond, the kinematics stay as they are there, so that a search may pass.
    """
    ratio = p.ball_diameter / p.pitch_diameter
    angle_i = min(max(angle_i, -STEEPEST), STEEPEST)
    angle_o = min(max(angle_o, -STEEPEST), STEEPEST)
    pitch = math.atan2(math.sin(angle_o), math.cos(angle_o) + ratio)
    if share > 0.0:
        inner = math.atan2(math.sin(angle_i), math.cos(angle_i) - ratio)
        pitch += 0.5 * share * (inner - pitch)
    roll_o = (1.0 / ratio + math.cos(angle_o)) / math.cos(pitch - angle_o)
    roll_i = (1.0 / ratio - math.cos(angle_i)) / math.cos(pitch - angle_i)
    m = roll_i / (roll_i + roll_o)
    return m, -m * roll_o * math.cos(pitch), m * roll_o * math.sin(pitch)


@kernel
def inertia_loads(p: Problem, m: float, spin_radial: float) -> tuple[float, float]:
    """Centrifugal force [N], and the gyroscopic term J w_m W_r along the orbit [N m]."""
    orbit = p.outer_speed + p.speed * m
    centrifugal = 0.5 * p.ball_mass * p.pitch_diameter * orbit * orbit
    return p.inertia_factor * centrifugal, p.inertia_factor * p.ball_inertia * orbit * p.speed * spin_radial


@kernel
def _inertia_at(p: Problem, angle_i: float, angle_o: float, share: float) -> tuple[float, float]:
    m, _, spin_radial = controlled_kinematics(p, angle_i, angle_o, share)
    return inertia_loads(p, m, spin_radial)


@kernel
def _inertia_slopes(p: Problem, angle_i: float, angle_o: float, share: float, slopes: Array) -> None:
    """Slopes of centrifugal force and gyroscopic term, shape (2, 3): inner angle, outer angle, share."""
    step = 1e-5
    F, G = _inertia_at(p, angle_i, angle_o, share)
    Fi, Gi = _inertia_at(p, angle_i + step, angle_o, share)
    Fo, Go = _inertia_at(p, angle_i, angle_o + step, share)
    slopes[0, 0], slopes[1, 0] = (Fi - F) / step, (Gi - G) / step
    slopes[0, 1], slopes[1, 1] = (Fo - F) / step, (Go - G) / step
    slopes[0, 2], slopes[1, 2] = 0.0, 0.0
    if p.inner_share > 0.0:
        Fs, Gs = _inertia_at(p, angle_i, angle_o, share + step)
        slopes[0, 2], slopes[1, 2] = (Fs - F) / step, (Gs - G) / step


@kernel
def normal_slopes(t: Touch, slopes: Array) -> None:
    """d(Q s, Q c)/d(axial, radial) of one contact, shape (2, 2) [N/m]."""
    s, c, side = t.sine, t.cosine, t.load / t.length
    slopes[0, 0] = t.load_slope * s * s + side * c * c
    slopes[0, 1] = slopes[1, 0] = (t.load_slope - side) * s * c
    slopes[1, 1] = t.load_slope * c * c + side * s * s


@kernel
def inner_share(p: Problem, load: float) -> tuple[float, float]:
    """Share lambda_i of the gyroscopic friction (and of the control) and its slope with the inner load.

    A ball that leaves the inner race cannot be controlled by it: where the inner load is less than the
    centrifugal force (taken at 0.45 of the ring speed) the share falls smoothly to 0.
    """
    full = inertia_loads(p, 0.45, 0.0)[0]
    if p.inner_share == 0.0 or load >= full:
        return p.inner_share, 0.0
    t = load / full
    return p.inner_share * t * t * (3.0 - 2.0 * t), p.inner_share * 6.0 * t * (1.0 - t) / full


@kernel
def controlled_ball(p: Problem, A: Array, state: Array, residual: Array, out: Work) -> None:
    """Force balance of one ball, shape (2,) [N], its slopes, and what the inner race gives the ball.

    `out.by_state`, shape (2, 4): slopes of the balance with V and with A. `out.push`: (axial, outward,
    orbital force, outward couple, orbital couple) of the inner race on the ball; `out.push_by`, shape (5, 4),
    its slopes.
    """
    D, push = p.ball_diameter, out.push
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    share, _ = inner_share(p, i.load)
    F, G = _inertia_at(p, math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine), share)
    T_i, T_o = share * G / D, (2.0 - share) * G / D  # friction across the grooves carries the moment
    push[:] = 0.0
    push[0] = i.load * i.sine + T_i * i.cosine
    push[1] = i.load * i.cosine - T_i * i.sine
    push[4] = 0.5 * D * T_i
    residual[0] = push[0] - o.load * o.sine - T_o * o.cosine
    residual[1] = push[1] - o.load * o.cosine + T_o * o.sine + F
    _controlled_slopes(p, i, o, G, out)


@kernel
def _controlled_slopes(p: Problem, i: Touch, o: Touch, G: float, out: Work) -> None:
    """Slopes of the balance; with w = A - V they enter V negative and A positive."""
    D, push_by, by_state = p.ball_diameter, out.push_by, out.by_state
    share, share_slope = inner_share(p, i.load)
    inertia = np.empty((2, 3))
    _inertia_slopes(p, math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine), share, inertia)
    T_i, T_o = share * G / D, (2.0 - share) * G / D
    H_i, H_o = np.empty((2, 2)), np.empty((2, 2))
    normal_slopes(i, H_i)
    normal_slopes(o, H_o)
    push_by[:, :] = 0.0
    for k in range(2):
        a_i = (i.cosine if k == 0 else -i.sine) / i.length  # slopes of the angles with w and V
        a_o = (o.cosine if k == 0 else -o.sine) / o.length
        handed = share_slope * i.load_slope * (i.sine if k == 0 else i.cosine)  # of the share with w
        F_w, F_v = inertia[0, 0] * a_i + inertia[0, 2] * handed, inertia[0, 1] * a_o
        G_w, G_v = inertia[1, 0] * a_i + inertia[1, 2] * handed, inertia[1, 1] * a_o
        Ti_w, Ti_v = (share * G_w + handed * G) / D, share * G_v / D
        To_w, To_v = ((2.0 - share) * G_w - handed * G) / D, (2.0 - share) * G_v / D
        push_by[0, 2 + k] = H_i[0, k] + Ti_w * i.cosine - T_i * i.sine * a_i
        push_by[1, 2 + k] = H_i[1, k] - Ti_w * i.sine - T_i * i.cosine * a_i
        push_by[4, 2 + k] = 0.5 * D * Ti_w
        push_by[0, k] = Ti_v * i.cosine - push_by[0, 2 + k]
        push_by[1, k] = -Ti_v * i.sine - push_by[1, 2 + k]
        push_by[4, k] = 0.5 * D * Ti_v - push_by[4, 2 + k]
        by_state[0, 2 + k] = push_by[0, 2 + k] - To_w * o.cosine
        by_state[1, 2 + k] = push_by[1, 2 + k] + To_w * o.sine + F_w
        outer_x = H_o[0, k] + To_v * o.cosine - T_o * o.sine * a_o
        outer_r = H_o[1, k] - To_v * o.sine - T_o * o.cosine * a_o - F_v
        by_state[0, k] = push_by[0, k] - outer_x + To_w * o.cosine
        by_state[1, k] = push_by[1, k] - outer_r - To_w * o.sine - F_w


@kernel
def inertia_pull(p: Problem, A: Array, state: Array, pull: Array) -> None:
    """Centrifugal force and the friction that carries the gyroscopic moment, (axial, outward) [N]."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    share, _ = inner_share(p, i.load)
    F, G = _inertia_at(p, math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine), share)
    T_i, T_o = share * G / p.ball_diameter, (2.0 - share) * G / p.ball_diameter
    pull[0] = T_i * i.cosine - T_o * o.cosine
    pull[1] = T_o * o.sine - T_i * i.sine + F
