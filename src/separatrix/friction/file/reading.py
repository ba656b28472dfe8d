"""Read a friction file: TOML, one [[test]] for each test, every dimensional value as text with its unit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, together
from separatrix.friction.fit import FrictionTest
from separatrix.friction.fit.records import NAMES
from separatrix.toml_text import Kind, label_of, read_toml
from separatrix.toml_values import Reader, build, list_of, nearest, quantity, ratio, table, text
from separatrix.units import parse, printable, shown

MOST_TESTS = 10_000
MOST_PROBLEMS = 100
KIND = Kind(
    noun="a friction file",
    most_bytes=8 * 1024 * 1024,
    empty="`separatrix tribometer FILES --out friction.toml` makes one from logs.",
)
REQUIRED = (*NAMES, "friction")
AXES = {"time": "s", "distance": "m", "cycles": "cycles"}
"""What running-in may be counted in, and the unit in which it is written."""

_CYCLES = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]+)?)\s*cycles?\s*")
_EXAMPLE = 'Write [[test]], and under it material = "Armalon" and so on.'


def read_friction(path: Path) -> tuple[FrictionTest, ...]:
    """Tests of a friction file, in its order.

    Raises
    ------
    InputError
        Everything that is wrong with it, a line each: place, rule, value, cure.
    """
    data, lines = read_toml(path, KIND)
    label = label_of(path)
    items = _items(data, lines, label)
    tests: list[FrictionTest] = []
    problems: list[InputError] = []
    for number, item in enumerate(items):
        place = _place(lines, label, f"test.{number}", "test")
        try:
            tests.append(_test(item, f"{place}: [[test]]", number, lines, label))
        except InputError as error:
            problems.extend(error.problems or (error,))
        if len(problems) > MOST_PROBLEMS:
            break
    if not problems:
        problems.extend([*_twice(tests, lines, label), *_alike(tests, lines, label)])
    if problems:
        raise together(problems)
    return tuple(tests)


def _items(data: Mapping[str, Any], lines: Mapping[str, int], label: str) -> list[Any]:
    for key in data:
        if key not in ("title", "test"):
            place = _place(lines, label, key, f"{key}.0")
            known = nearest(key, ("title", "test"))
            raise InputError(f"{place}: {printable(key)}", "is no key of a friction file", cure=known)
    if "title" in data:
        text(data["title"], f"{_place(lines, label, 'title')}: title")
    items = data.get("test")
    if items is None:
        raise InputError(label, "holds no test", cure=_EXAMPLE)
    if not isinstance(items, list) or not 0 < len(items) <= MOST_TESTS:
        place = _place(lines, label, "test", "test.0")
        got = f"{len(items)} tests" if isinstance(items, list) else shown(items)
        raise InputError(f"{place}: test", f"must be 1 to {MOST_TESTS} tables", got, _EXAMPLE)
    return items


def _test(item: Any, where: str, number: int, lines: Mapping[str, int], label: str) -> FrictionTest:
    """One test; what its record or its readers refuse is given the line of its key."""
    if not isinstance(item, dict):
        raise InputError(where, "must be a table", shown(item), _EXAMPLE)
    try:
        given = _all_keys(item, where)
        if "run_in_end" in given:
            given["run_in_axis"], given["run_in_end"] = given["run_in_end"]
        return build(FrictionTest, given, where)
    except InputError as error:
        problems = error.problems or (error,)
        raise together([_at_its_line(p, where, number, lines, label) for p in problems]) from None


def _all_keys(item: dict[str, Any], where: str) -> dict[str, Any]:
    """Every key read; everything wrong at once."""
    given: dict[str, Any] = {}
    problems: list[InputError] = []
    for key, value in item.items():
        try:
            given |= table({key: value}, where, _READERS, ())
        except InputError as error:
            problems.extend(error.problems or (error,))
    if missing := [key for key in REQUIRED if key not in item]:
        problems.append(InputError(where, f"lacks: {', '.join(missing)}"))
    if problems:
        raise together(problems)
    return given


def _at_its_line(
    problem: InputError, where: str, number: int, lines: Mapping[str, int], label: str
) -> InputError:
    key = problem.path.removeprefix(where).lstrip(".").partition(",")[0]
    line = lines.get(f"test.{number}.{key}")
    at = problem.path if line is None else f"{label}, line {line}: {problem.path.partition(': ')[2]}"
    return problem.at(at)


def _place(lines: Mapping[str, int], label: str, *keys: str) -> str:
    line = next((lines[key] for key in keys if key in lines), None)
    return label if line is None else f"{label}, line {line}"


def _twice(tests: list[FrictionTest], lines: Mapping[str, int], label: str) -> Iterator[InputError]:
    """Refuse the same log twice, under whatever name: it would count as a repeated test."""
    known: dict[str, int] = {}
    for number, test in enumerate(tests):
        if test.checksum is None:
            continue
        first = known.setdefault(test.checksum, number)
        if first != number and not _parts_of_one(tests[first].source, test.source):
            place = _place(lines, label, f"test.{number}.checksum", f"test.{number}")
            rule = f"is that of test {first + 1} once more"
            yield InputError(
                f"{place}: [[test]].checksum", rule, cure="Each log counts once; remove one of the two."
            )


def _parts_of_one(first: str | None, second: str | None) -> bool:
    """Whether two sources are different tests of one log: ``"a.csv, step 1"`` and ``"a.csv, step 2"``."""
    files = {(source or "").partition(",")[0] for source in (first, second)}
    return first != second and len(files) == 1


def _alike(tests: list[FrictionTest], lines: Mapping[str, int], label: str) -> Iterator[InputError]:
    """Refuse one name in two spellings: its tests would be those of two materials, or two environments."""
    known: dict[tuple[str, str], tuple[str, int]] = {}
    for number, test in enumerate(tests):
        for key in NAMES:
            name = getattr(test, key)
            spelled, first = known.setdefault((key, " ".join(name.casefold().split())), (name, number))
            if spelled != name:
                place = _place(lines, label, f"test.{number}.{key}", f"test.{number}")
                rule = f"differs from that of test {first + 1} only in capitals or spaces"
                cure = f"Write both alike, for instance {shown(spelled)}."
                yield InputError(f"{place}: [[test]].{key}", rule, shown(name), cure)


def _interval(unit: str) -> Reader:
    """Read one quantity, or a list of the lowest and the highest."""

    def read(value: Any, where: str) -> tuple[float, float]:
        if not isinstance(value, list):
            single = parse(value, unit, where)
            return single, single
        if len(value) != 2:
            rule = "must be one quantity, or [lowest, highest]"
            raise InputError(where, rule, f"{len(value)} of them")
        low, high = list_of(quantity(unit))(value, where)
        return low, high

    return read


def run_in_end(value: Any, where: str) -> tuple[str, float]:
    """Read where running-in ends, and its axis: ``"120 s"``, ``"35 m"`` or ``"500 cycles"``."""
    if not isinstance(value, str):
        rule = "must be a time, a distance or a number of cycles, as text"
        raise InputError(where, rule, shown(value), 'Write it like "35 m".')
    if found := _CYCLES.fullmatch(value):
        return "cycles", float(found.group(1))
    try:
        return "time", parse(value, "s", where)
    except InputError:
        pass
    try:
        return "distance", parse(value, "m", where)
    except InputError:
        rule = "must be a time, a distance or a number of cycles"
        cure = 'Write it like "120 s", "35 m" or "500 cycles".'
        raise InputError(where, rule, shown(value), cure) from None


_READERS: dict[str, Reader] = {
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
    "run_in_end": run_in_end,
    "flags": list_of(text),
    "source": text,
    "checksum": text,
    "reduced_by": text,
}
"""How each key of a test is read: the contract of a friction file."""
