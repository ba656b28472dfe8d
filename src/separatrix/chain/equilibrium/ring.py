"""Equilibrium of the inner ring in five degrees of freedom, over balls that are each in balance.

Ring displacement q = (x, y, z) [m] and small turns about y and z [rad]; y lies along the radial load, ball j
at azimuth psi_j from y towards z. Loads are conjugate to q. Then angles, loads, speeds and spin of the solved
balls, and Jones's criterion.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.chain.equilibrium.balance import inertia_loads, slip_coefficients
from separatrix.chain.equilibrium.ball_balance import (
    SMOOTHING,
    kinematic_start,
    slopes_with_ring,
    solve_controlled,
    solve_free,
    solve_kinematics,
)
from separatrix.chain.equilibrium.groove import Touch, static_split, touch
from separatrix.chain.equilibrium.problem import Method, Problem, Work, copy, solve_linear, work
from separatrix.chain.hertz import elliptic_integrals
from separatrix.ground.compiled import kernel, part, unfolded
from separatrix.ground.units import Array

STATIC, CONTROLLED, FREE = 3, 2, 6
"""Length of the state of a ball, which names its model; of the three numbers of STATIC two are used."""

IntArray = NDArray[np.int64]


class Balls(NamedTuple):
    """Loads on the ring, its degrees of freedom, and the balls to solve, each standing for `weight` balls."""

    loads: Array
    dofs: IntArray
    azimuths: Array
    weight: float


@part
def groove_vector(p: Problem, q: Array, azimuth: float, A: Array) -> None:
    """A, from the outer to the inner groove centre in the plane of a ball, shape (2,) [m]."""
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    s, c, arm = math.sin(azimuth), math.cos(azimuth), 0.5 * p.pitch_diameter
    A[0] = span * p.free_sine + q[0] + arm * (q[3] * s - q[4] * c)
    A[1] = span * p.free_cosine + q[1] * c + q[2] * s


@part
def push_on_ring(p: Problem, azimuth: float, push: Array, out: Array) -> None:
    """Turn forces and couples in ball axes into the five loads they make, shape (5, columns)."""
    s, c, arm = math.sin(azimuth), math.cos(azimuth), 0.5 * p.pitch_diameter
    for k in range(push.shape[1]):
        out[0, k] = push[0, k]
        out[1, k] = push[1, k] * c - push[2, k] * s
        out[2, k] = push[1, k] * s + push[2, k] * c
        out[3, k] = arm * push[0, k] * s + push[3, k] * c - push[4, k] * s
        out[4, k] = -arm * push[0, k] * c + push[3, k] * s + push[4, k] * c


@part
def static_ball(p: Problem, A: Array, state: Array, push: Array, by_ring: Array) -> None:
    """Ball without inertia: both contacts on one line; `by_ring` (5, 2) are the slopes of `push` with A."""
    state[0], state[1], load = static_split(p, A[0], A[1])
    at_wall = A[1] < 0.0
    length = abs(A[0]) if at_wall else math.hypot(A[0], A[1])
    s, c = (A[0] / length, 0.0 if at_wall else A[1] / length) if load > 0.0 else (0.0, 1.0)
    approach = length - (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    slope, side = (1.5 * load / approach, 0.0 if at_wall else load / length) if load > 0.0 else (0.0, 0.0)
    push[:], by_ring[:, :] = 0.0, 0.0
    push[0], push[1] = load * s, load * c
    by_ring[0, 0] = slope * s * s + side * c * c
    by_ring[0, 1] = by_ring[1, 0] = (slope - side) * s * c
    by_ring[1, 1] = slope * c * c + side * s * s


@unfolded
def moving_ball(p: Problem, A: Array, state: Array, method: Method, out: Work, by_ring: Array) -> float:
    """Ball with inertia, solved; returns 0, or how far the smoothing of friction came (inf: nowhere)."""
    if state.shape[0] == CONTROLLED:
        if not solve_controlled(p, A, state, method, out):
            return math.inf
    else:
        reached = solve_free(p, A, state, method, out)
        if reached > SMOOTHING:
            return reached
    return 0.0 if slopes_with_ring(out, by_ring) else math.inf


@unfolded
def ring_balance(
    p: Problem, q: Array, setup: Balls, states: Array, method: Method, balance: Array, slopes: Array
) -> tuple[float, int]:
    """Loads less what the balls carry, shape (5,), and slopes with q, (5, 5).

    Returns 0, or the smoothing reached by the ball that failed, and its number.
    """
    copy(balance, setup.loads)
    slopes[:, :] = 0.0
    A, by_ring, out = np.empty(2), np.zeros((5, 2)), work(states.shape[1])
    total, total_by, weight, arm = np.empty((5, 1)), np.empty((5, 2)), setup.weight, 0.5 * p.pitch_diameter
    for j in range(setup.azimuths.size):
        azimuth = setup.azimuths[j]
        groove_vector(p, q, azimuth, A)
        if states.shape[1] == STATIC:
            static_ball(p, A, states[j], out.push, by_ring)
        else:
            reached = moving_ball(p, A, states[j], method, out, by_ring)
            if reached > 0.0:
                return reached, j
        push_on_ring(p, azimuth, out.push.reshape((5, 1)), total)
        push_on_ring(p, azimuth, by_ring, total_by)
        s, c = math.sin(azimuth), math.cos(azimuth)
        for row in range(5):
            balance[row] -= weight * total[row, 0]
            x, r = weight * total_by[row, 0], weight * total_by[row, 1]
            slopes[row, 0] -= x
            slopes[row, 1] -= r * c
            slopes[row, 2] -= r * s
            slopes[row, 3] -= x * arm * s
            slopes[row, 4] += x * arm * c
    return 0.0, -1


@part
def unbalance(balance: Array, dofs: IntArray, arm: float) -> float:
    """Root of the sum of squares of the unbalanced loads in `dofs`, moments over the arm [N]."""
    total = 0.0
    for d in dofs:
        total += (balance[d] / (arm if d > 2 else 1.0)) ** 2
    return math.sqrt(total)


@part
def _ring_step(
    balance: Array, slopes: Array, dofs: IntArray, arm: float, damping: float, step: Array
) -> bool:
    """Newton step over `dofs`, turns times the arm [m], shape (n, 1); `damping` [N/m] shortens it."""
    n = dofs.size
    matrix = np.empty((n, n))
    for i in range(n):
        unit = arm if dofs[i] > 2 else 1.0
        step[i, 0] = -balance[dofs[i]] / unit
        for k in range(n):
            matrix[i, k] = slopes[dofs[i], dofs[k]] / (unit * (arm if dofs[k] > 2 else 1.0))
        matrix[i, i] -= damping
    return solve_linear(matrix, step)


@part
def _stiffest(slopes: Array, dofs: IntArray, arm: float) -> float:
    worst = 0.0
    for d in dofs:
        worst = max(worst, abs(slopes[d, d]) / (arm * arm if d > 2 else 1.0))
    return worst


@kernel
def solve_ring(
    p: Problem,
    q: Array,
    setup: Balls,
    states: Array,
    method: Method,
    tolerance: float,
    limit: int,
    boldness: float,
    balance: Array,
) -> tuple[float, int, float, int]:
    """Damped Newton (Levenberg) on the ring from `q` and `states`, in place as is `balance`, shape (5,).

    A step may raise the unbalance by the factor `boldness`: along a curved valley that is faster. A `limit`
    of 0 gives the balance where the ring is.

    Returns the unbalance [N], iterations, the smoothing at which a ball failed (0: none) and its number.
    """
    dofs, arm, n = setup.dofs, 0.5 * p.pitch_diameter, setup.dofs.size
    slopes, good_slopes, step, good_balance = (
        np.empty((5, 5)),
        np.empty((5, 5)),
        np.empty((n, 1)),
        np.empty(5),
    )
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    good_q, good_states = q.copy(), states.copy()
    rest, damping, lost, iteration = math.inf, 0.0, 0, 0
    while True:  # one call of `ring_balance`, for each copy of it takes seconds to compile
        failed, ball = ring_balance(p, q, setup, states, method, balance, slopes)
        now = unbalance(balance, dofs, arm) if failed == 0.0 else math.inf
        lost = 0 if now < math.inf else lost + 1
        if now < boldness * rest:
            rest = now
            copy(good_q, q)
            copy(good_balance, balance)
            for j in range(states.shape[0]):
                copy(good_states[j], states[j])
            for row in range(5):
                copy(good_slopes[row], slopes[row])
            damping = 0.1 * damping if damping > 1e-9 else 0.0
        elif iteration == 0:
            return math.inf, 0, failed, ball
        elif damping > 1e4 or lost > 6:
            break
        else:
            damping = max((6.0 if now < math.inf else 100.0) * damping, 1e-5)
        if rest <= tolerance:
            return rest, iteration, 0.0, -1
        solved, floor = False, max(_stiffest(good_slopes, dofs, arm), method.force / span)
        while not solved and iteration < limit and lost <= 6:
            iteration += 1
            solved = _ring_step(good_balance, good_slopes, dofs, arm, (1e-14 + damping) * floor, step)
            if not solved:
                lost, damping = lost + 1, max(100.0 * damping, 1e-5)
        if not solved:
            break
        stride = min(1.0, 0.2 * span / max(np.max(np.abs(step)), 1e-300))
        for i in range(n):
            q[dofs[i]] = good_q[dofs[i]] + stride * step[i, 0] / (arm if dofs[i] > 2 else 1.0)
        for j in range(states.shape[0]):
            copy(states[j], good_states[j])
    copy(q, good_q)
    for j in range(states.shape[0]):
        copy(states[j], good_states[j])
    return rest, limit, failed if rest > 1e3 * tolerance else 0.0, ball


COLUMNS = 21
"""Columns of `ball_table`, in the order that `solve.finished` reads."""


@part
def _grip(t: Touch) -> float:
    """Jones's measure of how strongly a race controls the spin of a ball, Q a E [N m]."""
    K, D, _ = elliptic_integrals(t.axis_ratio)
    E = K - (1.0 - t.axis_ratio) * (1.0 + t.axis_ratio) * D
    return float(t.major_coefficient * t.load ** (4.0 / 3.0) * E)


@part
def _speeds_at(p: Problem, side: float, t: Touch, state: Array) -> tuple[float, float]:
    """Spin/roll ratio [-] and mean rolling speed over the speed difference [m] of one contact."""
    c, n = np.empty(4), np.empty(2)
    slip_coefficients(p, side, t, state, c, n)
    D, ring = p.ball_diameter, 1.0 - state[2] if side < 0.0 else -state[2]
    ball_surface = 0.5 * D * (state[3] * n[1] - state[4] * n[0])
    ring_surface = 0.5 * ring * (p.pitch_diameter + D * n[1])
    return c[0] / c[1], 0.5 * abs(ball_surface + ring_surface)


@part
def _edge(p: Problem, angle: float, t: Touch) -> float:
    """Angle from the bottom of the groove to the far end of the ellipse on the ball; 0 without load."""
    if not t.load > 0.0:
        return 0.0
    half_width = t.major_coefficient * t.load ** (1.0 / 3.0)
    return abs(angle) + math.asin(min(2.0 * half_width / p.ball_diameter, 1.0))


@part
def _place(p: Problem, q: Array, azimuth: float, state: Array, A: Array) -> None:
    """Groove vector of a ball; one that floats at rest is put between the grooves at their first touch."""
    groove_vector(p, q, azimuth, A)
    touching = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    length = math.hypot(A[0], A[1])
    if p.inertia_factor == 0.0 and length < touching:
        for k in range(2):
            A[k] *= touching / length
            state[k] = A[k] * ((p.outer_conformity - 0.5) * p.ball_diameter / touching)


@kernel
def ball_table(p: Problem, q: Array, azimuths: Array, states: Array) -> Array:
    """One row a ball: angles, loads, orbit, spin, pitch, yaw, ratios, rolling speeds, inertia, control.

    Then whether each race is touched, and the edge of each contact: the angle from the bottom of the groove
    to the far end of the ellipse.
    """
    table, A = np.empty((azimuths.size, COLUMNS)), np.empty(2)
    for j in range(azimuths.size):
        row, s = table[j], states[j]
        _place(p, q, azimuths[j], s, A)
        i = touch(p, -1.0, A[0] - s[0], A[1] - s[1], 0.0)
        o = touch(p, 1.0, s[0], s[1], 0.0)
        row[0], row[1] = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
        row[2], row[3] = i.load, o.load
        row[4] = p.outer_speed + p.speed * s[2]
        row[5], row[6], row[7] = p.speed * s[3], p.speed * s[4], p.speed * s[5]
        forward = 1.0 if s[3] >= 0.0 else -1.0
        row[8] = math.atan2(-forward * s[4], math.hypot(s[3], s[5]))
        row[9] = math.atan2(forward * s[5], abs(s[3]))
        row[10], row[12] = _speeds_at(p, -1.0, i, s)
        row[11], row[13] = _speeds_at(p, 1.0, o, s)
        row[12] *= abs(p.speed)
        row[13] *= abs(p.speed)
        row[14], G = inertia_loads(p, s[2], math.hypot(s[4], s[5]))
        row[15] = abs(G)
        row[16] = _grip(o) * math.cos(row[0] - row[1]) - _grip(i)
        row[17], row[18] = 1.0 if i.load > 0.0 else 0.0, 1.0 if o.load > 0.0 else 0.0
        row[19], row[20] = _edge(p, row[0], i), _edge(p, row[1], o)
    return table


@kernel
def controlled_states(p: Problem, q: Array, azimuths: Array, states: Array) -> Array:
    """Complete V, shape (ball, 2 or more), with orbit and spin under race control, shape (ball, 6)."""
    full, A = np.empty((azimuths.size, 6)), np.empty(2)
    for j in range(azimuths.size):
        full[j, 0], full[j, 1] = states[j, 0], states[j, 1]
        _place(p, q, azimuths[j], full[j], A)
        kinematic_start(p, A, full[j])
    return full


@kernel
def settle_free_states(p: Problem, q: Array, azimuths: Array, states: Array, method: Method) -> int:
    """Bring orbit and spin of every ball to the free balance, V held; -1, or the first ball that fails."""
    A = np.empty(2)
    for j in range(azimuths.size):
        _place(p, q, azimuths[j], states[j], A)
        if not solve_kinematics(p, A, states[j], method):
            return j
    return -1
