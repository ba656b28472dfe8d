"""95 % intervals from the scatter between independent blocks of samples: the jackknife with Student's t.

The quantities are smooth functions of block sums, so leaving out one block after the other tells their
scatter (Efron & Tibshirani 1993, chapter 11). The blocks are independent randomisations of quasi-random
points, for which Student's t over the blocks holds its promise (L'Ecuyer, Nakayama, Owen & Tuffin 2023);
a bootstrap of single rows would not know that the rows spread evenly.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import stdtrit

from separatrix.sensitivity.records import Estimate
from separatrix.units import Array


def jackknife(sums: Array, quantity: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Value of a function of sums over blocks, and half the width of its 95 % interval.

    Parameters
    ----------
    sums : ndarray
        Shape (block, ...): sums over each block's samples.
    quantity : callable
        Takes sums of shape (...,), gives any shape; called once with all blocks and once without each.
    """
    blocks = len(sums)
    value = np.asarray(quantity(sums.sum(axis=0)))
    without = np.array([quantity(np.delete(sums, k, axis=0).sum(axis=0)) for k in range(blocks)])
    squares = np.sum((without - without.mean(axis=0)) ** 2, axis=0)
    half = stdtrit(blocks - 1, 0.975) * np.sqrt((blocks - 1) / blocks * squares)
    return value, np.asarray(half)


def estimate(value: float, half: float, low: float = -np.inf, high: float = np.inf) -> Estimate:
    """Estimate within the range that the quantity can have."""
    value, half = float(value), float(half)
    return Estimate(
        value=min(max(value, low), high),
        low=min(max(value - half, low), high),
        high=min(max(value + half, low), high),
    )


def by_block(values: Array, blocks: int) -> Array:
    """Sums over the samples of each block, shape (block, ...) of values of shape (sample, ...).

    Blocks follow one another; where the samples do not share out evenly, some have one more.
    """
    return np.array([part.sum(axis=0) for part in np.array_split(values, blocks)])
