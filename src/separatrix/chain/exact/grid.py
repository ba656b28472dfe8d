r"""Cells of a contact: uniform, x along rolling (particles enter at the largest x), y across the groove.

Arrays are of shape (row, column): a row is a strip along rolling. The outline cuts the cells at the row ends;
`fraction` is the share of a cell's length inside. The unknown of a cut cell is its force over the area of the
whole cell.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array, Metre, Pascal

MEAN_SHAPE = 0.72  # mean over largest pressure of a row, between pi/4 of Hertz and 2/3 of a thin soft film
CELLS = 40  # columns, and rows, of a contact that is not longer than wide
LONGEST = 8.0  # length over width up to which the numbers of columns and rows change (measured in the tests)
SHORTEST_ROW = 6  # cells of a row from which its pressure tells its ends
LENGTH_HALVINGS, END_HALVINGS = 20, 24  # leave 1e-5 of the logarithm of the length, 1e-7 cells of the end
SMALLEST_FRACTION = 1e-3  # of a cell's length; cells with less inside are left out
GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """Cell centres along x and y and the share of each cell inside the contact."""

    x: Annotated[Array, "m", ("column",)]
    y: Annotated[Array, "m", ("row",)]
    dx: Metre
    dy: Metre
    fraction: Annotated[Array, "-", ("row", "column")]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.y.size, self.x.size

    @property
    def cell_area(self) -> float:
        """Area of a whole cell [m2]."""
        return self.dx * self.dy


def cell_counts(
    columns: int | None, rows: int | None, *, semi_minor: Metre, semi_major: Metre
) -> tuple[int, int]:
    """Columns and rows as given, or of 1600 cells.

    These are 40 x 40. In a contact longer than wide the columns are 40 times length over width to the power
    1/3: columns resolve its ends, rows its sides. Their errors in the spin moment have opposite signs, and
    with these numbers nearly the same size.
    """
    ratio = min(max(semi_minor / semi_major, 1.0), LONGEST)
    usual = round(CELLS * ratio ** (1.0 / 3.0))
    return usual if columns is None else columns, round(CELLS**2 / usual) if rows is None else rows


def elliptic_grid(*, semi_minor: Metre, semi_major: Metre, columns: int, rows: int) -> Grid:
    """Grid over the box of an ellipse: `semi_minor` along rolling, `semi_major` across."""
    b, a = semi_minor, semi_major
    edges = np.linspace(-1.0, 1.0, rows + 1)
    half_lengths = b * np.diff(_circle_area(edges)) * 0.5 * rows
    x, dx = _centres(b, columns)
    y, dy = _centres(a, rows)
    return Grid(x=x, y=y, dx=dx, dy=dy, fraction=_inside(x, dx, -half_lengths, half_lengths))


def _centres(half_length: Metre, count: int) -> tuple[Array, Metre]:
    width = 2.0 * half_length / count
    return width * np.arange(0.5 - 0.5 * count, 0.5 * count), width


def _circle_area(u: Array) -> Array:
    """Integral of sqrt(1 - u^2) from 0 to u, |u| <= 1 [-]."""
    return 0.5 * (u * np.sqrt(np.maximum(1.0 - u * u, 0.0)) + np.arcsin(np.clip(u, -1.0, 1.0)))


def _inside(x: Array, dx: Metre, low: Array, high: Array) -> Array:
    """Share of each cell's length between the ends low and high of its row, shape (row, column) [-]."""
    right, left = np.minimum(x + 0.5 * dx, high[:, None]), np.maximum(x - 0.5 * dx, low[:, None])
    share = np.clip((right - left) / dx, 0.0, 1.0)
    return np.where(share > SMALLEST_FRACTION, share, 0.0)


def end_normals(grid: Grid) -> tuple[Array, Array]:
    """Cosine and sine between rolling and the normal of the outline, shape (row, column) [-].

    A cell takes the end of its row on its side. The outline is the chord across a row, between the means of
    its end and those of its neighbours; the outermost rows end in a point.
    """
    inside = np.maximum(grid.fraction.sum(axis=1), SMALLEST_FRACTION)
    middle, half = grid.fraction @ grid.x / inside, 0.5 * grid.dx * inside
    ends = np.stack([middle - half, middle + half])
    between = 0.5 * (ends[:, 1:] + ends[:, :-1])
    first, last = np.full((2, 1), middle[0]), np.full((2, 1), middle[-1])
    left, right = np.diff(np.concatenate([first, between, last], axis=1), axis=1) / grid.dy
    slope = np.where(grid.x > middle[:, None], right[:, None], left[:, None])
    cos = 1.0 / np.sqrt(1.0 + slope**2)
    return cos, -slope * cos


def elliptic_pressure(grid: Grid, *, semi_minor: Metre, semi_major: Metre, max_pressure: Pascal) -> Array:
    """Hertz pressure averaged over whole cells, shape (row, column) [Pa]; its load is exact."""
    b, a, p0 = semi_minor, semi_major, max_pressure
    edges = np.append(grid.x - 0.5 * grid.dx, grid.x[-1] + 0.5 * grid.dx) / b
    mean = np.zeros(grid.shape)
    for node, weight in zip(GAUSS_NODES, GAUSS_WEIGHTS, strict=True):
        half_length = np.sqrt(np.maximum(1.0 - ((grid.y + 0.5 * node * grid.dy) / a) ** 2, 1e-30))[:, None]
        mean += 0.5 * weight * half_length**2 * np.diff(_circle_area(np.clip(edges / half_length, -1.0, 1.0)))
    mean[grid.fraction == 0.0] = 0.0
    return np.asarray(mean * (2.0 / 3.0 * math.pi * a * b * p0 / (mean.sum() * grid.cell_area)))


def pressed_grid(
    x: Array, y: Array, pressure: Array, refined: int = 1, *, row_width: Metre = 0.0
) -> tuple[Grid, Array]:
    """Grid of any one patch of contact, cropped to it, with its pressure, shape (row, column) [Pa].

    A single row, of a contact in the plane, needs its width.

    Each cell is made of `refined` x `refined` cells of the pressure. Towards the end of a row of these the
    pressure falls with the root of the distance d, under a soft film with d itself over a length l: the end
    and l are those of d/sqrt(d + l) with the forces on the outer cells. Rows of fewer than six cells have the
    length that their mean pressure gives.
    """
    n, fine = refined, float(x[1] - x[0])
    ends = row_ends(x, pressure)
    blocks = pressure.reshape(y.size // n, n, x.size // n, n)
    x, y, p = x.reshape(-1, n).mean(axis=1), y.reshape(-1, n).mean(axis=1), blocks.mean(axis=(1, 3))
    shares = _inside(x, n * fine, ends[:, 0], ends[:, 1]).reshape(y.size, n, x.size).mean(axis=1)
    fraction = np.where((p > 0.0) & (shares > SMALLEST_FRACTION), shares, 0.0)
    rows, columns = (np.flatnonzero((fraction > 0.0).any(axis=axis)) for axis in (1, 0))
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    dx, dy = float(x[1] - x[0]), float(y[1] - y[0]) if y.size > 1 else row_width
    kept = np.where(fraction > 0.0, p, 0.0)[window]
    grid = Grid(x=x[window[1]], y=y[window[0]], dx=dx, dy=dy, fraction=fraction[window])
    return grid, kept * (p.sum() / kept.sum())


def row_ends(x: Array, pressure: Array) -> Array:
    """First and last end of the contact in each row of cells at x, shape (row, 2) [m]."""
    (rows, columns), dx, touched = pressure.shape, x[1] - x[0], pressure > 0.0
    first, last = touched.argmax(axis=1), columns - 1 - touched[:, ::-1].argmax(axis=1)
    ends = np.zeros((rows, 2))
    for j in np.flatnonzero(touched.any(axis=1)):
        p, i, k = pressure[j], first[j], last[j]
        if k - i >= SHORTEST_ROW - 1:
            ends[j, 0] = x[i] + dx * (1.5 - _reach(p[i] + p[i + 1], p[i + 2], p[i + 3]))
            ends[j, 1] = x[k] - dx * (1.5 - _reach(p[k] + p[k - 1], p[k - 2], p[k - 3]))
            continue
        half, middle = 0.5 * dx * p.sum() / (MEAN_SHAPE * p.max()), (x * p).sum() / p.sum()
        ends[j] = max(middle - half, x[i] - 0.5 * dx), min(middle + half, x[k] + 0.5 * dx)
    return ends


@kernel
def _reach(outer: float, middle: float, inner: float) -> float:
    """Cells from the inner edge of the two outer cells to the end, by d/sqrt(d + l).

    The forces on the two outer cells, the next one and the one after decide end and l. The end is inside the
    outermost cell or beyond it, but not beyond the middle of the next, which does not touch.
    """
    low, high, end = -4.0, 4.0, 0.0  # logarithm of l, in cells
    for _ in range(LENGTH_HALVINGS + 1):
        length = 10.0 ** (0.5 * (low + high))
        below, above = 1.0, 2.5  # the end at which the cell beyond it takes the ratio of forces
        for _ in range(END_HALVINGS):
            end = 0.5 * (below + above)
            force = _edge_force(end, length)
            if _edge_force(end + 1.0, length) - force > middle / outer * force:
                below = end
            else:
                above = end
        end = 0.5 * (below + above)
        met = _edge_force(end + 2.0, length) - _edge_force(end + 1.0, length)
        if met * outer < inner * _edge_force(end, length):
            low = 0.5 * (low + high)
        else:
            high = 0.5 * (low + high)
    return end


@part
def _edge_force(d: float, length: float) -> float:
    """Integral of d/sqrt(d + l) from the end to d, times 3/2."""
    root, corner = math.sqrt(d + length), math.sqrt(length)
    return (d / (root + corner)) ** 2 * (root + 2.0 * corner)
