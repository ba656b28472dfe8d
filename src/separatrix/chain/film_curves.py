"""Restitution factor against the width of a worn track and the thickness of a film, by both models."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import race_tracks
from separatrix.chain.race_curve import race_slope
from separatrix.chain.restitution import Restitution, restitution
from separatrix.chain.solution import Solution
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Ratio
from separatrix.study.study import Film, TractionModel

SHARES = (*np.linspace(0.0, 0.2, 21).tolist(), *np.linspace(0.25, 1.0, 16).tolist())
"""Widths of a worn band over that of the wider contact: closer where little is worn."""

EXACT_SHARES = (0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 1.0)
EXACT_THICKNESSES = (0.0, 1e-8, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5)


@dataclass(frozen=True, slots=True, kw_only=True)
class WearCurve:
    """Restitution factor against the width of the worn band, shape (worn,), by strips; and by exact contacts.

    `width` is the band's, over the wider contact's in `share`. The `exact` ones are None where the study's
    model is not the exact contact, and lack the points that have no answer.
    """

    share: Annotated[Array, "-", ("worn",)]  # width of the band over that of the wider contact
    width: Annotated[Array, "m", ("worn",)]  # of the worn band
    restitution_factor: Annotated[Array, "-", ("worn",)]  # by strips
    restitution_factor_free_spin: Annotated[Array, "-", ("worn",)]
    """The same if the ball is free to spin in the impact."""
    exact_share: Annotated[Array | None, "-", ("worn_exact",)]  # share at which exact contacts were solved
    exact_restitution_factor: Annotated[Array | None, "-", ("worn_exact",)]  # by exact contacts
    exact_restitution_factor_free_spin: Annotated[Array | None, "-", ("worn_exact",)]
    """By exact contacts, the ball free to spin."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExactFilms:
    """Restitution factor by exact contacts against the thickness of a whole film, shape (film,)."""

    thickness: Annotated[Array, "m", ("film_exact",)]  # of the whole film
    restitution_factor: Annotated[Array, "-", ("film_exact",)]  # with that film


def wear_curve(solution: Solution) -> WearCurve | None:
    """Vary the width of the study's worn band, kinematics held; None without a band."""
    film, state = solution.study.film, solution.bearing
    wear = film.wear
    if wear is None or not wear.is_band:
        return None
    widest = 2.0 * max(state.inner.ellipse.semi_major, state.outer.ellipse.semi_major)

    def worn(share: Ratio) -> Film:
        if wear.width is not None:
            return replace(film, wear=replace(wear, width=share * widest))
        return replace(film, wear=replace(wear, share=share))

    by_strips = _found(SHARES, _factors(solution, [worn(share) for share in SHARES], TractionModel.STRIPS))
    exact: dict[float, Restitution] = {}
    if solution.study.traction.model is TractionModel.EXACT:
        films = [worn(share) for share in EXACT_SHARES]
        exact = _found(EXACT_SHARES, _factors(solution, films, TractionModel.EXACT))
    return WearCurve(
        share=np.array(SHARES),
        width=widest * np.array(SHARES),
        restitution_factor=np.array([one.restitution_factor for one in by_strips.values()]),
        restitution_factor_free_spin=np.array(
            [one.restitution_factor_free_spin for one in by_strips.values()]
        ),
        exact_share=np.array([*exact]) if exact else None,
        exact_restitution_factor=(
            np.array([one.restitution_factor for one in exact.values()]) if exact else None
        ),
        exact_restitution_factor_free_spin=(
            np.array([one.restitution_factor_free_spin for one in exact.values()]) if exact else None
        ),
    )


def exact_films(solution: Solution) -> ExactFilms | None:
    """Vary the thickness of the study's film, not worn; None unless its model is the exact contact."""
    film = solution.study.film
    if film.body is None or solution.study.traction.model is TractionModel.STRIPS:
        return None
    bare = Film(race_friction=film.race_friction)
    films = [replace(film, thickness=h, wear=None) if h > 0.0 else bare for h in EXACT_THICKNESSES]
    known = _found(EXACT_THICKNESSES, _factors(solution, films, TractionModel.EXACT))
    factors = [one.restitution_factor for one in known.values()]
    return ExactFilms(thickness=np.array([*known]), restitution_factor=np.array(factors))


def _found(at: Sequence[float], results: Sequence[Restitution | None]) -> dict[float, Restitution]:
    """The results that there are, by where they are."""
    return {x: one for x, one in zip(at, results, strict=True) if one is not None}


def _factors(solution: Solution, films: Sequence[Film], model: TractionModel) -> list[Restitution | None]:
    """Restitution under each film; None where the exact contact has no answer."""
    study, state = solution.study, solution.bearing
    settings = study.traction.by(model)

    def under(film: Film) -> Restitution | None:
        try:
            inner, outer = (race_slope(one, settings) for one in race_tracks(study.bearing, film, state))
        except (InputError, ConvergenceError):
            if model is TractionModel.STRIPS:
                raise
            return None
        k, mass = solution.ball_cage_stiffness, solution.inertia.mass
        dampings = state.dampings(inner.slope, outer.slope)
        return restitution(*dampings, ball_cage_stiffness=k, cage_mass=mass)

    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(under, films))
