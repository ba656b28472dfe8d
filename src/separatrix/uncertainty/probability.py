"""Probabilities out of samples: of a verdict, of being best, and who is tied.

An interval of a probability holds two doubts: so many samples only, and a boundary that only so many runs
have told. Samples give a share for each boundary that the runs allow; each share has Jeffreys' interval
(L. D. Brown, T. T. Cai, A. DasGupta, Statistical Science 16, 2001, 101-133), and their mixture over the
boundaries has the one shown. Samples that fill their space evenly scatter less than random ones, so it is on
the careful side.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from separatrix.units import Array, Ratio

ENDS_95 = (0.025, 0.975)
ENDS_90 = (0.05, 0.95)
SURE: Ratio = 0.95
"""A candidate that beats another in so many of the samples is told apart from it."""

_LEVELS: Array = np.asarray((np.arange(41) + 0.5) / 41.0, dtype=np.float64)


def mixed_interval(counts: Array, samples: int) -> tuple[Array, Array, Array]:
    """Probability and its 95 % interval from counts for several boundaries.

    Parameters
    ----------
    counts : ndarray
        Samples of which it is true, for each boundary, shape (draw, ...).
    samples : int
        Of how many.

    Returns
    -------
    tuple of ndarray
        Mean share, and the ends of its interval, shape (...) each [-].
    """
    known = np.asarray(counts, dtype=np.float64)
    levels = _LEVELS.reshape(-1, *([1] * known.ndim))
    spread = betaincinv(known + 0.5, samples - known + 0.5, levels)
    low, high = np.quantile(spread.reshape(-1, *known.shape[1:]), ENDS_95, axis=0)
    value = known.mean(axis=0) / samples
    low, high = np.where(value <= 0.0, 0.0, low), np.where(value >= 1.0, 1.0, high)
    return value, np.minimum(low, value), np.maximum(high, value)


def best_credit(thresholds: Array) -> Array:
    """Who has the largest threshold, shape (sample, case): 1, or an equal part where several share it."""
    best = thresholds >= thresholds.max(axis=1, keepdims=True)
    return np.asarray(best / best.sum(axis=1, keepdims=True))


def tie_groups(thresholds: Array, credit: Array) -> list[int]:
    """Group of each candidate, 1 the best; within a group nobody can be told from its leader.

    The leader is the one that is best most often; all that it beats in fewer than `SURE` of the samples are
    in its group. The rest are led by the best among them, and so on.

    Parameters
    ----------
    thresholds : ndarray
        Shape (sample, candidate) [-].
    credit : ndarray
        Probability of being best, shape (candidate,); it breaks ties of the medians.
    """
    middle = np.median(thresholds, axis=0)
    left = sorted(range(middle.size), key=lambda i: (-credit[i], -middle[i], i))
    groups, number = [0] * middle.size, 0
    while left:
        number += 1
        leader = left[0]
        beaten = (thresholds[:, [leader]] > thresholds).mean(axis=0)
        group = [i for i in left if i == leader or beaten[i] < SURE]
        for i in group:
            groups[i] = number
        left = [i for i in left if i not in group]
        left.sort(key=lambda i: (-middle[i], i))
    return groups


def quantiles(values: Array, ends: tuple[Ratio, Ratio] = ENDS_90) -> tuple[Array, Array, Array]:
    """Median, and the ends of an interval, of each column."""
    low, middle, high = np.quantile(values, (ends[0], 0.5, ends[1]), axis=0)
    return middle, low, high


def sizes(samples: int, first: int = 64) -> list[int]:
    """Return 64, 128, ... up to all samples, at which convergence is shown."""
    found, size = [], first
    while size < samples:
        found.append(size)
        size *= 2
    return [*found, samples]


def prefix_counts(true: NDArray[Any], ends: Sequence[int]) -> Array:
    """How many of the first so many samples are true, or their credit in sum, shape (size, case)."""
    total = np.cumsum(true, axis=0, dtype=np.float64)
    return np.asarray(total[np.array(ends) - 1])
