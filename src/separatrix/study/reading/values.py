"""Readers of the values of a study file: how each key of each section is read."""

from __future__ import annotations

import csv
import re
import types
import typing
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import MISSING, fields
from enum import Enum
from functools import cache
from pathlib import Path

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.input_files import place
from separatrix.ground.toml import (
    Kind,
    Reader,
    build,
    choice,
    cut_list,
    list_of,
    nearest,
    path_text,
    quantity,
    ratio,
    read_text,
    table,
    text,
    whole,
)
from separatrix.ground.units import parse, shown, unit_of
from separatrix.study.candidates import NAMELESS
from separatrix.study.film import MOST_PLACES, Wear, Worn
from separatrix.study.library import Library
from separatrix.study.reading.uncertain import Uncertain, certain, count, gathered, number
from separatrix.study.study import SECTIONS as RECORDS
from separatrix.study.study import KinematicModel, Material, evenly_spaced

_CURE = 'Write its first row like "y [mm],thickness [um]".'
PROFILE = Kind(noun="a profile of a film", most_bytes=5_000_000, empty=_CURE)
HEADS = ("y", "thickness")
_HEAD = re.compile(r"\s*(\w+)\s*\[([^\]]+)\]\s*")


class Context(typing.NamedTuple):
    """Where the names of a study are looked up."""

    library: Library = Library()
    temperature: float | None = None
    """By which data of the library are chosen; None where the study states none."""

    folder: Path = Path()
    """Of the files that [film] names."""


_NOWHERE = Context()
_READING: ContextVar[Context] = ContextVar("reading", default=_NOWHERE)


@contextmanager
def using(library: Library, temperature: float | None, folder: Path) -> Iterator[None]:
    """Look up names here until the end, see `Context`."""
    before = _READING.set(Context(library, temperature, folder))
    try:
        yield
    finally:
        _READING.reset(before)


def context() -> Context:
    """Return that of the study that is being read."""
    return _READING.get()


def items(unit: str, default: str) -> Reader[tuple[float, ...]]:
    """Read a list of numbers that is not empty; left out, there is a default."""

    def read(value: object, where: str) -> tuple[float, ...]:
        if value == []:
            raise InputError(where, "must not be empty", cure=f"Leave it out to have {default}.")
        return list_of(quantity(unit))(value, where)

    return read


def kicks(value: object, where: str) -> tuple[float, ...]:
    """Read the speeds of the kicks, in any order."""
    return tuple(sorted(items("m/s", "them chosen")(value, where)))


def restitution_factors(value: object, where: str) -> tuple[float, ...]:
    """Read ``{ from = 0.05, to = 0.95, count = 19 }``, or a list of numbers."""
    if not isinstance(value, dict):
        return items("-", "them chosen")(value, where)
    given = table(value, where, {"from": ratio, "to": ratio, "count": whole}, ("from", "to", "count"))
    if not 2 <= given["count"] <= 1000:
        raise InputError(where, "needs a count from 2 to 1000", shown(given["count"]))
    return evenly_spaced(given["from"], given["to"], given["count"])


def material(kind: str) -> Reader[Material | Uncertain]:
    """Read a material: a name of the library, or a table with its properties."""

    def read(value: object, where: str) -> Material | Uncertain:
        if isinstance(value, str):
            return named_material(value, kind, where)
        if not isinstance(value, dict):
            rule = f"must be the name of a {kind}, or its properties elastic_modulus and poisson_ratio"
            cure = f'Write it like "{context().library.names(kind)[0]}".'
            raise InputError(where, rule, shown(value), cure)
        given, found = gathered(table(value, where, _PROPERTIES, ("elastic_modulus", "poisson_ratio")))
        made = build(Material, {"name": NAMELESS, **given}, where)
        return Uncertain(made, found) if found else made

    return read


_PROPERTIES: dict[str, Reader[object]] = {
    "elastic_modulus": number("Pa"),
    "poisson_ratio": number("-"),
    "density": number("kg/m3"),
    "thermal_expansion": number("m/m/K"),
    "compressive_strength": quantity("Pa"),
    "name": text,
    "source": text,
    "confidence": text,
}


def named_material(name: str, kind: str, where: str) -> Material:
    """Material of the library, or a refusal that lists its materials."""
    return context().library.material(kind, known_name(name, kind, where), context().temperature)


def cage_material(value: object, where: str) -> Material | Uncertain | str:
    """Read the cage's material; a name that the library lacks stays, for it may be that of a candidate."""
    if isinstance(value, str) and context().library.named("cage material", value) is None:
        return text(value, where)
    return material("cage material")(value, where)


def known_name(name: str, kind: str, where: str, more: str = "") -> str:
    """Exact name in the library of one in any spelling, or a refusal that lists the names."""
    found = context().library.named(kind, name)
    if found is not None:
        return found
    names = context().library.names(kind)
    listed, near = cut_list(f"The library has {', '.join(names)}."), nearest(name, names)
    cure = f"{near} {listed}{more}" if near.startswith("Did") else f"{listed}{more}"
    raise InputError(where, f"is not a {kind} of the library", shown(name), cure)


_WEAR: dict[str, Reader[object]] = {
    "friction": number("-"),
    "width": number("m"),
    "share": number("-"),
    "thickness": number("m"),
    "across": list_of(quantity("m")),
    "thicknesses": list_of(quantity("m")),
    "profile": text,
    "races": choice(Worn),
}


def wear(value: object, where: str) -> Wear | Uncertain:
    """Read the wear of a film: a band, or a profile of thickness in the study or in a CSV file."""
    given, found = gathered(table(value, where, _WEAR, ("friction",), "[film.wear]"))
    if "profile" in given:
        if {"across", "thicknesses"} & given.keys():
            rule = "and across with thicknesses exclude each other"
            raise InputError(f"{where}.profile", rule, cure="Give one of the two.")
        given["across"], given["thicknesses"] = read_profile(
            place(context().folder, str(given.pop("profile"))), f"{where}.profile"
        )
    made = build(Wear, given, where)
    return Uncertain(made, found) if found else made


def read_profile(path: Path, where: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Places across the groove and thicknesses there [m], of a table of two columns with their units."""
    if not path.is_file():
        cure = "It is looked for in the folder of the study."
        raise InputError(where, "does not name a file", shown(str(path.name)), cure)
    lines = enumerate(read_text(path, PROFILE).splitlines(), start=1)
    rows = [(n, row) for n, line in lines if (row := next(csv.reader([line]), []))]
    label = path_text(path)
    heads = [_HEAD.fullmatch(cell) for cell in rows[0][1]] if rows else []
    found = {head[1].casefold(): (i, head[2]) for i, head in enumerate(heads) if head is not None}
    if set(found) != set(HEADS) or len(heads) != len(HEADS):
        raise InputError(f"{label}, line 1", "must name two columns, y and thickness", cure=_CURE)
    if len(rows) - 1 > MOST_PLACES:
        raise InputError(label, f"must have at most {MOST_PLACES} rows", f"{len(rows) - 1}")
    columns: dict[str, list[float]] = {name: [] for name in HEADS}
    problems: list[InputError] = []
    for line, row in rows[1:]:
        with noted(problems):
            at = f"{label}, line {line}"
            if len(row) != len(HEADS):
                raise InputError(at, "must have two cells", f"{len(row)}")
            for name, (i, unit) in found.items():
                columns[name].append(parse(f"{row[i].strip()} {unit}", "m", f"{at}: {name}"))
    if problems:
        raise together(problems)
    return tuple(columns["y"]), tuple(columns["thickness"])


_CERTAIN = frozenset({"reference_kick", "runs", "seed"})
_LISTS: dict[str, Reader[tuple[float, ...]]] = {
    "kicks": kicks,
    "pocket_angles": items("rad", "evenly spaced pockets"),
    "restitution_factors": restitution_factors,
}
_MATERIALS: dict[tuple[str, str], Reader[object]] = {
    ("bearing", "ball_material"): material("bearing material"),
    ("bearing", "ring_material"): material("bearing material"),
    ("film", "material"): material("film"),
    ("cage", "material"): cage_material,
}


def required_fields(record: type) -> list[str]:
    """Fields of a record that have no default."""
    return [f.name for f in fields(record) if f.default is f.default_factory is MISSING]


@cache
def _types(record: type) -> dict[str, object]:
    """Types of the fields of a record, without None."""
    hints = typing.get_type_hints(record).items()
    return {
        name: typing.get_args(hint)[0] if isinstance(hint, types.UnionType) else hint for name, hint in hints
    }


def options_of(section: str, key: str) -> type[Enum] | None:
    """Choices of a key; None for a key that takes other values."""
    if section == "kinematics":
        return KinematicModel
    record = RECORDS.get(section)
    hint = None if record is None else _types(record).get(key)
    return hint if isinstance(hint, type) and issubclass(hint, Enum) else None


def _reader(section: str, record: type, name: str) -> Reader[object]:
    """Reader of a field of a record, by its type."""
    hint, options = _types(record)[name], options_of(section, name)
    if name in _LISTS:
        return certain(_LISTS[name])
    if hint is Material:
        return _MATERIALS[section, name]
    if hint is Wear:
        return wear
    if hint is int:
        return certain(whole) if name in _CERTAIN else count
    if hint is str:
        return text
    if options is not None:
        return choice(options)
    unit = unit_of(record, name)
    return certain(quantity(unit)) if name in _CERTAIN else number(unit)


READERS: dict[str, dict[str, Reader[object]]] = {
    **{
        # the name of the cage's candidate follows from its material
        section: {
            f.name: _reader(section, record, f.name) for f in fields(record) if f.name != "material_name"
        }
        for section, record in RECORDS.items()
    },
    "kinematics": {"model": choice(KinematicModel)},
    "ranking": {
        "friction": text,
        "materials": list_of(text),
        "environment": text,
        "candidates": lambda value, _: value,  # read one by one by `ranking_section`
        "friction_scatter": certain(ratio),
    },
}
"""How each key of each section is read: the contract of a study file."""

READERS["bearing"]["radial_clearance"] = number("m")
READERS["film"] |= {"elastic_modulus": number("Pa"), "poisson_ratio": number("-")}
