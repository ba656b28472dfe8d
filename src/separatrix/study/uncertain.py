"""Values of a study with a form of their own: uncertain numbers, and names of the library.

A number may be ``"0.8 um +- 30 %"``, ``{ between = [..] }``, ``{ mean = .. }`` or ``[..]``. A refusal has as
its path what follows the key: ``.between, item 1,``.

Every distribution has a finite reach, `low` to `high`; a normal one and a log-normal one end `CUT` standard
deviations (of the logarithm) from their middle. What lies beyond is one draw in 1.7 million. Without it the
standard deviation is smaller by 8e-6 of itself, that of a log-normal one as wide as its mean by 4e-4.

Normal for what may lie on both sides of any value, log-normal for what is positive and would come near zero,
uniform where only bounds are known: JCGM 101:2008 (GUM, supplement 1), 6.4.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from separatrix.ground.errors import InputError
from separatrix.ground.reader import Reading
from separatrix.ground.schema import Described
from separatrix.ground.toml import Reader, cut_list, nearest, quantity, ratio, truth, whole
from separatrix.ground.units import NUMBER, Kelvin, format_quantity, parse, printable, shown
from separatrix.study.library import Library

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


_SIGN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
_PLAIN = re.compile(NUMBER)
_PERCENT = re.compile(rf"({NUMBER}) ?%")
_BRACKETS = re.compile(r"\(([^()]*)\) ?([^()]+)")
_FORM_OF = {"between": "between", "log": "between", "mean": "mean", "standard_deviation": "mean"}
"""Keys of a distribution, and the form that each belongs to."""

_FORMS = "between, or mean with standard_deviation"
_ALONE = "Write the value alone if it is certain."


def number(value: object, unit: str) -> tuple[float, Distribution | None]:
    """A number in SI and None, or the mean of an uncertain one and its distribution."""
    if isinstance(value, list):
        values = tuple(quantity(unit)(item, f", item {i},") for i, item in enumerate(value, 1))
        found = _made(samples, "", values=values, text=written(value))
    elif isinstance(value, dict):
        found = _table(value, unit)
    elif isinstance(value, str) and _SIGN.search(value):
        found = _plus_minus(value, unit)
    else:
        return quantity(unit)(value, ""), None
    return found.mean, found


def written(value: object) -> str:
    """The value as the file has it, on one short line."""
    if isinstance(value, dict):
        inside = ", ".join(f"{printable(str(key))} = {written(item)}" for key, item in value.items())
        return f"{{ {inside} }}"
    if isinstance(value, list):
        few = [written(item) for item in (value if len(value) <= 6 else value[:3])]
        return f"[{', '.join(few)}{f', ... {len(value)} of them' if len(value) > 6 else ''}]"
    return shown(value)


def deviation_of(width: object, mean: object, unit: str) -> float:
    """Standard deviation of a table: a width in the unit, or percent of the mean."""
    at = ".standard_deviation"
    if isinstance(width, str) and (unit != "-" or "%" in width):
        return _width(width, quantity(unit)(mean, ".mean"), str(mean), at, unit)
    return _not_zero(quantity(unit)(width, at), width, at)


def _plus_minus(text: str, unit: str) -> Distribution:
    """Read ``"0.5 um +- 20 %"``: a mean and its expanded uncertainty, `COVERAGE` standard deviations.

    ``"(0.5 +- 0.1) um"`` has one unit for both (GUM, 7.2.4).
    """
    shared = _BRACKETS.fullmatch(text.strip())
    parts = _SIGN.split(text.strip() if shared is None else shared[1].strip())
    if shared is not None:
        parts = [f"{part} {shared[2]}" for part in parts]
    example = {"m": "0.5 um", "N": "300 daN", "Pa": "1.5 GPa", "-": "0.1"}.get(unit, f"1.5 {unit}")
    like = f'Write it like "{example} +- 20 %"'
    if len(text) > 120 or len(parts) != 2 or not all(parts):
        raise InputError("", "must be one value, +- and one expanded uncertainty", shown(text), f"{like}.")
    if unit != "-" and _PLAIN.fullmatch(parts[0]):
        cure = f"{like}, with a unit on either side of +-."
        raise InputError("", "needs a unit before +- too", shown(text), cure)
    mean = _written_number(parts[0], "", unit)
    half = _width(parts[1], mean, parts[0], ", after +-,", unit)
    deviation = half / COVERAGE
    return _made(normal, "", mean=mean, standard_deviation=deviation, text=shown(text))


def _table(value: dict[str, object], unit: str) -> Distribution:
    """Read a table with bounds, or with mean and standard deviation."""
    for key in value:
        if key not in _FORM_OF:
            at, cure = f".{printable(key) or chr(34) * 2}", nearest(key, _FORM_OF)
            raise InputError(at, f"is not a key of a distribution: {_FORMS}", cure=cure)
    found = {_FORM_OF[key] for key in value if key != "log"}
    if len(found) != 1:
        rule = f"must have {_FORMS}" if not found else f"must have only one of {_FORMS}"
        raise InputError("", rule, written(value))
    if "log" in value and "between" not in value:
        raise InputError(".log", "has a meaning only with between")
    if "between" in found:
        return _between(value, quantity(unit))
    return _moments(value, unit)


def _between(value: dict[str, object], reader: Reader[float]) -> Distribution:
    bounds, at = value["between"], ".between"
    log = truth(value.get("log", False), ".log")
    if not isinstance(bounds, list) or len(bounds) != 2:
        got = f"a list of {len(bounds)}" if isinstance(bounds, list) else shown(bounds)
        raise InputError(at, "must be a list of two bounds", got)
    low, high = (reader(bound, f"{at}, item {i},") for i, bound in enumerate(bounds, 1))
    if not low < high:
        cure = _ALONE if low == high else "Write the lower one first."
        raise InputError(at, "must rise", f"{written(bounds[0])} and {written(bounds[1])}", cure)
    if log and low <= 0.0:
        cure = "A logarithm needs positive numbers: raise the lower bound, or leave log out."
        raise InputError(at, "must be > 0 with log = true", shown(bounds[0]), cure)
    kind = log_uniform if log else uniform
    return _made(kind, at, low=low, high=high, text=written(value))


def _moments(value: dict[str, object], unit: str) -> Distribution:
    if missing := [key for key in ("mean", "standard_deviation") if key not in value]:
        raise InputError("", f"lacks: {missing[0]}", written(value))
    mean = quantity(unit)(value["mean"], ".mean")
    deviation = deviation_of(value["standard_deviation"], value["mean"], unit)
    return _made(normal, "", mean=mean, standard_deviation=deviation, text=written(value))


def _made(kind: Callable[..., Distribution], where: str, **values: object) -> Distribution:
    """Make a distribution; the place in the file is put before its refusals."""
    try:
        return kind(**values)
    except InputError as error:
        raise error.at(where) from None


def _width(text: str, mean: float, mean_text: str, where: str, unit: str) -> float:
    """Read a width: percent of the mean, or a difference of two values of the quantity."""
    percent = _PERCENT.fullmatch(text.strip())
    if percent is None and unit != "-" and _PLAIN.fullmatch(text.strip()):
        cure = f'Write "{printable(text.strip())} %", or the width with its unit.'
        raise InputError(where, "needs a unit, or %", shown(text), cure)
    if percent is None:
        width = _written_number(text, where, unit)
        if unit == "K":  # a difference, without the zero of the scale
            scale = re.sub(r"^\s*[-+.0-9eE]+\s*", "", text)
            width -= parse(f"0 {scale}", unit, where)
        return _not_zero(width, text, where)
    if unit == "K" and not re.search(r"[0-9] ?K$", mean_text.strip()):
        cure = "Write the width in kelvin."
        raise InputError(where, "is a share of a temperature, whose zero is arbitrary", shown(text), cure)
    share = _not_zero(float(percent[1]) / 100.0, text, where)
    if mean == 0.0:
        raise InputError(where, "is a share of 0", shown(text), "Write the width with its unit.")
    return share * abs(mean)


def _written_number(text: str, where: str, unit: str) -> float:
    """Read a number inside a text; a ratio has no quotes of its own there."""
    if unit != "-":
        return parse(text, unit, where)
    if _PLAIN.fullmatch(text.strip()) is None:
        cure = "Write a decimal point." if "," in text else 'Write it like "0.1 +- 20 %".'
        raise InputError(where, "must be a plain number, without a unit", shown(text), cure)
    return ratio(float(text), where)


def _not_zero(width: float, written_as: object, where: str) -> float:
    if not width > 0.0:
        cure = _ALONE if width == 0.0 else "A width has no sign."
        raise InputError(where, "must be a width > 0", shown(written_as), cure)
    return width


@dataclass(frozen=True, slots=True)
class StudyHelper:
    """Reader of uncertain numbers, and of names of a library."""

    library: Library

    def number(self, raw: object, unit: str, one: Described) -> tuple[float, Distribution | None]:
        """Number of a key or, with an empty unit, whole one; and its distribution, None if it is certain."""
        if one.key.certain or not unit:
            is_table = isinstance(raw, dict) and {"between", "standard_deviation"} & set(raw)
            if is_table or isinstance(raw, list) or (isinstance(raw, str) and _SIGN.search(raw)):
                raise InputError("", "takes no distribution", written(raw), "It takes one certain value.")
        return number(raw, unit) if unit else (whole(raw, ""), None)

    def named(self, raw: object, one: Described, reading: Reading) -> Any:
        """Material of a name; None if the value is not a name."""
        if isinstance(raw, dict):
            return None
        kind = one.key.named
        if not isinstance(raw, str):
            rule = f"must be the name of a {kind}, or its properties elastic_modulus and poisson_ratio"
            raise InputError("", rule, shown(raw), f'Write it like "{self.library.names(kind)[0]}".')
        return self.library.material(kind, self.known(raw, kind), temperature_of(reading))

    def known(self, name: str, kind: str, more: str = "") -> str:
        """Exact name in the library of one in any spelling, or a refusal that lists the names."""
        found = self.library.named(kind, name)
        if found is not None:
            return found
        names = self.library.names(kind)
        listed, near = cut_list(f"The library has {', '.join(names)}."), nearest(name, names)
        cure = f"{near} {listed}{more}" if near.startswith("Did") else f"{listed}{more}"
        raise InputError("", f"is not a {kind} of the library", shown(name), cure)


def helper_of(reading: Reading) -> StudyHelper:
    """Helper of the reading of a study."""
    return cast("StudyHelper", reading.helper)


def temperature_of(reading: Reading) -> Kelvin | None:
    """Temperature of the study, by which data of the library are chosen; None where it states none."""
    operation = reading.done.get("operation")
    return None if operation is None else operation.temperature
