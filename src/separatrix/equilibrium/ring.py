"""Equilibrium of the inner ring in five degrees of freedom, over balls that are each in balance.

Ring displacement q = (x, y, z) [m] and small turns about y and z [rad]; y lies along the radial load, ball j at
azimuth psi_j from y towards z. Loads are conjugate to q.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from separatrix.equilibrium.ball import solve_controlled, solve_free
from separatrix.equilibrium.groove import static_split
from separatrix.equilibrium.problem import Problem, solve_linear
from separatrix.units import Array

STATIC, CONTROLLED, FREE = 0, 2, 6
"""Number of unknowns of a ball, which names its model."""


@njit(cache=True, nogil=True, error_model="numpy")
def groove_vector(p: Problem, q: Array, azimuth: float, A: Array) -> None:
    """A, from the outer to the inner groove centre in the plane of a ball, shape (2,) [m]."""
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    s, c, arm = math.sin(azimuth), math.cos(azimuth), 0.5 * p.pitch_diameter
    A[0] = span * p.free_sine + q[0] + arm * (q[3] * s - q[4] * c)
    A[1] = span * p.free_cosine + q[1] * c + q[2] * s


@njit(cache=True, nogil=True, error_model="numpy")
def push_on_ring(p: Problem, azimuth: float, push: Array, out: Array) -> None:
    """Turn forces and couples in ball axes into the five loads they make, shape (5, columns)."""
    s, c, arm = math.sin(azimuth), math.cos(azimuth), 0.5 * p.pitch_diameter
    for k in range(push.shape[1]):
        out[0, k] = push[0, k]
        out[1, k] = push[1, k] * c - push[2, k] * s
        out[2, k] = push[1, k] * s + push[2, k] * c
        out[3, k] = arm * push[0, k] * s + push[3, k] * c - push[4, k] * s
        out[4, k] = -arm * push[0, k] * c + push[3, k] * s + push[4, k] * c


@njit(cache=True, nogil=True, error_model="numpy")
def static_ball(p: Problem, A: Array, state: Array, push: Array, by_ring: Array) -> None:
    """Ball without inertia: both contacts on one line; `by_ring` (5, 2) are the slopes of `push` with A."""
    state[0], state[1], load = static_split(p, A[0], A[1])
    length = math.hypot(A[0], A[1])
    s, c = A[0] / length, A[1] / length
    approach = length - (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    slope = 1.5 * load / approach if load > 0.0 else 0.0
    push[:], by_ring[:, :] = 0.0, 0.0
    push[0], push[1] = load * s, load * c
    by_ring[0, 0] = slope * s * s + load / length * c * c
    by_ring[0, 1] = by_ring[1, 0] = (slope - load / length) * s * c
    by_ring[1, 1] = slope * c * c + load / length * s * s


@njit(cache=True, nogil=True, error_model="numpy")
def moving_ball(
    p: Problem,
    A: Array,
    state: Array,
    force: float,
    cells: int,
    nodes: Array,
    coarse_nodes: Array,
    push: Array,
    by_ring: Array,
) -> float:
    """Ball with inertia, solved; returns 0, or how far the smoothing of friction came (inf: nowhere)."""
    n = state.shape[0]
    by_state, push_by = np.zeros((n, n + 2)), np.zeros((5, n + 2))
    if n == CONTROLLED:
        if not solve_controlled(p, A, state, force, nodes, by_state, push, push_by):
            return math.inf
    else:
        reached = solve_free(p, A, state, force, cells, nodes, coarse_nodes, by_state, push, push_by)
        if reached > 1e-4:
            return reached
    answer = by_state[:, n:].copy()
    if not solve_linear(by_state[:, :n].copy(), answer):
        return math.inf
    for row in range(5):
        for k in range(2):
            total = push_by[row, n + k]
            for j in range(n):
                total -= push_by[row, j] * answer[j, k]
            by_ring[row, k] = total
    return 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def ring_balance(
    p: Problem,
    q: Array,
    loads: Array,
    azimuths: Array,
    weight: float,
    states: Array,
    force: float,
    cells: int,
    nodes: Array,
    coarse_nodes: Array,
    balance: Array,
    slopes: Array,
) -> tuple[float, int]:
    """Loads less what the balls carry, shape (5,), and slopes with q, (5, 5); each ball stands for `weight`.

    Returns 0, or the smoothing reached by the ball that failed, and its number.
    """
    balance[:] = loads
    slopes[:, :] = 0.0
    A, push, by_ring = np.empty(2), np.zeros((5, 1)), np.zeros((5, 2))
    total, total_by = np.empty((5, 1)), np.empty((5, 2))
    for j in range(azimuths.size):
        groove_vector(p, q, azimuths[j], A)
        if states.shape[1] == STATIC + 3:
            static_ball(p, A, states[j], push[:, 0], by_ring)
        else:
            reached = moving_ball(p, A, states[j], force, cells, nodes, coarse_nodes, push[:, 0], by_ring)
            if reached > 0.0:
                return reached, j
        push_on_ring(p, azimuths[j], push, total)
        push_on_ring(p, azimuths[j], by_ring, total_by)
        s, c, arm = math.sin(azimuths[j]), math.cos(azimuths[j]), 0.5 * p.pitch_diameter
        for row in range(5):
            balance[row] -= weight * total[row, 0]
            x, r = weight * total_by[row, 0], weight * total_by[row, 1]
            slopes[row, 0] -= x
            slopes[row, 1] -= r * c
            slopes[row, 2] -= r * s
            slopes[row, 3] -= x * arm * s
            slopes[row, 4] += x * arm * c
    return 0.0, -1


@njit(cache=True, nogil=True, error_model="numpy")
def unbalance(balance: Array, dofs: Array, arm: float) -> float:
    """Largest unbalanced load over the degrees of freedom `dofs`, moments over the arm [N]."""
    worst = 0.0
    for d in dofs:
        worst = max(worst, abs(balance[d]) / (arm if d > 2 else 1.0))
    return worst


@njit(cache=True, nogil=True, error_model="numpy")
def solve_ring(
    p: Problem,
    q: Array,
    loads: Array,
    dofs: Array,
    azimuths: Array,
    weight: float,
    states: Array,
    force: float,
    cells: int,
    nodes: Array,
    coarse_nodes: Array,
    tolerance: float,
    limit: int,
) -> tuple[float, int, float, int]:
    """Newton with step halving on the ring from `q`, in place, over the degrees of freedom `dofs`.

    Returns the unbalance [N], iterations, the smoothing at which a ball failed (0: none) and its number.
    """
    arm, n = 0.5 * p.pitch_diameter, dofs.size
    balance, slopes = np.empty(5), np.empty((5, 5))
    matrix, step = np.empty((n, n)), np.empty((n, 1))
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    failed, ball = ring_balance(
        p, q, loads, azimuths, weight, states, force, cells, nodes, coarse_nodes, balance, slopes
    )
    if failed > 0.0:
        return math.inf, 0, failed, ball
    rest = unbalance(balance, dofs, arm)
    good_q, good_states = q.copy(), states.copy()
    damping = 0.0
    for iteration in range(limit):
        if rest <= tolerance:
            return rest, iteration, 0.0, -1
        stiffest = 0.0
        for i in range(n):
            unit = arm if dofs[i] > 2 else 1.0
            step[i, 0] = -balance[dofs[i]] / unit
            for k in range(n):
                matrix[i, k] = slopes[dofs[i], dofs[k]] / (unit * (arm if dofs[k] > 2 else 1.0))
            stiffest = max(stiffest, abs(matrix[i, i]))
        floor = max(stiffest, force / span)
        for i in range(n):
            matrix[i, i] -= (1e-14 + damping) * floor
        if not solve_linear(matrix, step):
            return rest, iteration, 0.0, -1
        size = np.max(np.abs(step))
        stride = min(1.0, 0.2 * span / max(size, 1e-300))
        moved = False
        for _ in range(10):
            for i in range(n):
                q[dofs[i]] = good_q[dofs[i]] + stride * step[i, 0] / (arm if dofs[i] > 2 else 1.0)
            states[:] = good_states
            failed, ball = ring_balance(
                p, q, loads, azimuths, weight, states, force, cells, nodes, coarse_nodes, balance, slopes
            )
            now = unbalance(balance, dofs, arm) if failed == 0.0 else math.inf
            if now <= (1.0 - 0.05 * stride) * rest:
                moved = True
                break
            stride *= 0.4
        if moved:
            rest = now
            good_q[:], good_states[:] = q, states
            damping *= 0.1
            if damping < 1e-9:
                damping = 0.0
            continue
        q[:], states[:] = good_q, good_states
        ring_balance(p, q, loads, azimuths, weight, states, force, cells, nodes, coarse_nodes, balance, slopes)
        if damping > 1e3:
            return rest, iteration, failed, ball
        damping = max(10.0 * damping, 1e-6)
    return rest, limit, 0.0, -1
