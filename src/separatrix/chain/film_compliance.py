"""The film of a study on one race, as the contact sees it: friction and compliance across the groove."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre, Ratio
from separatrix.study.study import Film, Race, Wear


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A quantity across the groove: linear between the places y, constant beyond them.

    Two equal places make a step.
    """

    across: tuple[Metre, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        y, values = np.array(self.across), np.array(self.values)
        if y.size == 0 or y.shape != values.shape or not np.isfinite(y).all() or (np.diff(y) < 0.0).any():
            rule = "must be finite, in increasing order, one place for each value [m]"
            raise InputError("Profile.across", rule, f"{self.across}")
        wrong = values[~((values >= 0.0) & (values < np.inf))]
        if wrong.size:
            raise InputError("Profile.values", "must be finite and >= 0", f"{wrong[0]:g}")

    def at(self, y: Array) -> Array:
        """Values at places, shape of y."""
        return np.asarray(np.interp(y, self.across, self.values))


def worn_band(half_width: Metre, *, worn: float, film: float) -> Profile:
    """Profile of a film that is worn off less than `half_width` from the middle."""
    w = half_width
    return Profile(across=(-w, -w, w, w), values=(film, worn, worn, film))


def pieces_across(half_width: Metre, *quantities: float | Profile) -> tuple[Array, list[Array]]:
    """Edges over |y| < half_width between which every quantity is linear, shape (edge,), rising [m].

    With the values of each quantity at both ends of every piece, from inside, shape (piece, 2).
    """
    places = {y for one in quantities if isinstance(one, Profile) for y in one.across if abs(y) < half_width}
    edges = np.array([-half_width, *sorted(places), half_width])

    def at_ends(one: float | Profile) -> Array:
        if not isinstance(one, Profile):
            return np.full((edges.size - 1, 2), one)
        near, far = (one.at(edges[:-1] + share * np.diff(edges)) for share in (0.25, 0.75))
        return np.stack([1.5 * near - 0.5 * far, 1.5 * far - 0.5 * near], axis=1)

    return edges, [at_ends(one) for one in quantities]


def film_compliance(film: Film) -> float:
    """Shear compliance L = h/G of the film, total over ball and race [m/Pa]; 0 if the races are bare."""
    if film.body is None or film.thickness is None:
        return 0.0
    return 2.0 * film.thickness * (1.0 + film.body.poisson_ratio) / film.body.elastic_modulus


def track_of(film: Film, race: Race, semi_major: Metre) -> tuple[Ratio | Profile, float | Profile]:
    """Friction f_BT [-] and compliance L = h/G [m/Pa] of a race's film under a contact of this half width."""
    whole, wear, thickness = film_compliance(film), film.wear, film.thickness
    if wear is None or thickness is None or not wear.touches(race):
        return (film.race_friction, whole)
    if not wear.is_band:
        y, h = wear.places
        return (
            _friction(wear, film.race_friction),
            Profile(across=y, values=tuple(whole / thickness * one for one in h)),
        )
    half = 0.5 * wear.width if wear.width is not None else (wear.share or 0.0) * semi_major
    if half == 0.0:
        return (film.race_friction, whole)
    bare = wear.friction if wear.thickness == 0.0 else film.race_friction
    left = whole * wear.thickness / thickness
    if half >= semi_major:
        return (bare, left)
    return (worn_band(half, worn=bare, film=film.race_friction), worn_band(half, worn=left, film=whole))


def _friction(wear: Wear, on_film: Ratio) -> Profile:
    """Friction of the bare race between two neighbours without film, else that on the film."""
    y, h = wear.places
    between = [wear.friction if before == after == 0.0 else on_film for before, after in pairwise(h)]
    ends = [wear.friction if h[i] == 0.0 else on_film for i in (0, -1)]
    values = [ends[0], *np.repeat(between, 2).tolist(), ends[1]]
    return Profile(across=tuple(np.repeat(y, 2).tolist()), values=tuple(values))
