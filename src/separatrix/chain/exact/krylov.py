r"""One linear step of the tangential problem: GMRES with a preconditioner on the right (Saad & Schultz 1986).

The unknowns are both components of the traction in a sticking cell and its turn along the tangent t in a
slipping one, which is the azimuth of Zhao, Vollebregt & Oosterlee (2014):

    stick: (A v)_i = r_i,      slip: t.(A v)_i + d_i t.v_i = r_i.

They are stored as two numbers a cell; the second one of a slipping cell stays 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.chain.exact.operator import Operator, product
from separatrix.chain.exact.precondition import SLIP, STICK, States, precondition, slip_factors
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array

LARGEST_SPACE = 80  # vectors of the Krylov space; 3 to 12 are usual


@dataclass(frozen=True, slots=True)
class Sets:
    """Stick and slip: state and turn d, shape (row, column), and normal n = z/|z|, shape (2, row, column)."""

    state: States
    normal: Array
    turn: Array


def solve_step(op: Operator, sets: Sets, right: Array, tolerance: float) -> tuple[Array, int]:
    """Tractions v, shape (2, row, column), and the number of products taken; `tolerance` is relative."""
    band = slip_factors(sets.state, op.whole, sets.normal, sets.turn, op.rows, op.kind, op.local)

    def nearly_inverse(u: Array) -> Array:
        return precondition(
            u, sets.state, op.whole, sets.normal, sets.turn, op.diagonal, band, op.inverses, op.kind
        )

    space = np.empty((LARGEST_SPACE + 1, *right.shape))
    triangle = np.zeros((LARGEST_SPACE + 1, LARGEST_SPACE))
    turns = np.zeros((3, LARGEST_SPACE + 1))  # cosines and sines of Givens' rotations, and the right side
    length = begin(right, space, turns)
    if length == 0.0:
        return np.zeros_like(right), 0
    for k in range(LARGEST_SPACE):
        v = nearly_inverse(space[k])
        left = extend(k, product(op, v), v, sets.state, sets.normal, sets.turn, space, triangle, turns)
        if left <= tolerance * length:
            break
    return nearly_inverse(combine(k + 1, space, triangle, turns)), k + 1


@part
def dot(x: Array, y: Array) -> float:
    """Inner product in a fixed order of four partial sums."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = x.size - x.size % 4
    for i in range(0, whole, 4):
        a += x[i] * y[i]
        b += x[i + 1] * y[i + 1]
        c += x[i + 2] * y[i + 2]
        d += x[i + 3] * y[i + 3]
    for i in range(whole, x.size):
        a += x[i] * y[i]
    return (a + b) + (c + d)


@kernel
def begin(right: Array, space: Array, turns: Array) -> float:
    """Set the first vector of the space; length of the right side."""
    length = math.sqrt(dot(right.ravel(), right.ravel()))
    if length > 0.0:
        space[0] = right / length
    turns[2, 0] = length
    return length


@kernel
def extend(
    k: int,
    slip: Array,
    v: Array,
    state: States,
    normal: Array,
    turn: Array,
    space: Array,
    triangle: Array,
    turns: Array,
) -> float:
    """Add the next vector by Gram and Schmidt, rotate its column; length of the residual."""
    new = space[k + 1]
    project_slip(slip, v, state, normal, turn, new)
    flat = new.ravel()
    for n in range(k + 1):
        other = space[n].ravel()
        h = dot(flat, other)
        triangle[n, k] = h
        for i in range(flat.size):
            flat[i] -= h * other[i]
    length = math.sqrt(dot(flat, flat))
    if length > 0.0:
        for i in range(flat.size):
            flat[i] /= length
    for n in range(k):
        c, s = turns[0, n], turns[1, n]
        upper, lower = triangle[n, k], triangle[n + 1, k]
        triangle[n, k], triangle[n + 1, k] = c * upper + s * lower, c * lower - s * upper
    hypotenuse = math.sqrt(triangle[k, k] ** 2 + length**2)
    turns[0, k], turns[1, k] = triangle[k, k] / hypotenuse, length / hypotenuse
    triangle[k, k] = hypotenuse
    turns[2, k + 1] = -turns[1, k] * turns[2, k]
    turns[2, k] *= turns[0, k]
    return math.fabs(turns[2, k + 1])


@part
def project_slip(slip: Array, v: Array, state: States, normal: Array, turn: Array, result: Array) -> None:
    """Left side of the rows: A v in stick, t.(A v) + d t.v in slip."""
    _, ny, nx = slip.shape
    for j in range(ny):
        for i in range(nx):
            result[0, j, i], result[1, j, i] = 0.0, 0.0
            if state[j, i] == STICK:
                result[0, j, i], result[1, j, i] = slip[0, j, i], slip[1, j, i]
            elif state[j, i] == SLIP:
                tx, ty, d = -normal[1, j, i], normal[0, j, i], turn[j, i]
                x, y = slip[0, j, i] + d * v[0, j, i], slip[1, j, i] + d * v[1, j, i]
                result[0, j, i] = tx * x + ty * y


@kernel
def right_side(slip: Array, state: States, normal: Array) -> Array:
    """Right side -S in stick and -t.S in slip, shape (2, row, column)."""
    result = np.zeros_like(slip)
    project_slip(-slip, result, state, normal, np.zeros(state.shape), result)
    return result


@kernel
def combine(count: int, space: Array, triangle: Array, turns: Array) -> Array:
    """Vector of the space with the least residual."""
    weights = np.zeros(count)
    total: Array = np.zeros_like(space[0])
    for n in range(count - 1, -1, -1):
        weights[n] = turns[2, n]
        for m in range(n + 1, count):
            weights[n] -= triangle[n, m] * weights[m]
        weights[n] /= triangle[n, n]
        total += weights[n] * space[n]
    return total
