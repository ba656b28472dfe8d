"""Friction files: tests as a person or the verb `tribometer` writes them (docs/reference/friction-file.md).

TOML, one [[test]] for each test, every dimensional value as text with its unit.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, together
from separatrix.friction.records import NAMES, UNITS, FrictionTest, place
from separatrix.toml_files import (
    Kind,
    Reader,
    build,
    label_of,
    list_of,
    nearest,
    quantity,
    ratio,
    read_toml,
    table,
    text,
)
from separatrix.units import parse, printable, shown

MOST_TESTS = 10_000
MOST_PROBLEMS = 100
KIND = Kind(
    noun="a friction file",
    most_bytes=8 * 1024 * 1024,
    empty="`separatrix tribometer FILES --out friction.toml` makes one from logs.",
)
REQUIRED = (*NAMES, "friction")

HEADER = """\
# Friction of cage materials from tests, as `separatrix tribometer` writes it and a study reads it:
#     [ranking]
#     friction = "friction.toml"
# One [[test]] for each test. Required: material, counterface, medium, friction. The rest may be left out.
# slip_speed, pressure (mean contact pressure) and temperature: a quantity with its unit as text, or
# ["lowest", "highest"]. standard_error is that of this test's mean; standard_deviation that of the means
# of its whole cycles. Tests of one specimen name the same sample. Change or add what you know; a test that
# should not count is removed, or commented out.
"""
_EXAMPLE = 'Write [[test]], and under it material = "Armalon" and so on.'


def read_friction(path: Path) -> tuple[FrictionTest, ...]:
    """Tests of a friction file, in its order.

    Raises
    ------
    InputError
        Everything that is wrong with it, a line each: place, rule, value, cure.
    """
    data, lines = read_toml(path, KIND)
    file = _Places(label_of(path), lines)
    items = _items(data, file)
    tests: list[FrictionTest] = []
    problems: list[InputError] = []
    for number, item in enumerate(items):
        try:
            tests.append(_test(item, number, file))
        except InputError as error:
            problems.extend(error.problems or (error,))
        if len(problems) > MOST_PROBLEMS:
            break
    if not problems:
        problems.extend([*_twice(tests, file), *_alike(tests, file)])
    if problems:
        raise together(problems)
    return tuple(tests)


@dataclass(frozen=True, slots=True)
class _Places:
    """Where the keys of a file are."""

    label: str
    lines: Mapping[str, int]

    def of(self, *keys: str) -> str:
        """Label and line of the first of the keys that the file holds."""
        line = next((self.lines[key] for key in keys if key in self.lines), None)
        return self.label if line is None else f"{self.label}, line {line}"


def _items(data: Mapping[str, object], file: _Places) -> list[object]:
    for key in data:
        if key not in ("title", "test"):
            where = f"{file.of(key, f'{key}.0')}: {printable(key)}"
            raise InputError(where, "is not a key of a friction file", cure=nearest(key, ("title", "test")))
    if "title" in data:
        text(data["title"], f"{file.of('title')}: title")
    items = data.get("test")
    if items is None:
        raise InputError(file.label, "holds no test", cure=_EXAMPLE)
    if not isinstance(items, list) or not 0 < len(items) <= MOST_TESTS:
        got = f"{len(items)} tests" if isinstance(items, list) else shown(items)
        where = f"{file.of('test', 'test.0')}: test"
        raise InputError(where, f"must be 1 to {MOST_TESTS} tables", got, _EXAMPLE)
    return items


def _test(item: object, number: int, file: _Places) -> FrictionTest:
    """One test; what its record or its readers refuse has the line of its key."""
    where = f"{file.of(f'test.{number}', 'test')}: [[test]]"
    if not isinstance(item, dict):
        raise InputError(where, "must be a table", shown(item), _EXAMPLE)
    given: dict[str, Any] = {}
    problems: list[InputError] = []
    try:
        for key, value in item.items():
            try:
                given |= table({key: value}, where, _READERS, ())
            except InputError as error:
                problems.extend(error.problems or (error,))
        if missing := [key for key in REQUIRED if key not in item]:
            problems.append(InputError(where, f"lacks: {', '.join(missing)}"))
        if problems:
            raise together(problems)
        if "run_in_end" in given:
            given["run_in_axis"], given["run_in_end"] = given["run_in_end"]
        return build(FrictionTest, given, where)
    except InputError as error:
        found = []
        for problem in error.problems or (error,):
            key = problem.path.removeprefix(where).lstrip(".").partition(",")[0]
            line = file.lines.get(f"test.{number}.{key}")
            rest = problem.path.partition(": ")[2]
            found.append(problem if line is None else problem.at(f"{file.label}, line {line}: {rest}"))
        raise together(found) from None


def _twice(tests: Sequence[FrictionTest], file: _Places) -> Iterator[InputError]:
    """Refuse the same log twice, under whatever name: it would count as a repeated test."""
    known: dict[str, int] = {}
    for number, test in enumerate(tests):
        if test.checksum is None:
            continue
        first = known.setdefault(test.checksum, number)
        sources = [tests[first].source or "", test.source or ""]
        of_one_log = sources[0] != sources[1] and len({one.partition(",")[0] for one in sources}) == 1
        if first != number and not of_one_log:
            where = f"{file.of(f'test.{number}.checksum', f'test.{number}')}: [[test]].checksum"
            cure = "Each log counts once; remove one of the two."
            yield InputError(where, f"is that of test {first + 1} once more", cure=cure)


def _alike(tests: Sequence[FrictionTest], file: _Places) -> Iterator[InputError]:
    """Refuse one name in two spellings: its tests would be those of two materials, or two environments."""
    known: dict[tuple[str, str], tuple[str, int]] = {}
    for number, test in enumerate(tests):
        for key in NAMES:
            name = getattr(test, key)
            spelled, first = known.setdefault((key, " ".join(name.casefold().split())), (name, number))
            if spelled != name:
                where = f"{file.of(f'test.{number}.{key}', f'test.{number}')}: [[test]].{key}"
                rule = f"differs from that of test {first + 1} only in capitals or spaces"
                cure = f"Write both alike, for instance {shown(spelled)}."
                yield InputError(where, rule, shown(name), cure)


def _interval(unit: str) -> Reader[tuple[float, float]]:
    """Read one quantity, or a list of the lowest and the highest."""

    def read(value: Any, where: str) -> tuple[float, float]:
        if not isinstance(value, list):
            single = parse(value, unit, where)
            return single, single
        if len(value) != 2:
            raise InputError(where, "must be one quantity, or [lowest, highest]", f"{len(value)} of them")
        low, high = list_of(quantity(unit))(value, where)
        return low, high

    return read


_READERS: dict[str, Reader[object]] = {
    "material": text,
    "counterface": text,
    "medium": text,
    "friction": ratio,
    "standard_error": ratio,
    "standard_deviation": ratio,
    "effective_count": ratio,
    "temperature": _interval("K"),
    "slip_speed": _interval("m/s"),
    "pressure": _interval("Pa"),
    "sample": text,
    "test": text,
    "run_in_end": place,
    "flags": list_of(text),
    "source": text,
    "checksum": text,
    "reduced_by": text,
}
"""How each key of a test is read, in the order in which they are written: the contract of a friction file."""

_WRITTEN = {"slip_speed": (1.0, "m/s"), "pressure": (1e6, "MPa"), "temperature": (1.0, "K")}
"""Size and name of the unit in which a condition is written."""


def exists_already(path: Path) -> InputError:
    """Refusal to overwrite."""
    cure = "It may hold numbers that a person wrote: name a new file, or remove it first."
    return InputError(f"--out {path}", "exists already, and was not touched", cure=cure)


def friction_text(tests: Sequence[FrictionTest]) -> str:
    """Content of a friction file that a person can read and change."""
    return "\n".join([HEADER, *("\n".join(["[[test]]", *_lines(test), ""]) for test in tests)])


def _lines(test: FrictionTest) -> Iterator[str]:
    for name in _READERS:
        value = getattr(test, name)
        if value is None or value == ():
            continue
        if name in _WRITTEN:
            low, high = (_text(f"{_scaled(one, name)} {_WRITTEN[name][1]}") for one in value)
            value = low if low == high else f"[{low}, {high}]"
        elif name == "run_in_end":
            if test.run_in_axis is None:
                continue
            value = _text(f"{float(value)!r} {UNITS[test.run_in_axis]}")
        elif name == "flags":
            value = f"[{', '.join(map(_text, value))}]"
        else:
            value = _text(value) if isinstance(value, str) else repr(float(value))
        yield f"{name} = {value}"


def _text(value: str) -> str:
    """Basic string of TOML: JSON's escapes are among its own."""
    return json.dumps(value, ensure_ascii=False)


def _scaled(value: float, name: str) -> str:
    """Value in the unit written, in exact decimal arithmetic: read back it is the same float."""
    exact = Decimal(repr(value)) / Decimal(_WRITTEN[name][0])
    plain = f"{exact.normalize():f}"
    return plain if len(plain) <= 24 else f"{exact:e}"
