"""Cells of a study workbook, read by openpyxl.

Nothing is evaluated: a formula has the value that was saved with it. Macros and links to other files are
never followed.
"""

from __future__ import annotations

import datetime
import math
import re
import warnings
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from io import BytesIO
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeGuard

from separatrix.ground.errors import InputError
from separatrix.ground.input_files import note, size_of, unreadable
from separatrix.ground.sheet import SAVE_AGAIN, refuse_unsafe
from separatrix.ground.units import NUMBER, printable, shown

if TYPE_CHECKING:
    from openpyxl.cell.read_only import ReadOnlyCell

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a section's sheet; key and value are required, others may be left out, in any order."""

MOST_ROWS, MOST_COLUMNS = 2000, 300
LAST_ROW = 1_048_576
LONGEST_TEXT = 4000
SEPARATOR = ";"
Plain = float | int | str | bool

_PLAIN = re.compile(NUMBER)
_BEGINS_AS_NUMBER = re.compile(r"\s*[+-]?\.?[0-9]")


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell with a value: its file, sheet and name, and whether it is shown as a percentage."""

    value: Plain
    place: str
    is_percent: bool = False
    is_formula: bool = False

    @property
    def text(self) -> str:
        """Its text."""
        if not isinstance(self.value, str):
            raise InputError(self.place, "must be text", shown(self.value))
        return self.value.strip()


@dataclass(frozen=True, slots=True)
class Sheet:
    """Cells of a sheet by row and column, from 1; a cell with a fault raises it when it is used."""

    name: str
    place: str
    cells: Mapping[tuple[int, int], Cell | InputError]
    beyond: str = ""
    """Place of the first cell that was not read because it is too far from the first one."""

    formulas: dict[str, None] = field(default_factory=dict)
    """Sheet and name of the cells with formulas that were used."""

    def at(self, row: int, column: int) -> str:
        """Return file, sheet and cell."""
        from openpyxl.utils import get_column_letter

        return f"{self.place}, cell {get_column_letter(column)}{row}"

    @property
    def last_row(self) -> int:
        """Number of the last row that has a cell."""
        return max((row for row, _ in self.cells), default=0)

    def given(self, row: int, column: int | None) -> Cell | None:
        """Return a cell with a value; None if it is empty."""
        cell = None if column is None else self.cells.get((row, column))
        if isinstance(cell, InputError):
            raise cell
        if cell is not None and cell.is_formula:
            self.formulas[f"{printable(self.name)}!{cell.place.rpartition(' ')[2]}"] = None
        return cell

    def headings(self) -> dict[str, int]:
        """Return the columns of the texts in the first row, in small letters."""
        found: dict[str, int] = {}
        for (number, column), cell in self.cells.items():
            if number == 1 and isinstance(cell, Cell):
                heading = str(cell.value).strip().casefold().replace("±", "+-")
                if heading in COLUMNS and heading in found and {"key", "value"} <= found.keys():
                    raise InputError(cell.place, "is a second column of that heading", shown(heading))
                found[heading] = column
        return found


def sheets_of(path: Path, label: str, is_whole: Callable[[str], bool]) -> list[Sheet]:
    """Return the worksheets of a workbook: all rows of those that `is_whole` selects, two of the others."""
    from openpyxl.reader.excel import ExcelReader

    has_links = _refuse_other_kinds(path, label)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on parts of the workbook that are not read
            content = path.read_bytes()
            note(path, content)
            reader = ExcelReader(BytesIO(content), True, data_only=True)
            reader.read()
            parts = {sheet.name: relation.target for sheet, relation in reader.parser.find_sheets()}
            if absent := [name for name, part in parts.items() if part not in reader.valid_files]:
                raise InputError(label, "has a sheet without content", shown(absent[0]), SAVE_AGAIN)
            found = []
            for sheet in reader.wb.worksheets:
                most = LAST_ROW if is_whole(sheet.title) else 2
                place = f"{label}, sheet {printable(sheet.title)}"
                with reader.archive.open(parts[sheet.title]) as part:
                    formulas = _formulas(part, place, most)
                found.append(_sheet(sheet, formulas, Sheet(sheet.title, place, {}), most, has_links))
    except InputError:  # which is a ValueError, too
        raise
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, SyntaxError, OSError) as error:
        why = printable(str(error.__cause__ or error).partition("\n")[0], 100).rstrip(".")
        raise InputError(label, f"is not a readable workbook: {why}", cure=SAVE_AGAIN) from None
    return found


def _refuse_other_kinds(path: Path, label: str) -> bool:
    """Refuse all but an .xlsx workbook without macros; return whether it takes values from other files."""
    if size_of(path, label) == 0:
        raise InputError(label, "is empty")
    try:
        with path.open("rb") as file:
            start = file.read(8)
    except OSError as error:
        raise unreadable(label, error) from None
    if start == b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1":
        rule = "is an .xls workbook of the old kind, or has a password"
        raise InputError(label, rule, cure="Save it as .xlsx without a password.")
    refuse_unsafe(path, label)
    with zipfile.ZipFile(path) as container:
        parts = container.namelist()
        types = container.read("[Content_Types].xml") if "[Content_Types].xml" in parts else b""
    names = {name.casefold() for name in parts}
    kinds = {"content.xml": "an OpenDocument file", "xl/workbook.bin": "a binary workbook, .xlsb"}
    for mark in kinds.keys() & names:
        raise InputError(label, f"is {kinds[mark]}, which is not read", cure="Save it as .xlsx.")
    if b"macroEnabled" in types or any(n.endswith("vbaproject.bin") or "macrosheets/" in n for n in names):
        cure = "Save it as .xlsx, which keeps no macros."
        raise InputError(label, "has macros, which are never run", cure=cure)
    if "xl/workbook.xml" not in names:
        raise InputError(label, "is a zip file, but not a workbook", cure=SAVE_AGAIN)
    return any("externallinks/" in name for name in names)


def _formulas(part: IO[bytes], place: str, most: int) -> dict[tuple[int, int], str]:
    """Return the formulas of a sheet by row and column, down to the row `most`."""
    from openpyxl.utils.cell import coordinate_to_tuple
    from openpyxl.xml.functions import iterparse

    found: dict[tuple[int, int], str] = {}
    row = column = 0
    for event, element in iterparse(part, ("start", "end")):
        kind, where = element.tag.rpartition("}")[2], element.get("r")
        if event == "start" and kind in ("row", "c"):
            if kind == "row":
                before, row, column = (row, 0), int(where or row + 1), 0
            else:
                before = (row, column)
                row, column = coordinate_to_tuple(where) if where else (row, column + 1)
            if (row, column) <= before or (kind == "c" and row != before[0]):
                rule = f"is damaged: its rows and cells are not in order ({where or row})"
                raise InputError(place, rule, cure=SAVE_AGAIN)
            if row > most:
                break
        elif event == "end" and kind == "f":
            found[row, column] = f"={element.text or ''}"
        elif event == "end" and kind == "row":
            element.clear()
        elif event == "end" and kind == "sheetData":
            break
    return found


def _sheet(
    saved: Any,
    formulas: Mapping[tuple[int, int], str],
    sheet: Sheet,
    most: int,
    has_links: bool,
) -> Sheet:
    found: dict[tuple[int, int], Cell | InputError] = {}
    saved.reset_dimensions()  # what a file states of its size may be wrong
    for row, cells in enumerate(saved.iter_rows(max_row=most), 1):
        for column, cell in enumerate(cells, 1):
            formula = formulas.get((row, column), "")
            if (cell.value is None and not formula) or (
                isinstance(cell.value, str) and not cell.value.strip()
            ):
                continue
            where = sheet.at(row, column)
            if row > MOST_ROWS or column > MOST_COLUMNS:
                return replace(sheet, cells=found, beyond=where if most > 2 else "")
            found[row, column] = _cell(cell, formula, where, has_links)
    return replace(sheet, cells=found)


def _cell(cell: ReadOnlyCell, formula: str, where: str, has_links: bool) -> Cell | InputError:
    """Return a cell with its value, or the refusal of its value."""
    value: Any = cell.value
    if cell.data_type == "e":
        return InputError(where, "shows an error instead of a value", str(value))
    if formula and has_links:
        rule = "is a formula in a workbook that takes values from other files, which are never opened"
        return InputError(where, rule, cure="Paste it as a value.")
    if formula and value is None:
        cure = "Open the workbook in a spreadsheet program and save it, or enter the value."
        return InputError(where, "has a formula without a saved value", shown(formula), cure)
    if isinstance(value, datetime.date | datetime.time | datetime.timedelta):
        cure = "Format the cell as a number, and enter the value again."
        return InputError(where, "has a date or a time of day", cure=cure)
    if isinstance(value, float) and not math.isfinite(value):
        return InputError(where, "must be a finite number", shown(value))
    if isinstance(value, str) and len(value) > LONGEST_TEXT:
        return InputError(where, f"is longer than {LONGEST_TEXT} characters")
    if isinstance(value, str):
        value = value.replace("_x005F_", "_")  # an underscore that would begin the code of a character
    return Cell(value, where, "%" in cell.number_format, bool(formula))


def is_number(value: object) -> TypeGuard[int | float]:
    """Whether a value is a number, which a truth value is not."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def is_plain(text: str) -> bool:
    """Whether a text is a number without a unit."""
    return _PLAIN.fullmatch(text) is not None


def begins_as_number(text: str) -> bool:
    """Whether a text begins as a number does."""
    return _BEGINS_AS_NUMBER.match(text) is not None


def plain_number(value: float) -> int | float:
    """Return a number of a cell, in which 64 and 64.0 are the same, as an integer if it is one."""
    return int(value) if value == math.floor(value) and abs(value) < 1e15 else value


def with_unit(value: float, unit: str) -> str:
    """Return a number as text without loss, ``"25"`` or ``"3e-07"``, and its unit if it has one."""
    return f"{plain_number(value)} {unit}".rstrip()


def percent(value: float) -> str:
    """Return a share as a text of percent, without the digits of rounding."""
    return with_unit(float(f"{100.0 * value:.12g}"), "%")
