"""On which conditions the friction of a group of tests can be seen to depend."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import log

from separatrix.friction.fit.records import PRODUCT, WORDS, FrictionTest
from separatrix.units import Kelvin, format_quantity

LEAST_SPAN = 1.2
"""Ratio of the largest to the smallest value from which tests are said to span a condition; nearer than that
tests were run at one temperature."""

TOGETHER = 0.95
"""Correlation of ln speed and ln pressure from which their slopes cannot be told apart."""

Range = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Covariates:
    """Names of the slopes of a group, their centres, and what is to be said about those that it lacks.

    A slope is on ln(slip_speed), ln(pressure) or, where these went together, ln(pressure_velocity), each
    counted from its `centres`, the mean over the tests.
    """

    names: tuple[str, ...] = ()
    centres: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()

    def row(self, values: dict[str, float]) -> list[float]:
        """Row of the design: 1, and the logarithm of each condition over its centre."""
        return [1.0, *(log(values[n]) - c for n, c in zip(self.names, self.centres, strict=True))]


def covariates(tests: Sequence[FrictionTest]) -> Covariates:
    """Slopes that these tests can tell: all state the condition and span it, and a test is left over."""
    notes = list(_unstated(tests))
    spanned = [name for name in ("slip_speed", "pressure") if _spans(tests, name)]
    along = _correlation(tests) if len(spanned) == 2 else 0.0
    if along > TOGETHER:
        spanned = [PRODUCT]
        notes.append("slip speed and pressure went together: slope on their product pV")
    elif along < -TOGETHER:
        spanned = ["slip_speed"]
        notes.append("pressure fell as slip speed rose: slope on slip speed, for both")
    if len(tests) < len(spanned) + 2 and len(spanned) == 2 and _spans(tests, PRODUCT):
        spanned = [PRODUCT]
        notes.append("too few tests for two slopes: slope on the product pV")
    if spanned and len(tests) < len(spanned) + 2:
        notes.append(f"{len(tests)} tests are too few for a slope")
        spanned = []
    logs = {name: [centre(getattr(test, name)) for test in tests] for name in spanned}
    return Covariates(
        names=tuple(spanned), centres=tuple(sum(x) / len(x) for x in logs.values()), notes=tuple(notes)
    )


def at_temperature(tests: Sequence[FrictionTest], temperature: Kelvin | None) -> tuple[FrictionTest, ...]:
    """Tests that serve at a temperature: of a material in an environment those nearest it.

    Friction is not fitted over temperature, and a mean over warm and cold tests would be that of neither.
    Tests that state no temperature serve at any.
    """
    if temperature is None:
        return tuple(tests)
    nearest: dict[tuple[str, str], Range] = {}
    for test in tests:
        if test.temperature is not None:
            group = test.material, test.environment
            found = nearest.setdefault(group, test.temperature)
            nearest[group] = min(found, test.temperature, key=lambda it: (_apart(it, temperature), it))
    return tuple(test for test in tests if _serves(test, temperature, nearest))


def _serves(test: FrictionTest, temperature: Kelvin, nearest: Mapping[tuple[str, str], Range]) -> bool:
    if test.temperature is None:
        return True
    low, high = nearest[test.material, test.environment]
    return _apart(test.temperature, min(max(temperature, low), high)) <= log(LEAST_SPAN)


def _apart(limits: Range, value: float) -> float:
    """Logarithm of the ratio of a value to the nearest end of a range; 0 inside it."""
    return max(log(limits[0] / value), log(value / limits[1]), 0.0)


def centre(limits: Range) -> float:
    """Logarithm of the geometric middle of a range."""
    return 0.5 * (log(limits[0]) + log(limits[1]))


def values_of(test: FrictionTest, names: Sequence[str]) -> dict[str, float]:
    """Geometric middle of each condition of a test."""
    return {name: math.exp(centre(getattr(test, name))) for name in names}


def tested_range(tests: Sequence[FrictionTest], name: str) -> Range | None:
    """Lowest and highest value in the tests that state it; None if none does."""
    stated = [limits for test in tests if (limits := getattr(test, name)) is not None]
    return (min(low for low, _ in stated), max(high for _, high in stated)) if stated else None


def _unstated(tests: Sequence[FrictionTest]) -> Iterator[str]:
    for name in ("slip_speed", "pressure"):
        missing = sum(getattr(test, name) is None for test in tests)
        if 0 < missing < len(tests):
            yield f"{WORDS[name]} is not stated for {missing} of {len(tests)} tests: no slope on it"
    if _spread(tests, "temperature") >= log(LEAST_SPAN):
        span = in_words(tested_range(tests, "temperature") or (0.0, 0.0), "K")
        yield f"tests from {span} are taken together here; a study takes those nearest its temperature"


def _spans(tests: Sequence[FrictionTest], name: str) -> bool:
    stated = all(getattr(test, name) is not None for test in tests)
    return stated and _spread(tests, name) >= log(LEAST_SPAN)


def _spread(tests: Sequence[FrictionTest], name: str) -> float:
    """Logarithm of the largest over the smallest middle of a condition in the tests that state it."""
    middles = [centre(limits) for test in tests if (limits := getattr(test, name)) is not None]
    return max(middles) - min(middles) if middles else 0.0


def _correlation(tests: Sequence[FrictionTest]) -> float:
    """Correlation of ln speed and ln pressure; both are spanned."""
    x, y = ([centre(getattr(test, name)) for test in tests] for name in ("slip_speed", "pressure"))
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    xy = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y, strict=True))
    xx, yy = (sum((a - m) ** 2 for a in values) for values, m in ((x, mean_x), (y, mean_y)))
    return xy / math.sqrt(xx * yy)


def in_words(limits: Range, unit: str) -> str:
    """A range as text: ``"1 to 5 m/s"``."""
    low, high = (format_quantity(x, unit, 3) for x in limits)
    if low == high:
        return low
    number, _, symbol = low.partition(" ")
    return f"{number} to {high}" if high.endswith(f" {symbol}") else f"{low} to {high}"
