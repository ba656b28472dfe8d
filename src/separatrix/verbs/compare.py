"""`compare`: two saved answers of one verb side by side: what differs by more than counting noise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from separatrix.ground.document import Document, Part
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
from separatrix.verbs.parts.comparison import MAIN, UNCOUNTED_VERBS, Noise, compared, is_decision
from separatrix.verbs.parts.telling import quantity
from separatrix.verbs.saved_answers import is_number, read_answers
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


# --- the page -----------------------------------------------------------------------------------
Columns = tuple[Column, ...]
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
            *_tables("Verdicts and ranks that changed", lambda _: PLACE + SIDES, decisions, own),
            *_tables("Inputs that differ", lambda _: INPUTS, answer.inputs or (), own),
            *_tables("Results that differ", _changes, others, own),
            *_picture(answer, own),
            *(Note(text, "legend") for text in _notes(answer)),
        ),
    )


def _alike(rows: Sequence[Part]) -> list[Part]:
    """Return rows of which those that say the same of numbered parts, such as balls, are one."""

    def likeness(row: Part) -> tuple[str, ...]:
        stem, _, number = row.place.rpartition(" ")
        place = stem if number.isdigit() else row.place
        return place, row.name, *(_side(which)(row).text for which in ("first", "second"))

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
    title: str, columns: Callable[[bool], Columns], rows: Sequence[Part], own: str
) -> Iterator[Block]:
    """Yield a table under its title: what fits a screen there, of the own environment; else all."""
    ours = [_at(row.place.removeprefix(own), row) for row in rows if (row.get("place") or "").startswith(own)]
    shown = (ours or rows)[:ON_A_SCREEN]
    more = f"{len(rows) - len(shown)} more differ: `--full`." if len(rows) > len(shown) else ""
    yield Heading(f"{title} in {own.removesuffix(' / ')}" if ours else title, Level.BRIEF)
    yield Table(title, columns(False), tuple(shown), more, Level.BRIEF)
    yield Heading(title, Level.LONG)
    yield Table(title, columns(True), tuple(rows), "", Level.LONG)


def _words(name: str) -> str:
    return quantity(name).label if name else "in the answer"


def _told(row: Part, value: Any, low: float | None = None, high: float | None = None) -> Cell:
    """Return a value of a row as a cell; a text or a truth as words."""
    if not is_number(value):
        return Cell(ABSENT if value is None else str(value))
    form = ".0f" if isinstance(value, int) else ""
    known = Quantity(label=row.name, unit=quantity(row.name).unit, form=form)
    return Cell(Estimate(value, low, high), known, row.get("unit"))


def _side(which: str) -> Callable[[Part], Cell]:
    def cell(row: Part) -> Cell:
        side = row.get(which)
        return _told(row, side.value, side.low, side.high)

    return cell


SIDES = tuple(Column(which, _side(which), is_text=True) for which in ("first", "second"))
PLACE = text_column("where", lambda row: row.place), text_column("what", lambda row: _words(row.name))


def _changes(has_ends: bool) -> Columns:
    ends = ("change_low", "change_high") if has_ends else ()
    change = Column("change", lambda row: _told(row, row.change, *map(row.get, ends)), is_text=True)
    return *PLACE, *SIDES, change, text_column("noise", lambda row: Noise[row.noise].value)


def _input(which: str) -> Column:
    def words(row: Part) -> str:
        return printable(value_words(row.values[which], row.get("unit") or ""), 120)

    return text_column(which, words)


INPUTS = text_column("input", lambda row: row.key), _input("first"), _input("second")


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
    has_full=True,
)
