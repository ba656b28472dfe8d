"""What is said and done where friction is asked for outside the tested conditions.

The friction stays that of the nearest tested condition; slopes are not carried on. The scatter is widened
by what a power law of a plausible exponent could do on the way: exponent times ln(asked / nearest tested).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot, log

from separatrix.friction.fit.covariates import Range, in_words
from separatrix.friction.fit.records import CONDITIONS, PRODUCT, WORDS
from separatrix.units import Ratio, format_quantity

EXPONENTS = {"slip_speed": 0.1, "pressure": 0.1, PRODUCT: 0.1, "temperature": 0.3}
"""Exponent with which friction may go on with a condition beyond the tests: guesses. For slip speed,
pressure and pV a slope that was measured to be steeper takes their place."""

SLACK = 1.05
"""Ratio to the tested range within which a speed, a pressure or pV still counts as tested."""

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
    """Conditions held within the tested ranges; then also pV, where speed and pressure are both known.

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
    for name in (*asked, PRODUCT):
        value, limits = _product(values) if name == PRODUCT else asked[name], ranges.get(name)
        if value is None or (limits is None and name == PRODUCT):
            continue
        if limits is None:
            sentences.append(f"test {WORDS[name]} unknown (pocket: {_text(value, name)})")
            continue
        values[name] = min(max(value, limits[0]), limits[1])
        if _counts_as_tested(value, limits, name):
            continue
        sentences.append(_sentence(value, limits, name))
        exponent = max(exponents.get(name, 0.0), EXPONENTS[name])
        widening = hypot(widening, exponent * log(value / values[name]))
    return Held(values=values, sentences=tuple(sentences), widening=widening)


def other_medium(asked: str | Sequence[str] | None, tested: Iterable[str]) -> tuple[str, ...]:
    """What is said of a medium in which no test was run, by all its names; no number can be put on it."""
    names = (asked,) if isinstance(asked, str) else tuple(asked or ())
    if not names or {name.strip().casefold() for name in names} & {one.strip().casefold() for one in tested}:
        return ()
    return (f"tested in {', '.join(tested)}, not in {names[0]}",)


def _product(values: Mapping[str, float]) -> float | None:
    """PV of the held speed and pressure: each may have been tested, and both together not."""
    both = {"slip_speed", "pressure"} <= values.keys()
    return values["slip_speed"] * values["pressure"] if both else None


def _counts_as_tested(value: float, limits: Range, name: str) -> bool:
    low, high = limits
    if name == "temperature":
        return low - TEMPERATURE_SLACK <= value <= high + TEMPERATURE_SLACK
    return low / SLACK <= value <= high * SLACK


def _sentence(value: float, limits: Range, name: str) -> str:
    if name == PRODUCT:
        product, tested = _text(value, name), in_words(limits, "Pa")
        side = "beyond" if value > limits[1] else "below"
        return f"slip speed and pressure were not tested together: pV {product} is {side} {tested} m/s"
    nearest = limits[1] if value > limits[1] else limits[0]
    return (
        f"{WORDS[name]} in the pocket {_text(value, name)}, "
        f"tests cover {in_words(limits, CONDITIONS[name])}: value at {_text(nearest, name)} used"
    )


def _text(value: float, name: str) -> str:
    return (
        f"{format_quantity(value, 'Pa', 3)} m/s"
        if name == PRODUCT
        else format_quantity(value, CONDITIONS[name], 3)
    )
