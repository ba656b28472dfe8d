"""From the sections of a document to the records of a study; everything wrong is collected."""

from __future__ import annotations

import types
import typing
import warnings
from collections.abc import Callable
from dataclasses import MISSING, fields, replace
from enum import Enum
from typing import Any, ParamSpec, TypeVar

from separatrix.distribution import Distribution
from separatrix.errors import InputError, ValidityWarning, together
from separatrix.study import (
    SECTIONS as RECORDS,
)
from separatrix.study import (
    Guidance,
    KinematicModel,
    Material,
    Study,
    key_of,
)
from separatrix.study_file import values
from separatrix.study_file.document import MOST_PROBLEMS, SECTIONS, Document, library_of, used_records
from separatrix.study_numbers import MOST_DISTRIBUTIONS, contact_angle_of, settled_in
from separatrix.toml_values import Reader, choice, list_of, nearest, quantity, ratio, text, whole
from separatrix.units import printable, shown, unit_of

Record = TypeVar("Record")
Inputs = ParamSpec("Inputs")

_REQUIRED_SECTIONS = ("bearing", "operation", "film")
_ELASTIC = ("elastic_modulus", "poisson_ratio")
_NO_KEYS = frozenset({"material_name"})
"""Fields of records that have no key: they follow from others."""

_CERTAIN = frozenset({"reference_kick", "runs", "seed"})
_LISTS = {
    "kicks": values.kicks,
    "pocket_angles": values.pocket_angles,
    "restitution_factors": values.restitution_factors,
}
_MATERIALS = {
    ("bearing", "ball_material"): values.material("bearing material"),
    ("bearing", "ring_material"): values.material("bearing material"),
    ("film", "material"): values.material("film"),
    ("cage", "material"): values.cage_material,
}


class Unfinished(Exception):  # noqa: N818 - not an error: it never leaves this package
    """A section cannot be built because one of its values was refused already."""


def required_fields(record: type) -> list[str]:
    """Fields of a record that have no default."""
    return [f.name for f in fields(record) if f.default is f.default_factory is MISSING]


def _number(unit: str) -> Reader:
    """Reader of a number in this unit, certain or not."""
    return values.number(ratio if unit == "-" else quantity(unit), unit)


def _reader(section: str, record: type, name: str) -> Reader:
    """Reader of a field of a record, by its type."""
    hint = typing.get_type_hints(record, include_extras=True)[name]
    if isinstance(hint, types.UnionType):
        hint = next(part for part in typing.get_args(hint) if part is not types.NoneType)
    if name in _LISTS:
        return values.certain(_LISTS[name])
    if hint is Material:
        return _MATERIALS[section, name]
    if hint is int:
        return values.certain(whole) if name in _CERTAIN else values.count
    if hint is str:
        return text
    if isinstance(hint, type) and issubclass(hint, Enum):
        return choice(hint)
    unit = unit_of(record, name)
    return values.certain(quantity(unit)) if name in _CERTAIN else _number(unit)


READERS: dict[str, dict[str, Reader]] = {
    **{
        section: {f.name: _reader(section, record, f.name) for f in fields(record) if f.name not in _NO_KEYS}
        for section, record in RECORDS.items()
    },
    "kinematics": {"model": choice(KinematicModel)},
    "ranking": {
        "friction": text,
        "materials": list_of(text),
        "environment": text,
        "candidates": lambda value, _: value,  # read one by one by `ranking_section`
        "friction_scatter": values.certain(ratio),
    },
}
"""How each key of each section is read: the contract of a study file."""

READERS["bearing"]["radial_clearance"] = _number("m")
READERS["film"] |= {"elastic_modulus": _number("Pa"), "poisson_ratio": _number("-")}


def build_study(document: Document, name: str) -> Study:
    """Build the study of a document.

    Raises
    ------
    InputError
        With everything that is wrong, a line each.
    """
    from separatrix.study_file.ranking_section import FROM_BEARING, name_cage, name_environment

    title = attempt(document, _title, document, name)
    library = attempt(document, library_of, document)
    if library is None:
        raise document.refusal()
    with values.using(library, _temperature(document)):
        parts: dict[str, Any] = {}
        for section in SECTIONS:
            if section in document.sections:
                given = _converted(document, section)
                parts[section] = attempt(document, _record, document, section, given)
        attempt(document, name_cage, document, parts)
        fits = name_environment(parts)
    if missing := [f"[{section}]" for section in _REQUIRED_SECTIONS if section not in document.sections]:
        rule = f"lacks the section{'s'[: len(missing) > 1]} {', '.join(missing)}"
        document.problems.append(InputError("", rule))
    if len(document.problems) > MOST_PROBLEMS:
        rule = f"was not read to its end: it has more than {MOST_PROBLEMS} mistakes"
        document.problems.append(InputError("", rule))
    study = None
    if not document.problems:
        origins = _origins(document) | ({"ranking.environment": FROM_BEARING} if fits else {})
        made = {"name": name, "title": title or name, "origins": origins, **parts}
        study = attempt(document, record_of, document, Study, made)
    if study is not None:
        study = replace(study, records=used_records(library, document))
        study = _with_distributions(document, study)
    if study is None or document.problems:
        raise document.refusal()
    return study


def attempt(
    document: Document, make: Callable[Inputs, Record], *args: Inputs.args, **kwargs: Inputs.kwargs
) -> Record | None:
    """What `make` returns, or None with its refusals noted in the document."""
    try:
        return make(*args, **kwargs)
    except InputError as error:
        document.problems.extend(error.problems or (error,))
    except Unfinished:
        pass
    return None


def record_of(document: Document, record: Callable[..., Record], given: dict[str, Any]) -> Record:
    """Build a record; its refusals name the keys of the file, and the values as the file has them.

    Raises
    ------
    InputError
        The record refuses its values.
    """
    try:
        return record(**given)
    except InputError as error:
        raise together([_as_written(document, one) for one in error.problems or (error,)]) from None


def _as_written(document: Document, problem: InputError) -> InputError:
    path, got = key_of(problem.path), problem.got
    section, _, key = path.removeprefix("[").partition("] ")
    entry = document.sections.get(section, {}).get(key)
    uncertain = document.distributions.get(f"{section}.{key}")
    if got and uncertain is not None:
        got = f"{uncertain.text}, whose mean is {got}"
    elif got and entry is not None and isinstance(entry.value, str | int | float):
        got = shown(entry.value)
    return InputError(path, problem.rule, got, problem.cure)


def refuse_both(document: Document, section: str, one: str, other: str) -> None:
    """Refuse two keys that exclude each other."""
    written = document.sections.get(section, {})
    if one in written and other in written:
        raise InputError(f"[{section}] {one}", f"and {other} exclude each other", cure="Give one of the two.")


def _with_distributions(document: Document, study: Study) -> Study | None:
    """The study with the distributions of its uncertain numbers, each fitting its place."""
    found = document.distributions
    if len(found) > MOST_DISTRIBUTIONS:
        rule = f"has more than {MOST_DISTRIBUTIONS} uncertain numbers"
        cure = "Make those certain that matter least."
        document.problems.append(InputError("", rule, str(len(found)), cure))
        return None
    tried = {key: attempt(document, _settled, document, study, key) for key in found}
    settled = {key: one for key, one in tried.items() if one is not None}
    return replace(study, distributions=settled) if settled else study


def _settled(document: Document, study: Study, name: str) -> Distribution:
    try:
        return settled_in(study, name, document.distributions[name])
    except InputError as error:
        section, _, key = name.partition(".")
        if section == "ranking":
            raise error.at(f"[ranking] candidates, {printable(key, 120)},") from None
        is_key = key.partition(".")[0] in document.sections[section]
        raise error.at(f"[{section}] {key}" if is_key else f"[{section}] material.{key}") from None


def _temperature(document: Document) -> float | None:
    """Temperature of the study, by which data of the library are chosen; None if absent or refused."""
    entry = document.sections.get("operation", {}).get("temperature")
    try:
        value = None if entry is None else READERS["operation"]["temperature"](entry.value, "")
    except (InputError, TypeError):  # it is refused in its own place
        return None
    return None if value is None else float(values.unwrapped(value)[0])


def _title(document: Document, name: str) -> str:
    entry = document.top.get("title")
    return name if entry is None else text(entry.value, "title")


def _converted(document: Document, section: str) -> dict[str, Any]:
    """Values of a section's known keys; what is wrong goes to the document's problems."""
    converted: dict[str, Any] = {}
    for key, entry in document.sections[section].items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        value, found = values.unwrapped(attempt(document, _read, section, key, entry.value))
        prefix = section if (section, key) == ("film", "material") else f"{section}.{key}"
        document.distributions |= {f"{prefix}.{part}".strip("."): one for part, one in found.items()}
        if value is not None:
            converted[key] = value
    return converted


def _read(section: str, key: str, value: Any) -> Any:
    if isinstance(value, InputError):
        raise value
    at = f"[{section}] {printable(key) or chr(34) * 2}"
    if key in READERS[section]:
        return READERS[section][key](value, at)
    homes = [f"[{other}]" for other in SECTIONS if key in READERS[other]]
    cure = f"It belongs in {' or '.join(homes)}." if homes else nearest(key, READERS[section])
    raise InputError(at, "is not a valid key in this section", cure=cure)


def _record(document: Document, section: str, given: dict[str, Any]) -> Any:
    """Build the record of a section from its converted keys.

    Raises
    ------
    InputError
        A key is missing, is given without another one that it needs, or the record refuses its values.
    Unfinished
        A value that was written has been refused.
    """
    from separatrix.study_file.ranking_section import ranking

    written = document.sections[section]
    if section == "ranking":
        return ranking(document, given)
    if section == "kinematics":
        return given.get("model", KinematicModel.FREE)
    refused = [key for key in written if key in READERS[section] and key not in given]
    if section == "bearing":
        given = _bearing(document, given)
    elif section == "operation":
        refuse_both(document, "operation", "tilt", "moment")
        _refuse_alone(document, "operation", "ramp_start", "ramp_time", "the speeds are steady")
    elif section == "film":
        given = _film(document, given, refused)
    elif section == "cage":
        given = _cage(document, given, refused)
    record = RECORDS[section]
    required = required_fields(record)
    missing = [key for key in required if key not in written and key not in given]
    if missing:
        named = ("contact_angle (or radial_clearance)" if key == "contact_angle" else key for key in missing)
        raise InputError(f"[{section}]", f"lacks: {', '.join(named)}")
    if any(key not in given for key in required):
        raise Unfinished
    return record_of(document, record, given)


def _bearing(document: Document, given: dict[str, Any]) -> dict[str, Any]:
    """Give the contact angle without load that the radial clearance makes."""
    refuse_both(document, "bearing", "radial_clearance", "contact_angle")
    clearance = given.pop("radial_clearance", None)
    if clearance is None:
        if "radial_clearance" in document.sections["bearing"]:
            raise Unfinished
        return given
    angle = 0.0  # where something is missing or wrong, for which the record is refused
    diameter, inner, outer = (
        given.get(key) for key in ("ball_diameter", "inner_conformity", "outer_conformity")
    )
    if (
        diameter is not None
        and inner is not None
        and outer is not None
        and (inner + outer - 1.0) * diameter > 0.0
    ):
        try:
            angle = contact_angle_of(clearance, diameter, inner, outer)
        except InputError as error:
            raise together([_as_written(document, error)]) from None
    return {**given, "contact_angle": angle}


def _film(document: Document, given: dict[str, Any], refused: list[str]) -> dict[str, Any]:
    """Make the film's material of its modulus and Poisson's ratio where they are given in place of a name."""
    written = document.sections["film"]
    for key in _ELASTIC:
        refuse_both(document, "film", key, "material")
    in_place = [key for key in _ELASTIC if key in written]
    if len(in_place) == 1:
        missing = _ELASTIC[1 - _ELASTIC.index(in_place[0])]
        raise InputError("[film]", f"lacks: {missing}")
    if refused:
        raise Unfinished
    if in_place:
        properties = {key: given.pop(key) for key in _ELASTIC}
        try:
            given["material"] = Material(name="film given in the study", **properties)
        except InputError as error:
            found = [p.at(f"[film] {p.path.partition('.')[2]}") for p in error.problems or (error,)]
            raise together(found) from None
    return given


def _cage(document: Document, given: dict[str, Any], refused: list[str]) -> dict[str, Any]:
    """Check the keys of the land against the guidance, and leave a candidate's name to `name_cage`."""
    written = document.sections["cage"]
    land = [key for key in written if key in READERS["cage"] and key.startswith("land_")]
    if refused:
        raise Unfinished
    if land and "guidance" not in written:
        cure = 'Give guidance = "outer" or "inner", or leave it out.'
        raise InputError(
            f"[cage] {land[0]}", "needs guidance: without it the balls guide the cage", cure=cure
        )
    if land and given["guidance"] is Guidance.BALL:
        place = document.places.of(f"[cage] {land[0]}")
        sentence = f'{place}: [cage] {", ".join(land)}: not used, because guidance is "ball".'
        warnings.warn(sentence, ValidityWarning, stacklevel=2)
        given = {key: value for key, value in given.items() if key not in land}
    refuse_both(document, "cage", "pocket_angles", "pocket_spacing_scatter")
    _refuse_alone(document, "cage", "land_lobes", "land_out_of_round", "the land is round")
    return {**given, "material": None} if isinstance(given.get("material"), str) else given


def _refuse_alone(document: Document, section: str, key: str, other: str, otherwise: str) -> None:
    """Refuse a key that has no effect without another one."""
    written = document.sections[section]
    if key in written and other not in written:
        cure = "Give it, or leave both out."
        raise InputError(f"[{section}] {key}", f"needs {other}: without it {otherwise}", cure=cure)


def _origins(document: Document) -> dict[str, str]:
    """Place and text of every given key."""
    origins = {}
    for section, entries in document.sections.items():
        for key, entry in entries.items():
            plain = not isinstance(entry.value, dict | list) or f"{section}.{key}" in document.distributions
            shown_text = f": {values.written(entry.value)}" if plain else ""
            origins[f"{section}.{key}"] = document.places.of(f"[{section}] {key}") + shown_text
    if "bearing.radial_clearance" in origins:
        origins["bearing.contact_angle"] = f"from radial_clearance, {origins['bearing.radial_clearance']}"
    return origins
