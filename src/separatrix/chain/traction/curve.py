"""Traction coefficient against creep increment; its slope at the origin (paper, Eqs 2, 14, 15, Fig. 7)."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.chain.creep import Creep
from separatrix.chain.hertz import ContactEllipse
from separatrix.chain.traction.layer import BondedLayer
from separatrix.chain.traction.scaled import ScaledContact, scaled_contact
from separatrix.errors import InputError, ValidityWarning
from separatrix.study import Film
from separatrix.units import Array, Metre, Ratio

TOLERANCE = 0.005
THIN = 0.03  # film thickness over semi-minor axis up to which the film in series is used without a warning


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionCurve:
    """Traction coefficient of one contact against the creep increment, shape (case,) each [-].

    `slope` is the paper's alpha = dC_T/d(delta xi) at the origin, `slope_error` bounds its numerical error;
    `free_rolling_offset` is the creep on the centre line at which the contact carries no net traction;
    `nodes` counts the elements of the finest strip.
    """

    creep_increment: Annotated[Array, "-", ("increment",)]
    traction_coefficient: Annotated[Array, "-", ("increment",)]
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
    layer: BondedLayer | None = None,
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
    race_friction : float
        Friction f_BT of ball on track, >= 0 [-].
    film_compliance : float
        Shear compliance L = h/G of the film in series, >= 0 [m/Pa]; not used with a layer.
    creep_increments : array or None
        Where to compute, shape (case,) [-]; None takes 41 points that span saturation both ways.
    film_thickness : float
        Total thickness of the film [m]; only to warn where the film in series is out of its range.
    layer : BondedLayer or None
        The exact elastic layer instead of the film in series, see `bonded_layer`.
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

    Warns
    -----
    ValidityWarning
        The film in series is thicker than 0.03 of the semi-minor axis.

    Notes
    -----
    Paper, Eqs 2, 12-15 and Fig. 7, with the rolling entry condition (docs/theory/traction.md). Odd in the
    increment if the creep is pure spin or none; bounded by race_friction.
    """
    case = _checked_case(ellipse, creep, race_friction, film_compliance, film_thickness, layer)
    slope, error, nodes = (0.0, 0.0, 200) if case.idle else case.refined_slope(tolerance)
    table = case.tables(nodes)[0]
    offset = case.offset(table)
    increments = (
        case.increments(table) if creep_increments is None else np.asarray(creep_increments, dtype=np.float64)
    )
    traction = (
        np.zeros_like(increments)
        if case.idle
        else race_friction * case.forces(offset + increments / case.saturation, table)
    )
    return TractionCurve(
        creep_increment=increments,
        traction_coefficient=traction,
        slope=slope,
        slope_error=error,
        free_rolling_offset=offset * case.saturation,
        spin_roll_ratio=creep.spin / ellipse.curvature_rolling,
        nodes=2 * nodes,
    )


def traction_slope(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio,
    film_compliance: float,
    film_thickness: Metre = 0.0,
    layer: BondedLayer | None = None,
    tolerance: Ratio = TOLERANCE,
) -> tuple[Ratio, Ratio]:
    """Slope alpha of the curve at the origin and a bound of its numerical error [-]; see `traction_curve`."""
    case = _checked_case(ellipse, creep, race_friction, film_compliance, film_thickness, layer)
    return (0.0, 0.0) if case.idle else case.refined_slope(tolerance)[:2]


def _checked_case(
    ellipse: ContactEllipse,
    creep: Creep,
    friction: Ratio,
    compliance: float,
    thickness: Metre,
    layer: BondedLayer | None,
) -> ScaledContact:
    check_film(race_friction=friction, film_compliance=compliance, film_thickness=thickness)
    if layer is None and thickness > THIN * ellipse.semi_minor > 0.0:
        warnings.warn(
            f"film of {thickness:g} m is {thickness / ellipse.semi_minor:.3g} of the semi-minor axis: "
            f"a film in series with the half-planes holds up to {THIN:g} (docs/theory/traction.md).",
            ValidityWarning,
            stacklevel=3,
        )
    return scaled_contact(ellipse, creep, friction, compliance, layer)


def check_film(**values: float) -> None:
    """Refuse a friction [-], compliance [m/Pa] or thickness [m] that is negative or not finite."""
    units = {"race_friction": "-", "film_compliance": "m/Pa", "film_thickness": "m"}
    for name, value in values.items():
        if not 0.0 <= value < math.inf:
            raise InputError(f"traction: {name}", f"must be finite and >= 0 [{units[name]}]", f"{value:g}")
