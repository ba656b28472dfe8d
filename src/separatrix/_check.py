"""What a record checks about itself, as problems to collect and report together."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from enum import Enum
from numbers import Real

from separatrix.errors import InputError, together
from separatrix.units import format_quantity, shown, unit_of

Problems = Iterator[InputError]


def settle(*checks: Iterable[InputError]) -> None:
    """Raise every problem of the checks at once; the first problem of a field hides its others."""
    found: dict[str, InputError] = {}
    for check in checks:
        for problem in check:
            found.setdefault(problem.path, problem)
    if found:
        raise together(list(found.values()))


def between(
    record: object,
    field: str,
    low: float,
    high: float,
    *,
    hint: str = "",
    open_low: bool = False,
    open_high: bool = False,
) -> Problems:
    """Refuse what is no finite number in [low, high], without its open ends. None passes."""
    value = getattr(record, field)
    if value is None:
        return
    if not is_number(value) or not math.isfinite(value):
        yield problem(record, field, "must be a finite number", hint)
    elif not low <= value <= high or (open_low and value == low) or (open_high and value == high):
        yield problem(
            record, field, _range(unit_of(type(record), field), low, high, open_low, open_high), hint
        )


def positive(record: object, field: str, low: float, high: float, *, hint: str = "") -> Problems:
    """Refuse what is not above zero, or outside [low, high], where nothing real lies. None passes."""
    yield from _one_sided(record, field, low, high, "> 0", hint)


def not_negative(record: object, field: str, high: float, *, hint: str = "") -> Problems:
    """Refuse what is below zero, or above `high`, where nothing real lies. None passes."""
    yield from _one_sided(record, field, 0.0, high, ">= 0", hint)


def _one_sided(record: object, field: str, low: float, high: float, sign: str, hint: str) -> Problems:
    """Like `between`, but says only which side is wrong: the other one would not help."""
    value = getattr(record, field)
    if value is None or (is_number(value) and low <= value <= high):
        return
    unit = unit_of(type(record), field)
    if not is_number(value) or not math.isfinite(value):
        rule = f"must be a finite number {sign}"
    elif value < 0.0 or (value == 0.0 and sign == "> 0"):
        rule = f"must be {sign}"
    else:
        rule = (
            f"must be {'>=' if value < low else '<='} {format_quantity(low if value < low else high, unit)}"
        )
    yield problem(record, field, rule, hint)


def whole(record: object, field: str, low: int, high: int, *, hint: str = "") -> Problems:
    """Refuse what is not an integer between `low` and `high`."""
    value = getattr(record, field)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        yield problem(record, field, f"must be a whole number from {low} to {high}", hint)


def one_of(record: object, field: str, options: type[Enum]) -> Problems:
    """Refuse what is not a member of an Enum."""
    value = getattr(record, field)
    if not isinstance(value, options):
        names = ", ".join(f"{options.__name__}.{option.name}" for option in options)
        yield problem(record, field, f"must be one of {names}")


def printable_text(record: object, field: str, longest: int = 200) -> Problems:
    """Refuse what is not printable text of 1 to `longest` characters."""
    value = getattr(record, field)
    if value is None:
        return
    if not isinstance(value, str) or not 0 < len(value) <= longest or not value.isprintable():
        yield problem(record, field, f"must be printable text of 1 to {longest} characters")


def problem(record: object, field: str, rule: str, cure: str = "") -> InputError:
    """Build the refusal of one field: where, rule, value and cure."""
    value = getattr(record, field)
    unit = unit_of(type(record), field)
    text = (
        format_quantity(float(value), unit, 8)
        if unit and is_number(value) and math.isfinite(value)
        else shown(value)
    )
    return InputError(f"{type(record).__name__}.{field}", rule, text, cure)


def is_number(value: object) -> bool:
    """True for a real number that is not a bool, nor an integer too long for a float."""
    too_long = isinstance(value, int) and abs(value) >= 10**300
    return isinstance(value, Real) and not isinstance(value, bool) and not too_long


def _range(unit: str, low: float, high: float, open_low: bool, open_high: bool) -> str:
    top, bottom = format_quantity(high, unit), "0" if low == 0.0 else format_quantity(low, unit)
    if open_low or open_high:
        return f"must be {'>' if open_low else '>='} {bottom} and {'<' if open_high else '<='} {top}"
    return f"must lie between {bottom} and {top}"
