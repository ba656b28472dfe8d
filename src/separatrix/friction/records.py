"""A friction test as a fit takes it, its conditions, the friction that tests predict; places along a test."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from separatrix import _check, units
from separatrix.errors import InputError
from separatrix.measured_friction import FRICTION_LIMIT, LEAST_FRICTION
from separatrix.units import Kelvin, MetrePerSecond, Pascal, Ratio, format_number, format_quantity, shown

UNITS = {"time": "s", "distance": "m", "cycles": "cycles"}
"""The abscissae, of which a log has at least one, and the unit in which a friction file writes each."""

_CYCLES = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]{1,2})?)\s*cycles?\s*")


def place(value: Any, where: str) -> tuple[str, float]:
    """Read abscissa and place from a text such as ``"200 m"``, ``"10 min"`` or ``"500 cycles"``.

    Raises
    ------
    InputError
        It is none of these.

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

    Attributes
    ----------
    material, counterface, medium : str
        Of the cage, of the ball or race it slid on, and the gas or liquid around.
    friction : float
        Steady mean [-].
    standard_error, standard_deviation : float or None
        Of that mean, and of the whole-cycle means within the test [-]; None where not known.
    effective_count : float or None
        How many independent values the standard error rests on.
    temperature, slip_speed, pressure : tuple of float or None
        Lowest and highest during the test, or over the tests behind a printed mean [K, m/s, Pa];
        None where not known. The pressure is the mean contact pressure.
    sample : str or None
        Of which specimen; tests of one sample share its deviation. None: one of its own.
    run_in_end, run_in_axis : float and str, or None
        Where the steady part begins, and of what: time [s], distance [m] or cycles.
    """

    material: str
    counterface: str
    medium: str
    friction: Ratio
    standard_error: Ratio | None = None
    standard_deviation: Ratio | None = None
    effective_count: float | None = None
    temperature: tuple[Kelvin, Kelvin] | None = None
    slip_speed: tuple[MetrePerSecond, MetrePerSecond] | None = None
    pressure: tuple[Pascal, Pascal] | None = None
    sample: str | None = None
    test: str | None = None
    run_in_end: float | None = None
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Friction that the tests predict for stated conditions: log-normal about `mean`.

    Attributes
    ----------
    mean : float
        The material's friction, its median [-].
    standard_error : float
        How well that mean is known from the tests [-].
    standard_deviation : float
        Scatter of a new sample about it, widened where the conditions were not tested [-].
    extrapolation : tuple of str
        In what respect the conditions were not tested, in words; empty where they were.
    widening : float
        What the conditions not tested add to the standard deviation, in quadrature [-].
    assumed_scatter : bool
        Whether no repeated test of this material in this environment shows the scatter.
    """

    mean: Ratio
    standard_error: Ratio
    standard_deviation: Ratio
    extrapolation: tuple[str, ...] = ()
    widening: Ratio = 0.0
    assumed_scatter: bool = False

    @property
    def next_cage(self) -> Ratio:
        """Standard deviation of the friction of the next cage: of the mean and of a new sample together."""
        total: Ratio = (self.standard_error**2 + self.standard_deviation**2) ** 0.5
        return total
