"""Master curve of a strip: traction against creep for every film, all stick lengths in one recursion.

A strip knows two numbers: c, its creep over its saturation creep, and lam, its film compliance. With the
slipping tractions at their bound the stick zone reaches from the leading edge over m elements, and its
equations are the leading m rows of one Toeplitz matrix. Levinson's recursion solves all m = 1..n in turn, in
n^2 operations: the whole traction curve of `solve_strip`, not an approximation of it. A table over lam is
then interpolated.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from separatrix.chain.strip import node_pressure, strip_influence
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array

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
