"""Likelihood of a linear model with scatter between samples and between tests, and its REML estimate.

For one group of tests: ``y = X b + u[sample] + e + m`` with ``u ~ N(0, s2)``, ``e ~ N(0, t2)`` and the
tests' own errors ``m ~ N(0, se2)``, which are known. Patterson and Thompson, Biometrika 58 (1971) 545:
restricted likelihood; Searle, Casella and McCulloch, Variance Components (1992), chapter 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from separatrix.units import Array, Ratio

LEAST_DEVIATION = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearModel:
    """Tests of one group: y shape (test,), design (test, coefficient), error (test,), sample (test,)."""

    y: Array
    design: Array
    error: Array
    sample: NDArray[np.intp]

    @property
    def freedom(self) -> int:
        """Tests beyond the coefficients."""
        return int(len(self.y) - self.design.shape[1])

    @property
    def has_repeats(self) -> bool:
        """Whether some sample was tested more than once."""
        return bool(np.bincount(self.sample).max() > 1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Conditional:
    """Fit for given variances, one for each node: log-likelihood (node,), mean and covariance of b."""

    log_likelihood: Array
    mean: Array
    covariance: Array


def conditional(model: LinearModel, between_samples: Array, between_tests: Array) -> Conditional:
    """Generalised least squares and restricted log-likelihood at each node of variances, shape (node,).

    A sample's tests share one deviation, so the inverse covariance is a diagonal less one outer product for
    each sample (Sherman and Morrison, Ann. Math. Stat. 21 (1950) 124).
    """
    X, y = model.design, model.y
    Z = np.eye(model.sample.max() + 1)[model.sample]
    w = 1.0 / (between_tests[:, None] + model.error**2)
    total = w @ Z
    share = between_samples[:, None] / (1.0 + between_samples[:, None] * total)
    full = np.column_stack([X, y])
    sums = np.einsum("kn,ns,ni->ksi", w, Z, full)
    moments = np.einsum("kn,ni,nj->kij", w, full, full) - np.einsum("ks,ksi,ksj->kij", share, sums, sums)
    A, b, c = moments[:, :-1, :-1], moments[:, :-1, -1], moments[:, -1, -1]
    covariance = np.linalg.inv(A)
    mean = np.einsum("kij,kj->ki", covariance, b)
    quadratic = c - np.einsum("ki,ki->k", mean, b)
    spread = np.log1p(between_samples[:, None] * total).sum(axis=1) - np.log(w).sum(axis=1)
    likelihood = -0.5 * (spread + np.linalg.slogdet(A)[1] + np.maximum(quadratic, 0.0))
    return Conditional(log_likelihood=likelihood, mean=mean, covariance=covariance)


@dataclass(frozen=True, slots=True, kw_only=True)
class VarianceComponents:
    """Standard deviations of ln f, so relative ones: between samples and between tests of one sample [-].

    `between_tests` is None where no sample was tested twice: then `between_samples` holds both.
    """

    between_samples: Ratio
    between_tests: Ratio | None


def variance_components(models: Sequence[LinearModel]) -> VarianceComponents | None:
    """REML estimate of the scatter that several groups share; None if no group has a test to spare."""
    from scipy import optimize

    minimize: Any = optimize.minimize
    useful = [model for model in models if model.freedom > 0]
    if not useful:
        return None
    separate = any(model.has_repeats for model in useful)
    scale = _rough_scatter(useful)

    def loss(deviations: Array) -> float:
        s, t = (deviations if separate else (0.0, deviations[0])) * np.array(scale)
        nodes = np.array([s * s]), np.array([max(t, LEAST_DEVIATION) ** 2])
        return -float(sum(conditional(model, *nodes).log_likelihood[0] for model in useful))

    found = min(
        (
            minimize(loss, start, method="L-BFGS-B", bounds=[(0.0, 1e3)] * len(start), options=_EXACT)
            for start in (([0.7, 0.7], [0.1, 1.0], [1.0, 0.1]) if separate else ([1.0], [0.3]))
        ),
        key=lambda result: float(result.fun),
    )
    deviations = [float(x) * scale for x in found.x]
    return VarianceComponents(
        between_samples=deviations[0], between_tests=deviations[1] if separate else None
    )


_EXACT = {"ftol": 1e-15, "gtol": 1e-9}


def _rough_scatter(models: Sequence[LinearModel]) -> float:
    """Residual standard deviation of ordinary least squares, at least a little."""
    squares = freedom = 0.0
    for model in models:
        b = np.linalg.lstsq(model.design, model.y, rcond=None)[0]
        squares += float(np.sum((model.y - model.design @ b) ** 2))
        freedom += model.freedom
    return max(float((squares / freedom) ** 0.5), 1e-6)
