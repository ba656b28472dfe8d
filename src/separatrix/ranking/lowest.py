"""With what probability each candidate has the lowest friction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, log, sqrt

import numpy as np

from separatrix.ranking.friction import MeanFriction, errors_of
from separatrix.study import Friction
from separatrix.units import Ratio

TIED_FROM: Ratio = 0.05
"""Probability of being below the leader from which a candidate is tied with it."""

_LEAST_ERROR = 1e-9
NODES = 32
"""Of Gauss's rule, between two of the places where a factor falls: the error is rounding."""

_REACH = 9.0
_STEPS = (-_REACH, -3.0, 0.0, 3.0, _REACH)
"""Where a factor begins to fall, falls, and has fallen, in its own standard deviations."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LowestFriction:
    """Probability of having the lowest mean friction, by candidate, and who cannot be told from the first.

    `tied` begins with the leader, the most probable one; without a tie it stands alone. One friction alone
    has no probability of being the lowest: there is nothing to compare it with.
    """

    probabilities: Mapping[str, Ratio]
    tied: tuple[str, ...]


def probability_lowest(frictions: Mapping[str, Friction | None], scatter: Ratio = 0.09) -> LowestFriction:
    """Probability that each material's friction is the lowest of all in one environment.

    Each mean is log-normal about what was measured, with its standard error; without any scatter the
    standard error is that of an unrepeated test. Candidates that were not measured take no part.

    Parameters
    ----------
    frictions : mapping
        Candidate to its friction, or None.
    scatter : float
        Relative standard deviation of an unrepeated test [-].
    """
    return lowest_among(errors_of(frictions, scatter))


def lowest_among(known: Mapping[str, MeanFriction]) -> LowestFriction:
    """The same of mean frictions with their standard errors, 0 where there is none."""
    names = list(known)
    if len(names) < 2:
        return LowestFriction(probabilities={}, tied=tuple(names))
    logs, errors = [list(column) for column in zip(*map(_log, known.values()), strict=True)]
    found = lowest_of(logs, errors)
    leader = int(np.argmax(found))
    tied = [leader, *(j for j in range(len(names)) if j != leader and _reaches(logs, errors, j, leader))]
    return LowestFriction(
        probabilities=dict(zip(names, found, strict=True)), tied=tuple(names[j] for j in tied)
    )


def lowest_of(means: Sequence[float], deviations: Sequence[float]) -> list[Ratio]:
    r"""Probability that each of several independent normal numbers is the smallest.

    :math:`P_i = \int \varphi(x) \prod_{j \ne i} \Phi((\mu_j - \mu_i - \sigma_i x) / \sigma_j) dx`, by
    Gauss's rule between the places where a factor begins to fall, falls, and has fallen.
    """
    from scipy.special import ndtr

    mu, sigma = np.array(means, dtype=float), np.array(deviations, dtype=float)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    found = []
    for i in range(mu.size):
        others, widths = np.delete(mu, i), np.delete(sigma, i)
        edges = (others - mu[i] + np.outer(_STEPS, widths)) / sigma[i]
        ends = np.unique(np.clip(np.append(edges.ravel(), [-_REACH, 0.0, _REACH]), -_REACH, _REACH))
        half = 0.5 * np.diff(ends)[:, None]
        x = ends[:-1, None] + half * (1.0 + nodes)
        beyond = ndtr((others - mu[i] - sigma[i] * x[..., None]) / widths).prod(axis=-1)
        share = float((half * weights * np.exp(-0.5 * x * x) * beyond).sum() / sqrt(2.0 * np.pi))
        found.append(min(share, 1.0))  # rounding may leave 2e-15 more
    return found


def may_be_lower(one: MeanFriction, leader: MeanFriction) -> bool:
    """Whether a mean friction lies below a leader's with a probability of `TIED_FROM` or more."""
    means, errors = zip(_log(leader), _log(one), strict=True)
    return _reaches(means, errors, 1, 0)


def _log(friction: MeanFriction) -> tuple[float, float]:
    """Logarithm of a mean, and its standard error; the least of either instead of 0."""
    mean = max(friction.mean, 1e-300)
    return log(mean), max((friction.error or 0.0) / mean, _LEAST_ERROR)


def _reaches(means: Sequence[float], deviations: Sequence[float], j: int, leader: int) -> bool:
    from scipy.special import ndtr

    distance = (means[leader] - means[j]) / hypot(deviations[leader], deviations[j])
    return bool(ndtr(distance) >= TIED_FROM)
