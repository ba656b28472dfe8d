"""Tables of numbers in the sheets of an .xlsx workbook.

A table is a block of rows of numbers under a row of names, perhaps with a row of units between them; what
stands above as name and value is metadata. A cell that is empty, that holds a mark for a missing value or
that shows an error has no value. A formula has the value that was saved with it.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from separatrix.errors import InputError
from separatrix.spreadsheet import Cell, Row, Workbook, cell_name, column_name, open_workbook
from separatrix.tribometer.log import RawTable
from separatrix.tribometer.sheet_numbers import plain_numbers
from separatrix.units import UNITS, Array, printable, shown

MISSING = frozenset({"", "x", "-", "--", "---", "na", "n/a", "nan", "none", "null"})
"""Marks of a missing value, in lower case."""

MOST_HEADER_ROWS = 2000
MOST_COLUMNS = 1000
LEAST_NUMBERS = 2
"""Numbers in a row that make it one of a table: friction, and what it is logged against."""

SECONDS_IN_A_DAY = 86_400.0
_OTHER_UNITS = ("", "-", "1", "%", "rpm", "C", "°C", "degC", "cycles", "rev", "laps", "V", "mV", "dB", "ppm")
_BRACKETED = re.compile(r"[\[(].{0,20}[\])]")


@dataclass(frozen=True, slots=True)
class _Sheet:
    """Where a refusal stands."""

    workbook: Workbook
    name: str

    def at(self, place: str = "") -> str:
        """File, sheet, and a place in it."""
        where = f"{self.workbook.label}, sheet {printable(self.name)}"
        return f"{where}, {place}" if place else where


def read_tables(path: Path) -> list[RawTable]:
    """Return the table of each sheet that has one.

    Raises
    ------
    InputError
        It is no workbook that can be read safely, no sheet has a table, or a table holds what is neither a
        number nor missing.
    """
    workbook = open_workbook(path)
    found = [_table(_Sheet(workbook, name)) for name in workbook.sheets]
    tables = [table for table in found if table is not None]
    if not tables:
        cure = "Put the names of the columns in one row, and the numbers below."
        raise InputError(workbook.label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return tables


def _table(sheet: _Sheet) -> RawTable | None:
    rows = sheet.workbook.rows(sheet.name)
    above, first = _split(rows)
    if first is None:
        return None
    header, units, metadata = _headings(above, first, sheet)
    numbers = sorted({*header, *first[1]})
    if len(numbers) > MOST_COLUMNS:
        raise InputError(sheet.at(), f"has more than {MOST_COLUMNS} columns", "", str(len(numbers)))
    table = _Columns(sheet, numbers)
    quick = plain_numbers(sheet.workbook, sheet.name, first[0], numbers)
    columns = quick if quick is not None else table.read(chain([first], rows))
    return RawTable(
        name=sheet.name,
        headers=tuple(header.get(n, f"column {column_name(n)}") for n in numbers),
        units=table.units(units, dated=quick is None),
        columns=columns,
        metadata=metadata,
    )


def _split(rows: Iterator[Row]) -> tuple[list[Row], Row | None]:
    """Rows above the first row of the table, and that row; None if there is none."""
    above: list[Row] = []
    for row in rows:
        if _is_data(row):
            return above, row
        above.append(row)
        if len(above) > MOST_HEADER_ROWS:
            break
    return above, None


def _is_data(row: Row) -> bool:
    cells = row[1].values()
    numbers = sum(_is_number(cell) for cell in cells)
    return numbers >= LEAST_NUMBERS and all(_is_number(cell) or _is_missing(cell) for cell in cells)


def _is_number(cell: Cell) -> bool:
    return isinstance(cell.value, float)


def _is_missing(cell: Cell) -> bool:
    if isinstance(cell.value, str):
        return cell.value.strip().casefold() in MISSING
    return cell.value is None


def _headings(
    above: list[Row], first: Row, sheet: _Sheet
) -> tuple[dict[int, str], dict[int, str], dict[str, str]]:
    """Names and units by column, and the metadata above them."""
    if not above or not _texts(above[-1]):
        cure = "Put the names of the columns in the row above."
        raise InputError(sheet.at(f"row {first[0]}"), "has numbers without names above them", cure=cure)
    last = _texts(above[-1])
    if len(above) > 1 and _are_units(last) and _names_of(_texts(above[-2]), last, first):
        return _texts(above[-2]), last, _metadata(above[:-2])
    return last, {}, _metadata(above[:-1])


def _texts(row: Row) -> dict[int, str]:
    return {n: cell.value.strip() for n, cell in row[1].items() if isinstance(cell.value, str)}


def _are_units(texts: Mapping[int, str]) -> bool:
    return all(_is_unit(text) for text in texts.values())


def _is_unit(text: str) -> bool:
    known = any(text in spellings for spellings in UNITS.values())
    return known or text in _OTHER_UNITS or _BRACKETED.fullmatch(text) is not None


def _names_of(names: Mapping[int, str], units: Mapping[int, str], first: Row) -> bool:
    """Whether a row of texts can be the names of the columns that have these units."""
    return bool(names) and set(units) <= set(names) and len(set(names) & set(first[1])) >= LEAST_NUMBERS


def _metadata(rows: list[Row]) -> dict[str, str]:
    """What stands as a name and, right of it, a value and perhaps a unit."""
    found: dict[str, str] = {}
    for _, cells in rows:
        texts = [_as_text(cell) for _, cell in sorted(cells.items())]
        name = texts[0].strip().rstrip(":=").strip() if texts else ""
        if name and len(texts) > 1:
            found.setdefault(name, " ".join(texts[1:]).strip())
    return found


def _as_text(cell: Cell) -> str:
    if isinstance(cell.value, float):
        return f"{cell.value:.15g}"
    return "" if cell.value is None else str(cell.value)


class _Columns:
    """Fills the columns of a table row by row."""

    def __init__(self, sheet: _Sheet, numbers: list[int]) -> None:
        self._sheet = sheet
        self._numbers = numbers
        self._known = set(numbers)
        self._dates = dict.fromkeys(numbers, 0)
        self._count = dict.fromkeys(numbers, 0)
        self._ended = 0

    def read(self, rows: Iterator[Row]) -> list[Array]:
        """Return the columns of the rows; dates and times of day in seconds."""
        columns = {n: array("d") for n in self._numbers}
        for number, cells in rows:
            if not self._goes_on(number, cells):
                continue
            for n, column in columns.items():
                cell = cells.get(n)
                column.append(np.nan if cell is None else self._value(number, n, cell))
        return [self._in_seconds(n, np.array(column)) for n, column in columns.items()]

    def _goes_on(self, row: int, cells: Mapping[int, Cell]) -> bool:
        """Whether a row belongs to the table; below its end there may be texts, but no second table."""
        if not any(_is_number(cell) for cell in cells.values()):
            self._ended = self._ended or (0 if all(map(_is_missing, cells.values())) else row)
            return False
        if self._ended:
            rule = f"has numbers again, after the table ended with row {self._ended}"
            raise InputError(self._sheet.at(f"row {row}"), rule, cure="Put a second table on its own sheet.")
        if extra := [n for n in cells if n not in self._known and not _is_missing(cells[n])]:
            where = self._sheet.at(f"cell {cell_name(row, extra[0])}")
            raise InputError(
                where, "stands in a column that has no name", cure="Name the column, or clear it."
            )
        return True

    def _value(self, row: int, column: int, cell: Cell) -> float:
        if cell.formula:
            _check_formula(self._sheet, row, column, cell)
        if isinstance(cell.value, float):
            self._count[column] += 1
            self._dates[column] += cell.format == "date"
            return cell.value
        if _is_missing(cell):
            return np.nan
        where = self._sheet.at(f"cell {cell_name(row, column)}")
        cure = _comma_cure(cell.value) if isinstance(cell.value, str) else ""
        raise InputError(where, "must be a number or empty", "", shown(cell.value), cure)

    def _in_seconds(self, column: int, values: Array) -> Array:
        dates = self._dates[column]
        if 0 < dates < self._count[column]:
            where = self._sheet.at(f"column {column_name(column)}")
            raise InputError(
                where, "holds both plain numbers and dates", cure="Format the column in one way."
            )
        return values * SECONDS_IN_A_DAY if dates else values

    def units(self, written: Mapping[int, str], *, dated: bool) -> tuple[str, ...]:
        """Return the units as written; of dates and times of day, seconds."""
        dates = [n for n in self._numbers if dated and self._dates[n]]
        for n in dates:
            if written.get(n, "") not in ("", "s"):
                where = self._sheet.at(f"column {column_name(n)}")
                cure = "Format the column as a number, or take the unit away."
                raise InputError(
                    where, "holds dates or times of day, which have no unit", "", shown(written[n]), cure
                )
        return tuple("s" if n in dates else written.get(n, "") for n in self._numbers)


def _check_formula(sheet: _Sheet, row: int, column: int, cell: Cell) -> None:
    where = sheet.at(f"cell {cell_name(row, column)}")
    if sheet.workbook.has_links:
        rule = "is a formula in a workbook that takes values from other files, which are never opened"
        raise InputError(where, rule, cure="Paste it as a value.")
    if cell.value is None and not cell.error:
        cure = "Open the workbook in a spreadsheet program and save it."
        raise InputError(where, "holds a formula without a saved value", "", shown(f"={cell.formula}"), cure)


def _comma_cure(text: str) -> str:
    return "Enter it as a number, not as text." if re.fullmatch(r"\s*[-+]?[0-9.,]+\s*", text) else ""
