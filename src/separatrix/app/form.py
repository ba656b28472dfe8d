"""The form of a study: a field for every key of its records, with units, choices and the fault beside it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Any

from separatrix.app.candidate_form import CandidateList, candidate_list
from separatrix.app.candidates import KEY, SECTION
from separatrix.app.draft import Checked
from separatrix.app.fields import Field, field_of
from separatrix.study_file.document import SECTIONS
from separatrix.study_file.templates import TemplateKey, choices_of, section_remarks, template_keys
from separatrix.toml_files import folded

TESTED = (SECTION, "materials")
"""The key whose names are those of the tests that the study names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FormSection:
    """A section of the form, with what is said of it as a whole."""

    name: str
    remark: str
    fields: tuple[Field, ...]
    faults: tuple[str, ...]
    candidates: CandidateList | None = None
    """In [ranking], those of the user's own."""

    @property
    def is_empty(self) -> bool:
        """Whether the study gives none of its keys."""
        return not any(one.value for one in self.fields) and not (self.candidates and self.candidates.items)


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
    base = checked.inherited.get(name, {})
    keys = [one for one in template_keys() if one.section == name]
    known = {one.key for one in keys} | ({KEY} if name == SECTION else set())
    return FormSection(
        name=name,
        remark=section_remarks().get(name, ""),
        fields=tuple(
            _field(one, given.get(one.key), None if one.key in given else base.get(one.key), checked)
            for one in keys
        ),
        faults=tuple(one.message for one in checked.faults if one.section == name and one.key not in known),
        candidates=candidate_list(given, base, checked) if name == SECTION else None,
    )


def _field(key: TemplateKey, value: Any, inherited: Any, checked: Checked) -> Field:
    choices, is_open = choices_of(key.section, key.key)
    is_tested = (key.section, key.key) == TESTED
    return field_of(
        key.key,
        value,
        example=key.example,
        inherited=inherited,
        id=f"f-{key.section}-{key.key}",
        sent={"field": f"{key.section}.{key.key}"},
        choices=choices,
        is_open=is_open,
        is_required=key.is_required and inherited is None,
        meaning=key.meaning,
        faults=tuple(checked.faults_of(key.section, key.key)),
        boxes=_boxes(value, checked.offered.tested) if is_tested else (),
    )


def _boxes(value: Any, names: tuple[str, ...]) -> tuple[tuple[str, bool], ...]:
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
