"""Where the law of the boundary bends: as the land gets tighter than the pockets, it takes their place.

A cage on a wide land meets its balls first, and the land hardly matters. On a tight one the land holds it
off the balls, and the boundary rises steeply: on the shipped bearing by a factor of two where both plays are
equal, of six where the land has 0.8 of the pockets' play.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage import PlanarCage
from separatrix.distribution import Distribution
from separatrix.study import Guidance
from separatrix.units import Array, Ratio

BENDS: Array = np.log([1.16, 1.08, 1.0, 0.82, 0.6])
"""Logarithms of the land's play over the pockets' at which the slope of the boundary may change."""

RARE: Ratio = 1e-3
"""Share of a clearance's draws at either end that is left out where bends are looked for."""

HELD = 0.3
"""How far below the first bend the land has taken over, so that a run's outcome is as sharp as it gets."""

LEAST = 1e-12
"""Play of a pocket that has none [m]."""

_CLEARANCES = ("cage.land_clearance", "cage.pocket_clearance")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Play:
    """The land's play over the pockets' as a function of the uncertain parameters of a cage.

    Attributes
    ----------
    columns : tuple of int or None
        Of the parameters that are the land's and the pockets' clearance; None for one that is certain.
    certain : tuple of float
        What a certain one is [m].
    bends : ndarray
        Those of `BENDS` that the samples reach, falling, shape (bend,).
    """

    columns: tuple[int | None, int | None]
    certain: tuple[float, float]
    bends: Array

    def ratio(self, parameters: Array) -> Array:
        """Logarithm of the land's play over the pockets', shape (sample,)."""
        land, pocket = (
            np.full(len(parameters), value) if at is None else parameters[:, at]
            for at, value in zip(self.columns, self.certain, strict=True)
        )
        return np.asarray(np.log(land) - np.log(np.maximum(pocket, LEAST)))

    def hinges(self, parameters: Array) -> Array:
        """How far each sample lies below each bend, 0 above it, shape (sample, bend)."""
        return np.maximum(self.bends - self.ratio(parameters)[:, None], 0.0)

    def opened(self, cage: PlanarCage) -> PlanarCage:
        """Return the cage with its land no tighter than at the first bend, where its curve is traced.

        On a tight land the curve may lie beyond every friction, and would tell nothing of the others.
        """
        least = cage.pocket_clearance * math.exp(self.bends[0])
        if cage.land_clearance is None or cage.land_clearance >= least:
            return cage
        return replace(cage, land_clearance=least)


def play_of(cage: PlanarCage, names: Sequence[str], laws: Mapping[str, Distribution]) -> Play | None:
    """Bends of the boundary within the range of a cage's clearances; None without any.

    Parameters
    ----------
    cage : PlanarCage
        With every input at its mean.
    names : sequence of str
        Uncertain parameters, in the order of their columns.
    laws : mapping
        Their distributions.
    """
    if cage.guidance is Guidance.BALL or cage.land_clearance is None:
        return None
    certain = (cage.land_clearance, cage.pocket_clearance)
    ends = [_ends(laws.get(name), value) for name, value in zip(_CLEARANCES, certain, strict=True)]
    low, high = np.log(ends[0]) - np.log(np.maximum(ends[1], LEAST))[::-1]
    bends = np.array([bend for bend in BENDS if low < bend < high])
    columns = [names.index(name) if name in names else None for name in _CLEARANCES]
    return Play(columns=(columns[0], columns[1]), certain=certain, bends=bends) if bends.size else None


def _ends(law: Distribution | None, certain: float) -> Array:
    """Range of a clearance without its rare ends [m]."""
    return np.full(2, certain) if law is None else law.quantile(np.array([RARE, 1.0 - RARE]))
