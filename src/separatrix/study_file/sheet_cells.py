"""Cells of a sheet of a study: which row says what, and where it stands."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from separatrix.errors import InputError
from separatrix.spreadsheet import Cell, Workbook, cell_name
from separatrix.units import printable, shown

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a section's sheet; key and value are required, others may be left out, in any order."""

MOST_ROWS = 2000
MOST_COLUMNS = 300
LONGEST_TEXT = 4000


@dataclass(frozen=True, slots=True)
class SheetText:
    """What stands in a sheet, and where to look for it."""

    label: str
    name: str
    cells: Mapping[tuple[int, int], Cell]
    columns: Mapping[str, int]
    """Column of each heading in the first row."""
    formulas: list[str] = field(default_factory=list)
    """Places of the formulas whose saved values are taken, as they are taken."""
    has_links: bool = False
    beyond: str = ""
    """Place of the first cell that was not read, for it stands too far from the first one."""

    @property
    def has_headings(self) -> bool:
        """Whether the first row has the headings of a section."""
        return "key" in self.columns and "value" in self.columns

    @property
    def place(self) -> str:
        """File and sheet."""
        return f"{self.label}, sheet {printable(self.name)}"

    def at(self, row: int, column: int) -> str:
        """File, sheet and cell."""
        return f"{self.place}, cell {cell_name(row, column)}"

    @property
    def last_row(self) -> int:
        """Number of the last row that has a cell."""
        return max((row for row, _ in self.cells), default=0)

    def given(self, row: int, column: int | None) -> Cell | None:
        """Return a cell that holds a value; None if it is empty.

        Raises
        ------
        InputError
            It holds an error, a date, too long a text, or a formula whose value cannot be trusted.
        """
        cell = None if column is None else self.cells.get((row, column))
        if cell is None or column is None or (isinstance(cell.value, str) and not cell.value.strip()):
            return None
        self._check(cell, self.at(row, column))
        if cell.formula:
            self.formulas.append(f"{printable(self.name)}!{cell_name(row, column)}")
        return cell

    def _check(self, cell: Cell, where: str) -> None:
        if cell.error:
            raise InputError(where, "shows an error instead of a value", cell.error)
        if cell.formula and self.has_links:
            rule = "is a formula in a workbook that takes values from other files, which are never opened"
            raise InputError(where, rule, cure="Paste it as a value.")
        if cell.value is None:
            cure = "Open the workbook in a spreadsheet program and save it, or enter the value."
            raise InputError(where, "holds a formula without a saved value", shown(f"={cell.formula}"), cure)
        if cell.format == "date":
            cure = "Format the cell as a number, and enter the value again."
            raise InputError(where, "holds a date or a time of day", cure=cure)
        if isinstance(cell.value, float) and not math.isfinite(cell.value):
            raise InputError(where, "must be a finite number", shown(cell.value))
        if isinstance(cell.value, str) and len(cell.value) > LONGEST_TEXT:
            raise InputError(where, f"is longer than {LONGEST_TEXT} characters")


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One row with a value."""

    key: str
    value: Cell
    spread: Cell | None
    unit: str
    key_place: str
    value_place: str
    spread_place: str
    unit_place: str
    cell: str


def sheet_text(workbook: Workbook, name: str) -> SheetText:
    """Return what stands in a sheet, which is not larger than a study's can be."""
    cells: dict[tuple[int, int], Cell] = {}
    place = f"{workbook.label}, sheet {printable(name)}"
    beyond = ""
    for row, columns in workbook.rows(name):
        far = next((n for n in columns if n > MOST_COLUMNS or row > MOST_ROWS), None)
        if far is not None and not beyond:
            beyond = f"{place}, cell {cell_name(row, far)}"
        if row > MOST_ROWS:
            break
        cells |= {(row, column): cell for column, cell in columns.items() if column <= MOST_COLUMNS}
    found: dict[str, int] = {}
    for (row, column), cell in cells.items():
        heading = str(cell.value).strip().casefold().replace("±", "+-") if row == 1 else ""
        if heading in COLUMNS and heading in found and {"key", "value"} <= {*found, heading}:
            where = f"{place}, cell {cell_name(row, column)}"
            raise InputError(where, "is a second column of that heading", shown(heading))
        if heading in COLUMNS:
            found[heading] = column
    return SheetText(workbook.label, name, cells, found, has_links=workbook.has_links, beyond=beyond)


def fields_of(sheet: SheetText) -> Iterator[Field]:
    """Yield the rows of a section's sheet that have a value.

    Raises
    ------
    InputError
        A value stands without a key, a width without a value, or a key or unit is no text.
    """
    key_column, value_column = sheet.columns["key"], sheet.columns["value"]
    spread_column = sheet.columns.get("+-")
    unit_column = sheet.columns.get("unit")
    for row in range(2, sheet.last_row + 1):
        key, value = sheet.given(row, key_column), sheet.given(row, value_column)
        spread = sheet.given(row, spread_column)
        if key is None and (value is not None or spread is not None):
            at = sheet.at(row, value_column if value is not None else spread_column or value_column)
            raise InputError(
                at, "is a value without a key", cure="Name the key in the same row, or clear it."
            )
        if value is None and spread is not None:
            raise InputError(sheet.at(row, spread_column or 0), "is a width without a value")
        if key is None or value is None:
            continue
        yield Field(
            key=_text(key, sheet.at(row, key_column)),
            value=value,
            spread=spread,
            unit=_unit(sheet, row, unit_column),
            key_place=sheet.at(row, key_column),
            value_place=sheet.at(row, value_column),
            spread_place=sheet.at(row, spread_column or value_column),
            unit_place=sheet.at(row, unit_column or value_column),
            cell=cell_name(row, key_column),
        )


def _unit(sheet: SheetText, row: int, column: int | None) -> str:
    cell = sheet.given(row, column)
    if cell is None or column is None:
        return ""
    text = _text(cell, sheet.at(row, column))
    return "" if text == "-" else text


def _text(cell: Cell, where: str) -> str:
    if not isinstance(cell.value, str):
        raise InputError(where, "must be text", shown(cell.value))
    return cell.value.strip()
