r"""Influence of traction elements on one strip: half-plane with a film in series (paper, Eqs 7-11).

Units of the strip: x in half lengths b, traction in mu p0, displacement in mu p0 b/E*. Nodes run from the
leading edge x = +1, where particles enter, to x = -1. In stick

    sum_j [A(x_i - x_j) - A(x_i + dx - x_j)] Q_j + lam (Q_i - Q_(i-1)) = 2 c dx,   Q_(-1) = 0,

c = xi/xi_s being the creep over the strip's saturation creep 2 mu p0/E* and lam = L E*/b the film's
compliance.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.compiled import kernel
from separatrix.units import Array


@kernel
def log_kernel(x: float, half_width: float) -> float:
    """Surface displacement at x of a uniform unit traction on |x| < half_width, without its constant."""
    displacement = 0.0
    for edge, sign in ((x + half_width, 1.0), (x - half_width, -1.0)):
        if edge != 0.0:
            displacement -= sign * edge * math.log(abs(edge))
    return 2.0 / math.pi * displacement


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


def node_positions(nodes: int) -> Array:
    """Centres of the elements from the leading edge x = +1 to -1, shape (node,) [-]."""
    return 1.0 - (2.0 * np.arange(nodes) + 1.0) / nodes


@kernel
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
