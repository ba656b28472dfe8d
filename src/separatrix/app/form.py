"""The form of a study: a field for every key and for its candidates, with units, choices and faults."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import tomlkit

from separatrix.app.candidates import KEY, SECTION, is_measured
from separatrix.app.draft import Checked, Fault
from separatrix.study_file.document import SECTIONS
from separatrix.study_file.templates import (
    TemplateKey,
    choices_of,
    quantity_of,
    section_remarks,
    template_keys,
    units_like,
)
from separatrix.toml_files import folded

TESTED = (SECTION, "materials")
"""The key whose names are those of the tests that the study names."""


PROPERTIES: dict[str, tuple[object, str]] = {
    "elastic_modulus": ("5 GPa", "for the stiffness of ball and pocket; needs poisson_ratio"),
    "poisson_ratio": (0.4, "from 0 to below 0.5; needs elastic_modulus"),
    "density": ("1400 kg/m3", "for the mass of the cage and its growth by rotation"),
    "thermal_expansion": ("50e-6 m/m/K", "mean from 293 K to the operating temperature"),
    "compressive_strength": ("100 MPa", "for the warning that a pocket is pressed too hard"),
    "source": ("our data sheet", "where the numbers come from"),
    "confidence": ("measured", "how sure they are"),
}
"""Of a material that is given in place: an example, and the meaning."""

FRICTION: dict[str, tuple[object, str]] = {
    "mean": (0.12, "a number, or like 0.12 +- 20 %"),
    "standard_deviation": (0.02, "of single tests"),
    "count": (8, "of tests"),
    "source": ("our test 7", ""),
}
"""Parts of a friction: its mean, or another form of it, and what is beside the mean."""


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


def field_of(key: str, value: object, *, example: object, inherited: object = None, **more: Any) -> Field:
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
class Measured:
    """An environment with the fields of a candidate's friction in it."""

    environment: str
    fields: tuple[Field, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateForm:
    """One candidate, `number` from 0; `fields` are its name, and its material unless that is in place."""

    number: int
    name: str
    fields: tuple[Field, ...]
    frictions: tuple[Measured, ...]
    properties: tuple[Field, ...]
    property_faults: tuple[str, ...]
    faults: tuple[str, ...]

    @property
    def has_properties(self) -> bool:
        """Whether its material is given in place."""
        return any(one.value for one in self.properties)


@dataclass(frozen=True, slots=True, kw_only=True)
class CandidateList:
    """The candidates of a study, with what is wrong with them as a whole."""

    items: tuple[CandidateForm, ...]
    inherited: tuple[str, ...]
    """Names of those of the file that the study extends, as long as it has none of its own."""

    environments: tuple[str, ...]
    """To choose from for one that is not in the study yet."""

    faults: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FormSection:
    """A section of the form, with its remark and the faults of the whole section."""

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


def _section(name: str, data: Mapping[str, object], checked: Checked) -> FormSection:
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
        candidates=_candidate_list(given, base, checked) if name == SECTION else None,
    )


def _field(key: TemplateKey, value: object, inherited: object, checked: Checked) -> Field:
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


def _candidate_list(
    given: Mapping[str, object], base: Mapping[str, object], checked: Checked
) -> CandidateList:
    """Return the candidates in the form, from the keys of [ranking] and those that it inherits."""
    items = given.get(KEY, [])
    items = items if isinstance(items, list) else []
    faults = _Faults(one for one in checked.faults if (one.section, one.key) == (SECTION, KEY))
    known = _environments(items, given.get("environment", base.get("environment")))
    found = tuple(_candidate(number, item, known, checked, faults) for number, item in enumerate(items))
    inherited = base.get(KEY, []) if KEY not in given else []
    return CandidateList(
        items=found,
        inherited=tuple(_name(item) for item in inherited) if isinstance(inherited, list) else (),
        environments=tuple(one for one in checked.offered.environments if one not in known),
        faults=faults.rest(),
    )


def _environments(items: Iterable[object], own: object) -> dict[str, None]:
    frictions = [item.get("friction") for item in items if isinstance(item, dict)]
    found = [env for one in frictions if isinstance(one, dict) for env in one]
    return dict.fromkeys([*found, own] if isinstance(own, str) else found)


def _candidate(
    number: int, item: object, environments: Iterable[str], checked: Checked, faults: _Faults
) -> CandidateForm:
    given = item if isinstance(item, dict) else {}
    frictions, material, at = given.get("friction"), given.get("material"), f"[{number + 1}]"
    in_place = material if isinstance(material, dict) else {}

    def made(part: tuple[str, ...], value: object, **more: Any) -> Field:
        return field_of(
            part[-1],
            value,
            id="-".join((f"f-{KEY}-{number}", *part)),
            sent=_sent(number, part),
            faults=faults.taken(".".join((at, *part))),
            **more,
        )

    fields = [made(("name",), given.get("name"), example="My compound", is_required=True)]
    properties = tuple(
        made(("material", key), in_place.get(key), example=example, meaning=meaning)
        for key, (example, meaning) in PROPERTIES.items()
        if material is None or isinstance(material, dict)
    )
    property_faults = faults.taken(f"{at}.material") if in_place else ()
    if not in_place:
        name, names = material or None, checked.offered.cage_materials
        meaning = "a name of the library; for the stiffness of ball and pocket"
        fields.append(made(("material",), name, example="Armalon", meaning=meaning, choices=names))
    measured = frictions if isinstance(frictions, dict) else {}
    return CandidateForm(
        number=number,
        name=_name(item),
        fields=tuple(fields),
        frictions=tuple(
            _friction(number, place, env, measured.get(env), faults) for place, env in enumerate(environments)
        ),
        properties=properties,
        property_faults=property_faults,
        faults=faults.taken(at),
    )


def _friction(number: int, place: int, environment: str, value: object, faults: _Faults) -> Measured:
    """Return the fields of a friction; that of its mean has the faults that no other has."""
    at = f'[{number + 1}].friction."{environment[:60]}"'
    parts = value if is_measured(value) else {"mean": value}
    fields = [
        field_of(
            "friction" if key == "mean" else key,
            parts.get(key),
            example=example,
            meaning=meaning,
            id=f"f-{KEY}-{number}-friction-{place}-{key}",
            sent=_sent(number, ("friction", key)) | {"environment": environment},
            faults=faults.taken(at if key == "mean" else f"{at}.{key}"),
        )
        for key, (example, meaning) in reversed(FRICTION.items())
    ]
    return Measured(environment=environment, fields=tuple(reversed(fields)))


def _sent(number: int, part: tuple[str, ...]) -> dict[str, str]:
    return {"field": f"{SECTION}.{KEY}", "candidate": str(number), "part": ".".join(part)}


def _name(item: object) -> str:
    return as_typed(item.get("name", "") if isinstance(item, dict) else item)


class _Faults:
    """Faults of candidates, each of which is shown in one place."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self._left = list(faults)

    def taken(self, place: str) -> tuple[str, ...]:
        """Return the messages about a place, and what is inside it, that nothing has taken yet."""
        found = [
            one
            for one in self._left
            if one.inside.startswith(place) and one.inside[len(place) : len(place) + 1] in ("", *".,[ ")
        ]
        self._left = [one for one in self._left if one not in found]
        return tuple(one.message for one in found)

    def rest(self) -> tuple[str, ...]:
        """Return the messages that nothing has taken."""
        return tuple(one.message for one in self._left)
