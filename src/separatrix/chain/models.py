"""Strips and exact contact side by side, with Hertz's pressure and with that of the coated bodies."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import RaceContact, race_track
from separatrix.chain.race_curve import RaceTrack, contact_problem, exact_slope, strips
from separatrix.chain.restitution import contact_damping, race_damping, restitution
from separatrix.chain.solution import Solution
from separatrix.chain.traction.exact import RaceSlope, rolling_contact
from separatrix.chain.traction.exact.normal import film_strain
from separatrix.chain.traction.exact.slope import COLUMNS, ROWS
from separatrix.errors import ConvergenceError, InputError
from separatrix.study import ContactPressure, PressureSlip, Race, TractionModel, TractionSettings
from separatrix.units import Newton, NewtonMetre, NewtonSecondPerMetre, Pascal, Ratio, Rows, Watt

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

    model: TractionModel
    pressure: ContactPressure
    is_used: bool
    inner_slope: Ratio | None = None
    inner_slope_error: Ratio | None = None
    outer_slope: Ratio | None = None
    outer_slope_error: Ratio | None = None
    race_damping: NewtonSecondPerMetre | None = None
    restitution_factor: Ratio | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeRolling:
    """The exact contact of one race in free rolling; force and moment act on the ball.

    `lateral_share` is the lateral force over friction times load; `pressure_slip` the largest slip that the
    pressure causes between unlike or coated bodies, over the saturation creep 2 mu p0/E*; `dissipation` is
    the power of the slip.
    """

    lateral_force: Newton
    lateral_share: Ratio
    spin_moment: NewtonMetre
    stick_share: Ratio
    max_pressure: Pascal
    film_strain: Ratio
    pressure_slip: Ratio
    dissipation: Watt


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelComparison:
    """Models side by side, the exact contacts in free rolling, and where the strips leave their range."""

    models: Annotated[tuple[ModelSlopes, ...], Rows("model")]
    inner: FreeRolling | None
    outer: FreeRolling | None
    outside: tuple[str, ...]


def compare_models(solution: Solution) -> ModelComparison:
    """Compare the models at the contacts of a solved chain; with a cage, also their restitution factors.

    The pressure of the coated bodies is compared where it may differ from Hertz's: under a whole film that is
    squeezed by more than a hundredth of the approach.
    """
    study, state = solution.study, solution.bearing
    contacts = {Race.INNER: state.inner, Race.OUTER: state.outer}
    tracks = {race: race_track(study.bearing, study.film, race, at) for race, at in contacts.items()}
    slip = study.traction.pressure_slip
    choices = [(model, ContactPressure.HERTZ) for model in TractionModel]
    if study.film.wear is None and any(_squeeze(track) > SQUEEZED for track in tracks.values()):
        choices += [(model, ContactPressure.COATED) for model in TractionModel]
    rows = [_slopes(solution, tracks, *choice, slip=slip) for choice in choices]
    used = TractionSettings(model=TractionModel.EXACT, pressure=study.traction.pressure, pressure_slip=slip)
    try:
        found = {race: exact_slope(track, used) for race, track in tracks.items()}
    except (InputError, ConvergenceError):  # the row of this model has the reason
        return ModelComparison(models=tuple(rows), inner=None, outer=None, outside=())
    inner, outer = (_free_rolling(found[race], contacts[race], tracks[race]) for race in contacts)
    outside = tuple(_outside(rows, inner, outer, slip))
    return ModelComparison(models=tuple(rows), inner=inner, outer=outer, outside=outside)


def _squeeze(track: RaceTrack) -> Ratio:
    """Compression of the film by the largest pressure over the approach of the bodies."""
    material, thickness, ellipse = track.film.material, track.film.thickness, track.ellipse
    if material is None or thickness is None:
        return 0.0
    nu = material.poisson_ratio
    confined = material.elastic_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) if nu < 0.5 else 0.0
    return ellipse.max_pressure * thickness / (confined * ellipse.approach) if confined > 0.0 else 0.0


def _apart(one: tuple[Ratio | None, ...], other: tuple[Ratio | None, ...]) -> Ratio:
    """Largest relative difference of slopes that are known."""
    pairs = [(x, y) for x, y in zip(one, other, strict=True) if x is not None and y]
    return max((abs(x / y - 1.0) for x, y in pairs), default=0.0)


def _slopes(
    solution: Solution,
    tracks: dict[Race, RaceTrack],
    model: TractionModel,
    pressure: ContactPressure,
    *,
    slip: PressureSlip,
) -> ModelSlopes:
    asked = solution.study.traction
    row = ModelSlopes(
        model=model, pressure=pressure, is_used=(model, pressure) == (asked.model, asked.pressure)
    )

    def found(track: RaceTrack) -> tuple[Ratio, Ratio]:
        if model is TractionModel.STRIPS:
            curve = strips(track, pressure)
            return curve.slope, curve.slope_error
        own = exact_slope(track, TractionSettings(model=model, pressure=pressure, pressure_slip=slip))
        return own.slope, own.slope_error

    try:
        with ThreadPoolExecutor(2) as pool:
            (inner, inner_error), (outer, outer_error) = pool.map(found, tracks.values())
    except (InputError, ConvergenceError) as error:
        return replace(row, reason=str(error))
    state = solution.bearing
    dampings = [
        contact_damping(slope, at.load, at.rolling_speed)
        for slope, at in ((inner, state.inner), (outer, state.outer))
    ]
    factor = None
    if solution.study.cage is not None:
        k, mass = solution.ball_cage_stiffness, solution.design.mass
        factor = restitution(*dampings, ball_cage_stiffness=k, cage_mass=mass).restitution_factor
    return replace(
        row,
        inner_slope=inner,
        inner_slope_error=inner_error,
        outer_slope=outer,
        outer_slope_error=outer_error,
        race_damping=race_damping(*dampings),
        restitution_factor=factor,
    )


def _free_rolling(found: RaceSlope, at: RaceContact, track: RaceTrack) -> FreeRolling:
    one, whole = found.solution, replace(track, film=replace(track.film, wear=None))
    bodies = contact_problem(whole, TractionSettings()).bodies
    return FreeRolling(
        lateral_force=one.lateral_force,
        lateral_share=one.lateral_force / (track.film.race_friction * at.load),
        spin_moment=one.spin_moment,
        stick_share=one.stick_share,
        max_pressure=one.max_pressure,
        film_strain=film_strain(bodies, one.max_pressure),
        pressure_slip=_pressure_slip(track),
        dissipation=one.dissipation * abs(at.rolling_speed),
    )


def _pressure_slip(track: RaceTrack) -> Ratio:
    """Largest slip by the pressure over the saturation creep."""
    settings = TractionSettings(model=TractionModel.EXACT, pressure_slip=PressureSlip.INCLUDED)
    contact = rolling_contact(contact_problem(track, settings), columns=COLUMNS[0], rows=ROWS // 2)
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
