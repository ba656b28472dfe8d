"""Traction coefficient against creep increment; its slope at the origin (paper, Eqs 2, 14, 15, Fig. 7).

A contact is solved in units of its saturation creep.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.chain.creep import Creep
from separatrix.chain.film_profile import Profile, edges_of, ends_of
from separatrix.chain.hertz import ContactEllipse
from separatrix.chain.master_curve import MasterTable, film_tables, master_traction
from separatrix.chain.traction_ellipse import (
    GAUSS_NODES,
    GAUSS_WEIGHTS,
    LAM_HIGH,
    LAM_LOW,
    M_LOW,
    Y_HIGH,
    Y_LOW,
    Table,
    free_rolling,
    resultant,
)
from separatrix.ground.compiled import kernel
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre, Ratio, format_quantity

NODES = (200, 400, 800)  # elements a strip of the coarser of two solutions; the finer one has twice as many
INTERPOLATION = (
    3e-4  # largest relative error of a slope by the interpolation of the tables (measured in the tests)
)
RIGID = 1e-9  # saturation creep over the largest creep that stands for the limit of no friction


@dataclass(frozen=True, slots=True)
class ScaledContact:
    """Spin sigma = s a/xi_s, Heathcote eta = q a^2/xi_s; xi_s = 2 mu p0/E*, mu being the largest friction.

    `pieces` have the film lam0 = L E*/b and the friction over mu, shape (piece, 6): see
    chain/traction/ellipse.py. `steepness` is mu/xi_s; `idle` says that nothing is transmitted: no friction or
    no load.
    """

    sigma: Ratio
    eta: Ratio
    pieces: Array
    friction: Ratio
    saturation: Ratio
    steepness: Ratio
    idle: bool

    def local(self, y: Array) -> tuple[Array, Array]:
        """Film lam0 and friction over mu at y/a, shape of y each [-]."""
        piece = self.pieces[np.searchsorted(self.pieces[1:, Y_LOW], y, side="right")]
        along = (y - piece[:, Y_LOW]) / (piece[:, Y_HIGH] - piece[:, Y_LOW])
        lam, m = (piece[:, low] + (piece[:, low + 1] - piece[:, low]) * along for low in (LAM_LOW, M_LOW))
        return lam, m

    def reached(self, table: MasterTable) -> Array:
        """The pieces with their reach, shape (piece, 7)."""
        films = self.pieces[:, [LAM_LOW, LAM_HIGH]].max(axis=1)
        return np.column_stack([self.pieces, [reach(table, lam) if lam > 0.0 else 0.0 for lam in films]])

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
        farthest = reach(table, float(self.pieces[:, [LAM_LOW, LAM_HIGH]].max()))
        span = self.saturation * (2.5 * farthest + 1.5 * (abs(self.sigma) + abs(self.eta)))
        return np.linspace(-span, span, 41)

    def refined_slope(self, tolerance: Ratio) -> tuple[Ratio, Ratio, int]:
        """Slope at the origin, its error and the coarser number of elements; refined down to the tolerance.

        The error adds what the last halving of the elements and of the strips changed, and the
        interpolation's share.
        """
        slope, error, nodes = 0.0, math.inf, 0
        for nodes in NODES:
            best, fine = film_tables(nodes)
            offset = self.offset(best)
            slope = self.slope(best, offset, splits=2)
            error = abs(slope - self.slope(best, offset)) + INTERPOLATION * slope
            error += abs(slope - self.slope(fine, self.offset(fine)))
            if error <= tolerance * slope:
                break
        return slope, error, nodes

    def _arguments(
        self, table: MasterTable, splits: int
    ) -> tuple[float, float, Array, int, tuple[Array, Array], Table]:
        contents = (table.values, table.log_scale, table.axis)
        return self.sigma, self.eta, self.reached(table), splits, (GAUSS_NODES, GAUSS_WEIGHTS), contents


def reach(table: MasterTable, lam: Ratio) -> Ratio:
    """Creep over xi_s at which the tangent at the origin would saturate a strip under a film [-]."""
    return 2.0 / master_traction(0.0, lam, table.values, table.log_scale, table.axis)[1]


def scaled_contact(
    ellipse: ContactEllipse, creep: Creep, friction: Ratio | Profile, compliance: float | Profile
) -> ScaledContact:
    """Dimensionless form of one contact."""
    a, b, p0, E = ellipse.semi_major, ellipse.semi_minor, ellipse.max_pressure, ellipse.contact_modulus
    spread = max(abs(creep.spin) * a, abs(creep.curvature) * a * a)
    mu = max(friction.values) if isinstance(friction, Profile) else friction
    idle = mu == 0.0 or p0 == 0.0
    saturation = (RIGID * spread or RIGID) if idle else 2.0 * mu * p0 / E
    pieces = np.array([[-1.0, 1.0, 0.0, 0.0, 1.0, 1.0]])
    if not idle:
        edges = edges_of(a, friction, compliance)
        films, shares = ends_of(compliance, edges) * E / b, ends_of(friction, edges) / mu
        pieces = np.column_stack([edges[:-1] / a, edges[1:] / a, films, shares])
    return ScaledContact(
        sigma=creep.spin * a / saturation,
        eta=creep.curvature * a * a / saturation,
        pieces=pieces,
        friction=mu,
        saturation=saturation,
        steepness=0.0 if idle else 0.5 * E / p0,
        idle=idle,
    )


@kernel
def _forces(
    offsets: Array,
    sigma: float,
    eta: float,
    pieces: Array,
    splits: int,
    gauss: tuple[Array, Array],
    table: Table,
) -> Array:
    """Resultant over mu N at every offset, shape (case,) [-]."""
    forces = np.empty(offsets.size)
    for i in range(offsets.size):
        forces[i] = resultant(offsets[i], sigma, eta, pieces, splits, gauss, table)[0]
    return forces


TOLERANCE = 0.005
THIN = 0.03  # film thickness over semi-minor axis up to which the film in series is used without a warning


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionCurve:
    """Traction coefficient of one contact against the creep increment, shape (case,) each [-].

    `slope` is the paper's alpha = dC_T/d(delta xi) at the origin, `slope_error` bounds its numerical error;
    `free_rolling_offset` is the creep on the centre line at which the contact carries no net traction;
    `nodes` counts the elements of the finest strip.
    """

    creep_increment: Annotated[Array, "-", ("increment",)]  # what an impact of the cage adds to the creep
    traction_coefficient: Annotated[Array, "-", ("increment",)]  # T over N, at each increment
    slope: Ratio
    slope_error: Ratio
    free_rolling_offset: Ratio
    spin_roll_ratio: Ratio
    nodes: int  # elements along the finest strip
    notes: tuple[str, ...] = ()  # where the film leaves the range of its model, a sentence each


def traction_curve(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    creep_increments: Array | None = None,
    film_thickness: Metre = 0.0,
    tolerance: Ratio = TOLERANCE,
) -> TractionCurve:
    r"""Traction coefficient against the creep increment of one ball/race contact.

    Positive where the ball is faster than the race: C_T is then the force of the ball on the race along
    rolling, over the load. Without friction, or without load, traction and slope are exactly 0.

    Parameters
    ----------
    ellipse : ContactEllipse
        The Hertz contact.
    creep : Creep
        Spin and Heathcote creep of the contact.
    race_friction : float or Profile
        Friction f_BT of ball on track, >= 0; a profile across the groove of a worn track is > 0 [-].
    film_compliance : float or Profile
        Shear compliance L = h/G of the film in series, >= 0 [m/Pa].
    creep_increments : array or None
        Where to compute, shape (case,) [-]; None takes 41 points that span saturation both ways.
    film_thickness : float
        Total thickness of the film [m]; only to note where the film in series is out of its range.
    tolerance : float
        Relative error of the slope above which strips are refined, from 400 to at most 1600 elements [-].

    Returns
    -------
    TractionCurve
        The curve and its slope at the origin.

    Raises
    ------
    InputError
        A negative or non-finite number.

    Notes
    -----
    Paper, Eqs 2, 12-15 and Fig. 7, with the rolling entry condition (docs/theory/traction.md). Odd in the
    increment if the creep is pure spin or none, and the track symmetric; bounded by race_friction.
    """
    check_film(race_friction=race_friction, film_compliance=film_compliance, film_thickness=film_thickness)
    case = scaled_contact(ellipse, creep, race_friction, film_compliance)
    slope, error, nodes = (0.0, 0.0, 200) if case.idle else case.refined_slope(tolerance)
    table = film_tables(nodes)[0]
    offset = case.offset(table)
    increments = (
        case.increments(table) if creep_increments is None else np.asarray(creep_increments, dtype=np.float64)
    )
    traction = (
        np.zeros_like(increments)
        if case.idle
        else case.friction * case.forces(offset + increments / case.saturation, table)
    )
    return TractionCurve(
        creep_increment=increments,
        traction_coefficient=traction,
        slope=slope,
        slope_error=error,
        free_rolling_offset=offset * case.saturation,
        spin_roll_ratio=creep.spin / ellipse.curvature_rolling,
        nodes=2 * nodes,
        notes=_not_thin(film_thickness, ellipse.semi_minor),
    )


def traction_slope(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    tolerance: Ratio = TOLERANCE,
) -> tuple[Ratio, Ratio]:
    """Slope alpha of the curve at the origin and a bound of its numerical error [-]; see `traction_curve`."""
    check_film(race_friction=race_friction, film_compliance=film_compliance)
    case = scaled_contact(ellipse, creep, race_friction, film_compliance)
    return (0.0, 0.0) if case.idle else case.refined_slope(tolerance)[:2]


def _not_thin(thickness: Metre, semi_minor: Metre) -> tuple[str, ...]:
    """A sentence where a film is too thick to be in series."""
    if not thickness > THIN * semi_minor > 0.0:
        return ()
    return (
        f"film of {format_quantity(thickness, 'm', 3)} is {thickness / semi_minor:.3g} of the semi-minor "
        f"axis: a film in series with the half-planes is valid up to {THIN:g} (docs/theory/traction.md).",
    )


def check_film(**values: float | Profile) -> None:
    """Refuse a friction [-], compliance [m/Pa] or thickness [m] that is negative or not finite."""
    units = {"race_friction": "-", "film_compliance": "m/Pa", "film_thickness": "m"}
    for name, value in values.items():
        if isinstance(value, Profile):
            if name == "race_friction" and not min(value.values) > 0.0:
                raise InputError(f"traction: {name}", "must be > 0 everywhere [-]", f"{min(value.values):g}")
        elif not 0.0 <= value < math.inf:
            raise InputError(f"traction: {name}", f"must be finite and >= 0 [{units[name]}]", f"{value:g}")
