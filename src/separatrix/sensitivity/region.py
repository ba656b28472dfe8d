"""Which film keeps a cage stable: the plane of its thickness and its friction, or its modulus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from separatrix.chain import RestitutionState
from separatrix.errors import InputError
from separatrix.lubrication import FILM_THICKNESSES, RACE_FRICTIONS, LubricationCurve, lubrication_curve
from separatrix.sensitivity.design import central_values, evaluated, is_stable
from separatrix.sensitivity.inverse import PROBABILITY, require_within
from separatrix.sensitivity.question import Evaluated, Question
from separatrix.sensitivity.records import FilmAxis, RegionRow, RestitutionGrid, StableRegion
from separatrix.sensitivity.spans import spans_above
from separatrix.study import Film, Material, Study
from separatrix.units import Array, Metre, Pascal, Ratio

MODULUS_STEPS = np.geomspace(0.1, 10.0, 9)
"""Moduli of the grid over the study's own."""

FINER = 8
"""Values to a step of the grid at which the nominal verdict is asked for."""


def friction_grid(
    study: Study,
    state: RestitutionState,
    *,
    thicknesses: Sequence[Metre] = FILM_THICKNESSES,
    frictions: Sequence[Ratio] = RACE_FRICTIONS,
) -> RestitutionGrid:
    """Restitution factor over film thickness and race friction, the rolling held as it is.

    Raises
    ------
    InputError
        Bare races: there is no film to choose.
    """
    material = _film_material(study)
    curve = _curve(state, material, thicknesses, frictions)
    axis = FilmAxis(
        name="film.race_friction",
        words="race friction",
        unit="-",
        values=curve.race_friction,
        own=study.film.race_friction,
    )
    return RestitutionGrid(
        x=_thickness(study.film, thicknesses), y=axis, restitution_factor=curve.restitution_factor
    )


def modulus_grid(
    study: Study,
    state: RestitutionState,
    *,
    thicknesses: Sequence[Metre] = FILM_THICKNESSES,
    moduli: Sequence[Pascal] | None = None,
) -> RestitutionGrid:
    """Restitution factor over film thickness and the film's elastic modulus, at the study's race friction.

    Raises
    ------
    InputError
        Bare races: there is no film to choose.
    """
    own = _film_material(study)
    chosen = own.elastic_modulus * MODULUS_STEPS if moduli is None else np.array(moduli, float)
    rows = [
        _curve(state, replace(own, elastic_modulus=float(e)), thicknesses, [study.film.race_friction])
        for e in chosen
    ]
    axis = FilmAxis(
        name="film.elastic_modulus",
        words="film modulus",
        unit="Pa",
        values=chosen,
        own=own.elastic_modulus,
    )
    return RestitutionGrid(
        x=_thickness(study.film, thicknesses),
        y=axis,
        restitution_factor=np.array([row.restitution_factor[0] for row in rows]),
    )


def _film_material(study: Study) -> Material:
    if study.film.material is None:
        cure = "Give the film a material and a thickness."
        raise InputError(f"{study.name}: [film]", "has bare races, so there is no film to choose", cure=cure)
    return study.film.material


def _curve(
    state: RestitutionState, material: Material, thicknesses: Sequence[Metre], frictions: Sequence[Ratio]
) -> LubricationCurve:
    return lubrication_curve(
        state.traction.bearing.inner,
        state.traction.bearing.outer,
        material,
        ball_cage_stiffness=state.restitution.ball_cage_stiffness,
        cage_mass=state.restitution.cage_mass,
        film_thicknesses=thicknesses,
        race_frictions=frictions,
    )


def _thickness(film: Film, thicknesses: Sequence[Metre]) -> FilmAxis:
    return FilmAxis(
        name="film.thickness",
        words="film thickness",
        unit="m",
        values=np.array(thicknesses, float),
        own=film.thickness or 0.0,
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
        With `judge`, the verdict is the model's own; without, STABLE is a margin of 0 or more.
    values : ndarray
        Samples of all inputs, shape (sample, input) [SI].
    grid : RestitutionGrid
        From `friction_grid` or `modulus_grid`.
    probability : float
        Of STABLE, wanted [-].
    """
    require_within("probability", probability, 0.5, 0.9999)
    centre = central_values(question)
    nominal = (question.nominal or question.evaluate)(centre)
    sampled = evaluated(question, values)
    ratio, ratio_nominal = (
        damping_ratios(found.threshold - found.margin) / _of_the_grid(question, grid, at)[:, None]
        for found, at in ((sampled, values), (nominal, centre))
    )
    zeta = damping_ratios(grid.restitution_factor)
    share = np.array([[_stable_share(question, values, sampled, z * ratio) for z in row] for row in zeta])
    margin = nominal.threshold[0] - restitution_factors(zeta[:, :, None] * ratio_nominal[0])
    fine = _finer(grid.x.values)
    nominally = _nominal(question, centre, nominal, _between(grid.x.values, zeta, fine), ratio_nominal[0])
    return tuple(
        StableRegion(
            candidate=case.candidate,
            environment=case.environment,
            probability=probability,
            grid=grid,
            margin=margin[:, :, c],
            probability_stable=share[:, :, c],
            rows=tuple(
                RegionRow(
                    y=float(y),
                    nominal=spans_above(fine, nominally[k, :, c], 1.0),
                    probable=spans_above(grid.x.values, share[k, :, c], probability),
                )
                for k, y in enumerate(grid.y.values)
            ),
        )
        for c, case in enumerate(question.cases)
    )


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


def _nominal(question: Question, centre: Array, nominal: Evaluated, zeta: Array, ratio: Array) -> Array:
    """1 where the verdict with every input at its centre is STABLE, shape (y, fine, case)."""
    factor = restitution_factors(zeta[:, :, None] * ratio)
    if question.judge is None:
        return np.asarray((nominal.threshold[0] >= factor).astype(float))
    flat = factor.reshape(-1, factor.shape[-1])
    judged = is_stable(question.judge(np.repeat(centre, len(flat), axis=0), flat))
    return np.asarray(judged.astype(float).reshape(factor.shape))


def _stable_share(question: Question, values: Array, sampled: Evaluated, zeta: Array) -> Array:
    factor = restitution_factors(zeta)
    if question.judge is None:
        stable: NDArray[np.bool_] = sampled.threshold >= factor
    else:
        stable = is_stable(question.judge(values, factor))
    return np.asarray(stable.mean(axis=0))


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
