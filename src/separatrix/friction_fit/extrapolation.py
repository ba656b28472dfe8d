"""What is said and done where friction is asked for outside the tested conditions.

The friction stays that of the nearest tested condition; slopes are not carried on. The scatter is widened
by what a power law of a plausible exponent could do on the way: exponent times ln(asked / nearest tested).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, log

from separatrix.friction_fit.covariates import Range, in_words
from separatrix.friction_fit.records import CONDITIONS, WORDS
from separatrix.units import Ratio, format_quantity

EXPONENTS = {"slip_speed": 0.1, "pressure": 0.1, "temperature": 0.3}
"""Exponent with which friction may go on with a condition beyond the tests: guesses. For slip speed and
pressure a slope that was measured to be steeper takes their place."""

SLACK = {"slip_speed": 1.05, "pressure": 1.05}
"""Ratio to the tested range within which a condition still counts as tested."""

TEMPERATURE_SLACK = 5.0
"""The same for temperature, as a difference [K]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """Conditions as they are put to the fit, what is said of them, and the widening that they cost."""

    values: Mapping[str, float]
    sentences: tuple[str, ...]
    widening: Ratio


def held(
    asked: Mapping[str, float | None], ranges: Mapping[str, Range | None], exponents: Mapping[str, float]
) -> Held:
    """Conditions held within the tested ranges.

    Parameters
    ----------
    asked : mapping
        Condition to the value asked for, or None where nobody asks.
    ranges : mapping
        Condition to the tested range, or None where no test states it.
    exponents : mapping
        Condition to the exponent of the widening, where it is not that of `EXPONENTS`.
    """
    values: dict[str, float] = {}
    sentences, widening = [], 0.0
    for name, value in asked.items():
        limits = ranges.get(name)
        if value is None:
            continue
        if limits is None:
            sentences.append(f"{WORDS[name]} of the tests is not stated (asked for {_text(value, name)})")
            continue
        values[name] = min(max(value, limits[0]), limits[1])
        if _counts_as_tested(value, limits, name):
            continue
        sentences.append(_sentence(value, limits, name))
        exponent = max(exponents.get(name, 0.0), EXPONENTS[name])
        widening = hypot(widening, exponent * log(value / values[name]))
    return Held(values=values, sentences=tuple(sentences), widening=widening)


def other_medium(asked: str | None, tested: Sequence[str]) -> tuple[str, ...]:
    """What is said of a medium in which no test was run; no number can be put on it."""
    if asked is None or asked.strip().casefold() in {medium.strip().casefold() for medium in tested}:
        return ()
    return (f"tested in {', '.join(tested)}, not in {asked}",)


def _counts_as_tested(value: float, limits: Range, name: str) -> bool:
    low, high = limits
    if name == "temperature":
        return low - TEMPERATURE_SLACK <= value <= high + TEMPERATURE_SLACK
    return low / SLACK[name] <= value <= high * SLACK[name]


def _sentence(value: float, limits: Range, name: str) -> str:
    side = "beyond" if value > limits[1] else "below"
    nearest = limits[1] if value > limits[1] else limits[0]
    return (
        f"{WORDS[name]} {_text(value, name)} is {side} the tested {in_words(limits, CONDITIONS[name])} "
        f"(held at {_text(nearest, name)})"
    )


def _text(value: float, name: str) -> str:
    return format_quantity(value, CONDITIONS[name], 3)
