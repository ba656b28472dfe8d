r"""Stick and slip of one contact: reduced semi-smooth Newton with a line search.

With z = p - c S, c = 1/A_ii, Coulomb's law is p = Proj(z), the projection on the disc of the bound g. Where
|z| <= g the cell sticks, else it slips along n = z/|z|. One pass

1. puts slipping cells on the bound, p = g n;
2. solves for both components in stick and the turn along t in slip (`krylov`);
3. takes p + v in stick and g (n cos th + t sin th), th = t.v/g, in slip;
4. goes the part 1, 1/2 ... 1/16 of that way that makes |p - Proj(p - c S)| fall by a tenth of the part;
5. stops where |p - Proj(p - c S)| <= tolerance |p|.

This is Newton's method on p - Proj(p - c S) with the slipping cells kept on their circles. |p| and not the
bound is the measure, since tractions may be far below it.

The bound is that of the cells of a contact, also of a worn track.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.chain.exact.grid import GAUSS_NODES, GAUSS_WEIGHTS, Grid
from separatrix.chain.exact.krylov import Sets, right_side, solve_step
from separatrix.chain.exact.operator import Operator, product
from separatrix.chain.exact.precondition import OUTSIDE, SLIP, STICK, States
from separatrix.chain.film_compliance import Profile
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, Pascal, Ratio

LIGHTEST = 1e-6  # of the largest pressure, below which asperities do not soften further


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


TOLERANCE = 1e-5  # of the tractions: forces are then right to about 1e-6
LINEAR = 0.05  # relative tolerance of a linear step
LARGEST_PASSES = 100
SHORTEST = 1.0 / 16.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Settled:
    """Tractions [Pa] and slip times dx [m], shape (2, row, column), with their stick and slip cells."""

    traction: Array
    slip_step: Array
    sets: Sets
    residual: Ratio
    passes: int
    products: int


def settle(
    op: Operator,
    bound: Array,
    driving: Array,
    *,
    start: Array | None = None,
    tolerance: Ratio = TOLERANCE,
    linear: Ratio = LINEAR,
) -> Settled:
    """Tractions under the bound g, shape (row, column) [Pa], and the rigid slip times dx [m].

    Raises
    ------
    ConvergenceError
        The residual is above the tolerance after 100 passes.
    """
    c = np.where(op.active, 2.0 / (op.diagonal[0] + op.diagonal[1]), 0.0)
    g = np.where(op.active, bound, 0.0)
    p = np.zeros_like(driving) if start is None else clipped(start, g)
    S = driving + product(op, p)
    products = 1
    for passes in range(LARGEST_PASSES + 1):
        state, normal, turn, jump, residual, size, moved = classify(p, S, c, g)
        if residual <= tolerance * size:
            sets = Sets(state, normal, turn)
            ratio = residual / size if size > 0.0 else 0.0
            return Settled(
                traction=p, slip_step=S, sets=sets, residual=ratio, passes=passes, products=products
            )
        onto_bound = S
        if moved > 0.0:
            onto_bound = S + product(op, jump)
        sets = Sets(state, normal, turn)
        accuracy = max(linear, 0.3 * tolerance * size / residual)
        v, taken = solve_step(op, sets, right_side(onto_bound, state, normal), accuracy)
        step = turned(p, v, state, normal, g)
        change = product(op, step)
        line_search(p, S, step, change, c, g, residual)
        products += taken + 1 + (moved > 0.0)
    raise ConvergenceError(
        f"Rolling contact: tractions did not settle in {LARGEST_PASSES} passes (residual "
        f"{residual / size:.2g}, limit {tolerance:g}).",
        LARGEST_PASSES,
        residual / size,
    )


@kernel
def clipped(p: Array, g: Array) -> Array:
    """Projection of tractions on the discs of the bound."""
    result = np.empty_like(p)
    for j in range(g.shape[0]):
        for i in range(g.shape[1]):
            result[0, j, i], result[1, j, i] = _projected(p[0, j, i], p[1, j, i], g[j, i])
    return result


@part
def _projected(x: float, y: float, g: float) -> tuple[float, float]:
    length = math.sqrt(x * x + y * y)
    if length <= g:
        return x, y
    return g * x / length, g * y / length


@kernel
def classify(
    p: Array, S: Array, c: Array, g: Array
) -> tuple[States, Array, Array, Array, float, float, float]:
    """State, normal n and turn d of each cell, jump onto the bound; |p - Proj(z)|, |p| and |jump|."""
    _, ny, nx = p.shape
    state = np.full((ny, nx), OUTSIDE, dtype=np.int8)
    normal, jump, turn = np.zeros_like(p), np.zeros_like(p), np.zeros((ny, nx))
    residual, size, moved = 0.0, 0.0, 0.0
    for j in range(ny):
        for i in range(nx):
            if g[j, i] <= 0.0:
                continue
            x, y = p[0, j, i], p[1, j, i]
            zx, zy = x - c[j, i] * S[0, j, i], y - c[j, i] * S[1, j, i]
            length = math.sqrt(zx * zx + zy * zy)
            size += x * x + y * y
            if length <= g[j, i]:
                state[j, i] = STICK
                residual += (x - zx) ** 2 + (y - zy) ** 2
                continue
            state[j, i] = SLIP
            normal[0, j, i], normal[1, j, i] = zx / length, zy / length
            turn[j, i] = (length - g[j, i]) / (c[j, i] * g[j, i])
            jump[0, j, i], jump[1, j, i] = g[j, i] * zx / length - x, g[j, i] * zy / length - y
            off = jump[0, j, i] ** 2 + jump[1, j, i] ** 2
            residual, moved = residual + off, moved + off
    return state, normal, turn, jump, math.sqrt(residual), math.sqrt(size), math.sqrt(moved)


@kernel
def turned(p: Array, v: Array, state: States, normal: Array, g: Array) -> Array:
    """Whole step: v in stick; in slip from p to the bound, turned by th = t.v/g."""
    step = np.zeros_like(p)
    for j in range(g.shape[0]):
        for i in range(g.shape[1]):
            if state[j, i] == STICK:
                step[0, j, i], step[1, j, i] = v[0, j, i], v[1, j, i]
            elif state[j, i] == SLIP:
                nx, ny = normal[0, j, i], normal[1, j, i]
                angle = (nx * v[1, j, i] - ny * v[0, j, i]) / g[j, i]
                angle = min(max(angle, -1.0), 1.0)
                cosine, sine = math.cos(angle), math.sin(angle)
                step[0, j, i] = g[j, i] * (nx * cosine - ny * sine) - p[0, j, i]
                step[1, j, i] = g[j, i] * (ny * cosine + nx * sine) - p[1, j, i]
    return step


@kernel
def line_search(p: Array, S: Array, step: Array, change: Array, c: Array, g: Array, before: float) -> float:
    """Move p and S in place by the first part of the step that serves, else the shortest; that part."""
    part_ = 1.0
    while part_ > SHORTEST:
        if _residual_at(p, S, step, change, c, g, part_) <= (1.0 - 0.1 * part_) * before:
            break
        part_ *= 0.5
    for n in range(2):
        for j in range(g.shape[0]):
            for i in range(g.shape[1]):
                p[n, j, i] += part_ * step[n, j, i]
                S[n, j, i] += part_ * change[n, j, i]
    return part_


@part
def _residual_at(p: Array, S: Array, step: Array, change: Array, c: Array, g: Array, length: float) -> float:
    """|p - Proj(p - c S)| after a part of the step."""
    total = 0.0
    for j in range(g.shape[0]):
        for i in range(g.shape[1]):
            if g[j, i] > 0.0:
                x, y = p[0, j, i] + length * step[0, j, i], p[1, j, i] + length * step[1, j, i]
                zx = x - c[j, i] * (S[0, j, i] + length * change[0, j, i])
                zy = y - c[j, i] * (S[1, j, i] + length * change[1, j, i])
                px, py = _projected(zx, zy, g[j, i])
                total += (x - px) ** 2 + (y - py) ** 2
    return math.sqrt(total)
