r"""Distributions of one number: what is known of an input that is not known exactly.

Every distribution has a finite reach, `low` to `high`; a normal one and a log-normal one end `CUT` standard
deviations (of the logarithm) from their middle. What lies beyond is one draw in 1.7 million. Without it the
standard deviation is smaller by 8e-6 of itself, that of a log-normal one as wide as its mean by 4e-4.

Normal for what may lie on both sides of any value, log-normal for what is positive and would come near zero,
uniform where only bounds are known: JCGM 101:2008 (GUM, supplement 1), 6.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Normal:
    """Normal distribution, without what lies beyond `CUT` standard deviations."""

    mean: float
    standard_deviation: float
    text: str = ""
    low: float = field(init=False, repr=False)
    high: float = field(init=False, repr=False)
    kind = "normal"

    def __post_init__(self) -> None:
        _check(self, "mean", "standard_deviation", positive=("standard_deviation",))
        reach = CUT * self.standard_deviation
        _set(self, low=self.mean - reach, high=self.mean + reach)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        return self.mean + self.standard_deviation * _standard_normal(probability)


@dataclass(frozen=True, slots=True, kw_only=True)
class LogNormal:
    """Log-normal distribution of this mean and standard deviation; its logarithm ends as `Normal` does."""

    mean: float
    standard_deviation: float
    text: str = ""
    log_deviation: float = field(init=False, repr=False)
    """Standard deviation of the logarithm."""

    median: float = field(init=False, repr=False)
    low: float = field(init=False, repr=False)
    high: float = field(init=False, repr=False)
    kind = "log-normal"

    def __post_init__(self) -> None:
        both = ("mean", "standard_deviation")
        _check(self, *both, positive=both)
        s = math.sqrt(math.log1p((self.standard_deviation / self.mean) ** 2))
        median = self.mean * math.exp(-0.5 * s**2)
        low, high = (median * math.exp(side * CUT * s) for side in (-1.0, 1.0))
        _set(self, log_deviation=s, median=median, low=low, high=high)

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
    mean: float = field(init=False, repr=False)
    standard_deviation: float = field(init=False, repr=False)
    kind = "uniform"

    def __post_init__(self) -> None:
        _check(self, "low", "high", rising=True)
        width = self.high - self.low
        _set(self, mean=self.low + 0.5 * width, standard_deviation=width / math.sqrt(12.0))

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        return self.low + (self.high - self.low) * probability


@dataclass(frozen=True, slots=True, kw_only=True)
class LogUniform:
    """Anything between two positive bounds, each factor alike: the logarithm is uniform."""

    low: float
    high: float
    text: str = ""
    mean: float = field(init=False, repr=False)
    standard_deviation: float = field(init=False, repr=False)
    kind = "log-uniform"

    def __post_init__(self) -> None:
        _check(self, "low", "high", positive=("low",), rising=True)
        w = math.log(self.high / self.low)
        if w > 0.1:
            variance = math.expm1(2.0 * w) / (2.0 * w) - (math.expm1(w) / w) ** 2
        else:  # by its series, for the two terms nearly cancel
            variance = math.exp(w) * w * w * (1.0 / 12.0 + w * w * (1.0 / 180.0 + w * w / 6720.0))
        deviation = self.low * math.sqrt(variance)
        _set(self, mean=self.low * math.expm1(w) / w, standard_deviation=deviation)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np

        return self.low * np.exp(math.log(self.high / self.low) * probability)


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Values that were drawn or measured elsewhere, each as likely as the others; kept in rising order.

    The mean of whole numbers is the one of them that is nearest to it. The standard deviation is that of the
    values taken as the whole population.
    """

    values: tuple[float, ...]
    text: str = ""
    mean: float = field(init=False, repr=False)
    standard_deviation: float = field(init=False, repr=False)
    low: float = field(init=False, repr=False)
    high: float = field(init=False, repr=False)
    kind = "samples"

    def __post_init__(self) -> None:
        if not 2 <= (count := len(self.values)) <= MOST_SAMPLES:
            cure = "Write one value without brackets." if count == 1 else ""
            raise InputError("Samples.values", f"must have 2 to {MOST_SAMPLES} samples", str(count), cure)
        for value in self.values:
            _check_magnitude("Samples.values", value)
        values = tuple(sorted(self.values))
        if values[0] == values[-1]:
            cure = "Write the value alone if it is certain."
            raise InputError("Samples.values", "must differ: there is no spread in them", self.text, cure)
        mean = math.fsum(values) / count
        deviation = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / count)
        object.__setattr__(self, "values", values)
        central = min(values, key=lambda value: abs(value - mean)) if self.is_whole else mean
        _set(self, mean=central, standard_deviation=deviation, low=values[0], high=values[-1])

    @property
    def is_whole(self) -> bool:
        """Whether every value was given as a whole number."""
        return all(isinstance(value, int) for value in self.values)

    def quantile(self, probability: Array) -> Array:
        """Values below which these shares of all draws lie, same shape."""
        import numpy as np

        places = np.minimum((np.asarray(probability) * len(self.values)).astype(int), len(self.values) - 1)
        values: Array = np.array(self.values, dtype=np.float64)[places]
        return values


Distribution = Normal | LogNormal | Uniform | LogUniform | Samples
"""What is known of one number, in SI.

Each has its `kind` in words, the mean that verbs of one value take, the standard uncertainty, the ends, and
as `text` what the study wrote, empty if it was made in Python."""


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


def _set(record: object, **values: float) -> None:
    for name, value in values.items():
        object.__setattr__(record, name, value)


def _check(record: object, *names: str, positive: tuple[str, ...] = (), rising: bool = False) -> None:
    kind, given = type(record).__name__, {name: getattr(record, name) for name in names}
    for name, value in given.items():
        _check_magnitude(f"{kind}.{name}", value)
    for name in positive:
        if not given[name] > 0.0:
            raise InputError(f"{kind}.{name}", "must be > 0", shown(given[name]))
    if rising and not given["low"] < given["high"]:
        got = f"{given['low']:g} and {given['high']:g}"
        raise InputError(f"{kind}.high", "must be above its lower bound", got)


def _check_magnitude(where: str, value: float) -> None:
    if not (value == 0.0 or LEAST <= abs(value) <= MOST):
        rule = f"must be a finite number: 0, or between {LEAST:g} and {MOST:g} in magnitude"
        raise InputError(where, rule, shown(value))
