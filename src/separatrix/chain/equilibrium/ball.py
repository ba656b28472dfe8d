"""Newton's method for one ball at a given place of the inner ring, with either kinematic model."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.free import free_ball, turning_loads
from separatrix.chain.equilibrium.groove import touch
from separatrix.chain.equilibrium.problem import Method, Problem, Work, solve_linear
from separatrix.chain.equilibrium.race_control import controlled_ball
from separatrix.compiled import kernel
from separatrix.units import Array

TOLERANCE = 1e-11
"""Largest unbalanced force of a ball over the force scale of the bearing; rounding allows about 1e-14."""


@kernel
def evaluate(
    p: Problem,
    A: Array,
    state: Array,
    smoothing: float,
    fine: bool,
    method: Method,
    residual: Array,
    out: Work,
) -> None:
    """Balance of one ball by the model that the length of its state implies: 2 race control, 6 free."""
    if state.shape[0] == 2:
        controlled_ball(p, A, state, residual, out)
        return
    cells, nodes = (method.cells, method.nodes) if fine else (method.coarse_cells, method.coarse_nodes)
    free_ball(p, A, state, smoothing, cells, nodes, residual, out)


@kernel
def row_scales(p: Problem, A: Array, state: Array, force: float, scales: Array) -> None:
    """What counts as one unit in each row of the balance: loads in the plane, friction across it."""
    scales[:2] = force
    if state.shape[0] == 6:
        i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
        o = touch(p, 1.0, state[0], state[1], 0.0)
        grip = 100.0 * p.friction * max(turning_loads(p, i, o)[1], 1e-9 * force)  # rounding is coarser here
        scales[2] = grip
        scales[3:] = 0.5 * p.ball_diameter * grip


@kernel
def newton_step(by_state: Array, residual: Array, scales: Array, step: Array) -> bool:
    """Newton step of the scaled balance, shape (n, 1); False if the slopes are singular."""
    n = residual.size
    matrix = np.empty((n, n))
    for row in range(n):
        step[row, 0] = -residual[row] / scales[row]
        for k in range(n):
            matrix[row, k] = by_state[row, k] / scales[row]
    return solve_linear(matrix, step)


@kernel
def scaled_norm(residual: Array, scales: Array) -> float:
    """Root of the sum of squares of the scaled balance."""
    total = 0.0
    for row in range(residual.size):
        total += (residual[row] / scales[row]) ** 2
    return math.sqrt(total)


@kernel
def newton_ball(
    p: Problem,
    A: Array,
    state: Array,
    smoothing: float,
    fine: bool,
    method: Method,
    out: Work,
    limit: int,
    tolerance: float,
) -> float:
    """Newton with step halving from `state`; returns the scaled unbalance reached (good if <= tolerance)."""
    n = state.shape[0]
    residual, scales, step, trial = np.empty(n), np.empty(n), np.zeros((n, 1)), state.copy()
    reach = 0.3 * (min(p.inner_conformity, p.outer_conformity) - 0.5) * p.ball_diameter
    norm, stride, steps = math.inf, 1.0, 0
    row_scales(p, A, state, method.force, scales)
    while True:  # one call of `evaluate`, for each copy of it takes seconds to compile
        evaluate(p, A, trial, smoothing, fine, method, residual, out)
        if scaled_norm(residual, scales) <= (1.0 - 0.1 * stride) * norm or steps == 0:
            state[:] = trial
            row_scales(p, A, state, method.force, scales)
            norm = scaled_norm(residual, scales)
            if norm <= tolerance or steps == limit or not newton_step(out.by_state, residual, scales, step):
                break
            steps += 1
            stride = min(1.0, reach / max(math.hypot(step[0, 0], step[1, 0]), 1e-300))
        else:
            stride *= 0.5
            if stride < 2e-4:
                break
        for row in range(n):
            trial[row] = state[row] + stride * step[row, 0]
    return min(norm, tolerance) if norm <= 100.0 * tolerance else norm  # rounding: as good as it gets
