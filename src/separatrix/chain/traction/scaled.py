"""One contact in units of its saturation creep: what the kernels take, and slopes with their error."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from separatrix.chain.creep import Creep
from separatrix.chain.hertz import ContactEllipse
from separatrix.chain.traction.ellipse import (
    GAUSS_NODES,
    GAUSS_WEIGHTS,
    LEVELS,
    Table,
    free_rolling,
    resultant,
)
from separatrix.chain.traction.layer import BondedLayer, layer_tables
from separatrix.chain.traction.master import MasterTable, film_tables, master_traction
from separatrix.compiled import kernel
from separatrix.units import Array, Ratio

NODES = (200, 400, 800)  # elements a strip of the coarser of two solutions; the finer one has twice as many
INTERPOLATION = (
    3e-4  # largest relative error of a slope by the interpolation of the tables (measured in the tests)
)
RIGID = 1e-9  # saturation creep over the largest creep that stands for the limit of no friction

Tables = Callable[[int], tuple[MasterTable, MasterTable]]


@dataclass(frozen=True, slots=True)
class ScaledContact:
    """Spin sigma = s a/xi_s, Heathcote eta = q a^2/xi_s, film lam = L E*/b; xi_s = 2 mu p0/E*.

    Under a bonded layer `lam` is h/b. `steepness` is mu/xi_s; `idle` says that nothing is transmitted: no
    friction or no load.
    """

    sigma: Ratio
    eta: Ratio
    lam: Ratio
    saturation: Ratio
    steepness: Ratio
    idle: bool
    tables: Tables

    def reach(self, table: MasterTable) -> Ratio:
        """Creep over xi_s at which the tangent at the origin would saturate the middle strip [-]."""
        return 2.0 / master_traction(0.0, self.lam, table.values, table.log_scale, table.axis)[1]

    def offset(self, table: MasterTable) -> Ratio:
        """Offset of free rolling over the saturation creep [-]."""
        return free_rolling(*self._arguments(table, 1))

    def slope(self, table: MasterTable, offset: Ratio, splits: int = 1) -> Ratio:
        """Slope alpha = dC_T/dxi at an offset; `splits` cuts every panel of strips into as many [-]."""
        return self.steepness * resultant(offset, *self._arguments(table, splits))[1]

    def forces(self, offsets: Array, table: MasterTable) -> Array:
        """Traction over mu N at every offset, shape (case,) [-]."""
        return _forces(offsets, *self._arguments(table, 1))

    def increments(self, table: MasterTable) -> Array:
        """41 creep increments from saturation to saturation, shape (case,) [-]."""
        span = self.saturation * (2.5 * self.reach(table) + 1.5 * (abs(self.sigma) + abs(self.eta)))
        return np.linspace(-span, span, 41)

    def refined_slope(self, tolerance: Ratio) -> tuple[Ratio, Ratio, int]:
        """Slope at the origin, its error and the coarser number of elements; refined down to the tolerance.

        The error adds what the last halving of the elements and of the strips changed, and the
        interpolation's share.
        """
        slope, error, nodes = 0.0, math.inf, 0
        for nodes in NODES:
            best, fine = self.tables(nodes)
            offset = self.offset(best)
            slope = self.slope(best, offset, splits=2)
            error = abs(slope - self.slope(best, offset)) + INTERPOLATION * slope
            error += abs(slope - self.slope(fine, self.offset(fine)))
            if error <= tolerance * slope:
                break
        return slope, error, nodes

    def _arguments(
        self, table: MasterTable, splits: int
    ) -> tuple[float, float, float, Array, int, tuple[Array, Array], Table]:
        levels = LEVELS[:2] if self.lam == 0.0 else LEVELS * self.reach(table)
        contents = (table.values, table.log_scale, table.axis)
        return self.sigma, self.eta, self.lam, levels, splits, (GAUSS_NODES, GAUSS_WEIGHTS), contents


def scaled_contact(
    ellipse: ContactEllipse, creep: Creep, friction: Ratio, compliance: float, layer: BondedLayer | None
) -> ScaledContact:
    """Dimensionless form of one contact; a layer takes the place of the compliance."""
    a, b, p0, E = ellipse.semi_major, ellipse.semi_minor, ellipse.max_pressure, ellipse.contact_modulus
    largest = max(abs(creep.spin) * a, abs(creep.curvature) * a * a)
    idle = friction == 0.0 or p0 == 0.0
    saturation = (RIGID * largest or RIGID) if idle else 2.0 * friction * p0 / E
    lam, tables = _film(b, E, compliance, None if idle else layer)
    return ScaledContact(
        sigma=creep.spin * a / saturation,
        eta=creep.curvature * a * a / saturation,
        lam=0.0 if idle else lam,
        saturation=saturation,
        steepness=0.0 if idle else 0.5 * E / p0,
        idle=idle,
        tables=tables,
    )


def _film(
    semi_minor: float, modulus: float, compliance: float, layer: BondedLayer | None
) -> tuple[Ratio, Tables]:
    if layer is None:
        return (compliance * modulus / semi_minor if semi_minor > 0.0 else 0.0), film_tables
    bonded, ratio = layer, layer.thickness / semi_minor

    def tables(nodes: int) -> tuple[MasterTable, MasterTable]:
        return layer_tables(bonded, ratio, nodes)

    return ratio, tables


@kernel
def _forces(
    offsets: Array,
    sigma: float,
    eta: float,
    lam: float,
    levels: Array,
    splits: int,
    gauss: tuple[Array, Array],
    table: Table,
) -> Array:
    """Resultant over mu N at every offset, shape (case,) [-]."""
    forces = np.empty(offsets.size)
    for i in range(offsets.size):
        forces[i] = resultant(offsets[i], sigma, eta, lam, levels, splits, gauss, table)[0]
    return forces
