r"""When a cage grows, as a law of single runs, fitted where they are undecided.

.. math:: P = 1 - (1 - p)(1 - p_\text{land}), \quad
    \operatorname{logit} p = \frac{\ln f - \ln f_{1/2}(\eta) - \delta(x, \eta)}{w_\pm}

for each kick, with the traced curve :math:`f_{1/2}` of the cage as it is, a shift :math:`\delta` of low
order in the standardised parameters x of the cage and in :math:`\eta`, bends where the land takes the place
of the pockets (`regime`), a width on either side of one half, and the probability to grow by the land, which
falls with the friction of the pockets. Coefficients have normal priors; the mode is found by Fisher scoring,
and their posterior is normal about it (Laplace's approximation: D. J. C. MacKay, Information Theory,
Inference, and Learning Algorithms, 2003, ch. 27).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.random import Generator, Philox
from scipy.special import expit

from separatrix.uncertainty.terms import SIDE, UNIT_FRICTION, Scale
from separatrix.uncertainty.traced import FEW, TracedBoundary
from separatrix.units import Array, Ratio

STEPS, SETTLED = 60, 1e-7
HALVED = tuple(0.5**k for k in range(20))
LONGEST = 2.0
"""Standard deviations of its prior by which a coefficient may move in a step of the scoring."""

LEAST_SHARE = 1e-12
"""Probability to which those that are smaller are raised."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Points:
    """Single runs: shape (run,) each but `parameters`, shape (run, parameter).

    `offset` is ln f less that of the traced curve; `kick` the place of the kick, `grew` whether the run grew.
    """

    kick: Array
    restitution_factor: Array
    parameters: Array
    offset: Array
    friction: Array
    grew: Array

    def of(self, chosen: Array) -> Points:
        """Return some of the runs."""
        return Points(**{field.name: getattr(self, field.name)[chosen] for field in fields(Points)})

    def __add__(self, other: Points) -> Points:
        both = {
            f.name: np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(Points)
        }
        return Points(**both)


class Coefficients(NamedTuple):
    """Coefficients of kicks: of shift, both widths and the land, shape (kick, term); the misfit of each."""

    shift: Array
    below: Array
    above: Array
    land: Array
    misfit: Array


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
        Coefficients of the shift, of both widths' logarithms, and of the land, shape (kick, coefficient).
    root : ndarray
        Root of their covariance, shape (kick, coefficient, coefficient).
    misfit : float
        Standard deviation of ln f that held-out runs show beyond their own scatter [-].
    clear : float
        Share of whirling runs that is clearly more than half [-].
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

    def coefficients(self, draw: int | None) -> Coefficients:
        """Coefficients of every kick: the mode, or a draw; those of the land stay at their mode.

        Where no run grew by the land their posterior is far from normal: draws would make cages grow by it.
        """
        kicks, count = self.mode.shape
        if draw is None:
            return self._parted(self.mode, np.zeros(kicks))
        normal = Generator(Philox(key=[self.seed, draw])).standard_normal((kicks, count + 1))
        found = self.mode + np.einsum("kij,kj->ki", self.root, normal[:, 1:])
        drawn = self._parted(found, self.misfit * normal[:, 0])
        return drawn._replace(land=self._parted(self.mode, drawn.misfit).land)

    def _parted(self, found: Array, misfit: Array) -> Coefficients:
        ends = np.cumsum([self.shift_terms, SIDE, SIDE])
        shift, below, above, land = np.split(found, ends, axis=1)
        return Coefficients(shift, below, above, land, misfit)

    @property
    def shift_terms(self) -> int:
        """Number of terms of the shift."""
        return len(self.scale.priors(np.zeros(self.knots.size))[0].centre)

    def terms(self, eta: Array, parameters: Array) -> Array:
        """Terms of the shift, shape (sample, term)."""
        return self.scale.shift(self.knots, eta, parameters)

    def shift(self, eta: Array, parameters: Array, draw: int | None) -> Array:
        """Shift of ln f of each kick, shape (kick, sample)."""
        found = self.coefficients(draw)
        return np.asarray(found.shift @ self.terms(eta, parameters).T + found.misfit[:, None])

    def shifts(self, kick: int, nodes: Array, parameters: Array, draw: int | None) -> Array:
        """Shift of one kick at every node for every sample, shape (sample, node)."""
        samples = len(parameters)
        found = self.coefficients(draw)
        columns = [
            self.terms(np.full(samples, eta), parameters) @ found.shift[kick] + found.misfit[kick]
            for eta in nodes
        ]
        return np.stack(columns, axis=1)

    def around(
        self, half: Array, eta: Array, parameters: Array, draw: int | None
    ) -> tuple[Array, Array, Array]:
        """Frictions that part the outcomes of a kick, shape (kick, sample) each.

        Few of the runs whirl from the first, below which the land drives the cage, to the second; clearly
        more than half of them above the last. `half` holds those of the traced curve at which half of them
        whirl.
        """
        found = self.coefficients(draw)
        middle = half * np.exp(found.shift @ self.terms(eta, parameters).T + found.misfit[:, None])
        pieces = self.scale.width(eta, parameters)
        below, above = (np.exp(side @ pieces.T) for side in (found.below, found.above))
        still = found.land[:, :-1] @ self.scale.land(eta, parameters).T
        slope = found.land[:, -1:] / UNIT_FRICTION
        ends = []
        for share, width in ((FEW, below), (self.clear, above)):
            by_land = expit(still + slope * middle * np.exp(logit(share) * width))
            left = np.maximum((share - by_land) / (1.0 - by_land), LEAST_SHARE)
            ends.append(np.where(by_land < share, middle * np.exp(np.log(left / (1.0 - left)) * width), 0.0))
        needed = (still - logit(FEW)) / np.maximum(-slope, LEAST_SHARE)
        return np.maximum(needed, 0.0), ends[0], ends[1]


def logit(share: Ratio) -> float:
    """Logarithm of the odds."""
    return math.log(share / (1.0 - share))


def fitted(
    points: Points, scale: Scale, traced: TracedBoundary, *, seed: int, near: Surrogate | None = None
) -> Surrogate:
    """Law of every kick by penalised likelihood, each from its own runs; `near` is where it is looked for."""
    modes, roots = [], []
    for kick in range(len(traced.kicks)):
        own = points.of(points.kick == kick)
        groups = scale.priors(traced.error[kick, 1])
        centre, deviation = (np.concatenate(parts) for parts in zip(*groups, strict=True))
        start = centre if near is None else near.mode[kick]
        mode, root = _mode(runs_of(own, scale, traced.restitution_factors), start, centre, deviation)
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


class Runs(NamedTuple):
    """Runs of one kick: terms of shift, width and land, offset, and whether they grew."""

    shift: Array
    width: Array
    land: Array
    offset: Array
    grew: Array


def runs_of(points: Points, scale: Scale, knots: Array) -> Runs:
    """Terms of runs of one kick."""
    eta, known = points.restitution_factor, points.parameters
    land = np.column_stack([scale.land(eta, known), points.friction / UNIT_FRICTION])
    return Runs(scale.shift(knots, eta, known), scale.width(eta, known), land, points.offset, points.grew)


class Foretold(NamedTuple):
    """What a law says of runs: P(whirl), what part of it is the pockets', logits of both, and the width."""

    share: Array
    by_pockets: Array
    pockets: Array
    land: Array
    width: Array


def foretold_of(found: Array, runs: Runs) -> Foretold:
    """P(whirl) of runs by coefficients of their kick, shape (run,) each."""
    count = runs.shift.shape[1]
    shift, below, above, land = np.split(found, [count, count + SIDE, count + 2 * SIDE])
    distance = runs.offset - runs.shift @ shift
    width = np.where(distance < 0.0, runs.width @ below, runs.width @ above)
    width = np.exp(width)
    pockets, by_land = distance / width, runs.land @ land
    share = np.maximum(-np.expm1(-np.logaddexp(0.0, pockets) - np.logaddexp(0.0, by_land)), LEAST_SHARE)
    return Foretold(share, expit(pockets) / share, pockets, by_land, width)


def _mode(runs: Runs, start: Array, centre: Array, deviation: Array) -> tuple[Array, Array]:
    """Mode of the coefficients and the root of their covariance, by Fisher scoring with shortened steps."""
    found = start
    value = _objective(found, runs, centre, deviation)
    for _ in range(STEPS):
        gradient, information = _scores(found, runs, centre, deviation)
        step = np.linalg.solve(information, gradient)
        step *= min(1.0, LONGEST / float(np.max(np.abs(step) / deviation)))
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


def _objective(found: Array, runs: Runs, centre: Array, deviation: Array) -> float:
    """Logarithm of the penalised likelihood."""
    told = foretold_of(found, runs)
    dies = -np.logaddexp(0.0, told.pockets) - np.logaddexp(0.0, told.land)
    likelihood = float(np.sum(np.where(runs.grew > 0.5, np.log(told.share), dies)))
    return likelihood - 0.5 * float(np.sum(((found - centre) / deviation) ** 2))


def _scores(found: Array, runs: Runs, centre: Array, deviation: Array) -> tuple[Array, Array]:
    """Gradient of the penalised likelihood, and its expected information.

    With P = 1 - (1 - p)(1 - p_land) the slope of P is (1 - P)(p dz + p_land dz_land).
    """
    told = foretold_of(found, runs)
    z = told.pockets
    part = told.by_pockets[:, None]
    slope = np.concatenate(
        [
            -part * runs.shift / told.width[:, None],
            -part * (z * (z < 0.0))[:, None] * runs.width,
            -part * (z * (z >= 0.0))[:, None] * runs.width,
            (expit(told.land) / told.share)[:, None] * runs.land,
        ],
        axis=1,
    )
    gradient = slope.T @ (runs.grew - told.share) - (found - centre) / deviation**2
    weighted = slope * (told.share * (1.0 - told.share))[:, None]
    return gradient, weighted.T @ slope + np.diag(deviation**-2.0)
