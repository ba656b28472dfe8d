"""Bound of the tractions over the cells of a contact, also of a worn track."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.chain.traction.exact.grid import GAUSS_NODES, GAUSS_WEIGHTS, Grid
from separatrix.chain.traction.profile import Profile
from separatrix.ground.errors import InputError
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
