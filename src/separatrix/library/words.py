"""Readers that records of materials and tables of friction share."""

from __future__ import annotations

from typing import Any

from separatrix.errors import InputError
from separatrix.library.records import CONFIDENCES
from separatrix.units import format_quantity, parse, shown

LONGEST_TEXT = 1000
BLANK = "What is not known is left out, never given as 0."


def long_text(value: Any, where: str) -> str:
    """Read printable text on one line, up to `LONGEST_TEXT` characters."""
    if not isinstance(value, str):
        raise InputError(where, "must be text in quotes", shown(value))
    if not 0 < len(value.strip()) <= LONGEST_TEXT or not value.isprintable():
        rule = f"must be one line of 1 to {LONGEST_TEXT} printable characters"
        raise InputError(where, rule, shown(value))
    return value


def yes_or_no(value: Any, where: str) -> bool:
    """Read true or false."""
    if not isinstance(value, bool):
        raise InputError(where, "must be true or false, without quotes", shown(value))
    return value


def span(unit: str, value: Any, where: str, low: float, high: float) -> tuple[float, float]:
    """Read one quantity, or a list of the lowest and the highest one."""
    bounds = value if isinstance(value, list) else [value, value]
    if len(bounds) != 2:
        raise InputError(where, "must be one quantity or a list of the lowest and the highest", shown(value))
    first, last = (in_range(unit, bound, where, low, high) for bound in bounds)
    if first > last:
        raise InputError(where, "must give the lower end first", f"{shown(bounds[0])} first")
    return first, last


def in_range(unit: str, value: Any, where: str, low: float, high: float) -> float:
    """Read one quantity between two bounds."""
    number = parse(value, unit, where)
    if not low <= number <= high:
        rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
        raise InputError(where, rule, shown(value))
    return number


def confidence_of(value: Any, where: str) -> str:
    """Read one of the words, perhaps with a remark after a semicolon."""
    given = long_text(value, where)
    if given.partition(";")[0].strip() not in CONFIDENCES:
        rule = f"must be one of {', '.join(CONFIDENCES)}, perhaps with a remark after a semicolon"
        raise InputError(where, rule, shown(given), 'A guess is allowed and marked: "guess".')
    return given


def raw(value: Any, where: str) -> Any:  # noqa: ARG001 - the signature of every reader
    """Read nothing yet."""
    return value
