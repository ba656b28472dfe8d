"""`compare`: two saved answers of one verb side by side: what differs by more than counting noise.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Annotated

from separatrix import __version__
from separatrix.ground.errors import InputError
from separatrix.ground.plain_data import Document, Part, part_of, plain
from separatrix.ground.quantity import ABSENT, Estimate, Quantity
from separatrix.ground.toml import path_text
from separatrix.ground.units import printable
from separatrix.present.blocks import Cell, Column, Heading, Level, Note, Page, Table, facts, text_column
from separatrix.present.quantity_text import ends_of, quantity
from separatrix.verbs.answer_files import (
    AGAIN,
    VERBS,
    inputs_of_study,
    is_number,
    read_answers,
    refusing_damage,
)
from separatrix.verbs.parts.answer_page import value_words
from separatrix.verbs.parts.verdict_blocks import MARK
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A result in one answer, or its change, with its 95 % interval if it has one."""

    value: float | int | str | bool | None  # null where this answer lacks it
    low: float | None = None  # lower end of its 95 % interval
    high: float | None = None  # upper end


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A result that differs: where it is, its name in the document, both values, their difference."""

    place: str  # for instance "liquid nitrogen, 440C / Armalon"
    name: str  # empty where only one answer has the place
    unit: str = "-"  # SI unit of the numbers
    first: Value  # value of the first answer
    second: Value  # value of the second one
    change: Value | None = None  # second less first; null of texts
    beyond_noise: bool | None = None  # whether 0 is outside its interval; null without one


NOT_RESULTS = (
    *("study", "cage", "provenance", "separatrix_version", "verb", "name", "title", "seed", "warnings"),
    *("units", "complete", "reason", "static_reason", "outcome_sentence", "paper_statement", "words"),
    *("ball_reason", "extrapolation", "cause_sentence", "convergence", "clouds", "race", "notes"),
    *("by_kick", "long_look"),
)
"""Inputs, sentences that follow from numbers, single drawn bearings, and the runs behind a share."""

LABELS = ("case", "restitution_factor")
GRIDS = ("curve", "linear_limit")
"""Numbers that name a row, and lists whose rows need not be at the same values in two answers."""

DECISIONS = ("verdict", "paper_verdict", "uncertain_verdict", "decision", "outcome", "rank")
MAIN = (
    *("safety_factor", "restitution_threshold", "margin", "probability_stable"),
    *("own_critical_friction", "critical_friction", "restitution_factor"),
)
"""Names of results that a reader decides by: verdicts, outcomes and ranks, and the numbers behind them."""

NORMAL_95 = 1.959963984540054


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


def results(part: Part, own: str | None = None, place: tuple[str, ...] = ()) -> Places:
    """Return the single values of a document by place, of balls those of the most loaded one; no arrays.

    The places of the bearing's own environment do not name it.
    """
    items = {key: value for key, value in part.values.items() if key not in NOT_RESULTS}
    leaves = {key: one for key, one in items.items() if one is None or isinstance(one, float | int | str)}
    found = {place: Part(leaves, part.units)} if leaves else {}
    for key, value in items.items():
        if isinstance(value, dict):
            found |= results(part.get(key), own, (*place, key))
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            rows = part.get(key) if key != "balls" else [part.get(key)[part.most_loaded]]
            for i, one in enumerate(rows):
                label = () if key == "environments" and one.get("name") == own else _label(key, one, i)
                found |= results(one, own, (*place, *label))
    return found


def _label(key: str, row: Part, number: int) -> tuple[str, ...]:
    name, environment, x, y = map(row.get, ("name", "environment", "x", "y"))
    if isinstance(name, str):
        named = f"{name} in {environment}" if isinstance(environment, str) else name
        return (named,) if key in ("environments", "materials") else (key, named)
    if key == "balls":
        return ("most loaded ball",)
    if is_number(x) and is_number(y):
        return (f"x {x:.6g}, y {y:.6g}",)
    known = next((value for one in LABELS if is_number(value := row.get(one))), None)
    return (f"{key} {number + 1}" if known is None else f"{key} {known:.6g}",)


def differing(first: Places, second: Places) -> Iterator[Row]:
    """Yield a row for each result that differs."""
    for place in {**first, **second}:
        words, a, b = printable(" / ".join(place), 160), first.get(place), second.get(place)
        if a is None or b is None:
            if not place or place[-1].partition(" ")[0] not in GRIDS:
                has = [Value(value="yes" if node else None) for node in (a, b)]
                yield Row(place=words, name="", first=has[0], second=has[1])
            continue
        names = dict.fromkeys([*a.values, *b.values])
        beside = {one for name in names for one in (*ends_of(name), f"{name}_error")}
        for name in names:
            one, other = value_of(name, a), value_of(name, b)
            if name not in beside and one != other and (is_number(one.value) or one.value != other.value):
                yield _judged(Row(place=words, name=name, unit=a.unit(name), first=one, second=other))


def value_of(name: str, node: Part) -> Value:
    """Return a number with its interval: the one given, or that of its standard error."""
    value, error, low, high = map(node.get, (name, f"{name}_error", *ends_of(name)))
    if not is_number(value):
        return Value(value=printable(value, 80) if isinstance(value, str) else value)
    if is_number(low) and is_number(high):
        return Value(value=value, low=low, high=high)
    half = NORMAL_95 * error if is_number(error) else None
    return Value(value=value) if half is None else Value(value=value, low=value - half, high=value + half)


def _judged(row: Row) -> Row:
    """Return a row with the change of its numbers, compared with their intervals."""
    a, b = row.first, row.second
    if not is_number(a.value) or not is_number(b.value):
        return row
    change = Value(value=b.value - a.value)
    if a.low is None or a.high is None or b.low is None or b.high is None:
        return replace(row, change=change)
    low, high = difference_interval((a.value, a.low, a.high), (b.value, b.low, b.high))
    return replace(row, change=replace(change, low=low, high=high), beyond_noise=not low <= 0.0 <= high)


def order(row: Row) -> tuple[bool, bool, int, int, int, float]:
    """Key to sort rows by: what is decided by, in the own environment, beyond noise, the largest changes."""
    names = (*DECISIONS, *MAIN, row.name)
    noise = (True, None, False).index(row.beyond_noise)
    places = row.place.count(" / ")
    others = row.name not in DECISIONS, row.name not in MAIN
    sides = row.first, row.second, row.change
    first, second, change = (abs(one.value) if one and is_number(one.value) else 0.0 for one in sides)
    return *others, places, names.index(row.name), noise, -change / (max(first, second) or 1.0)


def compared(
    first: Mapping[str, Document], second: Mapping[str, Document], *, names: tuple[str, str]
) -> Document:
    """Compare the answers of the first verb that both have; `names` stand for them in messages.

    Raises
    ------
    InputError
        They share no verb, or one is not as separatrix writes it.
    """
    shared = [verb for verb in VERBS if verb in first and verb in second]
    if not shared:
        rule = f"must be an answer of {' or '.join(first)}, as {names[0]} is"
        raise InputError(names[1], rule, got=", ".join(second))
    pair, places, inputs, answers = [one[shared[0]] for one in (first, second)], [], [], []
    own, other = (one.get("environment") for one in pair)
    environment = own if own == other and isinstance(own, str) else None
    for name, one in zip(names, pair, strict=True):
        with refusing_damage(name):
            places.append(results(part_of(one), environment))
            question = ((one.get("provenance") or {}).get("command") or {}).get("question") or {}
            options = {f"--{key}": (value, None) for key, value in question.items()}
            inputs.append(dict(inputs_of_study(one["study"])) | options)
        if not inputs[-1]:
            raise InputError(name, "contains a study that separatrix did not write", cure=AGAIN)
        known = {"path": name, "title": printable(one["title"], 200), "seed": one["seed"]}
        answers.append(known | {"complete": one.get("complete") is not False})
    rows = sorted(differing(*places), key=order)
    keys = sorted({**inputs[0], **inputs[1]})
    pairs = {key: [side.get(key, (None, None)) for side in inputs] for key in keys}
    return {
        "separatrix_version": __version__,
        "verb": "compare",
        "of": shared[0],
        "answers": answers,
        "environment": environment,
        "inputs": [
            {"key": key, "first": a[0], "second": b[0], "unit": a[1] or b[1]}
            for key, (a, b) in pairs.items()
            if a[0] != b[0]
        ],
        "rows": plain(tuple(rows[:MOST_ROWS]), left_out=[]),
        "left_out": max(0, len(rows) - MOST_ROWS),
        "also": shared[1:],
    }


# --- the page -----------------------------------------------------------------------------------
ON_A_SCREEN = 12
LEGEND = (
    f"{MARK} more than counting noise: the 95 % interval of the change excludes 0 (of shares of runs: "
    "Newcombe's). It takes both answers as independent: with the same seed it is too wide, if anything."
)
ONE_RUN = "A single run of each is not evidence: repeated runs of the same cages can end differently."


def page(answer: Part) -> Page:
    """Return the page of `compare`: what a reader decides first, then the largest changes, then inputs."""
    named = [
        f"{one.title} ({printable(one.path, 80)}, seed {one.seed}){', interrupted' * (not one.complete)}"
        for one in answer.answers
    ]
    place = answer.environment and f"{answer.environment}, where no other is named"
    return Page(
        f"Two answers of {answer.of}",
        f"Compared by separatrix {answer.separatrix_version}",
        (
            facts(("First", named[0]), ("Second", named[1]), ("Environment", place)),
            Note(_lead(answer), "lead"),
            *_table("Results that differ", answer.rows or (), RESULTS),
            *(Note(text, "legend") for text in _notes(answer)),
            *_table("Inputs that differ", answer.inputs or (), INPUTS),
        ),
    )


def _lead(answer: Part) -> str:
    """Return the decisions that changed, and the numbers behind them that did so beyond noise."""
    if not answer.rows:
        return "The two answers are equal in every result."
    known = [row for row in answer.rows if row.name in DECISIONS or (row.name in MAIN and row.beyond_noise)]
    counts = Counter(_words(row.name) for row in known)
    changed = ", ".join(f"{name} ({count})" for name, count in counts.items())
    if not any(row.name in DECISIONS for row in known):
        more = f" Changed by more than counting noise: {changed}." if changed else ""
        return f"No verdict or rank changed.{more}"
    return f"Changed, numbers by more than counting noise: {changed}."


def _words(name: str) -> str:
    return quantity(name).label if name else "in the answer"


def _table(title: str, rows: Sequence[Part], columns: tuple[Column, ...]) -> Iterator[Heading | Table]:
    """Yield a table under its title: the first rows on a screen; else all."""
    more = f"{len(rows) - ON_A_SCREEN} more differ: `--full`." if len(rows) > ON_A_SCREEN else ""
    yield Heading(title)
    yield Table(title, columns, tuple(rows[:ON_A_SCREEN]), more, Level.BRIEF)
    yield Table(title, columns, tuple(rows), level=Level.LONG)


def _cell(row: Part, name: str) -> Cell:
    """Return a side of a row, or its change; a text or a truth as words."""
    found = row.get(name)
    value, low, high = (found.value, found.low, found.high) if found else (None, None, None)
    if not is_number(value):
        return Cell(ABSENT if value is None else str(value))
    form = ".0f" if isinstance(value, int) else ""
    known = Quantity(label=row.name, unit=quantity(row.name).unit, form=form)
    mark = MARK * bool(name == "change" and row.beyond_noise)
    is_top = name != "change" and low is not None and value >= quantity(row.name).top
    return Cell(Estimate(None, low) if is_top else Estimate(value, low, high), known, row.get("unit"), mark)


def _input(row: Part, which: str) -> str:
    return printable(value_words(row.values[which], row.get("unit") or ""), 120)


BOTH = ("first", "second")
RESULTS = (
    text_column("where", lambda row: row.place),
    text_column("what", lambda row: _words(row.name)),
    *(Column(which, partial(_cell, name=which), is_text=True) for which in (*BOTH, "change")),
)
INPUTS = (
    text_column("input", lambda row: row.key),
    *(text_column(which, partial(_input, which=which)) for which in BOTH),
)


def _notes(answer: Part) -> Iterator[str]:
    if any(row.beyond_noise for row in answer.rows):
        yield LEGEND
    if answer.rows and answer.of == "simulate":
        yield ONE_RUN
    if answer.left_out:
        yield f"{answer.left_out} more results differ: too many to list."
    if answer.also:
        yield f"Both also have answers of {', '.join(answer.also)}: name those files to compare them."


VERB = Tool(
    name="compare",
    compute=compute,
    page=page,
    epilog="A and B are folders of answers, their .json or .html files, of any verb with a study.",
    options=Options,
    rows="rows",
    folder="compare",
)
