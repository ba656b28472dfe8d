"""The numbers every kernel of the equilibrium needs, and the small linear solver they share."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from separatrix.chain.hertz import contact_modulus
from separatrix.ground.compiled import part
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array
from separatrix.study.study import BallBearing, Operation


class Problem(NamedTuple):
    """Bearing and speeds as plain floats [SI]; `speed` is inner less outer, `inertia_factor` scales it."""

    ball_diameter: float
    pitch_diameter: float
    inner_conformity: float
    outer_conformity: float
    free_sine: float
    free_cosine: float
    modulus: float
    ball_mass: float
    ball_inertia: float
    outer_speed: float
    speed: float
    inner_share: float  # lambda_i of the gyroscopic friction; the outer race carries 2 - lambda_i
    friction: float
    inertia_factor: float


class Method(NamedTuple):
    """How to solve: the force that counts as one unit [N], and the quadrature over an ellipse."""

    force: float
    cells: int
    nodes: Array
    coarse_cells: int
    coarse_nodes: Array


class Work(NamedTuple):
    """Room for one ball of n unknowns: slopes of its balance, (n, n + 2); its push, (5,), and (5, n + 2)."""

    by_state: Array
    push: Array
    push_by: Array


@part
def work(n: int) -> Work:
    """Empty room for a ball of n unknowns."""
    return Work(np.zeros((n, n + 2)), np.zeros(5), np.zeros((5, n + 2)))


def problem(bearing: BallBearing, operation: Operation, inner_share: float, friction: float) -> Problem:
    """Collect what the kernels need.

    Raises
    ------
    InputError
        The ball material has no density although the bearing turns.
    """
    D, ball = bearing.ball_diameter, bearing.ball_material
    turning = operation.inner_speed != 0.0 or operation.outer_speed != 0.0
    if ball.density is None and turning:
        cure = "Centrifugal force needs it; add it, or set the speeds to 0."
        raise InputError("[bearing] ball_material", "needs a density [kg/m3]", "", cure)
    mass = (ball.density or 0.0) * math.pi * D**3 / 6.0
    numbers = (
        D,
        bearing.pitch_diameter,
        bearing.inner_conformity,
        bearing.outer_conformity,
        math.sin(bearing.free_angle),
        math.cos(bearing.free_angle),
        contact_modulus(ball, bearing.ring_material),
        mass,
        0.1 * mass * D * D,
        operation.outer_speed,
        operation.inner_speed - operation.outer_speed,
        inner_share,
        friction,
        1.0 if turning else 0.0,
    )
    return Problem(*(float(number) for number in numbers))  # an int would compile every kernel anew


@part
def copy(into: Array, values: Array) -> None:
    """Set `into`, shape (n,), to the first values: an assignment of slices takes seconds to compile."""
    for k in range(into.size):
        into[k] = values[k]


@part
def solve_linear(matrix: Array, right: Array) -> bool:
    """Solve in place by Gauss with row exchange; `right`, shape (n, columns), becomes the answer.

    False if the matrix is singular.
    """
    n, columns = right.shape
    for i in range(n):
        pivot = i
        for j in range(i + 1, n):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        if not abs(matrix[pivot, i]) > 0.0:
            return False
        if pivot != i:
            for k in range(n):
                matrix[i, k], matrix[pivot, k] = matrix[pivot, k], matrix[i, k]
            for k in range(columns):
                right[i, k], right[pivot, k] = right[pivot, k], right[i, k]
        for j in range(i + 1, n):
            factor = matrix[j, i] / matrix[i, i]
            if factor != 0.0:
                for k in range(i, n):
                    matrix[j, k] -= factor * matrix[i, k]
                for k in range(columns):
                    right[j, k] -= factor * right[i, k]
    for i in range(n - 1, -1, -1):
        for k in range(columns):
            total = right[i, k]
            for j in range(i + 1, n):
                total -= matrix[i, j] * right[j, k]
            right[i, k] = total / matrix[i, i]
    return True
