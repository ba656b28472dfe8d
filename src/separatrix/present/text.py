"""A page as plain text, the same in every terminal: ASCII but for names, no colour, no width to guess."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

from separatrix.present.blocks import (
    Block,
    Equation,
    Facts,
    Heading,
    Level,
    Note,
    Page,
    ShownColumn,
    Table,
    spans,
)

WIDTH, TABLE, LABEL = 96, 100, 40
"""Most letters of a line of words, of a table, and of a label."""

LEAST = 24
"""Letters of a line of the last column of a table, where it is broken into lines."""

ASCII = str.maketrans(
    {"\N{MICRO SIGN}": "u", "\N{PLUS-MINUS SIGN}": "+/-", "\N{SUPERSCRIPT TWO}": "2", "\N{MINUS SIGN}": "-"}
)


def text(page: Page, level: Level = Level.BRIEF) -> str:
    """Return a page as text."""
    title = textwrap.shorten(page.title, WIDTH, placeholder=" ...")
    parts, shown = [f"{title}\n{'=' * len(title)}"], page.at(level).blocks
    for place, block in enumerate(shown):
        body = _block(block)
        if not body:
            continue
        follows = place > 0 and isinstance(shown[place - 1], Heading)
        parts.append(body if follows else f"\n{body}")
    return "\n".join(parts).translate(ASCII) + "\n"


def lead(page: Page) -> str:
    """Return the answer of a page in a few sentences, a paragraph each."""
    return "\n".join(map(words, page.lead)).translate(ASCII)


def _block(block: Block) -> str:
    match block:
        case Heading(text=title):
            line = words(title)
            return f"{line}\n{'-' * len(line)}"
        case Facts(pairs=pairs):
            return _facts([(words(label), words(cell.text)) for label, cell in pairs])
        case Table():
            caption = [_filled(words(block.caption), "  ", "  ")] if block.caption else []
            return "\n\n".join([_table(block), *caption])
        case Note(text=said, kind=kind):
            first, indent = {"lead": ("", ""), "caveat": ("Note: ", "      ")}.get(kind, ("  ", "  "))
            return _filled(words(said), first, indent)
        case Equation(words=said):
            return _filled(words(said), "  ", "  ")
        case _:
            return ""  # a picture is a file beside the text


def _facts(pairs: Sequence[tuple[str, str]]) -> str:
    """Return labels and values in two columns; a label as long as a sentence begins its own."""
    width = max((len(label) for label, _ in pairs if len(label) <= LABEL), default=0)
    return "\n".join(
        _filled(value, f"  {label:<{width}}  ", " " * (width + 4))
        if len(label) <= LABEL
        else _filled(f"{label}: {value}", "  ", "      ")
        for label, value in pairs
    )


def _filled(body: str, first: str, indent: str) -> str:
    return textwrap.fill(body, WIDTH, initial_indent=first, subsequent_indent=indent, break_on_hyphens=False)


def _table(table: Table) -> str:
    """Return a table; one that is too wide in parts, one below the other, each with the first column."""
    columns = table.shown
    cells = [[words(text) for text in one.texts] for one in columns]
    heads, widths = _heads(columns, cells, narrow=False)
    if sum(widths) + 2 * len(widths) > TABLE:
        heads, widths = _heads(columns, cells, narrow=True)
    signs = ["<" if one.is_text else ">" for one in columns]
    room = TABLE - sum(widths[:-1]) - 2 * len(widths)
    if columns[-1].is_text and LEAST <= room < widths[-1]:
        rows: list[Sequence[str]] = []
        for *row, last in zip(*cells, strict=True):
            first, *rest = textwrap.wrap(last, room) or [""]
            rows += [[*row, first], *([""] * len(row) + [more] for more in rest)]
        return _lines([heads, [*widths[:-1], room], signs], rows)
    parts = []
    for part in _parts(widths):
        rows = [*zip(*(cells[i] for i in part), strict=True)]
        parts.append(_lines([[one[i] for i in part] for one in (heads, widths, signs)], rows))
    return "\n\n".join(parts)


def _lines(columns: Sequence[Sequence[Any]], rows: Sequence[Sequence[str]]) -> str:
    """Return rows below their heads; `columns` has the heads of all, their widths, and their sides."""
    heads, widths, signs = columns
    tall = max(map(len, heads))
    above = [[*[""] * (tall - len(one)), *one] for one in heads]
    looks = [f"{sign}{width}" for sign, width in zip(signs, widths, strict=True)]
    body = [*zip(*above, strict=True), ["-" * width for width in widths], *rows]
    return "\n".join("  " + "  ".join(map(format, line, looks)).rstrip() for line in body)


def _parts(widths: Sequence[int]) -> list[list[int]]:
    """Return the places of the columns of each part that is not too wide."""
    parts: list[list[int]] = [[0]]
    for place in range(1, len(widths)):
        if sum(widths[i] + 2 for i in [*parts[-1], place]) > TABLE and parts[-1][1:]:
            parts.append([0])
        parts[-1].append(place)
    return parts


def _heads(
    columns: Sequence[ShownColumn], cells: Sequence[Sequence[str]], *, narrow: bool
) -> tuple[list[list[str]], list[int]]:
    """Return the lines above each column, head and unit, and its width: the least if `narrow`."""
    heads = []
    for one, each in zip(columns, cells, strict=True):
        unit = " ".join(filter(None, [one.unit, "(95 %)" if one.has_ends else ""]))
        head = words(one.head)
        least = max(map(len, [*each, *head.split(), unit, " " * 6])) if narrow else TABLE
        heads.append([*(textwrap.wrap(head, least) or [""]), *([unit] if unit else [])])
    return heads, [max(map(len, [*head, *each])) for head, each in zip(heads, cells, strict=True)]


def words(text: str) -> str:
    """Return a text with its symbols as letters; code stays between its backticks."""
    return "".join(f"`{part}`" if kind == "code" else part for kind, part in spans(text))
