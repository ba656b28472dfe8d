"""Strict reader of library files: TOML whose every number has a unit, a source and a confidence."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from separatrix.friction.prediction import refuse_scatter_about_zero
from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.toml import (
    Kind,
    Reader,
    build,
    label_of,
    nearest,
    parsed,
    places_of,
    quantity,
    ratio,
    read_text,
    table,
    text,
    truth,
    whole,
)
from separatrix.ground.units import format_quantity, printable, shown
from separatrix.study.library.records import (
    CONDITIONS,
    CONFIDENCES,
    ELASTIC,
    FLUID,
    KINDS,
    SOLID,
    Datum,
    Facts,
    FrictionTable,
    LibraryFile,
    Property,
    Record,
)
from separatrix.study.study import Friction

LIBRARY = Kind(
    noun="a library of materials",
    most_bytes=1024 * 1024,
    empty="`separatrix materials show 440C` shows what a record holds.",
)
SECTIONS = {kind.replace(" ", "_"): kind for kind in KINDS}
"""Kind of the records of each section of a file."""

MOST_RECORDS, MOST_DATA, MOST_PROBLEMS = 2000, 100, 100
TOP = ("title",)
_long_text: Reader[str] = partial(text, longest=1000, cure="Put it in quotes.")
BLANK = "What is not known is left out, never given as 0."


@dataclass(frozen=True, slots=True, kw_only=True)
class Content:
    """A library file and its records."""

    file: LibraryFile
    records: tuple[Record | FrictionTable, ...]


def read_library(path: Path, *, shipped: bool = False) -> Content:
    """Records of a library file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: file, line, record, rule, value, cure.
    """
    return library_of_text(read_text(path, LIBRARY), label_of(path), shipped=shipped)


def library_of_text(given: str, label: str, *, shipped: bool = False) -> Content:
    """Records of the text of a library file."""
    data, lines = parsed(given, label, LIBRARY)
    checksum = hashlib.sha256(given.encode()).hexdigest()
    file = LibraryFile(label=label, checksum=checksum, shipped=shipped)
    records: list[Record | FrictionTable] = []
    problems: list[InputError] = []
    for section, value in data.items():
        where = f"[{printable(section)}]" if isinstance(value, dict | list) else printable(section)
        with noted(problems):
            if section in TOP:
                _long_text(value, section)
                continue
            if section not in SECTIONS:
                raise InputError(where, "is not a kind of record", cure=nearest(section, SECTIONS))
            if not isinstance(value, dict):
                raise InputError(where, "must contain records, each with its name", shown(value))
            if len(value) > MOST_RECORDS:
                raise InputError(where, f"has more than {MOST_RECORDS} records")
            for name, item in value.items():
                if len(problems) <= MOST_PROBLEMS:
                    with noted(problems):
                        line = lines.get(f"{section}.{name}")
                        records.append(_record(section, name, item, file, line))
    if not records and not problems:
        rule = 'has no record: it needs a section such as [cage_material."My compound"]'
        problems.append(InputError("", rule))
    if problems:
        places = places_of(label, data, lines)
        raise together([one.at(places.locate(one.path)) for one in problems])
    return Content(file=file, records=tuple(records))


def _record(
    section: str, name: str, item: object, file: LibraryFile, line: int | None
) -> Record | FrictionTable:
    """Read one record; its faults are under the path of its keys, ``[film] PTFE.density``."""
    at = f"[{section}] {printable(name)}"
    if text(name, f"{at}, its name,") != name.strip():
        raise InputError(f"{at}, its name,", "must not begin or end with a space", shown(name))
    if not isinstance(item, dict):
        raise InputError(at, "must be a record: keys with values", shown(item))
    if section == "friction_table":
        return _friction_table(item, at, name, file, line)
    kind, is_fluid = SECTIONS[section], section == "fluid"
    data = {key: _data(known) for key, known in (FLUID if is_fluid else SOLID).items()}
    own = _FACTS if is_fluid else {"composition": _long_text, "aliases": _FACTS["aliases"]}
    readers = {**data, "remark": _long_text, "replaces": truth, **own}
    given = table(item, at, readers, ("substance", "phase") if is_fluid else ELASTIC, f"a {kind}")
    facts = Facts(aliases=given.get("aliases"))
    if is_fluid:
        facts = Facts(
            substance=given["substance"],
            phase=given["phase"],
            coolprop=given.get("coolprop"),
            aliases=given.get("aliases"),
        )
    return Record(
        kind=kind,
        name=name,
        data={key: value for key, value in given.items() if key in data},
        facts=facts,
        file=file,
        line=line,
        **{key: given[key] for key in ("remark", "replaces", "composition") if key in given},
    )


def _data(known: Property) -> Reader[tuple[Datum, ...]]:
    """Reader of one datum, or of several of one property under different conditions."""

    def read(value: object, where: str) -> tuple[Datum, ...]:
        if not isinstance(value, list):
            return (_datum(known, value, where),)
        if not 0 < len(value) <= MOST_DATA:
            raise InputError(where, f"must be 1 to {MOST_DATA} data", f"{len(value)} of them", BLANK)
        data = tuple(_datum(known, item, f"{where}[{i}]") for i, item in enumerate(value, 1))
        if len({(d.temperature, d.pressure, d.medium, d.form) for d in data}) < len(data):
            rule = "has two data for the same temperature, pressure, medium and form"
            raise InputError(where, rule, cure="Keep one, or give the condition in which they differ.")
        return data

    return read


def _datum(known: Property, value: object, where: str) -> Datum:
    if not isinstance(value, dict):
        example = '{ value = "5 GPa", source = "our test 12", confidence = "measured" }'
        raise InputError(where, "must be a number with its source", shown(value), f"Write it like {example}.")
    number = _in_range(known.unit, known.low, known.high, "Check the unit.")

    def expected(value: object, where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise InputError(where, "must be a list of the lowest and the highest value", shown(value))
        return number(value[0], where), number(value[1], where)

    readers: dict[str, Reader[object]] = {
        "value": number,
        "source": _source,
        "confidence": _confidence,
        "range": expected,
        "temperature": _span(*CONDITIONS["temperature"]),
        "pressure": _in_range("Pa", 1e-9, 1e11),
        "medium": _long_text,
        "form": _long_text,
    }
    given = table(value, where, readers, ("value", "source", "confidence"))
    if "range" in given and not given["range"][0] <= given["value"] <= given["range"][1]:
        rule = "must have the value between its ends, the lower one first"
        raise InputError(f"{where}.range", rule, shown(value["range"]))
    return Datum(unit=known.unit, **given)


def _friction_table(
    item: dict[str, object], at: str, name: str, file: LibraryFile, line: int | None
) -> FrictionTable:
    """Read a table of measured friction: its words, its conditions, and a row for each material."""
    readers: dict[str, Reader[object]] = {
        "title": _long_text,
        "source": _long_text,
        "confidence": _confidence,
        "remark": _long_text,
        "replaces": truth,
        "environments": _names,
        "friction": _rows,
        **{key: _span(*known) for key, known in CONDITIONS.items()},
    }
    given = table(item, at, readers, ("title", "source", "confidence", "friction"))
    conditions = {key: given.pop(key) for key in CONDITIONS if key in given}
    rows = {
        material: {
            env: _friction(value, f'{at}.friction."{printable(material)}"."{env[:60]}"', given)
            for env, value in row.items()
        }
        for material, row in given.pop("friction").items()
    }
    used = tuple(dict.fromkeys(env for row in rows.values() for env in row))
    environments = given.pop("environments", used)
    if unknown := [env for env in used if env not in environments]:
        cure = nearest(unknown[0], environments) if environments else ""
        rule = "lacks an environment that the table uses"
        raise InputError(f"{at}.environments", rule, shown(unknown[0]), cure)
    return FrictionTable(
        name=name,
        file=file,
        line=line,
        conditions=conditions,
        environments=environments,
        friction={material: {env: row.get(env) for env in environments} for material, row in rows.items()},
        **given,
    )


def _rows(value: object, where: str) -> dict[str, dict[str, object]]:
    """Read the names of materials and environments, not yet the frictions."""
    if not isinstance(value, dict) or not 0 < len(value) <= MOST_RECORDS:
        cure = 'Write a section [friction_table."NAME".friction."MATERIAL"] for each.'
        rule = f"must have the friction of 1 to {MOST_RECORDS} materials"
        raise InputError(where, rule, shown(value), cure)
    for name, row in value.items():
        at = f'{where}."{printable(text(name, where))}"'
        if not isinstance(row, dict) or not row:
            rule = "must give the friction in at least one environment"
            raise InputError(at, rule, shown(row), 'Write "liquid nitrogen, 440C" = 0.11.')
        for environment in row:
            text(environment, at)
    return value


def _friction(value: object, where: str, words: Mapping[str, str]) -> Friction:
    readers: dict[str, Reader[object]] = {"mean": ratio, "standard_deviation": ratio, "count": whole}
    given = table(value, where, readers, ("mean",)) if isinstance(value, dict) else {}
    given = given or {"mean": ratio(value, where)}
    if given["mean"] == 0.0:
        raise InputError(where, "must be above 0", "0", BLANK)
    known = {**given, "source": words["source"], "confidence": words["confidence"]}
    return refuse_scatter_about_zero(build(Friction, known, where), where)


def _names(value: object, where: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise InputError(where, "must be a list of names in quotes", shown(value))
    if len(set(value)) < len(value):
        raise InputError(where, "names an environment twice")
    return tuple(value)


def _source(value: object, where: str) -> str:
    given = _long_text(value, where)
    if len(given.strip()) < 3:
        cure = "Give who measured or printed it, and where."
        raise InputError(where, "must name a source", shown(value), cure)
    return given


def _confidence(value: object, where: str) -> str:
    given = _long_text(value, where)
    if given.partition(";")[0].strip() not in CONFIDENCES:
        rule = f"must be one of {', '.join(CONFIDENCES)}, perhaps with a remark after a semicolon"
        raise InputError(where, rule, shown(value), 'A guess is allowed and marked: "guess".')
    return given


def _phase(value: object, where: str) -> str:
    if value not in ("liquid", "gas"):
        raise InputError(where, 'must be "liquid" or "gas"', shown(value))
    return str(value)


def _in_range(unit: str, low: float, high: float, cure: str = "") -> Reader[float]:
    """Reader of one number between two bounds."""
    reader = quantity(unit)

    def read(value: object, where: str) -> float:
        number = reader(value, where)
        if not low <= number <= high:
            rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
            raise InputError(where, rule, shown(value), BLANK if cure and number == 0.0 else cure)
        return number

    return read


def _span(unit: str, low: float, high: float) -> Reader[tuple[float, float]]:
    """Reader of one quantity, or of a list of the lowest and the highest one."""
    one = _in_range(unit, low, high)

    def read(value: object, where: str) -> tuple[float, float]:
        bounds = value if isinstance(value, list) else [value, value]
        if len(bounds) != 2:
            rule = "must be one quantity or a list of the lowest and the highest"
            raise InputError(where, rule, shown(value))
        first, last = (one(bound, where) for bound in bounds)
        if first > last:
            raise InputError(where, "must give the lower end first", f"{shown(bounds[0])} first")
        return first, last

    return read


def _aliases(value: object, where: str) -> list[str]:
    if not isinstance(value, list) or not 0 < len(value) <= 20:
        raise InputError(where, "must be a list of 1 to 20 names", shown(value))
    return [text(name, where) for name in value]


def _coolprop(value: object, where: str) -> str:
    given = text(value, where)
    if not (given.isascii() and given.replace("-", "").isalnum()):
        raise InputError(where, "must be the plain name of a pure fluid, letters and digits", shown(value))
    return given


_FACTS: dict[str, Reader[object]] = {
    "substance": text,
    "phase": _phase,
    "coolprop": _coolprop,
    "aliases": _aliases,
}
