"""A workbook as the document of a schema: a sheet for each section, a row for each key.

A row gives a key, its value, perhaps its uncertainty, and its unit; they become the value of a TOML file,
``"25 g"`` or ``"0.5 um +- 20 %"``. A dotted key is a table in place, a number in it counts the items of a
list: ``candidates.1.name``. A list of tables may have a sheet of its own, with a row for each.

Nothing is evaluated: a formula has the value that was saved with it. Macros and links to other files are
never followed.
"""

from __future__ import annotations

import datetime
import math
import re
import typing
import warnings
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.reader import Document
from separatrix.ground.schema import Described, is_number, is_record, keys_of, without_none, without_unit
from separatrix.ground.sheet import SAVE_AGAIN, refuse_unsafe
from separatrix.ground.toml import KeyPath, label_of, nearest
from separatrix.ground.units import NUMBER, printable, shown

if TYPE_CHECKING:
    from openpyxl.cell.read_only import ReadOnlyCell

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a section's sheet; key and value are required, others may be left out, in any order."""

TOP = "study"
"""Sheet of the keys above the sections."""

MEAN = "mean"
"""Column of what an item has by names whose number may stand for all of it."""

SEPARATOR = ";"
MOST_ROWS, MOST_COLUMNS = 2000, 300
LAST_ROW = 1_048_576
LONGEST_TEXT = 4000
Plain = float | int | str | bool

_PLAIN = re.compile(NUMBER)
_BEGINS_AS_NUMBER = re.compile(r"\s*[+-]?\.?[0-9]")
_PART = re.compile(r'"([^"]+)"|([\w -]+)', re.ASCII)
_KEY = re.compile(rf"\w+(?:\.(?:{_PART.pattern})){{0,5}}", re.ASCII)


# ---- sheets, before a schema is asked


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
        """File, sheet and cell."""
        from openpyxl.utils import get_column_letter

        return f"{self.place}, cell {get_column_letter(column)}{row}"

    @property
    def last_row(self) -> int:
        """Number of the last row that has a cell."""
        return max((row for row, _ in self.cells), default=0)

    def given(self, row: int, column: int | None) -> Cell | None:
        """A cell with a value; None if it is empty."""
        cell = None if column is None else self.cells.get((row, column))
        if isinstance(cell, InputError):
            raise cell
        if cell is not None and cell.is_formula:
            self.formulas[f"{printable(self.name)}!{cell.place.rpartition(' ')[2]}"] = None
        return cell

    def headings(self) -> dict[str, int]:
        """Columns of the texts in the first row, in small letters."""
        found: dict[str, int] = {}
        for (number, column), cell in self.cells.items():
            if number == 1 and isinstance(cell, Cell):
                heading = str(cell.value).strip().casefold().replace("±", "+-")
                if heading in COLUMNS and heading in found and {"key", "value"} <= found.keys():
                    raise InputError(cell.place, "is a second column of that heading", shown(heading))
                found[heading] = column
        return found


def sheets_of(path: Path, label: str, is_whole: Callable[[str], bool]) -> list[Sheet]:
    """Worksheets of a workbook: all rows of those that `is_whole` selects, two of the others."""
    from openpyxl.reader.excel import ExcelReader

    has_links = _refuse_other_kinds(path, label)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on parts of the workbook that are not read
            reader = ExcelReader(BytesIO(path.read_bytes()), True, data_only=True)
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
    """Formulas of a sheet by row and column, down to the row `most`; cells out of order are refused."""
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
    saved: Any, formulas: Mapping[tuple[int, int], str], sheet: Sheet, most: int, has_links: bool
) -> Sheet:
    found: dict[tuple[int, int], Cell | InputError] = {}
    saved.reset_dimensions()  # what a file states of its size may be wrong
    for row, cells in enumerate(saved.iter_rows(max_row=most), 1):
        for column, cell in enumerate(cells, 1):
            formula = formulas.get((row, column), "")
            is_blank = isinstance(cell.value, str) and not cell.value.strip()
            if is_blank or (cell.value is None and not formula):
                continue
            where = sheet.at(row, column)
            if row > MOST_ROWS or column > MOST_COLUMNS:
                return replace(sheet, cells=found, beyond=where if most > 2 else "")
            found[row, column] = _cell(cell, formula, where, has_links)
    return replace(sheet, cells=found)


def _cell(cell: ReadOnlyCell, formula: str, where: str, has_links: bool) -> Cell | InputError:
    """A cell with its value, or the refusal of its value."""
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


# ---- the document of a schema


def read_sheets(schema: Any, path: Path) -> Document:
    """Document of a workbook; sheets of its own that have not the headings of a section are not read."""
    label = label_of(path)
    forms = {name: one.key.form or one.hint for name, one in keys_of(schema).items()}
    homes: dict[str, KeyPath] = {TOP: ()} | {name: (name,) for name, form in forms.items() if is_record(form)}
    tables: dict[str, KeyPath] = {
        key: (name, key)
        for name, form in forms.items()
        if is_record(form)
        for key, one in keys_of(form).items()
        if is_record(_item_of(one.hint))
    }
    known, made = dict[str, str](), _Making(schema, label)
    for sheet in sheets_of(path, label, lambda name: name.strip().casefold() in homes | tables):
        name = sheet.name.strip().casefold()
        if name not in homes | tables:
            second = {str(c.value) for (row, _), c in sheet.cells.items() if row == 2 and isinstance(c, Cell)}
            if {"key", "value"} <= sheet.headings().keys() or {"name", MEAN} <= second:
                rule, cure = f"is not a section of {schema.FILE.noun}", nearest(sheet.name, homes | tables)
                raise InputError(sheet.place, rule, cure=cure)
            continue
        if sheet.beyond:
            from openpyxl.utils import get_column_letter

            rule = f"is beyond row {MOST_ROWS} or column {get_column_letter(MOST_COLUMNS)}, and is not read"
            raise InputError(sheet.beyond, rule, cure="Move it, or clear it.")
        if (twin := known.setdefault(name, sheet.name)) != sheet.name:
            cure = "Delete one of them, or give it another name."
            raise InputError(sheet.place, "is a second sheet of that name", shown(twin), cure)
        with noted(made.problems):
            made.add_table(sheet, tables[name]) if name in tables else made.add_keys(sheet, homes[name])
        made.formulas += sheet.formulas
    return made.document()


class _Row(NamedTuple):
    """The cells of a row with a value."""

    key: Cell
    value: Cell
    spread: Cell | None
    unit: Cell | None


@dataclass(slots=True)
class _Making:
    """A document as it is made, sheet by sheet."""

    schema: Any
    label: str
    data: dict[str, Any] = field(default_factory=dict)
    places: dict[KeyPath, str] = field(default_factory=dict)
    formulas: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)
    counted: dict[KeyPath, dict[object, int]] = field(default_factory=dict)
    """Place in its list of each item, by the list and by what a sheet calls the item."""

    def document(self) -> Document:
        """The document, if no cell was refused."""
        if self.problems:
            raise together(self.problems)
        if not self.data:
            cure = "`separatrix new PATH.xlsx` writes one to fill in."
            raise InputError(self.label, f"has no sheet of {self.schema.FILE.noun} with a value", cure=cure)
        listed = ", ".join(self.formulas[:5]) + (", ..." if len(self.formulas) > 5 else "")
        count = len(self.formulas)
        what = "the cell has a formula" if count == 1 else f"{count} cells have formulas"
        sentence = f"{self.label}: {what} ({listed}); the saved values are used, nothing is recomputed."
        return Document(self.label, self.data, self.places, notes=(sentence,) if count else ())

    def add_keys(self, sheet: Sheet, section: KeyPath) -> None:
        """Add the keys of a section, or those above the sections."""
        columns, seen = sheet.headings(), dict[KeyPath, str]()
        if not {"key", "value"} <= columns.keys():
            cure = f"Its first row has the headings {', '.join(COLUMNS)}."
            raise InputError(sheet.place, "has no headings key and value", cure=cure)
        for number in range(2, sheet.last_row + 1):
            with noted(self.problems):
                row = _row(sheet, columns, number)
                if row is None:
                    continue
                parts = tuple(a or b for a, b in _PART.findall(row.key.text))
                if _KEY.fullmatch(row.key.text) is None:
                    raise InputError(row.key.place, "must be the name of a key", shown(row.key.text))
                path, hint, is_name = self._found((*section, *parts))
                where = f"{row.key.place}: {printable(row.key.text)}"
                if path in seen:
                    raise InputError(where, "is given a second time", cure=f"It is in {seen[path]}, too.")
                seen[path] = row.key.place.rpartition(" ")[2]
                if section:
                    self.places.setdefault(section, sheet.place)
                self._put(path, _value(hint, is_name, row), row.value.place, where)

    def add_table(self, sheet: Sheet, home: KeyPath) -> None:
        """Add the items of a list, a row each below two rows of headings."""
        items, columns = self.counted.setdefault(home, {}), _columns(sheet, _item_of(self._found(home)[1]))
        for row in range(3, sheet.last_row + 1):
            with noted(self.problems):
                every = ((path, sheet.given(row, number)) for path, (number, _) in columns.items())
                cells = {path: cell for path, cell in every if cell}
                if not cells:
                    continue
                at = (*home, items.setdefault(f"row {row}", len(items)))
                self.places[at] = f"{sheet.place}, row {row}"
                for path, cell in cells.items():
                    _, hint, is_name = self._found((*at, *path))
                    is_width = len(path) == 3 and path[-1] != MEAN
                    unit = columns[path][1] if is_number(cell.value) else None  # a text may have its own
                    value = _value(hint, is_name, _Row(cell, cell, None, unit), is_width)
                    if len(path) == 3 and hint is not str and not _begins_as_number(str(value).lstrip("[")):
                        cure = "Leave the cell empty if it was not measured."
                        raise InputError(cell.place, "must be a number", shown(value), cure)
                    is_alone = sum(other[:2] == path[:2] for other in cells) == 1
                    short = path[:2] if path[-1] == MEAN and is_alone else path
                    self._put((*at, *short), value, cell.place, f"{cell.place}: {'.'.join(path)}")

    def _found(self, path: KeyPath) -> tuple[KeyPath, Any, bool]:
        """Path of a key with the places of items for their numbers, its type, and whether it is a name.

        The type of a number is also that of what is inside: ``mass.mean``, ``thickness.between``.
        """
        owner: Any = self.schema
        one: Described | None = None
        found: KeyPath = ()
        for part in path:
            if is_record(owner):
                one = keys_of(owner, one).get(str(part))
                owner = None if one is None else one.key.form or one.hint
            elif is_record(_item_of(owner)):
                if isinstance(part, str) and part.isdigit():
                    items = self.counted.setdefault(found, {})
                    part = items.setdefault(part, len(items))
                owner = _item_of(owner)
            elif owner is not None:
                is_names = typing.get_origin(owner) is Mapping
                owner = without_none(typing.get_args(owner)[1])[0] if is_names else float
            found = (*found, part)
        return found, owner, one is not None and bool(one.key.named) and is_record(owner)

    def _put(self, path: KeyPath, value: object, place: str, where: str) -> None:
        """Set the value of a path, in tables and lists that are made."""
        table: Any = self.data
        for part, after in pairwise(path):
            if isinstance(table, list) and isinstance(part, int):
                table += [{}] * (part == len(table))
                table = table[part]
            elif isinstance(table, dict):
                table = table.setdefault(part, [] if isinstance(after, int) else {})
        if not isinstance(table, dict) or path[-1] in table:
            ways = "by rows of its parts" if isinstance(table, dict) else "as a value of its own"
            rule = f"is given {ways}, too"
            rule = "must name a key of the item" if isinstance(path[-1], int) else rule
            raise InputError(where, rule)
        table[path[-1]] = value
        for length in range(2, len(path)):
            self.places.setdefault(path[:length], place)
        self.places[path] = place


def _row(sheet: Sheet, columns: Mapping[str, int], number: int) -> _Row | None:
    """The cells of a row; None without a value."""
    key, value, spread, unit = (sheet.given(number, columns.get(name)) for name in COLUMNS[:4])
    if key is None and (stray := value or spread) is not None:
        cure = "Name the key in the same row, or clear it."
        raise InputError(stray.place, "is a value without a key", cure=cure)
    if value is None and spread is not None:
        raise InputError(spread.place, "is a width without a value")
    return None if key is None or value is None else _Row(key, value, spread, unit)


def _item_of(hint: Any) -> Any:
    """Type of the items of a list; None of what is none."""
    return without_unit(typing.get_args(hint)[0])[0] if typing.get_origin(hint) is tuple else None


def _value(hint: Any, is_name: bool, row: _Row, is_width: bool = False) -> Plain | list[Plain]:
    """Value of a row as a TOML file has it."""
    value, spread, item = row.value, row.spread, _item_of(hint)
    unit = "" if row.unit is None or row.unit.text == "-" else row.unit.text
    is_text = is_name or (item or hint) is str or (isinstance(hint, type) and issubclass(hint, Enum))
    plain: Plain = value.value
    if isinstance(plain, str):
        plain = plain if is_text else plain.strip().strip('"')  # as a refusal writes it
        parts = [part.strip() for part in plain.split(SEPARATOR) if part.strip()]
        if item or (not is_text and SEPARATOR in plain and all(map(_begins_as_number, parts))):
            if spread is not None:
                raise InputError(spread.place, "is a width beside a list", cure="Clear one of them.")
            return [
                part if is_text or not _is_plain(part) else _with_unit(float(part), unit) for part in parts
            ]
        has_own = _begins_as_number(plain) and re.search(r"[^\W\d_]|°", plain) and not _is_plain(plain)
        if unit and has_own and row.unit is not None:
            rule, cure = "is a unit beside a value that brings its own", "Clear this cell."
            raise InputError(row.unit.place, rule, shown(plain), cure)
        plain = f"{plain} {unit}" if unit else plain
    elif is_number(plain):
        if unit and value.is_percent:
            got, cure = f"{shown(plain)} {unit}", "Format the cell as a number."
            raise InputError(value.place, "is a percentage with a unit", got, cure)
        plain = _percent(plain) if is_width and value.is_percent else _with_unit(plain, unit)
        plain = str(plain) if is_text else plain
    if spread is not None:
        return f"{plain} +- {_width(spread, unit)}"
    return [plain] if item else plain


def _width(cell: Cell, unit: str) -> str:
    if is_number(cell.value):
        return _percent(cell.value) if cell.is_percent else str(_with_unit(cell.value, unit))
    text = str(cell.value).strip().removeprefix("+-").removeprefix("±").lstrip()
    return f"{text} {unit}".strip() if _is_plain(text) else text


def _is_plain(text: str) -> bool:
    """Whether a text is a number without a unit."""
    return _PLAIN.fullmatch(text) is not None


def _begins_as_number(text: str) -> bool:
    return _BEGINS_AS_NUMBER.match(text) is not None


def _with_unit(value: float, unit: str) -> Plain:
    """A number without loss, an integer if it is one, as a text with its unit if it has one."""
    number = int(value) if value == math.floor(value) and abs(value) < 1e15 else value
    return f"{number} {unit}" if unit else number


def _percent(value: float) -> str:
    """A share as a text of percent, without the digits of rounding."""
    return str(_with_unit(float(f"{100.0 * value:.12g}"), "%"))


def _columns(sheet: Sheet, owner: Any) -> dict[tuple[str, ...], tuple[int, Cell | None]]:
    """Columns of a list of tables by the key in an item: number, and the cell of its unit.

    A key of an item or of a record in it has its unit above; one of what an item has by names, as friction by
    environment, has the name above, which goes for the columns to its right, too.
    """
    own: dict[str, tuple[str, ...]] = {name: (name,) for name in keys_of(owner)}
    named: dict[str, str] = {}
    for name, one in keys_of(owner).items():
        is_names = typing.get_origin(one.hint) is Mapping
        inside = without_none(typing.get_args(one.hint)[1])[0] if is_names else one.hint
        for part in keys_of(inside) if is_record(inside) else ():
            named |= {part: name} if is_names else {}
            own |= {} if is_names or part in own else {part: (name, part)}
    found: dict[tuple[str, ...], tuple[int, Cell | None]] = {}
    environment, last = "", max((column for _, column in sheet.cells), default=0)
    for number in range(1, last + 1):
        above, below = (sheet.given(row, number) for row in (1, 2))
        if below is None:
            if above or any(sheet.given(row, number) for row in range(3, sheet.last_row + 1)):
                cure = f"One of {', '.join(named)}."
                raise InputError(sheet.at(2, number), "must name what the column holds", cure=cure)
            continue
        what = below.text
        is_named = what in named and bool(what not in own or above or environment)
        environment = above.text if above and is_named else environment
        if is_named and not environment:
            rule, cure = f"must name the environment of this {what}", 'Write it like "liquid nitrogen, 440C".'
            raise InputError(sheet.at(1, number), rule, cure=cure)
        if not is_named and what not in own:
            cure = nearest(what, named if environment or above else own | named)
            raise InputError(below.place, f"is not a heading of {sheet.name.strip()}", shown(what), cure)
        path = (named[what], environment, what) if is_named else own[what]
        if path in found:
            raise InputError(below.place, "is a second column of that heading", shown(what))
        found[path] = number, None if is_named else above
    return found
