"""Traction of a contact as figures show it: by both models, at several spins, and its shear."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from separatrix.chain.race_curve import RaceTrack, exact_curve, exact_slope, strips
from separatrix.chain.traction import ShearField, TractionCurve, exact, shear_field, track_of
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Ratio
from separatrix.study.study import ContactPressure, TractionModel, TractionSettings

SPIN_ROLL_RATIOS = (0.0, 0.1, 0.2, 0.4, 0.8)
"""Pivoting-to-rolling ratios at which the traction curves are drawn, as in the paper's Fig. 7."""

SATURATED = 0.995
"""Share of the whole friction from which a traction curve counts as flat in a figure."""

STRIPS = 5
"""Strips in which the shear is shown."""

INCREMENTS = 101
"""Creep increments of a curve."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExactArea:
    """The exact contact in free rolling, and where the stick of strips ends in its rows, shape (row,) [m].

    NaN where a strip slips throughout; None where the strips have another ellipse.
    """

    solution: exact.ContactSolution  # tractions and slip of every cell
    stick_line: Array | None  # where the stick of strips ends in each row


def exact_area(track: RaceTrack, settings: TractionSettings) -> ExactArea | None:
    """Fields of one race in free rolling; None if the exact contact has no answer."""
    if track.is_idle:
        return None
    try:
        found = exact_slope(track, settings.by(TractionModel.EXACT)).solution
    except (InputError, ConvergenceError):
        return None
    rows = found.across.size
    whole = found.across[-1] - found.across[0] + found.across[1] - found.across[0]
    if abs(whole - 2.0 * track.ellipse.semi_major) > 1e-9 * whole:  # not the ellipse of Hertz
        return ExactArea(solution=found, stick_line=None)
    field = _shear(track, rows)
    ends = [
        np.nan if slip[0] else x[slip.argmax()] if slip.any() else x[-1]
        for x, slip in zip(field.along, field.slip != 0, strict=True)
    ]
    return ExactArea(solution=found, stick_line=np.array(ends))


def curves_by_model(
    track: RaceTrack, settings: TractionSettings
) -> tuple[TractionCurve, TractionCurve | None]:
    """Curves of one contact by strips and by the exact contact; None if that has no answer.

    The creep increments go a quarter beyond those at which the contact's own curve is saturated.
    """
    increments = np.linspace(-1.0, 1.0, INCREMENTS) * _saturation(track)
    plain = strips(track, settings.pressure, increments)
    if track.is_idle:
        return plain, None
    try:
        return plain, exact_curve(track, settings.by(TractionModel.EXACT), plain)
    except (InputError, ConvergenceError):
        if settings.model is TractionModel.EXACT:
            raise
        return plain, None


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
    return _shear(track, STRIPS)


def _shear(track: RaceTrack, strips: int) -> ShearField:
    friction, compliance = track_of(track.film, track.race, track.ellipse.semi_major)
    return shear_field(
        track.ellipse, track.creep, race_friction=friction, film_compliance=compliance, strips=strips
    )
