"""Long tables of plain numbers in a sheet, many rows at once.

A log of a million rows is a hundred megabytes of XML in which every row looks like the one before. If every
row from the first to the last has just these columns, each a plain number or empty, it is cut out of the text
by one pattern; the count of rows, cells and brackets must agree with what the pattern found, or the answer is
None and the sheet is read event by event instead.
"""

from __future__ import annotations

import re
from itertools import chain

import numpy as np

from separatrix.spreadsheet import Workbook, column_name
from separatrix.spreadsheet.parts import Guard
from separatrix.units import Array

BLOCK = 16 * 1024**2
"""Bytes of XML matched at a time."""

MOST_STYLES = 500
"""Cell styles of a workbook up to which they go into the pattern."""


def plain_numbers(workbook: Workbook, sheet: str, first_row: int, columns: list[int]) -> list[Array] | None:
    """Return the columns from the first row of a table to the end of the sheet; None if not all are plain.

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
    """
    part = workbook.sheets[sheet]
    text = b"".join(Guard(workbook.label, part)(workbook.archive.pieces(part)))
    begin = re.search(rb'<row (?:[a-zA-Z]+="[^"<>]*" )*?r="%d"' % first_row, text)
    end = text.find(b"</sheetData>")
    if begin is None or end < 0 or workbook.has_links or len(workbook.formats) > MOST_STYLES:
        return None
    pattern = _pattern(columns, workbook.formats)
    blocks: list[Array] = []
    at = begin.start()
    while at < end:
        stop = text.find(b"</row>", min(at + BLOCK, end), end)
        stop = end if stop < 0 else stop + len(b"</row>")
        block = _block(text[at:stop], pattern, len(columns))
        if block is None:
            return None
        blocks.append(block)
        at = stop
    return list(np.concatenate(blocks).T.copy()) if blocks else None


def _pattern(columns: list[int], formats: list[str]) -> re.Pattern[bytes]:
    """Pattern of a row whose cells are these columns, each a number without a type or a formula, or empty."""
    styles = "|".join(str(i) for i, kind in enumerate(formats) if kind != "date")
    style = f'(?: s="(?:{styles})")?'
    filled = rf"{style}(?: t=\"n\")?><v>([-+.0-9eE]+)</v></c>"
    cells = "".join(f'(?:<c r="{column_name(n)}[0-9]+"(?:{filled}|{style}/>))?' for n in columns)
    return re.compile(rf"<row [^<>]*>{cells}</row>".encode())


def _block(text: bytes, pattern: re.Pattern[bytes], width: int) -> Array | None:
    """Numbers of a piece of the sheet, shape (row, column); None unless the pattern covers all of it."""
    rows = pattern.findall(text)
    flat = list(chain.from_iterable(rows)) if width > 1 else rows
    empty = text.count(b"/>")
    filled = len(flat) - flat.count(b"")
    if len(rows) != text.count(b"<row ") or filled + empty != text.count(b"<c "):
        return None
    if text.count(b"<") != 2 * len(rows) + 4 * filled + empty:
        return None  # something else stands between them
    try:
        numbers = np.array([float(number or b"nan") for number in flat])
    except ValueError:
        return None  # said with the name of the cell by who reads event by event
    return numbers.reshape(len(rows), width)
