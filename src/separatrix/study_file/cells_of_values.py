"""From what a TOML file says of a key to the cells of rows: the way back of `sheet_values`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from separatrix.study_file.sheet_values import SEPARATOR, number_text
from separatrix.units import UNITS

TEXTS = frozenset({"title", "extends", "library", "fluid", "name", "source", "confidence"})
"""Keys, and last parts of dotted keys, that are words even if they look like a quantity."""

_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_QUANTITY = re.compile(rf"\s*({_NUMBER}) ?([^0-9\s].*?)?\s*")
_SPREAD = re.compile(r"(.+?)\s*\+-\s*(.+)")


@dataclass(frozen=True, slots=True)
class Written:
    """The cells of a row."""

    value: Any = None
    spread: Any = None
    unit: str = ""


def rows_of(key: str, value: Any) -> Iterator[tuple[str, Written]]:
    """Yield the keys and cells of a value; a table has a row for each of its parts."""
    if isinstance(value, dict):
        for part, item in value.items():
            yield from rows_of(f"{key}.{part}", item)
    elif key.rpartition(".")[2] in TEXTS and not isinstance(value, list):
        yield key, Written(value)
    else:
        yield key, _list(value) if isinstance(value, list) else _one(value)


def _one(value: Any) -> Written:
    if not isinstance(value, str):
        return Written(value)
    if (spread := _SPREAD.fullmatch(value)) is not None:
        return _uncertain(value, spread[1], spread[2])
    number, unit = _quantity(value)
    return Written(value) if number is None else Written(number, unit=unit)


def _uncertain(text: str, middle: str, width: str) -> Written:
    """Return the cells of ``"0.5 um +- 20 %"``; the text as it is if its parts have different units."""
    number, unit = _quantity(middle)
    half, half_unit = _quantity(width)
    if number is not None and half is not None and half_unit == unit:
        return Written(number, half, unit)
    if number is not None and width.endswith("%"):
        return Written(number, width, unit)
    return Written(text)


def _list(items: list[Any]) -> Written:
    """Return a list in one cell, with the unit that all its items have."""
    found = [_quantity(item) if isinstance(item, str) else (item, "") for item in items]
    units = {unit for _, unit in found}
    numbers = [float(number) for number, _ in found if isinstance(number, int | float)]
    if len(units) == 1 and len(numbers) == len(items):
        return Written(f"{SEPARATOR} ".join(map(number_text, numbers)), unit=units.pop())
    return Written(f"{SEPARATOR} ".join(str(item) for item in items))


def _quantity(text: str) -> tuple[float | None, str]:
    """Return number and unit of a text, if a cell holds the number without loss; else None."""
    match = _QUANTITY.fullmatch(text)
    unit = match[2] or "" if match else ""
    if match is None or not any(unit in known for known in UNITS.values()):
        return None, ""
    number = float(match[1])
    return (number, unit) if Fraction(number_text(number)) == Fraction(match[1]) else (None, "")
