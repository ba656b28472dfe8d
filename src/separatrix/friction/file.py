"""A friction test, and friction files: tests as a person or the verb `tribometer` writes them.

The files are TOML, one [[test]] for each test, every dimensional value as text with its unit
(docs/reference/friction-file.md).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import partial
from pathlib import Path

from separatrix.friction.prediction import FRICTION_LIMIT, LEAST_FRICTION
from separatrix.ground import bounds as _check
from separatrix.ground import units
from separatrix.ground.errors import InputError, together
from separatrix.ground.toml import (
    Kind,
    Places,
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
from separatrix.ground.units import (
    Kelvin,
    MetrePerSecond,
    Pascal,
    Ratio,
    format_number,
    format_quantity,
    printable,
    shown,
)

UNITS = {"time": "s", "distance": "m", "cycles": "cycles"}
"""The abscissae, of which a log has at least one, and the unit in which a friction file writes each."""

_CYCLES = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]{1,2})?)\s*cycles?\s*")


def place(value: object, where: str) -> tuple[str, float]:
    """Read abscissa and place from a text such as ``"200 m"``, ``"10 min"`` or ``"500 cycles"``.

    Examples
    --------
    >>> place("10 min", ""), place("200 m", ""), place("500 cycles", "")
    (('time', 600.0), ('distance', 200.0), ('cycles', 500.0))
    """
    text = value if isinstance(value, str) and len(value) <= units.LONGEST else ""
    if found := _CYCLES.fullmatch(text):
        return "cycles", float(found.group(1))
    spelling = re.sub(r"^[^A-Za-z]*(?:[eE][-+]?[0-9]+)? ?", "", text.strip())
    axis = next((axis for axis in ("time", "distance") if spelling in units.UNITS[UNITS[axis]]), None)
    if axis is None:
        rule = "must be a time, a distance or a number of cycles with its unit"
        raise InputError(where, rule, units.shown(value), 'Write it like "10 min", "200 m" or "500 cycles".')
    found_place = units.parse(text, UNITS[axis], where)
    if found_place < 0.0:
        raise InputError(where, "must not be negative", units.shown(value))
    return axis, found_place


def in_words(value: float, axis: str) -> str:
    """Return a place along an abscissa as text: ``"12.5 min"``, ``"1.2 km"``, ``"500 cycles"``."""
    if axis == "cycles":
        return f"{format_number(value)} cycles"
    if axis == "distance":
        return f"{format_number(value / 1e3)} km" if value >= 1e4 else format_quantity(value, "m")
    for size, name in ((3600.0, "h"), (60.0, "min")):
        if value >= 3.0 * size:
            return f"{format_number(value / size)} {name}"
    return format_quantity(value, "s")


CONDITIONS = {"temperature": "K", "slip_speed": "m/s", "pressure": "Pa"}
"""What friction may depend on, and the SI unit."""

PRODUCT = "pressure_velocity"
WORDS = {"temperature": "temperature", "slip_speed": "slip speed", "pressure": "pressure", PRODUCT: "pV"}
_LIMITS = {"temperature": (0.1, 3000.0), "slip_speed": (1e-9, 1e3), "pressure": (1e-3, 1e12)}
NAMES = ("material", "counterface", "medium")  # what a test must state: what slid on what, in what
_TEXTS = (*NAMES, "sample", "test", "source", "checksum", "reduced_by")
LONGEST_FLAG = 500  # characters of a flag, for the reduction, the writer and the reader


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTest:
    """Steady friction of one test, with its scatter and its conditions as far as known.

    The conditions are the lowest and the highest during the test, or over the tests behind a printed mean;
    None if unknown.
    """

    material: str  # of the cage
    counterface: str  # of the ball or race that it slid on
    medium: str  # the gas or liquid around
    friction: Ratio  # steady mean
    standard_error: Ratio | None = None  # of that mean
    standard_deviation: Ratio | None = None  # of the means of whole cycles within the test
    effective_count: float | None = None  # independent values that the standard error rests on
    temperature: tuple[Kelvin, Kelvin] | None = None
    slip_speed: tuple[MetrePerSecond, MetrePerSecond] | None = None
    pressure: tuple[Pascal, Pascal] | None = None  # mean contact pressure
    sample: str | None = None  # tests of one specimen share its deviation; None: one of its own
    test: str | None = None
    run_in_end: float | None = None  # where the steady part begins: time [s], distance [m] or cycles
    run_in_axis: str | None = None
    flags: tuple[str, ...] = ()
    source: str | None = None
    checksum: str | None = None
    reduced_by: str | None = None

    def __post_init__(self) -> None:
        logarithm = "Its logarithm is fitted; 8 % is 0.08."
        _check.settle(
            *(_check.printable_text(self, name) for name in _TEXTS),
            _plain_names(self),
            _check.positive(self, "friction", LEAST_FRICTION, FRICTION_LIMIT, hint=logarithm),
            _check.not_negative(self, "standard_error", FRICTION_LIMIT),
            _check.not_negative(self, "standard_deviation", FRICTION_LIMIT),
            _check.positive(self, "effective_count", 1e-3, 1e12),
            *(_range(self, name, *limits) for name, limits in _LIMITS.items()),
            _short_flags(self),
        )

    @property
    def environment(self) -> str:
        """Medium and counterface, as friction tables name them."""
        return f"{self.medium}, {self.counterface}"

    @property
    def pressure_velocity(self) -> tuple[float, float] | None:
        """Product pV of mean pressure and slip speed, lowest and highest [Pa m/s]; None where not known."""
        if self.pressure is None or self.slip_speed is None:
            return None
        return self.pressure[0] * self.slip_speed[0], self.pressure[1] * self.slip_speed[1]


def _plain_names(test: FrictionTest) -> Iterator[InputError]:
    """With a space around it a name would be another that looks the same; the medium ends at a comma."""
    for name in NAMES:
        value = getattr(test, name)
        if isinstance(value, str) and value != value.strip():
            yield InputError(f"FrictionTest.{name}", "must not begin or end with a space", shown(value))
    if isinstance(test.medium, str) and "," in test.medium:
        cure = 'An environment is named "medium, counterface".'
        yield InputError("FrictionTest.medium", "must not hold a comma", shown(test.medium), cure)


def _short_flags(test: FrictionTest) -> Iterator[InputError]:
    for flag in test.flags:
        if not 0 < len(flag.strip()) <= LONGEST_FLAG or not flag.isprintable():
            rule = f"must be printable texts of 1 to {LONGEST_FLAG} characters"
            yield InputError("FrictionTest.flags", rule, shown(flag))


def _range(test: FrictionTest, name: str, low: float, high: float) -> Iterator[InputError]:
    value, where, unit = getattr(test, name), f"FrictionTest.{name}", CONDITIONS[name]
    if value is None:
        return
    if not isinstance(value, tuple) or len(value) != 2:
        yield InputError(where, "must be a lowest and a highest value", shown(value))
    elif outside := [x for x in value if not (_check.is_number(x) and low <= x <= high)]:
        rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
        got = outside[0]
        yield InputError(where, rule, format_quantity(got, unit) if got == got else "nan")
    elif value[0] > value[1]:
        rule = "must name the lowest first"
        yield InputError(where, rule, " before ".join(format_quantity(x, unit) for x in value))


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
    file = Places(label_of(path), {key: f"{label_of(path)}, line {line}" for key, line in lines.items()})
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


def _items(data: Mapping[str, object], file: Places) -> list[object]:
    for key in data:
        if key not in ("title", "test"):
            where = f"{file.of(f'{key}.0')}: {printable(key)}"
            raise InputError(where, "is not a key of a friction file", cure=nearest(key, ("title", "test")))
    if "title" in data:
        text(data["title"], f"{file.of('title')}: title")
    items = data.get("test")
    if items is None:
        raise InputError(file.label, "holds no test", cure=_EXAMPLE)
    if not isinstance(items, list) or not 0 < len(items) <= MOST_TESTS:
        got = f"{len(items)} tests" if isinstance(items, list) else shown(items)
        where = f"{file.of('test.0')}: test"
        raise InputError(where, f"must be 1 to {MOST_TESTS} tables", got, _EXAMPLE)
    return items


def _test(item: object, number: int, file: Places) -> FrictionTest:
    """One test; what its record or its readers refuse has the line of its key."""
    where = f"test.{number}"
    try:
        given = table(item, where, _READERS, REQUIRED)
        if isinstance(end := given.get("run_in_end"), tuple):
            given["run_in_axis"], given["run_in_end"] = end
        return build(FrictionTest, given, where)
    except InputError as error:
        found = error.problems or (error,)
        parts = [(one, one.path.removeprefix(where)) for one in found]
        raise together([one.at(f"{file.of(one.path)}: [[test]]{rest}") for one, rest in parts]) from None


def _twice(tests: Sequence[FrictionTest], file: Places) -> Iterator[InputError]:
    """Refuse the same log twice, under whatever name: it would count as a repeated test."""
    known: dict[str, int] = {}
    for number, test in enumerate(tests):
        if test.checksum is None:
            continue
        first = known.setdefault(test.checksum, number)
        sources = [tests[first].source or "", test.source or ""]
        of_one_log = sources[0] != sources[1] and len({one.partition(",")[0] for one in sources}) == 1
        if first != number and not of_one_log:
            where = f"{file.of(f'test.{number}.checksum')}: [[test]].checksum"
            cure = "Each log counts once; remove one of the two."
            yield InputError(where, f"is that of test {first + 1} once more", cure=cure)


def _alike(tests: Sequence[FrictionTest], file: Places) -> Iterator[InputError]:
    """Refuse one name in two spellings: its tests would be those of two materials, or two environments."""
    known: dict[tuple[str, str], tuple[str, int]] = {}
    for number, test in enumerate(tests):
        for key in NAMES:
            name = getattr(test, key)
            spelled, first = known.setdefault((key, " ".join(name.casefold().split())), (name, number))
            if spelled != name:
                where = f"{file.of(f'test.{number}.{key}')}: [[test]].{key}"
                rule = f"differs from that of test {first + 1} only in capitals or spaces"
                cure = f"Write both alike, for instance {shown(spelled)}."
                yield InputError(where, rule, shown(name), cure)


def _interval(unit: str) -> Reader[tuple[float, float]]:
    """Read one quantity, or a list of the lowest and the highest."""

    def read(value: object, where: str) -> tuple[float, float]:
        if not isinstance(value, list):
            single = quantity(unit)(value, where)
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
    "flags": list_of(partial(text, longest=LONGEST_FLAG)),
    "source": text,
    "checksum": text,
    "reduced_by": text,
}
"""How each key of a test is read, in the order in which they are written: the contract of a friction file."""

_WRITTEN = {"slip_speed": (1.0, "m/s"), "pressure": (1e6, "MPa"), "temperature": (1.0, "K")}
"""Size and name of the unit in which a condition is written."""


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
