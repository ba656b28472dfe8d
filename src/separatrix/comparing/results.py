"""Results of two answers side by side, and whether they differ by more than the scatter of their runs.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math
import types
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import get_args, get_type_hints

from separatrix.comparing.records import Noise, Plain, Row, Value, is_number
from separatrix.ground.plain_data import field_units
from separatrix.ground.units import printable
from separatrix.verbs import answer_records as answers
from separatrix.verdict.judgement import NORMAL_95, Judgement, KickCount
from separatrix.verdict.swept_cases import Sweep

Place = tuple[str, ...]
Nodes = dict[Place, dict[str, Plain]]
"""Single numbers and texts of an answer by place and name."""

NOT_RESULTS = frozenset(
    {
        "study",
        "cage",
        "provenance",
        "separatrix_version",
        "verb",
        "name",
        "title",
        "seed",
        "warnings",
        "units",
    }
    | {"complete", "reason", "static_reason", "outcome_sentence", "paper_statement"}
    | {"words", "ball_reason", "extrapolation", "cause_sentence", "convergence", "clouds", "race"}
)
"""Inputs, sentences that follow from numbers, and single drawn bearings."""

PROBABILITY = ("probability_low", "probability_high")
INTERVALS = {
    "probability_stable": PROBABILITY,
    "probability_whirl": PROBABILITY,
    "uncertain_probability_stable": ("uncertain_probability_low", "uncertain_probability_high"),
    "critical_friction": ("scatter_low", "scatter_high"),
    "critical_friction_low": ("low_scatter_low", "low_scatter_high"),
    "critical_friction_high": ("high_scatter_low", "high_scatter_high"),
}
"""Names of intervals that are not the name of the number with _low and _high."""

UNCOUNTED_VERBS = ("check", "bearing", "traction", "restitution", "mobility")
UNCOUNTED_PLACES = ("chain", "pocket", "static")
UNCOUNTED_NAMES = frozenset(
    {"friction", "restitution_factor", "restitution_factor_free_spin", "ball_cage_stiffness", "capacity"}
    | {"cage_speed", "drift_rate_law", "force_limit", "kick", "worst_kick", "runs", "duration"}
    | {"friction_deviation"}
)
"""What is computed without runs: its differences are exact up to the model."""

FROM_RUNS = {one.name for record in (Judgement, KickCount) for one in fields(record)}
BY_LABEL = ("ball", "case", "kick", "restitution_factor")
BARE = ("environments", "materials")
GRIDS = ("curve", "linear_limit", "by_kick")
"""Lists whose rows need not be at the same values in two answers."""


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


def of_document(node: Mapping[str, object], place: Place = ()) -> Nodes:
    """Results of a document; arrays of numbers are left out."""
    items = {key: value for key, value in node.items() if key not in NOT_RESULTS}
    leaves = {
        key: value for key, value in items.items() if value is None or isinstance(value, float | int | str)
    }
    found: Nodes = {place: leaves} if leaves else {}
    for key, value in items.items():
        if isinstance(value, dict):
            found |= of_document(value, (*place, key))
        elif isinstance(value, list):
            for i, one in enumerate(one for one in value if isinstance(one, dict)):
                found |= of_document(one, (*place, _label(key, one, i)))
    return found


def _label(key: str, row: Mapping[str, object], number: int) -> str:
    name, environment = row.get("name"), row.get("environment")
    if isinstance(name, str):
        named = f"{name} in {environment}" if isinstance(environment, str) else name
        return named if key in BARE else f"{key} {named}"
    x, y = row.get("x"), row.get("y")
    if is_number(x) and is_number(y):
        return f"x {x:.6g}, y {y:.6g}"
    known = next((value for one in BY_LABEL if is_number(value := row.get(one))), None)
    return f"{key} {number + 1}" if known is None else f"{key} {known:.6g}"


def differing(verb: str, first: Nodes, second: Nodes) -> Iterator[Row | None]:
    """Yield a row for each result that differs, and None for each that does not."""
    known = units()
    for place in {**first, **second}:
        words = printable(" / ".join(place), 160)
        if place not in first or place not in second:
            if not place or place[-1].partition(" ")[0] not in GRIDS:
                one, other = (Value(value="there" if place in nodes else None) for nodes in (first, second))
                yield Row(place=words, name="", unit=None, first=one, second=other, noise=Noise.CHANGED)
            continue
        a, b = first[place], second[place]
        parts = {part for leaves in (a, b) for name in leaves for part in _parts(name, leaves)}
        for name in {**a, **b}:
            if name not in parts:
                exact = _is_exact(verb, place, name)
                yield _row(words, name, known.get(name), _value(name, a), _value(name, b), exact=exact)


def _parts(name: str, leaves: Mapping[str, Plain]) -> tuple[str, ...]:
    """Names beside a number that are its interval or its error."""
    pair = INTERVALS.get(name, (f"{name}_low", f"{name}_high"))
    error = (f"{name}_error",) if f"{name}_error" in leaves else ()
    return (*pair, *error) if pair[0] in leaves else error


def _value(name: str, leaves: Mapping[str, Plain]) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, low, high = leaves.get(name), None, None
    pair = INTERVALS.get(name, (f"{name}_low", f"{name}_high"))
    error, eta, less = leaves.get(f"{name}_error"), leaves.get("restitution_factor"), 0.0
    if name == "margin" and is_number(eta):  # of the threshold, less the chain's eta
        pair, less = ("restitution_threshold_low", "restitution_threshold_high"), float(eta)
    ends = [float(end) - less for one in pair if is_number(end := leaves.get(one))]
    if is_number(value) and len(ends) == 2:
        low, high = ends
    elif is_number(value) and is_number(error):
        low, high = (float(value) + sign * NORMAL_95 * float(error) for sign in (-1.0, 1.0))
    runs = leaves.get("runs") if "probability" in name else None
    runs = leaves.get(f"{name.partition('_probability')[0]}_runs", runs) if "_probability" in name else runs
    count = int(runs) if isinstance(runs, int | float) and math.isfinite(runs) else None
    return Value(
        value=printable(value, 80) if isinstance(value, str) else value, low=low, high=high, runs=count
    )


def _row(place: str, name: str, unit: str | None, a: Value, b: Value, *, exact: bool) -> Row | None:
    if a.value == b.value and (a.low, a.high) == (b.low, b.high):
        return None
    row = Row(place=place, name=name, unit=unit, first=a, second=b, noise=Noise.CHANGED)
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


def _is_exact(verb: str, place: Place, name: str) -> bool:
    if verb in UNCOUNTED_VERBS or (place and place[0] in UNCOUNTED_PLACES):
        return True
    return name not in FROM_RUNS if verb == "sweep" else name in UNCOUNTED_NAMES


def order(row: Row) -> tuple[int, float]:
    """Key to sort rows by: verdicts, more than noise, exact, others; the largest change first."""
    if row.is_verdict:
        return 0, 0.0
    tier = (Noise.BEYOND, Noise.EXACT, Noise.CHANGED, Noise.UNJUDGED, Noise.WITHIN).index(row.noise) + 1
    if row.change is None:
        return tier, 0.0
    if row.change_low is not None and row.change_high is not None:
        width = row.change_high - row.change_low
        return tier, -abs(row.change) / width if width > 0.0 else -math.inf
    return tier, -abs(row.relative) if row.relative is not None else -math.inf


@cache
def units() -> dict[str, str]:
    """Unit of each name of a result, from the types of the records; names of two units are left out."""
    found: dict[str, str | None] = {}
    seen: set[type] = set()
    waiting: list[object] = [*vars(answers).values(), Sweep]
    while waiting:
        kind = waiting.pop()
        waiting += get_args(kind)
        if not isinstance(kind, type) or isinstance(kind, types.GenericAlias) or kind in seen:
            continue
        if not is_dataclass(kind):
            continue
        seen.add(kind)
        for name, unit in field_units(kind).items():
            found[name] = unit if found.setdefault(name, unit) == unit else None
        waiting += get_type_hints(kind).values()
    return {name: unit for name, unit in found.items() if unit is not None}
