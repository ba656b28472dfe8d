"""Two answers of one verb: inputs and results that differ, and whether by more than the scatter of the runs.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import Any, NamedTuple

from separatrix.ground.document import Document, Part, part_of
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable
from separatrix.verbs.parts.quantities import QUANTITIES
from separatrix.verbs.saved_answers import AGAIN, VERBS, is_number, refusing_damage

Input = tuple[object, str | None]
"""Value of an input, and its unit."""

MOST_ROWS = 500
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
    low: float | None = None  # lower end of its 95 % interval
    high: float | None = None  # upper end


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A result that differs: where it is, its name in the document, both values, their difference."""

    place: str  # for instance "liquid nitrogen, 440C / Armalon"
    name: str  # empty where only one answer has the place
    unit: str  # SI unit of the numbers
    first: Value  # value of the first answer
    second: Value  # value of the second one
    change: float | None = None  # second less first
    change_low: float | None = None  # ends of its 95 % interval
    change_high: float | None = None  # upper end
    relative: float | None = None  # over the first
    noise: Noise  # BEYOND, WITHIN, EXACT, UNJUDGED or CHANGED


NOT_RESULTS = (
    *("study", "cage", "provenance", "separatrix_version", "verb", "name", "title", "seed", "warnings"),
    *("units", "complete", "reason", "static_reason", "outcome_sentence", "paper_statement", "words"),
    *("ball_reason", "extrapolation", "cause_sentence", "convergence", "clouds", "race", "notes"),
)
"""Inputs, sentences that follow from numbers, and single drawn bearings."""

UNCOUNTED_VERBS = ("check", "bearing", "traction", "restitution", "mobility")
UNCOUNTED_PLACES = (("chain",), ("pocket",), ("static",))
UNCOUNTED_NAMES = (
    *("friction", "friction_deviation", "restitution_factor", "restitution_factor_free_spin", "capacity"),
    *("ball_cage_stiffness", "cage_speed", "drift_rate_law", "force_limit", "kick", "worst_kick", "runs"),
    "duration",
)
"""What is computed without runs: its differences are exact up to the model."""

LABELS = ("ball", "case", "kick", "restitution_factor")
GRIDS = ("curve", "linear_limit", "by_kick")
"""Numbers that name a row, and lists whose rows need not be at the same values in two answers."""

DECISIONS = ("decision", "outcome", "rank")
MAIN = ("margin", "probability_stable", "critical_friction", "restitution_factor")
"""Names of results that a reader decides by, beside the verdicts, and the numbers behind them."""

NORMAL_95 = 1.959963984540054
BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""


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


Places = dict[tuple[str, ...], Part]


def results(part: Part, place: tuple[str, ...] = ()) -> Places:
    """Return the single values of a document by place; arrays of numbers are left out."""
    items = {key: value for key, value in part.values.items() if key not in NOT_RESULTS}
    leaves = {key: one for key, one in items.items() if one is None or isinstance(one, float | int | str)}
    found = {place: Part(leaves, part.units)} if leaves else {}
    for key, value in items.items():
        if isinstance(value, dict):
            found |= results(part.get(key), (*place, key))
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for i, one in enumerate(part.get(key)):
                found |= results(one, (*place, _label(key, one, i)))
    return found


def _label(key: str, row: Part, number: int) -> str:
    name, environment, x, y = map(row.get, ("name", "environment", "x", "y"))
    if isinstance(name, str):
        named = f"{name} in {environment}" if isinstance(environment, str) else name
        return named if key in ("environments", "materials") else f"{key} {named}"
    if is_number(x) and is_number(y):
        return f"x {x:.6g}, y {y:.6g}"
    known = next((value for one in LABELS if is_number(value := row.get(one))), None)
    return f"{key} {number + 1}" if known is None else f"{key} {known:.6g}"


def differing(verb: str, first: Places, second: Places) -> Iterator[Row]:
    """Yield a row for each result that differs."""
    from separatrix.verdict.judgement import Judgement, KickCount

    from_runs = {one.name for record in (Judgement, KickCount) for one in fields(record)}
    for place in {**first, **second}:
        words, (a, b) = printable(" / ".join(place), 160), (nodes.get(place) for nodes in (first, second))
        if a is None or b is None:
            if not place or place[-1].partition(" ")[0] not in GRIDS:
                one, other = (Value(value="yes" if node else None) for node in (a, b))
                yield Row(place=words, name="", unit="-", first=one, second=other, noise=Noise.CHANGED)
            continue
        parts = {part for node in (a, b) for name in node.values for part in _parts(name, node)}
        is_chain = verb in UNCOUNTED_VERBS or place[:1] in UNCOUNTED_PLACES
        for name in {**a.values, **b.values}:
            exact = is_chain or (name not in from_runs if verb == "sweep" else name in UNCOUNTED_NAMES)
            row = None if name in parts else _row(value_of(name, a), value_of(name, b), exact=exact)
            if row is not None:
                yield replace(row, place=words, name=name, unit=a.unit(name))


def _ends(name: str) -> tuple[str, str]:
    known = QUANTITIES.get(name)
    return (known and known.ends) or (f"{name}_low", f"{name}_high")


def _parts(name: str, node: Part) -> Iterator[str]:
    """Yield the names beside a number that are its interval or its error."""
    for names in (_ends(name), (f"{name}_error",)):
        yield from names if names[0] in node.values else ()


def value_of(name: str, node: Part) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, error, eta = map(node.get, (name, f"{name}_error", "restitution_factor"))
    if not is_number(value):
        return Value(value=printable(value, 80) if isinstance(value, str) else value)
    less, ends = 0.0, _ends(name)
    if name == "margin" and is_number(eta):  # of the threshold, less the chain's eta
        less, ends = float(eta), _ends("restitution_threshold")
    low, high = map(node.get, ends)
    if not is_number(low) or not is_number(high):
        half = NORMAL_95 * error if is_number(error) else math.nan
        low, high = value - half, value + half
    return Value(value=value) if math.isnan(low) else Value(value=value, low=low - less, high=high - less)


def _row(a: Value, b: Value, *, exact: bool) -> Row | None:
    if a == b:
        return None
    row = Row(place="", name="", unit="-", first=a, second=b, noise=Noise.CHANGED)
    if not is_number(a.value) or not is_number(b.value):
        return None if a.value == b.value else row
    change, low, high = float(b.value) - float(a.value), None, None
    noise = Noise.EXACT if exact else Noise.UNJUDGED
    if a.low is not None and a.high is not None and b.low is not None and b.high is not None:
        low, high = difference_interval((a.value, a.low, a.high), (b.value, b.low, b.high))
        noise = Noise.WITHIN if low <= 0.0 <= high else Noise.EXACT if exact else Noise.BEYOND
    relative = change / abs(a.value) if a.value else None
    return replace(row, change=change, change_low=low, change_high=high, relative=relative, noise=noise)


def is_decision(name: str) -> bool:
    """Whether a result of this name is a verdict, a decision of a map, the outcome of a run, or a rank."""
    return name.endswith("verdict") or name in DECISIONS


def order(row: Row, own: str | None) -> tuple[bool, bool, bool, int, float]:
    """Key to sort rows by: what is decided by, in the own environment, beyond noise, the largest changes."""
    low, high, part = row.change_low, row.change_high, row.relative
    if row.change is not None and low is not None and high is not None:
        part = row.change / (high - low) if high > low else None
    size = 0.0 if row.change is None else math.inf if part is None else abs(part)
    is_else = not row.place.startswith(f"{own} / ") if own else row.place.startswith("chain")
    return not is_decision(row.name), row.name not in MAIN, is_else, (*Noise,).index(row.noise), -size


# --- inputs -------------------------------------------------------------------------------------
def of_study(node: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Input]]:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one its distribution."""
    if "value" in node:
        known, unit = node.get("distribution"), node.get("unit")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        yield path, (words or node["value"], unit if not words and isinstance(unit, str) else None)
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
    """Inputs of an answer, and the options of its command."""
    question = ((one.get("provenance") or {}).get("command") or {}).get("question") or {}
    return dict(of_study(one["study"])) | {f"--{name}": (value, None) for name, value in question.items()}


# --- two answers --------------------------------------------------------------------------------
def compared(
    first: Mapping[str, Document], second: Mapping[str, Document], *, names: tuple[str, str]
) -> Document:
    """Compare the answers of the first verb that both have; `names` stand for them in messages.

    Raises
    ------
    InputError
        They share no verb, or one is not as separatrix writes it.
    """
    from separatrix import __version__
    from separatrix.ground.plain_data import plain

    shared = [verb for verb in VERBS if verb in first and verb in second]
    if not shared:
        rule = f"must be an answer of {' or '.join(first)}, as {names[0]} is"
        raise InputError(names[1], rule, got=", ".join(second))
    sides = [_side(name, one[shared[0]]) for name, one in zip(names, (first, second), strict=True)]
    one, other = sides
    own = one.environment if one.environment == other.environment else None
    environment = own if isinstance(own, str) else None
    rows = sorted(differing(shared[0], one.places, other.places), key=lambda row: order(row, environment))
    keys = sorted({*one.inputs, *other.inputs})
    pairs = [(key, *(side.inputs.get(key, (None, None)) for side in sides)) for key in keys]
    return {
        "separatrix_version": __version__,
        "verb": "compare",
        "of": shared[0],
        "answers": [side.named for side in sides],
        "environment": environment,
        "shared_verdicts": len(one.verdicts & other.verdicts) if one.verdicts | other.verdicts else None,
        "inputs": [
            {"key": key, "first": a[0], "second": b[0], "unit": a[1] or b[1]}
            for key, a, b in pairs
            if a[0] != b[0]
        ],
        "rows": plain(tuple(rows[:MOST_ROWS]), left_out=[]),
        "left_out": max(0, len(rows) - MOST_ROWS),
        "also": shared[1:],
    }


class _Side(NamedTuple):
    """What is compared of an answer."""

    named: Document
    environment: object
    places: Places
    inputs: dict[str, Input]

    @property
    def verdicts(self) -> set[tuple[tuple[str, ...], str]]:
        """Places and names of what is decided, but for ranks."""
        keys = ((at, key) for at, node in self.places.items() for key in node.values)
        return {(at, key) for at, key in keys if is_decision(key) and key != "rank"}


def _side(name: str, one: Document) -> _Side:
    """Take from an answer what is compared; one that is damaged is refused under its name."""
    with refusing_damage(name):
        named = {"path": name, "title": printable(one["title"], 200), "seed": one["seed"]}
        named |= {"complete": one.get("complete") is not False}
        found = _Side(named, one.get("environment"), results(part_of(one)), inputs_of_answer(one))
    if not found.inputs:
        raise InputError(name, "contains a study that separatrix did not write", cure=AGAIN)
    return found
