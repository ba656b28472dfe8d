"""From the sections of a document to the records of a study; everything wrong is collected."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from separatrix.distribution import Distribution
from separatrix.errors import InputError, ValidityWarning, together
from separatrix.study import (
    BallBearing,
    CageDesign,
    Film,
    Guidance,
    KinematicModel,
    Material,
    Operation,
    PocketContact,
    PocketShape,
    StabilitySettings,
    Study,
)
from separatrix.study_file import values
from separatrix.study_file.distributions import certain, count, number, unwrapped, written
from separatrix.study_file.document import MOST_PROBLEMS, SECTIONS, Document, Entry
from separatrix.study_file.libraries import library_of, used_records
from separatrix.study_file.one_cage import FROM_BEARING, name_cage, name_environment
from separatrix.study_file.ranking_section import ranking
from separatrix.study_file.records import Unfinished, attempt, record_of, refuse_both, relocated, where
from separatrix.study_file.values import Reader
from separatrix.study_numbers import MOST_DISTRIBUTIONS, contact_angle_of, settled_in
from separatrix.toml_values import nearest
from separatrix.units import printable, shown, unit_of

_REQUIRED_SECTIONS = ("bearing", "operation", "film")


def _readers(record: type, **special: Reader) -> dict[str, Reader]:
    """Reader of each field of a record: from its unit, or the special one."""
    units = {f.name: unit_of(record, f.name) for f in fields(record) if f.name not in special}
    return {name: _number(u) for name, u in units.items() if u} | special


def _number(unit: str) -> Reader:
    """Reader of a number in this unit, certain or not."""
    return number(values.ratio if unit == "-" else values.quantity(unit), unit)


_READERS: dict[str, dict[str, Reader]] = {
    "bearing": _readers(
        BallBearing,
        ball_count=count,
        ball_material=values.material("bearing material"),
        ring_material=values.material("bearing material"),
        radial_clearance=_number("m"),
    ),
    "operation": _readers(Operation, fluid=values.text),
    "kinematics": {"model": values.choice(KinematicModel)},
    "film": _readers(
        Film,
        material=values.material("film"),
        elastic_modulus=_number("Pa"),
        poisson_ratio=_number("-"),
    ),
    "cage": _readers(
        CageDesign,
        material=values.cage_material,
        guidance=values.choice(Guidance),
        pocket_shape=values.choice(PocketShape),
        pocket_contact=values.choice(PocketContact),
        pocket_angles=certain(values.pocket_angles),
        land_count=count,
        land_lobes=count,
    ),
    "stability": _readers(
        StabilitySettings,
        kicks=certain(values.kicks),
        reference_kick=certain(values.quantity("m/s")),
        runs=certain(values.whole),
        restitution_factors=certain(values.restitution_factors),
        seed=certain(values.whole),
    ),
    "ranking": {
        "friction": values.text,
        "materials": values.list_of(values.text),
        "environment": values.text,
        "candidates": values.as_is,  # read one by one below, each with its own place
        "friction_scatter": certain(values.ratio),
    },
}
"""How each key of each section is read: the contract of a study file."""


def build_study(document: Document, name: str) -> Study:
    """Build the study of a document.

    Raises
    ------
    InputError
        With everything that is wrong, a line each.
    """
    title = attempt(document, _title, document, name)
    library = attempt(document, library_of, document)
    if library is None:
        raise together(document.problems)
    with values.using(library, _temperature(document)):
        parts = _parts(document)
        attempt(document, name_cage, document, parts)
        fits = name_environment(parts)
    if missing := [f"[{section}]" for section in _REQUIRED_SECTIONS if section not in document.sections]:
        rule = f"lacks the section{'s'[: len(missing) > 1]} {', '.join(missing)}"
        document.problems.append(InputError(document.label, rule))
    if document.problems:
        raise _refusal(document)
    try:
        origins = _origins(document) | ({"ranking.environment": FROM_BEARING} if fits else {})
        study = Study(name=name, title=title or name, origins=origins, **parts)
    except InputError as error:
        raise relocated(document, error) from None
    return _with_distributions(document, replace(study, records=used_records(library, document)))


def _refusal(document: Document) -> InputError:
    """Everything that is wrong; one line more where there were too many mistakes to read on."""
    if len(document.problems) > MOST_PROBLEMS:
        rule = f"was not read to its end: it has more than {MOST_PROBLEMS} mistakes"
        document.problems.append(InputError(document.label, rule))
    return together(document.problems)


def _with_distributions(document: Document, study: Study) -> Study:
    """The study with what is known of its uncertain numbers, each fitting its place."""
    found = document.distributions
    if len(found) > MOST_DISTRIBUTIONS:
        cure = "Make those certain that matter least."
        rule = f"has more than {MOST_DISTRIBUTIONS} uncertain numbers"
        raise InputError(document.label, rule, str(len(found)), cure)
    tried = {key: attempt(document, _settled, document, study, key) for key in found}
    settled = {key: one for key, one in tried.items() if one is not None}
    if document.problems:
        raise together(document.problems)
    return replace(study, distributions=settled) if settled else study


def _settled(document: Document, study: Study, key: str) -> Distribution:
    try:
        return settled_in(study, key, document.distributions[key])
    except InputError as error:
        raise error.at(_place_of_number(document, key)) from None


def _place_of_number(document: Document, name: str) -> str:
    """Place of an uncertain number: that of its key, and its name inside it."""
    section, _, key = name.partition(".")
    if section == "ranking":
        return f"{where(document, section, 'candidates')}, {printable(key, 120)},"
    first, _, rest = key.partition(".")
    if first in document.sections[section]:
        return where(document, section, first) + (f".{rest}" if rest else "")
    return f"{where(document, section, 'material')}.{key}"


def _temperature(document: Document) -> float | None:
    """Temperature of the study, by which data of the library are chosen; None if absent or refused."""
    entry = document.sections.get("operation", {}).get("temperature")
    try:
        value = None if entry is None else _READERS["operation"]["temperature"](entry.value, "")
    except InputError:  # it is refused in its own place
        return None
    return None if value is None else float(unwrapped(value)[0])


def _parts(document: Document) -> dict[str, Any]:
    """Record of each section that is there; None for one that is absent or was refused."""
    parts: dict[str, Any] = {}
    for section in SECTIONS:
        if section in document.sections:
            given = _converted(document, section)
            parts[section] = attempt(document, _MAKERS[section], document, given)
    return parts


def _title(document: Document, name: str) -> str:
    entry = document.top.get("title")
    return name if entry is None else values.text(entry.value, f"{entry.place}: title")


def _converted(document: Document, section: str) -> dict[str, Any]:
    """Values of a section's known keys; what is wrong goes to the document's problems."""
    converted: dict[str, Any] = {}
    for key, entry in document.sections[section].items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        value, found = unwrapped(attempt(document, _read, document, section, key, entry))
        for name, one in found.items():
            document.distributions[_name_of(section, key, name)] = one
        if value is not None:
            converted[key] = value
    return converted


def _name_of(section: str, key: str, part: str) -> str:
    """Name of an uncertain number; that of the film's material has no middle."""
    return (
        f"{section}.{part}"
        if (section, key) == ("film", "material")
        else f"{section}.{key}.{part}".strip(".")
    )


def _read(document: Document, section: str, key: str, entry: Entry) -> Any:
    at = where(document, section, key)
    if key in _READERS[section]:
        return _READERS[section][key](entry.value, at)
    homes = [f"[{other}]" for other in SECTIONS if key in _READERS[other]]
    cure = f"It belongs in {' or '.join(homes)}." if homes else nearest(key, _READERS[section])
    raise InputError(at, "is no key of this section", cure=cure)


def _bearing(document: Document, given: dict[str, Any]) -> BallBearing:
    refuse_both(document, "bearing", "radial_clearance", "contact_angle")
    written = document.sections["bearing"]
    clearance = given.pop("radial_clearance", None)
    if clearance is not None:
        given = {**given, "contact_angle": _free_angle(document, clearance, given)}
    elif "radial_clearance" in written:
        raise Unfinished
    if "contact_angle" in written or "contact_angle" in given:
        return record_of(document, BallBearing, given)
    return record_of(
        document, BallBearing, {**given, "contact_angle": 0.0}, ("contact_angle (or radial_clearance)",)
    )


def _free_angle(document: Document, clearance: float, given: dict[str, Any]) -> float:
    """Contact angle without load from the diametral play: cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D)."""
    needed = ("ball_diameter", "inner_conformity", "outer_conformity")
    if any(key not in given for key in needed):
        return 0.0  # the record is refused for what is missing
    diameter, inner, outer = (given[key] for key in needed)
    if 2.0 * (inner + outer - 1.0) * diameter <= 0.0:
        return 0.0  # the record is refused for its conformities
    try:
        return contact_angle_of(clearance, diameter, inner, outer)
    except InputError as error:
        text = shown(document.sections["bearing"]["radial_clearance"].value)
        raise InputError(where(document, "bearing", "radial_clearance"), error.rule, text) from None


def _operation(document: Document, given: dict[str, Any]) -> Operation:
    refuse_both(document, "operation", "tilt", "moment")
    _refuse_alone(document, "operation", "ramp_start", "ramp_time", "the speeds are steady")
    return record_of(document, Operation, given)


def _kinematics(document: Document, given: dict[str, Any]) -> KinematicModel:
    del document
    return KinematicModel(given.get("model", KinematicModel.FREE))


def _film(document: Document, given: dict[str, Any]) -> Film:
    written = document.sections["film"]
    for key in _ELASTIC:
        refuse_both(document, "film", key, "material")
    in_place = [key for key in _ELASTIC if key in written]
    if len(in_place) == 1:
        missing = _ELASTIC[1 - _ELASTIC.index(in_place[0])]
        raise InputError(f"{document.label}: [film]", f"lacks: {missing}")
    if any(key not in given for key in written if key in _READERS["film"]):
        raise Unfinished
    if in_place:
        properties = {key: given.pop(key) for key in _ELASTIC}
        at = where(document, "film", "elastic_modulus").removesuffix(" elastic_modulus")
        given["material"] = values.build(Material, {"name": "film given in the study", **properties}, at)
    return record_of(document, Film, given)


def _cage(document: Document, given: dict[str, Any]) -> CageDesign:
    written = document.sections["cage"]
    land = [key for key in written if key in _READERS["cage"] and key.startswith("land_")]
    if any(key not in given for key in written if key in _READERS["cage"]):
        raise Unfinished
    if land and "guidance" not in written:
        cure = 'Give guidance = "outer" or "inner", or leave it out.'
        raise InputError(
            where(document, "cage", land[0]), "needs guidance: without it the balls guide the cage", cure=cure
        )
    if land and given["guidance"] is Guidance.BALL:
        _say_unused(document, land)
        given = {key: value for key, value in given.items() if key not in land}
    if isinstance(given.get("material"), str):
        given = {**given, "material": None}  # a candidate's, perhaps: `name_cage` looks
    refuse_both(document, "cage", "pocket_angles", "pocket_spacing_scatter")
    _refuse_alone(document, "cage", "land_lobes", "land_out_of_round", "the land is round")
    return record_of(document, CageDesign, given)


def _refuse_alone(document: Document, section: str, key: str, other: str, otherwise: str) -> None:
    """Refuse a key that says nothing without another one."""
    written = document.sections[section]
    if key in written and other not in written:
        cure = "Give it, or leave both out."
        raise InputError(where(document, section, key), f"needs {other}: without it {otherwise}", cure=cure)


def _say_unused(document: Document, land: list[str]) -> None:
    place = where(document, "cage", land[0]).removesuffix(f" {land[0]}")
    names = ", ".join(land)
    warnings.warn(f'{place} {names}: not used, for guidance is "ball".', ValidityWarning, stacklevel=2)


def _stability(document: Document, given: dict[str, Any]) -> StabilitySettings:
    return record_of(document, StabilitySettings, given)


_ELASTIC = ("elastic_modulus", "poisson_ratio")

_MAKERS: dict[str, Callable[[Document, dict[str, Any]], Any]] = {
    "bearing": _bearing,
    "operation": _operation,
    "kinematics": _kinematics,
    "film": _film,
    "cage": _cage,
    "stability": _stability,
    "ranking": ranking,
}


def _origins(document: Document) -> dict[str, str]:
    """Place and text of every given key."""
    origins = {}
    for section, entries in document.sections.items():
        for key, entry in entries.items():
            plain = not isinstance(entry.value, (dict, list)) or f"{section}.{key}" in document.distributions
            text = f": {written(entry.value)}" if plain else ""
            origins[f"{section}.{key}"] = entry.place + text
    if "bearing.radial_clearance" in origins:
        origins["bearing.contact_angle"] = f"from radial_clearance, {origins['bearing.radial_clearance']}"
    return origins
