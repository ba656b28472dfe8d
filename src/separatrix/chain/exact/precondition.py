r"""Approximate inverse of the slip operator, row by row, without factorising it.

A run of m sticking cells of a row takes the inverse of the leading m x m block of the row's Toeplitz
matrix, for every m known beforehand (Levinson 1947, Gohberg & Semencul 1972); a run of slipping cells takes
the banded LU of its turns along the tangents t; cut cells take their diagonal. The order of operations is
fixed, so that the result does not depend on a library's threads.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array

Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]
States = NDArray[np.int8]
OUTSIDE, STICK, SLIP = 0, 1, 2
BAND = 4  # half width of the banded matrices of slipping runs


@kernel
def leading_inverses(t: Array) -> Array:
    """Transposed inverses of the leading blocks of T_ij = t[i - j + n - 1], sizes 1 to n in turn.

    Levinson's recursion for the first column f and the last column b of each inverse; then, after Gohberg and
    Semencul, B_ij = B_(i-1)(j-1) + (f_i b_(m-1-j) - b_(i-1) f_(m-j))/f_0.
    """
    n = (t.size + 1) // 2
    total = 0
    for m in range(1, n + 1):
        total += m * m
    blocks = np.empty(total)
    f, b = np.zeros(n), np.zeros(n)
    f[0] = b[0] = blocks[0] = 1.0 / t[n - 1]
    start = 1
    for m in range(2, n + 1):
        eps_f, eps_b = 0.0, 0.0
        for i in range(m - 1):
            eps_f += t[m - 1 - i + n - 1] * f[i]
            eps_b += t[n - 2 - i] * b[i]
        scale = 1.0 / (1.0 - eps_f * eps_b)
        for i in range(m - 1, -1, -1):
            lower, upper = f[i], (b[i - 1] if i > 0 else 0.0)
            f[i] = scale * (lower - eps_f * upper)
            b[i] = scale * (upper - eps_b * lower)
        for i in range(m):
            for j in range(m):
                B = b[m - 1 - j]
                if i > 0:
                    turn = b[i - 1] * f[m - j] if j > 0 else 0.0
                    before = blocks[start + (j - 1) * m + i - 1] if j > 0 else 0.0
                    B = before + (f[i] * b[m - 1 - j] - turn) / f[0]
                blocks[start + j * m + i] = B
        start += m * m
    return blocks


@kernel
def slip_factors(
    state: States, whole: Flags, normal: Array, turn: Array, rows: Array, kind: Indices, local: Array
) -> Array:
    """Banded LU of each run of whole slipping cells, shape (row, column, 2 BAND + 1).

    The matrix is D_xx t_x t_x' + D_yy t_y t_y' + d: the slip along t that turns of the tractions cause.
    """
    ny, nx = state.shape
    band = np.zeros((ny, nx, 2 * BAND + 1))
    for j in range(ny):
        xx, yy = rows[kind[j], 0], rows[kind[j], 1]
        first = 0
        while first < nx:
            if state[j, first] != SLIP or not whole[j, first]:
                first += 1
                continue
            last = first
            while last + 1 < nx and state[j, last + 1] == SLIP and whole[j, last + 1]:
                last += 1
            for i in range(first, last + 1):
                tx, ty = -normal[1, j, i], normal[0, j, i]
                for k in range(max(first, i - BAND), min(last, i + BAND) + 1):
                    coupling = (
                        -xx[i - k + nx - 1] * tx * normal[1, j, k] + yy[i - k + nx - 1] * ty * normal[0, j, k]
                    )
                    band[j, i, k - i + BAND] = coupling
                band[j, i, BAND] += local[0, j, i] * tx * tx + local[1, j, i] * ty * ty + turn[j, i]
            _factorise(band[j], first, last)
            first = last + 1
    return band


@part
def _factorise(band: Array, first: int, last: int) -> None:
    """LU without pivots of the band between two cells, in place."""
    for i in range(first, last + 1):
        for k in range(i + 1, min(last, i + BAND) + 1):
            factor = band[k, i - k + BAND] / band[i, BAND]
            band[k, i - k + BAND] = factor
            for column in range(i + 1, min(last, i + BAND) + 1):
                band[k, column - k + BAND] -= factor * band[i, column - i + BAND]


@kernel
def precondition(
    u: Array,
    state: States,
    whole: Flags,
    normal: Array,
    turn: Array,
    diagonal: Array,
    band: Array,
    inverses: Array,
    kind: Indices,
) -> Array:
    """Tractions, shape (2, row, column), that nearly cause the slip u; in slip u_0 is along t."""
    _, ny, nx = u.shape
    z = np.zeros_like(u)
    starts = np.zeros(nx + 1, dtype=np.int64)
    for m in range(1, nx):
        starts[m + 1] = starts[m] + m * m
    for j in range(ny):
        first = 0
        while first < nx:
            kept = state[j, first]
            last = first
            if kept != OUTSIDE and whole[j, first]:
                while last + 1 < nx and state[j, last + 1] == kept and whole[j, last + 1]:
                    last += 1
                if kept == STICK:
                    m = last - first + 1
                    for c in range(2):
                        _apply(inverses[kind[j], c], starts[m], m, u[c, j], z[c, j], first)
                else:
                    _substitute(band[j], u[0, j], z[0, j], first, last)
                    _along_tangent(z, normal, j, first, last)
            elif kept == STICK:
                z[0, j, first] = u[0, j, first] / diagonal[0, j, first]
                z[1, j, first] = u[1, j, first] / diagonal[1, j, first]
            elif kept == SLIP:
                tx, ty = -normal[1, j, first], normal[0, j, first]
                own = diagonal[0, j, first] * tx * tx + diagonal[1, j, first] * ty * ty + turn[j, first]
                z[0, j, first] = u[0, j, first] / own
                _along_tangent(z, normal, j, first, first)
            first = last + 1
    return z


@part
def _apply(blocks: Array, start: int, m: int, u: Array, z: Array, first: int) -> None:
    """Add block times u to z, column by column."""
    for k in range(m):
        factor, column = u[first + k], start + k * m
        for i in range(m):
            z[first + i] += blocks[column + i] * factor


@part
def _substitute(band: Array, u: Array, z: Array, first: int, last: int) -> None:
    """Solve the banded system of a run."""
    for i in range(first, last + 1):
        z[i] = u[i]
        for k in range(max(first, i - BAND), i):
            z[i] -= band[i, k - i + BAND] * z[k]
    for i in range(last, first - 1, -1):
        for k in range(i + 1, min(last, i + BAND) + 1):
            z[i] -= band[i, k - i + BAND] * z[k]
        z[i] /= band[i, BAND]


@part
def _along_tangent(z: Array, normal: Array, j: int, first: int, last: int) -> None:
    """Turn the lengths z_0 of a run into vectors along t = (-n_y, n_x)."""
    for i in range(first, last + 1):
        length = z[0, j, i]
        z[0, j, i], z[1, j, i] = -normal[1, j, i] * length, normal[0, j, i] * length
