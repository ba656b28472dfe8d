"""Readers of single values: from what TOML holds to what a record holds, or a refusal."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum
from typing import Any, TypeVar

from separatrix import library, study
from separatrix.errors import InputError, together
from separatrix.study import Friction, Material
from separatrix.study_file.document import nearest
from separatrix.units import parse, printable, shown

Record = TypeVar("Record")
Reader = Callable[[Any, str], Any]
"""From a value and the name of its place to the converted value; raises InputError."""


def as_is(value: Any, where: str) -> Any:  # noqa: ARG001 - the signature of every reader
    """Read nothing yet."""
    return value


def quantity(unit: str) -> Reader:
    """Read a number with a unit, as text."""
    return lambda value, where: parse(value, unit, where)


def ratio(value: Any, where: str) -> float:
    """Read a plain number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        cure = "Write it without quotes." if isinstance(value, str) and _is_plain_number(value) else ""
        if isinstance(value, str) and "," in value:
            cure = "Write a decimal point, without quotes."
        raise InputError(where, "must be a plain number, without a unit", "", shown(value), cure)
    if not -1e300 < value < 1e300:  # an integer may be too long for a float
        raise InputError(where, "must be a finite number", "", shown(value))
    return float(value)


def whole(value: Any, where: str) -> int:
    """Read an integer."""
    if isinstance(value, bool) or not isinstance(value, int):
        near = isinstance(value, float) and -1e15 < value < 1e15 and value == int(value)
        cure = f"Write {int(value)}." if near else ""
        raise InputError(where, "must be a whole number", "", shown(value), cure)
    return value


def text(value: Any, where: str) -> str:
    """Read a line of printable text."""
    if not isinstance(value, str):
        raise InputError(where, "must be text in quotes", "", shown(value))
    if not 0 < len(value.strip()) <= 200 or not value.isprintable():
        raise InputError(where, "must be one line of 1 to 200 printable characters", "", shown(value))
    return value


def choice(options: type[Enum]) -> Reader:
    """Read one of the values of an Enum."""

    def read(value: Any, where: str) -> Enum:
        names = [option.value for option in options]
        if value not in names or not isinstance(value, str):
            rule = "must be " + " or ".join([", ".join(f'"{name}"' for name in names[:-1]), f'"{names[-1]}"'])
            raise InputError(where, rule, "", shown(value))
        return options(value)

    return read


def list_of(reader: Reader) -> Reader:
    """Read a list, each item with one reader."""

    def read(value: Any, where: str) -> tuple[Any, ...]:
        if not isinstance(value, list):
            raise InputError(where, "must be a list in [brackets]", "", shown(value))
        return tuple(reader(item, f"{where}, item {i},") for i, item in enumerate(value, 1))

    return read


def kicks(value: Any, where: str) -> tuple[float, ...]:
    """Read the speeds of the kicks, in any order."""
    return tuple(sorted(list_of(quantity("m/s"))(value, where)))


def pocket_angles(value: Any, where: str) -> tuple[float, ...]:
    """Read the angle of each pocket; that there is one for each ball is the study's to check."""
    if not value and isinstance(value, list):
        raise InputError(where, "must not be empty", cure="Leave it out for pockets that stand evenly.")
    return tuple(list_of(quantity("rad"))(value, where))


def restitution_factors(value: Any, where: str) -> tuple[float, ...]:
    """Read ``{ from = 0.05, to = 0.95, count = 19 }``, or a list of numbers."""
    if not value and isinstance(value, list):
        raise InputError(where, "must not be empty", cure="Leave it out to have them chosen.")
    if isinstance(value, list):
        return tuple(list_of(ratio)(value, where))
    given = table(value, where, {"from": ratio, "to": ratio, "count": whole}, ("from", "to", "count"))
    if not 2 <= given["count"] <= 1000:
        raise InputError(where, "needs a count from 2 to 1000", "", shown(given["count"]))
    return study.evenly_spaced(given["from"], given["to"], given["count"])


def material(kind: str) -> Reader:
    """Read a material: a name of the library, or a table with its properties."""

    def read(value: Any, where: str) -> Material:
        if isinstance(value, str):
            return named_material(value, kind, where)
        if not isinstance(value, dict):
            rule = f"must be the name of a {kind} in quotes, or a table with its properties in {{braces}}"
            raise InputError(where, rule, "", shown(value))
        return material_in_place(value, where)

    return read


def named_material(name: str, kind: str, where: str) -> Material:
    """Material of the library, or a refusal that lists what there is."""
    if name not in library.names(kind):
        listed = f"The library has {', '.join(library.names(kind))}."
        near = nearest(name, library.names(kind))
        cure = f"{near} {listed}" if near.startswith("Did") else listed
        raise InputError(where, f"is no {kind} of the library", "", shown(name), cure)
    return library.material(kind, name)


def material_in_place(value: Any, where: str, name: str = "given in the study") -> Material:
    """Material from a table with elastic_modulus, poisson_ratio and perhaps density, name and source."""
    readers: dict[str, Reader] = {
        "elastic_modulus": quantity("Pa"),
        "poisson_ratio": ratio,
        "density": quantity("kg/m3"),
        "name": text,
        "source": text,
        "confidence": text,
    }
    given = table(value, where, readers, ("elastic_modulus", "poisson_ratio"))
    return build(Material, {"name": name, **given}, where)


def friction(value: Any, where: str) -> Friction:
    """Read a friction: a number, or a table with mean, standard_deviation and count."""
    if isinstance(value, dict):
        readers: dict[str, Reader] = {
            "mean": ratio,
            "standard_deviation": ratio,
            "count": whole,
            "source": text,
        }
        return build(Friction, table(value, where, readers, ("mean",)), where)
    return build(Friction, {"mean": ratio(value, where)}, where)


def table(value: Any, where: str, readers: dict[str, Reader], required: tuple[str, ...]) -> dict[str, Any]:
    """Read a table in place: every key known, every required key there."""
    if not isinstance(value, dict):
        raise InputError(where, f"must be a table in {{braces}} with {', '.join(required)}", "", shown(value))
    for key in value:
        if key not in readers:
            at = f"{where}.{printable(key)}"
            raise InputError(at, "is no key of this table", cure=nearest(key, readers))
    if missing := [key for key in required if key not in value]:
        raise InputError(where, f"lacks: {', '.join(missing)}")
    return {key: readers[key](item, f"{where}.{key}") for key, item in value.items()}


def build(record: type[Record], values: dict[str, Any], where: str) -> Record:
    """Build a record from a table; its refusals are given the place of the table."""
    try:
        return record(**values)
    except InputError as error:
        found = [
            InputError(f"{where}.{p.where.partition('.')[2]}", p.rule, p.unit, p.value, p.cure)
            for p in error.problems or (error,)
        ]
        raise together(found) from None


def _is_plain_number(value: str) -> bool:
    try:
        return math.isfinite(float(value))
    except ValueError:
        return False
