"""A friction test, and friction files: tests as a person or the verb `tribometer` writes them.

The files are TOML, one [[test]] for each test, every dimensional value as text with its unit
(docs/reference/friction-file.md).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal
from typing import ClassVar, NamedTuple

from separatrix.ground import units
from separatrix.ground.errors import InputError
from separatrix.ground.schema import (
    Fault,
    Faults,
    between,
    check,
    key,
    keys_of,
    not_negative,
    positive,
    record,
)
from separatrix.ground.toml import Kind, as_toml
from separatrix.ground.units import (
    Kelvin,
    MetrePerSecond,
    Pascal,
    Ratio,
    format_number,
    format_quantity,
    shown,
)

FRICTION_LIMIT = 2.0
LEAST_FRICTION = 1e-5
"""The least that is a measurement: of frictions that scatter the logarithm is taken."""

UNITS = {"time": "s", "distance": "m", "cycles": "cycles"}
"""The abscissae, of which a log has at least one, and the unit in which a friction file writes each."""

_CYCLES = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]{1,2})?)\s*cycles?\s*")


class Place(NamedTuple):
    """A place along an abscissa: time [s], distance [m] or cycles."""

    axis: str
    value: float


def place(value: object, where: str) -> Place:
    """Read a place along an abscissa from a text such as ``"200 m"``, ``"10 min"`` or ``"500 cycles"``.

    Examples
    --------
    >>> place("10 min", ""), place("200 m", ""), place("500 cycles", "")
    (Place(axis='time', value=600.0), Place(axis='distance', value=200.0), Place(axis='cycles', value=500.0))
    """
    text = value if isinstance(value, str) and len(value) <= units.LONGEST else ""
    if found := _CYCLES.fullmatch(text):
        return Place("cycles", float(found.group(1)))
    spelling = re.sub(r"^[^A-Za-z]*(?:[eE][-+]?[0-9]+)? ?", "", text.strip())
    axis = next((axis for axis in ("time", "distance") if spelling in units.UNITS[UNITS[axis]]), None)
    if axis is None:
        rule = "must be a time, a distance or a number of cycles with its unit"
        raise InputError(where, rule, units.shown(value), 'Write it like "10 min", "200 m" or "500 cycles".')
    found_place = units.parse(text, UNITS[axis], where)
    if found_place < 0.0:
        raise InputError(where, "must not be negative", units.shown(value))
    return Place(axis, found_place)


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
NAMES = ("material", "counterface", "medium")  # what a test must state: what slid on what, in what
LONGEST_FLAG = 500  # characters of a flag, for the reduction, the writer and the reader


@record
class FrictionTest:
    """Steady friction of one test, with its scatter and its conditions as far as known.

    The conditions are the lowest and the highest during the test, or over the tests behind a printed mean;
    None if unknown.
    """

    material: str = key()
    """Of the cage."""

    counterface: str = key()
    """Of the ball or race that it slid on."""

    medium: str = key()
    """The gas or liquid around."""

    friction: Ratio = key(
        positive(LEAST_FRICTION, FRICTION_LIMIT), hint="Its logarithm is fitted; 8 % is 0.08."
    )
    """Steady mean."""

    standard_error: Ratio | None = key(not_negative(FRICTION_LIMIT), default=None)
    """Of that mean."""

    standard_deviation: Ratio | None = key(not_negative(FRICTION_LIMIT), default=None)
    """Of the means of whole cycles within the test."""

    effective_count: Ratio | None = key(positive(1e-3, 1e12), default=None)
    """Independent values that the standard error rests on."""

    temperature: tuple[Kelvin, Kelvin] | None = key(between(0.1, 3000.0), default=None)
    slip_speed: tuple[MetrePerSecond, MetrePerSecond] | None = key(between(1e-9, 1e3), default=None)
    pressure: tuple[Pascal, Pascal] | None = key(between(1e-3, 1e12), default=None)
    """Mean contact pressure."""

    sample: str | None = key(default=None, without="a specimen of its own")
    """Tests of one specimen share its deviation."""

    test: str | None = key(default=None)
    run_in_end: Place | None = key(default=None, read=lambda value, *_: place(value, ""))
    """Where the steady part begins."""

    flags: tuple[str, ...] = key(default=(), letters=(1, LONGEST_FLAG))
    source: str | None = key(default=None)
    checksum: str | None = key(default=None)
    reduced_by: str | None = key(default=None)

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


@check(FrictionTest)
def _names_are_plain(material: str | None, counterface: str | None, medium: str | None) -> Faults:
    """With a space around it a name would be another that looks the same; the medium ends at a comma."""
    for name, value in zip(NAMES, (material, counterface, medium), strict=True):
        if value is not None and value != value.strip():
            yield Fault(name, "must not begin or end with a space")
    if medium is not None and "," in medium:
        yield Fault("medium", "must not hold a comma", 'An environment is named "medium, counterface".')


@record
class FrictionFile:
    """The keys of a friction file."""

    FILE: ClassVar = Kind(
        noun="a friction file",
        most_bytes=8 * 1024 * 1024,
        empty="`separatrix tribometer FILES --out friction.toml` makes one from logs.",
    )

    title: str | None = key(default=None)
    test: tuple[FrictionTest, ...] = key(
        length=(1, 10_000), hint='Write [[test]], and under it material = "Armalon" and so on.'
    )


@check(FrictionFile)
def _each_log_once(test: Sequence[FrictionTest]) -> Faults:
    """Refuse the same log twice, under whatever name: it would count as a repeated test."""
    known: dict[str, int] = {}
    for number, one in enumerate(test):
        if one.checksum is None:
            continue
        first = known.setdefault(one.checksum, number)
        sources = [test[first].source or "", one.source or ""]
        of_one_log = sources[0] != sources[1] and len({source.partition(",")[0] for source in sources}) == 1
        if first != number and not of_one_log:
            rule, cure = (
                f"is that of test {first + 1} once more",
                "Each log counts once; remove one of the two.",
            )
            yield Fault(("test", number, "checksum"), rule, cure, "")


@check(FrictionFile)
def _one_spelling_each(test: Sequence[FrictionTest]) -> Faults:
    """Refuse one name in two spellings: its tests would be those of two materials, or two environments."""
    known: dict[tuple[str, str], tuple[str, int]] = {}
    for number, one in enumerate(test):
        for name in NAMES:
            value = getattr(one, name)
            spelled, first = known.setdefault((name, " ".join(value.casefold().split())), (value, number))
            if spelled != value:
                rule = f"differs from that of test {first + 1} only in capitals or spaces"
                yield Fault(("test", number, name), rule, f"Write both alike, for instance {shown(spelled)}.")


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


_WRITTEN = {"slip_speed": (1.0, "m/s"), "pressure": (1e6, "MPa"), "temperature": (1.0, "K")}
"""Size and name of the unit in which a condition is written."""


def friction_text(tests: Sequence[FrictionTest]) -> str:
    """Content of a friction file that a person can read and change."""
    return "\n".join([HEADER, *("\n".join(["[[test]]", *_lines(test), ""]) for test in tests)])


def _lines(test: FrictionTest) -> Iterator[str]:
    for name in keys_of(FrictionTest):
        value = getattr(test, name)
        if value is None or value == ():
            continue
        if name in _WRITTEN:
            low, high = (f"{_scaled(one, name)} {_WRITTEN[name][1]}" for one in value)
            value = low if low == high else [low, high]
        elif isinstance(value, Place):
            value = f"{float(value.value)!r} {UNITS[value.axis]}"
        elif not isinstance(value, str | tuple):
            value = float(value)
        yield f"{name} = {as_toml(value)}"


def _scaled(value: float, name: str) -> str:
    """Value in the unit written, in exact decimal arithmetic: read back it is the same float."""
    exact = Decimal(repr(value)) / Decimal(_WRITTEN[name][0])
    plain = f"{exact.normalize():f}"
    return plain if len(plain) <= 24 else f"{exact:e}"
