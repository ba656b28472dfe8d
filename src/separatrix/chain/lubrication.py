"""Restitution factor against film thickness and race friction, bare to thick (the paper's Fig. 8)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import RaceContact
from separatrix.chain.film_compliance import film_compliance
from separatrix.chain.impact_restitution import Restitution, contact_damping, restitution
from separatrix.chain.traction_curve import traction_slope
from separatrix.ground.units import Array, Kilogram, Metre, NewtonPerMetre, Ratio
from separatrix.study.study import Film, Material

FILM_THICKNESSES: tuple[Metre, ...] = (0.0, *(float(h) for h in np.geomspace(1e-9, 1e-5, 41)))
"""Bare, then 1 nm to 10 um, ten to a decade."""

RACE_FRICTIONS: tuple[Ratio, ...] = (0.02, 0.05, 0.1, 0.2, 0.4)
"""From burnished MoS2 in vacuum to nearly unlubricated steel."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LubricationCurve:
    """Restitution factor against film thickness (0 is bare) and race friction.

    Attributes
    ----------
    film_thickness, race_friction : ndarray
        Shape (thickness,) [m] and (friction,) [-].
    restitution_factor, restitution_factor_free_spin : ndarray
        Shape (friction, thickness) [-].
    film_material : str
        Whose modulus the film has.
    """

    film_thickness: Annotated[Array, "m", ("film_thickness",)]
    race_friction: Annotated[Array, "-", ("race_friction",)]
    restitution_factor: Annotated[Array, "-", ("race_friction", "film_thickness")]
    restitution_factor_free_spin: Annotated[Array, "-", ("race_friction", "film_thickness")]
    film_material: str


def lubrication_curve(
    inner: RaceContact,
    outer: RaceContact,
    film_material: Material,
    *,
    ball_cage_stiffness: NewtonPerMetre,
    cage_mass: Kilogram,
    film_thicknesses: Sequence[Metre] = FILM_THICKNESSES,
    race_frictions: Sequence[Ratio] = RACE_FRICTIONS,
) -> LubricationCurve:
    """Restitution factor for each race friction and film thickness, the kinematics held.

    Parameters
    ----------
    inner, outer : RaceContact
        Contacts of the ball.
    film_material : Material
        Gives the film its shear modulus.
    ball_cage_stiffness, cage_mass : float
        k_BC [N/m] and M_C [kg].
    film_thicknesses, race_frictions : sequence of float
        Total thickness over ball and race, 0 for bare [m]; f_BT, > 0 [-].

    Notes
    -----
    The film is in series with the half-planes at every thickness; beyond some 3 % of the semi-minor axis that
    departs from a bonded layer (docs/theory/traction.md). Without race control the ball's spin depends on the
    race friction too; here it is that of the contacts given.
    """

    def under(h: Metre, f: Ratio) -> Restitution:
        film = Film(race_friction=f, material=film_material, thickness=h) if h else Film(race_friction=f)
        compliance = film_compliance(film)
        dampings = []
        for at in (inner, outer):
            slope, _ = traction_slope(at.ellipse, at.creep, race_friction=f, film_compliance=compliance)
            dampings.append(contact_damping(slope, at.ellipse.load, at.rolling_speed))
        return restitution(*dampings, ball_cage_stiffness=ball_cage_stiffness, cage_mass=cage_mass)

    found = [[under(h, f) for h in film_thicknesses] for f in race_frictions]
    return LubricationCurve(
        film_thickness=np.array(film_thicknesses),
        race_friction=np.array(race_frictions),
        restitution_factor=np.array([[one.restitution_factor for one in row] for row in found]),
        restitution_factor_free_spin=np.array(
            [[one.restitution_factor_free_spin for one in row] for row in found]
        ),
        film_material=film_material.name,
    )
