"""Friction of each material in each environment as a function of slip speed and pressure, from all tests.

The logarithm of friction is fitted: friction is positive, tests scatter by a share of it, and a power law of
speed, pressure or pV is a straight line (docs/theory/friction.md).

Scatter between samples and between tests is by restricted likelihood, with its posterior on a grid. For one
group of tests: ``y = X b + u[sample] + e + m`` with ``u ~ N(0, s2)``, ``e ~ N(0, t2)`` and the tests' own
errors ``m ~ N(0, se2)``, which are known. Patterson and Thompson, Biometrika 58 (1971) 545: restricted
likelihood; Searle, Casella and McCulloch, Variance Components (1992), chapter 6. The logarithm of a group's
scatter is normal about that of all groups, and this about the assumed one (Gelman and Hill, Data Analysis
Using Regression and Multilevel/Hierarchical Models (2007), chapters 12, 18).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import exp, hypot, sqrt
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from separatrix.friction.friction_file import CONDITIONS, PRODUCT, FrictionTest
from separatrix.friction.friction_law import (
    Asked,
    Covariates,
    Prediction,
    Range,
    at_temperature,
    covariates,
    limited,
    tested_range,
    values_of,
)
from separatrix.ground.units import Array, Kelvin, Ratio


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


DEFAULT_SCATTER: Ratio = 0.09
"""Standard deviation that an unrepeated test is assumed to have, as a share of its mean: a guess. A 25 %
repeatability limit over 2.8, borrowed from ASTM D2981, which states it for wear life and not for friction."""

GroupKey = tuple[str, str]  # material and environment


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A coefficient with its standard error and its 95 % interval."""

    value: float
    standard_error: float
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MaterialFit:
    """Friction of one material in one environment.

    `slopes` are exponents, by the name of their condition; `scatter` is the relative standard deviation of a
    new sample [-]; it `is_assumed` where its own tests do not show it.
    """

    tests: tuple[FrictionTest, ...]
    covariates: Covariates
    posterior: Posterior
    slopes: Mapping[str, Estimate]
    ranges: Mapping[str, Range | None]
    scatter: Ratio
    scatter_source: str
    is_assumed: bool

    def at(self, **asked: Unpack[Asked]) -> Prediction:
        """Friction predicted for these conditions; one that is not known stays at the middle of the tests.

        Outside the tests the mean stays that of the nearest tested condition, the standard deviation
        grows by a stated rule (`separatrix.friction.friction_law`), and `extrapolation` reports it.
        """
        # how steep friction may be, from the measured slopes and their errors
        steep = {name: sqrt(s.value**2 + s.standard_error**2) for name, s in self.slopes.items()}
        if PRODUCT in steep:
            steep = dict.fromkeys(("slip_speed", "pressure", PRODUCT), steep[PRODUCT])
        media = tuple(dict.fromkeys(test.medium for test in self.tests))
        values, sentences, widening = limited(asked, self.ranges, steep, media)
        chosen = self.covariates  # conditions that are not given stay at their centre
        middle = {name: exp(centre) for name, centre in zip(chosen.names, chosen.centres, strict=True)}
        contrast = np.array(chosen.row({**middle, **values}))
        log_mean, error = self.posterior.moments(contrast)
        mean = exp(log_mean)
        return Prediction(
            mean=mean,
            standard_error=mean * error,
            standard_deviation=mean * hypot(self.scatter, widening),
            extrapolation=sentences,
            widening=mean * widening,
            assumed_scatter=self.is_assumed,
        )

    def log_mean(self, *, slip_speed: Array, pressure: Array) -> Array:
        """Logarithm of the mean that `at` predicts, for many conditions, each limited to its tested range.

        Slip speed [m/s] and pressure [Pa] have the shape (sample,).
        """
        known = {"slip_speed": slip_speed, "pressure": pressure}
        known = {name: np.clip(x, *r) for name, x in known.items() if (r := self.ranges[name]) is not None}
        if (both := self.ranges[PRODUCT]) is not None and len(known) == len((slip_speed, pressure)):
            known[PRODUCT] = np.clip(known["slip_speed"] * known["pressure"], *both)
        coefficients = self.posterior.weight @ self.posterior.fit.mean
        mean = np.full(slip_speed.shape, coefficients[0])
        chosen = self.covariates
        for name, centre, slope in zip(chosen.names, chosen.centres, coefficients[1:], strict=True):
            mean += slope * (np.log(known[name]) - centre)
        return mean


ASSUMED = "assumed"
OWN, OTHERS = "its own tests", "tests of other materials, and assumed"
MANY = 60
"""Tests beyond the coefficients from which 9 % moves a scatter of 2 to 30 % by about a tenth at most."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrictionFit:
    """Fits of all materials in all environments."""

    groups: Mapping[GroupKey, MaterialFit]
    default_scatter: Ratio

    def of(self, material: str, environment: str) -> MaterialFit:
        """Fit of one material in one environment."""
        return self.groups[material, environment]


def fit_friction(tests: Sequence[FrictionTest], default_scatter: Ratio = DEFAULT_SCATTER) -> FrictionFit:
    """Fit friction over conditions to tests, each material in each environment by itself.

    An unrepeated test is assumed to have the default scatter, a relative standard deviation [-].
    """
    return _fit(tuple(tests), default_scatter)


@lru_cache(maxsize=16)
def _fit(tests: tuple[FrictionTest, ...], default_scatter: Ratio) -> FrictionFit:
    grouped: dict[GroupKey, list[FrictionTest]] = {}
    for test in tests:
        grouped.setdefault((test.material, test.environment), []).append(test)
    chosen = {key: covariates(group) for key, group in grouped.items()}
    models = {key: linear_model(group, chosen[key]) for key, group in grouped.items()}
    found = posteriors(list(models.values()), default_scatter)
    others = OTHERS if any(model.shows_scatter for model in models.values()) else ASSUMED
    few = f"{OWN}, drawn towards the assumed {100.0 * default_scatter:g} %"
    groups = {}
    for (key, model), posterior in zip(models.items(), found, strict=True):
        estimates = []
        for contrast in np.eye(1 + len(chosen[key].names))[1:]:
            value, error = posterior.moments(contrast)
            low, high = (posterior.quantile(contrast, p) for p in (0.025, 0.975))
            estimates.append(Estimate(value=value, standard_error=error, low=low, high=high))
        groups[key] = MaterialFit(
            tests=tuple(grouped[key]),
            covariates=chosen[key],
            posterior=posterior,
            slopes=dict(zip(chosen[key].names, estimates, strict=True)),
            ranges={name: tested_range(grouped[key], name) for name in (*CONDITIONS, PRODUCT)},
            scatter=posterior.scatter,
            scatter_source=(OWN if model.freedom >= MANY else few) if model.shows_scatter else others,
            is_assumed=not model.shows_scatter,
        )
    return FrictionFit(groups=groups, default_scatter=default_scatter)


def linear_model(tests: Sequence[FrictionTest], chosen: Covariates) -> LinearModel:
    """Tests of one group as a linear model of ln f."""
    numbers: dict[str, int] = {}
    sample = [numbers.setdefault(t.sample or f"\0{i}", len(numbers)) for i, t in enumerate(tests)]
    return LinearModel(
        y=np.log([test.friction for test in tests]),
        design=np.array([chosen.row(values_of(test, chosen.names)) for test in tests]),
        error=np.array([(test.standard_error or 0.0) / test.friction for test in tests]),
        sample=np.array(sample),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class TestedFriction:
    """What a candidate of a study carries: all tests of its file, which of them are its own, the scatter.

    All tests, because the scatter is pooled over the materials. Nothing is fitted before `at` is called. Of
    tests at different temperatures those nearest to the requested one serve.
    """

    __test__ = False

    material: str
    environment: str
    tests: tuple[FrictionTest, ...] = field(repr=False)
    default_scatter: Ratio

    @property
    def own(self) -> tuple[FrictionTest, ...]:
        """Tests of this material in this environment."""
        mine = (self.material, self.environment)
        return tuple(test for test in self.tests if (test.material, test.environment) == mine)

    def serving(self, temperature: Kelvin | None) -> tuple[FrictionTest, ...]:
        """Those of its own tests that serve at a temperature."""
        return at_temperature(self.own, temperature)

    def fitted(self, temperature: Kelvin | None) -> MaterialFit:
        """Fit of its own tests that serve at a temperature, with the scatter pooled over all materials."""
        tests = at_temperature(self.tests, temperature)
        return fit_friction(tests, self.default_scatter).of(self.material, self.environment)

    def at(self, **asked: Unpack[Asked]) -> Prediction:
        """Friction predicted for these conditions, as `MaterialFit.at`."""
        return self.fitted(asked.get("temperature")).at(**asked)
