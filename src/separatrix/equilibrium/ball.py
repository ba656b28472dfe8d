"""Newton's method for one ball at a given place of the inner ring, with either kinematic model."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from separatrix.equilibrium.free import free_ball, turning_loads
from separatrix.equilibrium.groove import static_split, touch
from separatrix.equilibrium.problem import Problem, solve_linear
from separatrix.equilibrium.race_control import controlled_ball, controlled_kinematics, rest_on_outer
from separatrix.units import Array

TOLERANCE = 1e-10
"""Largest unbalanced force of a ball over the force scale of the bearing; rounding allows about 1e-13."""


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate(
    p: Problem,
    A: Array,
    state: Array,
    smoothing: float,
    cells: int,
    nodes: Array,
    residual: Array,
    by_state: Array,
    push: Array,
    push_by: Array,
) -> None:
    """Balance of one ball by the model that the length of its state implies: 2 race control, 6 free."""
    if state.shape[0] == 2:
        controlled_ball(p, A, state, residual, by_state, push, push_by)
    else:
        free_ball(p, A, state, smoothing, cells, nodes, residual, by_state, push, push_by)


@njit(cache=True, nogil=True, error_model="numpy")
def row_scales(p: Problem, A: Array, state: Array, force: float, scales: Array) -> None:
    """What counts as one unit in each row of the balance: loads in the plane, friction across it."""
    scales[:2] = force
    if state.shape[0] == 6:
        i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
        o = touch(p, 1.0, state[0], state[1], 0.0)
        grip = p.friction * max(turning_loads(p, i, o)[1], 1e-9 * force)
        scales[2] = grip
        scales[3:] = 0.5 * p.ball_diameter * grip


@njit(cache=True, nogil=True, error_model="numpy")
def newton_ball(
    p: Problem,
    A: Array,
    state: Array,
    force: float,
    smoothing: float,
    cells: int,
    nodes: Array,
    by_state: Array,
    push: Array,
    push_by: Array,
    limit: int,
    tolerance: float,
) -> float:
    """Newton with step halving from `state`; returns the scaled unbalance reached (good if <= tolerance)."""
    n = state.shape[0]
    residual, scales = np.empty(n), np.empty(n)
    matrix, step, trial = np.empty((n, n)), np.empty((n, 1)), np.empty(n)
    reach = 0.3 * (min(p.inner_conformity, p.outer_conformity) - 0.5) * p.ball_diameter
    evaluate(p, A, state, smoothing, cells, nodes, residual, by_state, push, push_by)
    row_scales(p, A, state, force, scales)
    norm = math.sqrt(np.sum((residual / scales) ** 2))
    for _ in range(limit):
        if not norm > tolerance:
            break
        for row in range(n):
            step[row, 0] = -residual[row] / scales[row]
            for k in range(n):
                matrix[row, k] = by_state[row, k] / scales[row]
        if not solve_linear(matrix, step):
            return norm
        stride = min(1.0, reach / max(math.hypot(step[0, 0], step[1, 0]), 1e-300))
        before = norm
        for _ in range(12):
            for row in range(n):
                trial[row] = state[row] + stride * step[row, 0]
            evaluate(p, A, trial, smoothing, cells, nodes, residual, by_state, push, push_by)
            norm = math.sqrt(np.sum((residual / scales) ** 2))
            if norm <= (1.0 - 0.1 * stride) * before:
                break
            stride *= 0.5
        if not norm < before:
            if before <= 100.0 * tolerance:  # rounding: as good as it gets
                return tolerance
            evaluate(p, A, state, smoothing, cells, nodes, residual, by_state, push, push_by)
            return before
        state[:] = trial
        if n == 6:
            row_scales(p, A, state, force, scales)
            norm = math.sqrt(np.sum((residual / scales) ** 2))
    return norm


@njit(cache=True, nogil=True, error_model="numpy")
def controlled_start(p: Problem, A: Array, state: Array) -> None:
    """First guess of V: at the bottom of the outer groove if the ball misses the inner race, else on the line."""
    if p.inertia_factor > 0.0 and rest_on_outer(p, A, state):
        return
    state[0], state[1], _ = static_split(p, A[0], A[1])


@njit(cache=True, nogil=True, error_model="numpy")
def solve_controlled(
    p: Problem, A: Array, state: Array, force: float, nodes: Array, by_state: Array, push: Array, push_by: Array
) -> bool:
    """Ball under race control: warm, from the start above, then by raising the inertia in steps."""
    if newton_ball(p, A, state, force, 0.0, 0, nodes, by_state, push, push_by, 30, TOLERANCE) <= TOLERANCE:
        return True
    controlled_start(p, A, state)
    if newton_ball(p, A, state, force, 0.0, 0, nodes, by_state, push, push_by, 60, TOLERANCE) <= TOLERANCE:
        return True
    factor, step, good = 0.0, 0.1, np.empty(2)
    good[0], good[1], _ = static_split(p, A[0], A[1])
    while factor < 1.0 and step > 1e-4:
        state[:] = good
        trial = min(factor + step, 1.0)
        q = scaled_inertia(p, trial * p.inertia_factor)
        if newton_ball(q, A, state, force, 0.0, 0, nodes, by_state, push, push_by, 40, TOLERANCE) <= TOLERANCE:
            factor, good[:] = trial, state
            step *= 1.5
        else:
            step *= 0.5
    return factor >= 1.0


@njit(cache=True, nogil=True, error_model="numpy")
def scaled_inertia(p: Problem, factor: float) -> Problem:
    """Give the same problem with another inertia factor."""
    return Problem(
        p.ball_diameter,
        p.pitch_diameter,
        p.inner_conformity,
        p.outer_conformity,
        p.free_sine,
        p.free_cosine,
        p.modulus,
        p.ball_mass,
        p.ball_inertia,
        p.outer_speed,
        p.speed,
        p.inner_share,
        p.friction,
        factor,
    )


@njit(cache=True, nogil=True, error_model="numpy")
def kinematic_start(p: Problem, A: Array, state: Array) -> None:
    """Give a free ball the orbit and spin of outer race control at its place."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    angles = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    state[2], state[3], state[4] = controlled_kinematics(p, angles[0], angles[1])
    state[5] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def lower_smoothing(
    p: Problem,
    A: Array,
    state: Array,
    force: float,
    start: float,
    end: float,
    cells: int,
    nodes: Array,
    by_state: Array,
    push: Array,
    push_by: Array,
) -> float:
    """Follow the ball from `start` down to `end`, in adaptive ratios; returns the smoothing reached."""
    good, ratio = state.copy(), 0.25
    smoothing, reached = start, math.inf
    while True:
        rest = newton_ball(p, A, state, force, smoothing, cells, nodes, by_state, push, push_by, 25, 1e-7)
        if rest <= 1e-7:
            reached = smoothing
            good[:] = state
            if smoothing <= end:
                return reached
            ratio = max(ratio * ratio, 0.1)
        else:
            state[:] = good
            ratio = math.sqrt(ratio)
            if reached == math.inf or ratio > 0.98:
                return reached
        smoothing = max(reached * ratio, end)


@njit(cache=True, nogil=True, error_model="numpy")
def solve_free(
    p: Problem,
    A: Array,
    state: Array,
    force: float,
    cells: int,
    nodes: Array,
    coarse_nodes: Array,
    by_state: Array,
    push: Array,
    push_by: Array,
) -> float:
    """Ball without race control; returns the smoothing reached in units of d_m/4 (1e-4 is the aim)."""
    unit, aim = 0.25 * p.pitch_diameter, 1e-4
    if newton_ball(p, A, state, force, aim * unit, cells, nodes, by_state, push, push_by, 8, TOLERANCE) <= TOLERANCE:
        return aim
    best = math.inf
    fallback = state.copy()
    for start in (0.03, 3.0):
        state[:] = fallback
        kinematic_start(p, A, state)
        coarse = lower_smoothing(
            p, A, state, force, start * unit, aim * unit, cells // 3, coarse_nodes, by_state, push, push_by
        )
        if coarse <= aim * unit:
            rest = newton_ball(p, A, state, force, aim * unit, cells, nodes, by_state, push, push_by, 30, TOLERANCE)
            if rest <= TOLERANCE:
                return aim
        state[:] = fallback
        kinematic_start(p, A, state)
        fine = lower_smoothing(p, A, state, force, start * unit, aim * unit, cells, nodes, by_state, push, push_by)
        if fine <= aim * unit:
            rest = newton_ball(p, A, state, force, aim * unit, cells, nodes, by_state, push, push_by, 30, TOLERANCE)
            if rest <= TOLERANCE:
                return aim
        best = min(best, fine / unit)
    return best


@njit(cache=True, nogil=True, error_model="numpy")
def solve_kinematics(p: Problem, A: Array, state: Array, cells: int, nodes: Array) -> bool:
    """Orbit and spin without race control at a held V: the limit of slow turning, where no inertia acts."""
    by_state, push, push_by = np.empty((6, 8)), np.empty(5), np.empty((5, 8))
    residual, scales, trial = np.empty(6), np.empty(6), np.empty(6)
    matrix, step = np.empty((4, 4)), np.empty((4, 1))
    smoothing, unit = 0.3, 0.25 * p.pitch_diameter
    trial[:] = state
    while smoothing >= 1e-4:
        norm = math.inf
        for _ in range(100):
            evaluate(p, A, state, smoothing * unit, cells, nodes, residual, by_state, push, push_by)
            row_scales(p, A, state, 0.0, scales)
            norm = math.sqrt(np.sum((residual[2:] / scales[2:]) ** 2))
            if norm <= TOLERANCE:
                break
            for row in range(4):
                step[row, 0] = -residual[2 + row] / scales[2 + row]
                for k in range(4):
                    matrix[row, k] = by_state[2 + row, 2 + k] / scales[2 + row]
            if not solve_linear(matrix, step):
                return False
            stride = 1.0
            for _ in range(8):
                for k in range(4):
                    trial[2 + k] = state[2 + k] + stride * step[k, 0]
                evaluate(p, A, trial, smoothing * unit, cells, nodes, residual, by_state, push, push_by)
                if math.sqrt(np.sum((residual[2:] / scales[2:]) ** 2)) < (1.0 - 0.1 * stride) * norm:
                    break
                stride *= 0.5
            state[:] = trial
        if norm > 1e-7:
            return False
        if smoothing == 1e-4:
            return True
        smoothing = max(0.3 * smoothing, 1e-4)
    return True
