"""The form of a study: a field for every key, with units, choices and faults."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass

import tomlkit

from separatrix.front.page.drafts import Checked
from separatrix.ground.toml import folded
from separatrix.ground.units import UNITS
from separatrix.study.study import ORDER
from separatrix.study.template import StudyKey, quantity_of, remark_of, study_keys

TESTED = ("ranking", "materials")
"""The key whose names are those of the tests that the study names."""


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
    inherited: str
    choices: tuple[str, ...]
    is_open: bool
    is_required: bool
    meaning: str
    faults: tuple[str, ...]
    boxes: tuple[tuple[str, bool], ...]


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
    kind, name = key.one.unit, key.name
    number, unit = quantity_of(value, kind)
    usual = quantity_of(inherited, kind)[1] or quantity_of(key.example, kind)[1]
    units = tuple(UNITS[kind]) if usual else ()
    text = "" if value is None else as_typed(value) if number is None else number
    return Field(
        id=f"f-{key.section}-{name}",
        label=name.replace("_", " "),
        sent={"field": f"{key.section}.{name}"},
        value=text,
        unit=usual if not text else unit if number is not None else "",
        units=units,
        example=as_typed(key.example),
        inherited="" if inherited is None else as_typed(inherited),
        choices=key.choices,
        is_open=not key.is_word,
        is_required=key.is_required and inherited is None,
        meaning=key.meaning,
        faults=tuple(checked.faults_of(key.section, name)),
        boxes=_boxes(value, checked.tested) if (key.section, name) == TESTED else (),
    )


def _boxes(value: object, names: tuple[str, ...]) -> tuple[tuple[str, bool], ...]:
    """Return names with whether a list has them, as it spells them; none for what is not a list of names."""
    given = [] if value is None else value
    if not names or not isinstance(given, list) or not all(isinstance(one, str) for one in given):
        return ()
    spelled = {folded(one): one for one in given}
    others = [one for one in given if folded(one) not in map(folded, names)]
    return (
        *((spelled.get(folded(one), one), folded(one) in spelled) for one in names),
        *((one, True) for one in others),
    )
