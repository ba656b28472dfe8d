"""A friction test as a fit takes it, and its conditions; places along a test."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from separatrix import _check, units
from separatrix.errors import InputError
from separatrix.measured_friction import FRICTION_LIMIT, LEAST_FRICTION
from separatrix.units import Kelvin, MetrePerSecond, Pascal, Ratio, format_number, format_quantity, shown

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


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTest:
    """Steady friction of one test, with what is known of its scatter and of its conditions.

    The conditions are the lowest and the highest during the test, or over the tests behind a printed mean;
    what is not known is None.
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
