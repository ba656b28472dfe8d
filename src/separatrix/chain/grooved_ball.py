"""One ball between its two grooves: contacts, friction, and the balance of the ball.

In the plane of a ball, (x, r) are the axial and outward components. V leads from the outer groove's centre of
curvature to the ball centre, A to the inner groove's, and W = A - V from the ball to the latter. Speeds are
in units of (inner - outer) ring speed, relative to the outer ring: the orbit m is (w_m - w_o)/(w_i - w_o),
and the spin is that in the frame that turns with the ball's orbit. The state u of a ball, shape (6,), is
V [m], m, and the spin (axial, outward, orbital).

A groove is half a circle that goes on as two straight walls: no ball meets the missing half of the circle,
and the room of a ball stays convex. Contact angles so steep are refused once a bearing is solved.

A balance is an array `rows`, shape (12, 9): forces (axial, outward, orbital) [N] and couples [N m] on the
ball, and below them those that the inner race gives it. Column 0 has the values, 1 to 6 their slopes with the
state, 7 and 8 with A.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from separatrix.chain.hertz import approach_coefficient, contact_modulus
from separatrix.chain.slip_friction import COARSE_NODES, NODES, friction_resultants
from separatrix.ground.compiled import part, unfolded
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array
from separatrix.study.study import BallBearing, Operation

STATIC, CONTROLLED, FREE, HELD, KINEMATIC = range(5)
"""Models of a ball: without inertia; under race control; by friction alone; orbit and spin by friction or by
race control while V is held."""

STEEPEST = 1.4
"""Largest contact angle for which kinematics are computed [rad]."""

LEAST_SHARE = 1e-2
"""Share of the outer load with which the inner race still turns a ball that it hardly touches."""

SMOOTHING = 1e-4
"""Slip speed that rounds the corner of Coulomb's law, over the speed difference times d_m/4."""

TOLERANCE, FOLLOWED = 1e-11, 1e-7
"""Unbalance of a ball over the force scale of the bearing, of which rounding allows about 1e-14; the same of
a ball without race control on the way down to `SMOOTHING`."""


class Problem(NamedTuple):
    """Bearing and speeds as plain floats [SI]; a ball has no mass where nothing turns."""

    ball_diameter: float
    pitch_diameter: float
    inner_conformity: float
    outer_conformity: float
    modulus: float
    ball_mass: float
    ball_inertia: float
    outer_speed: float
    speed: float  # inner less outer
    inner_share: float  # lambda_i of the gyroscopic friction; the outer race carries 2 - lambda_i
    friction: float


def problem(bearing: BallBearing, operation: Operation, inner_share: float, friction: float) -> Problem:
    """Collect what the kernels need.

    Raises
    ------
    InputError
        The ball material has no density although the bearing turns.
    """
    D, ball = bearing.ball_diameter, bearing.ball_material
    inner, outer = float(operation.inner_speed), float(operation.outer_speed)
    turning = inner != 0.0 or outer != 0.0
    if ball.density is None and turning:
        cure = "Centrifugal force needs it; add it, or set the speeds to 0."
        raise InputError("[bearing] ball_material", "needs a density [kg/m3]", "", cure)
    mass = float(ball.density or 0.0) * math.pi * D**3 / 6.0 if turning else 0.0
    grooves = bearing.inner_conformity, bearing.outer_conformity, contact_modulus(ball, bearing.ring_material)
    turns = mass, 0.1 * mass * D * D, outer, inner - outer, inner_share, friction
    # an int would compile every kernel anew
    return Problem(*(float(number) for number in (D, bearing.pitch_diameter, *grooves, *turns)))


class Touch(NamedTuple):
    """One contact: angle as sine and cosine, load, its slopes, and the ellipse per load^(1/3)."""

    sine: float
    cosine: float
    length: float  # from ball centre to groove centre; infinite at a straight wall, where no angle changes
    load: float
    load_slope: float  # dQ/d(length)
    major_coefficient: float  # a = major_coefficient Q^(1/3)
    axis_ratio: float  # b/a


@part
def _stiffness(p: Problem, side: float, cosine: float) -> tuple[float, float, float]:
    """Stiffness and ellipse of a contact at its angle: `approach_coefficient`; side -1 inner, +1 outer."""
    D, f = p.ball_diameter, p.inner_conformity if side < 0.0 else p.outer_conformity
    rolling = 2.0 / (D * (1.0 + side * D * cosine / p.pitch_diameter))
    stiffness, major, k = approach_coefficient(rolling, (2.0 - 1.0 / f) / D, p.modulus, 0.0)
    return stiffness, major, k


@part
def touch(p: Problem, side: float, axial: float, radial: float) -> Touch:
    """Contact of a ball whose centre is (axial, radial) from the groove's; side -1 inner, +1 outer."""
    at_wall, radial = radial < 0.0, max(radial, 0.0)
    length = math.hypot(axial, radial)
    f = p.inner_conformity if side < 0.0 else p.outer_conformity
    approach = length - (f - 0.5) * p.ball_diameter
    # Without contact the angle is only nominal: turn it towards the radial direction as the gap opens.
    nominal_radial = radial - 2.0 * min(approach, 0.0)
    nominal = math.hypot(axial, nominal_radial)
    kappa, major, k = _stiffness(p, side, nominal_radial / nominal)
    root = math.sqrt(max(approach, 0.0))
    load, slope = kappa * root * max(approach, 0.0), 1.5 * kappa * root
    length = math.inf if at_wall else length
    return Touch(axial / nominal, nominal_radial / nominal, length, load, slope, major, k)


@part
def touches(p: Problem, A: Array, u: Array) -> tuple[Touch, Touch]:
    """Contacts of a ball at the inner and at the outer race."""
    return touch(p, -1.0, A[0] - u[0], A[1] - u[1]), touch(p, 1.0, u[0], u[1])


@part
def static_touch(p: Problem, A: Array, u: Array) -> Touch:
    """Both contacts on one line (no inertia), as one between the grooves' centres; V goes into the state."""
    axial, radial, at_wall = A[0], max(A[1], 0.0), A[1] < 0.0
    length = math.hypot(axial, radial)
    s, c = (axial / length, radial / length) if length > 0.0 else (0.0, 1.0)
    approach = length - (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    soft_i, soft_o = _stiffness(p, -1.0, c)[0] ** (-2.0 / 3.0), _stiffness(p, 1.0, c)[0] ** (-2.0 / 3.0)
    load = (max(approach, 0.0) / (soft_i + soft_o)) ** 1.5
    share = approach * soft_o / (soft_i + soft_o) if load > 0.0 else approach
    reach = (p.outer_conformity - 0.5) * p.ball_diameter + share
    u[0], u[1] = reach * s, reach * c + 0.5 * min(A[1], 0.0)  # between straight walls any height balances
    slope = 1.5 * load / approach if load > 0.0 else 0.0
    return Touch(s, c, math.inf if at_wall else length, load, slope, 0.0, 0.0)


@part
def _add(row: Array, value: float, w_x: float, w_r: float, v_x: float, v_r: float) -> None:
    """Add to a row of a balance a value and its slopes with W = A - V, and with V alone."""
    row[0] += value
    row[1] += v_x - w_x
    row[2] += v_r - w_r
    row[7] += w_x
    row[8] += w_r


@part
def _add_normal_load(t: Touch, rows: Array, inner: bool) -> None:
    """Load of a contact on the ball, (axial, outward) [N]: dQ/d(length) along it, Q/length across it."""
    s, c, k, side = t.sine, t.cosine, t.load_slope, t.load / t.length
    xx, xr, rr = k * s * s + side * c * c, (k - side) * s * c, k * c * c + side * s * s
    if inner:
        for first in (0, 6):
            _add(rows[first], t.load * s, xx, xr, 0.0, 0.0)
            _add(rows[first + 1], t.load * c, xr, rr, 0.0, 0.0)
    else:
        _add(rows[0], -t.load * s, 0.0, 0.0, -xx, -xr)
        _add(rows[1], -t.load * c, 0.0, 0.0, -xr, -rr)


@part
def inertia_loads(p: Problem, m: float, spin: float) -> tuple[float, float]:
    """Centrifugal force [N], and the gyroscopic moment J w_m W of a component of the spin [N m]."""
    orbit = p.outer_speed + p.speed * m
    return 0.5 * p.ball_mass * p.pitch_diameter * orbit * orbit, p.ball_inertia * orbit * p.speed * spin


# Race control (Jones)


@part
def controlled_kinematics(
    p: Problem, angle_i: float, angle_o: float, load_i: float
) -> tuple[float, float, float, float]:
    """Orbit m, spin (axial, outward) and lambda_i: rolling at both races, no spin at the controlling one.

    lambda_i 0 is outer race control, 2 inner; between them the pitch angle is too. A ball that leaves the
    inner race cannot be controlled by it: where the inner load is less than the centrifugal force (taken at
    0.45 of the ring speed) lambda_i falls smoothly to 0. No groove reaches to 80 degrees: beyond, the
    kinematics stay as they are there, so that a search may pass.
    """
    share, full, g = p.inner_share, inertia_loads(p, 0.45, 0.0)[0], p.ball_diameter / p.pitch_diameter
    if load_i < full:
        share *= (load_i / full) ** 2 * (3.0 - 2.0 * load_i / full)
    a_i, a_o = min(max(angle_i, -STEEPEST), STEEPEST), min(max(angle_o, -STEEPEST), STEEPEST)
    pitch = math.atan2(math.sin(a_o), math.cos(a_o) + g)  # tan(beta) = sin(a_o)/(cos(a_o) + D/d_m)
    if share > 0.0:
        pitch += 0.5 * share * (math.atan2(math.sin(a_i), math.cos(a_i) - g) - pitch)
    roll_o = (1.0 / g + math.cos(a_o)) / math.cos(pitch - a_o)
    roll_i = (1.0 / g - math.cos(a_i)) / math.cos(pitch - a_i)
    m = roll_i / (roll_i + roll_o)
    return m, -m * roll_o * math.cos(pitch), m * roll_o * math.sin(pitch), share


@part
def kinematic_start(p: Problem, A: Array, u: Array) -> None:
    """Give a ball the orbit and spin of race control at its place."""
    i, o = touches(p, A, u)
    angle_i, angle_o = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    u[2], u[3], u[4], _ = controlled_kinematics(p, angle_i, angle_o, i.load)
    u[5] = 0.0


@part
def _pull(p: Problem, angle_i: float, angle_o: float, load_i: float, out: Array) -> None:
    """Inertia, and friction T = lambda G/D across the grooves that carries the gyroscopic moment G.

    Shape (5,): (axial, outward) on the ball, the same of the inner race alone, its couple along the orbit.
    """
    m, _, spin, share = controlled_kinematics(p, angle_i, angle_o, load_i)
    F, G = inertia_loads(p, m, spin)
    T_i, T_o = share * G / p.ball_diameter, (2.0 - share) * G / p.ball_diameter
    out[2], out[3], out[4] = T_i * math.cos(angle_i), -T_i * math.sin(angle_i), 0.5 * p.ball_diameter * T_i
    out[0], out[1] = out[2] - T_o * math.cos(angle_o), out[3] + T_o * math.sin(angle_o) + F


@part
def controlled_balance(p: Problem, A: Array, u: Array, follow: float, rows: Array) -> bool:
    """Balance of forces under race control, orbit and spin following V; whether a groove presses the ball.

    Slopes of inertia and friction are differences, times `follow`: with 0 both count as constant.
    """
    i, o = touches(p, A, u)
    angle_i, angle_o = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    full, step, pulls = inertia_loads(p, 0.45, 0.0)[0], 1e-6, np.empty((4, 5))
    load_step = step * full if full > 0.0 else 1.0
    _pull(p, angle_i, angle_o, i.load, pulls[0])
    _pull(p, angle_i + step, angle_o, i.load, pulls[1])
    _pull(p, angle_i, angle_o + step, i.load, pulls[2])
    _pull(p, angle_i, angle_o, i.load + load_step, pulls[3])
    rows[:, :] = 0.0
    for n in range(5):
        at = pulls[0, n]
        by_i, by_o = (
            (pulls[1, n] - at) * follow / step / i.length,
            (pulls[2, n] - at) * follow / step / o.length,
        )
        by_load = (pulls[3, n] - at) * follow / load_step * i.load_slope
        w_x, w_r = by_i * i.cosine + by_load * i.sine, by_load * i.cosine - by_i * i.sine
        _add(rows[(0, 1, 6, 7, 11)[n]], at, w_x, w_r, by_o * o.cosine, -by_o * o.sine)
    _add_normal_load(i, rows, True)
    _add_normal_load(o, rows, False)
    return i.load + o.load > 0.0


# No race control: friction of the whole slip field over each ellipse


@part
def slip_coefficients(p: Problem, side: float, t: Touch, u: Array, c: Array, normal: Array) -> None:
    """Coefficients of the slip field, shape (4,) [-, m], and the normal (axial, outward) out of the ball."""
    ring = 1.0 - u[2] if side < 0.0 else -u[2]
    normal[0], normal[1] = side * t.sine, side * t.cosine
    turn_x, turn_r = u[3] - ring, u[4]
    c[0] = turn_x * normal[0] + turn_r * normal[1]
    c[1] = turn_x * normal[1] - turn_r * normal[0]  # minus the turn along y = t x n = (-n_r, n_x)
    c[2] = -0.5 * ring * p.pitch_diameter
    c[3] = u[5]


@part
def contact_friction(
    p: Problem, side: float, t: Touch, load: float, u: Array, smoothing: float, nodes: Array, out: Array
) -> None:
    """Resultants of the slip field of one contact per unit of friction and load: `friction_resultants`."""
    c, normal = np.empty(4), np.empty(2)
    slip_coefficients(p, side, t, u, c, normal)
    f = p.inner_conformity if side < 0.0 else p.outer_conformity
    radius = 2.0 * f * p.ball_diameter / (2.0 * f + 1.0)
    a = t.major_coefficient * load ** (1.0 / 3.0)
    friction_resultants(c, a, a * t.axis_ratio, 0.5 * p.ball_diameter, radius, smoothing, nodes, out)


@part
def contact_actions(
    p: Problem,
    side: float,
    t: Touch,
    Q: float,
    slope: float,
    u: Array,
    smoothing: float,
    nodes: Array,
    out: Array,
) -> None:
    """Friction of one race on the ball: forces (axial, outward, orbital) and couples, and slopes, (6, 7).

    Q is the load that turns the ball, `slope` that of Q with the length. Column 0 the values, 1 and 2 their
    slopes with the vector between groove centre and ball, V or W, and 3 to 6 with the speeds of the state.
    """
    r, c, n, s, cosine = np.empty((5, 7)), np.empty(4), np.empty(2), t.sine, t.cosine
    contact_friction(p, side, t, Q, u, smoothing, nodes, r)
    slip_coefficients(p, side, t, u, c, n)
    for q in range(5):  # values and slopes in the axes of the contact
        value, by_length = r[q, 0], (r[q, 0] + r[q, 5]) * slope / Q
        by_angle, by_orbital = (r[q, 1] * c[1] - r[q, 2] * c[0]) / t.length, r[q, 4]
        by_axial, by_outward = r[q, 1] * n[0] + r[q, 2] * n[1], r[q, 1] * n[1] - r[q, 2] * n[0]
        r[q, 3] = by_axial + 0.5 * p.pitch_diameter * r[q, 3]
        r[q, 0], r[q, 4], r[q, 5], r[q, 6] = value, by_axial, by_outward, by_orbital
        r[q, 1], r[q, 2] = by_length * s + by_angle * cosine, by_length * cosine - by_angle * s
    grip = -p.friction * Q if p.speed >= 0.0 else p.friction * Q
    for k in range(7):  # out of the axes of the contact, y = t x n = (-n_r, n_x)
        M, S, F, M_t, F_y = grip * r[0, k], grip * r[1, k], grip * r[2, k], grip * r[3, k], grip * r[4, k]
        out[0, k], out[1, k], out[2, k] = -F_y * n[1], F_y * n[0], F
        out[3, k], out[4, k], out[5, k] = M * n[0] + S * n[1], M * n[1] - S * n[0], M_t
    for q in (0, 3):  # with the angle, n turns by a right angle
        by_x, by_r = cosine / t.length, -s / t.length
        out[q, 1] += out[q + 1, 0] * by_x
        out[q, 2] += out[q + 1, 0] * by_r
        out[q + 1, 1] -= out[q, 0] * by_x
        out[q + 1, 2] -= out[q, 0] * by_r


@part
def turning_loads(p: Problem, i: Touch, o: Touch) -> tuple[float, float, float]:
    """Loads that turn the ball: outer, inner, and the slope of the inner; none of them vanishes."""
    load_o = max(o.load, 1e-15 * p.modulus * p.ball_diameter**2)
    if i.load >= LEAST_SHARE * load_o:
        return load_o, i.load, i.load_slope
    return load_o, LEAST_SHARE * load_o, 0.0


@part
def free_balance(
    p: Problem, A: Array, u: Array, smoothing: tuple[float, float], nodes: Array, rows: Array
) -> None:
    """Balance of forces and couples without race control; `smoothing` is that of inner and outer race."""
    i, o = touches(p, A, u)
    load_o, load_i, slope_i = turning_loads(p, i, o)
    acts = np.empty((2, 6, 7))
    for race in range(2):  # one call, for each copy of it takes seconds to compile
        side, t, Q, slope = (-1.0, i, load_i, slope_i) if race == 0 else (1.0, o, load_o, o.load_slope)
        contact_actions(p, side, t, Q, slope, u, smoothing[race], nodes, acts[race])
    # In the plane of the ball a hardly touching race pushes with its true load, not with the turning one.
    true, growth = (i.load / load_i, i.load_slope / load_i) if i.load < load_i else (1.0, 0.0)
    rows[:, :] = 0.0
    for q in range(6):
        a, b = acts[0, q], acts[1, q]
        w_x, w_r = true * a[1] + growth * i.sine * a[0], true * a[2] + growth * i.cosine * a[0]
        _add(rows[6 + q], true * a[0], w_x, w_r, 0.0, 0.0)
        if q < 2:
            _add(rows[q], true * a[0] + b[0], w_x, w_r, b[1], b[2])
        else:
            _add(rows[q], a[0] + b[0], a[1], a[2], b[1], b[2])
        for k in range(3, 7):
            rows[q, k], rows[6 + q, k] = (true if q < 2 else 1.0) * a[k] + b[k], true * a[k]
    _add_normal_load(i, rows, True)
    _add_normal_load(o, rows, False)
    # centrifugal force, and the change of the ball's momentum of spin, J w_m e_x x spin
    F, G_r = inertia_loads(p, u[2], u[4])
    G, G_t = inertia_loads(p, u[2], 1.0)[1], inertia_loads(p, u[2], u[5])[1]
    orbit = p.outer_speed + p.speed * u[2]
    growth = p.speed / orbit if orbit != 0.0 else 0.0  # d ln(w_m)/dm
    for q, value, by_m in ((1, F, 2.0 * F), (4, G_t, G_t), (5, -G_r, -G_r)):
        rows[q, 0] += value
        rows[q, 3] += by_m * growth
    rows[4, 6] += G
    rows[5, 5] -= G


# Solution


@part
def eliminate(matrix: Array) -> bool:
    """Solve n equations in place, shape (n, n + columns): the columns become the answers; False if singular.

    Gauss and Jordan, with exchange of rows.
    """
    n = matrix.shape[0]
    for i in range(n):
        pivot = i
        for j in range(i + 1, n):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        head = matrix[pivot, i]
        if not abs(head) > 0.0:
            return False
        for k in range(i, matrix.shape[1]):
            value = matrix[pivot, k] / head
            matrix[pivot, k], matrix[i, k] = matrix[i, k], value
        for j in range(n):
            factor = matrix[j, i] if j != i else 0.0
            for k in range(i, matrix.shape[1]):
                matrix[j, k] -= factor * matrix[i, k]
    return True


@part
def _copy(into: Array, values: Array) -> None:
    """Copy a state: an assignment of slices takes seconds to compile."""
    for k in range(into.size):
        into[k] = values[k]


@part
def _unbalance(rows: Array, scales: Array, first: int, last: int) -> float:
    """Root of the sum of squares of the scaled balance."""
    total = 0.0
    for q in range(first, last):
        total += (rows[q, 0] / scales[q]) ** 2
    return math.sqrt(total)


@unfolded
def newton_ball(
    p: Problem,
    A: Array,
    u: Array,
    model: int,
    smoothing: float,
    coarse: bool,
    force: float,
    limit: int,
    tolerance: float,
    rows: Array,
    by_ring: Array,
) -> float:
    """Newton with step halving from a state, in place; returns the scaled unbalance (good if <= tolerance).

    Loads in the plane are in units of `force` [N], friction across it in units of what the races can hold.
    Under race control the energy of both grooves is convex and a step is good if it does not climb beyond the
    low point of its line; else if the unbalance falls. `coarse` takes few nodes, or inertia as constant.
    `by_ring`, (6, 2), becomes the slopes with A of what the inner race gives a ball kept in balance.
    """
    first, last = 2 if model == HELD else 0, 2 if model == CONTROLLED else 6
    n, scales, trial, step, matrix = last - first, np.ones(6), u.copy(), np.zeros(6), np.empty((6, 9))
    reach, least = 0.3 * (min(p.inner_conformity, p.outer_conformity) - 0.5) * p.ball_diameter, 2e-4
    if model == CONTROLLED:
        reach, least = math.inf, 1e-15
    norm, stride, steps, work = math.inf, 1.0, 0, 0.0
    while True:  # one call of each balance, for each copy of it takes seconds to compile
        if model == CONTROLLED:
            pressed = controlled_balance(p, A, trial, 0.0 if coarse else 1.0, rows)
            good = pressed and step[0] * rows[0, 0] + step[1] * rows[1, 0] >= -0.5 * work
        else:
            free_balance(p, A, trial, (smoothing, smoothing), COARSE_NODES if coarse else NODES, rows)
            good = _unbalance(rows, scales, first, last) <= (1.0 - 0.1 * stride) * norm
        if good or steps == 0:
            _copy(u, trial)
            scales[:2] = force
            if last == 6:
                i, o = touches(p, A, u)
                turning = max(turning_loads(p, i, o)[1], 1e-9 * force)
                scales[2] = 100.0 * p.friction * turning  # rounding is coarser here
                scales[3:] = 0.5 * p.ball_diameter * scales[2]
            norm = _unbalance(rows, scales, first, last)
            for q in range(n):
                for k in range(n):
                    matrix[q, k] = rows[first + q, 1 + first + k] / scales[first + q]
                for k in range(3):  # the step, and how the state follows A
                    matrix[q, n + k] = -rows[first + q, 0 if k == 0 else 6 + k] / scales[first + q]
            if not eliminate(matrix[:n, : n + 3]):
                return math.inf
            if norm <= tolerance or steps >= limit:
                break
            steps += 1
            for k in range(n):
                step[first + k] = matrix[k, n]
            work = step[0] * rows[0, 0] + step[1] * rows[1, 0]
            stride = min(1.0, reach / max(math.hypot(step[0], step[1]), 1e-300))
        else:
            stride *= 0.5
            if stride < least:
                break
        for k in range(6):
            trial[k] = u[k] + stride * step[k]
    for q in range(6):
        for k in range(2):
            by_ring[q, k] = rows[6 + q, 7 + k]
            for state in range(n):
                by_ring[q, k] += rows[6 + q, 1 + first + state] * matrix[state, n + 1 + k]
    return min(norm, tolerance) if norm <= 100.0 * tolerance else norm  # rounding: as good as it gets


@part
def _restart(p: Problem, A: Array, u: Array, model: int, second: bool) -> float:
    """Another state to start from, and the smoothing to start with.

    Under race control V is that of the static line, or where the centrifugal force presses the ball into the
    outer groove; without it orbit and spin are those of race control.
    """
    if model != CONTROLLED:
        kinematic_start(p, A, u)
        return 3.0 if second else 0.03
    if static_touch(p, A, u).load == 0.0 or second:
        trial = 1e-3 * p.ball_diameter
        u[0], u[1] = 0.0, (p.outer_conformity - 0.5) * p.ball_diameter
        hard = touch(p, 1.0, 0.0, u[1] + trial).load
        u[1] += trial * (inertia_loads(p, 0.45, 0.0)[0] / hard) ** (2.0 / 3.0)
    return SMOOTHING


@unfolded
def solve_ball(
    p: Problem, A: Array, u: Array, model: int, force: float, rows: Array, by_ring: Array
) -> float:
    """Ball in balance, in place; returns the smoothing of friction reached, `SMOOTHING` if all went well.

    From its state at once, else from two others, coarse first. The smoothing is lowered in adaptive ratios.
    """
    place, good, best = u.copy(), u.copy(), math.inf
    for attempt in range(5):
        smoothing = SMOOTHING
        if attempt > 0 or model == HELD:
            _copy(u, place)
            smoothing = _restart(p, A, u, model, attempt > 2)
        ratio, reached, coarse = 0.25, math.inf, attempt % 2 == 1
        while True:
            last = smoothing == SMOOTHING and not coarse
            limit, tolerance = (12 if attempt == 0 else 100, TOLERANCE) if last else (25, FOLLOWED)
            if coarse and model == CONTROLLED:
                limit, tolerance = 2000, TOLERANCE
            slip = smoothing * 0.25 * p.pitch_diameter
            if newton_ball(p, A, u, model, slip, coarse, force, limit, tolerance, rows, by_ring) <= tolerance:
                if last:
                    return SMOOTHING
                _copy(good, u)
                reached, ratio, coarse = smoothing, max(ratio * ratio, 0.1), coarse and smoothing > SMOOTHING
            else:
                ratio = math.sqrt(ratio)
                _copy(u, good)
                if not SMOOTHING < reached < math.inf or ratio > 0.98:
                    break
            smoothing = max(reached * ratio, SMOOTHING)
        best = min(best, max(reached, 2.0 * SMOOTHING))
    return best


@part
def _between_grooves(p: Problem, A: Array, u: Array) -> None:
    """Put a ball that floats between its grooves a hair from touching both, with A."""
    span = (1.0 - 1e-12) * (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    length = math.hypot(A[0], A[1])
    if length < span:
        for k in range(2):
            A[k] *= span / length
            u[k] = A[k] * (p.outer_conformity - 0.5) / (p.inner_conformity + p.outer_conformity - 1.0)


@unfolded
def solve_balls(
    p: Problem, A: Array, u: Array, model: int, force: float, push: Array, by_rings: Array
) -> tuple[float, int]:
    """Every ball in balance between its rings, from its state, in place.

    A, shape (ball, 2), leads from the outer to the inner groove's centre [m]; states u, (ball, 6); `push`,
    (ball, 6), is what the inner race gives each, and `by_rings`, (ball, 6, 2), its slopes with A. `force` [N]
    is that which counts as one unit.

    Returns the smoothing reached by a ball that failed and its number; the smoothing is `SMOOTHING` if none.
    """
    rows = np.empty((12, 9))
    for j in range(A.shape[0]):
        rows[:, :] = 0.0
        if model == STATIC:
            _add_normal_load(static_touch(p, A[j], u[j]), rows, True)
            for q in range(6):
                _copy(by_rings[j, q], rows[6 + q, 7:])
        if model in (HELD, KINEMATIC):
            _between_grooves(p, A[j], u[j])
        if model not in (STATIC, KINEMATIC):
            reached = solve_ball(p, A[j], u[j], model, force, rows, by_rings[j])
            if reached > SMOOTHING:
                return reached, j
        if model in (CONTROLLED, KINEMATIC):
            kinematic_start(p, A[j], u[j])
        _copy(push[j], rows[6:, 0])
    return SMOOTHING, -1
