"""One field of a form: what a key holds as text and unit, what it may hold, and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import tomlkit

from separatrix.study_file.templates import quantity_of, units_like


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A value as text and unit, what it may be, its meaning, and what is wrong with it.

    `units` are the spellings that its unit may have; `choices` what it must be one of (`is_open` lets it be
    another name). `unit` is that of the value, or of the example where it has none. `inherited` is the value
    of the file that the study extends. `boxes` are the names that a list may have, ticked where it has them.
    `sent` is what the page sends with the value, `id` is that of its element.
    """

    id: str
    label: str
    sent: dict[str, str]
    value: str
    unit: str
    units: tuple[str, ...]
    example: str
    inherited: str = ""
    choices: tuple[str, ...] = ()
    is_open: bool = True
    is_required: bool = False
    meaning: str = ""
    faults: tuple[str, ...] = ()
    boxes: tuple[tuple[str, bool], ...] = ()


def field_of(key: str, value: Any, *, example: Any, inherited: Any = None, **more: Any) -> Field:
    """Return the field of a key with a value of a study; None is a value that is not given."""
    number, unit = quantity_of(value)
    usual = quantity_of(inherited)[1] or quantity_of(example)[1]
    units = units_like(usual)
    is_split = number is not None and unit in ("", *units)  # a unit of another kind stays beside its number
    text = "" if value is None else number if is_split and number is not None else as_typed(value)
    return Field(
        label=key.replace("_", " "),
        value=text,
        unit=usual if not text else unit if is_split else "",
        units=units,
        example=as_typed(example),
        inherited="" if inherited is None else as_typed(inherited),
        **more,
    )


def as_typed(value: Any) -> str:
    """Return a value as it is typed into a field: text as it is, lists and tables as TOML has them."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update(value)
        return table.as_string()
    return str(tomlkit.item(value).as_string())
