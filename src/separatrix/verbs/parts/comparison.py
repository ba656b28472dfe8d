"""Two answers of one verb: inputs and results that differ, and whether by more than the scatter of the runs.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, NamedTuple, TypeGuard

from separatrix.ground.document import Document
from separatrix.ground.units import printable
from separatrix.verbs.parts.quantities import QUANTITIES

Plain = float | int | str | bool | None


class Noise(StrEnum):
    """A difference compared with the scatter of the runs."""

    BEYOND = "MORE"  # 0 is outside the 95 % interval of the change
    EXACT = "exact"  # not counted in runs
    CHANGED = "changed"  # a text, or a number that one of them lacks
    UNJUDGED = "?"  # from runs, without an interval
    WITHIN = "within"  # 0 is inside that interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A result in one answer, with its 95 % interval if it has one."""

    value: Plain  # null where this answer lacks it
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A result that differs: where it is, its name in the document, both values, their difference."""

    place: str  # for instance "liquid nitrogen, 440C / Armalon"
    name: str  # empty where only one answer has the place
    unit: str
    first: Value
    second: Value
    change: float | None = None  # second less first
    change_low: float | None = None  # ends of its 95 % interval
    change_high: float | None = None
    relative: float | None = None  # change over the first
    noise: Noise


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """An input that differs; None where it is absent."""

    key: str  # of the study, or of the command
    first: object
    second: object
    unit: str | None  # of the numbers; null for a text


class Node(NamedTuple):
    """Single values of a part of an answer, and their units."""

    values: Mapping[str, Plain]
    units: Mapping[str, str]


NOT_RESULTS = frozenset(
    (
        *("study", "cage", "provenance", "separatrix_version", "verb", "name", "title", "seed", "warnings"),
        *("units", "complete", "reason", "static_reason", "outcome_sentence", "paper_statement", "words"),
        *("ball_reason", "extrapolation", "cause_sentence", "convergence", "clouds", "race", "notes"),
    )
)
"""Inputs, sentences that follow from numbers, and single drawn bearings."""

PROBABILITY = ("probability_low", "probability_high")
ENDS = {
    "probability_stable": PROBABILITY,
    "probability_whirl": PROBABILITY,
    "uncertain_probability_stable": ("uncertain_probability_low", "uncertain_probability_high"),
    "critical_friction": ("scatter_low", "scatter_high"),
    "critical_friction_low": ("low_scatter_low", "low_scatter_high"),
    "critical_friction_high": ("high_scatter_low", "high_scatter_high"),
}
"""Ends of intervals that have not the name of the number with _low and _high."""

UNCOUNTED_VERBS = ("check", "bearing", "traction", "restitution", "mobility")
UNCOUNTED_PLACES = (("chain",), ("pocket",), ("static",))
UNCOUNTED_NAMES = frozenset(
    (
        *(
            "friction",
            "restitution_factor",
            "restitution_factor_free_spin",
            "ball_cage_stiffness",
            "capacity",
        ),
        *("cage_speed", "drift_rate_law", "force_limit", "kick", "worst_kick", "runs", "duration"),
        "friction_deviation",
    )
)
"""What is computed without runs: its differences are exact up to the model."""

LABELS = ("ball", "case", "kick", "restitution_factor")
GRIDS = ("curve", "linear_limit", "by_kick")
"""Numbers that name a row, and lists whose rows need not be at the same values in two answers."""

DECISIONS = ("decision", "outcome", "rank")
MAIN = ("margin", "probability_stable", "critical_friction", "restitution_factor")
"""Names of results that a reader decides by, beside the verdicts, and the numbers behind them."""

NORMAL_95 = 1.959963984540054
MOST = 1e150  # magnitude from which a number of a document is damage; below it the square is finite
BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value of a document is a finite number; true and false are not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -MOST < value < MOST


def difference_interval(
    first: tuple[float, float, float], second: tuple[float, float, float]
) -> tuple[float, float]:
    """95 % interval of the second value less the first; each is (value, low, high) with its 95 % interval.

    For Wilson's intervals of two shares this is Newcombe's. It assumes that the two are independent: where
    both answers draw the same runs, the interval is too wide, if anything.
    """
    (a, a_low, a_high), (b, b_low, b_high) = first, second
    change = b - a
    return change - math.hypot(b - b_low, a_high - a), change + math.hypot(b_high - b, a - a_low)


def results(
    values: Mapping[str, Any], units: Any, place: tuple[str, ...] = ()
) -> dict[tuple[str, ...], Node]:
    """Return the single values of a document by place; arrays of numbers are left out."""
    known = units if isinstance(units, Mapping) else {}
    items = {key: value for key, value in values.items() if key not in NOT_RESULTS}
    leaves = {key: one for key, one in items.items() if one is None or isinstance(one, float | int | str)}
    texts = {key: one for key, one in known.items() if isinstance(one, str)}
    found = {place: Node(leaves, texts)} if leaves else {}
    for key, value in items.items():
        if isinstance(value, dict):
            found |= results(value, known.get(key), (*place, key))
        elif isinstance(value, list):
            for i, one in enumerate(one for one in value if isinstance(one, dict)):
                found |= results(one, known.get(key), (*place, _label(key, one, i)))
    return found


def _label(key: str, row: Mapping[str, Any], number: int) -> str:
    name, environment = row.get("name"), row.get("environment")
    if isinstance(name, str):
        named = f"{name} in {environment}" if isinstance(environment, str) else name
        return named if key in ("environments", "materials") else f"{key} {named}"
    x, y = row.get("x"), row.get("y")
    if is_number(x) and is_number(y):
        return f"x {x:.6g}, y {y:.6g}"
    known = next((value for one in LABELS if is_number(value := row.get(one))), None)
    return f"{key} {number + 1}" if known is None else f"{key} {known:.6g}"


Nodes = Mapping[tuple[str, ...], Node]


def differing(verb: str, first: Nodes, second: Nodes) -> Iterator[Row]:
    """Yield a row for each result that differs."""
    from_runs = _from_runs()
    for place in {**first, **second}:
        words = printable(" / ".join(place), 160)
        if place not in first or place not in second:
            if not place or place[-1].partition(" ")[0] not in GRIDS:
                one, other = (Value(value="yes" if place in nodes else None) for nodes in (first, second))
                yield Row(place=words, name="", unit="-", first=one, second=other, noise=Noise.CHANGED)
            continue
        (a, units), (b, _) = first[place], second[place]
        parts = {part for leaves in (a, b) for name in leaves for part in _parts(name, leaves)}
        is_chain = verb in UNCOUNTED_VERBS or place[:1] in UNCOUNTED_PLACES
        for name in {**a, **b}:
            if name in parts:
                continue
            exact = is_chain or (name not in from_runs if verb == "sweep" else name in UNCOUNTED_NAMES)
            row = _row(value_of(name, a), value_of(name, b), exact=exact)
            if row is not None:
                yield replace(row, place=words, name=name, unit=units.get(name, "-"))


def _from_runs() -> set[str]:
    from dataclasses import fields

    from separatrix.verdict.judgement import Judgement, KickCount

    return {one.name for record in (Judgement, KickCount) for one in fields(record)}


def _ends(name: str) -> tuple[str, str]:
    known = QUANTITIES.get(name)
    return (known.ends if known else None) or ENDS.get(name) or (f"{name}_low", f"{name}_high")


def _parts(name: str, leaves: Mapping[str, Plain]) -> tuple[str, ...]:
    """Names beside a number that are its interval or its error."""
    pair, error = _ends(name), (f"{name}_error",) if f"{name}_error" in leaves else ()
    return (*pair, *error) if pair[0] in leaves else error


def value_of(name: str, leaves: Mapping[str, Any]) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, pair, less = leaves.get(name), _ends(name), 0.0
    error, eta = leaves.get(f"{name}_error"), leaves.get("restitution_factor")
    if name == "margin" and is_number(eta):  # of the threshold, less the chain's eta
        pair, less = ("restitution_threshold_low", "restitution_threshold_high"), float(eta)
    ends = [float(end) - less for one in pair if is_number(end := leaves.get(one))]
    if is_number(value) and len(ends) == 2:
        return Value(value=value, low=ends[0], high=ends[1])
    if is_number(value) and is_number(error):
        half = NORMAL_95 * float(error)
        return Value(value=value, low=value - half, high=value + half)
    return Value(value=printable(value, 80) if isinstance(value, str) else value)


def _row(a: Value, b: Value, *, exact: bool) -> Row | None:
    if a.value == b.value and (a.low, a.high) == (b.low, b.high):
        return None
    row = Row(place="", name="", unit="-", first=a, second=b, noise=Noise.CHANGED)
    if not is_number(a.value) or not is_number(b.value):
        return None if a.value == b.value else row
    one, other = float(a.value), float(b.value)
    change, low, high = other - one, None, None
    noise = Noise.EXACT if exact else Noise.UNJUDGED
    if a.low is not None and a.high is not None and b.low is not None and b.high is not None:
        low, high = difference_interval((one, a.low, a.high), (other, b.low, b.high))
        noise = Noise.WITHIN if low <= 0.0 <= high else Noise.EXACT if exact else Noise.BEYOND
    relative = change / abs(one) if one else None
    return replace(row, change=change, change_low=low, change_high=high, relative=relative, noise=noise)


def is_decision(name: str) -> bool:
    """Whether a result of this name is a verdict, a decision of a map, the outcome of a run, or a rank."""
    return name.endswith("verdict") or name in DECISIONS


def order(row: Row) -> tuple[int, int, float]:
    """Key to sort rows by: decisions, more than noise, exact, others; the largest change first."""
    tier = -1 if is_decision(row.name) else (*Noise,).index(row.noise)
    is_main = 0 if row.name in MAIN else 1
    if row.change is None or tier < 0:
        return tier, is_main, 0.0
    if row.change_low is not None and row.change_high is not None:
        width = row.change_high - row.change_low
        return tier, is_main, -abs(row.change) / width if width > 0.0 else -math.inf
    return tier, is_main, -abs(row.relative) if row.relative is not None else -math.inf


# --- inputs -------------------------------------------------------------------------------------
Input = tuple[object, str | None]
"""Value of an input, and its unit."""


def differences(first: Mapping[str, Input], second: Mapping[str, Input]) -> Iterator[Difference]:
    """Yield each input that differs between two sets of them."""
    for key in {**first, **second}:
        a, b = first.get(key, (None, None)), second.get(key, (None, None))
        if a[0] != b[0]:
            yield Difference(key=key, first=a[0], second=b[0], unit=a[1] or b[1])


def of_study(node: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Input]]:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one its distribution."""
    if "value" in node:
        known, unit = node.get("distribution"), node.get("unit")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        is_plain = not words and isinstance(unit, str)
        yield path, (words or node["value"], str(unit) if is_plain else None)
        return
    if path and isinstance(node.get("name"), str):
        yield path, (node["name"], None)
    for key, item in node.items():
        if isinstance(item, Mapping) and key not in BESIDE:
            yield from of_study(item, f"{path}.{key}" if path else key)
        elif key == "candidates" and isinstance(item, list):
            for one in item:
                for place, measured in (one.get("friction") or {}).items():
                    if measured is not None:
                        yield f"friction of {one['name']} in {place}", (measured.get("mean"), "-")
                yield from of_study(one.get("material") or {}, f"material of {one['name']}")


def inputs_of_answer(one: Document) -> dict[str, Input]:
    """Inputs of an answer; of a simulation also kick and run, and the friction that it took."""
    found = dict(sorted(of_study(one["study"]), key=lambda pair: pair[0]))
    if one["verb"] == "simulate":
        taken: dict[str, Input] = {
            "--kick": (one.get("kick"), "m/s"),
            "--run": (one.get("run"), None),
            "cage.ball_cage_friction": ((one.get("cage") or {}).get("ball_cage_friction"), "-"),
        }
        return found | {key: value for key, value in taken.items() if value[0] is not None}
    command = (one.get("provenance") or {}).get("command") or {}
    return found | {f"--{name}": (value, None) for name, value in (command.get("question") or {}).items()}
