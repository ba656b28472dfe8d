"""Long tables of numbers in a sheet, many rows at once.

A log of a million rows is a hundred megabytes of XML in which every row looks like the one before. If every
row from the first to the last has just the columns of the first, and in those that are needed numbers of one
kind (written or saved with a formula), nothing, or a mark for a missing value, it is cut out of the text by
one pattern. The pattern must leave no letter of the text, or the answer is None and the sheet is read event
by event instead.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from xml.parsers import expat

import numpy as np

from separatrix.errors import InputError
from separatrix.spreadsheet import Workbook, column_name
from separatrix.spreadsheet.parts import Guard
from separatrix.units import Array

BLOCK = 16 * 1024**2
"""Bytes of XML matched at a time."""

MOST_STYLES = 500
"""Cell styles and shared texts of a workbook up to which they go into the pattern."""

_FORMULA = "(?:<f[^<>]*/>|<f[^<>]*(?<!/)>[^<>]*</f>)?"
_INSIDE = "[^<]*(?:<(?!/c>)[^<]*)*</c>"
_ANYTHING = f"[^<>]*/>|[^<>]*(?<!/)>{_INSIDE}"


def plain_numbers(
    workbook: Workbook,
    sheet: str,
    first_row: int,
    columns: Sequence[int],
    needed: Mapping[int, str],
    missing: Collection[str],
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
    missing : collection of str
        Texts that mean a missing value, in lower case.
    """
    part = workbook.sheets[sheet]
    text = b"".join(Guard(workbook.label, part)(workbook.archive.pieces(part)))
    begin = re.search(rb'<row (?:[a-zA-Z]+="[^"<>]*" )*?r="%d"' % first_row, text)
    end = text.find(b"</sheetData>")
    if begin is None or end < 0 or workbook.has_links or len(workbook.formats) > MOST_STYLES:
        return None
    table = _numbers(text, begin.start(), end, _pattern(columns, needed, workbook.formats))
    if table is None:
        marked = _pattern(columns, needed, workbook.formats, *_with_words(workbook, missing))
        table = _numbered(text, _numbers(text, begin.start(), end, marked))
    return None if table is None else dict(zip(needed, table, strict=True))


def _numbers(text: bytes, at: int, end: int, pattern: re.Pattern[bytes]) -> Array | None:
    """Numbers of the rows in a part of the text, shape (group of the pattern, row)."""
    blocks: list[Array] = []
    while at < end:
        stop = text.find(b"</row>", min(at + BLOCK, end), end)
        stop = end if stop < 0 else stop + len(b"</row>")
        block = _block(text[at:stop], pattern)
        if block is None:
            return None
        blocks.append(block)
        at = stop
    return np.concatenate(blocks, axis=1) if blocks else None


def _numbered(text: bytes, table: Array | None) -> Array | None:
    """Rows that have any number, without their own in front; None if they or the XML are not in order."""
    if table is None or not (np.diff(table[0]) > 0).all():
        return None
    try:
        expat.ParserCreate().Parse(text, True)
    except expat.ExpatError:
        return None  # said by who reads event by event, as are texts that cannot be read
    return np.asarray(table[1:, ~np.isnan(table[1:]).all(axis=0)])


def _pattern(
    columns: Sequence[int],
    needed: Mapping[int, str],
    formats: list[str],
    mark: str = "",
    other: str = _ANYTHING,
) -> re.Pattern[bytes]:
    """Pattern of a row of these columns, where marks are known also of its number and that of its cells."""
    row = r'<row (?:[a-zA-Z]+="[^"<>]*" )*?r="([1-9][0-9]{0,6})"[^<>]*>' if mark else "<row [^<>]*>"
    number = r"\1" if mark else "[0-9]+"
    kinds = {n: _number(needed[n], formats) + mark if n in needed else other for n in columns}
    cells = "".join(f'(?:<c r="{column_name(n)}{number}"(?:{kind}))?' for n, kind in kinds.items())
    return re.compile(rf"{row}{cells}</row>\s*".encode())


def _number(kind: str, formats: list[str]) -> str:
    """Pattern of a cell from its style on: a number of this kind, perhaps by a formula; or nothing at all."""
    styles = "|".join(str(i) for i, known in enumerate(formats) if known == kind)
    styled = f' s="(?:{styles})"' + ("" if kind else "|")
    return rf'(?:{styled})(?: t="n")?>{_FORMULA}<v>([-+.0-9eE]+)</v></c>|(?: s="[0-9]+")?/>'


def _with_words(workbook: Workbook, missing: Collection[str]) -> tuple[str, str]:
    """Patterns of a cell that holds a mark or an error, and of any cell that can be read."""
    try:
        strings = workbook.strings[:MOST_STYLES]
    except InputError:
        strings = []
    gone = "|".join(str(i) for i, text in enumerate(strings) if text.strip().casefold() in missing)
    plain = [word for word in missing if word == word.strip().casefold() and word.isprintable()]
    words = "|".join(re.escape(word) for word in plain if not set(word) & set("&<>_"))
    word = rf"[ \t\r\n]*+(?i:{words or '(?!)'})[ \t\r\n]*+"
    mark = (
        rf'|(?: s="[0-9]+")?(?: t="e">{_FORMULA}<v>[^<>&]+</v>| t="str">{_FORMULA}<v>{word}</v>'
        rf'| t="s">{_FORMULA}<v>(?:{gone or "(?!)"})</v>'
        rf'| t="inlineStr"><is><t(?: xml:space="preserve")?>{word}</t></is>)</c>'
    )
    number = r"-?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?"
    shared = "|".join(map(str, range(len(strings)))) or "(?!)"
    other = (
        rf'(?: s="[0-9]+")?(?:(?: t="n")?>{_FORMULA}(?:<v>{number}</v>)?</c>'
        rf'| t="s">{_FORMULA}<v>(?:{shared})</v></c>| t="(?:inlineStr|str|b|e)">{_INSIDE}|/>)'
    )
    return mark, other


def _block(text: bytes, pattern: re.Pattern[bytes]) -> Array | None:
    """Numbers of a piece of the sheet, shape (group, row); None unless the pattern covers all of it."""
    pieces = pattern.split(text)
    between, *columns = (pieces[i :: pattern.groups + 1] for i in range(pattern.groups + 1))
    if any(between):
        return None
    try:
        return np.array([[float(number or b"nan") for number in column] for column in columns])
    except ValueError:
        return None  # said with the name of the cell by who reads event by event
