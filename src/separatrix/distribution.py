r"""Distributions of one number: what is known of an input that is not known exactly.

Every distribution has a finite reach, `low` to `high`; a normal one and a log-normal one end `CUT` standard
deviations (of the logarithm) from their middle. What lies beyond is one draw in 1.7 million. Without it the
standard deviation is smaller by 8e-6 of itself, that of a log-normal one as wide as its mean by 4e-4.

Normal for what may lie on both sides of any value, log-normal for what is positive and would come near zero,
uniform where only bounds are known: JCGM 101:2008 (GUM, supplement 1), 6.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from separatrix.errors import InputError
from separatrix.units import format_quantity, shown

if TYPE_CHECKING:
    from separatrix.units import Array

CUT = 5.0
"""Standard deviations from the middle at which a normal distribution ends."""

COVERAGE = 2.0
"""What stands behind ``+-`` is an expanded uncertainty: so many standard deviations (GUM, 6.2 and 7.2)."""

MOST_SAMPLES = 10_000

LEAST, MOST = 1e-60, 1e60
"""Magnitudes that a number of a distribution may have, besides 0: their ratios can be squared, and the square
exponentiated with its root, without leaving what a computer can hold."""
_TAIL = 0.5 * math.erfc(CUT / math.sqrt(2.0))


class Distribution(Protocol):
    """What is known of one number, in SI."""

    @property
    def kind(self) -> str:
        """Its name, in words."""

    @property
    def text(self) -> str:
        """As the study wrote it; empty if it was made in Python."""

    @property
    def mean(self) -> float:
        """The mean, which every verb takes that asks for one value."""

    @property
    def standard_deviation(self) -> float:
        """The standard uncertainty."""

    @property
    def low(self) -> float:
        """The least value it takes."""

    @property
    def high(self) -> float:
        """The largest value it takes."""

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Normal:
    """Normal distribution, without what lies beyond `CUT` standard deviations."""

    mean: float
    standard_deviation: float
    text: str = ""
    kind = "normal"

    def __post_init__(self) -> None:
        _finite(self, "mean", "standard_deviation")
        _positive(self, "standard_deviation")

    @property
    def low(self) -> float:
        """The least value it takes."""
        return self.mean - CUT * self.standard_deviation

    @property
    def high(self) -> float:
        """The largest value it takes."""
        return self.mean + CUT * self.standard_deviation

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        return self.mean + self.standard_deviation * _standard_normal(probability)


@dataclass(frozen=True, slots=True, kw_only=True)
class LogNormal:
    """Log-normal distribution of this mean and standard deviation; its logarithm ends as `Normal` does."""

    mean: float
    standard_deviation: float
    text: str = ""
    kind = "log-normal"

    def __post_init__(self) -> None:
        _finite(self, "mean", "standard_deviation")
        _positive(self, "mean", "standard_deviation")

    @property
    def log_deviation(self) -> float:
        """Standard deviation of the logarithm."""
        return math.sqrt(math.log1p((self.standard_deviation / self.mean) ** 2))

    @property
    def median(self) -> float:
        """The value that is exceeded as often as not."""
        return self.mean * math.exp(-0.5 * self.log_deviation**2)

    @property
    def low(self) -> float:
        """The least value it takes."""
        return self.median * math.exp(-CUT * self.log_deviation)

    @property
    def high(self) -> float:
        """The largest value it takes."""
        return self.median * math.exp(CUT * self.log_deviation)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np

        return self.median * np.exp(self.log_deviation * _standard_normal(probability))


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform:
    """Anything between two bounds, all alike."""

    low: float
    high: float
    text: str = ""
    kind = "uniform"

    def __post_init__(self) -> None:
        _finite(self, "low", "high")
        _rising(self)

    @property
    def mean(self) -> float:
        """Middle of the bounds."""
        return self.low + 0.5 * (self.high - self.low)

    @property
    def standard_deviation(self) -> float:
        """The standard uncertainty: width over the root of 12."""
        return (self.high - self.low) / math.sqrt(12.0)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        return self.low + (self.high - self.low) * probability


@dataclass(frozen=True, slots=True, kw_only=True)
class LogUniform:
    """Anything between two positive bounds, each factor alike: the logarithm is uniform."""

    low: float
    high: float
    text: str = ""
    kind = "log-uniform"

    def __post_init__(self) -> None:
        _finite(self, "low", "high")
        _positive(self, "low")
        _rising(self)

    @property
    def mean(self) -> float:
        """The mean, above the geometric one."""
        width = math.log(self.high / self.low)
        return self.low * math.expm1(width) / width

    @property
    def standard_deviation(self) -> float:
        """The standard uncertainty; of a narrow one by its series, for the two terms nearly cancel."""
        w = math.log(self.high / self.low)
        if w > 0.1:
            variance = math.expm1(2.0 * w) / (2.0 * w) - (math.expm1(w) / w) ** 2
        else:
            variance = math.exp(w) * w * w * (1.0 / 12.0 + w * w * (1.0 / 180.0 + w * w / 6720.0))
        return self.low * math.sqrt(variance)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np

        return self.low * np.exp(math.log(self.high / self.low) * probability)


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Values that were drawn or measured elsewhere, each as likely as the others; kept in rising order."""

    values: tuple[float, ...]
    text: str = ""
    kind = "samples"

    def __post_init__(self) -> None:
        if not 2 <= len(self.values) <= MOST_SAMPLES:
            rule = f"must hold 2 to {MOST_SAMPLES} values"
            raise InputError("Samples.values", rule, str(len(self.values)))
        for value in self.values:
            _check_magnitude("Samples.values", value)
        if min(self.values) == max(self.values):
            cure = "Write the value alone if it is certain."
            raise InputError("Samples.values", "must differ: there is no spread in them", cure=cure)
        object.__setattr__(self, "values", tuple(sorted(self.values)))

    @property
    def mean(self) -> float:
        """The mean; of whole numbers, the one of them that is nearest to it."""
        mean = math.fsum(self.values) / len(self.values)
        return min(self.values, key=lambda value: abs(value - mean)) if self.is_whole else mean

    @property
    def is_whole(self) -> bool:
        """Whether every value was given as a whole number."""
        return all(isinstance(value, int) for value in self.values)

    @property
    def standard_deviation(self) -> float:
        """The standard uncertainty, of the values taken as the whole population."""
        mean = math.fsum(self.values) / len(self.values)
        return math.sqrt(math.fsum((value - mean) ** 2 for value in self.values) / len(self.values))

    @property
    def low(self) -> float:
        """The least value it takes."""
        return self.values[0]

    @property
    def high(self) -> float:
        """The largest value it takes."""
        return self.values[-1]

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np

        places = np.minimum((np.asarray(probability) * len(self.values)).astype(int), len(self.values) - 1)
        values: Array = np.array(self.values, dtype=np.float64)[places]
        return values


def positive_alternative(distribution: Distribution) -> LogNormal | None:
    """Log-normal distribution in the place of a normal one that reaches 0 or below; None for any other."""
    if not isinstance(distribution, Normal) or distribution.mean <= 0.0 or distribution.low > 0.0:
        return None
    deviation, text = distribution.standard_deviation, distribution.text
    return LogNormal(mean=distribution.mean, standard_deviation=deviation, text=text)


def described(distribution: Distribution, unit: str) -> str:
    """A distribution in words: ``normal, 0.5 um, standard deviation 0.05 um``."""
    ends = (format_quantity(x, unit or "-", 4) for x in (distribution.low, distribution.high))
    if isinstance(distribution, Samples):
        return f"{len(distribution.values)} samples from {' to '.join(ends)}"
    if isinstance(distribution, Uniform | LogUniform):
        return f"{distribution.kind} between {' and '.join(ends)}"
    middle = format_quantity(distribution.mean, unit, 7)
    deviation = format_quantity(distribution.standard_deviation, unit, 4)
    if unit == "K":  # a difference of temperatures is written as one
        deviation = f"{distribution.standard_deviation:.4g} K"
    return f"{distribution.kind}, mean {middle}, standard deviation {deviation}"


def _standard_normal(probability: Array) -> Array:
    """Quantiles of the standard normal distribution between -`CUT` and `CUT`."""
    from scipy.special import ndtri

    values: Array = ndtri(_TAIL + (1.0 - 2.0 * _TAIL) * probability)
    return values


def _finite(record: object, *names: str) -> None:
    for name in names:
        _check_magnitude(f"{type(record).__name__}.{name}", getattr(record, name))


def _check_magnitude(where: str, value: float) -> None:
    if not (value == 0.0 or LEAST <= abs(value) <= MOST):
        rule = f"must be a finite number: 0, or between {LEAST:g} and {MOST:g} in magnitude"
        raise InputError(where, rule, shown(value))


def _positive(record: object, *names: str) -> None:
    for name in names:
        if not getattr(record, name) > 0.0:
            where = f"{type(record).__name__}.{name}"
            raise InputError(where, "must be > 0", shown(getattr(record, name)))


def _rising(record: Uniform | LogUniform) -> None:
    if not record.low < record.high:
        got = f"{record.low:g} and {record.high:g}"
        raise InputError(f"{type(record).__name__}.high", "must be above its lower bound", got)
