r"""Distributions of one number: what is known of an input that is not known exactly.

Every distribution has a finite reach, `low` to `high`; a normal one and a log-normal one end `CUT` standard
deviations (of the logarithm) from their middle. What lies beyond is one draw in 1.7 million. Without it the
standard deviation is smaller by 8e-6 of itself, that of a log-normal one as wide as its mean by 4e-4.

Normal for what may lie on both sides of any value, log-normal for what is positive and would come near zero,
uniform where only bounds are known: JCGM 101:2008 (GUM, supplement 1), 6.4.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.ground.errors import InputError
from separatrix.ground.units import format_quantity, shown

if TYPE_CHECKING:
    from separatrix.ground.units import Array

CUT = 5.0
"""Standard deviations from the middle at which a normal distribution ends."""

COVERAGE = 2.0
"""Standard deviations in an expanded uncertainty, which is what follows ``+-`` (GUM, 6.2 and 7.2)."""

MOST_SAMPLES = 10_000

LEAST, MOST = 1e-60, 1e60
"""Magnitudes that a number of a distribution may have, besides 0: their ratios can be squared, and the square
exponentiated with its root, without leaving what a computer can hold."""
_TAIL = 0.5 * math.erfc(CUT / math.sqrt(2.0))


NORMAL, LOG_NORMAL = "normal", "log-normal"
UNIFORM, LOG_UNIFORM, SAMPLES = "uniform", "log-uniform", "samples"


@dataclass(frozen=True, slots=True, kw_only=True)
class Distribution:
    """What is known of one number, in SI; `normal` and the functions below it make one."""

    kind: str
    mean: float
    """What verbs of one value take."""

    standard_deviation: float
    low: float
    high: float
    text: str = ""
    """What the study wrote; empty if it was made in Python."""

    samples: tuple[float, ...] = ()

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np
        from scipy.special import ndtri

        if self.kind == UNIFORM:
            return self.low + (self.high - self.low) * probability
        if self.kind == LOG_UNIFORM:
            return self.low * np.exp(math.log(self.high / self.low) * probability)
        if self.kind == SAMPLES:
            count = len(self.samples)
            places = np.minimum((np.asarray(probability) * count).astype(int), count - 1)
            return np.asarray(np.array(self.samples, dtype=np.float64)[places])
        deviations: Array = ndtri(_TAIL + (1.0 - 2.0 * _TAIL) * probability)
        if self.kind == NORMAL:
            return self.mean + self.standard_deviation * deviations
        deviation, median = _of_logarithm(self.mean, self.standard_deviation)
        return median * np.exp(deviation * deviations)


def normal(*, mean: float, standard_deviation: float, text: str = "") -> Distribution:
    """Normal distribution, without what lies beyond `CUT` standard deviations."""
    _check("mean", mean)
    _check("standard_deviation", standard_deviation, above=0.0)
    low, high = (mean + side * CUT * standard_deviation for side in (-1.0, 1.0))
    return Distribution(
        kind=NORMAL, mean=mean, standard_deviation=standard_deviation, low=low, high=high, text=text
    )


def log_normal(*, mean: float, standard_deviation: float, text: str = "") -> Distribution:
    """Log-normal distribution of this mean and standard deviation, its logarithm cut as a normal one is."""
    _check("mean", mean, above=0.0)
    _check("standard_deviation", standard_deviation, above=0.0)
    s, median = _of_logarithm(mean, standard_deviation)
    low, high = (median * math.exp(side * CUT * s) for side in (-1.0, 1.0))
    return Distribution(
        kind=LOG_NORMAL, mean=mean, standard_deviation=standard_deviation, low=low, high=high, text=text
    )


def _of_logarithm(mean: float, standard_deviation: float) -> tuple[float, float]:
    """Standard deviation of the logarithm of a log-normal distribution, and its median."""
    s = math.sqrt(math.log1p((standard_deviation / mean) ** 2))
    return s, mean * math.exp(-0.5 * s**2)


def uniform(*, low: float, high: float, text: str = "") -> Distribution:
    """Anything between two bounds, all alike."""
    _check("low", low)
    _check("high", high, above=low)
    mean, deviation = low + 0.5 * (high - low), (high - low) / math.sqrt(12.0)
    return Distribution(kind=UNIFORM, mean=mean, standard_deviation=deviation, low=low, high=high, text=text)


def log_uniform(*, low: float, high: float, text: str = "") -> Distribution:
    """Anything between two positive bounds, each factor alike: the logarithm is uniform."""
    _check("low", low, above=0.0)
    _check("high", high, above=low)
    w = math.log(high / low)
    if w > 0.1:
        variance = math.expm1(2.0 * w) / (2.0 * w) - (math.expm1(w) / w) ** 2
    else:  # by its series, for the two terms nearly cancel
        variance = math.exp(w) * w * w * (1.0 / 12.0 + w * w * (1.0 / 180.0 + w * w / 6720.0))
    mean, deviation = low * math.expm1(w) / w, low * math.sqrt(variance)
    return Distribution(
        kind=LOG_UNIFORM, mean=mean, standard_deviation=deviation, low=low, high=high, text=text
    )


def samples(*, values: Sequence[float], text: str = "") -> Distribution:
    """Values that were drawn or measured elsewhere, each as likely as the others; kept in rising order.

    The standard deviation is that of the values taken as the whole population.
    """
    if not 2 <= (count := len(values)) <= MOST_SAMPLES:
        cure = "Write one value without brackets." if count == 1 else ""
        raise InputError("values", f"must have 2 to {MOST_SAMPLES} samples", str(count), cure)
    for value in values:
        _check("values", value)
    rising = tuple(sorted(values))
    if rising[0] == rising[-1]:
        cure = "Write the value alone if it is certain."
        raise InputError("values", "must differ: there is no spread in them", text, cure)
    mean = math.fsum(rising) / count
    deviation = math.sqrt(math.fsum((value - mean) ** 2 for value in rising) / count)
    low, high = rising[0], rising[-1]
    return Distribution(
        kind=SAMPLES, mean=mean, standard_deviation=deviation, low=low, high=high, text=text, samples=rising
    )


def positive_alternative(distribution: Distribution) -> Distribution | None:
    """Log-normal distribution in the place of a normal one that reaches 0 or below; None for any other."""
    if distribution.kind != NORMAL or distribution.mean <= 0.0 or distribution.low > 0.0:
        return None
    deviation, text = distribution.standard_deviation, distribution.text
    return log_normal(mean=distribution.mean, standard_deviation=deviation, text=text)


def described(distribution: Distribution, unit: str) -> str:
    """A distribution in words: ``normal, 0.5 um, standard deviation 0.05 um``."""
    ends = (format_quantity(x, unit or "-", 4) for x in (distribution.low, distribution.high))
    if distribution.kind == SAMPLES:
        return f"{len(distribution.samples)} samples from {' to '.join(ends)}"
    if distribution.kind in (UNIFORM, LOG_UNIFORM):
        return f"{distribution.kind} between {' and '.join(ends)}"
    middle = format_quantity(distribution.mean, unit, 7)
    deviation = format_quantity(distribution.standard_deviation, unit, 4)
    if unit == "K":  # a difference of temperatures is written as one
        deviation = f"{distribution.standard_deviation:.4g} K"
    return f"{distribution.kind}, mean {middle}, standard deviation {deviation}"


def _check(name: str, value: float, above: float | None = None) -> None:
    if not (value == 0.0 or LEAST <= abs(value) <= MOST):
        rule = f"must be a finite number: 0, or between {LEAST:g} and {MOST:g} in magnitude"
        raise InputError(name, rule, shown(value))
    if above is not None and not value > above:
        raise InputError(name, f"must be > {above:g}", shown(value))
