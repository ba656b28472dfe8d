"""The form of a study: a field for every key of its records, with units, choices and the fault beside it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Any

import tomlkit

from separatrix.app.draft import Checked
from separatrix.study_file.document import SECTIONS
from separatrix.study_file.templates import (
    TemplateKey,
    choices_of,
    quantity_of,
    section_remarks,
    template_keys,
    units_like,
)

LEFT_TO_TEXT = ("candidates",)
"""Keys that are edited as text only: whole tables."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One key: what it holds as text and unit, what it may hold, its meaning, and what is wrong with it.

    `units` are the spellings that its unit may have; `choices` what it must be one of (`is_open` lets it be
    another name). `unit` is that of the value, or of the example where it has none. `inherited` is the value
    of the file that the study extends.
    """

    section: str
    key: str
    value: str
    unit: str
    units: tuple[str, ...]
    choices: tuple[str, ...]
    is_open: bool
    is_required: bool
    example: str
    inherited: str
    meaning: str
    faults: tuple[str, ...]

    @property
    def name(self) -> str:
        """Name of the field in the page."""
        return f"{self.section}.{self.key}"

    @property
    def label(self) -> str:
        """The key in words."""
        return self.key.replace("_", " ")


@dataclass(frozen=True, slots=True, kw_only=True)
class FormSection:
    """A section of the form, with what is said of it as a whole."""

    name: str
    remark: str
    fields: tuple[Field, ...]
    faults: tuple[str, ...]

    @property
    def is_empty(self) -> bool:
        """Whether the study gives none of its keys."""
        return not any(one.value for one in self.fields)


def form(checked: Checked) -> tuple[FormSection, ...]:
    """Return the sections of the form of a text; without valid TOML its fields are empty."""
    try:
        data = tomllib.loads(checked.text)
    except (ValueError, RecursionError):
        data = {}
    return tuple(_section(name, data, checked) for name in ("", *SECTIONS))


def _section(name: str, data: dict[str, Any], checked: Checked) -> FormSection:
    given = data.get(name, {}) if name else {k: v for k, v in data.items() if not isinstance(v, dict)}
    given = given if isinstance(given, dict) else {}
    keys = [one for one in template_keys() if one.section == name and one.key not in LEFT_TO_TEXT]
    base = checked.inherited.get(name, {})
    fields = tuple(
        _field(one, given.get(one.key), None if one.key in given else base.get(one.key), checked)
        for one in keys
    )
    known = {one.key for one in keys}
    others = [one.message for one in checked.faults if one.section == name and one.key not in known]
    remark = section_remarks().get(name, "")
    return FormSection(name=name, remark=remark, fields=fields, faults=tuple(others))


def _field(key: TemplateKey, value: Any, inherited: Any, checked: Checked) -> Field:
    choices, is_open = choices_of(key.section, key.key)
    number, unit = quantity_of(value)
    usual = quantity_of(inherited)[1] or quantity_of(key.example)[1]
    units = units_like(usual)
    is_split = number is not None and unit in ("", *units)  # a unit of another kind stays beside its number
    text = "" if value is None else number if is_split and number is not None else _text(value)
    return Field(
        section=key.section,
        key=key.key,
        value=text,
        unit=usual if not text else unit if is_split else "",
        units=units,
        choices=choices,
        is_open=is_open,
        is_required=key.is_required and inherited is None,
        example=_text(key.example),
        inherited="" if inherited is None else _text(inherited),
        meaning=key.meaning,
        faults=tuple(checked.faults_of(key.section, key.key)),
    )


def _text(value: Any) -> str:
    """Return a value as it is typed into a field: text as it is, lists and tables as TOML has them."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update(value)
        return table.as_string()
    return str(tomlkit.item(value).as_string())
