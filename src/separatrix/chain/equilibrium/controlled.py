"""A ball under race control, solved from wherever it starts."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.ball import TOLERANCE, newton_ball
from separatrix.chain.equilibrium.groove import static_split, touch
from separatrix.chain.equilibrium.problem import Method, Problem, Work
from separatrix.chain.equilibrium.race_control import (
    controlled_kinematics,
    inertia_pull,
    inner_share,
    normal_slopes,
)
from separatrix.compiled import kernel
from separatrix.units import Array

ROUNDS = 12
"""Times that a resting ball is given the inertia of its new angles; each takes a tenth of the change."""


@kernel
def _normal_pull(p: Problem, A: Array, state: Array, pull: Array, g: Array, H: Array) -> float:
    """Loads of both grooves less the pull, shape (2,), and their slopes, (2, 2); returns the sum of loads."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    other = np.empty((2, 2))
    normal_slopes(o, H)
    normal_slopes(i, other)
    H += other
    g[0] = o.load * o.sine - i.load * i.sine - pull[0]
    g[1] = o.load * o.cosine - i.load * i.cosine - pull[1]
    return float(i.load + o.load)


@kernel
def rest(p: Problem, A: Array, pull: Array, state: Array) -> None:
    """Move the ball to where the grooves hold it against a constant pull.

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
        state[:2] = trial
        g[:], H[:, :] = there, slopes


@kernel
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


@kernel
def solve_controlled(p: Problem, A: Array, state: Array, method: Method, out: Work) -> bool:
    """Ball under race control: from `state`, then from where it rests."""
    if newton_ball(p, A, state, 0.0, True, method, out, 15, TOLERANCE) <= TOLERANCE:
        return True
    controlled_start(p, A, state)
    return bool(newton_ball(p, A, state, 0.0, True, method, out, 40, TOLERANCE) <= TOLERANCE)


@kernel
def kinematic_start(p: Problem, A: Array, state: Array) -> None:
    """Give a free ball the orbit and spin of race control at its place."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    angle_i, angle_o = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    share, _ = inner_share(p, i.load)
    state[2], state[3], state[4] = controlled_kinematics(p, angle_i, angle_o, share)
    state[5] = 0.0
