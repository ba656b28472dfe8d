"""A ball that is pushed along its orbit for long: F(u), quasi-steady, from the whole slip fields.

All modes of the ball but the slowest have relaxed: the slowest, the attitude of its spin axis, is where it
was. Its coordinate is held at zero, and only along its pattern may the spin still change.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from separatrix.chain.mobility.field import HeldBall, balanced
from separatrix.chain.mobility.modes import Modes
from separatrix.errors import ConvergenceError
from separatrix.units import Array


class Curve(NamedTuple):
    """Speeds of a curve: first and last over capacity/C_f, the most over the rolling speed, and how many."""

    first: float
    last: float
    most: float
    points: int


CURVE = Curve(first=0.02, last=6.0, most=0.25, points=25)

CLOSED = 1e-8
"""Unbalance over the capacity of a point of the curve."""

DEEPEST = 8
"""Halvings of the way from one point to the next."""


def pushed(ball: HeldBall, found: Modes, speeds: Array, *, is_held: bool = True) -> Array:
    """F(u) at speeds beyond the free orbit that grow in size from 0, as far as friction balances [N].

    With `is_held` the slowest mode stays; without it the spin relaxes for good.
    """
    unknown, at, forces = np.zeros(6), 0.0, []
    for speed in speeds:
        try:
            force, unknown = _follow(ball, found, unknown, at, float(speed), is_held)
        except ConvergenceError:
            break
        forces.append(force)
        at = float(speed)
    return np.array(forces)


def _follow(
    ball: HeldBall, found: Modes, start: Array, at: float, speed: float, is_held: bool
) -> tuple[float, Array]:
    """Force at a speed from the solution at the last one, in as many steps as Newton's method needs."""
    unknown, step, depth = start, speed - at, 0
    while True:
        trial = speed if abs(speed - at) <= abs(step) * (1.0 + 1e-12) else at + step
        force, there, rest = _newton(ball, found, unknown, trial, is_held)
        if rest <= CLOSED:
            unknown, at = there, trial
            if at == speed:
                return force, unknown
        elif depth < DEEPEST:
            step, depth = 0.5 * step, depth + 1
        else:
            message = f"Mobility: a push at {trial:.3g} m/s finds no balance of friction."
            raise ConvergenceError(message, DEEPEST, rest)


def _newton(
    ball: HeldBall, found: Modes, unknown: Array, speed: float, is_held: bool
) -> tuple[float, Array, float]:
    """Newton on (V - V_0, spin - spin_0, drift of the held mode), all scaled; force and unbalance, too."""
    arm = 0.5 * ball.problem.ball_diameter
    scales = ball.capacity * np.array((1.0, 1.0, arm, arm, arm))
    drift = np.zeros(4) if found.right is None or not is_held else found.masses @ found.right
    drift = drift / max(float(np.abs(drift[1:]).max()), 1e-300) * ball.capacity * arm
    lengths = np.array((1e-6 * ball.problem.ball_diameter,) * 2 + (abs(ball.units[1]),) * 3 + (1.0,))
    rest, state = np.inf, ball.state.copy()
    best = unknown
    force = 0.0
    for _ in range(25):
        state[:2] = ball.state[:2] + unknown[:2] * lengths[:2]
        spin = unknown[2:5] * lengths[2:5]
        state[2] = ball.state[2] + speed / ball.units[0]
        state[3:] = ball.state[3:] + spin / ball.units[1:]
        balance, slopes = balanced(ball, state)
        rows, matrix = np.empty(6), np.zeros((6, 6))
        acting = balance - np.concatenate(((0.0, 0.0), unknown[5] * drift))
        rows[:5] = acting[[0, 1, 3, 4, 5]] / scales
        matrix[:5, :2] = slopes[[0, 1, 3, 4, 5], :2]
        matrix[:5, 2:5] = slopes[[0, 1, 3, 4, 5], 3:] / ball.units[1:]
        matrix[2:5, 5] = -drift[1:]
        matrix[:5] *= lengths / scales[:, None]
        if drift.any() and found.left is not None:
            row = found.left / max(float(np.abs(found.left[1:]).max()), 1e-300)
            rows[5] = (row[0] * speed + row[1:] @ spin) / lengths[2]
            matrix[5, 2:5] = row[1:]
        else:
            rows[5], matrix[5, 5] = unknown[5], 1.0
        rest, best, force = float(np.abs(rows).max()), unknown, -float(acting[2])
        if not np.isfinite(rest) or rest <= 0.01 * CLOSED:
            break
        try:
            unknown = unknown - np.linalg.solve(matrix, rows)
        except np.linalg.LinAlgError:
            return force, best, np.inf
    return force, best, rest
