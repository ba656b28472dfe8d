"""What knowing more is worth when one material is chosen by its mean margin in each environment.

For an input known exactly: the regression of Strong, Oakley & Brennan (2014), with cubic splines of the
input's normal score.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from separatrix.distribution import Distribution
from separatrix.sensitivity.scatter import jackknife
from separatrix.units import Array

Groups = Sequence[NDArray[np.intp]]
"""Cases of each environment."""

_SCORES = ndtri(np.array([0.05, 0.2, 0.4, 0.6, 0.8, 0.95]))
_END = 6.2
"""Normal scores of quasi-random points lie within this."""

_KNOTS = np.array([-_END] * 4 + _SCORES.tolist() + [_END] * 4)
_SHARES = ndtr(np.linspace(-_END, _END, 1001))
_GRID = (np.arange(256) + 0.5) / 256


def best_choices(means: Array, groups: Groups) -> float:
    """Mean of the best less the best of the means, summed over the environments.

    Parameters
    ----------
    means : ndarray
        Mean margin after each result, shape (result, case) [-].
    groups : sequence of ndarray
        Cases among which one is chosen.
    """
    return float(sum(means[:, g].max(axis=1).mean() - means[:, g].mean(axis=0).max() for g in groups))


def perfect_choice(
    known: Distribution, x: Array, margin: Array, cases: NDArray[np.intp], groups: Groups
) -> tuple[float, float]:
    """Value of knowing an input exactly, and half the width of its 95 % interval [-].

    Parameters
    ----------
    known : Distribution
        Of the input.
    x : ndarray
        Its values, shape (block, sample).
    margin : ndarray
        Shape (block, sample, case) [-].
    cases : ndarray
        Those that the input enters; the mean margin of the others does not depend on it.
    groups : sequence of ndarray
        Cases among which one is chosen.
    """
    after = _splines(_GRID)
    sums = np.array(
        [_normal_equations(_splines(_shares(known, one)), m) for one, m in zip(x, margin, strict=True)]
    )

    def value(of: Array) -> Array:
        size = after.shape[1]
        gram, right, total = of[:, :size], of[:-1, size:], of[-1, size:]
        means = np.broadcast_to(total / of[-1, 0], (len(after), len(total))).copy()
        fitted = np.linalg.pinv(gram[:-1], hermitian=True) @ right[:, cases]
        means[:, cases] = after @ fitted
        return np.array(best_choices(means, groups))

    found, half = jackknife(sums, value)
    return float(found), float(half)


def _normal_equations(basis: Array, margin: Array) -> Array:
    """Products of the basis with itself and with the margins; below them the count and sums."""
    both = np.hstack((basis, margin))
    counts = np.concatenate((np.full(basis.shape[1], float(len(basis))), margin.sum(axis=0)))
    return np.vstack((basis.T @ both, counts))


def _shares(known: Distribution, x: Array) -> Array:
    """Share of the distribution below each value, by its quantiles at a thousand places."""
    return np.asarray(np.interp(x, known.quantile(_SHARES), _SHARES))


def _splines(u: Array) -> Array:
    """Cubic B-splines of the normal score, shape (sample, spline)."""
    from scipy.interpolate import BSpline

    z = np.clip(ndtri(u), -_END, _END)
    return np.asarray(BSpline.design_matrix(z, _KNOTS, 3).toarray())
