"""Equilibrium of one ball by both kinematic models: race control (Jones), and free.

Speeds are in units of (inner - outer) ring speed, relative to the outer ring: `orbit` m is
(w_m - w_o)/(w_i - w_o), and `spin` is the ball's spin in the frame that turns with its orbit. Under outer
or inner race control the state of a ball is V (axial, radial) [m], shape (2,), and its kinematics follow.
Without race control friction over both ellipses decides spin axis and orbit: shape (6,), V, orbit m and spin
(axial, radial, orbital).
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.groove import Touch, friction_resultants, touch
from separatrix.chain.equilibrium.problem import Problem, Work
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array

STEEPEST = 1.4
"""Largest contact angle for which kinematics are computed [rad]."""


@part
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


@part
def _inertia_at(p: Problem, angle_i: float, angle_o: float, share: float) -> tuple[float, float]:
    m, _, spin_radial = controlled_kinematics(p, angle_i, angle_o, share)
    return inertia_loads(p, m, spin_radial)


@part
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


@part
def normal_slopes(t: Touch, slopes: Array) -> None:
    """d(Q s, Q c)/d(axial, radial) of one contact, shape (2, 2) [N/m]."""
    s, c, side = t.sine, t.cosine, t.load / t.length
    slopes[0, 0] = t.load_slope * s * s + side * c * c
    slopes[0, 1] = slopes[1, 0] = (t.load_slope - side) * s * c
    slopes[1, 1] = t.load_slope * c * c + side * s * s


@part
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


@part
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


@part
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


@part
def inertia_pull(p: Problem, A: Array, state: Array, pull: Array) -> None:
    """Centrifugal force and the friction that carries the gyroscopic moment, (axial, outward) [N]."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    share, _ = inner_share(p, i.load)
    F, G = _inertia_at(p, math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine), share)
    T_i, T_o = share * G / p.ball_diameter, (2.0 - share) * G / p.ball_diameter
    pull[0] = T_i * i.cosine - T_o * o.cosine
    pull[1] = T_o * o.sine - T_i * i.sine + F


LEAST_SHARE = 1e-2
"""Share of the outer load with which the inner race still turns a ball that it hardly touches."""


@part
def slip_coefficients(p: Problem, side: float, t: Touch, state: Array, c: Array, normal: Array) -> None:
    """Coefficients of the slip field, shape (4,) [-, m], and the normal (axial, radial) out of the ball."""
    ring = 1.0 - state[2] if side < 0.0 else -state[2]
    normal[0], normal[1] = side * t.sine, side * t.cosine
    turn_x, turn_r = state[3] - ring, state[4]
    c[0] = turn_x * normal[0] + turn_r * normal[1]
    c[1] = turn_x * normal[1] - turn_r * normal[0]  # minus the turn along y = t x n = (-n_r, n_x)
    c[2] = -0.5 * ring * p.pitch_diameter
    c[3] = state[5]


@part
def contact_friction(
    p: Problem,
    side: float,
    t: Touch,
    load: float,
    state: Array,
    smoothing: float,
    cells: int,
    nodes: Array,
    out: Array,
) -> None:
    """Resultants of the slip field of one contact per unit of friction and load: `friction_resultants`."""
    c, normal = np.empty(4), np.empty(2)
    slip_coefficients(p, side, t, state, c, normal)
    f = p.inner_conformity if side < 0.0 else p.outer_conformity
    radius = 2.0 * f * p.ball_diameter / (2.0 * f + 1.0)
    a = t.major_coefficient * load ** (1.0 / 3.0)
    b = a * t.axis_ratio
    friction_resultants(c, a, b, 0.5 * p.ball_diameter, radius, smoothing, cells, nodes, out)


@part
def contact_actions(
    p: Problem,
    side: float,
    t: Touch,
    load: float,
    load_slope: float,
    state: Array,
    smoothing: float,
    cells: int,
    nodes: Array,
    force: Array,
    force_by: Array,
) -> None:
    """Friction of one race on the ball: forces (axial, outward, orbital), then couples, shape (6,).

    `force_by`, shape (6, 6): slopes with the vector from groove centre to ball (columns 0 and 1, the sign of
    `side` turning V into it) and with the four speeds of the state.
    """
    r, full = np.empty((5, 7)), np.empty((5, 7))
    contact_friction(p, side, t, load, state, smoothing, cells, nodes, r)
    c, n = np.empty(4), np.empty(2)
    slip_coefficients(p, side, t, state, c, n)
    grip = -p.friction * load if p.speed >= 0.0 else p.friction * load
    for row in range(5):  # the value; slopes with the vector, orbit and spin
        by_angle = r[row, 1] * c[1] - r[row, 2] * c[0]
        by_length = (r[row, 0] + r[row, 5]) * load_slope / load
        full[row, 0] = grip * r[row, 0]
        full[row, 1] = grip * (by_length * t.sine + by_angle * t.cosine / t.length)
        full[row, 2] = grip * (by_length * t.cosine - by_angle * t.sine / t.length)
        full[row, 4] = grip * (r[row, 1] * n[0] + r[row, 2] * n[1])
        full[row, 3] = full[row, 4] + grip * r[row, 3] * 0.5 * p.pitch_diameter
        full[row, 5] = grip * (r[row, 1] * n[1] - r[row, 2] * n[0])
        full[row, 6] = grip * r[row, 4]
    _to_ball(full[:, 0], n[0], n[1], force)
    for k in range(6):
        _to_ball(full[:, 1 + k], n[0], n[1], force_by[:, k])
    turned = np.empty(6)  # with the angle, n turns by a right angle
    _to_ball(full[:, 0], n[1], -n[0], turned)
    turned[2] = turned[5] = 0.0
    for q in range(6):
        force_by[q, 0] += turned[q] * t.cosine / t.length
        force_by[q, 1] -= turned[q] * t.sine / t.length


@part
def _to_ball(resultants: Array, n_x: float, n_r: float, out: Array) -> None:
    """Turn resultants in contact axes into (axial, outward, orbital) forces and couples, shape (6,)."""
    M, S, F, Mt, Fy = resultants
    out[0], out[1], out[2] = -Fy * n_r, Fy * n_x, F  # y = t x n = (-n_r, n_x)
    out[3], out[4], out[5] = M * n_x + S * n_r, M * n_r - S * n_x, Mt


@part
def free_ball(
    p: Problem,
    A: Array,
    state: Array,
    smoothing: tuple[float, float],
    cells: int,
    nodes: Array,
    residual: Array,
    out: Work,
) -> None:
    """Force and moment balance of one ball, shape (6,), its slopes, and what the inner race gives it.

    `smoothing` is that of the inner and of the outer race. Forces (axial, outward, orbital) [N], then
    couples [N m]. `out.by_state`, shape (6, 8): slopes with the state, then with A; `out.push` and
    `out.push_by`, shape (5, 8), as in `controlled_ball`.
    """
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    load_o, load_i, slope_i = turning_loads(p, i, o)
    acts, acts_by = np.empty((2, 6)), np.empty((2, 6, 6))
    for race in range(2):  # one call, for each copy of it takes seconds to compile
        side, t, load, slope = (-1.0, i, load_i, slope_i) if race == 0 else (1.0, o, load_o, o.load_slope)
        contact_actions(
            p, side, t, load, slope, state, smoothing[race], cells, nodes, acts[race], acts_by[race]
        )
    inner, inner_by, outer, outer_by = acts[0], acts_by[0], acts[1], acts_by[1]
    by_state, push, push_by = out.by_state, out.push, out.push_by
    for q in range(6):  # loops, for an expression of arrays takes seconds to compile
        residual[q] = inner[q] + outer[q]
        for k in range(2):
            by_state[q, k], by_state[q, 6 + k] = outer_by[q, k] - inner_by[q, k], inner_by[q, k]
        for k in range(2, 6):
            by_state[q, k] = inner_by[q, k] + outer_by[q, k]
    _add_inertia(p, state, residual, by_state)
    _keep_real_friction(i, load_i, inner, inner_by, residual, by_state)
    real = min(i.load / load_i, 1.0)
    for q in range(5):
        source = q if q < 3 else q + 1
        push[q] = real * inner[source]
        for k in range(2):
            push_by[q, k], push_by[q, 6 + k] = -real * inner_by[source, k], real * inner_by[source, k]
        for k in range(2, 6):
            push_by[q, k] = real * inner_by[source, k]
    _add_normal_loads(i, o, residual, out)


@part
def _add_normal_loads(i: Touch, o: Touch, residual: Array, out: Work) -> None:
    H_i, H_o = np.empty((2, 2)), np.empty((2, 2))
    normal_slopes(i, H_i)
    normal_slopes(o, H_o)
    residual[0] += i.load * i.sine - o.load * o.sine
    residual[1] += i.load * i.cosine - o.load * o.cosine
    out.push[0] += i.load * i.sine
    out.push[1] += i.load * i.cosine
    for q in range(2):
        for k in range(2):
            out.by_state[q, k] -= H_i[q, k] + H_o[q, k]
            out.by_state[q, 6 + k] += H_i[q, k]
            out.push_by[q, k] -= H_i[q, k]
            out.push_by[q, 6 + k] += H_i[q, k]


@part
def _keep_real_friction(
    i: Touch, turning: float, inner: Array, inner_by: Array, residual: Array, by_state: Array
) -> None:
    """In the plane of the ball a hardly touching race pushes with its true load, not with the turning one."""
    if i.load >= turning:
        return
    gone = 1.0 - i.load / turning
    for q in range(2):
        residual[q] -= gone * inner[q]
        for k in range(2, 6):
            by_state[q, k] -= gone * inner_by[q, k]
        for k in range(2):
            along = (i.sine if k == 0 else i.cosine) * i.load_slope / turning * inner[q] - gone * inner_by[
                q, k
            ]
            by_state[q, 6 + k] += along
            by_state[q, k] -= along


@part
def turning_loads(p: Problem, i: Touch, o: Touch) -> tuple[float, float, float]:
    """Loads that turn the ball: outer, inner, and the slope of the inner; none of them vanishes."""
    load_o = max(o.load, 1e-15 * p.modulus * p.ball_diameter**2)
    if i.load >= LEAST_SHARE * load_o:
        return load_o, i.load, i.load_slope
    return load_o, LEAST_SHARE * load_o, 0.0


@part
def _add_inertia(p: Problem, state: Array, residual: Array, by_state: Array) -> None:
    """Centrifugal force and the change of the ball's momentum of spin, J w_m e_x x spin."""
    F, G_r = inertia_loads(p, state[2], state[4])
    _, G_t = inertia_loads(p, state[2], state[5])
    _, G = inertia_loads(p, state[2], 1.0)
    orbit = p.outer_speed + p.speed * state[2]
    growth = p.speed / orbit if orbit != 0.0 else 0.0  # d ln(w_m)/dm
    residual[1] += F
    by_state[1, 2] += 2.0 * F * growth
    residual[4] += G_t
    residual[5] -= G_r
    by_state[4, 2] += G_t * growth
    by_state[5, 2] -= G_r * growth
    by_state[4, 5] += G
    by_state[5, 4] -= G
