"""A page of blocks: a verb makes it, a renderer shows it, neither knows the other."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Flag, auto
from typing import Any, Literal

from separatrix.ground.quantity import ABSENT, Estimate, Number, Quantity, alone, in_column, middle, scale
from separatrix.present.figure import Figure


class Level(Flag):
    """Where a block is shown: on a screen, with ``--full``, in a report, or only in a workbook."""

    BRIEF = auto()
    FULL = auto()
    REPORT = auto()
    SHEET = auto()
    LONG = FULL | REPORT
    ALWAYS = BRIEF | FULL | REPORT


TONES = ("STABLE", "UNSTABLE", "UNDECIDED")
"""Words that a renderer may colour."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A value with what describes it; `before` and `mark` stand around its text, no part of the number."""

    value: Number | str | bool
    quantity: Quantity | None = None
    unit: str = "-"
    mark: str = ""
    before: str = ""

    @property
    def is_number(self) -> bool:
        """Whether it is a number, perhaps an absent one."""
        return self.quantity is not None and not isinstance(self.value, str)

    @property
    def text(self) -> str:
        """As it stands alone."""
        if self.quantity is None or isinstance(self.value, str):
            return f"{ABSENT if self.value is None else self.value}{self.mark}"
        return self.before + alone(self.value, self.quantity, self.unit) + self.mark

    @property
    def scale(self) -> tuple[float, str]:
        """Size and symbol of the unit in which it is written alone."""
        if self.quantity is None or isinstance(self.value, str) or middle(self.value) is None:
            return 1.0, ""
        return scale([middle(self.value) or 0.0], self.unit, self.quantity.unit)


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: what is above it, and the cell of a row."""

    head: str
    cell: Callable[[Any], Cell]
    is_text: bool = False
    meaning: str = ""


@dataclass(frozen=True, slots=True)
class ShownColumn:
    """A column as every renderer shows it: its head, its unit, the texts of its cells, and these.

    `scales` are size and symbol of the unit in which each number is written.
    """

    head: str
    unit: str
    texts: tuple[str, ...]
    cells: tuple[Cell, ...]
    scales: tuple[tuple[float, str], ...]
    is_text: bool

    @property
    def has_ends(self) -> bool:
        """Whether its numbers have intervals."""
        return any(isinstance(one.value, Estimate) and one.value.has_ends for one in self.cells)

    @property
    def title(self) -> str:
        """Its head with its unit."""
        return self.head + f" [{self.unit}]" * bool(self.unit) + " (95 %)" * self.has_ends


@dataclass(frozen=True, slots=True)
class Heading:
    """Title of a section; it ends where the next of its depth begins."""

    text: str
    level: Level = Level.ALWAYS
    depth: Literal[2, 3] = 2


@dataclass(frozen=True, slots=True)
class Facts:
    """Labels, each with a value or a sentence."""

    pairs: tuple[tuple[str, Cell], ...]
    level: Level = Level.ALWAYS


@dataclass(frozen=True, slots=True)
class Table:
    """Rows under columns; `name` is that of its sheet in a workbook."""

    name: str
    columns: tuple[Column, ...]
    rows: tuple[Any, ...]
    caption: str = ""
    level: Level = Level.ALWAYS

    @property
    def shown(self) -> list[ShownColumn]:
        """Its columns with their texts: numbers of a column have one unit and the same decimals."""
        return [_shown(one, [one.cell(row) for row in self.rows]) for one in self.columns]


def _shown(column: Column, cells: Sequence[Cell]) -> ShownColumn:
    known = [one for one in cells if one.is_number and one.value is not None]
    kinds = {(one.quantity, one.unit) for one in known}
    unit, texts, scales = "", [one.text for one in cells], [one.scale for one in cells]
    if len(kinds) == 1:  # in a table of quantities as rows, each has its own unit
        numbers = [place for place, one in enumerate(cells) if one.is_number]
        first = known[0]
        values: list[Any] = [cells[place].value for place in numbers]
        found, unit, size = in_column(values, first.quantity or Quantity(label=""), first.unit)
        scales = [(size, unit)] * len(cells)
        for place, text in zip(numbers, found, strict=True):
            texts[place] = cells[place].before + text + cells[place].mark
    return ShownColumn(column.head, unit, tuple(texts), tuple(cells), tuple(scales), column.is_text)


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure, made when a renderer asks for it."""

    name: str
    figure: Callable[[], Figure]
    caption: str
    level: Level = Level.REPORT


@dataclass(frozen=True, slots=True)
class View:
    """A page of its own to look at and play, as text of HTML, made when it is asked for."""

    name: str
    html: Callable[[], str]
    caption: str
    level: Level = Level.REPORT


@dataclass(frozen=True, slots=True)
class Note:
    """A paragraph: the answer itself, text, a caveat, or what explains the table above it.

    Between backticks is code, between dollar signs a symbol: ``$eta$``, ``$f_BC$``.
    """

    text: str
    kind: Literal["lead", "text", "caveat", "legend"] = "text"
    level: Level = Level.ALWAYS


@dataclass(frozen=True, slots=True)
class Equation:
    """A formula in LaTeX, and what it is."""

    latex: str
    words: str
    level: Level = Level.REPORT


Block = Heading | Facts | Table | Picture | View | Note | Equation


@dataclass(frozen=True, slots=True)
class Page:
    """An answer: its title, what it was computed for, its blocks, and its inputs and their sources."""

    title: str
    subtitle: str
    blocks: tuple[Block, ...]
    appendix: tuple[Block, ...] = ()

    def at(self, level: Level) -> Page:
        """Return the page with the blocks of a level, without headings that nothing follows."""
        kept: list[Block] = []
        for one in reversed((*self.blocks, *self.appendix)):
            if not one.level & level or (isinstance(one, Table) and not one.rows):
                continue
            if isinstance(one, Facts) and not one.pairs:
                continue
            after = kept[-1] if kept else None
            is_bare = after is None or (isinstance(after, Heading) and after.depth <= _depth(one))
            if isinstance(one, Heading) and is_bare:
                continue
            kept.append(one)
        return replace(self, blocks=tuple(reversed(kept)), appendix=())

    def without_notes(self) -> Page:
        """Return the page without caveats and legends: the answer alone."""
        kept = [one for one in self.blocks if not isinstance(one, Note) or one.kind in ("lead", "text")]
        return replace(self, blocks=tuple(kept))

    @property
    def lead(self) -> tuple[str, ...]:
        """The answer in a few sentences."""
        return tuple(one.text for one in self.blocks if isinstance(one, Note) and one.kind == "lead")


def _depth(one: Block) -> int:
    return one.depth if isinstance(one, Heading) else 0


def joined(title: str, subtitle: str, parts: Sequence[tuple[str, Page]]) -> Page:
    """Return pages as sections of one, each under its title; notes that several have stand once.

    Its appendix is that of the first.
    """
    blocks: list[Block] = []
    for name, page in parts:
        blocks.append(Heading(name))
        for one in page.blocks:
            if isinstance(one, Heading):
                blocks.append(replace(one, depth=3))
            elif isinstance(one, Note) and one.kind == "lead" and page is not parts[0][1]:
                blocks.append(replace(one, kind="text"))
            elif not (isinstance(one, Note) and one.kind == "caveat" and one in blocks):
                blocks.append(one)
    return Page(title, subtitle, tuple(blocks), parts[0][1].appendix)


def facts(*pairs: tuple[str, Cell | str | None], level: Level = Level.ALWAYS) -> Facts:
    """Return labels with their values, without those that have none."""
    cells = ((label, one if isinstance(one, Cell) else Cell(one)) for label, one in pairs)
    return Facts(tuple((label, one) for label, one in cells if one.value not in (None, "")), level)


def text_column(head: str, text: Callable[[Any], Any], meaning: str = "") -> Column:
    """Return a column of words."""
    return Column(head, lambda row: Cell(text(row)), is_text=True, meaning=meaning)


def explained(columns: Iterable[Column]) -> str:
    """Return what those columns mean that say so, a sentence each."""
    return " ".join(f"{one.head}: {one.meaning}." for one in columns if one.meaning)


_MARKED = re.compile(r"`([^`]*)`|\$([A-Za-z]\w*(?:\(\w\))?)\$")

_MICRO = re.compile(r'"[^"]*"|`[^`]*`|(?<=\d )u(?=(?:m|s|N|W|J|Pa)\b)')
"""The u of a unit after its number; and what stays as it is written: quoted of a study file, or code."""


def spans(text: str) -> Iterator[tuple[Literal["text", "code", "symbol"], str]]:
    """Yield the parts of a text: words, what is between backticks, a symbol between dollar signs.

    A unit in words has the micro sign, as in tables; plain text has a u for both.
    """
    text, end = _MICRO.sub(lambda one: "\N{MICRO SIGN}" if one[0] == "u" else one[0], text), 0
    for one in _MARKED.finditer(text):
        if one.start() > end:
            yield "text", text[end : one.start()]
        yield ("code", one[1]) if one[2] is None else ("symbol", one[2])
        end = one.end()
    if text[end:]:
        yield "text", text[end:]


def grouped(pairs: Iterable[tuple[Any, Any]]) -> dict[Any, list[Any]]:
    """Return each first item with all its second ones, both in order."""
    found: dict[Any, list[Any]] = {}
    for key, one in pairs:
        found.setdefault(key, []).append(one)
    return found
