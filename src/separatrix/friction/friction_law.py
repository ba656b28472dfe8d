"""Friction of one material in one environment over its conditions, as a candidate of a study carries it.

Outside the tests friction stays that of the nearest tested condition; slopes are not extrapolated. The
scatter is widened by what a power law of a plausible exponent could do: exponent times ln(condition / nearest
tested). Nothing here imports numpy: a study is read without fitting anything.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import hypot, log, sqrt
from statistics import correlation
from typing import ClassVar, Protocol, TypedDict, Unpack

from separatrix.friction.friction_file import (
    CONDITIONS,
    FRICTION_LIMIT,
    LEAST_FRICTION,
    PRODUCT,
    WORDS,
    FrictionTest,
)
from separatrix.ground.schema import between, key, not_negative, record
from separatrix.ground.units import Kelvin, MetrePerSecond, Pascal, Ratio, format_quantity


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Friction that tests predict for stated conditions: log-normal about `mean`."""

    mean: Ratio  # the material's friction, its median
    standard_error: Ratio  # how well that mean is known from the tests
    standard_deviation: Ratio  # of a new sample about it, widened where the conditions were not tested
    extrapolation: tuple[str, ...] = ()  # in what respect the conditions were not tested, in words
    widening: Ratio = 0.0  # what these add to the standard deviation, in quadrature
    assumed_scatter: bool = False  # whether no repeated test shows the scatter


class Asked(TypedDict, total=False):
    """Conditions for which a friction is predicted; one that is None or left out is not known."""

    slip_speed: MetrePerSecond | None
    pressure: Pascal | None
    temperature: Kelvin | None
    medium: str | Sequence[str] | None
    """By one name, or by all its names: a test under any of them was run in it."""


class FrictionLaw(Protocol):
    """Friction as a function of the conditions, from tests, as `friction_fit.TestedFriction`."""

    def at(self, **asked: Unpack[Asked]) -> Prediction:
        """Friction for these conditions."""


GIVEN = "given in the study"


@record
class Friction:
    """A measured ball/cage friction: its mean and, if known, its scatter.

    `standard_deviation` is that of single tests or samples; `standard_error` that of the mean, where it is
    not the former over the root of `count`. `law` is what knows more: friction over the conditions.
    `extrapolation` says in words in what respect a friction was asked for where nothing was tested;
    `widening` is the part of the standard deviation that stands for it.
    """

    SHORT: ClassVar = "mean"

    mean: Ratio = key(between(0.0, FRICTION_LIMIT), certain=True, example="0.12")
    standard_deviation: Ratio | None = key(not_negative(FRICTION_LIMIT), default=None, certain=True)
    count: int | None = key(between(1, 1e9), default=None, certain=True)
    source: str = key(default=GIVEN, letters=(1, 2000))
    standard_error: Ratio | None = None
    assumed_scatter: bool = False
    extrapolation: tuple[str, ...] = ()
    widening: Ratio = 0.0
    law: FrictionLaw | None = field(default=None, compare=False, repr=False)
    confidence: str = GIVEN


SCATTER_RULE = f"must be >= {LEAST_FRICTION:g} where there is a standard deviation [-]"
SCATTER_CURE = "A friction of 0 does not scatter: give its mean, or { between = [..., ...] }."


LEAST_SPAN = 1.2
"""Ratio of the largest to the smallest value from which tests span a condition; nearer than that
tests were run at one temperature."""

TOGETHER = 0.95  # correlation of ln speed and ln pressure from which their slopes cannot be separated
Range = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Covariates:
    """Names of the slopes of a group, their centres, and notes on those that it lacks.

    A slope is on ln(slip_speed), ln(pressure) or, where these went together, ln(pressure_velocity), each
    counted from its `centres`, the mean over the tests.
    """

    names: tuple[str, ...] = ()
    centres: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()

    def row(self, values: dict[str, float]) -> list[float]:
        """Row of the design: 1, and the logarithm of each condition over its centre."""
        return [1.0, *(log(values[n]) - c for n, c in zip(self.names, self.centres, strict=True))]


def covariates(tests: Sequence[FrictionTest]) -> Covariates:
    """Slopes that these tests can show: all state the condition and span it, and a test is left over."""
    notes = []
    for name in ("slip_speed", "pressure"):
        missing = sum(getattr(test, name) is None for test in tests)
        if 0 < missing < len(tests):
            notes.append(f"{WORDS[name]} is not stated for {missing} of {len(tests)} tests: no slope on it")
    if _spread(tests, "temperature") >= log(LEAST_SPAN):
        span = in_words(tested_range(tests, "temperature") or (0.0, 0.0), "K")
        note = f"tests from {span} are taken together here; a study takes those nearest its temperature"
        notes.append(note)
    spanned = [name for name in ("slip_speed", "pressure") if _spans(tests, name)]
    logs = [[centre(getattr(test, name)) for test in tests] for name in spanned]
    along = correlation(*logs) if len(spanned) == 2 else 0.0
    if along > TOGETHER:
        spanned = [PRODUCT]
        notes.append("slip speed and pressure went together: slope on their product pV")
    elif along < -TOGETHER:
        spanned = ["slip_speed"]
        notes.append("pressure fell as slip speed rose: slope on slip speed, for both")
    if len(tests) < len(spanned) + 2 and len(spanned) == 2 and _spans(tests, PRODUCT):
        spanned = [PRODUCT]
        notes.append("too few tests for two slopes: slope on the product pV")
    if spanned and len(tests) < len(spanned) + 2:
        notes.append(f"{len(tests)} tests are too few for a slope")
        spanned = []
    centres = tuple(sum(centre(getattr(test, name)) for test in tests) / len(tests) for name in spanned)
    return Covariates(names=tuple(spanned), centres=centres, notes=tuple(notes))


def at_temperature(tests: Sequence[FrictionTest], temperature: Kelvin | None) -> tuple[FrictionTest, ...]:
    """Tests that serve at a temperature: of a material in an environment those nearest it.

    Friction is not fitted over temperature, and a mean over warm and cold tests would be that of neither.
    Tests that state no temperature serve at any.
    """
    if temperature is None:
        return tuple(tests)
    nearest: dict[tuple[str, str], Range] = {}
    for test in tests:
        if test.temperature is not None:
            group = test.material, test.environment
            found = nearest.setdefault(group, test.temperature)
            nearest[group] = min(found, test.temperature, key=lambda it: (_apart(it, temperature), it))
    serving = []
    for test in tests:
        if test.temperature is not None:
            low, high = nearest[test.material, test.environment]
            if _apart(test.temperature, min(max(temperature, low), high)) > log(LEAST_SPAN):
                continue
        serving.append(test)
    return tuple(serving)


def _apart(limits: Range, value: float) -> float:
    """Logarithm of the ratio of a value to the nearest end of a range; 0 inside it."""
    return max(log(limits[0] / value), log(value / limits[1]), 0.0)


def centre(limits: Range) -> float:
    """Logarithm of the geometric middle of a range."""
    return 0.5 * (log(limits[0]) + log(limits[1]))


def values_of(test: FrictionTest, names: Sequence[str]) -> dict[str, float]:
    """Geometric middle of each condition of a test."""
    return {name: math.exp(centre(getattr(test, name))) for name in names}


def tested_range(tests: Sequence[FrictionTest], name: str) -> Range | None:
    """Lowest and highest value in the tests that state it; None if none does."""
    stated = [limits for test in tests if (limits := getattr(test, name)) is not None]
    return (min(low for low, _ in stated), max(high for _, high in stated)) if stated else None


def _spans(tests: Sequence[FrictionTest], name: str) -> bool:
    stated = all(getattr(test, name) is not None for test in tests)
    return stated and _spread(tests, name) >= log(LEAST_SPAN)


def _spread(tests: Sequence[FrictionTest], name: str) -> float:
    """Logarithm of the largest over the smallest middle of a condition in the tests that state it."""
    middles = [centre(limits) for test in tests if (limits := getattr(test, name)) is not None]
    return max(middles) - min(middles) if middles else 0.0


def in_words(limits: Range, unit: str) -> str:
    """A range as text: ``"1 to 5 m/s"``."""
    low, high = (format_quantity(x, unit, 3) for x in limits)
    if low == high:
        return low
    number, _, symbol = low.partition(" ")
    return f"{number} to {high}" if high.endswith(f" {symbol}") else f"{low} to {high}"


EXPONENTS = {"slip_speed": 0.1, "pressure": 0.1, PRODUCT: 0.1, "temperature": 0.3}
"""Exponent with which friction may go on with a condition beyond the tests: guesses. For slip speed,
pressure and pV a slope that was measured to be steeper takes their place."""

SLACK = 1.05  # ratio to the tested range within which a speed, a pressure or pV still counts as tested
TEMPERATURE_SLACK = 5.0  # the same for temperature, as a difference [K]


def limited(
    asked: Asked, ranges: Mapping[str, Range | None], exponents: Mapping[str, float], media: Sequence[str]
) -> tuple[Mapping[str, float], tuple[str, ...], Ratio]:
    """Conditions within the tested ranges, sentences on those outside, and the widening that these cost.

    Also of pV, where speed and pressure are both known: each may have been tested, and both together not. The
    exponent of the widening is that of `EXPONENTS`, or the given one where it is larger. A medium in which no
    test was run has a sentence; its effect has no number.
    """
    conditions = {
        "slip_speed": asked.get("slip_speed"),
        "pressure": asked.get("pressure"),
        "temperature": asked.get("temperature"),
    }
    values: dict[str, float] = {}
    sentences, widening = [], 0.0
    for name in (*conditions, PRODUCT):
        value, limits = conditions.get(name), ranges.get(name)
        if name == PRODUCT and {"slip_speed", "pressure"} <= values.keys():
            value = values["slip_speed"] * values["pressure"]
        if value is None or (limits is None and name == PRODUCT):
            continue
        if limits is None:
            sentences.append(f"test {WORDS[name]} unknown (pocket: {_text(value, name)})")
            continue
        values[name] = min(max(value, limits[0]), limits[1])
        low, high = limits
        near = (low - TEMPERATURE_SLACK, high + TEMPERATURE_SLACK)
        near = near if name == "temperature" else (low / SLACK, high * SLACK)
        if near[0] <= value <= near[1]:
            continue
        sentences.append(_sentence(value, limits, name))
        exponent = max(exponents.get(name, 0.0), EXPONENTS[name])
        widening = hypot(widening, exponent * log(value / values[name]))
    medium = asked.get("medium") or ()
    names = (medium,) if isinstance(medium, str) else medium
    tested = {one.strip().casefold() for one in media}
    if names and tested and tested.isdisjoint(name.strip().casefold() for name in names):
        sentences.append(f"tested in {', '.join(media)}, not in {names[0]}")
    return values, tuple(sentences), widening


def _sentence(value: float, limits: Range, name: str) -> str:
    if name == PRODUCT:
        product, tested = _text(value, name), in_words(limits, "Pa")
        side = "beyond" if value > limits[1] else "below"
        return f"slip speed and pressure were not tested together: pV {product} is {side} {tested} m/s"
    nearest = limits[1] if value > limits[1] else limits[0]
    tests = f"tests cover {in_words(limits, CONDITIONS[name])}: value at {_text(nearest, name)} used"
    return f"{WORDS[name]} in the pocket {_text(value, name)}, {tests}"


def _text(value: float, name: str) -> str:
    unit, rest = ("Pa", " m/s") if name == PRODUCT else (CONDITIONS[name], "")
    return format_quantity(value, unit, 3) + rest


@dataclass(frozen=True, slots=True, kw_only=True)
class StatedFriction:
    """A printed mean: one number for a range of conditions, perhaps with its scatter and number of tests.

    Without a stated scatter it is that of an unrepeated test; the mean then has that standard error.
    Outside its conditions a sentence reports that, and its scatter is unchanged: its tests are unknown.
    """

    mean: Ratio
    standard_deviation: Ratio | None = None
    count: int | None = None
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    medium: str | None = None
    default_scatter: Ratio

    def at(self, **asked: Unpack[Asked]) -> Prediction:
        """Friction predicted for these conditions: the printed mean, and what of them was not tested."""
        media = () if self.medium is None else (self.medium,)
        _, sentences, _ = limited(asked, self.ranges, {}, media)
        stated = self.standard_deviation
        scatter = self.default_scatter * self.mean if stated is None else stated
        return Prediction(
            mean=self.mean,
            standard_error=scatter if stated is None else scatter / sqrt(self.count or 1),
            standard_deviation=scatter,
            extrapolation=sentences,
            assumed_scatter=stated is None,
        )
