"""From the sections of a document to the records of a study; everything wrong is collected."""

from __future__ import annotations

import math
from dataclasses import MISSING, fields
from typing import Any

from separatrix import library
from separatrix.errors import InputError, together
from separatrix.study import (
    BallBearing,
    CageDesign,
    Candidate,
    Film,
    Guidance,
    KinematicModel,
    Operation,
    RankingQuestion,
    StabilitySettings,
    Study,
)
from separatrix.study_file import values
from separatrix.study_file.document import SECTIONS, Document, Entry, unknown
from separatrix.study_file.values import Reader
from separatrix.units import format_quantity, printable, shown, unit_of

_REQUIRED_SECTIONS = ("bearing", "operation", "film")
_MOST_PROBLEMS = 20


def _readers(record: type, **special: Reader) -> dict[str, Reader]:
    """Reader of each field of a record: from its unit, or the special one."""
    units = {f.name: unit_of(record, f.name) for f in fields(record) if f.name not in special}
    return {
        name: values.ratio if u == "-" else values.quantity(u) for name, u in units.items() if u
    } | special


_READERS: dict[str, dict[str, Reader]] = {
    "bearing": _readers(
        BallBearing,
        ball_count=values.whole,
        ball_material=values.material("bearing material"),
        ring_material=values.material("bearing material"),
        radial_clearance=values.quantity("m"),
    ),
    "operation": _readers(Operation, fluid=values.text),
    "kinematics": {"model": values.choice(KinematicModel)},
    "film": _readers(
        Film,
        material=values.material("film"),
        elastic_modulus=values.quantity("Pa"),
        poisson_ratio=values.ratio,
    ),
    "cage": _readers(CageDesign, material=values.material("cage material"), guidance=values.choice(Guidance)),
    "stability": _readers(
        StabilitySettings,
        kicks=values.kicks,
        runs=values.whole,
        restitution_factors=values.restitution_factors,
        seed=values.whole,
    ),
    "ranking": {
        "friction": values.text,
        "materials": values.list_of(values.text),
        "candidates": values.as_is,  # read one by one below, each with its own place
    },
}
"""How each key of each section is read: the contract of a study file."""


def build_study(document: Document, name: str) -> Study:
    """Build the study of a document.

    Raises
    ------
    InputError
        With everything that is wrong, on one line.
    """
    problems = document.problems
    title = _title(document, name)
    given = {section: _converted(document, section) for section in SECTIONS}
    if missing := [f"[{section}]" for section in _REQUIRED_SECTIONS if section not in document.sections]:
        problems.append(
            InputError(document.label, f"lacks the section{'s'[: len(missing) > 1]} {', '.join(missing)}")
        )
    parts = {
        "bearing": _bearing(document, given["bearing"]),
        "operation": _operation(document, given["operation"]),
        "kinematics": given["kinematics"].get("model", KinematicModel.FREE),
        "film": _film(document, given["film"]),
        "cage": _cage(document, given["cage"]) if "cage" in document.sections else None,
        "stability": _record(document, "stability", StabilitySettings, given["stability"])
        or StabilitySettings(),
        "ranking": _ranking(document, given["ranking"]) if "ranking" in document.sections else None,
    }
    if problems:
        raise together(problems)
    try:
        return Study(name=name, title=title, origins=_origins(document), **parts)
    except InputError as error:
        raise together([_relocated(document, p) for p in error.problems or (error,)]) from None


def _title(document: Document, name: str) -> str:
    entry = document.top.get("title")
    if entry is None:
        return name
    try:
        return values.text(entry.value, f"{entry.place}: title")
    except InputError as error:
        document.problems.append(error)
        return name


def _converted(document: Document, section: str) -> dict[str, Any]:
    """Values of a section's known keys; what is wrong goes to the document's problems."""
    converted: dict[str, Any] = {}
    readers = _READERS[section]
    for key, entry in document.sections.get(section, {}).items():
        where = f"{entry.place}: [{section}] {printable(key)[:60]}"
        if len(document.problems) > _MOST_PROBLEMS:
            break
        try:
            if key not in readers:
                raise _unknown_key(where, section, key)
            converted[key] = readers[key](entry.value, where)
        except InputError as error:
            document.problems.extend(error.problems or (error,))
    return converted


def _unknown_key(where: str, section: str, key: str) -> InputError:
    homes = [f"[{other}]" for other in SECTIONS if key in _READERS[other]]
    if homes:
        return InputError(where, "is no key of this section", cure=f"It belongs in {' or '.join(homes)}.")
    return unknown(where, "key of this section", key, _READERS[section])


def _record(
    document: Document, section: str, record: type, given: dict[str, Any], lacks: list[str] | None = None
) -> Any:
    """Record of a section, or None with its problems noted."""
    present = document.sections.get(section)
    if present is None and section in _REQUIRED_SECTIONS:
        return None
    written = present or {}
    required = [f.name for f in fields(record) if f.default is MISSING and f.default_factory is MISSING]
    missing = (lacks or []) + [key for key in required if key not in written and key not in given]
    if missing:
        document.problems.append(InputError(f"{document.label}: [{section}]", f"lacks: {', '.join(missing)}"))
    if missing or any(key not in given for key in written if key in required):
        return None
    try:
        return record(**given)
    except InputError as error:
        document.problems.extend(_relocated(document, p) for p in error.problems or (error,))
        return None


_SECTION_OF = {
    "BallBearing": "bearing",
    "Operation": "operation",
    "Film": "film",
    "CageDesign": "cage",
    "StabilitySettings": "stability",
    "RankingQuestion": "ranking",
}


def _relocated(document: Document, problem: InputError) -> InputError:
    """The refusal of a record, in the words of the file: its place, its section and what it says there."""
    record, _, key = problem.where.partition(".")
    section = _SECTION_OF.get(record)
    if section is None:
        return problem
    entry = document.sections.get(section, {}).get(key)
    place = entry.place if entry else document.label
    is_scalar = entry is not None and isinstance(entry.value, (str, int, float))
    value = shown(entry.value) if entry is not None and is_scalar and problem.value else problem.value
    return InputError(f"{place}: [{section}] {key}", problem.rule, problem.unit, value, problem.cure)


def _bearing(document: Document, given: dict[str, Any]) -> BallBearing | None:
    written = document.sections.get("bearing", {})
    lacks = []
    if "contact_angle" in written and "radial_clearance" in written:
        document.problems.append(_exclusive(written, "bearing", "radial_clearance", "contact_angle"))
        return None
    if "contact_angle" not in written and "radial_clearance" not in written:
        lacks = ["contact_angle (or radial_clearance)"]
    clearance = given.pop("radial_clearance", None)
    if "radial_clearance" in written:
        angle = None if clearance is None else _free_angle(document, clearance, given)
        given["contact_angle"] = 0.0 if angle is None else angle
    elif lacks:
        given["contact_angle"] = 0.0
    record: BallBearing | None = _record(document, "bearing", BallBearing, given, lacks)
    return record


def _free_angle(document: Document, clearance: float, given: dict[str, Any]) -> float | None:
    """Contact angle without load from the diametral play: cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D)."""
    needed = ("ball_diameter", "inner_conformity", "outer_conformity")
    if any(key not in given for key in needed):
        return None
    diameter, inner, outer = (given[key] for key in needed)
    room = 2.0 * (inner + outer - 1.0) * diameter
    if not 0.0 <= clearance < room:
        entry = document.sections["bearing"]["radial_clearance"]
        top = format_quantity(room, "m") if room > 0.0 else "what the grooves allow"
        rule = f"must be >= 0 and less than {top}, where the free contact angle would reach 90 deg"
        document.problems.append(
            InputError(f"{entry.place}: [bearing] radial_clearance", rule, "", shown(entry.value))
        )
        return None
    return 2.0 * math.asin(math.sqrt(0.5 * clearance / room))


def _operation(document: Document, given: dict[str, Any]) -> Operation | None:
    written = document.sections.get("operation", {})
    if "moment" in written and "tilt" in written:
        document.problems.append(_exclusive(written, "operation", "tilt", "moment"))
        return None
    record: Operation | None = _record(document, "operation", Operation, given)
    return record


def _film(document: Document, given: dict[str, Any]) -> Film | None:
    written = document.sections.get("film", {})
    in_place = {key: entry for key, entry in written.items() if key in ("elastic_modulus", "poisson_ratio")}
    properties: dict[str, Any] = {
        key: given.pop(key) for key in ("elastic_modulus", "poisson_ratio") if key in given
    }
    if in_place and "material" in written:
        document.problems.append(_exclusive(written, "film", next(iter(in_place)), "material"))
        return None
    if len(in_place) == 1:
        missing = ({"elastic_modulus", "poisson_ratio"} - set(in_place)).pop()
        document.problems.append(InputError(f"{document.label}: [film]", f"lacks: {missing}"))
        return None
    if len(properties) == 2:
        try:
            where = f"{in_place['elastic_modulus'].place}: [film] material"
            given["material"] = values.build(
                Material, {"name": "film given in the study", **properties}, where
            )
        except InputError as error:
            document.problems.extend(error.problems or (error,))
            return None
    elif in_place:
        return None
    if "material" in written and "material" not in given:
        return None
    record: Film | None = _record(document, "film", Film, given)
    return record


def _cage(document: Document, given: dict[str, Any]) -> CageDesign | None:
    written = document.sections["cage"]
    if given.get("guidance", Guidance.BALL) is Guidance.BALL and "guidance" not in _failed(written, given):
        for key in written:
            if key.startswith("land_") and key in _READERS["cage"]:
                where = f"{written[key].place}: [cage] {key}"
                cure = 'Give guidance = "outer" or "inner", or leave it out.'
                document.problems.append(
                    InputError(where, "has no meaning for a cage guided by its balls", cure=cure)
                )
                return None
    if _failed(written, given):
        return None
    record: CageDesign | None = _record(document, "cage", CageDesign, given)
    return record


def _failed(written: dict[str, Entry], given: dict[str, Any]) -> set[str]:
    return {key for key in written if key in _READERS["cage"] and key not in given}


def _exclusive(written: dict[str, Entry], section: str, one: str, other: str) -> InputError:
    where = f"{written[one].place}: [{section}] {one}"
    return InputError(where, f"and {other} exclude each other", cure="Give one of the two.")


def _ranking(document: Document, given: dict[str, Any]) -> RankingQuestion | None:
    written = document.sections["ranking"]
    before = len(document.problems)
    if "candidates" in written and ("friction" in written or "materials" in written):
        other = "friction" if "friction" in written else "materials"
        document.problems.append(_exclusive(written, "ranking", "candidates", other))
    elif "candidates" in written:
        given = _candidates(document, given.get("candidates"))
    elif "friction" not in written:
        document.problems.append(
            InputError(f"{document.label}: [ranking]", "lacks: friction (or candidates)")
        )
    elif "friction" in given:
        given = _from_table(document, given)
    if len(document.problems) > before or "candidates" not in given:
        return None
    record: RankingQuestion | None = _record(document, "ranking", RankingQuestion, given)
    return record


def _from_table(document: Document, given: dict[str, Any]) -> dict[str, Any]:
    written = document.sections["ranking"]
    name = given["friction"]
    if name not in library.FRICTION_TABLES:
        where = f"{written['friction'].place}: [ranking] friction"
        cure = f"The library has {', '.join(library.FRICTION_TABLES)}."
        document.problems.append(
            InputError(where, "is no friction table of the library", "", shown(name), cure)
        )
        return {}
    table = library.friction_table(name)
    chosen = given.get("materials", tuple(table.friction))
    for material in chosen:
        if material not in table.friction:
            where = f"{written['materials'].place}: [ranking] materials"
            near = unknown(where, "", material, table.friction).cure
            has = f"{name} has {', '.join(table.friction)}."
            cure = f"{near} {has}" if near.startswith("Did") else has
            document.problems.append(
                InputError(where, "names a material without friction", "", shown(material), cure)
            )
            return {}
    known = [material for material in chosen if material in table.friction]
    return {"environments": table.environments, "candidates": tuple(table.candidate(m) for m in known)}


def _candidates(document: Document, value: Any) -> dict[str, Any]:
    place = document.sections["ranking"]["candidates"].place
    if not isinstance(value, list) or not value:
        where = f"{place}: [ranking] candidates"
        document.problems.append(
            InputError(where, "must be one or more [[ranking.candidates]]", "", shown(value))
        )
        return {}
    found: list[tuple[str, dict[str, Any]]] = []
    for i, item in enumerate(value[:1000]):
        line = document.lines.get(f"ranking.candidates.{i}")
        where = (
            f"{f'{document.label}, line {line}' if line else place}: [[ranking.candidates]] number {i + 1}"
        )
        try:
            found.append((where, values.table(item, where, _CANDIDATE, ("name", "friction"))))
        except InputError as error:
            document.problems.extend(error.problems or (error,))
    environments = tuple(dict.fromkeys(env for _, item in found for env in item["friction"]))
    candidates = []
    for where, item in found:
        friction = {env: item["friction"].get(env) for env in environments}
        try:
            candidates.append(values.build(Candidate, {**item, "friction": friction}, where))
        except InputError as error:
            document.problems.extend(error.problems or (error,))
    return {"environments": environments, "candidates": tuple(candidates)}


def _frictions(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict) or not value:
        cure = 'Write it like { "liquid nitrogen, 440C" = 0.11 }.'
        raise InputError(where, "must be a table from environment to friction", "", shown(value), cure)
    names = {values.text(env, f"{where}, an environment's name,"): item for env, item in value.items()}
    return {env: values.friction(item, f'{where} in "{env}"') for env, item in names.items()}


_CANDIDATE: dict[str, Reader] = {
    "name": values.text,
    "friction": _frictions,
    "material": values.material("cage material"),
}


def _origins(document: Document) -> dict[str, str]:
    """Place and text of every given key."""
    origins = {}
    for section, entries in document.sections.items():
        for key, entry in entries.items():
            text = f": {shown(entry.value)}" if not isinstance(entry.value, (dict, list)) else ""
            origins[f"{section}.{key}"] = entry.place + text
    if "bearing.radial_clearance" in origins:
        origins["bearing.contact_angle"] = f"from radial_clearance, {origins['bearing.radial_clearance']}"
    return origins
