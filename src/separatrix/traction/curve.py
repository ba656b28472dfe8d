"""Traction coefficient against creep increment, and its slope at the origin (paper, Eqs 2, 14 and 15, Fig. 7)."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np

from separatrix.creep import Creep
from separatrix.errors import InputError, ValidityWarning
from separatrix.hertz import ContactEllipse
from separatrix.study import Film
from separatrix.traction.compiled import kernel
from separatrix.traction.ellipse import GAUSS_NODES, GAUSS_WEIGHTS, LEVELS, Table, free_rolling, resultant
from separatrix.traction.master import MasterTable, film_tables, master_traction
from separatrix.units import Array, Metre, Ratio

NODES = (200, 400, 800)  # elements a strip of the coarser of two solutions; the finer one has twice as many
TOLERANCE = 0.005
RIGID = 1e-9  # saturation creep over the largest creep that stands for the limit of no friction


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionCurve:
    """Traction coefficient of one contact against the creep increment, shape (case,) each [-].

    `slope` is the paper's alpha = dC_T/d(delta xi) at the origin and `slope_error` bounds its numerical error;
    `free_rolling_offset` is the creep on the centre line at which the contact carries no net traction; `nodes` is the finest strip.
    """

    creep_increment: Array
    traction_coefficient: Array
    slope: Ratio
    slope_error: Ratio
    free_rolling_offset: Ratio
    spin_roll_ratio: Ratio
    nodes: int


def film_compliance(film: Film) -> float:
    """Shear compliance L = h/G of the film, total over ball and race [m/Pa]; 0 if the races are bare."""
    if film.material is None or film.thickness is None:
        return 0.0
    return 2.0 * film.thickness * (1.0 + film.material.poisson_ratio) / film.material.elastic_modulus


def traction_curve(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio,
    film_compliance: float,
    creep_increments: Array | None = None,
    film_thickness: Metre = 0.0,
    tolerance: Ratio = TOLERANCE,
) -> TractionCurve:
    r"""Traction coefficient against the creep increment of one ball/race contact.

    Parameters
    ----------
    ellipse : ContactEllipse
        The Hertz contact.
    creep : Creep
        Spin and Heathcote creep of the contact.
    race_friction : float
        Friction f_BT of ball on track, >= 0 [-]. Without friction (or load) traction and slope are exactly 0.
    film_compliance : float
        Shear compliance L = h/G of the film, >= 0 [m/Pa].
    creep_increments : array or None
        Where to compute, shape (case,) [-]; None takes 41 points that span saturation both ways.
    film_thickness : float
        Total thickness of the film [m]; only to say when the film in series is out of its range.
    tolerance : float
        Relative error of the slope above which the strips are refined, up to 1600 elements each [-].

    Returns
    -------
    TractionCurve
        The curve and its slope at the origin.

    Raises
    ------
    InputError
        A negative or non-finite number.

    Warns
    -----
    ValidityWarning
        The film is thicker than 0.03 of the semi-minor axis.

    Notes
    -----
    Paper, Eqs 2, 12-15 and Fig. 7, with the rolling entry condition and the film in series (docs/theory/traction.md).
    Odd in the increment if the creep is pure spin or none; bounded by race_friction.
    """
    _check(race_friction=race_friction, film_compliance=film_compliance, film_thickness=film_thickness)
    _warn_if_thick(film_thickness, ellipse.semi_minor)
    case = _scaled(ellipse, creep, race_friction, film_compliance)
    increments = case.increments() if creep_increments is None else np.asarray(creep_increments, dtype=float)
    ratio = creep.spin / ellipse.curvature_rolling
    if case.idle:
        return TractionCurve(
            creep_increment=increments,
            traction_coefficient=np.zeros_like(increments),
            slope=0.0,
            slope_error=0.0,
            free_rolling_offset=case.offset(film_tables(NODES[0])[0]) * case.saturation,
            spin_roll_ratio=ratio,
            nodes=2 * NODES[0],
        )
    slope, error, nodes = _refined_slope(case, tolerance)
    table = film_tables(nodes)[0]
    offset = case.offset(table)
    return TractionCurve(
        creep_increment=increments,
        traction_coefficient=race_friction * case.forces(offset + increments / case.saturation, table),
        slope=slope,
        slope_error=error,
        free_rolling_offset=offset * case.saturation,
        spin_roll_ratio=ratio,
        nodes=2 * nodes,
    )


def traction_slope(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio,
    film_compliance: float,
    film_thickness: Metre = 0.0,
    tolerance: Ratio = TOLERANCE,
) -> tuple[Ratio, Ratio]:
    """Slope alpha of the traction curve at the origin and a bound of its numerical error; see `traction_curve`."""
    _check(race_friction=race_friction, film_compliance=film_compliance, film_thickness=film_thickness)
    _warn_if_thick(film_thickness, ellipse.semi_minor)
    case = _scaled(ellipse, creep, race_friction, film_compliance)
    return (0.0, 0.0) if case.idle else _refined_slope(case, tolerance)[:2]


@dataclass(frozen=True, slots=True)
class _Scaled:
    """One contact in units of its saturation creep: what the kernels of `ellipse` take."""

    sigma: Ratio
    eta: Ratio
    lam: Ratio
    saturation: Ratio
    steepness: Ratio
    idle: bool

    def levels(self, table: MasterTable) -> Array:
        """Creeps at which panels of strips end: scaled to where this film saturates."""
        if self.lam == 0.0:
            return LEVELS[:2]
        s = 0.5 * master_traction(0.0, self.lam, table.values, table.log_scale, table.axis)[1]
        return LEVELS / s

    def arguments(
        self, table: MasterTable, splits: int
    ) -> tuple[float, float, float, Array, int, tuple[Array, Array], Table]:
        """Arguments of the kernels after the offset."""
        contents = (table.values, table.log_scale, table.axis)
        gauss = (GAUSS_NODES, GAUSS_WEIGHTS)
        return self.sigma, self.eta, self.lam, self.levels(table), splits, gauss, contents

    def offset(self, table: MasterTable) -> Ratio:
        """Offset of free rolling over the saturation creep [-]."""
        return free_rolling(*self.arguments(table, 1))

    def slope(self, table: MasterTable, offset: Ratio, splits: int = 1) -> Ratio:
        """Slope alpha at an offset [-]."""
        return self.steepness * resultant(offset, *self.arguments(table, splits))[1]

    def forces(self, offsets: Array, table: MasterTable) -> Array:
        """Traction over mu N at every offset, shape (case,) [-]."""
        return _forces(offsets, *self.arguments(table, 1))

    def increments(self) -> Array:
        """41 creep increments from saturation to saturation, shape (case,) [-]."""
        span = self.saturation * (1.5 * (1.0 + self.lam) + 2.0 * (abs(self.sigma) + abs(self.eta)))
        return np.linspace(-span, span, 41)


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


def _scaled(ellipse: ContactEllipse, creep: Creep, friction: Ratio, compliance: float) -> _Scaled:
    a, b, p0, E = ellipse.semi_major, ellipse.semi_minor, ellipse.max_pressure, ellipse.contact_modulus
    largest = max(abs(creep.spin) * a, abs(creep.curvature) * a * a)
    idle = friction == 0.0 or p0 == 0.0
    saturation = 2.0 * friction * p0 / E if not idle else (RIGID * largest or RIGID)
    return _Scaled(
        sigma=creep.spin * a / saturation,
        eta=creep.curvature * a * a / saturation,
        lam=compliance * E / b if b > 0.0 and not idle else 0.0,
        saturation=saturation,
        steepness=0.5 * E / p0 if p0 > 0.0 else 0.0,  # mu/xi_s
        idle=idle,
    )


def _refined_slope(case: _Scaled, tolerance: Ratio) -> tuple[Ratio, Ratio, int]:
    """Slope, its error and the coarser number of elements, refined until the error meets the tolerance."""
    slope, error = 0.0, math.inf
    for nodes in NODES:
        best, fine = film_tables(nodes)
        offset = case.offset(best)
        slope = case.slope(best, offset, splits=2)
        placement = abs(slope - case.slope(best, offset))
        error = placement + abs(slope - case.slope(fine, case.offset(fine)))
        if error <= tolerance * slope:
            break
    return slope, error, nodes


def _check(**values: float) -> None:
    for name, value in values.items():
        if not 0.0 <= value < math.inf:
            unit = {"race_friction": "-", "film_compliance": "m/Pa", "film_thickness": "m"}[name]
            raise InputError(f"traction_curve: {name}", "must be finite and >= 0", unit, f"{value:g}")


def _warn_if_thick(thickness: Metre, semi_minor: Metre) -> None:
    if thickness > 0.03 * semi_minor > 0.0:
        warnings.warn(
            f"film of {thickness:g} m is {thickness / semi_minor:.3g} of the semi-minor axis: a film in series with the half-planes "
            "holds up to 0.03 (docs/theory/traction.md); the exact bonded layer is an option.",
            ValidityWarning,
            stacklevel=3,
        )
