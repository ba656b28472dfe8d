"""From the cells of one row to what a TOML file would say: a number, a text with its unit, or a list."""

from __future__ import annotations

import math
import re
from typing import Any

from separatrix.errors import InputError
from separatrix.study_file.sheet_cells import Field
from separatrix.units import shown

LISTS = frozenset({"kicks", "pocket_angles", "restitution_factors", "materials", "library"})
LIST_PARTS = frozenset({"between", "samples"})
"""Keys, and last parts of dotted keys, that are lists even of one item."""

SEPARATOR = ";"
_PLAIN = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_BEGINS_AS_NUMBER = re.compile(r"[+-]?\.?[0-9]")


def written_value(field: Field) -> Any:
    """Return the value of a row as a TOML file would give it.

    Raises
    ------
    InputError
        A percentage has a unit, or a list has a width.
    """
    text = field.value.value
    if isinstance(text, str) and is_list(field.key, text):
        if field.spread is not None:
            raise InputError(field.spread_place, "is a width beside a list", cure="Clear one of them.")
        return list_of(text, field.unit)
    if field.spread is not None:
        return _spread(field)
    value = _alone(field)
    return [value] if _takes_list(field.key) and not isinstance(value, bool) else value


def begins_as_number(text: str) -> bool:
    """Whether a text begins as a number does."""
    return _BEGINS_AS_NUMBER.match(text.strip()) is not None


def is_list(key: str, text: str) -> bool:
    """Whether a text is a list: its key takes one, or numbers stand on both sides of a separator."""
    parts = [part.strip() for part in text.split(SEPARATOR)]
    numbers = len(parts) > 1 and all(begins_as_number(part) for part in parts if part)
    return numbers or _takes_list(key)


def list_of(text: str, unit: str) -> list[Any]:
    """Return the items of a list in one cell."""
    return [_item(part.strip(), unit) for part in text.split(SEPARATOR) if part.strip()]


def number_text(value: float) -> str:
    """Return a number as text without loss: ``"25"``, ``"11.1125"``, ``"3e-07"``."""
    return str(int(value)) if value == math.floor(value) and abs(value) < 1e15 else repr(value)


def plain_number(value: float) -> int | float:
    """Return a number of a cell, which does not tell 64 from 64.0, as an integer if it is one."""
    return int(value) if math.isfinite(value) and value == math.floor(value) and abs(value) < 1e15 else value


def _takes_list(key: str) -> bool:
    return key in LISTS or key.rpartition(".")[2] in LIST_PARTS


def _item(text: str, unit: str) -> Any:
    """Return one item of a list."""
    if _PLAIN.fullmatch(text) is None:
        return text
    return f"{text} {unit}" if unit else plain_number(float(text))


def _alone(field: Field) -> Any:
    value, unit = field.value.value, field.unit
    if isinstance(value, float):
        if unit and field.value.format == "percent":
            rule, cure = "is a percentage with a unit", "Format the cell as a number."
            raise InputError(field.value_place, rule, f"{shown(value)} {unit}", cure)
        return f"{number_text(value)} {unit}" if unit else plain_number(value)
    if not unit or not isinstance(value, str):
        return value
    if (
        begins_as_number(value)
        and re.search(r"[^\W\d_]|°", value)
        and _PLAIN.fullmatch(value.strip()) is None
    ):
        rule, cure = "is a unit beside a value that brings its own", "Clear this cell."
        raise InputError(field.unit_place, rule, shown(value), cure)
    return f"{value} {unit}"


def _spread(field: Field) -> str:
    """Return a value and its width: ``"0.5 um +- 20 %"``."""
    value = _alone(field)
    return f"{value} +- {_width(field)}"


def _width(field: Field) -> str:
    width = field.spread.value if field.spread is not None else None
    if isinstance(width, float):
        if field.spread is not None and field.spread.format == "percent":
            return f"{number_text(float(f'{100.0 * width:.12g}'))} %"
        return f"{number_text(width)} {field.unit}".strip()
    text = str(width).strip().removeprefix("+-").removeprefix("±").lstrip()
    return f"{text} {field.unit}".strip() if _PLAIN.fullmatch(text) else text
