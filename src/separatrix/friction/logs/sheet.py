"""Sheets of an .xlsx workbook as tab separated text, which the reader of text takes from there.

Row n of the sheet is line n of the text. Formulas have the value saved with them. Dates and times of day are
written as such.
"""

from __future__ import annotations

import datetime
import posixpath
import re
import zipfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.column_map import TextFormat
from separatrix.friction.logs.log import RawTable
from separatrix.units import printable
from separatrix.workbook_guard import SAVE_AGAIN, refuse_unsafe

MOST_ROWS_ABOVE = 2000  # rows in which the first rows of numbers are looked for
_NUMBERS = (float, datetime.datetime, datetime.date, datetime.time, datetime.timedelta)
_FIRST_DAY = datetime.datetime(1900, 1, 1)
_PIECE = 4 * 1024**2
_LITERAL = re.compile(r'"[^"]*"|\\.')
"""Part of a number format that is shown as it is: a % in it does not make a percentage."""

_ATTRIBUTE, _PLACE = re.compile(r'(\w+)="([^"]*)"'), re.compile("([A-Z]{1,3})([0-9]{1,7})")
_PREFIX = re.compile(rb"<(\w+:|)worksheet\b")
_BLANKS = str.maketrans("\t\r\n", "   ")


def sheets_as_text(path: Path, label: str) -> dict[str, bytes]:
    """Return the text of each sheet that holds a table of numbers, by its name."""
    import python_calamine

    refuse_unsafe(path, label)
    try:
        with python_calamine.CalamineWorkbook.from_path(path) as workbook:
            sheets = {name: workbook.get_sheet_by_name(name) for name in workbook.sheet_names}
            texts = {name: "\n".join(_lines(one.to_python(False))) for name, one in sheets.items()}
    except (python_calamine.CalamineError, OSError, ValueError) as error:
        raise _unreadable(label, error) from None
    found = {name: text.encode() for name, text in texts.items() if text}
    if not found:
        cure = "Put the names of the columns in one row, and the numbers (not as text) below."
        raise InputError(label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return found


def _lines(rows: Sequence[Sequence[object]]) -> Iterator[str]:
    """Yield a line for each row; none for a sheet without two rows of numbers, one below the other.

    From the second such row on, a row of words alone is a remark, which ends where its words do.
    """
    counts = [sum(isinstance(cell, _NUMBERS) for cell in row) for row in rows[:MOST_ROWS_ABOVE]]
    begin = next((i for i in range(1, len(counts)) if counts[i - 1] and counts[i]), None)
    for i, row in enumerate(rows if begin else ()):
        kinds = set(map(type, row))
        if kinds == {float}:
            yield "\t".join(map(repr, row))
            continue
        line = "\t".join(map(_written, row))
        has_numbers = not kinds.isdisjoint(_NUMBERS)
        yield line if has_numbers or (begin and i < begin and line.strip()) else line.rstrip()


def _written(cell: object) -> str:
    if isinstance(cell, str):
        return cell.translate(_BLANKS)
    if isinstance(cell, float):
        return repr(cell)
    return str(_FIRST_DAY + cell if isinstance(cell, datetime.timedelta) else cell)


@dataclass(frozen=True, slots=True)
class OddCells:
    """Cells of a sheet that are not what their value says, by column from 0 and row from 1."""

    percentages: dict[int, list[int]] = field(default_factory=dict)
    """Rows of the cells that are shown as percentages, by column. They hold fractions."""
    valueless: list[tuple[int, int, str]] = field(default_factory=list)
    """Column, row and error of each error cell; no error for a formula that was never computed."""


def odd_cells(path: Path, sheet: str, label: str) -> OddCells:
    """Return the percentages, the errors and the formulas without a value of a sheet.

    calamine returns neither formats nor errors, and openpyxl takes a minute for a million rows: the XML is
    searched for such cells.
    """
    found = OddCells()
    try:
        with zipfile.ZipFile(path) as archive:
            target, percent = _part_and_percentages(archive, sheet)
            with archive.open(target) as part:
                _search(part, percent, found)
    except (OSError, LookupError, ValueError, SyntaxError) as error:  # SyntaxError: of XML
        raise _unreadable(label, error) from None
    return found


def _part_and_percentages(archive: zipfile.ZipFile, sheet: str) -> tuple[str, set[str]]:
    """Return the part that holds a sheet, and the numbers of the cell styles that show percentages."""
    from openpyxl.xml.functions import fromstring

    names = {name.casefold(): name for name in archive.namelist()}

    def read(part: str) -> Any:
        return fromstring(archive.read(names[part.casefold()]))

    def related(part: str) -> tuple[dict[str, str], dict[str, str]]:
        """Return the parts that a part names, by their identifiers and by their kinds."""
        folder, _, name = part.rpartition("/")
        links = list(read(f"{folder}/_rels/{name}.rels".lstrip("/")))
        paths = [posixpath.normpath(posixpath.join("/", folder, one.get("Target")))[1:] for one in links]
        kinds = [one.get("Type").rpartition("/")[2] for one in links]
        ids = [one.get("Id") for one in links]
        return dict(zip(ids, paths, strict=True)), dict(zip(kinds, paths, strict=True))

    book = related("")[1]["officeDocument"]
    paths, kinds = related(book)
    sheets = {one.get("name"): dict(one.items()) for one in read(book).iterfind("{*}sheets/{*}sheet")}
    target = paths[next(value for key, value in sheets[sheet].items() if key.endswith("}id"))]
    if "styles" not in kinds:
        return names[target.casefold()], set()
    styles = read(kinds["styles"])
    formats = {"9": "0%", "10": "0.00%"}  # those that every workbook has
    formats |= {one.get("numFmtId"): one.get("formatCode") for one in styles.iterfind("{*}numFmts/{*}numFmt")}
    used = [formats.get(one.get("numFmtId"), "") for one in styles.iterfind("{*}cellXfs/{*}xf")]
    percent = {str(i) for i, text in enumerate(used) if "%" in _LITERAL.sub("", text)}
    return names[target.casefold()], percent


def _search(part: IO[bytes], percent: Collection[str], found: OddCells) -> None:
    """Note the odd cells of a sheet's XML, which is read in pieces that end with a row."""
    from openpyxl.utils import column_index_from_string

    left = part.read(_PIECE)
    prefix = _PREFIX.search(left)
    x = prefix[1].decode() if prefix else ""
    marks = "|".join(['t="e"', *(f's="{style}"' for style in sorted(percent))])
    formula = rf"<{x}f\b(?:[^<>]*/>|[^<>]*>[^<]*</{x}f>)\s*(?:<{x}v\s*(?:/>|></{x}v>)\s*)?</{x}c>"
    cells = re.compile(rf"<{x}c (?:[^<>]*?\b(?:{marks})|[^<>]*>\s*{formula})".encode())
    value = re.compile(rf"<{x}v>([^<]*)<".encode())
    while left:
        end = left.rfind(b"row>") + 4
        for cell in cells.finditer(left, 0, end) if end >= 4 else ():
            close = left.index(b">", cell.start())
            known = dict(_ATTRIBUTE.findall(left[cell.start() : close].decode()))
            place = _PLACE.fullmatch(known.get("r", ""))
            if place is None:
                raise ValueError("its cells do not state where they are")
            column, row = column_index_from_string(place[1]) - 1, int(place[2])
            if known.get("t") == "e":
                error = value.search(left, close)
                found.valueless.append((column, row, error[1].decode() if error else "#"))
            elif known.get("s") in percent:
                found.percentages.setdefault(column, []).append(row)
            elif known.get("t") != "str":  # a formula whose value is an empty text has one
                found.valueless.append((column, row, ""))
        piece = part.read(_PIECE)
        left = left[max(end, 0) :] + piece if piece else b""


def checked(
    table: RawTable, odd: OddCells, where: str, read: Sequence[int], percent: Sequence[int], form: TextFormat
) -> RawTable:
    """Return a table of a sheet, its columns of percent in percent where their cells hold fractions.

    `where` names the workbook and the sheet in a refusal, `percent` the columns that are in percent by their
    name or the column map. An error that `form` names means a missing value.
    """
    from openpyxl.utils import get_column_letter

    units, columns, lines = list(table.units), list(table.columns), np.asarray(table.lines)
    inside = set(lines.tolist()) if odd.valueless else set()
    for column, row, error in odd.valueless:
        if column not in read or row not in inside or error.casefold() in form.missing:
            continue
        place = f"{where}, cell {get_column_letter(column + 1)}{row}"
        if not error:
            cure = "Open the workbook in a spreadsheet program and save it."
            raise InputError(place, "holds a formula without a saved value", cure=cure)
        cure = f'If that means a missing value, add below [format] in the column map: missing = ["{error}"].'
        raise InputError(place, "holds an error", error, cure)
    for i in read:
        there = np.isfinite(columns[i])
        shown = np.isin(lines, odd.percentages.get(i, ())) & there
        if not shown.any():
            continue
        if not np.array_equal(shown, there):
            first = shown[there][0]
            row = int(np.flatnonzero(there & (shown != first))[0])
            rule = (
                "is a percentage among plain numbers" if not first else "is a plain number among percentages"
            )
            got = f"{columns[i][row]:g}" if first else f"{100.0 * columns[i][row]:g} %"
            place = f"{where}, cell {get_column_letter(i + 1)}{lines[row]}"
            raise InputError(place, rule, got, "Format all cells of the column alike.")
        if i in percent:
            units[i], columns[i] = "%", columns[i] * 100.0
    return replace(table, units=tuple(units), columns=columns)


def _unreadable(label: str, error: Exception) -> InputError:
    return InputError(label, f"is not a readable workbook: {printable(str(error), 100)}", cure=SAVE_AGAIN)
