"""The form of a study: a field for every key, with units, choices and faults."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass

import tomlkit

from separatrix.front.page.drafts import Checked
from separatrix.study.study import ORDER
from separatrix.study.template import StudyKey, remark_of, study_keys


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A value as it is typed, what it may be, its meaning, and what is wrong with it.

    `choices` are what it must be one of (`is_open` lets it be another name); `inherited` is the value of the
    file that the study extends.
    """

    id: str
    name: str
    label: str
    value: str
    example: str
    inherited: str
    choices: tuple[str, ...]
    is_open: bool
    is_required: bool
    meaning: str
    faults: tuple[str, ...]


def as_typed(value: object) -> str:
    """Return a value as it is typed into a field: text as it is, lists and tables as TOML has them."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update(value)
        return table.as_string()
    return str(tomlkit.item(value).as_string())


@dataclass(frozen=True, slots=True, kw_only=True)
class FormSection:
    """A section of the form, with its remark and the faults of the whole section."""

    name: str
    remark: str
    fields: tuple[Field, ...]
    faults: tuple[str, ...]
    is_empty: bool
    """Whether the study gives none of its keys."""


def form(checked: Checked) -> tuple[FormSection, ...]:
    """Return the sections of the form of a text; without valid TOML its fields are empty."""
    try:
        data = tomllib.loads(checked.text)
    except (ValueError, RecursionError):
        data = {}
    return tuple(_section(name, data, checked) for name in ("", *ORDER))


def _section(name: str, data: Mapping[str, object], checked: Checked) -> FormSection:
    given = data.get(name, {}) if name else {k: v for k, v in data.items() if not isinstance(v, dict)}
    given = given if isinstance(given, dict) else {}
    base = checked.inherited.get(name, {})
    keys = study_keys(name)
    known = {one.name for one in keys}
    return FormSection(
        name=name,
        remark=remark_of(name),
        fields=tuple(
            _field(one, given.get(one.name), None if one.name in given else base.get(one.name), checked)
            for one in keys
        ),
        faults=tuple(one.message for one in checked.faults if one.section == name and one.key not in known),
        is_empty=not given,
    )


def _field(key: StudyKey, value: object, inherited: object, checked: Checked) -> Field:
    """Return the field of a key with a value of a study; None is a value that is not given."""
    return Field(
        id=f"f-{key.section}-{key.name}",
        name=f"{key.section}.{key.name}",
        label=key.name.replace("_", " "),
        value="" if value is None else as_typed(value),
        example=as_typed(key.example),
        inherited="" if inherited is None else as_typed(inherited),
        choices=key.choices,
        is_open=not key.is_word,
        is_required=key.is_required and inherited is None,
        meaning=key.meaning,
        faults=tuple(checked.faults_of(key.section, key.name)),
    )
