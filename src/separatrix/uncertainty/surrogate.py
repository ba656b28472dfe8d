r"""How the boundary moves with the cage: a logistic law of single runs, fitted where they are undecided.

.. math:: \operatorname{logit} P(\text{grow}) = \frac{\ln f - \ln f_{1/2}(\eta) - \delta(x, \eta)}{w_\pm}

for each kick, with the traced curve :math:`f_{1/2}` of the cage as it is, a shift :math:`\delta` of low
order in the standardised parameters x of the cage and in :math:`\eta`, bends where the land takes the place
of the pockets (`regime`), and a width on either side of one half. Coefficients and widths have normal priors;
the mode is found by Fisher scoring, and their posterior is normal about it (Laplace's approximation: D. J. C.
MacKay, Information Theory, Inference, and Learning Algorithms, 2003, ch. 27).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator, Philox
from numpy.typing import NDArray
from scipy.special import expit

from separatrix.distribution import Distribution
from separatrix.uncertainty.regime import HELD, Play
from separatrix.uncertainty.traced import FEW, TracedBoundary
from separatrix.units import Array, Ratio

WIDTH_KNOTS: Array = np.array([0.0, 0.25, 0.5, 1.0])
"""Those between which the logarithm of a width is one; the width below one half comes before that above."""

MOST_CROSSED = 8
"""Parameters up to which products of two enter the shift."""

PRIOR_KNOT, PRIOR_LINEAR, PRIOR_SLOPE, PRIOR_SQUARE, PRIOR_PRODUCT = 0.03, 0.5, 0.25, 0.15, 0.15
"""Standard deviations of the coefficients of ln f thought possible before a run; that of a knot comes on top
of the traced curve's own scatter there."""

PRIOR_BEND, PRIOR_BEND_SLOPE, PRIOR_BEND_LINEAR = 6.0, 3.0, 0.5
"""The same of the slope of ln f below a bend: by itself, along eta, and by a standardised parameter."""

WIDTH, WIDTH_SPREAD = 0.12, 1.0
"""Width of logit P in ln f thought likely, and how far (a factor of e) it may be off."""

STEPS, SETTLED = 60, 1e-9
HALVED = tuple(0.5**k for k in range(20))
WIDTHS = 2 * (WIDTH_KNOTS.size + 1)
"""Coefficients of the widths, the last ones of a kick's."""


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

    def terms(self, knots: Array, eta: Array, parameters: Array) -> Array:
        """Terms of the shift, shape (sample, term)."""
        return features(knots, eta, self.standard(parameters), self.hinges(parameters))

    def pieces(self, eta: Array, parameters: Array) -> Array:
        """Terms of the logarithm of a width, shape (sample, piece): along eta, and how far the land holds."""
        hinges = self.hinges(parameters)
        held = np.minimum(hinges[:, :1].sum(axis=1) / HELD, 1.0)
        return np.column_stack([_pieces(eta, WIDTH_KNOTS), held])


def scale_of(names: Sequence[str], distributions: Sequence[Distribution]) -> Scale:
    """Scale of parameters from what is known of them: median and half the middle two thirds."""
    if not names:
        none = np.zeros(0)
        return Scale(names=(), centre=none, spread=none, logarithmic=none.astype(np.bool_))
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
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Points:
    """Single runs: shape (run,) each but `parameters`, shape (run, parameter).

    `offset` is ln f less that of the traced curve; `kick` the place of the kick, `grew` whether the run grew.
    """

    kick: Array
    restitution_factor: Array
    parameters: Array
    offset: Array
    grew: Array

    def of(self, chosen: Array) -> Points:
        """Return some of the runs."""
        return Points(
            kick=self.kick[chosen],
            restitution_factor=self.restitution_factor[chosen],
            parameters=self.parameters[chosen],
            offset=self.offset[chosen],
            grew=self.grew[chosen],
        )

    def __add__(self, other: Points) -> Points:
        def both(name: str) -> Array:
            return np.concatenate([getattr(self, name), getattr(other, name)])

        return Points(
            kick=both("kick"),
            restitution_factor=both("restitution_factor"),
            parameters=both("parameters"),
            offset=both("offset"),
            grew=both("grew"),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Surrogate:
    """Fitted law of every kick.

    Attributes
    ----------
    scale : Scale
        Of the parameters.
    knots : ndarray
        Restitution factors of the traced curve, between which its own correction is a straight line [-].
    mode : ndarray
        Coefficients of the shift, then logarithms of both widths at `WIDTH_KNOTS`, shape (kick, coefficient).
    root : ndarray
        Root of their covariance, shape (kick, coefficient, coefficient).
    misfit : float
        Standard deviation of ln f that held-out runs show beyond their own scatter [-].
    clear : float
        Share of growing runs that is clearly more than half [-].
    seed : int
        Of the draws.
    """

    scale: Scale
    knots: Array
    mode: Array
    root: Array
    misfit: float
    clear: Ratio
    seed: int

    def coefficients(self, draw: int | None) -> tuple[Array, Array]:
        """Coefficients, shape (kick, coefficient), and the misfit of each kick: the mode, or a draw."""
        if draw is None:
            return self.mode, np.zeros(len(self.mode))
        kicks, count = self.mode.shape
        normal = Generator(Philox(key=[self.seed, draw])).standard_normal((kicks, count + 1))
        return self.mode + np.einsum("kij,kj->ki", self.root, normal[:, 1:]), self.misfit * normal[:, 0]

    def terms(self, eta: Array, parameters: Array) -> Array:
        """Terms of the shift, shape (sample, term)."""
        return self.scale.terms(self.knots, eta, parameters)

    def shift(self, eta: Array, parameters: Array, draw: int | None) -> Array:
        """Shift of ln f of each kick, shape (kick, sample)."""
        found, misfit = self.coefficients(draw)
        terms = self.terms(eta, parameters)
        return np.asarray(found[:, :-WIDTHS] @ terms.T + misfit[:, None])

    def shifts(self, kick: int, nodes: Array, parameters: Array, draw: int | None) -> Array:
        """Shift of one kick at every node for every sample, shape (sample, node)."""
        samples = len(parameters)
        found, misfit = self.coefficients(draw)
        columns = [
            self.terms(np.full(samples, eta), parameters) @ found[kick, :-WIDTHS] + misfit[kick]
            for eta in nodes
        ]
        return np.stack(columns, axis=1)

    def around(self, half: Array, eta: Array, parameters: Array, draw: int | None) -> tuple[Array, Array]:
        """Frictions at which few, and clearly more than half, of the runs grow, shape (kick, sample) each.

        `half` holds those of the traced curve at which half of them grow.
        """
        found, _ = self.coefficients(draw)
        pieces = self.scale.pieces(eta, parameters)
        below = np.exp(found[:, -WIDTHS : -WIDTHS // 2] @ pieces.T)
        above = np.exp(found[:, -WIDTHS // 2 :] @ pieces.T)
        middle = half * np.exp(self.shift(eta, parameters, draw))
        return middle * np.exp(logit(FEW) * below), middle * np.exp(logit(self.clear) * above)


def logit(share: Ratio) -> float:
    """Logarithm of the odds."""
    return math.log(share / (1.0 - share))


def features(knots: Array, eta: Array, standard: Array, hinges: Array) -> Array:
    """Terms of the shift, shape (sample, term): pieces in eta between knots, parameters, bends."""
    count = standard.shape[1]
    pieces = list(_pieces(eta, knots).T)
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


def _pieces(eta: Array, knots: Array) -> Array:
    """Straight pieces between knots, shape (sample, knot): 1 at its own knot, 0 at the others."""
    return np.stack([np.interp(eta, knots, unit) for unit in np.eye(knots.size)], axis=1)


def prior(count: int, bends: int, scatter: Array) -> Array:
    """Standard deviations of the coefficients before any run, those of the widths last.

    Parameters
    ----------
    count, bends : int
        Parameters, and bends.
    scatter : ndarray
        Of ln f of the traced curve at its knots, shape (knot,) [-].
    """
    products = count * (count - 1) // 2 if count <= MOST_CROSSED else 0
    parts = (
        (PRIOR_LINEAR, count),
        (PRIOR_SLOPE, count),
        (PRIOR_SQUARE, count),
        (PRIOR_PRODUCT, products),
        (PRIOR_BEND, bends),
        (PRIOR_BEND_SLOPE, bends),
        (PRIOR_BEND_LINEAR, count if bends else 0),
    )
    shift = [np.full(n, deviation) for deviation, n in parts]
    return np.concatenate([np.hypot(scatter, PRIOR_KNOT), *shift, np.full(WIDTHS, WIDTH_SPREAD)])


def fitted(points: Points, scale: Scale, traced: TracedBoundary, *, seed: int) -> Surrogate:
    """Law of every kick by penalised likelihood, each from its own runs."""
    modes, roots = [], []
    for kick in range(len(traced.kicks)):
        own = points.of(points.kick == kick)
        eta, bends = own.restitution_factor, 0 if scale.play is None else scale.play.bends.size
        terms = scale.terms(traced.restitution_factors, eta, own.parameters)
        deviation = prior(len(scale.names), bends, traced.error[kick, 1])
        runs = _Runs(terms, scale.pieces(eta, own.parameters), own.offset, own.grew)
        mode, root = _mode(runs, deviation)
        modes.append(mode)
        roots.append(root)
    return Surrogate(
        scale=scale,
        knots=traced.restitution_factors,
        mode=np.stack(modes),
        root=np.stack(roots),
        misfit=0.0,
        clear=traced.targets[2],
        seed=seed,
    )


class _Runs(NamedTuple):
    """Runs of one kick: terms of shift and widths, offset, and whether they grew."""

    terms: Array
    pieces: Array
    offset: Array
    grew: Array


def _mode(runs: _Runs, deviation: Array) -> tuple[Array, Array]:
    """Mode of the coefficients and the root of their covariance, by Fisher scoring with halved steps."""
    centre = np.zeros(deviation.size)
    centre[-WIDTHS:] = math.log(WIDTH)
    found = centre.copy()
    value = _objective(found, runs, centre, deviation)
    for _ in range(STEPS):
        gradient, information = _scores(found, runs, centre, deviation)
        step = np.linalg.solve(information, gradient)
        share = next(
            (s for s in HALVED if _objective(found + s * step, runs, centre, deviation) >= value), 0.0
        )
        found = found + share * step
        new = _objective(found, runs, centre, deviation)
        if new - value <= SETTLED * abs(value):
            break
        value = new
    _, information = _scores(found, runs, centre, deviation)
    return found, np.linalg.inv(np.linalg.cholesky(information)).T


def logits(found: Array, terms: Array, pieces: Array, offset: Array) -> tuple[Array, Array]:
    """Logit of P(grow) of runs, and the width of each, shape (run,)."""
    distance = offset - terms @ found[:-WIDTHS]
    below, above = pieces @ found[-WIDTHS : -WIDTHS // 2], pieces @ found[-WIDTHS // 2 :]
    width = np.exp(np.where(distance < 0.0, below, above))
    return distance / width, width


def _objective(found: Array, runs: _Runs, centre: Array, deviation: Array) -> float:
    """Logarithm of the penalised likelihood."""
    z, _ = logits(found, runs.terms, runs.pieces, runs.offset)
    likelihood = float(np.sum(runs.grew * z - np.logaddexp(0.0, z)))
    return likelihood - 0.5 * float(np.sum(((found - centre) / deviation) ** 2))


def _scores(found: Array, runs: _Runs, centre: Array, deviation: Array) -> tuple[Array, Array]:
    """Gradient of the penalised likelihood, and its expected information."""
    z, width = logits(found, runs.terms, runs.pieces, runs.offset)
    share = expit(z)
    below, above = (z * (z < 0.0))[:, None], (z * (z >= 0.0))[:, None]
    slope = np.concatenate([-runs.terms / width[:, None], -below * runs.pieces, -above * runs.pieces], axis=1)
    gradient = slope.T @ (runs.grew - share) - (found - centre) / deviation**2
    weighted = slope * (share * (1.0 - share))[:, None]
    return gradient, weighted.T @ slope + np.diag(deviation**-2.0)
