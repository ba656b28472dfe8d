r"""One strip: influence of its traction elements, and Coulomb's law solved directly (paper, 4.3.3, Eqs 7-11).

Half-plane with a film in series. Units of the strip: x in half lengths b, traction in mu p0, displacement in
mu p0 b/E*. Nodes run from the leading edge x = +1, where particles enter, to x = -1. In stick

    sum_j [A(x_i - x_j) - A(x_i + dx - x_j)] Q_j + lam (Q_i - Q_(i-1)) = 2 c dx,   Q_(-1) = 0,

c = xi/xi_s being the creep over the strip's saturation creep 2 mu p0/E* and lam = L E*/b the film's
compliance.

The paper cuts the traction without slip at the bound; that alone is not Carter's solution. Here an active set
of sticking and slipping elements is used: the stick zone is solved anew after every change, and an element
slips only while its slip opposes its traction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, Ratio


@part
def log_kernel(x: float, half_width: float) -> float:
    """Surface displacement at x of a uniform unit traction on |x| < half_width, without its constant."""
    right, left = x + half_width, x - half_width  # never 0: x lies on centres of elements
    return 2.0 / math.pi * (left * math.log(abs(left)) - right * math.log(abs(right)))


@kernel
def strip_influence(nodes: int, lam: float) -> Array:
    """Toeplitz coefficients t[i - j + nodes - 1] of the stick equations, shape (2 nodes - 1,) [-]."""
    dx = 2.0 / nodes
    t = np.zeros(2 * nodes - 1)
    for k in range(1 - nodes, nodes):
        t[k + nodes - 1] = log_kernel(-k * dx, 0.5 * dx) - log_kernel((1 - k) * dx, 0.5 * dx)
    t[nodes - 1] += lam
    if nodes > 1:
        t[nodes] -= lam
    return t


@kernel
def node_pressure(nodes: int) -> Array:
    """Element averages of the Hertz pressure sqrt(1 - x^2) from the leading edge on, shape (node,) [-]."""
    averages = np.zeros(nodes)
    upper = math.pi / 4.0
    for i in range(nodes):
        x = 1.0 - 2.0 * (i + 1) / nodes
        lower = 0.5 * (x * math.sqrt(max(1.0 - x * x, 0.0)) + math.asin(x))
        averages[i] = (upper - lower) * nodes / 2.0
        upper = lower
    return averages


@part
def toeplitz_product(t: Array, q: Array) -> Array:
    """Product of the Toeplitz matrix with tractions q, shape (node,) [-]."""
    nodes = q.size
    product = np.zeros(nodes)
    for i in range(nodes):
        total = 0.0
        for j in range(nodes):
            total += t[i - j + nodes - 1] * q[j]
        product[i] = total
    return product


BLOCK_SWEEPS = 60
LEAST_INDEX_SWEEPS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class StripSolution:
    """Traction of one strip in units of mu p0, from the leading edge on; shape (node,) each [-].

    `slip` is 0 in stick, else the sign of the slip; `tangent` is d(traction)/dc with the stick zone held;
    `sweeps` counts the solutions of the stick zone.
    """

    along: Array
    pressure: Array
    shear: Array
    tangent: Array
    slip: Array
    sweeps: int

    @property
    def traction_ratio(self) -> Ratio:
        """Traction over its bound mu P of the strip [-]."""
        return float(self.shear.sum() / self.pressure.sum())

    @property
    def slope(self) -> Ratio:
        """Tangent of `traction_ratio` to the creep c [-]."""
        return float(self.tangent.sum() / self.pressure.sum())


def solve_strip(creep: Ratio | Array, lam: Ratio = 0.0, *, nodes: int = 200) -> StripSolution:
    """Traction along one strip in steady rolling.

    Parameters
    ----------
    creep : float or array
        Creep over the strip's saturation creep 2 mu p0/E*, of either sign; or its course along the strip,
        shape (node,) [-].
    lam : float
        Film compliance L E*/b of the strip, >= 0 [-].
    nodes : int
        Elements; the error is of first order in 1/nodes (Carter at T/(mu P) = 0.64: 0.7 % with 50, 0.04 %
        with 800).

    Returns
    -------
    StripSolution
        Traction, stick and slip.

    Raises
    ------
    ConvergenceError
        The stick zone did not settle.
    """
    t = strip_influence(nodes, lam)
    strain = np.ascontiguousarray(
        np.broadcast_to(4.0 * np.asarray(creep, dtype=np.float64) / nodes, (nodes,))
    )
    pressure = node_pressure(nodes)
    q, slip, sweeps = active_set(t, pressure, strain)
    if sweeps < 0:
        raise ConvergenceError(
            f"Strip of {nodes} elements: the stick zone still changes after {-sweeps} sweeps.", -sweeps
        )
    return StripSolution(
        along=1.0 - (2.0 * np.arange(nodes) + 1.0) / nodes,
        pressure=pressure,
        shear=q,
        tangent=stick_solution(t, np.zeros(nodes), np.full(nodes, 4.0 / nodes), slip),
        slip=slip,
        sweeps=sweeps,
    )


@kernel
def stick_solution(t: Array, q: Array, strain: Array, slip: Array) -> Array:
    """Tractions with slipping elements held at q and sticking ones strained as given, shape (node,) [-]."""
    n = q.size
    sticks = np.nonzero(slip == 0)[0]
    matrix, right = np.empty((sticks.size, sticks.size)), np.empty(sticks.size)
    for row in range(sticks.size):
        i = sticks[row]
        total = strain[i]
        for j in range(n):
            if slip[j] != 0:
                total -= t[i - j + n - 1] * q[j]
        right[row] = total
        for column in range(sticks.size):
            matrix[row, column] = t[i - sticks[column] + n - 1]
    solution = q.copy()
    if sticks.size > 0:
        solution[sticks] = np.linalg.solve(matrix, right)
    return solution


@kernel
def active_set(t: Array, bound: Array, strain: Array) -> tuple[Array, Array, int]:
    """Traction, slip sign (0 in stick), shape (node,) each, and sweeps, negative if unsettled.

    Coulomb wants slip where a sticking element is beyond its bound, and stick where slip opposes traction.
    All wrong elements change at once; should that cycle, one at a time, the first in order (Murty's rule).
    """
    slip = np.zeros(bound.size)
    q = np.zeros(bound.size)
    limit = BLOCK_SWEEPS + LEAST_INDEX_SWEEPS * bound.size
    for sweep in range(1, limit + 1):
        q = stick_solution(t, slip * bound, strain, slip)
        rest = strain - toeplitz_product(t, q)
        settled = True
        for i in range(q.size):
            wanted = slip[i]
            if slip[i] == 0.0 and abs(q[i]) > bound[i] * (1.0 + 1e-12):
                wanted = np.sign(q[i])
            elif slip[i] * rest[i] < -1e-12:
                wanted = 0.0
            if wanted != slip[i] and (settled or sweep <= BLOCK_SWEEPS):
                slip[i], settled = wanted, False
        if settled:
            return q, slip, sweep
    return q, slip, -limit
