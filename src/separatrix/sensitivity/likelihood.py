"""How likely an input's true value makes a test's result."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from separatrix.distribution import Distribution
from separatrix.sensitivity.records import Measurement
from separatrix.units import Array, Ratio

DRAWN = 2**14
"""Results behind the quantiles."""

FAR = 1e-9
"""Weight that a sample keeps however far it is: a result without a near sample leaves all as it was."""

_HALF_STEP = 2.0**-31


@dataclass(frozen=True, slots=True)
class Likelihood:
    r"""A result is normal about the part of the input that a test can tell.

    With the share :math:`\rho` of the variance being lack of knowledge, that part is, given the value
    :math:`x` of the next cage, normal about :math:`m + \rho (x - m)` with the variance
    :math:`\rho (1 - \rho) s^2`; the error of the test is added to it. The kernel is never narrower than
    `floor`, so that enough samples keep some weight.
    """

    known: Distribution
    error: Ratio
    reducible: Ratio
    floor: float

    def centre(self, x: Array) -> Array:
        """Mean of the results, given the value."""
        m = self.known.mean
        return m + self.reducible * (x - m)

    def deviation(self, x: Array) -> Array:
        """Standard deviation of the results, given the value."""
        inner = self.reducible * (1.0 - self.reducible) * self.known.standard_deviation**2
        return np.sqrt(inner + (self.error * self.centre(x)) ** 2 + self.floor**2)

    def results(self, count: int, seed: tuple[int, ...]) -> Array:
        """Results that may come out, rising: quantiles (k + 1/2) / count of a large quasi-random sample."""
        from scipy.stats import qmc

        points = qmc.Sobol(2, scramble=True, rng=np.random.default_rng(seed)).random(DRAWN) + _HALF_STEP
        x = self.known.quantile(points[:, 0])
        drawn = self.centre(x) + self.deviation(x) * ndtri(points[:, 1])
        return np.asarray(np.quantile(drawn, (np.arange(count) + 0.5) / count))

    def weights(self, x: Array, results: Array) -> Array:
        """Weight of each sample under each result, shape (result, sample), not normalised [-]."""
        deviation = self.deviation(x)
        height = self.known.standard_deviation / deviation
        away = (results[:, None] - self.centre(x)) / deviation
        return np.asarray(height * np.exp(-0.5 * away**2) + FAR)


def likelihood(known: Distribution, test: Measurement, samples: int, fewest: int) -> Likelihood:
    """Likelihood of a test, told from this many samples of which `fewest` shall keep some weight.

    A normal kernel of deviation h in the middle of N samples of a normal of deviation s leaves an effective
    number of 2 sqrt(pi) h N / (sqrt(2 pi) s) = 1.41 N h / s.
    """
    return Likelihood(
        known=known,
        error=test.error / test.repeats**0.5,
        reducible=test.reducible,
        floor=known.standard_deviation * fewest / (2.0**0.5 * samples),
    )
