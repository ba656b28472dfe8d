"""Named materials and friction tables, each datum with its source and its confidence.

The data are the TOML files in `data/`; this is their one loader.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from separatrix.errors import DataError
from separatrix.study import Candidate, Friction, Material
from separatrix.units import parse

FILES = {
    "bearing material": "bearing_materials.toml",
    "film": "films.toml",
    "cage material": "cage_materials.toml",
}
"""The kinds of material in the library, and the file of each."""

FRICTION_TABLES = ("pin-on-disk-77K",)

_WORDS = {"elastic_modulus": "modulus", "poisson_ratio": "Poisson's ratio", "density": "density"}
_UNITS = {"elastic_modulus": "Pa", "density": "kg/m3"}


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTable:
    """Measured ball/cage friction of several materials in several environments; None where not measured."""

    name: str
    title: str
    source: str
    confidence: str
    environments: tuple[str, ...]
    friction: Mapping[str, Mapping[str, Friction | None]]

    def candidate(self, name: str) -> Candidate:
        """One material of the table, with its elastic record if the library has one."""
        if name not in self.friction:
            raise DataError(f'no material "{name}"; {self.name} has {", ".join(self.friction)}')
        material = cage_material(name) if name in names("cage material") else None
        return Candidate(name=name, friction=self.friction[name], material=material)


def names(kind: str) -> tuple[str, ...]:
    """Names of the library's materials of one kind, a key of `FILES`."""
    return tuple(_data(FILES[kind]))


def material(kind: str, name: str) -> Material:
    """One material by its exact name.

    Raises
    ------
    DataError
        The library has no material of that name.
    """
    if name not in names(kind):
        raise DataError(f'no {kind} "{name}"; the library has {", ".join(names(kind))}')
    record = _data(FILES[kind])[name]
    data = {key: datum for key, datum in record.items() if isinstance(datum, dict)}
    sources = [
        record["remark"].rstrip("."),
        *(f"{_WORDS[key]}: {datum['source']}" for key, datum in data.items()),
    ]
    return Material(
        name=name,
        source=". ".join(sources),
        confidence=", ".join(f"{_WORDS[key]}: {datum['confidence']}" for key, datum in data.items()),
        **{key: _value(key, datum["value"]) for key, datum in data.items()},
    )


def bearing_material(name: str) -> Material:
    """A material of balls and rings."""
    return material("bearing material", name)


def film_material(name: str) -> Material:
    """A solid lubricant film."""
    return material("film", name)


def cage_material(name: str) -> Material:
    """A cage material."""
    return material("cage material", name)


@cache
def friction_table(name: str) -> FrictionTable:
    """One table of measured friction by its exact name.

    Raises
    ------
    DataError
        The library has no table of that name.
    """
    if name not in FRICTION_TABLES:
        raise DataError(f'no friction table "{name}"; the library has {", ".join(FRICTION_TABLES)}')
    data = _data(f"{name}.toml")
    environments = tuple(data["environments"])
    friction = {
        material: {env: _friction(row.get(env), data) for env in environments}
        for material, row in data["friction"].items()
    }
    return FrictionTable(
        name=name,
        title=data["title"],
        source=data["source"],
        confidence=data["confidence"],
        environments=environments,
        friction=friction,
    )


def _friction(value: float | None, data: dict[str, Any]) -> Friction | None:
    return (
        None if value is None else Friction(mean=value, source=data["source"], confidence=data["confidence"])
    )


def _value(key: str, value: str | float) -> float:
    return parse(str(value), _UNITS[key], key) if key in _UNITS else float(value)


@cache
def _data(file: str) -> dict[str, Any]:
    return tomllib.loads((files("separatrix.library") / "data" / file).read_text(encoding="utf-8"))
