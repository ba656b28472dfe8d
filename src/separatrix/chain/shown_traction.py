"""Traction of a contact as figures show it: at several pivoting-to-rolling ratios, and its shear."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from separatrix.chain.contacts import RaceContact
from separatrix.chain.traction import ShearField, TractionCurve, film_compliance, shear_field, traction_curve
from separatrix.study import Film

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""

STRIPS = 5
"""Strips in which the shear is shown."""


def curves_by_ratio(film: Film, at: RaceContact, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves of one contact: at its own ratio, then at `SPIN_ROLL_RATIOS` with its sign.

    The creep increments go a quarter beyond those at which the contact's own curve is saturated.
    """
    increments = np.linspace(-1.0, 1.0, 201) * _saturation(film, at, curve)
    own = at.creep.spin
    others = (math.copysign(ratio, own) * at.ellipse.curvature_rolling for ratio in SPIN_ROLL_RATIOS)
    return tuple(
        traction_curve(
            at.ellipse,
            replace(at.creep, spin=spin),
            race_friction=film.race_friction,
            film_compliance=film_compliance(film),
            creep_increments=increments,
        )
        for spin in (own, *others)
    )


def _saturation(film: Film, at: RaceContact, curve: TractionCurve) -> float:
    """Creep increment a quarter beyond the one at which a curve has its whole friction, either way."""
    widest = float(curve.creep_increment[-1])
    finer = traction_curve(
        at.ellipse,
        at.creep,
        race_friction=film.race_friction,
        film_compliance=film_compliance(film),
        creep_increments=widest * np.sinh(np.linspace(-6.0, 6.0, 201)) / math.sinh(6.0),
    )
    rising = np.abs(finer.traction_coefficient) < SATURATED * film.race_friction
    return min(1.25 * float(np.abs(finer.creep_increment[rising]).max()), widest)


def shear(film: Film, at: RaceContact) -> ShearField:
    """Shear in a few strips of a contact in free rolling (the paper's Fig. 6)."""
    return shear_field(
        at.ellipse,
        at.creep,
        race_friction=film.race_friction,
        film_compliance=film_compliance(film),
        strips=STRIPS,
    )
