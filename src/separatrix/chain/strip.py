r"""One strip: influence of its traction elements, and Coulomb's law solved directly (paper, 4.3.3, Eqs 7-11).

Half-plane with a film in series. Units of the strip: x in half lengths b, traction in mu p0, displacement in
mu p0 b/E*. Nodes run from the leading edge x = +1, where particles enter, to x = -1. In stick

    sum_j [A(x_i - x_j) - A(x_i + dx - x_j)] Q_j + lam (Q_i - Q_(i-1)) = 2 c dx,   Q_(-1) = 0,

c = xi/xi_s being the creep over the strip's saturation creep 2 mu p0/E* and lam = L E*/b the film's
compliance.

The paper cuts the traction without slip at the bound; that alone is not Carter's solution. Here an active set
of sticking and slipping elements is used: the stick zone is solved anew after every change, and an element
slips only while its slip opposes its traction.

The master curve is traction against creep for every film. With the slipping tractions at their bound the
stick zone reaches from the leading edge over m elements, and its equations are the leading m rows of one
Toeplitz matrix. Levinson's recursion solves all m = 1..n in turn, in n^2 operations: the whole traction curve
of `solve_strip`, not an approximation of it. A table over lam is then interpolated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

from separatrix.ground.compiled import kernel, part
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


LAM_MIN, LAM_MAX, LAM_COUNT = 1e-3, 300.0, 56
CREEP_COUNT = 257
SOFT = math.pi / 4.0  # s (1 + SOFT lam) tends to a constant where the film is soft


class MasterTable(NamedTuple):
    """Traction over its bound, F, on a grid of v = s c/(1 + s c) and log lam, with s = F'(0)/2.

    The film axis is uniform in w = ln[(lam + lam_min)/(1 + lam/lam_max)].
    """

    values: Array  # F and dF/dv, shape (film, creep, 2)
    log_scale: Array  # ln[s (1 + pi lam/4)], shape (film,)
    axis: tuple[float, float]  # first w, and its step


@kernel
def nested_sticks(t: Array, p: Array, g: Array) -> tuple[Array, Array, Array]:
    """Creep, traction and tangent at which element m is about to slip while all before it stick.

    Parameters
    ----------
    t, p, g : array
        Toeplitz coefficients, shape (2 node - 1,), element averages of pressure and T p, shape (node,) [-].

    Returns
    -------
    tuple of array
        c, F and dF/dc for m = 1..n, shape (node,) each [-].

    Notes
    -----
    Traction is p - r with r = 0 in slip; the stick rows are T_m r = (T p)_m - 2 c dx. f and b are Levinson's
    forward and backward vectors, x and z the solutions for the right sides T p and 1.
    """
    n = p.size
    dx = 2.0 / n
    c, F, S = np.zeros(n), np.zeros(n), np.zeros(n)
    f, b, x, z = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    sum_x, sum_z, total = 0.0, 0.0, p.sum()
    for m in range(n):
        ef, eb, ex, ez = 0.0, 0.0, 0.0, 0.0
        for j in range(m):
            lower = t[m - j + n - 1]
            ef += lower * f[j]
            ex += lower * x[j]
            ez += lower * z[j]
            eb += t[n - 2 - j] * b[j]
        sum_b = _grow(f, b, m, ef, eb, t[n - 1])
        wx, wz = g[m] - ex, 1.0 - ez
        for j in range(m + 1):
            x[j] += wx * b[j]
            z[j] += wz * b[j]
        sum_x += wx * sum_b
        sum_z += wz * sum_b
        c[m] = 0.5 * wx / (dx * wz)
        S[m] = 2.0 * dx * sum_z / total
        F[m] = 1.0 - sum_x / total + c[m] * S[m]
    return c, F, S


@part
def _grow(f: Array, b: Array, m: int, ef: float, eb: float, diagonal: float) -> float:
    """Levinson's step of forward and backward vectors from m to m + 1 elements, in place; the sum of b."""
    if m == 0:
        f[0] = b[0] = 1.0 / diagonal
        return float(b[0])
    d = 1.0 / (1.0 - ef * eb)
    sum_b = 0.0
    for j in range(m, -1, -1):
        old_f = f[j] if j < m else 0.0
        old_b = b[j - 1] if j > 0 else 0.0
        f[j] = d * (old_f - ef * old_b)
        b[j] = d * (old_b - eb * old_f)
        sum_b += b[j]
    return sum_b


Knots = tuple[Array, Array, Array]


def matched_knots(coarse: Array, fine: Array) -> tuple[Knots, Knots]:
    """Knots (c, F, dF/dc) of a strip from its influences with n and 2 n elements, at equal stick lengths.

    At equal stick length all three are first order in 1/n and smooth, so that Richardson's 2 (fine) -
    (coarse) works up to saturation, where the curve at equal creep has a kink that moves with n. Returns the
    extrapolated knots, and the fine ones.
    """

    def knots(t: Array) -> Knots:
        p = node_pressure((t.size + 1) // 2)
        return nested_sticks(t, p, np.convolve(t, p)[p.size - 1 : 2 * p.size - 1])

    first, second = knots(coarse), [values[1::2] for values in knots(fine)]
    c, F, S = (2.0 * two - one for one, two in zip(first, second, strict=True))
    return _ordered(c, F, S), _ordered(second[0], second[1], second[2])


def _ordered(c: Array, F: Array, S: Array) -> Knots:
    """Knots from the origin to saturation, without those of unresolved stick or slip zones.

    A stick zone of one element does not count. Slip zones under a thirty-second of the strip at the trailing
    edge, where the curve is all but straight, are bridged by the cubic between the tangents, which is exact
    for Carter's curve.
    """
    c, F, tangents = c[: -c.size // 32], F[: -c.size // 32], S[: -c.size // 32]
    top = 1 + int(np.argmax(c[1:]))
    start = top + int(np.argmax(F[top:] < 1.0 - 1e-9))
    end = c[start] + 2.0 * (1.0 - F[start]) / tangents[start]
    return (
        np.concatenate(([0.0], c[start:][::-1], [end])),
        np.concatenate(([0.0], F[start:][::-1], [1.0])),
        np.concatenate(([S[-1]], tangents[start:][::-1], [0.0])),
    )


def _row(knots: Knots, scale: float) -> Array:
    """One strip's F and dF/dv on the grid of v = s c/(1 + s c), shape (creep, 2) [-]."""
    c, F, S = knots
    v = np.linspace(0.0, 1.0, CREEP_COUNT)[:-1]
    creep = v / (1.0 - v) / scale
    inside, at = creep < c[-1], np.minimum(creep, c[-1])
    # the cubics that have the values and tangents of the knots
    i = np.clip(np.searchsorted(c, at, side="right") - 1, 0, c.size - 2)
    step, x = c[i + 1] - c[i], at - c[i]
    chord = (F[i + 1] - F[i]) / step
    bend = (S[i] + S[i + 1] - 2.0 * chord) / step
    square, cube = (chord - S[i]) / step - bend, bend / step
    curve = F[i] + S[i] * x + square * (x * x) + cube * (x * x * x)
    tangent = S[i] + square * x * 2.0 + cube * (x * x) * 3.0
    row = np.zeros((CREEP_COUNT, 2))
    row[:-1, 0] = np.where(inside, np.minimum(curve, 1.0), 1.0)
    row[:-1, 1] = np.where(inside, np.maximum(tangent, 0.0), 0.0) / (scale * (1.0 - v) ** 2)
    row[-1, 0] = 1.0
    return row


@lru_cache(maxsize=4)
def film_tables(nodes: int) -> tuple[MasterTable, MasterTable]:
    """Tables of the film in series: extrapolated from `nodes` and 2 `nodes` elements, and the latter.

    Their films reach from none to a practically infinite one.
    """
    first, last = math.log(LAM_MIN), math.log(LAM_MAX * (1.0 - 1e-6))
    stretched = np.exp(np.linspace(first, last, LAM_COUNT))
    lams = (stretched - LAM_MIN) / (1.0 - stretched / LAM_MAX)
    lams[0] = 0.0
    knots = [matched_knots(strip_influence(nodes, lam), strip_influence(2 * nodes, lam)) for lam in lams]
    scales = np.array([0.5 * best[2][0] for best, _ in knots])
    log_scale, axis = np.log(scales * (1.0 + SOFT * lams)), (first, (last - first) / (LAM_COUNT - 1))
    best, fine = (
        np.array([_row(pair[i], scale) for pair, scale in zip(knots, scales, strict=True)]) for i in (0, 1)
    )
    return MasterTable(best, log_scale, axis), MasterTable(fine, log_scale, axis)


@kernel
def master_traction(c: float, lam: float, table: MasterTable) -> tuple[float, float]:
    """Traction over its bound, F, and dF/dc of one strip, for c of either sign (cubic in v and log lam)."""
    values, log_scale, count = table.values, table.log_scale, table.log_scale.size
    w = (math.log((lam + LAM_MIN) / (1.0 + lam / LAM_MAX)) - table.axis[0]) / table.axis[1]
    w = min(max(w, 0.0), count - 1.0)
    start = min(max(int(w) - 1, 0), count - 4)
    w -= start
    weights = (
        -(w - 1.0) * (w - 2.0) * (w - 3.0) / 6.0,
        w * (w - 2.0) * (w - 3.0) / 2.0,
        -w * (w - 1.0) * (w - 3.0) / 2.0,
        w * (w - 1.0) * (w - 2.0) / 6.0,
    )
    log_s = 0.0
    for i in range(4):
        log_s += weights[i] * log_scale[start + i]
    s = math.exp(log_s) / (1.0 + SOFT * lam)
    v = s * abs(c) / (1.0 + s * abs(c))
    cells = values.shape[1] - 1
    cell = min(int(v * cells), cells - 1)
    u, h = v * cells - cell, 1.0 / cells
    F, dF = 0.0, 0.0
    for i in range(4):
        if weights[i] != 0.0:
            f0, d0 = values[start + i, cell, 0], values[start + i, cell, 1] * h
            f1, d1 = values[start + i, cell + 1, 0], values[start + i, cell + 1, 1] * h
            rise = f1 - f0
            square, cube = 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise
            F += weights[i] * (f0 + u * (d0 + u * (square + u * cube)))
            dF += weights[i] * (d0 + u * (2.0 * square + 3.0 * u * cube))
    return math.copysign(min(F, 1.0), c), dF / h * s * (1.0 - v) ** 2
