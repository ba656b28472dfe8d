"""A ball that is pushed along its orbit for long: F(u), quasi-steady, from the whole slip fields.

All modes of the ball but the slowest have relaxed: the slowest, the attitude of its spin axis, is where it
was. Its coordinate is held at zero, and only along its pattern may the spin still change.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from separatrix.chain.mobility.field import HeldBall, balanced
from separatrix.chain.mobility.modes import Modes
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array


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


def pushed(ball: HeldBall, found: Modes, speeds: Array) -> Array:
    """F(u) at speeds beyond the free orbit that grow in size from 0, as far as friction balances [N].

    The slowest mode stays; without its pattern the spin relaxes for good.
    """
    unknown, at, forces = np.zeros(6), 0.0, []
    for speed in speeds:
        try:
            force, unknown = _follow(ball, found, unknown, at, float(speed))
        except ConvergenceError:
            break
        forces.append(force)
        at = float(speed)
    return np.array(forces)


def _follow(ball: HeldBall, found: Modes, start: Array, at: float, speed: float) -> tuple[float, Array]:
    """Force at a speed from the solution at the last one, in as many steps as Newton's method needs."""
    unknown, step, depth = start, speed - at, 0
    while True:
        trial = speed if abs(speed - at) <= abs(step) * (1.0 + 1e-12) else at + step
        force, there, rest = _newton(ball, found, unknown, trial)
        if rest <= CLOSED:
            unknown, at = there, trial
            if at == speed:
                return force, unknown
        elif depth < DEEPEST:
            step, depth = 0.5 * step, depth + 1
        else:
            message = f"Mobility: a push at {trial:.3g} m/s finds no balance of friction."
            raise ConvergenceError(message, DEEPEST, rest)


def _newton(ball: HeldBall, found: Modes, unknown: Array, speed: float) -> tuple[float, Array, float]:
    """Newton on (V - V_0, spin - spin_0, drift of the held mode), all scaled; force and unbalance, too."""
    force, best, rest = 0.0, unknown, np.inf
    for _ in range(25):
        force, rows, matrix = _equations(ball, found, unknown, speed)
        rest, best = float(np.abs(rows).max()), unknown
        if not np.isfinite(rest) or rest <= 0.01 * CLOSED:
            break
        try:
            unknown = unknown - np.linalg.solve(matrix, rows)
        except np.linalg.LinAlgError:
            return force, best, np.inf
    return force, best, rest


def _equations(ball: HeldBall, found: Modes, unknown: Array, speed: float) -> tuple[float, Array, Array]:
    """Force of a push, what is not yet 0, shape (6,), and its slopes with the unknowns, (6, 6).

    Balance in the plane of the contacts, couples less the drift, and the held mode's coordinate.
    """
    arm, acts = 0.5 * ball.problem.ball_diameter, [0, 1, 3, 4, 5]
    scales = ball.capacity * np.array((1.0, 1.0, arm, arm, arm))
    units = np.array((1e-6 * ball.problem.ball_diameter,) * 2 + (abs(ball.units[1]),) * 3)
    moved = unknown[:5] * units
    state = ball.state.copy()
    state[:2] += moved[:2]
    state[2] += speed / ball.units[0]
    state[3:] += moved[2:] / ball.units[1:]
    balance, slopes = balanced(ball, state)
    drift, row = np.zeros(4), np.zeros(4)
    if found.right is not None and found.left is not None:
        drift = _over_spin(found.masses @ found.right) * ball.capacity * arm
        row = _over_spin(found.left)
    balance[2:] -= unknown[5] * drift
    matrix = np.zeros((6, 6))
    matrix[:5, :2] = slopes[acts, :2]
    matrix[:5, 2:5] = slopes[acts, 3:] / ball.units[1:]
    matrix[:5, :5] *= units / scales[:, None]
    matrix[2:5, 5] = -drift[1:] / scales[2:]
    matrix[5, 2:5], matrix[5, 5] = row[1:], float(found.right is None)
    coordinate = (row[0] * speed + row[1:] @ moved[2:]) / units[2]
    last = unknown[5] if found.right is None else coordinate
    return -float(balance[2]), np.append(balance[acts] / scales, last), matrix


def _over_spin(values: Array) -> Array:
    """A pattern over its largest part of spin."""
    return np.asarray(values / float(np.abs(values[1:]).max()))
