"""The form of a study: a field for every key of the schema, with its value, its choices and its faults."""

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
    """A key with its value as it is typed, that of the file that the study extends, and what is wrong."""

    key: StudyKey
    value: str
    inherited: str
    faults: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FormSection:
    """A section with its remark and the faults of the whole of it; open if the study has one of its keys."""

    name: str
    remark: str
    fields: tuple[Field, ...]
    faults: tuple[str, ...]
    is_open: bool


def as_typed(value: object) -> str:
    """Return a value as it is typed into a field: text as it is, lists and tables as TOML has them."""
    if value is None or isinstance(value, str):
        return value or ""
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update(value)
        return table.as_string()
    return str(tomlkit.item(value).as_string())


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
    base, keys = checked.inherited.get(name, {}), study_keys(name)
    fields = tuple(
        Field(
            key=key,
            value=as_typed(given.get(key.name)),
            inherited="" if key.name in given else as_typed(base.get(key.name)),
            faults=checked.faults_of(name, key.name),
        )
        for key in keys
    )
    known = {key.name for key in keys}
    whole = tuple(one.message for one in checked.faults if one.section == name and one.key not in known)
    is_open = bool(given) or bool(whole)
    return FormSection(name=name, remark=remark_of(name), fields=fields, faults=whole, is_open=is_open)
