"""A quantity that varies across the groove: friction and film of a worn track."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre


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


def ends_of(quantity: float | Profile, edges: Array) -> Array:
    """Values at both ends of the pieces between rising edges, from inside, shape (piece, 2).

    A profile is linear in each piece: its places are among the edges.
    """
    if not isinstance(quantity, Profile):
        return np.full((edges.size - 1, 2), quantity)
    low, high = edges[:-1], edges[1:]
    near, far = (quantity.at(low + share * (high - low)) for share in (0.25, 0.75))
    return np.stack([1.5 * near - 0.5 * far, 1.5 * far - 0.5 * near], axis=1)


def edges_of(half_width: Metre, *quantities: float | Profile) -> Array:
    """Edges over |y| < half_width between which every quantity is linear, in rising order [m]."""
    places = {y for one in quantities if isinstance(one, Profile) for y in one.across if abs(y) < half_width}
    return np.array([-half_width, *sorted(places), half_width])
