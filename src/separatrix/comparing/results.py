"""Results of two answers side by side, from their documents or their datasets."""

from __future__ import annotations

import dataclasses
import math
import types
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, get_args, get_type_hints

import numpy as np

from separatrix import answers
from separatrix.cage import Judgement, KickCount
from separatrix.cage.verdict import NORMAL_95
from separatrix.comparing.agreement import is_number
from separatrix.comparing.noise import difference_interval
from separatrix.comparing.records import Noise, Plain, Row, Value
from separatrix.explore.sweep import Sweep
from separatrix.present.walk import field_units
from separatrix.units import printable

if TYPE_CHECKING:
    import xarray as xr

Place = tuple[str, ...]
Nodes = dict[Place, dict[str, Plain]]
"""Single numbers and texts of an answer by place and name."""

NOT_RESULTS = frozenset(
    {"study", "cage", "provenance", "separatrix_version", "verb", "name", "title", "seed", "warnings"}
    | {"complete", "reason", "static_reason", "impacts_reason", "outcome_sentence", "paper_statement"}
    | {"words", "extrapolation", "cause_sentence", "convergence", "clouds", "race", "notes"}
)
"""Inputs, sentences that follow from numbers, and single drawn bearings."""

PROBABILITY = ("probability_low", "probability_high")
INTERVALS = {
    "probability_stable": PROBABILITY,
    "probability_whirl": PROBABILITY,
    "uncertain_probability_stable": ("uncertain_probability_low", "uncertain_probability_high"),
    "other_ball_probability_stable": ("other_ball_probability_low", "other_ball_probability_high"),
    "critical_friction": ("scatter_low", "scatter_high"),
    "critical_friction_low": ("low_scatter_low", "low_scatter_high"),
    "critical_friction_high": ("high_scatter_low", "high_scatter_high"),
}
"""Names of intervals that are not the name of the number with _low and _high."""

UNCOUNTED_VERBS = ("check", "bearing", "traction", "restitution", "mobility")
UNCOUNTED_PLACES = ("chain", "pocket", "static")
UNCOUNTED_NAMES = frozenset(
    {"friction", "restitution_factor", "restitution_factor_free_spin", "ball_cage_stiffness", "capacity"}
    | {"cage_speed", "drift_rate_law", "kick", "worst_kick", "runs", "duration", "friction_deviation"}
)
"""What is computed without runs: its differences are exact up to the model."""

FROM_RUNS = {one.name for record in (Judgement, KickCount) for one in dataclasses.fields(record)}
BY_LABEL = ("ball", "case", "kick", "restitution_factor")
BARE = ("environments", "materials")
GRIDS = ("curve", "linear_limit", "hard_limit", "by_kick")
"""Lists whose rows need not be at the same values in two answers."""

MOST_ON_AXIS, MOST_VALUES = 200, 200_000


def of_document(document: Mapping[str, Any]) -> Nodes:
    """Results of a document; arrays of numbers are left out."""
    return {place: leaves for place, leaves in _nodes(document, ()) if leaves}


def _nodes(node: Mapping[str, Any], place: Place) -> Iterator[tuple[Place, dict[str, Plain]]]:
    items = {key: value for key, value in node.items() if key not in NOT_RESULTS}
    yield place, {key: value for key, value in items.items() if not isinstance(value, list | dict)}
    for key, value in items.items():
        if isinstance(value, dict):
            yield from _nodes(value, (*place, key))
        elif isinstance(value, list):
            rows = [one for one in value if isinstance(one, dict)]
            for i, one in enumerate(rows):
                yield from _nodes(one, (*place, _label(key, one, i)))


def _label(key: str, row: Mapping[str, Any], number: int) -> str:
    """Name of a row of a list."""
    name, environment = row.get("name"), row.get("environment")
    if isinstance(name, str):
        named = f"{name} in {environment}" if isinstance(environment, str) else name
        return named if key in BARE else f"{key} {named}"
    if is_number(row.get("x")) and is_number(row.get("y")):
        return f"x {row['x']:.6g}, y {row['y']:.6g}"
    known = next((one for one in BY_LABEL if is_number(row.get(one))), None)
    return f"{key} {number + 1}" if known is None else f"{key} {row[known]:.6g}"


def of_dataset(data: xr.Dataset) -> Nodes:
    """Results of a dataset; variables with long axes, such as time, are left out."""
    found: Nodes = {}
    for key in data.data_vars:
        name, values, place = str(key), data[key], Place()
        if name in NOT_RESULTS or name.startswith("cage_") or values.size > MOST_VALUES:
            continue
        if any(size > MOST_ON_AXIS for size in values.shape):
            continue
        for head in ("material", "overall", "here", "chain", "pocket"):
            if name.startswith(f"{head}_"):
                name, place = name.removeprefix(f"{head}_"), () if head == "material" else (head,)
                break
        if name in NOT_RESULTS:
            continue
        for at in np.ndindex(*values.shape):
            labels = [_axis(data, str(dim), i) for dim, i in zip(values.dims, at, strict=True)]
            value: Any = values.values[at]
            value = value.item() if isinstance(value, np.generic) else value
            absent = value == "" or (isinstance(value, float) and not math.isfinite(value))
            found.setdefault((*place, *labels), {})[name] = None if absent else value
    return found


def _axis(data: xr.Dataset, dim: str, number: int) -> str:
    if dim not in data.variables or data[dim].ndim != 1:
        return f"{dim} {number}"
    value = data[dim].values[number]
    if isinstance(value, str):
        return value
    return f"{dim} {value:.6g}"


def differing(verb: str, first: Nodes, second: Nodes) -> Iterator[Row | None]:
    """Yield a row for each result that differs, and None for each that does not."""
    known = units()
    for place in {**first, **second}:
        if place not in first or place not in second:
            last = place[-1].partition(" ")[0] if place else ""
            if last not in GRIDS:
                here = [Value(value="there" if place in nodes else None) for nodes in (first, second)]
                yield Row(
                    place=_words(place),
                    name="",
                    unit=None,
                    first=here[0],
                    second=here[1],
                    noise=Noise.CHANGED,
                )
            continue
        a, b = first[place], second[place]
        parts = {part for leaves in (a, b) for name in leaves for part in _parts(name, leaves)}
        for name in {**a, **b}:
            if name not in parts:
                one, other = _value(name, a), _value(name, b)
                exact = _is_exact(verb, place, name)
                yield _row(_words(place), name, known.get(name), one, other, exact=exact)


def _words(place: Place) -> str:
    return printable(" / ".join(place), 160)


def _parts(name: str, leaves: Mapping[str, Plain]) -> tuple[str, ...]:
    """Names beside a number that are its interval or its error."""
    pair = INTERVALS.get(name, (f"{name}_low", f"{name}_high"))
    error = (f"{name}_error",) if f"{name}_error" in leaves else ()
    return (*pair, *error) if pair[0] in leaves else error


def _value(name: str, leaves: Mapping[str, Plain]) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, low, high = leaves.get(name), None, None
    pair = INTERVALS.get(name, (f"{name}_low", f"{name}_high"))
    ends = [leaves.get(end) for end in pair]
    error, eta = leaves.get(f"{name}_error"), leaves.get("restitution_factor")
    if name == "margin" and is_number(eta):  # of the threshold, less the chain's eta
        ends = [leaves.get(f"restitution_threshold_{end}") for end in ("low", "high")]
        ends = [end - eta if is_number(end) else None for end in ends]  # type: ignore[operator]
    if is_number(value) and all(is_number(end) for end in ends):
        low, high = (float(end) for end in ends)  # type: ignore[arg-type]
    elif is_number(value) and is_number(error):
        low, high = (float(value) + sign * NORMAL_95 * float(error) for sign in (-1.0, 1.0))  # type: ignore[arg-type]
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
    one, other = float(a.value), float(b.value)  # type: ignore[arg-type]
    change, low, high = other - one, None, None
    noise = Noise.EXACT if exact else Noise.UNJUDGED
    if None not in (a.low, a.high, b.low, b.high):
        ends = (one, a.low, a.high), (other, b.low, b.high)
        low, high = difference_interval(*ends)  # type: ignore[arg-type]
        noise = Noise.WITHIN if low <= 0.0 <= high else Noise.EXACT if exact else Noise.BEYOND
    relative = change / abs(one) if one else None
    return dataclasses.replace(
        row, change=change, change_low=low, change_high=high, relative=relative, noise=noise
    )


def _is_exact(verb: str, place: Place, name: str) -> bool:
    if verb in UNCOUNTED_VERBS or place[:1] in [(one,) for one in UNCOUNTED_PLACES]:
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
        if not dataclasses.is_dataclass(kind):
            continue
        seen.add(kind)
        for name, unit in field_units(kind).items():
            found[name] = unit if found.setdefault(name, unit) == unit else None
        waiting += get_type_hints(kind).values()
    return {name: unit for name, unit in found.items() if unit is not None}
