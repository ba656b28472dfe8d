"""Readers of single values: from what TOML holds to what a record holds, or a refusal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from separatrix import study
from separatrix.cage_choice import NAMELESS
from separatrix.distribution import Normal
from separatrix.errors import InputError
from separatrix.library import Library
from separatrix.measured_friction import refuse_scatter_about_zero
from separatrix.study import Friction, Material
from separatrix.study_file.distributions import Uncertain, friction_deviation, gathered, number, unwrapped
from separatrix.toml_values import (
    Reader,
    as_is,
    build,
    choice,
    list_of,
    nearest,
    quantity,
    ratio,
    table,
    text,
    whole,
)
from separatrix.units import shown

__all__ = [
    "Reader",
    "as_is",
    "build",
    "cage_material",
    "choice",
    "current_library",
    "current_temperature",
    "friction",
    "kicks",
    "known_name",
    "list_of",
    "material",
    "material_in_place",
    "named_material",
    "nearest",
    "pocket_angles",
    "quantity",
    "ratio",
    "restitution_factors",
    "table",
    "text",
    "using",
    "whole",
]


_LIBRARY: ContextVar[Library | None] = ContextVar("library", default=None)
_TEMPERATURE: ContextVar[float | None] = ContextVar("temperature", default=None)


@contextmanager
def using(library: Library, temperature: float | None) -> Iterator[None]:
    """Read names from this library, with the data that serve at this temperature, until the end."""
    before = _LIBRARY.set(library), _TEMPERATURE.set(temperature)
    try:
        yield
    finally:
        _LIBRARY.reset(before[0])
        _TEMPERATURE.reset(before[1])


def current_library() -> Library:
    """The library of the study that is being read; the shipped one otherwise."""
    return _LIBRARY.get() or Library()


def current_temperature() -> float | None:
    """Temperature of the study that is being read; None where it states none."""
    return _TEMPERATURE.get()


def kicks(value: Any, where: str) -> tuple[float, ...]:
    """Read the speeds of the kicks, in any order."""
    if not value and isinstance(value, list):
        raise InputError(where, "must not be empty", cure="Leave it out to have them chosen.")
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
        raise InputError(where, "needs a count from 2 to 1000", shown(given["count"]))
    return study.evenly_spaced(given["from"], given["to"], given["count"])


def material(kind: str) -> Reader:
    """Read a material: a name of the library, or a table with its properties."""

    def read(value: Any, where: str) -> Material | Uncertain:
        if isinstance(value, str):
            return named_material(value, kind, where)
        if not isinstance(value, dict):
            rule = f"must be the name of a {kind} in quotes, or a table with its properties in {{braces}}"
            raise InputError(where, rule, shown(value))
        return material_in_place(value, where)

    return read


def named_material(name: str, kind: str, where: str) -> Material:
    """Material of the library, or a refusal that lists what there is."""
    return current_library().material(kind, known_name(name, kind, where), current_temperature())


def cage_material(value: Any, where: str) -> Material | Uncertain | str:
    """Read the cage's material; a name that the library lacks stays, for it may be that of a candidate."""
    if isinstance(value, str) and current_library().named("cage material", value) is None:
        return text(value, where)
    found: Material | Uncertain = material("cage material")(value, where)
    return found


def known_name(name: str, kind: str, where: str, more: str = "") -> str:
    """Exact name in the library of one in any spelling, or a refusal with what there is."""
    names = current_library().names(kind)
    found = current_library().named(kind, name)
    if found is not None:
        return found
    listed = f"The library has {', '.join(names)}."
    if len(listed) > 200:
        listed = f"{listed[: listed.rindex(',', 0, 200)]}, ..."
    near = nearest(name, names)
    raise InputError(
        where,
        f"is no {kind} of the library",
        shown(name),
        f"{near} {listed}{more}" if near.startswith("Did") else f"{listed}{more}",
    )


def material_in_place(value: Any, where: str, name: str = NAMELESS) -> Material | Uncertain:
    """Material from a table with elastic_modulus, poisson_ratio and perhaps more."""
    readers: dict[str, Reader] = {
        "elastic_modulus": number(quantity("Pa"), "Pa"),
        "poisson_ratio": number(ratio, "-"),
        "density": number(quantity("kg/m3"), "kg/m3"),
        "compressive_strength": quantity("Pa"),
        "name": text,
        "source": text,
        "confidence": text,
    }
    given, found = gathered(table(value, where, readers, ("elastic_modulus", "poisson_ratio")))
    made = build(Material, {"name": name, **given}, where)
    return Uncertain(made, found) if found else made


def friction(value: Any, where: str) -> Friction | Uncertain:
    """Read a friction: a number, a table with mean, standard_deviation and count, or a distribution."""
    if isinstance(value, dict) and not {"between", "samples"} & set(value):
        readers: dict[str, Reader] = {
            "mean": ratio,
            "standard_deviation": ratio,
            "count": whole,
            "source": text,
        }
        given = {**value, "standard_deviation": friction_deviation(value, where)}
        kept = {key: item for key, item in given.items() if key in value}
        stated = build(Friction, table(kept, where, readers, ("mean",)), where)
        return refuse_scatter_about_zero(stated, where)
    mean, found = unwrapped(number(ratio, "-")(value, where))
    if not found:
        return build(Friction, {"mean": mean}, where)
    deviation = found[""].standard_deviation
    known = build(Friction, {"mean": mean, "standard_deviation": deviation}, where)
    if isinstance(found[""], Normal):
        refuse_scatter_about_zero(known, where)
    return Uncertain(known, found)
