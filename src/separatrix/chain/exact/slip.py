r"""Stick and slip of one contact: reduced semi-smooth Newton with a line search.

With z = p - c S, c = 1/A_ii, Coulomb's law is p = Proj(z), the projection on the disc of the bound g. Where
|z| <= g the cell sticks, else it slips along n = z/|z|. One pass

1. puts slipping cells on the bound, p = g n;
2. solves for both components in stick and the turn along the tangent t in slip, which is the azimuth of Zhao,
   Vollebregt & Oosterlee (2014): stick (A v)_i = -S_i, slip t.(A v)_i + d_i t.v_i = -t.S_i;
3. takes p + v in stick and g (n cos th + t sin th), th = t.v/g, in slip;
4. goes the part 1, 1/2 ... 1/16 of that way that makes |p - Proj(p - c S)| fall by a tenth of the part;
5. stops where |p - Proj(p - c S)| <= tolerance |p|.

This is Newton's method on p - Proj(p - c S) with the slipping cells kept on their circles. |p| and not the
bound is the measure, since tractions may be far below it.

The linear step is solved by generalised conjugate residuals (Eisenstat, Elman & Schultz 1983), the iterates
of GMRES without its triangle. The preconditioner is an approximate inverse row by row: a run of m sticking
cells takes the inverse of the leading m x m block of the row's Toeplitz matrix, a run of slipping cells the
banded LU of its turns along the tangents; cut cells take their diagonal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from separatrix.chain.exact.grid import GAUSS_NODES, GAUSS_WEIGHTS, Grid
from separatrix.chain.exact.operator import Flags, Indices, Operator, product
from separatrix.chain.film_compliance import Profile
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, Pascal, Ratio

States = NDArray[np.int8]
OUTSIDE, STICK, SLIP = 0, 1, 2
LIGHTEST = 1e-6  # of the largest pressure, below which asperities do not soften further
TOLERANCE = 1e-5  # of the tractions: forces are then right to about 1e-6
LINEAR = 0.05  # relative tolerance of a linear step
LARGEST_PASSES = 100
SHORTEST = 1.0 / 16.0  # part of a step
LARGEST_SPACE = 80  # vectors of the Krylov space; 3 to 12 are usual
BAND = 4  # half width of the banded matrices of slipping runs


def over_cells(quantity: float | Profile, grid: Grid) -> Array:
    """Mean of a quantity in each cell, shape (row, column)."""
    if not isinstance(quantity, Profile):
        return np.full(grid.shape, quantity)
    values = quantity.at(grid.y[:, None] + 0.5 * grid.dy * GAUSS_NODES)
    means = 0.5 * (values * GAUSS_WEIGHTS).sum(axis=1, keepdims=True)
    return np.asarray(np.broadcast_to(means, grid.shape))


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionLaw:
    """Largest traction g = min(cohesion + coefficient p, shear_strength).

    Cohesion and a coefficient describe solid lubricants under high pressure; the coefficient may vary across
    the groove.
    """

    coefficient: Ratio | Profile  # of friction; a profile varies across the groove
    cohesion: Pascal = 0.0  # largest traction without pressure
    shear_strength: Pascal = math.inf  # that no pressure exceeds

    def __post_init__(self) -> None:
        mu = self.coefficient
        if not isinstance(mu, Profile) and not 0.0 <= mu < math.inf:
            raise InputError("FrictionLaw.coefficient", "must be finite and >= 0 [-]", f"{mu:g}")
        if not 0.0 <= self.cohesion < math.inf:
            raise InputError("FrictionLaw.cohesion", "must be finite and >= 0 [Pa]", f"{self.cohesion:g}")
        if not self.shear_strength > 0.0:
            raise InputError("FrictionLaw.shear_strength", "must be > 0 [Pa]", f"{self.shear_strength:g}")

    def bound(self, grid: Grid, pressure: Array) -> Array:
        """Bound g of each cell from the pressure on it, shape (row, column) [Pa]; 0 outside."""
        inside = grid.fraction > 0.0
        rising = self.cohesion * grid.fraction + over_cells(self.coefficient, grid) * pressure
        strength = self.shear_strength * np.where(inside, grid.fraction, 1.0)
        return np.where(inside, np.minimum(rising, strength), 0.0)


def rough_compliance(grid: Grid, pressure: Array, roughness: Metre) -> Array:
    """Compliance L = l/p of asperities, p the local pressure inside a cell, shape (row, column) [m/Pa].

    Their stiffness rises linearly with the pressure (Campana, Persson & Mueser 2011). At the edge L has no
    limit, but neither traction nor bound: below a millionth of the largest pressure L is that of a millionth.
    """
    f = grid.fraction
    local = pressure / np.where(f > 0.0, f, 1.0)
    return np.where(f > 0.0, roughness / np.maximum(local, LIGHTEST * local.max()), 0.0)


@dataclass(frozen=True, slots=True)
class Sets:
    """Stick and slip: state and turn d, shape (row, column), and normal n = z/|z|, shape (2, row, column)."""

    state: States
    normal: Array
    turn: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Settled:
    """Tractions [Pa] and slip times dx [m], shape (2, row, column), with their stick and slip cells."""

    traction: Array
    slip_step: Array
    sets: Sets
    residual: Ratio
    passes: int


def settle(
    op: Operator,
    bound: Array,
    driving: Array,
    *,
    start: Array | None = None,
    tolerance: Ratio = TOLERANCE,
) -> Settled:
    """Tractions under the bound g, shape (row, column) [Pa], and the rigid slip times dx [m].

    Raises
    ------
    ConvergenceError
        The residual is above the tolerance after 100 passes.
    """
    c = np.where(op.active, 2.0 / (op.diagonal[0] + op.diagonal[1]), 0.0)
    g = np.where(op.active, bound, 0.0)
    p = np.zeros_like(driving) if start is None else _projected(start, g)
    S = driving + product(op, p)
    for passes in range(LARGEST_PASSES + 1):
        state, normal, turn, jump, residual = classified(p, S, c, g)
        sets, size = Sets(state, normal, turn), _norm(p)
        if residual <= tolerance * size:
            ratio = residual / size if size > 0.0 else 0.0
            return Settled(traction=p, slip_step=S, sets=sets, residual=ratio, passes=passes)
        onto_bound = S + product(op, jump) if jump.any() else S
        right = -equations(onto_bound, np.zeros_like(p), state, normal, turn)
        v = solve_step(op, sets, right, max(LINEAR, 0.3 * tolerance * size / residual))
        slips, (x, y) = state == SLIP, normal
        angle = np.clip((x * v[1] - y * v[0]) / np.where(slips, g, 1.0), -1.0, 1.0)
        cosine, sine = g * np.cos(angle), g * np.sin(angle)
        step = np.where(slips, np.stack([x * cosine - y * sine, y * cosine + x * sine]) - p, v)
        change = product(op, step)
        part_ = 1.0
        while part_ > SHORTEST:
            q = p + part_ * step
            if _norm(q - _projected(q - c * (S + part_ * change), g)) <= (1.0 - 0.1 * part_) * residual:
                break
            part_ *= 0.5
        p, S = p + part_ * step, S + part_ * change
    raise ConvergenceError(
        f"Rolling contact: tractions did not settle in {LARGEST_PASSES} passes (residual "
        f"{residual / size:.2g}, limit {tolerance:g}).",
        LARGEST_PASSES,
        residual / size,
    )


def _projected(z: Array, g: Array) -> Array:
    """Projection on the discs of the bound; 0 outside the contact."""
    length = np.sqrt(z[0] * z[0] + z[1] * z[1])
    return z * np.where(length <= g, g > 0.0, g / np.where(length > 0.0, length, 1.0))


def _norm(p: Array) -> float:
    return float(np.linalg.norm(p))


@kernel
def classified(p: Array, S: Array, c: Array, g: Array) -> tuple[States, Array, Array, Array, float]:
    """State, normal n and turn d of each cell, its jump onto the bound; |p - Proj(p - c S)|."""
    _, ny, nx = p.shape
    state = np.full((ny, nx), OUTSIDE, dtype=np.int8)
    normal, jump, turn, residual = np.zeros_like(p), np.zeros_like(p), np.zeros((ny, nx)), 0.0
    for j in range(ny):
        for i in range(nx):
            if g[j, i] <= 0.0:
                continue
            x, y = c[j, i] * S[0, j, i], c[j, i] * S[1, j, i]
            zx, zy = p[0, j, i] - x, p[1, j, i] - y
            length = math.sqrt(zx * zx + zy * zy)
            state[j, i] = STICK
            if length > g[j, i]:
                state[j, i] = SLIP
                normal[0, j, i], normal[1, j, i] = zx / length, zy / length
                turn[j, i] = (length - g[j, i]) / (c[j, i] * g[j, i])
                x, y = g[j, i] * zx / length - p[0, j, i], g[j, i] * zy / length - p[1, j, i]
                jump[0, j, i], jump[1, j, i] = x, y
            residual += x * x + y * y
    return state, normal, turn, jump, math.sqrt(residual)


def solve_step(op: Operator, sets: Sets, right: Array, tolerance: float) -> Array:
    """Tractions v of one linear step, shape (2, row, column); `tolerance` is relative.

    They are two numbers a cell; the second row of a slipping cell is 0 = 0.
    """
    length = _norm(right)
    if length == 0.0:
        return np.zeros_like(right)
    state, normal, turn = sets.state, sets.normal, sets.turn
    band = slip_factors(state, op.whole, normal, turn, op.rows, op.kind, op.local)
    images, triangle = np.empty((LARGEST_SPACE, right.size)), np.zeros((LARGEST_SPACE + 1, LARGEST_SPACE))
    directions, rest = list[Array](), right.copy()
    for k in range(LARGEST_SPACE):
        v = precondition(rest, state, op.whole, normal, turn, op.diagonal, band, op.inverses, op.kind)
        directions.append(v)
        image = equations(product(op, v), v, state, normal, turn)
        if advance(k, image.ravel(), images, triangle, rest.ravel()) <= tolerance * length:
            break
    taken = len(directions)
    weights = np.linalg.solve(triangle[:taken, :taken], triangle[-1, :taken])
    return np.asarray(np.tensordot(weights, np.stack(directions), axes=1))


@kernel
def advance(k: int, image: Array, images: Array, triangle: Array, rest: Array) -> float:
    """Make an image orthogonal to those before by Gram and Schmidt, take it off the rest; what is left.

    The triangle gets its parts along the images, and in the last row that of the rest along it.
    """
    for n in range(k):
        h = triangle[n, k] = np.dot(images[n], image)
        for i in range(image.size):
            image[i] -= h * images[n, i]
    size = math.sqrt(np.dot(image, image))
    if size == 0.0:  # no way on
        triangle[k, k] = 1.0
        return 0.0
    triangle[k, k], images[k] = size, image / size
    share = triangle[-1, k] = np.dot(images[k], rest)
    for i in range(rest.size):
        rest[i] -= share * images[k, i]
    return math.sqrt(np.dot(rest, rest))


@kernel
def equations(slip: Array, v: Array, state: States, normal: Array, turn: Array) -> Array:
    """Left side of the rows from the slip A v: itself in stick, t.(A v) + d t.v in slip; shape of v."""
    _, ny, nx = slip.shape
    result = np.zeros_like(slip)
    for j in range(ny):
        for i in range(nx):
            if state[j, i] == STICK:
                result[0, j, i], result[1, j, i] = slip[0, j, i], slip[1, j, i]
            elif state[j, i] == SLIP:
                tx, ty, d = -normal[1, j, i], normal[0, j, i], turn[j, i]
                x, y = slip[0, j, i] + d * v[0, j, i], slip[1, j, i] + d * v[1, j, i]
                result[0, j, i] = tx * x + ty * y
    return result


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
