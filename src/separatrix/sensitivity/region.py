"""Which film keeps a cage stable: the plane of its thickness and its friction."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from separatrix.chain import RestitutionState
from separatrix.errors import InputError
from separatrix.lubrication import FILM_THICKNESSES, lubrication_curve
from separatrix.sensitivity.design import central_values, evaluated, is_stable
from separatrix.sensitivity.inverse import PROBABILITY, require_within
from separatrix.sensitivity.question import Question
from separatrix.sensitivity.records import FilmAxis, RegionRow, RestitutionGrid, StableRegion
from separatrix.sensitivity.spans import spans_above
from separatrix.study import Study
from separatrix.traction.curve import THIN
from separatrix.units import Array, Metre, Ratio

FRICTIONS: tuple[Ratio, ...] = (0.02, 0.03, 0.05, 0.07, 0.1, 0.14, 0.2, 0.28, 0.4)
"""Race frictions of the grid: those of the lubrication curves, and one between each two."""

FINER = 8
"""Values to a step of the grid at which the nominal verdict is asked for."""


def friction_grid(
    study: Study,
    state: RestitutionState,
    *,
    thicknesses: Sequence[Metre] = FILM_THICKNESSES,
    frictions: Sequence[Ratio] = FRICTIONS,
) -> RestitutionGrid:
    """Restitution factor over film thickness and race friction, the rolling held as it is.

    Raises
    ------
    InputError
        Bare races: there is no film to choose.
    """
    film, contacts = study.film, state.traction.bearing
    if film.material is None:
        cure = "Give the film a material and a thickness."
        raise InputError(f"{study.name}: [film]", "has bare races, so there is no film to choose", cure=cure)
    curve = lubrication_curve(
        contacts.inner,
        contacts.outer,
        film.material,
        ball_cage_stiffness=state.restitution.ball_cage_stiffness,
        cage_mass=state.restitution.cage_mass,
        film_thicknesses=thicknesses,
        race_frictions=frictions,
    )
    return RestitutionGrid(
        x=FilmAxis(
            name="film.thickness",
            words="film thickness",
            unit="m",
            values=curve.film_thickness,
            own=film.thickness or 0.0,
        ),
        y=FilmAxis(
            name="film.race_friction",
            words="race friction",
            unit="-",
            values=curve.race_friction,
            own=film.race_friction,
        ),
        restitution_factor=curve.restitution_factor,
        holds_up_to=THIN * min(contacts.inner.ellipse.semi_minor, contacts.outer.ellipse.semi_minor),
    )


def stable_regions(
    question: Question, values: Array, grid: RestitutionGrid, *, probability: Ratio = PROBABILITY
) -> tuple[StableRegion, ...]:
    """Where in the plane of two film quantities each case is stable.

    Each sample keeps its other inputs: its damping ratio is that of the grid, times the ratio that it has to
    the grid at the sample's own film. For pocket stiffness, cage mass and race damping alike that is exact
    (zeta is their product); what film and the other inputs do to the damping together is left out.

    Parameters
    ----------
    question : Question
        With `judge`.
    values : ndarray
        Samples of all inputs, shape (sample, input) [SI].
    grid : RestitutionGrid
        From `friction_grid`.
    probability : float
        Of STABLE, wanted [-].
    """
    require_within("probability", probability, 0.5, 0.9999)
    zeta = damping_ratios(grid.restitution_factor)
    share = _shares(question, values, grid, zeta)
    fine, centre = _finer(grid.x.values), central_values(question)
    nominal = _shares(question, centre, grid, _between(grid.x.values, zeta, fine))
    return tuple(
        StableRegion(
            candidate=case.candidate,
            environment=case.environment,
            probability=probability,
            grid=grid,
            probability_stable=share[:, :, c],
            rows=tuple(
                RegionRow(
                    y=float(y),
                    nominal=spans_above(fine, nominal[k, :, c], 1.0),
                    probable=spans_above(grid.x.values, share[k, :, c], probability),
                )
                for k, y in enumerate(grid.y.values)
            ),
        )
        for c, case in enumerate(question.cases)
    )


def _shares(question: Question, values: Array, grid: RestitutionGrid, zeta: Array) -> Array:
    """Share of the samples that are STABLE at damping ratios of shape (y, x), shape (y, x, case)."""
    found, judge = evaluated(question, values), question.judged()
    values = question.in_pockets(values)
    ratio = damping_ratios(found.threshold - found.margin) / _of_the_grid(question, grid, values)[:, None]
    rows = []
    for row in zeta:
        factor = restitution_factors((row[:, None, None] * ratio).reshape(-1, ratio.shape[1]))
        stable = is_stable(judge(np.tile(values, (row.size, 1)), factor))
        rows.append(stable.reshape(row.size, *ratio.shape).mean(axis=1))
    return np.array(rows)


def _finer(x: Array) -> Array:
    """Values between those given, `FINER` to a step: equal ratios where both ends are positive."""
    steps = (
        np.geomspace(low, high, FINER, endpoint=False)
        if low > 0.0
        else np.linspace(low, high, FINER, endpoint=False)
        for low, high in pairwise(x)
    )
    return np.concatenate([*steps, x[-1:]])


def _between(x: Array, zeta: Array, fine: Array) -> Array:
    """Damping ratios at finer values of x, straight in their logarithm, shape (y, fine)."""
    return np.asarray(np.exp([np.interp(fine, x, row) for row in np.log(zeta)]))


def _of_the_grid(question: Question, grid: RestitutionGrid, values: Array) -> Array:
    """Damping ratio of the grid at each sample's own film, shape (sample,); held beyond the grid's edges.

    The logarithm is taken as straight: over x, and over the logarithm of y, for zeta goes nearly as a power.
    """
    x, y = (_own(question, axis, values) for axis in (grid.x, grid.y))
    zeta = np.log(damping_ratios(grid.restitution_factor))
    along = np.array([np.interp(x, grid.x.values, row) for row in zeta])
    place = np.interp(np.log(y), np.log(grid.y.values), np.arange(len(zeta)))
    low = np.minimum(place.astype(int), len(zeta) - 2)
    columns = np.arange(len(values))
    upper, lower = along[low + 1, columns], along[low, columns]
    return np.asarray(np.exp(lower + (place - low) * (upper - lower)))


def _own(question: Question, axis: FilmAxis, values: Array) -> Array:
    names = [one.name for one in question.inputs]
    return values[:, names.index(axis.name)] if axis.name in names else np.full(len(values), axis.own)


def restitution_factors(damping_ratio: Array) -> Array:
    """Restitution factors of damping ratios, as `restitution.restitution_factor`, any shape [-]."""
    zeta = np.minimum(damping_ratio, 1.0 - 1e-16)
    below = np.exp(-np.pi * zeta / np.sqrt((1.0 - zeta) * (1.0 + zeta)))
    return np.where(damping_ratio < 1.0, below, 0.0)


def damping_ratios(restitution_factor: Array) -> Array:
    """Damping ratios of restitution factors, as `restitution.damping_ratio_for`; 1 where nothing returns."""
    log = np.log(np.clip(restitution_factor, 1e-300, 1.0 - 1e-12))
    return np.where(restitution_factor > 0.0, -log / np.hypot(np.pi, log), 1.0)
