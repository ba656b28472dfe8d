"""Terms of the law of the boundary, and what is thought of their coefficients before a run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.distribution import Distribution
from separatrix.uncertainty.regime import HELD, Play
from separatrix.units import Array, Ratio

WIDTH_KNOTS: Array = np.array([0.0, 0.25, 0.5, 1.0])
"""Those between which the logarithm of a width is one; the width below one half comes before that above."""

SIDE = WIDTH_KNOTS.size + 1
"""Coefficients of the width on one side of one half: at the knots, and where the land holds."""

MOST_CROSSED = 8
"""Parameters up to which products of two enter the shift."""

PRIOR_KNOT, PRIOR_LINEAR, PRIOR_SLOPE, PRIOR_SQUARE, PRIOR_PRODUCT = 0.03, 0.5, 0.25, 0.15, 0.15
"""Standard deviations of the coefficients of ln f thought possible before a run; that of a knot comes on top
of the traced curve's own scatter there."""

PRIOR_BEND, PRIOR_BEND_SLOPE, PRIOR_BEND_LINEAR = 6.0, 3.0, 0.5
"""The same of the slope of ln f below a bend: by itself, along eta, and by a standardised parameter."""

WIDTH, WIDTH_SPREAD, WIDTH_HELD = 0.12, 1.0, 0.3
"""Width of logit P in ln f thought likely; how far (a factor of e) it may be off, and differ on the land."""

LAND, LAND_SPREAD = -6.0, 3.0
"""Logit of the probability that a cage grows by its land, thought likely: that it does not."""

LAND_LINEAR, LAND_BEND = 1.0, 10.0
"""Standard deviations of the coefficients of that logit: along eta, friction and parameters; below a bend."""

UNIT_FRICTION: Ratio = 0.1


class Group(NamedTuple):
    """Coefficients of a kind: thought likely, and how far they may be off, shape (coefficient,) each."""

    centre: Array
    deviation: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scale:
    """Parameters of a cage and what makes them standard: (x - centre) / spread, of ln x where it is positive.

    `centre`, `spread` and `logarithmic` have shape (parameter,); `play` says where the boundary bends, if it
    does.
    """

    names: tuple[str, ...]
    centre: Array
    spread: Array
    logarithmic: NDArray[np.bool_]
    play: Play | None = None

    def standard(self, parameters: Array) -> Array:
        """Return standardised parameters, shape (sample, parameter) [-]."""
        known = np.asarray(parameters, dtype=np.float64)
        found = np.where(self.logarithmic, np.log(np.where(self.logarithmic, known, 1.0)), known)
        return np.asarray((found - self.centre) / self.spread)

    def hinges(self, parameters: Array) -> Array:
        """How far each sample lies below each bend, shape (sample, bend)."""
        return np.zeros((len(parameters), 0)) if self.play is None else self.play.hinges(parameters)

    def shift(self, knots: Array, eta: Array, parameters: Array) -> Array:
        """Terms of the shift of ln f, shape (sample, term)."""
        return features(knots, eta, self.standard(parameters), self.hinges(parameters))

    def width(self, eta: Array, parameters: Array) -> Array:
        """Terms of the logarithm of a width, shape (sample, `SIDE`): along eta, and where the land holds."""
        held = np.minimum(self.hinges(parameters)[:, :1].sum(axis=1) / HELD, 1.0)
        return np.column_stack([straight_pieces(eta, WIDTH_KNOTS), held])

    def land(self, eta: Array, parameters: Array) -> Array:
        """Terms of the logit of growing by the land at no friction of the pockets, shape (sample, term)."""
        ones = np.ones((len(parameters), 1))
        middle = (2.0 * eta - 1.0)[:, None]
        return np.concatenate([ones, middle, self.standard(parameters), self.hinges(parameters)], axis=1)

    def priors(self, scatter: Array) -> tuple[Group, Group, Group]:
        """Coefficients before any run, of shift, widths and land; the last one of the land is friction's.

        `scatter` is that of ln f of the traced curve at its knots, shape (knot,) [-].
        """
        count, bends = len(self.names), 0 if self.play is None else self.play.bends.size
        products = count * (count - 1) // 2 if count <= MOST_CROSSED else 0
        shift = [
            *np.hypot(scatter, PRIOR_KNOT),
            *[PRIOR_LINEAR] * count,
            *[PRIOR_SLOPE] * count,
            *[PRIOR_SQUARE] * count,
            *[PRIOR_PRODUCT] * products,
            *[PRIOR_BEND] * bends,
            *[PRIOR_BEND_SLOPE] * bends,
            *[PRIOR_BEND_LINEAR] * (count if bends else 0),
        ]
        land = [LAND_SPREAD, *[LAND_LINEAR] * (1 + count), *[LAND_BEND] * bends, LAND_LINEAR]
        likely = [math.log(WIDTH)] * WIDTH_KNOTS.size
        return (
            Group(np.zeros(len(shift)), np.array(shift)),
            Group(np.tile([*likely, 0.0], 2), np.tile([*[WIDTH_SPREAD] * WIDTH_KNOTS.size, WIDTH_HELD], 2)),
            Group(np.array([LAND, *[0.0] * (len(land) - 1)]), np.array(land)),
        )


def scale_of(names: Sequence[str], distributions: Sequence[Distribution], play: Play | None = None) -> Scale:
    """Scale of parameters from what is known of them: median and half the middle two thirds."""
    if not names:
        none = np.zeros(0)
        return Scale(names=(), centre=none, spread=none, logarithmic=none.astype(np.bool_), play=play)
    logarithmic = np.array([one.low > 0.0 for one in distributions], dtype=np.bool_)
    ends = np.array([one.quantile(np.array([0.16, 0.5, 0.84])) for one in distributions]).reshape(-1, 3)
    ends[logarithmic] = np.log(ends[logarithmic])
    relative = [one.standard_deviation / (one.mean if one.low > 0.0 else 1.0) for one in distributions]
    half = 0.5 * (ends[:, 2] - ends[:, 0])
    return Scale(
        names=tuple(names),
        centre=ends[:, 1],
        spread=np.where(half > 0.0, half, np.array(relative)),
        logarithmic=logarithmic,
        play=play,
    )


def features(knots: Array, eta: Array, standard: Array, hinges: Array) -> Array:
    """Terms of the shift, shape (sample, term): pieces in eta between knots, parameters, bends."""
    count = standard.shape[1]
    pieces = list(straight_pieces(eta, knots).T)
    linear = list(standard.T)
    slopes = [column * (2.0 * eta - 1.0) for column in linear]
    squares = [column**2 - 1.0 for column in linear]
    products = (
        [linear[i] * linear[j] for i in range(count) for j in range(i)] if count <= MOST_CROSSED else []
    )
    bends = list(hinges.T)
    bent = [column * (2.0 * eta - 1.0) for column in bends]
    mixed = [bends[0] * column for column in linear] if bends else []
    return np.stack([*pieces, *linear, *slopes, *squares, *products, *bends, *bent, *mixed], axis=1)


def straight_pieces(eta: Array, knots: Array) -> Array:
    """Straight pieces between knots, shape (sample, knot): 1 at its own knot, 0 at the others."""
    return np.stack([np.interp(eta, knots, unit) for unit in np.eye(knots.size)], axis=1)
