"""Bound of the tractions and compliance of the film over a contact, also of a worn track."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.chain.traction.exact.grid import GAUSS_NODES, GAUSS_WEIGHTS, Grid
from separatrix.errors import InputError
from separatrix.units import Array, Metre, Pascal, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A quantity across the groove: linear between the places y, constant beyond them.

    Two equal places make a step.
    """

    across: tuple[Metre, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        y, values = np.array(self.across), np.array(self.values)
        if (
            y.size == 0
            or y.shape != values.shape
            or not np.isfinite([y, values]).all()
            or (np.diff(y) < 0.0).any()
        ):
            raise InputError(
                "Profile.across", "must be finite, in increasing order, one place for each value"
            )
        if (values < 0.0).any():
            raise InputError("Profile.values", "must be >= 0", f"{values.min():g}")

    def row_means(self, grid: Grid) -> Array:
        """Mean over each row of a grid, shape (row, 1)."""
        y = grid.y[:, None] + 0.5 * grid.dy * GAUSS_NODES
        values = np.interp(y, self.across, self.values)
        return np.asarray(0.5 * (values * GAUSS_WEIGHTS).sum(axis=1, keepdims=True))


def worn_band(half_width: Metre, *, worn: float, film: float) -> Profile:
    """Profile of a film that is worn off over |y| < half_width."""
    w = half_width
    return Profile(across=(-w, -w, w, w), values=(film, worn, worn, film))


def over_cells(quantity: float | Profile, grid: Grid) -> Array:
    """Value in each cell, shape (row, column)."""
    rows = quantity.row_means(grid) if isinstance(quantity, Profile) else np.full((grid.y.size, 1), quantity)
    return np.asarray(np.broadcast_to(rows, grid.shape))


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionLaw:
    """Largest traction g = min(cohesion + coefficient p, shear_strength).

    Cohesion and a coefficient describe solid lubricants under high pressure; the coefficient may vary across
    the groove.
    """

    coefficient: Ratio | Profile
    cohesion: Pascal = 0.0
    shear_strength: Pascal = math.inf

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


LIGHTEST = 1e-6  # of the largest pressure, below which asperities do not soften further


def rough_compliance(grid: Grid, pressure: Array, roughness: Metre) -> Array:
    """Compliance L = l/p of asperities, p the local pressure inside a cell, shape (row, column) [m/Pa].

    Their stiffness rises linearly with the pressure (Campana, Persson & Mueser 2011). At the edge L has no
    limit, but neither traction nor bound: below a millionth of the largest pressure L is that of a millionth.
    """
    f = grid.fraction
    local = pressure / np.where(f > 0.0, f, 1.0)
    return np.where(f > 0.0, roughness / np.maximum(local, LIGHTEST * local.max()), 0.0)
