"""A ball without race control: the smoothing of Coulomb's corner, lowered till it no longer matters."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.ball import (
    TOLERANCE,
    evaluate,
    newton_ball,
    newton_step,
    row_scales,
    scaled_norm,
)
from separatrix.chain.equilibrium.controlled import kinematic_start
from separatrix.chain.equilibrium.problem import Method, Problem, Work, solve_linear, work
from separatrix.compiled import kernel
from separatrix.units import Array

SMOOTHING = 1e-4
"""Slip speed that rounds the corner of Coulomb's law, over the speed difference times d_m/4."""


@kernel
def lower_smoothing(
    p: Problem, A: Array, state: Array, start: float, fine: bool, method: Method, out: Work
) -> float:
    """Follow the ball from `start` down to `SMOOTHING` in adaptive ratios; returns the smoothing reached."""
    good, ratio, unit = state.copy(), 0.25, 0.25 * p.pitch_diameter
    smoothing, reached = start, math.inf
    while True:
        if newton_ball(p, A, state, smoothing * unit, fine, method, out, 25, 1e-7) <= 1e-7:
            reached = smoothing
            good[:] = state
            ratio = max(ratio * ratio, 0.1)
        else:
            state[:] = good
            ratio = math.sqrt(ratio)
        if reached <= SMOOTHING or reached == math.inf or ratio > 0.98:
            return reached
        smoothing = max(reached * ratio, SMOOTHING)


@kernel
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
            state[:2] = place
            kinematic_start(p, A, state)
            start = 0.03 if attempt < 2 else 3.0
            reached = lower_smoothing(p, A, state, start, attempt % 2 == 1, method, out)
        if reached <= SMOOTHING:
            limit = 8 if attempt < 0 else 30
            if newton_ball(p, A, state, aim, True, method, out, limit, TOLERANCE) <= TOLERANCE:
                return SMOOTHING
            reached = 2.0 * SMOOTHING
        if attempt >= 0:
            best = min(best, reached)
    return best


@kernel
def _turn_until_balanced(p: Problem, A: Array, state: Array, smoothing: float, method: Method) -> float:
    """Newton on orbit and spin at a held V; returns the unbalance in units of the friction."""
    out, residual, scales, trial = work(6), np.empty(6), np.empty(6), state.copy()
    step, norm, stride = np.zeros((4, 1)), math.inf, 1.0
    row_scales(p, A, state, 0.0, scales)
    for _ in range(200):
        evaluate(p, A, trial, smoothing, True, method, residual, out)
        now = scaled_norm(residual[2:], scales[2:])
        if now <= (1.0 - 0.1 * stride) * norm:
            state[:], norm, stride = trial, now, 1.0
            if norm <= TOLERANCE or not newton_step(out.by_state[2:, 2:6], residual[2:], scales[2:], step):
                break
        else:
            stride *= 0.5
            if stride < 2e-3:
                break
        trial[2:] = state[2:] + stride * step[:, 0]
    return norm


@kernel
def solve_kinematics(p: Problem, A: Array, state: Array, method: Method) -> bool:
    """Orbit and spin without race control at a held V: the limit of slow turning, where no inertia acts."""
    smoothing = 0.3
    while True:
        if _turn_until_balanced(p, A, state, smoothing * 0.25 * p.pitch_diameter, method) > 1e-7:
            return False
        if smoothing == SMOOTHING:
            return True
        smoothing = max(0.3 * smoothing, SMOOTHING)


@kernel
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
