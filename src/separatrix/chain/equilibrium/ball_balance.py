"""One ball at a given place of the inner ring, solved by Newton's method with either kinematic model.

Under race control from wherever it starts; without it the smoothing of Coulomb's corner is lowered until it
no longer matters.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.balance import (
    controlled_ball,
    controlled_kinematics,
    free_ball,
    inertia_pull,
    inner_share,
    normal_slopes,
    turning_loads,
)
from separatrix.chain.equilibrium.groove import static_split, touch
from separatrix.chain.equilibrium.problem import Method, Problem, Work, copy, solve_linear, work
from separatrix.ground.compiled import part, unfolded
from separatrix.ground.units import Array

TOLERANCE = 1e-11
"""Largest unbalanced force of a ball over the force scale of the bearing; rounding allows about 1e-14."""


@unfolded
def evaluate(
    p: Problem, A: Array, state: Array, smoothing: float, method: Method, residual: Array, out: Work
) -> None:
    """Balance of one ball by the model that the length of its state implies: 2 race control, 6 free."""
    if state.shape[0] == 2:
        controlled_ball(p, A, state, residual, out)
        return
    free_ball(p, A, state, (smoothing, smoothing), method.cells, method.nodes, residual, out)


@part
def row_scales(p: Problem, A: Array, state: Array, force: float, scales: Array) -> None:
    """What counts as one unit in each row of the balance: loads in the plane, friction across it."""
    scales[:2] = force
    if state.shape[0] == 6:
        i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
        o = touch(p, 1.0, state[0], state[1], 0.0)
        grip = 100.0 * p.friction * max(turning_loads(p, i, o)[1], 1e-9 * force)  # rounding is coarser here
        scales[2] = grip
        scales[3:] = 0.5 * p.ball_diameter * grip


@part
def newton_step(by_state: Array, residual: Array, scales: Array, step: Array) -> bool:
    """Newton step of the scaled balance, shape (n, 1); False if the slopes are singular."""
    n = residual.size
    matrix = np.empty((n, n))
    for row in range(n):
        step[row, 0] = -residual[row] / scales[row]
        for k in range(n):
            matrix[row, k] = by_state[row, k] / scales[row]
    return solve_linear(matrix, step)


@part
def scaled_norm(residual: Array, scales: Array) -> float:
    """Root of the sum of squares of the scaled balance."""
    total = 0.0
    for row in range(residual.size):
        total += (residual[row] / scales[row]) ** 2
    return math.sqrt(total)


@part
def newton_ball(
    p: Problem,
    A: Array,
    state: Array,
    smoothing: float,
    method: Method,
    out: Work,
    limit: float,
    tolerance: float,
) -> float:
    """Newton with step halving from `state`; returns the scaled unbalance reached (good if <= tolerance).

    `limit` is a number of steps, as a float: for every whole number or truth value that is written in a call
    numba compiles a copy, which takes seconds.
    """
    n = state.shape[0]
    residual, scales, step, trial = np.empty(n), np.empty(n), np.zeros((n, 1)), state.copy()
    reach = 0.3 * (min(p.inner_conformity, p.outer_conformity) - 0.5) * p.ball_diameter
    norm, stride, steps = math.inf, 1.0, 0
    row_scales(p, A, state, method.force, scales)
    while True:  # one call of `evaluate`, for each copy of it takes seconds to compile
        evaluate(p, A, trial, smoothing, method, residual, out)
        if scaled_norm(residual, scales) <= (1.0 - 0.1 * stride) * norm or steps == 0:
            copy(state, trial)
            row_scales(p, A, state, method.force, scales)
            norm = scaled_norm(residual, scales)
            if norm <= tolerance or steps >= limit or not newton_step(out.by_state, residual, scales, step):
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


ROUNDS = 12
"""Times that a resting ball is given the inertia of its new angles; each takes a tenth of the change."""


@part
def _normal_pull(p: Problem, A: Array, state: Array, pull: Array, g: Array, H: Array) -> float:
    """Loads of both grooves less the pull, shape (2,), and their slopes, (2, 2); returns the sum of loads."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    other = np.empty((2, 2))
    normal_slopes(o, H)
    normal_slopes(i, other)
    for k in range(2):
        H[k, 0] += other[k, 0]
        H[k, 1] += other[k, 1]
    g[0] = o.load * o.sine - i.load * i.sine - pull[0]
    g[1] = o.load * o.cosine - i.load * i.cosine - pull[1]
    return float(i.load + o.load)


@part
def rest(p: Problem, A: Array, pull: Array, state: Array) -> None:
    """Move the ball to where the grooves balance a constant pull.

    Both grooves are convex, so the energy is, and Newton's steps find its only low point from anywhere if
    none of them climbs beyond it.
    """
    g, H, trial, there, slopes = np.empty(2), np.empty((2, 2)), np.empty(2), np.empty(2), np.empty((2, 2))
    loads = _normal_pull(p, A, state, pull, g, H)
    for _ in range(200):
        if math.hypot(g[0], g[1]) <= 1e-9 * (loads + math.hypot(pull[0], pull[1])):
            return
        det = H[0, 0] * H[1, 1] - H[0, 1] * H[1, 0]
        if not det > 0.0:
            return
        x, r = (H[0, 1] * g[1] - H[1, 1] * g[0]) / det, (H[1, 0] * g[0] - H[0, 0] * g[1]) / det
        fall, stride = x * g[0] + r * g[1], 1.0
        for _ in range(60):
            trial[0], trial[1] = state[0] + stride * x, state[1] + stride * r
            loads = _normal_pull(p, A, trial, pull, there, slopes)
            if loads > 0.0 and x * there[0] + r * there[1] <= -0.5 * fall:
                break
            stride *= 0.5
        copy(state[:2], trial)
        copy(g, there)
        for k in range(2):
            copy(H[k], slopes[k])


@part
def controlled_start(p: Problem, A: Array, state: Array) -> None:
    """Put the ball where it rests under its own inertia, from its static line or from the outer groove."""
    static_x, static_r, load = static_split(p, A[0], A[1])
    pull = np.zeros(2)
    if load > 0.0:
        state[0], state[1] = static_x, static_r
    else:
        trial = 1e-3 * p.ball_diameter
        state[0], state[1] = 0.0, (p.outer_conformity - 0.5) * p.ball_diameter
        inertia_pull(p, A, state, pull)
        state[1] += trial * (pull[1] / touch(p, 1.0, 0.0, state[1] + trial, 0.0).load) ** (2.0 / 3.0)
    for _ in range(ROUNDS):
        inertia_pull(p, A, state, pull)
        rest(p, A, pull, state)


@unfolded
def solve_controlled(p: Problem, A: Array, state: Array, method: Method, out: Work) -> bool:
    """Ball under race control: from `state`, then from where it rests."""
    if newton_ball(p, A, state, 0.0, method, out, 15.0, TOLERANCE) <= TOLERANCE:
        return True
    controlled_start(p, A, state)
    return bool(newton_ball(p, A, state, 0.0, method, out, 40.0, TOLERANCE) <= TOLERANCE)


@part
def kinematic_start(p: Problem, A: Array, state: Array) -> None:
    """Give a free ball the orbit and spin of race control at its place."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    angle_i, angle_o = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    share, _ = inner_share(p, i.load)
    state[2], state[3], state[4] = controlled_kinematics(p, angle_i, angle_o, share)
    state[5] = 0.0


SMOOTHING = 1e-4
"""Slip speed that rounds the corner of Coulomb's law, over the speed difference times d_m/4."""


@unfolded
def lower_smoothing(p: Problem, A: Array, state: Array, start: float, method: Method, out: Work) -> float:
    """Follow the ball from `start` down to `SMOOTHING` in adaptive ratios; returns the smoothing reached."""
    good, ratio, unit = state.copy(), 0.25, 0.25 * p.pitch_diameter
    smoothing, reached = start, math.inf
    while True:
        if newton_ball(p, A, state, smoothing * unit, method, out, 25.0, 1e-7) <= 1e-7:
            reached = smoothing
            copy(good, state)
            ratio = max(ratio * ratio, 0.1)
        else:
            copy(state, good)
            ratio = math.sqrt(ratio)
        if reached <= SMOOTHING or reached == math.inf or ratio > 0.98:
            return reached
        smoothing = max(reached * ratio, SMOOTHING)


@part
def coarse(method: Method) -> Method:
    """The same with the coarse quadrature."""
    cells, nodes = method.coarse_cells, method.coarse_nodes
    return Method(method.force, cells, nodes, cells, nodes)


@unfolded
def solve_free(p: Problem, A: Array, state: Array, method: Method, out: Work) -> float:
    """Ball without race control; returns the smoothing reached, `SMOOTHING` if all went well.

    From `state` at once; else from the kinematics of race control down from a little, then from much
    smoothing, first with the coarse quadrature and then with the fine one.
    """
    aim = SMOOTHING * 0.25 * p.pitch_diameter
    place, best = state[:2].copy(), math.inf
    for attempt in range(-1, 4):
        reached = SMOOTHING
        if attempt >= 0:
            copy(state[:2], place)
            kinematic_start(p, A, state)
            start = 0.03 if attempt < 2 else 3.0
            reached = lower_smoothing(p, A, state, start, method if attempt % 2 == 1 else coarse(method), out)
        if reached <= SMOOTHING:
            limit = 8.0 if attempt < 0 else 30.0
            if newton_ball(p, A, state, aim, method, out, limit, TOLERANCE) <= TOLERANCE:
                return SMOOTHING
            reached = 2.0 * SMOOTHING
        if attempt >= 0:
            best = min(best, reached)
    return best


@part
def _turn_until_balanced(p: Problem, A: Array, state: Array, smoothing: float, method: Method) -> float:
    """Newton on orbit and spin at a held V; returns the unbalance in units of the friction."""
    out, residual, scales, trial = work(6), np.empty(6), np.empty(6), state.copy()
    step, norm, stride = np.zeros((4, 1)), math.inf, 1.0
    row_scales(p, A, state, 0.0, scales)
    for _ in range(200):
        evaluate(p, A, trial, smoothing, method, residual, out)
        now = scaled_norm(residual[2:], scales[2:])
        if now <= (1.0 - 0.1 * stride) * norm:
            copy(state, trial)
            norm, stride = now, 1.0
            if norm <= TOLERANCE or not newton_step(out.by_state[2:, 2:6], residual[2:], scales[2:], step):
                break
        else:
            stride *= 0.5
            if stride < 2e-3:
                break
        for k in range(4):
            trial[2 + k] = state[2 + k] + stride * step[k, 0]
    return norm


@part
def solve_kinematics(p: Problem, A: Array, state: Array, method: Method) -> bool:
    """Orbit and spin without race control at a held V: the limit of slow turning, where no inertia acts."""
    smoothing = 0.3
    while True:
        if _turn_until_balanced(p, A, state, smoothing * 0.25 * p.pitch_diameter, method) > 1e-7:
            return False
        if smoothing == SMOOTHING:
            return True
        smoothing = max(0.3 * smoothing, SMOOTHING)


@part
def slopes_with_ring(out: Work, by_ring: Array) -> bool:
    """Slopes of what the ball gives with A, shape (5, 2), the ball kept in balance; False if singular."""
    n = out.by_state.shape[0]
    answer = out.by_state[:, n:].copy()
    if not solve_linear(out.by_state[:, :n].copy(), answer):
        return False
    for row in range(5):
        for k in range(2):
            total = out.push_by[row, n + k]
            for j in range(n):
                total -= out.push_by[row, j] * answer[j, k]
            by_ring[row, k] = total
    return True
