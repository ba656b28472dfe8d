"""From the sections of a document to the records of a study; all faults are collected."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import product
from typing import TypeVar

from separatrix.ground.errors import InputError, ValidityWarning, together
from separatrix.ground.toml import Values, nearest, text
from separatrix.ground.units import printable, shown
from separatrix.study.distribution import Distribution
from separatrix.study.keys import ANGLE_FROM, MOST_DISTRIBUTIONS, contact_angle_of, settled_in
from separatrix.study.library import Library
from separatrix.study.reading.document import (
    ALTERNATIVES,
    MOST_PROBLEMS,
    SECTIONS,
    Document,
    Unfinished,
    library_of,
)
from separatrix.study.reading.uncertain import unwrapped, written
from separatrix.study.reading.values import READERS, required_fields, using
from separatrix.study.study import SECTIONS as RECORDS
from separatrix.study.study import Guidance, KinematicModel, Material, Study, key_of

Record = TypeVar("Record")

LEFT_OUT = "cage"
"""In `Study.records`: the refusal of a cage that the study is built without, for the verbs that need none."""

_ELASTIC = ("elastic_modulus", "poisson_ratio")
_USELESS_ALONE = {
    "operation": ("ramp_start", "ramp_time", "the speeds are steady"),
    "cage": ("land_lobes", "land_out_of_round", "the land is round"),
}
"""A key that has no effect without another one, and why."""


def build_study(document: Document, name: str) -> Study:
    """Build the study of a document; a refusal has everything that is wrong, a line each."""
    from separatrix.study.reading.ranking_section import FROM_BEARING, name_cage, name_environment

    title, library, fits = name, None, False
    parts: Values = {}
    with document.noting():
        title = text(document.top.get("title", name), "title")
    with document.noting():
        library = library_of(document)
    if library is None:
        raise document.refusal()
    with using(library, _temperature(document), document.film_folder):
        for section in SECTIONS:
            if section in document.sections:
                given = _converted(document, section)
                parts[section] = None
                with document.noting():
                    parts[section] = _record(document, section, given)
        with document.noting():
            name_cage(document, parts)
        fits = name_environment(parts)
    required = ("bearing", "operation", "film")
    if missing := [f"[{section}]" for section in required if section not in document.sections]:
        rule = f"lacks the section{'s'[: len(missing) > 1]} {', '.join(missing)}"
        document.problems.append(InputError("", rule))
    if len(document.problems) > MOST_PROBLEMS:
        rule = f"was not read to its end: it has more than {MOST_PROBLEMS} mistakes"
        document.problems.append(InputError("", rule))
    if not document.problems:
        origins = _origins(document) | ({"ranking.environment": FROM_BEARING} if fits else {})
        records = _used_records(library, document)
        with document.noting():
            made = {"name": name, "title": title, "origins": origins, "records": records, **parts}
            return _with_distributions(document, _study(document, made))
    raise document.refusal()


def _study(document: Document, made: Values) -> Study:
    """Build the study; without its cage where nothing gives the stiffness of its pockets."""
    try:
        return record_of(document, Study, made)
    except InputError as error:
        if error.path != "[cage] ball_cage_stiffness":
            raise
        refusal = error.at(document.locate(error.path))
    sentence = f"{refusal.path} {refusal.rule}: the section is left out, and verbs that need it are refused."
    warnings.warn(sentence, ValidityWarning, stacklevel=4)
    for key in [key for key in document.distributions if key.startswith("cage.")]:
        del document.distributions[key]
    left = {**made["records"], LEFT_OUT: refusal}
    return record_of(document, Study, {**made, "cage": None, "records": left})


def record_of(document: Document, record: Callable[..., Record], given: Mapping[str, object]) -> Record:
    """Build a record; its refusals name the keys of the file, and the values as the file has them."""
    try:
        return record(**given)
    except InputError as error:
        raise together([_as_written(document, one) for one in error.problems or (error,)]) from None


def _as_written(document: Document, problem: InputError) -> InputError:
    path, got = key_of(problem.path), problem.got
    section, _, key = path.removeprefix("[").partition("] ")
    value = document.sections.get(section, {}).get(key)
    uncertain = document.distributions.get(f"{section}.{key}")
    if got and uncertain is not None:
        got = f"{uncertain.text}, whose mean is {got}"
    elif got and isinstance(value, str | int | float):
        got = shown(value)
    return InputError(path, problem.rule, got, problem.cure)


def _with_distributions(document: Document, study: Study) -> Study:
    """The study with the distributions of its uncertain numbers, each fitting its place."""
    from separatrix.study.reading.ranking_section import place_of_candidate

    found = document.distributions
    if len(found) > MOST_DISTRIBUTIONS:
        rule = f"has more than {MOST_DISTRIBUTIONS} uncertain numbers"
        raise InputError("", rule, str(len(found)), "Make those certain that matter least.")
    settled: dict[str, Distribution] = {}
    for name, one in found.items():
        section, _, key = name.partition(".")
        if section == "ranking":
            at = place_of_candidate(document, key)
        else:
            is_key = key.partition(".")[0] in document.sections[section]
            at = f"[{section}] {key}" if is_key else f"[{section}] material.{key}"
        with document.noting():
            try:
                settled[name] = settled_in(study, name, one)
            except InputError as error:
                raise error.at(at) from None
    if document.problems:
        raise Unfinished
    return replace(study, distributions=settled)


def _temperature(document: Document) -> float | None:
    """Temperature of the study, by which data of the library are chosen; None if absent or refused."""
    value = document.sections.get("operation", {}).get("temperature")
    try:
        mean, _ = unwrapped(READERS["operation"]["temperature"](value, ""))
    except (InputError, TypeError):  # it is refused in its own place
        return None
    return mean if isinstance(mean, float) else None


def _used_records(library: Library, document: Document) -> dict[str, object]:
    """Whole records of the fluid and the friction table that a study names."""
    fluid = document.sections["operation"].get("fluid")
    known = library.fluid(fluid) if isinstance(fluid, str) else None
    records: dict[str, object] = {} if known is None else {"operation.fluid": known.plain()}
    table = document.sections.get("ranking", {}).get("friction")
    if table in library.names("friction table"):
        records["ranking.friction"] = library.friction_table(table).plain()
    return records


def _converted(document: Document, section: str) -> Values:
    """Values of a section's known keys; faults go to the document's problems."""
    converted: Values = {}
    readers = READERS[section]
    for key, value in document.sections[section].items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        with document.noting():
            if isinstance(value, InputError):
                raise value
            at = f"[{section}] {printable(key) or chr(34) * 2}"
            if key not in readers:
                homes = [f"[{other}]" for other in SECTIONS if key in READERS[other]]
                cure = f"It belongs in {' or '.join(homes)}." if homes else nearest(key, readers)
                raise InputError(at, "is not a valid key in this section", cure=cure)
            converted[key], found = unwrapped(readers[key](value, at))
            prefix = section if (section, key) == ("film", "material") else f"{section}.{key}"
            document.distributions |= {f"{prefix}.{part}".strip("."): one for part, one in found.items()}
    return converted


def _record(document: Document, section: str, given: Values) -> object:
    """Build the record of a section from its converted keys."""
    from separatrix.study.reading.ranking_section import ranking

    written = document.sections[section]
    if section == "kinematics":
        return given.get("model", KinematicModel.FREE)
    for one, other in product(*ALTERNATIVES.get(section, ((), ()))):
        if one in written and other in written:
            rule = f"and {other} exclude each other"
            raise InputError(f"[{section}] {one}", rule, cure="Give one of the two.")
    if section == "ranking":
        return ranking(document, given)
    given = _OWN_RULES.get(section, lambda _, given: given)(document, given)
    key, other, otherwise = _USELESS_ALONE.get(section, ("", "", ""))
    if key in written and other not in written:
        rule, cure = f"needs {other}: without it {otherwise}", "Give it, or leave both out."
        raise InputError(f"[{section}] {key}", rule, cure=cure)
    record = RECORDS[section]
    required = required_fields(record)
    if missing := [key for key in required if key not in written and key not in given]:
        named = ("contact_angle (or radial_clearance)" if key == "contact_angle" else key for key in missing)
        raise InputError(f"[{section}]", f"lacks: {', '.join(named)}")
    if any(key not in given for key in required):
        raise Unfinished
    return record_of(document, record, given)


def _bearing(document: Document, given: Values) -> Values:
    """Replace the radial clearance by the contact angle without load."""
    if "radial_clearance" not in document.sections["bearing"]:
        return given
    if "radial_clearance" not in given:
        raise Unfinished
    clearance, angle = given.pop("radial_clearance"), 0.0
    if all(key in given for key in ANGLE_FROM):
        diameter, inner, outer = (given[key] for key in ANGLE_FROM)
        if (inner + outer - 1.0) * diameter > 0.0:  # else the record is refused
            angle = record_of(document, lambda: contact_angle_of(clearance, diameter, inner, outer), {})
    return {**given, "contact_angle": angle}


def _film(document: Document, given: Values) -> Values:
    """Make the film's material of its modulus and Poisson's ratio where they are given in place of a name."""
    written = document.sections["film"]
    lacking = [key for key in _ELASTIC if key not in written]
    if len(lacking) == 1:
        raise InputError("[film]", f"lacks: {lacking[0]}")
    if _is_refused(document, "film", given):
        raise Unfinished
    if not lacking:
        properties = {key: given.pop(key) for key in _ELASTIC}
        try:
            given["material"] = Material(name="film given in the study", **properties)
        except InputError as error:
            found = [p.at(f"[film] {p.path.partition('.')[2]}") for p in error.problems or (error,)]
            raise together(found) from None
    return given


def _cage(document: Document, given: Values) -> Values:
    """Check the keys of the land against the guidance, and leave a candidate's name to `name_cage`."""
    written = document.sections["cage"]
    if _is_refused(document, "cage", given):
        raise Unfinished
    land = [key for key in written if key in READERS["cage"] and key.startswith("land_")]
    if land and "guidance" not in written:
        rule = "needs guidance: without it the balls guide the cage"
        cure = 'Give guidance = "outer" or "inner", or leave it out.'
        raise InputError(f"[cage] {land[0]}", rule, cure=cure)
    if land and given["guidance"] is Guidance.BALL:
        place = document.places.of(f"[cage] {land[0]}")
        sentence = f'{place}: [cage] {", ".join(land)}: not used, because guidance is "ball".'
        warnings.warn(sentence, ValidityWarning, stacklevel=2)
        given = {key: value for key, value in given.items() if key not in land}
    return {**given, "material": None} if isinstance(given.get("material"), str) else given


_OWN_RULES = {"bearing": _bearing, "film": _film, "cage": _cage}


def _is_refused(document: Document, section: str, given: Mapping[str, object]) -> bool:
    """Whether a value of the section was refused."""
    return any(key in READERS[section] and key not in given for key in document.sections[section])


def _origins(document: Document) -> dict[str, str]:
    """Place and text of every given key."""
    origins = {}
    for section, given in document.sections.items():
        for key, value in given.items():
            plain = not isinstance(value, dict | list) or f"{section}.{key}" in document.distributions
            text = f": {written(value)}" if plain else ""
            origins[f"{section}.{key}"] = document.places.of(f"[{section}] {key}") + text
            inside = value.items() if (section, key) == ("film", "wear") and isinstance(value, dict) else ()
            for part, one in inside:
                place = document.places.of(f"[film] wear.{part}")
                for name in ("across", "thicknesses") if part == "profile" else (part,):
                    origins[f"film.wear.{name}"] = f"{place}: {written(one)}"
    if "bearing.radial_clearance" in origins:
        origins["bearing.contact_angle"] = f"from radial_clearance, {origins['bearing.radial_clearance']}"
    return origins
