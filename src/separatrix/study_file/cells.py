"""Cells of a study workbook, read by openpyxl: what each holds, and what a row of them says.

Nothing is evaluated: a formula has the value that was saved with it. Macros and links to other files are
never followed.
"""

from __future__ import annotations

import datetime
import math
import re
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

from separatrix.errors import InputError
from separatrix.regular_file import size_of, unreadable
from separatrix.units import NUMBER, printable, shown
from separatrix.workbook_guard import SAVE_AGAIN, refuse_unsafe

if TYPE_CHECKING:
    from openpyxl.cell.read_only import ReadOnlyCell

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a section's sheet; key and value are required, others may be left out, in any order."""

MOST_ROWS, MOST_COLUMNS = 2000, 300
LAST_ROW = 1_048_576
LONGEST_TEXT = 4000
LISTS = frozenset({"kicks", "pocket_angles", "restitution_factors", "materials", "library"})
LIST_PARTS = frozenset({"between", "samples"})
"""Keys, and last parts of dotted keys, that are lists even of one item."""

SEPARATOR = ";"
Plain = float | int | str | bool
Value = Plain | list[Plain]
"""What a TOML file would say in the place of a row."""

_PLAIN = re.compile(NUMBER)
_BEGINS_AS_NUMBER = re.compile(r"\s*[+-]?\.?[0-9]")


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell that holds a value: its file, sheet and name, and whether it is shown as a percentage."""

    value: Plain
    place: str
    is_percent: bool = False
    formula: str = ""
    """Sheet and name of a cell whose value was saved with a formula; else empty."""

    @property
    def text(self) -> str:
        """Its text.

        Raises
        ------
        InputError
            It holds something else.
        """
        if not isinstance(self.value, str):
            raise InputError(self.place, "must be text", shown(self.value))
        return self.value.strip()


@dataclass(frozen=True, slots=True)
class Sheet:
    """Cells of a sheet by row and column, from 1; a cell with a fault raises it when it is asked for."""

    name: str
    place: str
    cells: Mapping[tuple[int, int], Cell | InputError]
    beyond: str = ""
    """Place of the first cell that was not read because it is too far from the first one."""

    def at(self, row: int, column: int) -> str:
        """Return file, sheet and cell."""
        from openpyxl.utils import get_column_letter

        return f"{self.place}, cell {get_column_letter(column)}{row}"

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
        if isinstance(cell, InputError):
            raise cell
        return cell

    def headings(self, row: int = 1) -> dict[str, int]:
        """Return the columns of the texts in a row, in small letters."""
        found: dict[str, int] = {}
        for (number, column), cell in self.cells.items():
            if number == row and isinstance(cell, Cell):
                heading = str(cell.value).strip().casefold().replace("±", "+-")
                if heading in COLUMNS and heading in found and {"key", "value"} <= found.keys():
                    raise InputError(cell.place, "is a second column of that heading", shown(heading))
                found[heading] = column
        return found


def sheets_of(path: Path, label: str, is_whole: Callable[[str], bool]) -> list[Sheet]:
    """Return the worksheets of a workbook: whole where `is_whole` wants it, of others the first two rows.

    Raises
    ------
    InputError
        It is not an .xlsx workbook that can be read safely, or has macros.
    """
    from openpyxl.reader.excel import ExcelReader

    has_links = _refuse_other_kinds(path, label)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on parts of the workbook that are not read
            content = path.read_bytes()
            readers = [ExcelReader(BytesIO(content), True, data_only=saved) for saved in (True, False)]
            for reader in readers:
                reader.read()
            for sheet, relation in readers[0].parser.find_sheets():
                if relation.target not in readers[0].valid_files:
                    raise InputError(label, "has a sheet without content", shown(sheet.name), SAVE_AGAIN)
            values, formulas = (reader.wb for reader in readers)
            sheets = [
                _sheet(sheet, formulas[sheet.title], label, is_whole(sheet.title), has_links)
                for sheet in values.worksheets
            ]
    except InputError:  # which is a ValueError, too
        raise
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, SyntaxError, OSError) as error:
        why = printable(str(error.__cause__ or error).partition("\n")[0], 100).rstrip(".")
        raise InputError(label, f"is not a readable workbook: {why}", cure=SAVE_AGAIN) from None
    return sheets


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
        names = {name.casefold() for name in container.namelist()}
        types = (
            container.read("[Content_Types].xml") if "[Content_Types].xml" in container.namelist() else b""
        )
    for mark, kind in (
        ("content.xml", "an OpenDocument file"),
        ("xl/workbook.bin", "a binary workbook, .xlsb"),
    ):
        if mark in names:
            raise InputError(label, f"is {kind}, which is not read", cure="Save it as .xlsx.")
    if b"macroEnabled" in types or any(n.endswith("vbaproject.bin") or "macrosheets/" in n for n in names):
        cure = "Save it as .xlsx, which keeps no macros."
        raise InputError(label, "has macros, which are never run", cure=cure)
    if "xl/workbook.xml" not in names:
        raise InputError(label, "is a zip file, but not a workbook", cure=SAVE_AGAIN)
    return any("externallinks/" in name for name in names)


def _sheet(values: Any, formulas: Any, label: str, whole: bool, has_links: bool) -> Sheet:
    found: dict[tuple[int, int], Cell | InputError] = {}
    sheet = Sheet(values.title, f"{label}, sheet {printable(values.title)}", found)
    for one in (values, formulas):
        one.reset_dimensions()  # what a file states of its size may be wrong
    most = LAST_ROW if whole else 2
    both = zip(values.iter_rows(max_row=most), formulas.iter_rows(max_row=most), strict=True)
    for row, (saved, entered) in enumerate(both, 1):
        for column, (cell, formula) in enumerate(zip(saved, entered, strict=True), 1):
            if formula.value is None or (isinstance(cell.value, str) and not cell.value.strip()):
                continue
            if row > MOST_ROWS or column > MOST_COLUMNS:
                return replace(sheet, beyond=sheet.at(row, column)) if whole else sheet
            found[row, column] = _cell(cell, formula, sheet, (row, column), has_links)
    return sheet


def _cell(
    saved: ReadOnlyCell, entered: ReadOnlyCell, sheet: Sheet, at: tuple[int, int], has_links: bool
) -> Cell | InputError:
    """Return a cell with its value, or why it has none that can be taken."""
    value: Any = saved.value
    where, formula = sheet.at(*at), ""
    if saved.data_type == "e":
        return InputError(where, "shows an error instead of a value", str(value))
    if entered.data_type == "f":
        formula = f"{printable(sheet.name)}!{where.rpartition(' ')[2]}"
        if has_links:
            rule = "is a formula in a workbook that takes values from other files, which are never opened"
            return InputError(where, rule, cure="Paste it as a value.")
        if value is None:
            cure = "Open the workbook in a spreadsheet program and save it, or enter the value."
            text = shown(getattr(entered.value, "text", entered.value))
            return InputError(where, "holds a formula without a saved value", text, cure)
    if isinstance(value, datetime.date | datetime.time | datetime.timedelta):
        cure = "Format the cell as a number, and enter the value again."
        return InputError(where, "holds a date or a time of day", cure=cure)
    if isinstance(value, float) and not math.isfinite(value):
        return InputError(where, "must be a finite number", shown(value))
    if isinstance(value, str) and len(value) > LONGEST_TEXT:
        return InputError(where, f"is longer than {LONGEST_TEXT} characters")
    if isinstance(value, str):
        value = value.replace("_x005F_", "_")  # an underscore that would begin the code of a character
    return Cell(value, where, "%" in saved.number_format, formula)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A row of a section's sheet that has a value: what a TOML file would say, and where its cells are."""

    key: str
    value: Value
    formulas: tuple[str, ...]
    key_place: str
    place: str
    spread_place: str
    unit_place: str
    lacks_unit: str
    """The number that has no unit, or the first of a list; empty where there is none."""


def rows_of(sheet: Sheet) -> Iterator[Row]:
    """Yield the rows of a section's sheet that have a value.

    Raises
    ------
    InputError
        A value without a key, a width without a value, a text where a number is due, or the reverse.
    """
    columns = sheet.headings()
    for number in range(2, sheet.last_row + 1):
        key, value, spread, unit = (sheet.given(number, columns.get(name)) for name in COLUMNS[:4])
        if key is None and (stray := value or spread) is not None:
            cure = "Name the key in the same row, or clear it."
            raise InputError(stray.place, "is a value without a key", cure=cure)
        if value is None and spread is not None:
            raise InputError(spread.place, "is a width without a value")
        if key is None or value is None:
            continue
        unit_text = "" if unit is None or unit.text == "-" else unit.text
        written = _written(key.text, value, spread, unit, unit_text)
        items = written if isinstance(written, list) else [written]
        yield Row(
            key=key.text,
            value=written,
            formulas=tuple(cell.formula for cell in (key, value, spread, unit) if cell and cell.formula),
            key_place=key.place,
            place=value.place,
            spread_place=spread.place if spread else value.place,
            unit_place=sheet.at(number, columns["unit"]) if "unit" in columns else value.place,
            lacks_unit="" if unit_text else next(map(number_text, filter(is_number, items)), ""),
        )


def is_number(value: Plain) -> TypeGuard[int | float]:
    """Whether a value is a number, which a truth value is not."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def begins_as_number(text: str) -> bool:
    """Whether a text begins as a number does."""
    return _BEGINS_AS_NUMBER.match(text) is not None


def is_list(key: str, text: str) -> bool:
    """Whether a text is a list: its key takes one, or there are numbers on both sides of a separator."""
    parts = [part for part in text.split(SEPARATOR) if part.strip()]
    return _takes_list(key) or (SEPARATOR in text and all(map(begins_as_number, parts)))


def list_of(text: str, unit: str) -> list[Plain]:
    """Return the items of a list in one cell."""
    items = [part.strip() for part in text.split(SEPARATOR) if part.strip()]
    numbers = [f"{item} {unit}" if unit else plain_number(float(item)) for item in items if _is_plain(item)]
    ready = iter(numbers)
    return [next(ready) if _is_plain(item) else item for item in items]


def number_text(value: float) -> str:
    """Return a number as text without loss: ``"25"``, ``"11.1125"``, ``"3e-07"``."""
    return str(plain_number(value))


def plain_number(value: float) -> int | float:
    """Return a number of a cell, which does not tell 64 from 64.0, as an integer if it is one."""
    return int(value) if value == math.floor(value) and abs(value) < 1e15 else value


def percent(value: float) -> str:
    """Return a share as a text of percent, without the digits of rounding."""
    return f"{number_text(float(f'{100.0 * value:.12g}'))} %"


def _is_plain(text: str) -> bool:
    return _PLAIN.fullmatch(text) is not None


def _takes_list(key: str) -> bool:
    return key in LISTS or key.rpartition(".")[2] in LIST_PARTS


def _written(key: str, value: Cell, spread: Cell | None, unit: Cell | None, unit_text: str) -> Value:
    """Return the value of a row as a TOML file would give it."""
    if isinstance(value.value, str) and is_list(key, value.value):
        if spread is not None:
            raise InputError(spread.place, "is a width beside a list", cure="Clear one of them.")
        return list_of(value.value, unit_text)
    plain = _with_unit(value, unit, unit_text)
    if spread is not None:
        return f"{plain} +- {_width(spread, unit_text)}"
    return [plain] if _takes_list(key) and not isinstance(plain, bool) else plain


def _with_unit(cell: Cell, unit: Cell | None, text: str) -> Plain:
    value = cell.value
    if isinstance(value, bool) or (isinstance(value, str) and not text):
        return value
    if isinstance(value, str):
        has_own = begins_as_number(value) and re.search(r"[^\W\d_]|°", value) and not _is_plain(value.strip())
        if has_own and unit is not None:
            rule, cure = "is a unit beside a value that brings its own", "Clear this cell."
            raise InputError(unit.place, rule, shown(value), cure)
        return f"{value} {text}"
    if not text:
        return plain_number(value)
    if cell.is_percent:
        cure = "Format the cell as a number."
        raise InputError(cell.place, "is a percentage with a unit", f"{shown(value)} {text}", cure)
    return f"{number_text(value)} {text}"


def _width(cell: Cell, unit: str) -> str:
    if is_number(cell.value):
        return percent(cell.value) if cell.is_percent else f"{number_text(cell.value)} {unit}".strip()
    text = str(cell.value).strip().removeprefix("+-").removeprefix("±").lstrip()
    return f"{text} {unit}".strip() if _is_plain(text) else text
