"""Long tables of numbers in a sheet, many rows at once.

A log of a million rows is a hundred megabytes of XML in which every row looks like the one before. If every
row from the first to the last has just the columns of the first, and in those that are needed numbers of one
kind (written or saved with a formula) or nothing, it is cut out of the text by one pattern. The pattern must
leave no letter of the text, or the answer is None and the sheet is read event by event instead.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from separatrix.spreadsheet import Workbook, column_name
from separatrix.spreadsheet.parts import Guard
from separatrix.units import Array

BLOCK = 16 * 1024**2
"""Bytes of XML matched at a time."""

MOST_STYLES = 500
"""Cell styles of a workbook up to which they go into the pattern."""


def plain_numbers(
    workbook: Workbook, sheet: str, first_row: int, columns: Sequence[int], needed: Mapping[int, str]
) -> dict[int, Array] | None:
    """Return the needed columns from the first row of a table to the end of the sheet; None if not plain.

    Parameters
    ----------
    workbook : Workbook
        From `open_workbook`.
    sheet : str
        Name of the sheet.
    first_row : int
        Number of the table's first row.
    columns : sequence of int
        Numbers of its columns, rising.
    needed : mapping
        Those of them that are read, in the same order, with the kind of their numbers (`Cell.format`);
        anything may stand in the others.
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
    return dict(zip(needed, np.concatenate(blocks, axis=1), strict=True)) if blocks else None


def _pattern(columns: Sequence[int], needed: Mapping[int, str], formats: list[str]) -> re.Pattern[bytes]:
    """Pattern of a row of these columns: a needed cell is a number of its kind, or empty."""
    anything = "[^<>]*/>|[^<>]*(?<!/)>[^<]*(?:<(?!/c>)[^<]*)*</c>"
    cells = "".join(
        f'(?:<c r="{column_name(n)}[0-9]+"(?:{_number(needed[n], formats) if n in needed else anything}))?'
        for n in columns
    )
    return re.compile(rf"(<row [^<>]*>{cells}</row>\s*)".encode())


def _number(kind: str, formats: list[str]) -> str:
    """Pattern of a cell from its style on: a number of this kind, perhaps by a formula; or nothing at all."""
    styles = "|".join(str(i) for i, known in enumerate(formats) if known == kind)
    styled = f' s="(?:{styles})"' + ("" if kind else "|")
    formula = "(?:<f[^<>]*/>|<f[^<>]*(?<!/)>[^<>]*</f>)?"
    return rf'(?:{styled})(?: t="n")?>{formula}<v>([-+.0-9eE]+)</v></c>|(?: s="[0-9]+")?/>'


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
