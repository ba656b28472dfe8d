"""Tables of numbers in the sheets of an .xlsx workbook.

A table is a block of rows of numbers under a row of names, perhaps with a row of units between them; what
stands above as name and value is metadata. Only the columns that are asked for are read: words may stand in
the others. A cell that is empty, that holds a mark for a missing value or that shows an error has no value. A
formula has the value that was saved with it; dates and times of day are seconds since the first row.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from separatrix.errors import InputError
from separatrix.spreadsheet import Cell, Row, Workbook, cell_name, column_name, open_workbook
from separatrix.tribometer.column_map import TextFormat
from separatrix.tribometer.header import bare_unit, is_units
from separatrix.tribometer.log import RawTable, Wanted
from separatrix.tribometer.sheet_numbers import plain_numbers
from separatrix.units import Array, printable, shown

MOST_HEADER_ROWS = 2000
MOST_COLUMNS = 1000
LEAST_NUMBERS = 2
"""Numbers in a row that make it one of a table: friction, and what it is logged against."""

SECONDS_IN_A_DAY = 86_400.0
_NOTHING_SAID = TextFormat()


def _every(headers: Sequence[str], units: Sequence[str]) -> Sequence[int]:  # noqa: ARG001  one signature for all
    return range(len(headers))


@dataclass(frozen=True, slots=True)
class _Sheet:
    """A sheet, and what is asked of it."""

    workbook: Workbook
    name: str
    form: TextFormat
    wanted: Wanted
    headless: bool

    def at(self, place: str = "") -> str:
        """File, sheet, and a place in it."""
        where = f"{self.workbook.label}, sheet {printable(self.name)}"
        return f"{where}, {place}" if place else where

    def is_missing(self, cell: Cell) -> bool:
        """True for a cell that is empty, or marked as such."""
        if isinstance(cell.value, str):
            return cell.value.strip().casefold() in self.form.missing
        return cell.value is None

    def is_data(self, row: Row) -> bool:
        """True for a row of the table: two numbers or more, and at most twice as many words."""
        numbers = sum(_is_number(cell) for cell in row[1].values())
        words = sum(not _is_number(cell) and not self.is_missing(cell) for cell in row[1].values())
        return words <= 2 * numbers if numbers >= LEAST_NUMBERS else numbers == 1 and words == 0


def read_tables(
    path: Path, form: TextFormat = _NOTHING_SAID, wanted: Wanted = _every, *, headless: bool = False
) -> list[RawTable]:
    """Return the table of each sheet that has one.

    Parameters
    ----------
    path : Path
        The workbook.
    form : TextFormat
        What the column map says: sheets to read, rows of names and units, marks of a missing value.
    wanted : callable
        From headers and units to the numbers of the columns to read; the others are left NaN.
    headless : bool
        The columns are known by their numbers, so that a table may lack names.

    Raises
    ------
    InputError
        It is no workbook that can be read safely, no sheet has a table, or a column that is read holds what
        is neither a number nor missing.
    """
    workbook = open_workbook(path)
    names = form.tables if set(form.tables) <= set(workbook.sheets) else ()
    sheets = (_Sheet(workbook, name, form, wanted, headless) for name in names or workbook.sheets)
    tables = [table for sheet in sheets if (table := _table(sheet)) is not None]
    if not tables:
        cure = "Put the names of the columns in one row, and the numbers (not as text) below."
        raise InputError(workbook.label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return tables


def _table(sheet: _Sheet) -> RawTable | None:
    rows = sheet.workbook.rows(sheet.name)
    above, first = _split(rows, sheet)
    if not first:
        return None
    names, written, metadata = _headings(above, first[0], sheet)
    numbers = sorted({*names, *first[0][1]})
    if len(numbers) > MOST_COLUMNS:
        raise InputError(sheet.at(), f"has more than {MOST_COLUMNS} columns", str(len(numbers)))
    headers = tuple(names.get(n, f"column {column_name(n)}") for n in numbers)
    kinds = {n: _kind(first, n) for n in numbers}
    units = tuple(_unit(sheet, n, kinds[n], bare_unit(written.get(n, ""))) for n in numbers)
    needed = [numbers[i] for i in sheet.wanted(headers, units)]
    return RawTable(
        name=sheet.name,
        headers=headers,
        units=units,
        columns=_columns(sheet, chain(first, rows), first[0][0], kinds, needed),
        metadata=metadata,
    )


def _split(rows: Iterator[Row], sheet: _Sheet) -> tuple[list[Row], list[Row]]:
    """Rows above the table, and its first rows; a single row of numbers above other rows is metadata."""
    above: list[Row] = []
    first: list[Row] = []
    for row in rows:
        if row[0] > sheet.form.begin and sheet.is_data(row):
            first.append(row)
        else:
            above += [*first, row]
            first = []
        if len(first) == 2 or len(above) > MOST_HEADER_ROWS:
            break
    return above, first


def _is_number(cell: Cell) -> bool:
    return isinstance(cell.value, float)


Heading = tuple[dict[int, str], dict[int, str], dict[str, str]]


def _headings(above: list[Row], first: Row, sheet: _Sheet) -> Heading:
    """Names and units by column, and the metadata above them."""
    if sheet.form.header_line is not None:
        return _told(above, sheet)
    last = _texts(above[-1]) if above else {}
    if not last and sheet.headless:
        return {}, {}, _metadata(above)
    if not last:
        cure = "Put the names of the columns in the row above, or say which sheets to read: [format] tables."
        raise InputError(sheet.at(f"row {first[0]}"), "has numbers without names above them", cure=cure)
    units: dict[int, str] = {}
    if len(above) > 1 and is_units(list(last.values())) and _names_of(_texts(above[-2]), last, first):
        units = last
        above = above[:-1]
    names = _texts(above[-1])
    if len(above) > 1 and not set(first[1]) <= set(names):  # merged cells have their text in the upper row
        names = {n: text for n, text in _texts(above[-2]).items() if n in first[1]} | names
    return names, units, _metadata(above[:-1])


def _told(above: list[Row], sheet: _Sheet) -> Heading:
    """Names and units in the rows that the column map names."""
    texts = {number: _texts((number, cells)) for number, cells in above}
    form = sheet.form
    for key, number in (("header_line", form.header_line), ("units_line", form.units_line)):
        if number is not None and not texts.get(number):
            raise InputError(sheet.at(f"{key} = {number}"), "must be a row of texts")
    metadata = [row for row in above if row[0] < (form.header_line or 0)]
    return texts[form.header_line or 0], texts.get(form.units_line or 0, {}), _metadata(metadata)


def _texts(row: Row) -> dict[int, str]:
    return {n: cell.value.strip() for n, cell in row[1].items() if isinstance(cell.value, str)}


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


def _kind(first: list[Row], column: int) -> str:
    """How the first number of a column is shown: as a date, a percentage, or nothing special."""
    cells = (row[1][column] for row in first if column in row[1])
    return next((cell.format for cell in cells if _is_number(cell)), "")


def _unit(sheet: _Sheet, column: int, kind: str, written: str) -> str:
    """Unit of a column: as written, seconds of dates, percent of what is shown as such."""
    if kind == "date" and written not in ("", "s"):
        where = sheet.at(f"column {column_name(column)}")
        cure = "Format the column as a number, or take the unit away."
        rule = "holds dates or times of day, which have no unit"
        raise InputError(where, rule, shown(written), cure)
    return {"date": "s", "percent": "%"}.get(kind, written)


def _columns(
    sheet: _Sheet, rows: Iterator[Row], first: int, kinds: dict[int, str], needed: list[int]
) -> list[Array]:
    """The columns of a table, at once if its cells are alike; those that are not needed are NaN."""
    if not needed:
        return [np.empty(0)] * len(kinds)
    read = {n: kinds[n] for n in needed}
    raw = plain_numbers(sheet.workbook, sheet.name, first, list(kinds), read, sheet.form.missing)
    found = _Columns(sheet, read).read(rows) if raw is None else raw
    found = {n: _as_shown(values, kinds[n]) for n, values in found.items()}
    nothing = np.broadcast_to(np.float64(np.nan), (len(found[needed[0]]),))
    return [found.get(n, nothing) for n in kinds]


class _Columns:
    """Fills the columns of a table row by row."""

    def __init__(self, sheet: _Sheet, kinds: Mapping[int, str]) -> None:
        self._sheet = sheet
        self._kinds = kinds
        self._ended = 0

    def read(self, rows: Iterator[Row]) -> dict[int, Array]:
        """Return the columns of the rows by their numbers, as they are saved."""
        columns = {n: array("d") for n in self._kinds}
        for number, cells in rows:
            if self._goes_on(number, [cells[n] for n in columns if n in cells]):
                for n, column in columns.items():
                    cell = cells.get(n)
                    column.append(np.nan if cell is None else self._value(number, n, cell))
        return {n: np.array(column) for n, column in columns.items()}

    def _goes_on(self, row: int, cells: Sequence[Cell]) -> bool:
        """Whether a row belongs to the table; below its end there may be texts, but no second table."""
        if not any(_is_number(cell) for cell in cells):
            self._ended = self._ended or (0 if all(map(self._sheet.is_missing, cells)) else row)
            return False
        if self._ended:
            rule = f"has numbers again, after the table ended with row {self._ended}"
            raise InputError(self._sheet.at(f"row {row}"), rule, cure="Put a second table on its own sheet.")
        return True

    def _value(self, row: int, column: int, cell: Cell) -> float:
        if cell.formula:
            _check_formula(self._sheet, row, column, cell)
        if isinstance(cell.value, float):
            if cell.format != self._kinds[column]:
                raise self._mixed(column, cell.format or self._kinds[column])
            return cell.value
        if self._sheet.is_missing(cell):
            return np.nan
        where = self._sheet.at(f"cell {cell_name(row, column)}")
        cure = _cure(cell.value) if isinstance(cell.value, str) else ""
        raise InputError(where, "must be a number or empty", shown(cell.value), cure)

    def _mixed(self, column: int, kind: str) -> InputError:
        where = self._sheet.at(f"column {column_name(column)}")
        rule = f"holds both plain numbers and {'dates' if kind == 'date' else 'percentages'}"
        return InputError(where, rule, cure="Format the column in one way.")


def _as_shown(values: Array, kind: str) -> Array:
    """Numbers of a column in the unit of `_unit`: dates are saved as days, percentages as fractions."""
    if kind == "date":
        there = values[np.isfinite(values)]
        return np.asarray((values - there[:1]) * SECONDS_IN_A_DAY)
    return values * 100.0 if kind == "percent" else values


def _check_formula(sheet: _Sheet, row: int, column: int, cell: Cell) -> None:
    where = sheet.at(f"cell {cell_name(row, column)}")
    if sheet.workbook.has_links:
        rule = "is a formula in a workbook that takes values from other files, which are never opened"
        raise InputError(where, rule, cure="Paste it as a value.")
    if cell.value is None and not cell.error:
        cure = "Open the workbook in a spreadsheet program and save it."
        raise InputError(where, "holds a formula without a saved value", shown(f"={cell.formula}"), cure)


def _cure(text: str) -> str:
    if re.fullmatch(r"\s*[-+]?[0-9.,]+\s*", text):
        return "Enter it as a number, not as text."
    return f"If that means a missing value, add below [format] in a column map: missing = [{shown(text)}]."
