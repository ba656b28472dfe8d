"""The film of a study on one race, as the contact sees it: friction and compliance across the groove."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from separatrix.chain.film_profile import Profile, worn_band
from separatrix.ground.units import Metre, Ratio
from separatrix.study.study import Film, Race, Wear


class Track(NamedTuple):
    """Friction f_BT [-] and film compliance L = h/G [m/Pa] of one race, each a number or a profile."""

    friction: Ratio | Profile
    compliance: float | Profile


def film_compliance(film: Film) -> float:
    """Shear compliance L = h/G of the film, total over ball and race [m/Pa]; 0 if the races are bare."""
    if film.body is None or film.thickness is None:
        return 0.0
    return 2.0 * film.thickness * (1.0 + film.body.poisson_ratio) / film.body.elastic_modulus


def track_of(film: Film, race: Race, semi_major: Metre) -> Track:
    """Film of a race under a contact whose semi-major axis lies across the groove."""
    whole, wear, thickness = film_compliance(film), film.wear, film.thickness
    if wear is None or thickness is None or not wear.touches(race):
        return Track(film.race_friction, whole)
    if not wear.is_band:
        return Track(_friction(wear, film.race_friction), _profile(wear, whole / thickness))
    half = 0.5 * wear.width if wear.width is not None else (wear.share or 0.0) * semi_major
    if half == 0.0:
        return Track(film.race_friction, whole)
    bare = wear.friction if wear.thickness == 0.0 else film.race_friction
    left = whole * wear.thickness / thickness
    if half >= semi_major:
        return Track(bare, left)
    return Track(worn_band(half, worn=bare, film=film.race_friction), worn_band(half, worn=left, film=whole))


def _profile(wear: Wear, per_metre: float) -> Profile:
    return Profile(across=wear.places.across, values=tuple(per_metre * h for h in wear.places.thicknesses))


def _friction(wear: Wear, on_film: Ratio) -> Profile:
    """Friction of the bare race between two neighbours without film, else that on the film."""
    h = wear.places.thicknesses
    between = [wear.friction if before == after == 0.0 else on_film for before, after in pairwise(h)]
    ends = [wear.friction if h[i] == 0.0 else on_film for i in (0, -1)]
    values = [ends[0], *np.repeat(between, 2).tolist(), ends[1]]
    return Profile(across=tuple(np.repeat(wear.places.across, 2).tolist()), values=tuple(values))
