"""`compare`: two saved answers of one verb side by side: what differs by more than counting noise.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from separatrix.ground.document import Document, Part, part_of
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import ABSENT, Estimate, Quantity
from separatrix.ground.toml import path_text
from separatrix.ground.units import printable
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    facts,
    grouped,
    text_column,
)
from separatrix.present.figure import BLUE, GREY, VERMILION, Across, Axis, Figure, Mark, Panel, Trace
from separatrix.verbs.parts.answer_page import value_words
from separatrix.verbs.parts.quantity_text import quantity
from separatrix.verbs.saved_answers import AGAIN, VERBS, is_number, read_answers, refusing_damage
from separatrix.verbs.verb import Option, Tool


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What `compare` takes."""

    first: Annotated[Path, Option("Folder or file of an answer.", "A", True)]
    second: Annotated[Path, Option("Another one of the same verb.", "B", True)]


def compute(options: Options) -> Document:
    """Compare two saved answers: verdicts, ranks, inputs, and each result with its counting noise."""
    sides = [read_answers(one) for one in (options.first, options.second)]
    return compared(*sides, names=(path_text(options.first), path_text(options.second)))


MOST_ROWS = 500


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

    value: float | int | str | bool | None  # null where this answer lacks it
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
Input = tuple[object, str | None]
"""Value of an input, and its unit."""


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
        words, nodes = printable(" / ".join(place), 160), [side.get(place) for side in (first, second)]
        a, b = nodes
        if a is None or b is None:
            if not place or place[-1].partition(" ")[0] not in GRIDS:
                has = [Value(value="yes" if node else None) for node in nodes]
                yield Row(place=words, name="", unit="-", first=has[0], second=has[1], noise=Noise.CHANGED)
            continue
        is_chain = verb in UNCOUNTED_VERBS or place[:1] in UNCOUNTED_PLACES
        names = dict.fromkeys([*a.values, *b.values])
        beside = {end for node in (a, b) for name in names for end in _beside(name) if end in node.values}
        for name in names:
            exact = is_chain or (name not in from_runs if verb == "sweep" else name in UNCOUNTED_NAMES)
            one, other = value_of(name, a), value_of(name, b)
            if name not in beside and one != other and (is_number(one.value) or one.value != other.value):
                row = Row(
                    place=words, name=name, unit=a.unit(name), first=one, second=other, noise=Noise.CHANGED
                )
                yield _judged(row, exact=exact)


def _ends(name: str) -> tuple[str, str]:
    return quantity(name).ends or (f"{name}_low", f"{name}_high")


def _beside(name: str) -> tuple[str, ...]:
    """Return the names of the interval and of the error of a number."""
    return (*_ends(name), f"{name}_error")


def value_of(name: str, node: Part) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, error, eta = map(node.get, (name, f"{name}_error", "restitution_factor"))
    if not is_number(value):
        return Value(value=printable(value, 80) if isinstance(value, str) else value)
    less, ends = 0.0, _ends(name)
    if name == "margin" and is_number(eta):  # of the threshold, less the chain's eta
        less, ends = float(eta), _ends("restitution_threshold")
    low, high = map(node.get, ends)
    if is_number(low) and is_number(high):
        return Value(value=value, low=low - less, high=high - less)
    half = NORMAL_95 * error if is_number(error) else None
    return Value(value=value) if half is None else Value(value=value, low=value - half, high=value + half)


def _judged(row: Row, *, exact: bool) -> Row:
    """Return a row with the change of its numbers, compared with the scatter of the runs."""
    a, b = row.first, row.second
    if not is_number(a.value) or not is_number(b.value):
        return row
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
    pair, places, inputs = [one[shared[0]] for one in (first, second)], [], []
    for name, one in zip(names, pair, strict=True):
        with refusing_damage(name):
            places.append(results(part_of(one)))
            inputs.append(inputs_of_answer(one))
        if not inputs[-1]:
            raise InputError(name, "contains a study that separatrix did not write", cure=AGAIN)
    own, other = (one.get("environment") for one in pair)
    environment = own if own == other and isinstance(own, str) else None
    rows = sorted(differing(shared[0], *places), key=lambda row: order(row, environment))
    decided = [
        {(at, key) for at, node in side.items() for key in node.values if is_decision(key) and key != "rank"}
        for side in places
    ]
    pairs = [
        (key, *(side.get(key, (None, None)) for side in inputs)) for key in sorted({*inputs[0], *inputs[1]})
    ]
    return {
        "separatrix_version": __version__,
        "verb": "compare",
        "of": shared[0],
        "answers": [
            {
                "path": name,
                "title": printable(one["title"], 200),
                "seed": one["seed"],
                "complete": one.get("complete") is not False,
            }
            for name, one in zip(names, pair, strict=True)
        ],
        "environment": environment,
        "shared_verdicts": len(decided[0] & decided[1]) if decided[0] | decided[1] else None,
        "inputs": [
            {"key": key, "first": a[0], "second": b[0], "unit": a[1] or b[1]}
            for key, a, b in pairs
            if a[0] != b[0]
        ],
        "rows": plain(tuple(rows[:MOST_ROWS]), left_out=[]),
        "left_out": max(0, len(rows) - MOST_ROWS),
        "also": shared[1:],
    }


# --- the page -----------------------------------------------------------------------------------
ON_A_SCREEN, MOST_DRAWN = 8, 20

LEGEND = (
    "noise: MORE, or within: whether the 95 % interval of the change excludes 0 (shares of runs: Newcombe's "
    "interval). exact: not counted in runs, exact up to the model. ?: from runs, without an interval."
)
EXACT = "No counting: these results are exact up to the model."
ONE_RUN = "A single run of each is not evidence: repeated runs of the same cages can end differently."


def page(answer: Part) -> Page:
    """Return the page of `compare`: what a reader decides first, then inputs, then the largest changes."""
    rows, own = _alike(answer.rows), f"{answer.environment} / "
    decisions = [one for one in rows if is_decision(one.name)]
    others = [one for one in rows if not is_decision(one.name)]
    named = [f"{one.title} ({printable(one.path, 80)}, seed {one.seed})" for one in answer.answers]
    ends = ["" if one.complete else ", interrupted" for one in answer.answers]
    return Page(
        f"Two answers of {answer.of}",
        f"Compared by separatrix {answer.separatrix_version}",
        (
            facts(("First", named[0] + ends[0]), ("Second", named[1] + ends[1])),
            Note(" ".join(_lead(answer)), "lead"),
            *_tables("Verdicts and ranks that changed", decisions, own, PLACE + SIDES),
            *_tables("Inputs that differ", answer.inputs or (), own, INPUTS),
            *_tables("Results that differ", others, own, CHANGES, CHANGES_WITH_ENDS),
            *_picture(answer, own),
            *(Note(text, "legend") for text in _notes(answer)),
        ),
    )


def _alike(rows: Sequence[Part]) -> list[Part]:
    """Return rows of which those that say the same of numbered parts, such as balls, are one."""

    def likeness(row: Part) -> tuple[str, ...]:
        stem, _, number = row.place.rpartition(" ")
        place = stem if number.isdigit() else row.place
        return place, row.name, *(_side(row, which).text for which in BOTH)

    alike = grouped((likeness(row), row) for row in rows).values()
    return [_at(f"{one.place} and {len(more)} more" if more else one.place, one) for one, *more in alike]


def _at(place: str, row: Part) -> Part:
    return Part({**row.values, "place": place}, row.units, row.where)


def _lead(answer: Part) -> Iterator[str]:
    """Yield what a reader decides by."""
    rows, shared = answer.rows, answer.shared_verdicts
    if not rows:
        yield "The two answers are equal in every result."
        return
    changed = [row.name == "rank" for row in rows if is_decision(row.name)]
    ranks = f"; ranks: {sum(changed)}" if any(changed) else ""
    if shared is not None:
        yield f"Verdicts changed: {changed.count(False)} of {shared} that both have{ranks}."
    beyond = [_words(row.name) for row in rows if row.name in MAIN and row.noise == "BEYOND"]
    if beyond:
        counts = ", ".join(f"{name} ({beyond.count(name)})" for name in dict.fromkeys(beyond))
        yield f"Changed by more than counting noise: {counts}."


def _tables(
    title: str, rows: Sequence[Part], own: str, columns: Columns, full: Columns = ()
) -> Iterator[Block]:
    """Yield a table under its title: what fits a screen there, of the own environment; else all."""
    ours = [_at(row.place.removeprefix(own), row) for row in rows if (row.get("place") or "").startswith(own)]
    shown = (ours or rows)[:ON_A_SCREEN]
    more = f"{len(rows) - len(shown)} more differ: `--full`." if len(rows) > len(shown) else ""
    yield Heading(f"{title} in {own.removesuffix(' / ')}" if ours else title, Level.BRIEF)
    yield Table(title, columns, tuple(shown), more, Level.BRIEF)
    yield Heading(title, Level.LONG)
    yield Table(title, full or columns, tuple(rows), "", Level.LONG)


def _words(name: str) -> str:
    return quantity(name).label if name else "in the answer"


def _cell(row: Part, value: Any, low: float | None = None, high: float | None = None) -> Cell:
    """Return a value of a row as a cell; a text or a truth as words."""
    if not is_number(value):
        return Cell(ABSENT if value is None else str(value))
    form = ".0f" if isinstance(value, int) else ""
    known = Quantity(label=row.name, unit=quantity(row.name).unit, form=form)
    return Cell(Estimate(value, low, high), known, row.get("unit"))


def _side(row: Part, which: str) -> Cell:
    side = row.get(which)
    return _cell(row, side.value, side.low, side.high)


def _input(row: Part, which: str) -> str:
    return printable(value_words(row.values[which], row.get("unit") or ""), 120)


Columns = tuple[Column, ...]
BOTH = ("first", "second")
PLACE = text_column("where", lambda row: row.place), text_column("what", lambda row: _words(row.name))
SIDES = tuple(Column(which, partial(_side, which=which), is_text=True) for which in BOTH)
NOISE = text_column("noise", lambda row: Noise[row.noise].value)
CHANGES, CHANGES_WITH_ENDS = (
    (*PLACE, *SIDES, Column("change", change, is_text=True), NOISE)
    for change in (
        lambda row: _cell(row, row.change),
        lambda row: _cell(row, row.change, row.change_low, row.change_high),
    )
)
INPUTS = (
    text_column("input", lambda row: row.key),
    *(text_column(which, partial(_input, which=which)) for which in BOTH),
)


def _notes(answer: Part) -> Iterator[str]:
    if answer.rows and answer.of in UNCOUNTED_VERBS:
        yield EXACT
    elif answer.rows and answer.of == "simulate":
        yield ONE_RUN
    elif answer.rows:
        yield LEGEND
        seeds = {one.seed for one in answer.answers}
        if len(seeds) == 1:
            same = f"Both draw the same disturbances (seed {seeds.pop()})"
            yield f"{same}; the intervals take their runs as independent."
    if answer.left_out:
        yield f"{answer.left_out} more results differ: too many to list."
    if answer.also:
        yield f"Both also have answers of {', '.join(answer.also)}: name those files to compare them."


# --- the picture --------------------------------------------------------------------------------
DRAWN = ("margin", "critical_friction", "probability_stable")
"""Results by which a reader decides: the first of them that differs is drawn."""

LOOKS = (("first", 0.14, BLUE, "o"), ("second", -0.14, VERMILION, "s"))


def _picture(answer: Part, own: str) -> Iterator[Picture]:
    """Yield what is decided by, of the own environment, in both answers, the largest value on top."""
    rows = [row for row in answer.rows if row.name in DRAWN and row.change_low is not None]
    ours = [row for row in rows if row.place.startswith(own)] or rows
    if ours:
        name = min((row.name for row in ours), key=DRAWN.index)
        rows = sorted((row for row in ours if row.name == name), key=lambda row: row.first.value)
        label, titles = _words(name), [printable(one.path, 80) for one in answer.answers]
        caption = f"{label[:1].upper()}{label[1:]} where it differs, with 95 % intervals."
        yield Picture("comparison", lambda: _figure(label, rows[-MOST_DRAWN:], titles), caption)


def _figure(label: str, rows: Sequence[Part], titles: Sequence[str]) -> Figure:
    marks: list[Mark] = [Across(at=0.0, colour=GREY, line=":")]
    for (which, shift, colour, marker), title in zip(LOOKS, titles, strict=True):
        x, low, high = ([getattr(row.get(which), end) for row in rows] for end in ("value", "low", "high"))
        look: dict[str, Any] = {"colour": colour, "marker": marker, "line": "", "name": f"{which}: {title}"}
        y = [at + shift for at in range(len(rows))]
        marks.append(Trace(x=x, y=y, low=low, high=high, ends_along="x", **look))
    places = Axis(label="", names=tuple(row.place.rpartition(" / ")[2] for row in rows))
    panel = Panel(title="", x=Axis(label=f"{label} [-]"), y=places, marks=tuple(marks))
    return Figure(rows=((panel,),), alt="Both answers; the tables have the numbers.", height=3.2)


VERB = Tool(
    name="compare",
    epilog="A and B are folders of answers, their .json or .html files, of any verb with a study.",
    compute=compute,
    page=page,
    options=Options,
    rows="rows",
    folder="compare",
    has_full=True,
)
