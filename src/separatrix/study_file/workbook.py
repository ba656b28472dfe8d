"""A study in a workbook: one sheet for each section, one row for each key (docs/reference/workbook.md).

A row gives a key, its value, perhaps its uncertainty, and its unit. It becomes what a TOML file would
say, ``"25 g"`` or ``"0.5 um +- 20 %"``, and is read by the same readers; a dotted key is a table in place.
The sheet `candidates` has one row for each cage material and its frictions by environment: its first row
names the environments, the second what the columns hold.
"""

from __future__ import annotations

import dataclasses
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, ValidityWarning
from separatrix.study import SECTIONS as RECORDS
from separatrix.study import Material
from separatrix.study_file.cells import (
    COLUMNS,
    MOST_COLUMNS,
    MOST_ROWS,
    Cell,
    Row,
    Sheet,
    begins_as_number,
    is_list,
    is_number,
    list_of,
    number_text,
    percent,
    plain_number,
    rows_of,
    sheets_of,
)
from separatrix.study_file.document import SECTIONS, TOP, Document, Entry, LibraryPlace
from separatrix.study_numbers import numbers_of
from separatrix.toml_text import Places, label_of
from separatrix.toml_values import nearest
from separatrix.units import UNITS, missing_unit, printable, shown, unit_of

STUDY_SHEET = "study"
"""The sheet of what a TOML file has above its sections: title, extends, library."""

CANDIDATES = "candidates"
OWN = ("name", "material")
PROPERTIES = ("elastic_modulus", "poisson_ratio", "density", "source")
"""Of a material in place; one with a unit has it in the first row."""

MEASURED = ("mean", "standard_deviation", "count", "source")
_KEY = re.compile(r"[A-Za-z0-9_]+(?:\.[A-Za-z0-9_ -]+){0,2}")
_NAMES = (*SECTIONS, STUDY_SHEET, CANDIDATES)


def document_of(path: Path) -> Document:
    """Return the document of a workbook.

    Raises
    ------
    InputError
        It is not a workbook that can be read safely, or is not laid out as a study.

    Warns
    -----
    ValidityWarning
        It holds formulas: their saved values are taken.
    """
    label = label_of(path)
    document = Document(label, places=Places(label), folder=path.parent)
    formulas: list[str] = []
    known: dict[str, str] = {}
    for sheet in sheets_of(path, document.label, lambda name: _folded(name) in _NAMES):
        folded = _folded(sheet.name)
        if folded not in _NAMES:
            if {"key", "value"} <= sheet.headings().keys() or {"name", "mean"} <= _texts(sheet, 2):
                cure = nearest(sheet.name, (STUDY_SHEET, *SECTIONS, CANDIDATES))
                raise InputError(sheet.place, "is not a section of a study", cure=cure)
            continue
        if sheet.beyond:
            from openpyxl.utils import get_column_letter

            rule = f"lies beyond row {MOST_ROWS} or column {get_column_letter(MOST_COLUMNS)}, and is not read"
            raise InputError(sheet.beyond, rule, cure="Move it, or clear it.")
        if (twin := known.setdefault(folded, sheet.name)) != sheet.name:
            cure = "Delete one of them, or give it another name."
            raise InputError(sheet.place, "is a second sheet of that name", shown(twin), cure)
        formulas += _add(document, sheet, folded)
    document.libraries.append(LibraryPlace(path, document.top.get("library")))
    if not document.sections:
        cure = "`separatrix new --excel PATH.xlsx` writes one to fill in."
        raise InputError(document.label, "has no sheet of a study with a value in it", cure=cure)
    if formulas:
        listed = ", ".join(formulas[:5]) + (", ..." if len(formulas) > 5 else "")
        what = "the cell holds a formula" if len(formulas) == 1 else f"{len(formulas)} cells hold formulas"
        sentence = f"{document.label}: {what} ({listed}); the saved values are used, nothing is recomputed."
        warnings.warn(sentence, ValidityWarning, stacklevel=4)
    return document


def _folded(name: str) -> str:
    return name.strip().casefold()


def _texts(sheet: Sheet, row: int) -> set[str]:
    cells = (cell for (number, _), cell in sheet.cells.items() if number == row and isinstance(cell, Cell))
    return {str(cell.value).strip() for cell in cells}


def _add(document: Document, sheet: Sheet, section: str) -> list[str]:
    """Add what a sheet says to the document; return the places of its formulas."""
    if section == CANDIDATES:
        return _add_candidates(document, sheet)
    if not {"key", "value"} <= sheet.headings().keys():
        cure = f"Its first row has the headings {', '.join(COLUMNS)}."
        raise InputError(sheet.place, "has no headings key and value", cure=cure)
    rows = list(_known_once(sheet))
    entries: dict[str, Entry] = {}
    for row in rows:
        path = f"[{section}] {row.key}" if section != STUDY_SHEET else row.key
        document.places.known |= {path: row.place, f"{path}, after +-,": row.spread_place}
        key, *inside = row.key.split(".")
        document.places.known.setdefault(path.removesuffix("".join(f".{part}" for part in inside)), row.place)
        if section == STUDY_SHEET and key not in TOP:
            cure = f"On this sheet there are only {', '.join(TOP)}."
            document.problems.append(
                InputError(f"{row.place}: {path}", "is not a key of this sheet", cure=cure)
            )
            continue
        unit = _unit_of(section, key, inside)
        value: Any = row.value
        if row.lacks_unit and unit in UNITS:
            value = missing_unit(row.lacks_unit, unit, f"{row.unit_place}: {path}", in_cell=True)
            if inside:
                raise value
        if inside:
            _set(entries.setdefault(key, Entry({}, document.folder)).value, inside, row.value, row)
        elif key in entries:
            raise InputError(f"{row.key_place}: {printable(key)}", "is given by rows of its parts, too")
        else:
            entries[key] = Entry(value, document.folder)
    if section == STUDY_SHEET:
        document.top.update(entries)
    elif entries:
        document.places.known[f"[{section}]"] = sheet.place
        document.sections.setdefault(section, {}).update(entries)
    return [formula for row in rows for formula in row.formulas]


def _unit_of(section: str, key: str, inside: list[str]) -> str:
    """Unit of a key of a section, or of a property of a material; empty where it has none."""
    names = {"radial_clearance": "m", "elastic_modulus": "Pa"}
    name = inside[-1] if inside and inside[-1] in numbers_of(Material) else key
    record = RECORDS.get(section) if name == key else Material
    known = record is not None and name in {f.name for f in dataclasses.fields(record)}
    return unit_of(record, name) if record is not None and known else names.get(name, "")


def _known_once(sheet: Sheet) -> Iterator[Row]:
    """Yield the rows that have a value; a key is written once, and as keys are."""
    seen: dict[str, str] = {}
    for row in rows_of(sheet):
        if _KEY.fullmatch(row.key) is None:
            raise InputError(row.key_place, "must be the name of a key", shown(row.key))
        if row.key in seen:
            cure = f"It is in {seen[row.key]}, too."
            raise InputError(f"{row.key_place}: {row.key}", "is given a second time", cure=cure)
        seen[row.key] = row.key_place.rpartition(" ")[2]
        yield row


def _set(table: Any, keys: list[str], value: Any, row: Row) -> None:
    """Set an item of a table in place, itself perhaps in a table."""
    for key in keys[:-1]:
        table = table.setdefault(key, {}) if isinstance(table, dict) else None
    if not isinstance(table, dict) or keys[-1] in table:
        raise InputError(f"{row.key_place}: {printable(row.key)}", "is given as a value of its own, too")
    table[keys[-1]] = value


@dataclass(frozen=True, slots=True)
class _Column:
    """What a column of the candidates holds: a property, or a number of an environment."""

    number: int
    what: str
    environment: str = ""
    unit: str = ""

    @property
    def path(self) -> tuple[str, ...]:
        """Keys of its value in the table of a candidate."""
        if self.environment:
            return ("friction", self.environment, self.what)
        return ("material", self.what) if self.what in PROPERTIES else (self.what,)


def _add_candidates(document: Document, sheet: Sheet) -> list[str]:
    """Add the candidates as tables; return the places of formulas among them."""
    columns = list(_columns(sheet))
    items: list[dict[str, Any]] = []
    formulas: list[str] = []
    for row in range(3, sheet.last_row + 1):
        item: dict[str, Any] = {}
        at = f"[ranking] candidates[{len(items) + 1}]"
        for column in columns:
            if (cell := sheet.given(row, column.number)) is None:
                continue
            _set_part(item, column.path, _part(cell, column), cell.place)
            formulas += [cell.formula] if cell.formula else []
            first, *rest = column.path
            names = [f'"{rest[0][:60]}"', *rest[1:]] if first == "friction" else rest
            document.places.known[".".join([f"{at}.{first}", *names])] = cell.place
            if column.what == "mean":
                document.places.known[".".join([f"{at}.{first}", *names[:-1]])] = cell.place
        if item and "name" not in item:
            number = next((column.number for column in columns if column.what == "name"), 1)
            rule = f"must name the candidate of row {row}"
            raise InputError(sheet.at(row, number), rule, cure="Name it, or clear the row.")
        if item:
            given = item.get("friction", {})
            alone = {name: one["mean"] if set(one) == {"mean"} else one for name, one in given.items()}
            items.append(item | ({"friction": alone} if alone else {}))
            document.places.known[at] = f"{sheet.place}, row {row}"
    if items:
        document.places.known["[ranking] candidates"] = sheet.place
        document.sections.setdefault("ranking", {})[CANDIDATES] = Entry(items, document.folder)
    return formulas


def _columns(sheet: Sheet) -> Iterator[_Column]:
    """Yield the columns with headings; an environment applies to those to its right, up to the next one."""
    environment, seen = "", set()
    for number in range(1, max((column for _, column in sheet.cells), default=0) + 1):
        above, below = (cell.text if (cell := sheet.given(row, number)) else "" for row in (1, 2))
        if not below:
            if above or any(sheet.given(row, number) for row in range(3, sheet.last_row + 1)):
                cure = f"One of {', '.join(MEASURED)}."
                raise InputError(sheet.at(2, number), "must name what the column holds", cure=cure)
            continue
        if not environment and below in (*OWN, *PROPERTIES) and not (below == "source" and above):
            column = _Column(number, below, unit="" if above == "-" else above)
        elif below in MEASURED:
            environment = above or environment
            column = _Column(number, below, environment)
            if not environment:
                cure = 'Write it like "liquid nitrogen, 440C".'
                raise InputError(sheet.at(1, number), f"must name the environment of this {below}", cure=cure)
        else:
            known = MEASURED if environment or above else (*OWN, *PROPERTIES, *MEASURED)
            rule = "is not a heading of candidates"
            raise InputError(sheet.at(2, number), rule, shown(below), nearest(below, known))
        if column.path in seen:
            raise InputError(sheet.at(2, number), "is a second column of that heading", shown(below))
        seen.add(column.path)
        yield column


def _set_part(item: dict[str, Any], path: tuple[str, ...], value: Any, where: str) -> None:
    for key in path[:-1]:
        item = item.setdefault(key, {})
        if not isinstance(item, dict):
            rule = "is a property of a material that is also named"
            raise InputError(where, rule, cure="Give the name of one in the library, or the properties.")
    item[path[-1]] = value


def _part(cell: Cell, column: _Column) -> Any:
    value = cell.value
    if (
        column.what in MEASURED
        and column.what != "source"
        and isinstance(value, str)
        and not begins_as_number(value)
    ):
        cure = "Leave the cell empty if it was not measured."
        raise InputError(cell.place, "must be a number", shown(value), cure)
    if is_number(value):
        if column.what == "standard_deviation" and cell.is_percent:
            return percent(value)
        return f"{number_text(value)} {column.unit}" if column.unit else plain_number(value)
    return (
        list_of(value, "")
        if column.environment and isinstance(value, str) and is_list(column.what, value)
        else value
    )
