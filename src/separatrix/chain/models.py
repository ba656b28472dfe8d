"""Strips and exact contact side by side, with Hertz's pressure and with that of the coated bodies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import RaceContact, of_both_races, race_tracks
from separatrix.chain.race_curve import RaceTrack, contact_problem, exact_slope, race_slope
from separatrix.chain.restitution import race_damping, restitution
from separatrix.chain.solution import Solution
from separatrix.chain.traction import exact
from separatrix.chain.traction.exact.slope import COLUMNS, ROWS
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Newton, NewtonMetre, NewtonSecondPerMetre, Pascal, Ratio, Rows, Watt
from separatrix.study.study import ContactPressure, PressureSlip, TractionModel, TractionSettings

STRAINED: Ratio = 0.1
"""Film strain p0/M_c from which a film is no longer linearly elastic."""

SQUEEZED: Ratio = 0.01
"""Film strain times thickness over the approach from which a film may change the pressure."""

NOTICED: Ratio = 0.2
"""Slip by the pressure over the saturation creep that is named: it moves free rolling by that."""

CLOSE: Ratio = 0.03
"""Difference of slopes that is named: a bearing's contacts without a soft film are closer."""

LATERAL: Ratio = 0.05
"""Lateral force over mu N from which it is named: strips have none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelSlopes:
    """Slopes by one model, and what they make of the damping; None with the reason where it has no answer."""

    model: TractionModel  # strips or exact contact
    pressure: ContactPressure  # by Hertz, or of the coated bodies
    is_used: bool  # whether the study uses this model
    inner_slope: Ratio | None = None  # alpha of the inner race
    inner_slope_error: Ratio | None = None  # its estimated error
    outer_slope: Ratio | None = None  # alpha of the outer race
    outer_slope_error: Ratio | None = None  # its estimated error
    race_damping: NewtonSecondPerMetre | None = None
    restitution_factor: Ratio | None = None
    reason: str = ""  # why there is no answer; empty if there is


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeRolling:
    """The exact contact of one race in free rolling; force and moment act on the ball.

    `lateral_share` is the lateral force over friction times load; `pressure_slip` the largest slip that the
    pressure causes between unlike or coated bodies, over the saturation creep 2 mu p0/E*; `dissipation` is
    the power of the slip.
    """

    lateral_force: Newton
    lateral_share: Ratio  # lateral force over friction times load
    spin_moment: NewtonMetre
    stick_share: Ratio
    max_pressure: Pascal  # largest of the contact, with the films
    film_strain: Ratio
    pressure_slip: Ratio  # largest slip caused by the pressure, over the saturation creep
    dissipation: Watt  # power of the slip


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelComparison:
    """Models side by side, the exact contacts in free rolling, and where the strips leave their range."""

    models: Annotated[tuple[ModelSlopes, ...], Rows("model")]  # one for each model and pressure
    inner: FreeRolling | None  # the exact contact with the inner race, if it was solved
    outer: FreeRolling | None  # the exact contact with the outer race, if it was solved
    outside: tuple[str, ...]  # where the strips leave their range, a sentence each


def compare_models(solution: Solution) -> ModelComparison:
    """Compare the models at the contacts of a solved chain; with a cage, also their restitution factors.

    The pressure of the coated bodies is compared where it may differ from Hertz's: under a whole film that is
    squeezed by more than a hundredth of the approach.
    """
    study, state = solution.study, solution.bearing
    tracks, asked = race_tracks(study.bearing, study.film, state), study.traction
    choices = [(model, ContactPressure.HERTZ) for model in TractionModel]
    is_soft = study.film.wear is None and any(_squeeze(track) > SQUEEZED for track in tracks)
    if is_soft or asked.pressure is ContactPressure.COATED:
        choices += [(model, ContactPressure.COATED) for model in TractionModel]
    rows = [_slopes(solution, tracks, *choice) for choice in choices]
    try:
        found = [exact_slope(track, asked.by(TractionModel.EXACT)) for track in tracks]
    except (InputError, ConvergenceError):  # the row of this model has the reason
        return ModelComparison(models=tuple(rows), inner=None, outer=None, outside=())
    inner, outer = map(_free_rolling, found, (state.inner, state.outer), tracks)
    outside = tuple(_outside(rows, inner, outer, asked.pressure_slip))
    return ModelComparison(models=tuple(rows), inner=inner, outer=outer, outside=outside)


def _strain(track: RaceTrack, pressure: Pascal) -> Ratio:
    """Compression of the film by a pressure over its thickness; 0 without a film."""
    material = track.film.body
    if material is None:
        return 0.0
    return pressure / exact.solid(material.elastic_modulus, material.poisson_ratio).compression_modulus


def _squeeze(track: RaceTrack) -> Ratio:
    """Compression of the film by the largest pressure over the approach of the bodies."""
    ellipse = track.ellipse
    return _strain(track, ellipse.max_pressure) * (track.film.thickness or 0.0) / ellipse.approach


def _apart(one: tuple[Ratio | None, ...], other: tuple[Ratio | None, ...]) -> Ratio:
    """Largest relative difference of slopes that are known."""
    pairs = [(x, y) for x, y in zip(one, other, strict=True) if x is not None and y]
    return max((abs(x / y - 1.0) for x, y in pairs), default=0.0)


def _slopes(
    solution: Solution, tracks: tuple[RaceTrack, RaceTrack], model: TractionModel, pressure: ContactPressure
) -> ModelSlopes:
    asked, state = solution.study.traction, solution.bearing
    used = (model, pressure) == (asked.model, asked.pressure)
    row = ModelSlopes(model=model, pressure=pressure, is_used=used)
    try:
        inner, outer = of_both_races(lambda track: race_slope(track, asked.by(model, pressure)), tracks)
    except (InputError, ConvergenceError) as error:
        return replace(row, reason=str(error))
    dampings, factor = state.dampings(inner.slope, outer.slope), None
    if solution.study.cage is not None:
        k, mass = solution.ball_cage_stiffness, solution.inertia.mass
        factor = restitution(*dampings, ball_cage_stiffness=k, cage_mass=mass).restitution_factor
    return replace(
        row,
        inner_slope=inner.slope,
        inner_slope_error=inner.slope_error,
        outer_slope=outer.slope,
        outer_slope_error=outer.slope_error,
        race_damping=race_damping(*dampings),
        restitution_factor=factor,
    )


def _free_rolling(found: exact.RaceSlope, at: RaceContact, track: RaceTrack) -> FreeRolling:
    one = found.solution
    return FreeRolling(
        lateral_force=one.lateral_force,
        lateral_share=one.lateral_force / (track.film.race_friction * at.load),
        spin_moment=one.spin_moment,
        stick_share=one.stick_share,
        max_pressure=one.max_pressure,
        film_strain=_strain(track, one.max_pressure),
        pressure_slip=_pressure_slip(track),
        dissipation=one.dissipation * abs(at.rolling_speed),
    )


def _pressure_slip(track: RaceTrack) -> Ratio:
    """Largest slip by the pressure over the saturation creep."""
    settings = TractionSettings(model=TractionModel.EXACT, pressure_slip=PressureSlip.INCLUDED)
    contact = exact.rolling_contact(contact_problem(track, settings), columns=COLUMNS[0], rows=ROWS // 2)
    saturation = 2.0 * track.film.race_friction * track.ellipse.max_pressure / track.ellipse.contact_modulus
    return float(np.abs(contact.coupling).max()) / saturation


def _outside(
    rows: list[ModelSlopes], inner: FreeRolling, outer: FreeRolling, asked: PressureSlip
) -> Iterator[str]:
    """Where the strips leave their range: a sentence each."""
    slopes = {(one.model, one.pressure): (one.inner_slope, one.outer_slope) for one in rows}
    exact = slopes[TractionModel.EXACT, ContactPressure.HERTZ]
    off = _apart(slopes[TractionModel.STRIPS, ContactPressure.HERTZ], exact)
    if off > CLOSE:
        yield f"The slopes by strips are up to {off:.0%} off those of the exact contact."
    pressed = _apart(slopes.get((TractionModel.EXACT, ContactPressure.COATED), exact), exact)
    if pressed > CLOSE:
        yield (
            f"The film changes the pressure, and with it the slopes by up to {pressed:.0%}: "
            'consider [traction] pressure = "coated".'
        )
    strain = max(inner.film_strain, outer.film_strain)
    if strain > STRAINED:
        yield (
            f"The pressure compresses the film by {strain:.0%} of its thickness: above {STRAINED:.0%} it is "
            "not linearly elastic, as every model here takes it to be."
        )
    slip = max(inner.pressure_slip, outer.pressure_slip)
    if slip > NOTICED and asked is PressureSlip.NEGLECTED:
        yield (
            f"The pressure alone makes the surfaces slip by up to {slip:.2g} of the saturation creep: "
            'consider [traction] model = "exact" with pressure_slip = "included".'
        )
    lateral = max(abs(inner.lateral_share), abs(outer.lateral_share))
    if lateral > LATERAL:
        yield (
            f"Spin pushes the ball across the groove with up to {lateral:.0%} of friction times load; strips "
            "have no such force."
        )
