"""Shear over the ellipse and along one strip, with stick and slip: direct solutions (paper, Figs 5 and 6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.chain.creep import Creep
from separatrix.chain.film_profile import Profile
from separatrix.chain.hertz import ContactEllipse
from separatrix.chain.master_curve import film_tables
from separatrix.chain.strip import solve_strip, stick_solution, strip_influence
from separatrix.chain.traction_curve import scaled_contact
from separatrix.ground.units import Array, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class ShearField:
    """Traction over the ellipse from direct strips; arrays of shape (strip, node) unless said.

    across : y of the strips, shape (strip,) [m]; along : x of the elements, leading edge first [m];
    creep_ratio : xi of the strips, shape (strip,) [-]; pressure, bound (friction times pressure), shear,
    shear_without_slip [Pa]; slip : 0 in stick, else its sign; sweeps : solutions of each strip's stick zone,
    shape (strip,).
    """

    across: Annotated[Array, "m", ("strip",)]  # place of each strip
    along: Annotated[Array, "m", ("strip", "node")]  # place of each element, leading edge first
    creep_ratio: Annotated[Array, "-", ("strip",)]  # of ball and race, over the rolling speed
    pressure: Annotated[Array, "Pa", ("strip", "node")]  # by Hertz
    bound: Annotated[Array, "Pa", ("strip", "node")]  # friction times pressure
    shear: Annotated[Array, "Pa", ("strip", "node")]  # tangential traction
    shear_without_slip: Annotated[Array, "Pa", ("strip", "node")]  # shear of a contact that sticks throughout
    slip: Annotated[Array, ("strip", "node")]  # 0 in stick, else the sign of the slip
    sweeps: Annotated[Array, ("strip",)]  # solutions until the strip's stick zone settled


def shear_field(
    ellipse: ContactEllipse,
    creep: Creep,
    *,
    race_friction: Ratio | Profile,
    film_compliance: float | Profile,
    creep_increment: Ratio = 0.0,
    strips: int = 41,
    nodes: int = 100,
) -> ShearField:
    """Shear over the ellipse at one creep increment; with ``strips=1`` the middle strip.

    Parameters
    ----------
    ellipse, creep, race_friction, film_compliance
        As for `traction_curve`; race_friction must exceed 0.
    creep_increment : float
        Increment from free rolling, positive where the ball is faster [-].
    strips, nodes : int
        Strips of equal width across the ellipse, and elements along each.

    Returns
    -------
    ShearField
        Traction with slip and without, pressure, stick and slip.
    """
    case = scaled_contact(ellipse, creep, race_friction, film_compliance)
    y = 2.0 * (np.arange(strips) + 0.5) / strips - 1.0
    offset = case.offset(film_tables(200)[0]) * case.saturation
    xi = creep.ratio(y * ellipse.semi_major, offset + creep_increment)
    half = np.sqrt(1.0 - y * y)  # b(y)/b, and p0(y)/p0
    films, shares = case.local(y)
    ratios = np.zeros(strips) if case.idle else xi / (case.saturation * shares * half)
    solved = [solve_strip(c, lam, nodes=nodes) for c, lam in zip(ratios, films / half, strict=True)]
    stuck = [_stuck(c, lam, nodes) for c, lam in zip(ratios, films / half, strict=True)]
    pressure = ellipse.max_pressure * half[:, None]
    bound = case.friction * shares[:, None] * pressure
    return ShearField(
        across=y * ellipse.semi_major,
        along=ellipse.semi_minor * half[:, None] * solved[0].along,
        creep_ratio=xi,
        pressure=pressure * solved[0].pressure,
        bound=bound * solved[0].pressure,
        shear=bound * np.array([s.shear for s in solved]),
        shear_without_slip=bound * np.array(stuck),
        slip=np.array([s.slip for s in solved]),
        sweeps=np.array([s.sweeps for s in solved]),
    )


def _stuck(creep: Ratio, lam: Ratio, nodes: int) -> Array:
    """Traction of a strip that sticks throughout, in units of mu p0(y), shape (node,) [-]."""
    influence = strip_influence(nodes, lam)
    return stick_solution(influence, np.zeros(nodes), np.full(nodes, 4.0 * creep / nodes), np.zeros(nodes))
