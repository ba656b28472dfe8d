"""Posterior of the scatter of each group, on a grid, pooled in part over the groups.

The logarithm of a group's scatter is normal about that of all groups, and this about the assumed scatter
(Gelman and Hill, Data Analysis Using Regression and Multilevel/Hierarchical Models (2007), chapters 12, 18).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from separatrix.friction.fit.components import Conditional, LinearModel, conditional
from separatrix.units import Array, Ratio

BETWEEN_GROUPS = 0.2
"""Standard deviation of the logarithm of a group's scatter about that of all groups: a guess."""

OF_THE_ASSUMPTION = 0.3
"""Standard deviation of the logarithm of all groups' scatter about the assumed one: a guess."""

_LOGS = np.linspace(-4.0, 4.0, 65)
_LEAST = 1e-300
_SHARES = np.sqrt((np.arange(8) + 0.5) / 8.0)
"""Shares of the variance that lie between samples, all as likely beforehand: one specimen run again differs
less than two specimens do (density proportional to the share; a guess)."""


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
    deviations = _nodes(default_scatter, first @ kernel)
    fits = [_fits(model, deviations) for model in models]
    logs = [_relative(fit, model) for fit, model in zip(fits, models, strict=True)]
    messages = [_log(kernel @ np.exp(one).mean(axis=1)) for one in logs]
    found = []
    for i, (fit, log_likelihood) in enumerate(zip(fits, logs, strict=True)):
        prior = _normalised(sum([*messages[:i], *messages[i + 1 :]], _log(first))) @ kernel
        weight = _normalised(log_likelihood + _log(prior)[:, None]).ravel()
        variance = np.repeat(deviations**2, len(_SHARES))
        found.append(Posterior(variance=variance, weight=weight, fit=fit))
    return found


def _nodes(default_scatter: Ratio, prior: Array) -> Array:
    """Scatters at the nodes, such that their mean square beforehand is that of the assumed scatter."""
    shape: Array = np.exp(_LOGS)
    return shape * (default_scatter / float(np.sqrt(prior @ shape**2)))


def _fits(model: LinearModel, deviations: Array) -> Conditional:
    variance = (deviations**2)[:, None]
    samples, tests = (variance * share for share in (_SHARES, 1.0 - _SHARES))
    return conditional(model, samples.ravel(), tests.ravel())


def _relative(fit: Conditional, model: LinearModel) -> Array:
    """Log-likelihood less its largest value, shape (scatter, share); flat where the model fits exactly."""
    shape = (len(_LOGS), len(_SHARES))
    if model.freedom == 0:
        return np.zeros(shape)
    relative: Array = fit.log_likelihood - fit.log_likelihood.max()
    return relative.reshape(shape)


def _normal(distance: Array, deviation: float) -> Array:
    """Discrete normal distribution along the last axis."""
    weight: Array = np.exp(-0.5 * (distance / deviation) ** 2)
    normal: Array = weight / weight.sum(axis=-1, keepdims=True)
    return normal


def _log(weight: Array) -> Array:
    """Logarithm; many equal tests leave weights too small for a number, which count as `_LEAST`."""
    log: Array = np.log(np.maximum(weight, _LEAST))
    return log


def _normalised(log_weight: Array) -> Array:
    """Weights of sum 1."""
    weight = np.exp(log_weight - log_weight.max())
    normalised: Array = weight / weight.sum()
    return normalised
