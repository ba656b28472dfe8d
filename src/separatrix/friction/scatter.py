"""Scatter between samples and between tests: restricted likelihood, and its posterior on a grid.

For one group of tests: ``y = X b + u[sample] + e + m`` with ``u ~ N(0, s2)``, ``e ~ N(0, t2)`` and the
tests' own errors ``m ~ N(0, se2)``, which are known. Patterson and Thompson, Biometrika 58 (1971) 545:
restricted likelihood; Searle, Casella and McCulloch, Variance Components (1992), chapter 6. The logarithm of
a group's scatter is normal about that of all groups, and this about the assumed one (Gelman and Hill, Data
Analysis Using Regression and Multilevel/Hierarchical Models (2007), chapters 12, 18).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from separatrix.ground.units import Array, Ratio


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
    def shows_scatter(self) -> bool:
        """Whether the tests show how samples scatter: two samples, and a test beyond the coefficients."""
        return self.freedom > 0 and bool(np.any(self.sample != self.sample[0]))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Conditional:
    """Fit for given variances, one for each node: log-likelihood (node,), mean and covariance of b."""

    log_likelihood: Array
    mean: Array
    covariance: Array


def conditional(model: LinearModel, between_samples: Array, between_tests: Array) -> Conditional:
    """Generalised least squares and restricted log-likelihood at each node of variances, shape (node,).

    A sample's tests share one deviation: its weighted mean has the variance 1/(sum of weights) + s2, and what
    is left within the sample that of the tests alone. Written so, nothing cancels for a small variance.
    """
    order = np.argsort(model.sample, kind="stable")
    full = np.column_stack([model.design, model.y])[order]
    starts, sample = np.unique(model.sample[order], return_index=True, return_inverse=True)[1:]
    w = 1.0 / (between_tests[:, None] + model.error[order] ** 2)
    total = np.add.reduceat(w, starts, axis=1)
    mean_of = np.add.reduceat(w[:, :, None] * full, starts, axis=1) / total[:, :, None]
    left = full - mean_of[:, sample]
    weight = total / (1.0 + between_samples[:, None] * total)
    moments = np.einsum("kn,kni,knj->kij", w, left, left) + np.einsum(
        "ks,ksi,ksj->kij", weight, mean_of, mean_of
    )
    A, b, c = moments[:, :-1, :-1], moments[:, :-1, -1], moments[:, -1, -1]
    covariance = np.linalg.inv(A)
    mean = np.einsum("kij,kj->ki", covariance, b)
    quadratic = c - np.einsum("ki,ki->k", mean, b)
    spread = np.log1p(between_samples[:, None] * total).sum(axis=1) - np.log(w).sum(axis=1)
    likelihood = -0.5 * (spread + np.linalg.slogdet(A)[1] + np.maximum(quadratic, 0.0))
    return Conditional(log_likelihood=likelihood, mean=mean, covariance=covariance)


BETWEEN_GROUPS = 0.2
"""Standard deviation of the logarithm of a group's scatter about that of all groups: a guess."""

OF_THE_ASSUMPTION = 0.3
"""Standard deviation of the logarithm of all groups' scatter about the assumed one: a guess."""

_LOGS = np.linspace(-4.0, 4.0, 65)
_LEAST = 1e-300
_SHARES = np.sqrt((np.arange(8) + 0.5) / 8.0)
"""Shares of the variance between samples, all as likely beforehand: one specimen run again differs less than
two specimens do (density proportional to the share; a guess)."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Posterior:
    """Nodes of the scatter of one group, with their weights, and the fit at each.

    `variance` and `weight` have shape (node,); `scatter` is the root of the mean variance [-].
    """

    variance: Array
    weight: Array
    fit: Conditional

    @property
    def scatter(self) -> Ratio:
        """Relative standard deviation of a new sample."""
        return float(np.sqrt(self.weight @ self.variance))

    def moments(self, contrast: Array) -> tuple[float, float]:
        """Mean and standard deviation of a combination of the coefficients."""
        means, variances = self._nodes(contrast)
        mean = float(self.weight @ means)
        return mean, float(np.sqrt(self.weight @ (variances + (means - mean) ** 2)))

    def quantile(self, contrast: Array, probability: Ratio) -> float:
        """Quantile of a combination of the coefficients: of a mixture of normals."""
        from scipy.optimize import brentq
        from scipy.special import ndtr

        means, variances = self._nodes(contrast)
        deviations = np.sqrt(variances)

        def excess(x: float) -> float:
            return float(self.weight @ ndtr((x - means) / deviations)) - probability

        low, high = float((means - 9.0 * deviations).min()), float((means + 9.0 * deviations).max())
        return float(brentq(excess, low, high, xtol=1e-12))

    def _nodes(self, contrast: Array) -> tuple[Array, Array]:
        return self.fit.mean @ contrast, np.einsum("i,kij,j->k", contrast, self.fit.covariance, contrast)


def posteriors(models: Sequence[LinearModel], default_scatter: Ratio) -> list[Posterior]:
    """Posterior of every group; one that has no test to spare keeps the prior that the others leave."""
    kernel = _normal(_LOGS[:, None] - _LOGS, BETWEEN_GROUPS)
    first = _normal(_LOGS[None, :], OF_THE_ASSUMPTION)[0]
    shape = np.exp(_LOGS)  # such that the mean square beforehand is that of the assumed scatter
    deviations = shape * (default_scatter / float(np.sqrt((first @ kernel) @ shape**2)))
    nodes = (deviations**2)[:, None]
    samples, tests = ((nodes * share).ravel() for share in (_SHARES, 1.0 - _SHARES))
    fits = [conditional(model, samples, tests) for model in models]
    # log-likelihood less its largest value, flat where the model fits exactly
    shape_of = (len(_LOGS), len(_SHARES))
    logs = [
        np.reshape(fit.log_likelihood - fit.log_likelihood.max(), shape_of)
        if model.freedom
        else np.zeros(shape_of)
        for fit, model in zip(fits, models, strict=True)
    ]
    messages = [_log(kernel @ np.exp(one).mean(axis=1)) for one in logs]
    variance = np.repeat(deviations**2, len(_SHARES))
    found = []
    for i, (fit, log_likelihood) in enumerate(zip(fits, logs, strict=True)):
        prior = _normalised(sum([*messages[:i], *messages[i + 1 :]], _log(first))) @ kernel
        weight = _normalised(log_likelihood + _log(prior)[:, None]).ravel()
        found.append(Posterior(variance=variance, weight=weight, fit=fit))
    return found


def _normal(distance: Array, deviation: float) -> Array:
    """Discrete normal distribution along the last axis."""
    weight = np.exp(-0.5 * (distance / deviation) ** 2)
    return np.asarray(weight / weight.sum(axis=-1, keepdims=True))


def _log(weight: Array) -> Array:
    """Logarithm; many equal tests leave weights too small for a number, which count as `_LEAST`."""
    return np.asarray(np.log(np.maximum(weight, _LEAST)))


def _normalised(log_weight: Array) -> Array:
    """Weights of sum 1."""
    weight = np.exp(log_weight - log_weight.max())
    return np.asarray(weight / weight.sum())
