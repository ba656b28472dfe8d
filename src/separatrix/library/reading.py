"""Strict reader of library files: TOML whose every number has a unit, a source and a confidence."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from separatrix.errors import InputError, together
from separatrix.library.records import (
    CONDITION_UNITS,
    CONFIDENCES,
    ELASTIC,
    FLUID,
    KINDS,
    SOLID,
    Datum,
    FrictionTable,
    LibraryFile,
    Property,
    Record,
)
from separatrix.measured_friction import refuse_scatter_about_zero
from separatrix.study import Friction
from separatrix.toml_text import Kind, label_of, parsed, places_of, read_text
from separatrix.toml_values import Reader, build, nearest, ratio, table, text, whole
from separatrix.units import format_quantity, parse, printable, shown

LIBRARY = Kind(
    noun="a library of materials",
    most_bytes=1024 * 1024,
    empty="`separatrix materials show 440C` shows what a record holds.",
)
SECTIONS = {kind.replace(" ", "_"): kind for kind in KINDS}
"""Section of a file -> kind of its records."""

MOST_RECORDS, MOST_DATA, MOST_PROBLEMS, LONGEST_TEXT = 2000, 100, 100, 1000
TOP = ("title",)
BLANK = "What is not known is left out, never given as 0."
CONDITION_LIMITS = {
    "temperature": (1e-3, 5000.0),
    "slip_speed": (1e-9, 1e4),
    "normal_force": (1e-9, 1e9),
    "pressure": (1e-3, 1e12),
}
Made = TypeVar("Made")
Inputs = ParamSpec("Inputs")


@dataclass(frozen=True, slots=True, kw_only=True)
class Content:
    """What a library file holds."""

    file: LibraryFile
    records: tuple[Record | FrictionTable, ...]


def read_library(path: Path) -> Content:
    """Records of a library file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: file, line, record, rule, value, cure.
    """
    return library_of_text(read_text(path, LIBRARY), label_of(path))


def library_of_text(given: str, label: str) -> Content:
    """Records of the text of a library file."""
    data, lines = parsed(given, label, LIBRARY)
    return _Reading(given, label, data, lines, shipped=False).content(data)


class Shipped(Mapping[str, Record | FrictionTable]):
    """Records of a shipped file, of one kind, by name; each is read when asked for, as a study needs few.

    Raises
    ------
    InputError
        A record is wrong, when it is asked for.
    """

    def __init__(self, path: Path) -> None:
        given = read_text(path, LIBRARY)
        data, lines = parsed(given, label_of(path), LIBRARY)
        self._reading = _Reading(given, label_of(path), data, lines, shipped=True)
        ((self._section, self._items),) = data.items()
        self._read: dict[str, Record | FrictionTable] = {}

    def __getitem__(self, name: str) -> Record | FrictionTable:
        if name not in self._read:
            self._read[name] = self._reading.record(self._section, name, self._items[name])
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)


class _Reading:
    """One file being read: what is wrong is collected, and placed at the end."""

    def __init__(
        self, given: str, label: str, data: dict[str, Any], lines: Mapping[str, int], *, shipped: bool
    ) -> None:
        checksum = hashlib.sha256(given.encode()).hexdigest()
        self.file = LibraryFile(label=label, checksum=checksum, shipped=shipped)
        self.lines, self.places = lines, places_of(label, data, lines)
        self.problems: list[InputError] = []

    def content(self, data: Mapping[str, Any]) -> Content:
        """Read every section; refuse with everything wrong."""
        records: list[Record | FrictionTable] = []
        for section, value in data.items():
            if section in TOP:
                self._attempt(_long_text, value, section)
                continue
            where = f"[{printable(section)}]" if isinstance(value, dict | list) else printable(section)
            if section not in SECTIONS:
                cure = nearest(section, SECTIONS)
                self.problems.append(InputError(where, "is not a kind of record", cure=cure))
            elif not isinstance(value, dict):
                rule = "must hold records, each with its name"
                self.problems.append(InputError(where, rule, shown(value)))
            elif len(value) > MOST_RECORDS:
                self.problems.append(InputError(where, f"holds more than {MOST_RECORDS} records"))
            else:
                for name, item in value.items():
                    if len(self.problems) <= MOST_PROBLEMS:
                        record = self._attempt(self.record, section, name, item)
                        records += [record] if record is not None else []
        if not records and not self.problems:
            rule = 'holds no record: it needs a section such as [cage_material."My compound"]'
            self.problems.append(InputError("", rule))
        if self.problems:
            raise together([one.at(self.places.locate(one.path)) for one in self.problems])
        return Content(file=self.file, records=tuple(records))

    def record(self, section: str, name: str, item: Any) -> Record | FrictionTable:
        """Read one record; its faults are under the path of its keys, ``[film] PTFE.density``."""
        at = f"[{section}] {printable(name)}"
        if text(name, f"{at}, its name,") != name.strip():
            raise InputError(f"{at}, its name,", "must not begin or end with a space", shown(name))
        if not isinstance(item, dict):
            raise InputError(at, "must be a record: keys with values", shown(item))
        common = {"name": name, "file": self.file, "line": self.lines.get(f"{section}.{name}")}
        if section == "friction_table":
            return _friction_table(item, at, common)
        return _material(SECTIONS[section], item, at, common)

    def _attempt(
        self, make: Callable[Inputs, Made], *args: Inputs.args, **kwargs: Inputs.kwargs
    ) -> Made | None:
        """What `make` returns, or None with its refusals noted."""
        try:
            return make(*args, **kwargs)
        except InputError as error:
            self.problems.extend(error.problems or (error,))
        return None


def _material(kind: str, item: Mapping[str, Any], at: str, common: dict[str, Any]) -> Record:
    """Read a material or a fluid: its words, its facts and its numbers."""
    numbers = FLUID if kind == "fluid" else SOLID
    words: dict[str, Reader] = {"remark": _long_text, "replaces": _yes_or_no}
    words |= _FACTS if kind == "fluid" else {"composition": _long_text, "aliases": _aliases}
    given: dict[str, Any] = {}
    data: dict[str, tuple[Datum, ...]] = {}
    problems: list[InputError] = []
    for key, value in item.items():
        where = f"{at}.{printable(key)}"
        try:
            if key in words:
                given[key] = words[key](value, where)
            elif key in numbers:
                data[key] = _data(numbers[key], value, where)
            else:
                cure = nearest(key, [*numbers, *words])
                raise InputError(where, f"is not a key of a {kind}", cure=cure)
        except InputError as error:
            problems.extend(error.problems or (error,))
    required = ("substance", "phase") if kind == "fluid" else ELASTIC
    if missing := [key for key in required if key not in item]:
        problems.append(InputError(at, f"lacks: {', '.join(missing)}"))
    if problems:
        raise together(problems)
    facts = {key: given.pop(key, None) for key in (_FACTS if kind == "fluid" else ("aliases",))}
    return Record(kind=kind, data=data, facts=facts, **given, **common)


def _data(known: Property, value: Any, where: str) -> tuple[Datum, ...]:
    """Read one datum, or several of one property under different conditions."""
    if not isinstance(value, list):
        return (_datum(known, value, where),)
    if not 0 < len(value) <= MOST_DATA:
        raise InputError(where, f"must hold 1 to {MOST_DATA} data", f"{len(value)} of them", BLANK)
    data = tuple(_datum(known, item, f"{where}[{i}]") for i, item in enumerate(value, 1))
    conditions = [(d.temperature, d.pressure, d.medium, d.form) for d in data]
    if len(set(conditions)) < len(conditions):
        rule = "holds two data for the same temperature, pressure, medium and form"
        raise InputError(where, rule, cure="Keep one, or give the condition in which they differ.")
    return data


def _datum(known: Property, value: Any, where: str) -> Datum:
    if not isinstance(value, dict):
        example = '{ value = "5 GPa", source = "our test 12", confidence = "measured" }'
        raise InputError(where, "must be a number with its source", shown(value), f"Write it like {example}.")

    def number(value: Any, where: str) -> float:
        found = ratio(value, where) if known.unit == "-" else parse(value, known.unit, where)
        if not known.low <= found <= known.high:
            low, high = (format_quantity(bound, known.unit) for bound in (known.low, known.high))
            cure = BLANK if found == 0.0 else "Check the unit."
            raise InputError(where, f"must lie between {low} and {high}", shown(value), cure)
        return found

    def expected(value: Any, where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise InputError(where, "must be a list of the lowest and the highest value", shown(value))
        return number(value[0], where), number(value[1], where)

    readers: dict[str, Reader] = {
        "value": number,
        "source": _source,
        "confidence": _confidence,
        "range": expected,
        "temperature": _span("K", *CONDITION_LIMITS["temperature"]),
        "pressure": _in_range("Pa", 1e-9, 1e11),
        "medium": _long_text,
        "form": _long_text,
    }
    given = table(value, where, readers, ("value", "source", "confidence"))
    if "range" in given and not given["range"][0] <= given["value"] <= given["range"][1]:
        rule = "must hold the value between its ends, the lower one first"
        raise InputError(f"{where}.range", rule, shown(value["range"]))
    return Datum(unit=known.unit, **given)


def _friction_table(item: Mapping[str, Any], at: str, common: dict[str, Any]) -> FrictionTable:
    """Read a table of measured friction: its words, its conditions, and a row for each material."""
    readers: dict[str, Reader] = {
        "title": _long_text,
        "source": _long_text,
        "confidence": _confidence,
        "remark": _long_text,
        "replaces": _yes_or_no,
        "environments": _names,
        "friction": _rows,
        **{key: _span(unit, *CONDITION_LIMITS[key]) for key, unit in CONDITION_UNITS.items()},
    }
    given = table(item, at, readers, ("title", "source", "confidence", "friction"))
    conditions = {key: given.pop(key) for key in CONDITION_UNITS if key in given}
    rows = {
        name: {
            env: _friction(value, f'{at}.friction."{printable(name)}"."{env[:60]}"', given)
            for env, value in row.items()
        }
        for name, row in given.pop("friction").items()
    }
    used = tuple(dict.fromkeys(env for row in rows.values() for env in row))
    environments = given.pop("environments", used)
    if unknown := [env for env in used if env not in environments]:
        cure = nearest(unknown[0], environments) if environments else ""
        rule = "lacks an environment that the table uses"
        raise InputError(f"{at}.environments", rule, shown(unknown[0]), cure)
    friction = {name: {env: row.get(env) for env in environments} for name, row in rows.items()}
    return FrictionTable(
        conditions=conditions, environments=environments, friction=friction, **given, **common
    )


def _rows(value: Any, where: str) -> dict[str, dict[str, Any]]:
    """Read the names of materials and environments, not yet the frictions."""
    if not isinstance(value, dict) or not 0 < len(value) <= MOST_RECORDS:
        cure = 'Write a section [friction_table."NAME".friction."MATERIAL"] for each.'
        rule = f"must hold the friction of 1 to {MOST_RECORDS} materials"
        raise InputError(where, rule, shown(value), cure)
    for name, row in value.items():
        at = f'{where}."{printable(text(name, where))}"'
        if not isinstance(row, dict) or not row:
            rule = "must give the friction in at least one environment"
            raise InputError(at, rule, shown(row), 'Write "liquid nitrogen, 440C" = 0.11.')
        for environment in row:
            text(environment, at)
    return value


def _friction(value: Any, where: str, words: Mapping[str, str]) -> Friction:
    readers: dict[str, Reader] = {"mean": ratio, "standard_deviation": ratio, "count": whole}
    given = {"mean": ratio(value, where)} if not isinstance(value, dict) else None
    given = given or table(value, where, readers, ("mean",))
    if given["mean"] == 0.0:
        raise InputError(where, "must be above 0", "0", BLANK)
    known = {**given, "source": words["source"], "confidence": words["confidence"]}
    return refuse_scatter_about_zero(build(Friction, known, where), where)


def _names(value: Any, where: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise InputError(where, "must be a list of names in quotes", shown(value))
    if len(set(value)) < len(value):
        raise InputError(where, "names an environment twice")
    return tuple(value)


def _long_text(value: Any, where: str) -> str:
    """Read printable text on one line, up to `LONGEST_TEXT` characters."""
    if not isinstance(value, str):
        raise InputError(where, "must be text", shown(value), "Put it in quotes.")
    if not 0 < len(value.strip()) <= LONGEST_TEXT or not value.isprintable():
        rule = f"must be one line of 1 to {LONGEST_TEXT} printable characters"
        raise InputError(where, rule, shown(value))
    return value


def _source(value: Any, where: str) -> str:
    if len(_long_text(value, where).strip()) < 3:
        cure = "Give who measured or printed it, and where."
        raise InputError(where, "must name a source", shown(value), cure)
    return str(value)


def _confidence(value: Any, where: str) -> str:
    """Read one of the words, perhaps with a remark after a semicolon."""
    given = _long_text(value, where)
    if given.partition(";")[0].strip() not in CONFIDENCES:
        rule = f"must be one of {', '.join(CONFIDENCES)}, perhaps with a remark after a semicolon"
        raise InputError(where, rule, shown(given), 'A guess is allowed and marked: "guess".')
    return given


def _yes_or_no(value: Any, where: str) -> bool:
    if not isinstance(value, bool):
        raise InputError(where, "must be true or false, without quotes", shown(value))
    return value


def _in_range(unit: str, low: float, high: float) -> Callable[[Any, str], float]:
    """Reader of one quantity between two bounds."""

    def read(value: Any, where: str) -> float:
        number = parse(value, unit, where)
        if not low <= number <= high:
            rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
            raise InputError(where, rule, shown(value))
        return number

    return read


def _span(unit: str, low: float, high: float) -> Callable[[Any, str], tuple[float, float]]:
    """Reader of one quantity, or of a list of the lowest and the highest one."""
    one = _in_range(unit, low, high)

    def read(value: Any, where: str) -> tuple[float, float]:
        bounds = value if isinstance(value, list) else [value, value]
        if len(bounds) != 2:
            rule = "must be one quantity or a list of the lowest and the highest"
            raise InputError(where, rule, shown(value))
        first, last = (one(bound, where) for bound in bounds)
        if first > last:
            raise InputError(where, "must give the lower end first", f"{shown(bounds[0])} first")
        return first, last

    return read


def _phase(value: Any, where: str) -> str:
    if value not in ("liquid", "gas"):
        raise InputError(where, 'must be "liquid" or "gas"', shown(value))
    return str(value)


def _coolprop(value: Any, where: str) -> str:
    given = text(value, where)
    if not (given.isascii() and given.replace("-", "").isalnum()):
        raise InputError(where, "must be the plain name of a pure fluid, letters and digits", shown(given))
    return given


def _aliases(value: Any, where: str) -> list[str]:
    if not isinstance(value, list) or not 0 < len(value) <= 20:
        raise InputError(where, "must be a list of 1 to 20 names", shown(value))
    return [text(name, where) for name in value]


_FACTS: dict[str, Reader] = {"substance": text, "phase": _phase, "coolprop": _coolprop, "aliases": _aliases}
