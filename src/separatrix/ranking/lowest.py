"""Mean friction of each candidate with its error, and with what probability it is the lowest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot, log, sqrt

import numpy as np

from separatrix.chain.pocket import standard_error, with_scatter
from separatrix.study import Friction
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True)
class MeanFriction:
    """Mean friction, its standard error (None if no scatter is known), and what is to be said of it.

    The error holds what was not tested: outside the tests the mean is known less well. `deviation` is the
    standard deviation of a new sample; `assumed` tells a scatter that nobody measured.
    """

    mean: Ratio
    error: Ratio | None = None
    deviation: Ratio | None = None
    assumed: bool = False
    extrapolation: tuple[str, ...] = ()

    def interval(self) -> tuple[Ratio, Ratio]:
        """95 % interval of the mean; the mean twice if its scatter is not known."""
        half = 1.96 * (self.error or 0.0)
        return max(0.0, self.mean - half), self.mean + half


def measured(friction: Friction) -> MeanFriction:
    """Mean and standard error of one measurement, with the widening for what was not tested."""
    error = standard_error(friction)
    return MeanFriction(
        friction.mean,
        None if error is None else hypot(error, friction.widening),
        friction.standard_deviation,
        friction.assumed_scatter,
        friction.extrapolation,
    )


def overall(frictions: Iterable[Friction | None]) -> MeanFriction | None:
    """Mean over the measured environments, each counting once; None if there is none."""
    found = [measured(friction) for friction in frictions if friction is not None]
    if not found:
        return None
    mean = sum(one.mean for one in found) / len(found)
    errors = [one.error for one in found if one.error is not None]
    return MeanFriction(
        mean,
        sqrt(sum(e * e for e in errors)) / len(found) if errors else None,
        assumed=any(one.assumed for one in found),
        extrapolation=tuple(dict.fromkeys(text for one in found for text in one.extrapolation)),
    )


def errors_of(frictions: Mapping[str, Friction | None], scatter: Ratio) -> dict[str, MeanFriction]:
    """Mean and standard error of those that were measured; without any scatter that of an unrepeated test."""
    return {name: measured(with_scatter(f, scatter)) for name, f in frictions.items() if f is not None}


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
