"""A page as a workbook: a sheet for each table, one for facts and notes; numbers are numbers."""

from __future__ import annotations

import re
from typing import Any

from separatrix.ground.quantity import middle
from separatrix.ground.sheet import add_table, new_workbook, workbook_bytes
from separatrix.present.blocks import Cell, Facts, Heading, Level, Note, Page, ShownColumn, Table
from separatrix.present.text import words


def spreadsheet(page: Page) -> bytes:
    """Return a page as a workbook, with every table of any level."""
    book, names = new_workbook(), set[str]()
    blocks = page.at(Level.FULL | Level.REPORT | Level.SHEET).blocks
    about: list[tuple[str | None, str | None]] = [(page.title, None), (page.subtitle, None)]
    for one in blocks:
        if isinstance(one, Heading):
            about += [(None, None), (words(one.text), None)]
        elif isinstance(one, Note):
            about.append((words(one.text), None))
        elif isinstance(one, Facts):
            about += [(words(label), words(cell.text)) for label, cell in one.pairs]
    add_table(book, "about", ("", ""), about)
    for one in blocks:
        if isinstance(one, Table):
            parts = [part for column in one.shown for part in _parts(column)]
            heads = [head for head, _ in parts]
            rows = [*zip(*(values for _, values in parts), strict=True)]
            add_table(book, _name(one.name, names), heads, rows, keep_columns=2 if len(heads) > 4 else 1)
    return workbook_bytes(book)


def _name(name: str, taken: set[str]) -> str:
    """Return a name that Excel allows for a sheet, and that no other has."""
    plain = re.sub(r"[\[\]:*?/\\']", " ", name)[:31]
    found, number = plain, 2
    while found.casefold() in taken:
        found, number = f"{plain[:27]} {number}", number + 1
    taken.add(found.casefold())
    return found


def _parts(column: ShownColumn) -> list[tuple[str, list[Any]]]:
    """Return heads and values: an estimate takes three columns, marks and units of rows one of their own."""
    name = words(column.head)
    head = f"{name} [{column.unit}]" if column.unit else name
    sizes = [size for size, _ in column.scales]
    parts = [(head, [_value(one, size) for one, size in zip(column.cells, sizes, strict=True)])]
    if column.has_ends:
        for end in ("low", "high"):
            ends = [getattr(one.value, end, None) for one in column.cells]
            values = [None if v is None else v / size for v, size in zip(ends, sizes, strict=True)]
            parts.append((f"{head}, 95 % {end}", values))
    marks = [(one.before + one.mark).strip() or None for one in column.cells]
    if any(mark for mark, one in zip(marks, column.cells, strict=True) if one.is_number):
        parts.append((f"{name}, mark", marks))
    if not column.unit and any(symbol for _, symbol in column.scales):
        parts.append((f"{name}, unit", [symbol or None for _, symbol in column.scales]))
    return parts


def _value(cell: Cell, size: float) -> Any:
    """Return a number in its unit; what is none, as its text."""
    if not cell.is_number or isinstance(cell.value, str):
        return None if cell.value is None else words(cell.text)
    number = middle(cell.value)
    return number if number is None or isinstance(number, int) else number / size
