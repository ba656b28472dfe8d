"""Long tables of plain numbers in a sheet, many rows at once.

A log of a million rows is a hundred megabytes of XML in which every row looks like the one before. If every
row from the first to the last has just the columns of the first, and plain numbers or nothing in those that
are needed, it is cut out of the text by one pattern. The pattern must leave no letter of the text, or the
answer is None and the sheet is read event by event instead.
"""

from __future__ import annotations

import re

import numpy as np

from separatrix.spreadsheet import Workbook, column_name
from separatrix.spreadsheet.parts import Guard
from separatrix.units import Array

BLOCK = 16 * 1024**2
"""Bytes of XML matched at a time."""

MOST_STYLES = 500
"""Cell styles of a workbook up to which they go into the pattern."""


def plain_numbers(
    workbook: Workbook, sheet: str, first_row: int, columns: list[int], needed: list[int]
) -> list[Array] | None:
    """Return the needed columns from the first row of a table to the end of the sheet; None if not plain.

    Parameters
    ----------
    workbook : Workbook
        From `open_workbook`.
    sheet : str
        Name of the sheet.
    first_row : int
        Number of the table's first row.
    columns : list of int
        Numbers of its columns, rising.
    needed : list of int
        Those of them that are read; anything may stand in the others.
    """
    part = workbook.sheets[sheet]
    text = b"".join(Guard(workbook.label, part)(workbook.archive.pieces(part)))
    begin = re.search(rb'<row (?:[a-zA-Z]+="[^"<>]*" )*?r="%d"' % first_row, text)
    end = text.find(b"</sheetData>")
    if begin is None or end < 0 or workbook.has_links or len(workbook.formats) > MOST_STYLES:
        return None
    pattern = _pattern(columns, needed, workbook.formats)
    blocks: list[Array] = []
    at = begin.start()
    while at < end:
        stop = text.find(b"</row>", min(at + BLOCK, end), end)
        stop = end if stop < 0 else stop + len(b"</row>")
        block = _block(text[at:stop], pattern)
        if block is None:
            return None
        blocks.append(block)
        at = stop
    return list(np.concatenate(blocks, axis=1)) if blocks else None


def _pattern(columns: list[int], needed: list[int], formats: list[str]) -> re.Pattern[bytes]:
    """Pattern of a row of these columns: a needed cell is a number without a type or a formula, or empty."""
    styles = "|".join(str(i) for i, kind in enumerate(formats) if not kind)
    style = f'(?: s="(?:{styles})")?'
    number = rf"{style}(?: t=\"n\")?><v>([-+.0-9eE]+)</v></c>|{style}/>"
    anything = "[^<>]*/>|[^<>]*(?<!/)>[^<]*(?:<(?!/c>)[^<]*)*</c>"
    cells = "".join(
        f'(?:<c r="{column_name(n)}[0-9]+"(?:{number if n in needed else anything}))?' for n in columns
    )
    return re.compile(rf"(<row [^<>]*>{cells}</row>\s*)".encode())


def _block(text: bytes, pattern: re.Pattern[bytes]) -> Array | None:
    """Numbers of a piece of the sheet, shape (column, row); None unless the pattern covers all of it."""
    rows = pattern.findall(text)
    if not rows or sum(len(row[0]) for row in rows) != len(text):
        return None
    _, *columns = zip(*rows, strict=True)
    try:
        return np.array([[float(number or b"nan") for number in column] for column in columns])
    except ValueError:
        return None  # said with the name of the cell by who reads event by event
