"""`compare`: two saved answers of one verb side by side: what differs by more than counting noise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from separatrix.ground.document import Document, Part
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import ABSENT, Estimate, Quantity, alone
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
from separatrix.present.figure import BLUE, GREY, VERMILION, Across, Axis, Band, Figure, Panel, Trace
from separatrix.verbs.parts.comparison import (
    MAIN,
    UNCOUNTED_VERBS,
    Input,
    Node,
    Noise,
    Plain,
    differences,
    differing,
    inputs_of_answer,
    is_decision,
    is_number,
    order,
    results,
    value_of,
)
from separatrix.verbs.parts.quantities import QUANTITIES
from separatrix.verbs.saved_answers import AGAIN, VERBS, read_answers, refusing_damage
from separatrix.verbs.verb import Option, Tool


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What `compare` takes."""

    first: Annotated[Path, Option("Folder or file of an answer.", "A", True)]
    second: Annotated[Path, Option("Another one of the same verb.", "B", True)]


MOST_ROWS, ON_A_SCREEN, IN_A_REPORT = 2000, 8, 40


def compute(options: Options) -> Document:
    """Compare two saved answers: verdicts, ranks, inputs, and each result with its counting noise."""
    sides = [read_answers(one) for one in (options.first, options.second)]
    return compared(*sides, names=(path_text(options.first), path_text(options.second)))


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
    verb = shared[0]
    sides = [_read(name, by_verb[verb]) for name, by_verb in zip(names, (first, second), strict=True)]
    one, other = sides
    rows = sorted(differing(verb, one.nodes, other.nodes), key=order)
    any_verdict, shared_verdicts = one.verdicts | other.verdicts, one.verdicts & other.verdicts
    return {
        "separatrix_version": __version__,
        "verb": "compare",
        "of": verb,
        "answers": [side.named for side in sides],
        "same_seed": one.named["seed"] == other.named["seed"],
        "environment": one.environment if one.environment == other.environment else None,
        "shared_verdicts": len(shared_verdicts) if any_verdict else None,
        "inputs": plain(tuple(differences(one.inputs, other.inputs)), left_out=[]),
        "rows": plain(tuple(rows[:MOST_ROWS]), left_out=[]),
        "left_out": max(0, len(rows) - MOST_ROWS),
        "also": shared[1:],
        "curves": [one.curve, other.curve] if one.curve and other.curve else None,
        "margins": [one.margins, other.margins] if one.margins and other.margins else None,
    }


class _Side(NamedTuple):
    """What is compared of an answer; its verdicts by place and name."""

    named: Document
    environment: str | None
    nodes: dict[tuple[str, ...], Node]
    verdicts: set[tuple[tuple[str, ...], str]]
    inputs: dict[str, Input]
    curve: list[Document]
    margins: list[Document]


def _read(name: str, one: Document) -> _Side:
    """Take from an answer what is compared; one that is damaged is refused under its name."""
    with refusing_damage(name):
        nodes, inputs, own = results(one, one["units"]), inputs_of_answer(one), one.get("environment")
        places = ((place, key) for place, node in nodes.items() for key in node.values)
        verdicts = {(place, key) for place, key in places if is_decision(key) and key != "rank"}
        environment = own if isinstance(own, str) else None
        side = _Side(_named(name, one), environment, nodes, verdicts, inputs, _curve(one), _margins(one))
    if not inputs:
        raise InputError(name, "contains a study that separatrix did not write", cure=AGAIN)
    return side


def _named(path: str, one: Document) -> Document:
    title, complete = printable(one["title"], 200), one.get("complete") is not False
    return {"path": path, "title": title, "seed": one["seed"], "complete": complete}


def _curve(one: Document) -> list[Document]:
    """Return the points of the stability curve of an answer, for the picture; none if it has no curve."""
    curve = one.get("curve") if one["verb"] == "stability" else (one.get("stability") or {}).get("curve")
    names = ("restitution_factor", "critical_friction", "scatter_low", "scatter_high")
    points = [{name: row.get(name) for name in names} for row in curve or ()]
    return [row for row in points if all(map(is_number, row.values()))]


def _margins(one: Document) -> list[Document]:
    """Return the margin of each candidate in the bearing's own environment, in the order of their ranks."""
    if one["verb"] != "rank":
        return []
    rows: list[Document] = next(
        (env["materials"] for env in one["environments"] if env["name"] == one["environment"]), []
    )
    found = []
    for row in rows:
        value = value_of("margin", row)
        if is_number(value.value):
            found.append({"name": row["name"], "margin": value.value, "low": value.low, "high": value.high})
    return found


# --- the page -----------------------------------------------------------------------------------
LEGEND = (
    "noise: MORE, or within: whether the 95 % interval of the change excludes 0 (shares of runs: Newcombe's "
    "interval). exact: not counted in runs, exact up to the model. ?: from runs, without an interval."
)
EXACT = "No counting: these results are exact up to the model."
ONE_RUN = "A single run of each is not evidence: repeated runs of the same cages can end differently."


def page(answer: Part) -> Page:
    """Return the page of `compare`: what a reader decides first, then inputs, then the largest changes."""
    rows = _alike([_Shown(one, answer.get("environment") or "") for one in answer.rows])
    decisions = sorted((one for one in rows if is_decision(one.row.name)), key=lambda one: not one.is_short)
    others = [one for one in rows if not is_decision(one.row.name)]
    named = [
        f"{one.title} ({printable(one.path, 80)}, seed {one.seed})"
        + ("" if one.complete else ", interrupted")
        for one in answer.answers
    ]
    largest = "Results that differ", ", the largest changes first"
    return Page(
        f"Two answers of {answer.of}",
        f"Compared by separatrix {answer.separatrix_version}",
        (
            facts(("First", named[0]), ("Second", named[1])),
            Note(" ".join(_lead(answer)), "lead"),
            *_long(("Verdicts and ranks that changed", ""), _decided(), _decided(is_brief=True), decisions),
            *_long(("Inputs that differ", ""), _inputs(), _inputs(), answer.get("inputs") or []),
            *_long(largest, _changes(), _changes(is_brief=True), others),
            *_pictures(answer),
            *(Note(text, "legend") for text in _notes(answer)),
        ),
    )


@dataclass(frozen=True, slots=True)
class _Shown:
    """A row, with the environment that is left out before its place, and how many others are like it."""

    row: Part
    own: str
    others: int = 0

    @property
    def place(self) -> str:
        """Where it is, among the rows of a screen."""
        more = f" and {self.others} more" if self.others else ""
        return str(self.row.place).removeprefix(f"{self.own} / ") + more

    @property
    def is_short(self) -> bool:
        """Whether it is for a screen: of the own environment, and not kick by kick."""
        place = self.row.place
        is_own = not self.own or place.startswith(f"{self.own} / ")
        return (is_own or place.partition(" ")[0] in ("", "chain")) and place.count(" / ") < 2

    @property
    def is_main(self) -> bool:
        """Whether a reader decides by it."""
        return self.row.name in MAIN and self.of_runs

    @property
    def of_runs(self) -> bool:
        """Whether it is not one of the chain's results, which other verbs have too."""
        return not self.row.place.startswith("chain")


def _alike(rows: Sequence[_Shown]) -> list[_Shown]:
    """Return rows of which those that say the same of numbered parts, such as balls, are one."""
    alike = grouped((_likeness(one), one) for one in rows)
    return [_Shown(same[0].row, same[0].own, len(same) - 1) for same in alike.values()]


def _likeness(one: _Shown) -> tuple[str, ...]:
    row, (stem, _, number) = one.row, one.row.place.rpartition(" ")
    place = stem if number.isdigit() else row.place
    return place, row.name, *(_side(which)(one).text for which in ("first", "second"))


def _lead(answer: Part) -> Iterator[str]:
    """Yield what a reader decides by."""
    rows, shared = answer.rows, answer.shared_verdicts
    if not rows:
        yield "The two answers are equal in every result."
        return
    changed = sum(is_decision(row.name) and row.name != "rank" for row in rows)
    if shared == 0:
        yield "The two answers have no verdict in common."
    elif shared is not None:
        yield (
            f"{changed} of {shared} verdicts changed."
            if changed
            else f"No verdict changed ({shared} compared)."
        )
    ranks = [row for row in rows if row.name == "rank" and row.place.startswith(f"{answer.environment} / ")]
    was, now = (
        " and ".join(row.place.rpartition(" / ")[2] for row in ranks if row.get(which).value == 1)
        for which in ("first", "second")
    )
    if was and now:
        yield f"First in {answer.environment}: {was} in the first answer, {now} in the second."
    main = [row.name for row in rows if row.name in MAIN and row.noise == "BEYOND"]
    for name in dict.fromkeys(main):
        count = main.count(name)
        yield f"{count} value{'s'[: count != 1]} of {_words(name)} changed by more than counting noise."


Columns = tuple[Column, ...]


def _long(title: tuple[str, str], whole: Columns, brief: Columns, rows: Sequence[Any]) -> Iterator[Block]:
    """Yield a table under its title: what fits a screen there, all of it elsewhere."""
    if not rows:
        return
    name, own = title[0].lower(), ""
    short = [one for one in rows if isinstance(one, _Shown) and one.is_short]
    if short:
        own = f" in {short[0].own}" if short[0].own else ""
        short = [one for one in short if one.is_main] or [one for one in short if one.of_runs] or short
    shown = tuple((short or rows)[:ON_A_SCREEN])
    more = f"{len(rows) - len(shown)} more differ: `--full`." if len(rows) > len(shown) else ""
    yield Heading(f"{title[0]}{own}{title[1]}", Level.BRIEF)
    yield Table(name, brief, shown, more, Level.BRIEF)
    yield Heading("".join(title), Level.LONG)
    yield Table(name, whole, tuple(rows[:IN_A_REPORT]), "", Level.LONG)
    if len(rows) > IN_A_REPORT:
        yield Note(f"{len(rows) - IN_A_REPORT} more differ: `--full`.", "legend", Level.REPORT)
    yield Table(f"{name}, more", whole, tuple(rows[IN_A_REPORT:]), "", Level.FULL | Level.SHEET)


def _words(name: str) -> str:
    if not name:
        return "in the answer"
    known = QUANTITIES.get(name)
    return known.label if known else name.replace("_", " ")


def _told(row: Part, value: Plain, low: float | None, high: float | None) -> Cell:
    """Return a value of a row as a cell; a text or a truth as words."""
    if not is_number(value):
        return Cell(ABSENT if value is None else str(value))
    known = QUANTITIES.get(row.name)
    unit, form = known.unit if known else "", ".0f" if isinstance(value, int) else ""
    return Cell(Estimate(value, low, high), Quantity(label=row.name, unit=unit, form=form), row.get("unit"))


def _side(which: str) -> Callable[[_Shown], Cell]:
    def cell(one: _Shown) -> Cell:
        side = one.row.get(which)
        return _told(one.row, side.value, side.low, side.high)

    return cell


def _decided(*, is_brief: bool = False) -> Columns:
    return (
        text_column("where", lambda one: one.place if is_brief else one.row.place),
        text_column("what", lambda one: _words(one.row.name)),
        Column("first", _side("first"), is_text=True),
        Column("second", _side("second"), is_text=True),
    )


def _changes(*, is_brief: bool = False) -> Columns:
    def change(one: _Shown) -> Cell:
        ends = (None, None) if is_brief else (one.row.change_low, one.row.change_high)
        return _told(one.row, one.row.change, *ends)

    noise = text_column("noise", lambda one: Noise[one.row.noise].value)
    return *_decided(is_brief=is_brief), Column("change", change, is_text=True), noise


def _inputs() -> Columns:
    def value(which: str) -> Callable[[Part], str]:
        return lambda row: input_words(row.get(which), row.get("unit"))

    key = text_column("input", lambda row: row.key)
    return key, text_column("first", value("first")), text_column("second", value("second"))


def input_words(value: Any, unit: str | None) -> str:
    """Return the value of an input in one of the answers."""
    if isinstance(value, Part):
        return "given"
    if isinstance(value, list):
        return printable(", ".join(input_words(one, unit) for one in value), 120) or ABSENT
    if is_number(value):
        return alone(float(value), Quantity(label="", digits=5), unit or "-")
    return ABSENT if value is None else printable(str(value), 120)


def _notes(answer: Part) -> Iterator[str]:
    if answer.rows and answer.of in UNCOUNTED_VERBS:
        yield EXACT
    elif answer.rows and answer.of == "simulate":
        yield ONE_RUN
    elif answer.rows:
        yield LEGEND
        if answer.same_seed:
            same = f"Both draw the same disturbances (seed {answer.answers[0].seed})"
            yield f"{same}; the intervals take their runs as independent."
    if answer.left_out:
        yield f"{answer.left_out} more results differ: too many to list."
    if answer.also:
        yield f"Both also have answers of {', '.join(answer.also)}: name those files to compare them."


# --- the picture --------------------------------------------------------------------------------
def _pictures(answer: Part) -> Iterator[Picture]:
    """Yield one picture with both answers: the curves, the margins, or both side by side."""
    makers = [maker for name, maker in (("curves", _curves), ("margins", _dots)) if name in answer]
    if not makers:
        return
    titles = [one.title for one in answer.answers]
    names = titles if titles[0] != titles[1] else [one.path for one in answer.answers]

    def figure() -> Figure:
        return Figure(
            rows=(tuple(maker(answer, letter) for maker, letter in zip(makers, "ab", strict=False)),),
            heading=tuple(f"{which}: {name}" for which, name in zip(("First", "Second"), names, strict=True)),
            alt="Both answers over the same axes; the tables have the numbers that differ.",
            height=2.9,
        )

    yield Picture("comparison", figure, "Both answers over the same axes, with 95 % intervals.")


LOOKS = ((BLUE, "o", "-", "first"), (VERMILION, "s", "--", "second"))


def _curves(answer: Part, letter: str) -> Panel:
    """Return critical friction against the restitution factor, of both."""
    marks: list[Any] = []
    for points, (colour, _, line, name) in zip(answer.values["curves"], LOOKS, strict=True):
        x, y, low, high = (
            [one[key] for one in points]
            for key in ("restitution_factor", "critical_friction", "scatter_low", "scatter_high")
        )
        marks += [Band(x=x, low=low, high=high, colour=colour, opacity=0.2)]
        marks += [Trace(x=x, y=y, colour=colour, line=line, name=name)]
    return Panel(
        title=f"{letter}  Critical friction",
        x=Axis(label="restitution factor $eta$ [-]"),
        y=Axis(label="critical friction $f_BC$ [-]", low=0.0),
        marks=tuple(marks),
    )


def _dots(answer: Part, letter: str) -> Panel:
    """Return the margin of each candidate with its interval, of both."""
    sides = answer.values["margins"]
    every = list(dict.fromkeys(one["name"] for side in sides for one in side))[::-1]
    marks: list[Any] = [Across(at=0.0, colour=GREY, line=":")]
    for side, shift, (colour, marker, _, name) in zip(sides, (0.14, -0.14), LOOKS, strict=True):
        values = [one["margin"] for one in side]
        low, high = (_known(side, end) for end in ("low", "high"))
        y = [every.index(one["name"]) + shift for one in side]
        look: dict[str, Any] = {"colour": colour, "marker": marker, "line": "", "name": name}
        marks.append(Trace(x=values, y=y, low=low, high=high, ends_along="x", **look))
    return Panel(
        title=f"{letter}  Margin in {answer.environment or 'the own environment'}",
        x=Axis(label="margin of the restitution factor [-]"),
        y=Axis(label="", names=tuple(every), low=-0.6, high=len(every) - 0.4),
        marks=tuple(marks),
    )


def _known(side: Sequence[Mapping[str, Any]], end: str) -> list[float]:
    return [one[end] if one[end] is not None else one["margin"] for one in side]


VERB = Tool(
    name="compare",
    epilog="A and B are folders of answers, their .json or .html files, of any verb with a study.",
    compute=compute,
    page=page,
    options=Options,
    has_full=True,
)
