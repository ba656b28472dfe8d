"""Ball equilibrium without race control: friction over both ellipses decides spin axis and orbit.

State of a ball, shape (6,): V (axial, radial) [m], orbit m and spin (axial, radial, orbital) in units of the
difference of the ring speeds.
"""

from __future__ import annotations

import numpy as np

from separatrix.chain.equilibrium.groove import Touch, touch
from separatrix.chain.equilibrium.problem import Problem, Work
from separatrix.chain.equilibrium.race_control import inertia_loads, normal_slopes
from separatrix.chain.equilibrium.slip import friction_resultants
from separatrix.compiled import kernel
from separatrix.units import Array

LEAST_SHARE = 1e-2
"""Share of the outer load with which the inner race still turns a ball that it hardly touches."""


@kernel
def slip_coefficients(p: Problem, side: float, t: Touch, state: Array, c: Array, normal: Array) -> None:
    """Coefficients of the slip field, shape (4,) [-, m], and the normal (axial, radial) out of the ball."""
    ring = 1.0 - state[2] if side < 0.0 else -state[2]
    normal[0], normal[1] = side * t.sine, side * t.cosine
    turn_x, turn_r = state[3] - ring, state[4]
    c[0] = turn_x * normal[0] + turn_r * normal[1]
    c[1] = turn_x * normal[1] - turn_r * normal[0]  # minus the turn along y = t x n = (-n_r, n_x)
    c[2] = -0.5 * ring * p.pitch_diameter
    c[3] = state[5]


@kernel
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


@kernel
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
    r, full = np.empty((5, 6)), np.empty((5, 7))
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


@kernel
def _to_ball(resultants: Array, n_x: float, n_r: float, out: Array) -> None:
    """Turn resultants in contact axes into (axial, outward, orbital) forces and couples, shape (6,)."""
    M, S, F, Mt, Fy = resultants
    out[0], out[1], out[2] = -Fy * n_r, Fy * n_x, F  # y = t x n = (-n_r, n_x)
    out[3], out[4], out[5] = M * n_x + S * n_r, M * n_r - S * n_x, Mt


@kernel
def free_ball(
    p: Problem, A: Array, state: Array, smoothing: float, cells: int, nodes: Array, residual: Array, out: Work
) -> None:
    """Force and moment balance of one ball, shape (6,), its slopes, and what the inner race gives it.

    Forces (axial, outward, orbital) [N], then couples [N m]. `out.by_state`, shape (6, 8): slopes with the
    state, then with A; `out.push` and `out.push_by`, shape (5, 8), as in `controlled_ball`.
    """
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    load_o, load_i, slope_i = turning_loads(p, i, o)
    inner, inner_by, outer, outer_by = np.empty(6), np.empty((6, 6)), np.empty(6), np.empty((6, 6))
    contact_actions(p, -1.0, i, load_i, slope_i, state, smoothing, cells, nodes, inner, inner_by)
    contact_actions(p, 1.0, o, load_o, o.load_slope, state, smoothing, cells, nodes, outer, outer_by)
    by_state, push, push_by = out.by_state, out.push, out.push_by
    residual[:] = inner + outer
    by_state[:, 2:6] = inner_by[:, 2:] + outer_by[:, 2:]
    by_state[:, 6:] = inner_by[:, :2]
    by_state[:, :2] = outer_by[:, :2] - inner_by[:, :2]
    _add_inertia(p, state, residual, by_state)
    _keep_real_friction(i, load_i, inner, inner_by, residual, by_state)
    real = min(i.load / load_i, 1.0)
    for q in range(5):
        source = q if q < 3 else q + 1
        push[q] = real * inner[source]
        push_by[q, :2], push_by[q, 6:] = -real * inner_by[source, :2], real * inner_by[source, :2]
        push_by[q, 2:6] = real * inner_by[source, 2:]
    _add_normal_loads(i, o, residual, out)


@kernel
def _add_normal_loads(i: Touch, o: Touch, residual: Array, out: Work) -> None:
    H_i, H_o = np.empty((2, 2)), np.empty((2, 2))
    normal_slopes(i, H_i)
    normal_slopes(o, H_o)
    residual[0] += i.load * i.sine - o.load * o.sine
    residual[1] += i.load * i.cosine - o.load * o.cosine
    out.by_state[:2, :2] -= H_i + H_o
    out.by_state[:2, 6:] += H_i
    out.push[0] += i.load * i.sine
    out.push[1] += i.load * i.cosine
    out.push_by[:2, :2] -= H_i
    out.push_by[:2, 6:] += H_i


@kernel
def _keep_real_friction(
    i: Touch, turning: float, inner: Array, inner_by: Array, residual: Array, by_state: Array
) -> None:
    """In the plane of the ball a hardly touching race pushes with its true load, not with the turning one."""
    if i.load >= turning:
        return
    gone = 1.0 - i.load / turning
    for q in range(2):
        residual[q] -= gone * inner[q]
        by_state[q, 2:6] -= gone * inner_by[q, 2:]
        for k in range(2):
            along = (i.sine if k == 0 else i.cosine) * i.load_slope / turning * inner[q] - gone * inner_by[
                q, k
            ]
            by_state[q, 6 + k] += along
            by_state[q, k] -= along


@kernel
def turning_loads(p: Problem, i: Touch, o: Touch) -> tuple[float, float, float]:
    """Loads that turn the ball: outer, inner, and the slope of the inner; none of them vanishes."""
    load_o = max(o.load, 1e-15 * p.modulus * p.ball_diameter**2)
    if i.load >= LEAST_SHARE * load_o:
        return load_o, i.load, i.load_slope
    return load_o, LEAST_SHARE * load_o, 0.0


@kernel
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
