r"""Slip that tractions cause: a convolution over the grid, and the local terms of cut cells and films.

Steady rolling (Kalker 1990) has the slip W - dU/dx. The derivative is one-sided, of second order at the
centre of the cell: times dx,

    S_i = W dx + U(x_i - dx/2)/2 + U(x_i) - U(x_i + dx/2) - U(x_i + dx) + U(x_i + 3 dx/2)/2.

Its bias upstream carries the entry condition. The factors of the cells' centres and those of their edges each
sum to 0, so that it does not see how the jumps of the tractions between cells differ at centres and edges.
U is the convolution of the tractions with the influence of one cell, by zero-padded FFT (Liu & Wang 2000).

A cut cell with the share f of its length inside has the extra term

    c D_0 (1/f - 1) cos(theta),    D_0 = D_n n n + D_t t t,

n the normal of the outline, at the angle theta to rolling, and t its tangent. D_n and D_t are the stencil's
terms of a row of endless width: the ends of neighbouring rows move together as one edge. Distances along
rolling are 1/cos(theta) of those across that edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from separatrix.chain.exact.grid import Grid, end_normals
from separatrix.chain.exact.influence import Body, flexibility, half_space_flexibility, influence, pair_images
from separatrix.ground.compiled import kernel
from separatrix.ground.units import Array, Metre, Ratio

Complex = NDArray[np.complex128]
Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]

ROLLING = ((-1, 0.5), (0, 1.0), (1, -1.0), (2, -1.0), (3, 0.5))  # pairs of shift in dx/2 and factor
THIN_ROLLING = ((1, 0.25), (0, 0.75), (-1, -1.25), (-2, 0.25))  # it on a thin film: offset in cells, factor
DISPLACEMENT = ((0, 1.0),)
CUT = 3.0  # makes the sticking slope of a plane strip independent of the cut (measured in the tests)
ENDLESS = 1e5  # width of a row over a cell's sides, as of a plane strip
THIN = 0.02  # thickness over cell width at which half of a film acts as in series
LARGEST_KINDS = 8  # of rows, for which the preconditioner keeps inverses
WHOLE = 0.6  # share of a cell inside from which the preconditioner takes it as whole
NEIGHBOUR = 0.4  # weight of the next row in the preconditioner's rows; its square of the one after, and so on


@dataclass(frozen=True, slots=True)
class Operator:
    """Slip times dx of tractions (2, row, column), and what the preconditioner needs of it.

    spectra : transforms of xx, yy, xy; padded : size of the transform; local : extra diagonal, cross : extra
    xy in the cell, and upstream : factor of the next cell upstream, of cuts and films; diagonal : A_ii;
    active, whole : cells in the contact, cells not cut by much; rows : Toeplitz coefficients of a row, shape
    (kind, 2, 2 columns - 1), and inverses of their leading blocks; kind : which of them a row takes.
    """

    spectra: Complex
    padded: tuple[int, int]
    local: Array
    cross: Array
    upstream: Array
    diagonal: Array
    active: Flags
    whole: Flags
    rows: Array
    inverses: Array
    kind: Indices


def rolling_operator(grid: Grid, bodies: tuple[Body, Body], compliance: Array | None = None) -> Operator:
    """Operator of steady rolling; `compliance` is L of a film in series, shape (row, column) [m/Pa]."""
    rows, columns = grid.shape
    padded = scipy.fft.next_fast_len(2 * rows - 1), scipy.fft.next_fast_len(2 * columns - 1, real=True)
    table = influence(grid.shape, (grid.dy, grid.dx), pair_images(*bodies), ROLLING)[:3]
    f, L = grid.fraction, np.zeros(grid.shape) if compliance is None else compliance
    thin = sum(film * share for film, share in (unresolved_film(body, grid.dx) for body in bodies))
    # the share `thin` of films responds as in series, L and -L upstream, with the rules of their row ends
    for offset, factor in (*THIN_ROLLING, (0, -1.0), (-1, 1.0)):
        table[:2, 0, columns - 1 + offset] -= factor * thin
    film, upstream = series_film(f, L, thin)
    cut, cross = _cut_cells(grid, bodies, thin)
    kinds, kind = np.unique(_row_compliance(L, f), return_inverse=True)
    near = NEIGHBOUR ** np.arange(1, rows)
    row = table[:2, 0] + 2.0 * np.einsum("j,cji->ci", near, table[:2, 1:])
    lines = np.repeat(row[None], kinds.size, axis=0)
    lines[:, :, columns - 1] += kinds[:, None]
    lines[:, :, columns - 2] -= kinds[:, None]
    return Operator(
        spectra=spectrum(table, padded),
        padded=padded,
        local=cut + film,
        cross=cross,
        upstream=upstream,
        diagonal=table[:2, 0, columns - 1, None, None] + cut + film,
        active=f > 0.0,
        whole=f >= WHOLE,
        rows=lines,
        inverses=np.array([[leading_inverses(t) for t in pair] for pair in lines]),
        kind=kind.astype(np.int64),
    )


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


def _cut_cells(grid: Grid, bodies: tuple[Body, Body], thin: float) -> tuple[Array, Array]:
    """Extra diagonal, shape (2, row, column), and extra xy of cut cells [m/Pa]; films have their own."""
    endless = ENDLESS * max(grid.dx, grid.dy)
    normal, tangent = influence((1, 1), (endless, grid.dx), pair_images(*bodies), ROLLING)[:2, 0, 0]
    normal, tangent = (D - dict(THIN_ROLLING)[0] * thin for D in (normal, tangent))
    cos, sin = end_normals(grid)
    size = CUT * cos * np.where(grid.fraction > 0.0, 1.0 / np.maximum(grid.fraction, 1e-300) - 1.0, 0.0)
    xx, yy = normal * cos**2 + tangent * sin**2, normal * sin**2 + tangent * cos**2
    return np.stack([size * xx, size * yy]), size * (normal - tangent) * cos * sin


def unresolved_film(body: Body, dx: Metre) -> tuple[float, Ratio]:
    """Compliance of a body's films [m/Pa] and the share that the cells see as a film in series.

    Films thinner than a cell respond as one does, and need its rules at the row ends: without them the
    sticking slope is up to 0.8 cells too high, 0.2 on average over the cuts; with them 0.4 and 0.1 (the
    average is measured in the tests).
    """
    h = sum(layer.thickness for layer in body.layers)
    if h == 0.0:
        return 0.0, 0.0
    k = 1e-4 / h
    excess = (flexibility(body, np.array([k])) - half_space_flexibility(body.base)[:, None])[[0, 3], 0] / k
    return float(max(excess.min(), 0.0)), 1.0 / (1.0 + (h / (THIN * dx)) ** 2)


def spectrum(table: Array, padded: tuple[int, int]) -> Complex:
    """Transform of influence tables xx, yy, xy or zz for circular convolution, shape (table, y, x)."""
    tables, rows, width = table.shape
    columns = (width + 1) // 2
    odd = np.array([1.0, 1.0, -1.0])[:tables, None, None]  # xy
    circular = np.zeros((tables, *padded))
    offsets = np.arange(1 - columns, columns) % padded[1]
    circular[:, :rows, offsets] = table
    circular[:, padded[0] - rows + 1 :, offsets] = odd * table[:, :0:-1]
    return np.asarray(scipy.fft.rfft2(circular, workers=1), dtype=np.complex128)


def series_film(fraction: Array, compliance: Array, thin: float) -> tuple[Array, Array]:
    """Diagonal and upstream factor of films in series, shape (row, column) each [m/Pa].

    U = L p, whole cells: L and -L. At a cut entry cell the diagonal is 2 L/f^2 and its downstream neighbour
    takes -L (2 f - 1)/f^2; a cut exit cell has 2 L/(f (1 + f)) and -2 L/(1 + f): so the ramp of tractions of
    a film alone is exact. `thin` is the compliance of true layers that take these rules too: the influence
    has the whole cells' share of it, which is taken off.
    """
    active = fraction > 0.0
    L, f = np.where(active, compliance + thin, 0.0), np.where(active, fraction, 1.0)
    after, before = np.zeros_like(active), np.zeros_like(active)  # active neighbours upstream and downstream
    after[:, :-1], before[:, 1:] = active[:, 1:], active[:, :-1]
    entry, exit_ = active & ~after, active & ~before & after
    diagonal = np.where(entry, 2.0 * L / f**2, np.where(exit_, 2.0 * L / (f * (1.0 + f)), L))
    feeds = np.where(entry, L * (2.0 * f - 1.0) / f**2, L)  # what a cell takes off its downstream neighbour
    upstream = np.zeros_like(L)
    upstream[:, :-1] = -feeds[:, 1:] * active[:, :-1]
    upstream[exit_] *= (2.0 / (1.0 + f))[exit_]
    return diagonal - thin * active, upstream + thin * (after & active)


def _row_compliance(compliance: Array, fraction: Array) -> Array:
    """Mean compliance of each row, rounded to a few values: it serves the preconditioner only."""
    weight = np.maximum(fraction.sum(axis=1), 1e-300)
    mean = (compliance * fraction).sum(axis=1) / weight
    logarithm, step = np.log(np.maximum(mean, 1e-300)), 0.2
    while np.unique(np.round(logarithm / step)).size > LARGEST_KINDS:
        step *= 2.0
    return np.asarray(np.where(mean > 0.0, np.exp(step * np.round(logarithm / step)), 0.0))


def product(op: Operator, traction: Array) -> Array:
    """Slip times dx that tractions cause, shape (2, row, column) [m]."""
    waves = scipy.fft.rfft2(traction, s=op.padded, workers=1)
    multiply(waves, op.spectra)
    displaced = scipy.fft.irfft2(waves, s=op.padded, overwrite_x=True, workers=1)
    return with_local(displaced, traction, op.local, op.cross, op.upstream)


@kernel
def multiply(waves: Complex, spectra: Complex) -> None:
    """Product of tractions with the influence, in place, wavenumber by wavenumber."""
    _, rows, columns = waves.shape
    for j in range(rows):
        for i in range(columns):
            x, y = waves[0, j, i], waves[1, j, i]
            waves[0, j, i] = spectra[0, j, i] * x + spectra[2, j, i] * y
            waves[1, j, i] = spectra[2, j, i] * x + spectra[1, j, i] * y


@kernel
def with_local(displaced: Array, traction: Array, local: Array, cross: Array, upstream: Array) -> Array:
    """Corner of the padded product, with the terms of cut cells and films; shape (2, row, column)."""
    _, rows, columns = traction.shape
    total = np.empty_like(traction)
    for c in range(2):
        for j in range(rows):
            for i in range(columns):
                total[c, j, i] = displaced[c, j, i] + local[c, j, i] * traction[c, j, i]
                total[c, j, i] += cross[j, i] * traction[1 - c, j, i]
            for i in range(columns - 1):
                total[c, j, i] += upstream[j, i] * traction[c, j, i + 1]
    return total
