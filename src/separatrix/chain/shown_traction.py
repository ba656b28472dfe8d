"""Traction of a contact as figures show it: its curve, those at other spins, and its shear."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from separatrix.chain.film_compliance import track_of
from separatrix.chain.race_curve import RaceTrack, exact_curve, strips
from separatrix.chain.shear import ShearField, shear_field
from separatrix.chain.traction_curve import TractionCurve
from separatrix.ground.units import Ratio
from separatrix.study.study import ContactPressure, TractionModel, TractionSettings

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""

STRIPS = 5
"""Strips in which the shear is shown."""

INCREMENTS = 101
"""Creep increments of a curve."""


def shown_curve(track: RaceTrack, settings: TractionSettings) -> TractionCurve:
    """Curve of one contact, at increments up to a quarter beyond those at which it is saturated."""
    plain = strips(track, settings.pressure, np.linspace(-1.0, 1.0, INCREMENTS) * _saturation(track))
    if settings.model is TractionModel.STRIPS or track.is_idle:
        return plain
    return exact_curve(track, settings, plain)


def curves_by_ratio(track: RaceTrack, curve: TractionCurve) -> tuple[TractionCurve, ...]:
    """Traction curves by strips at `SPIN_ROLL_RATIOS`, with the sign and at the increments of a curve."""
    own = track.creep.spin
    spins = (math.copysign(ratio, own) * track.ellipse.curvature_rolling for ratio in SPIN_ROLL_RATIOS)
    return tuple(
        strips(
            replace(track, creep=replace(track.creep, spin=spin)),
            ContactPressure.HERTZ,
            curve.creep_increment,
        )
        for spin in spins
    )


def _saturation(track: RaceTrack) -> Ratio:
    """Creep increment a quarter beyond the one at which the curve has its whole friction, either way."""
    widest = float(strips(track, ContactPressure.HERTZ).creep_increment[-1])
    finer = strips(
        track, ContactPressure.HERTZ, widest * np.sinh(np.linspace(-6.0, 6.0, 201)) / math.sinh(6.0)
    )
    coefficient = np.abs(finer.traction_coefficient)
    rising = coefficient < SATURATED * coefficient.max()
    farthest = float(np.abs(finer.creep_increment[rising]).max(initial=0.0))
    return min(1.25 * farthest or widest, widest)


def shear(track: RaceTrack) -> ShearField:
    """Shear in a few strips of a contact in free rolling (the paper's Fig. 6)."""
    friction, compliance = track_of(track.film, track.race, track.ellipse.semi_major)
    return shear_field(
        track.ellipse, track.creep, race_friction=friction, film_compliance=compliance, strips=STRIPS
    )
