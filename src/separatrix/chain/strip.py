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
import scipy

from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, Ratio


def strip_influence(nodes: int, lam: float) -> Array:
    """Toeplitz coefficients t[i - j + nodes - 1] of the stick equations, shape (2 nodes - 1,) [-]."""
    dx = 2.0 / nodes
    right = dx * (np.arange(nodes, -nodes - 1, -1) + 0.5)  # edges seen from the centres; none of them is 0
    primitive = right * np.log(np.abs(right))
    displacement = 2.0 / math.pi * (primitive[1:] - primitive[:-1])  # of a uniform unit traction
    t = displacement[1:] - displacement[:-1]
    t[nodes - 1 : nodes + 1] += np.array([lam, -lam])[: t[nodes - 1 : nodes + 1].size]
    return np.asarray(t)


def node_pressure(nodes: int) -> Array:
    """Element averages of the Hertz pressure sqrt(1 - x^2) from the leading edge on, shape (node,) [-]."""
    x = 1.0 - 2.0 * np.arange(nodes + 1) / nodes
    primitive = 0.5 * (x * np.sqrt(np.maximum(1.0 - x * x, 0.0)) + np.arcsin(x))
    return -0.5 * nodes * np.diff(primitive)


BLOCK_SWEEPS = 60
LEAST_INDEX_SWEEPS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class StripSolution:
    """Traction of one strip in units of mu p0, from the leading edge on; shape (node,) each [-].

    `stuck` is that without slip; `slip` is 0 in stick, else the sign of the slip; `sweeps` counts the
    solutions of the stick zone.
    """

    along: Array
    pressure: Array
    shear: Array
    stuck: Array
    slip: Array
    sweeps: int

    @property
    def traction_ratio(self) -> Ratio:
        """Traction over its bound mu P of the strip [-]."""
        return float(self.shear.sum() / self.pressure.sum())


def solve_strip(creep: Ratio | Array, lam: Ratio = 0.0, *, nodes: int = 200) -> StripSolution:
    """Traction along one strip in steady rolling.

    Coulomb wants slip where a sticking element is beyond its bound, and stick where slip opposes traction.
    All wrong elements change at once; should that cycle, one at a time, the first in order (Murty's rule).

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

    Raises
    ------
    ConvergenceError
        The stick zone did not settle.
    """
    t, bound = strip_influence(nodes, lam), node_pressure(nodes)
    matrix = scipy.linalg.toeplitz(t[nodes - 1 :], t[nodes - 1 :: -1])
    strain, slip = np.broadcast_to(4.0 * np.asarray(creep) / nodes, (nodes,)), np.zeros(nodes)
    limit = BLOCK_SWEEPS + LEAST_INDEX_SWEEPS * nodes
    for sweep in range(1, limit + 1):
        q, sticks = slip * bound, slip == 0.0
        q[sticks] = np.linalg.solve(matrix[np.ix_(sticks, sticks)], (strain - matrix @ q)[sticks])
        wanted = np.where(slip * (strain - matrix @ q) < -1e-12, 0.0, slip)
        beyond = sticks & (np.abs(q) > bound * (1.0 + 1e-12))
        wanted[beyond] = np.sign(q[beyond])
        wrong = np.flatnonzero(wanted != slip)
        if wrong.size == 0:
            return StripSolution(
                along=1.0 - (2.0 * np.arange(nodes) + 1.0) / nodes,
                pressure=bound,
                shear=q,
                stuck=np.asarray(np.linalg.solve(matrix, strain), dtype=np.float64),
                slip=slip,
                sweeps=sweep,
            )
        changed = wrong if sweep <= BLOCK_SWEEPS else wrong[:1]
        slip[changed] = wanted[changed]
    raise ConvergenceError(
        f"Strip of {nodes} elements: the stick zone still changes after {limit} sweeps.", limit
    )
