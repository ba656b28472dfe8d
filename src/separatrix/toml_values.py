"""Readers of single values of a TOML file: from what it holds to what a record holds, or a refusal."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches
from enum import Enum
from typing import Any, TypeVar

from separatrix.errors import InputError, noted, together
from separatrix.units import NUMBER, parse, printable, shown

Record = TypeVar("Record")
Reader = Callable[[Any, str], Any]
"""From a value and the name of its place to the converted value; raises InputError."""

_BESIDE = ("ring", "race", "land", "guided")
"""Words that may follow a choice."""


def folded(name: str) -> str:
    """Letters and digits of a name in lower case: what two spellings of it have in common."""
    return "".join(c for c in name.casefold() if c.isalnum())


def nearest(name: str, known: Iterable[str]) -> str:
    """Sentence for a name that is not known: the nearest one that is, and as many as fit in a line."""
    choices = list(known)
    by_case = {c.casefold(): c for c in choices}
    if near := get_close_matches(name[:80].casefold(), by_case, 1, 0.6):
        return f"Did you mean {by_case[near[0]]}?"
    return cut_list(f"Known: {', '.join(choices)}.")


def cut_list(listed: str) -> str:
    """A sentence with a list, cut after a comma where it is long."""
    return listed if len(listed) <= 200 else listed[: listed.rindex(",", 0, 200)] + ", ..."


def quantity(unit: str) -> Reader:
    """Read a number with a unit, as text; of a ratio, without a unit, a plain number."""
    return ratio if unit == "-" else lambda value, where: parse(value, unit, where)


def ratio(value: Any, where: str) -> float:
    """Read a plain number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        cure = _as_number(value)
        raise InputError(where, "must be a plain number, without a unit", shown(value), cure)
    if not -1e300 < value < 1e300:  # an integer may be too long for a float
        raise InputError(where, "must be a finite number", shown(value))
    return float(value)


def whole(value: Any, where: str) -> int:
    """Read an integer."""
    if isinstance(value, bool) or not isinstance(value, int):
        near = isinstance(value, float) and -1e15 < value < 1e15 and value == int(value)
        cure = f"Write {int(value)}." if near else _as_number(value)
        raise InputError(where, "must be a whole number", shown(value), cure)
    return value


def text(value: Any, where: str) -> str:
    """Read a line of printable text."""
    if not isinstance(value, str):
        raise InputError(where, "must be text", shown(value))
    if not 0 < len(value.strip()) <= 200 or not value.isprintable():
        raise InputError(where, "must be one line of 1 to 200 printable characters", shown(value))
    return value


def choice(options: type[Enum]) -> Reader:
    """Read one of the values of an Enum, in any spelling: "Inner ring" is "inner"."""
    names = [option.value for option in options]
    known = {folded(f"{name} {word}"): name for name in names for word in ("", *_BESIDE)}

    def read(value: Any, where: str) -> Enum:
        found = known.get(folded(value)) if isinstance(value, str) else None
        if found is None:
            rule = "must be " + " or ".join([", ".join(f'"{name}"' for name in names[:-1]), f'"{names[-1]}"'])
            raise InputError(where, rule, shown(value))
        return options(found)

    return read


def list_of(reader: Reader) -> Reader:
    """Read a list, each item with one reader."""

    def read(value: Any, where: str) -> tuple[Any, ...]:
        if not isinstance(value, list):
            raise InputError(where, "must be a list in [brackets]", shown(value))
        return tuple(reader(item, f"{where}, item {i},") for i, item in enumerate(value, 1))

    return read


def table(
    value: Any,
    where: str,
    readers: Mapping[str, Reader],
    required: tuple[str, ...] = (),
    what: str = "this table",
) -> dict[str, Any]:
    """Read a table in place, every key known and every required key there; all faults are collected."""
    if not isinstance(value, dict):
        raise InputError(where, f"must be a table with {', '.join(required)}", shown(value))
    given: dict[str, Any] = {}
    problems: list[InputError] = []
    for key, item in value.items():
        at = f"{where}.{printable(key)}"
        with noted(problems):
            if key not in readers:
                raise InputError(at, f"is not a key of {what}", cure=nearest(key, readers))
            given[key] = readers[key](item, at)
    if missing := [key for key in required if key not in value]:
        problems.append(InputError(where, f"lacks: {', '.join(missing)}"))
    if problems:
        raise together(problems)
    return given


def build(record: Callable[..., Record], values: Mapping[str, Any], where: str) -> Record:
    """Build a record from a table; its refusals are given the place of the table."""
    try:
        return record(**values)
    except InputError as error:
        found = [p.at(f"{where}.{p.path.partition('.')[2]}") for p in error.problems or (error,)]
        raise together(found) from None


def _as_number(value: Any) -> str:
    """What helps where a number is given as text."""
    number = value.replace(",", ".") if isinstance(value, str) else ""
    if number.endswith("%") and re.fullmatch(NUMBER, share := number.removesuffix("%").strip()):
        return f"Write {float(share) / 100.0:.12g}."
    if re.fullmatch(NUMBER, number.strip()) is None:
        return ""
    point = " with a decimal point" if "," in value else ""
    return f"Write {number.strip()} as a number{point}, not as text."
