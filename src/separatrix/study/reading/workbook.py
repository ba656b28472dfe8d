"""A study in a workbook: one sheet for each section, one row for each key (docs/reference/workbook.md).

A row gives a key, its value, perhaps its uncertainty, and its unit. It becomes the value of a TOML
file, ``"25 g"`` or ``"0.5 um +- 20 %"``, and is read by the same readers; a dotted key is a table in place.
The sheet `candidates` has one row for each cage material and its frictions by environment: its first row
names the environments, the second what the columns hold.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

from separatrix.ground.errors import InputError, ValidityWarning
from separatrix.ground.toml import Places, label_of, nearest
from separatrix.ground.units import UNITS, missing_unit, printable, shown, unit_of
from separatrix.study.keys import numbers_of
from separatrix.study.reading.cells import (
    COLUMNS,
    MOST_COLUMNS,
    MOST_ROWS,
    SEPARATOR,
    Cell,
    Plain,
    Sheet,
    begins_as_number,
    is_number,
    is_plain,
    percent,
    plain_number,
    sheets_of,
    with_unit,
)
from separatrix.study.reading.document import SECTIONS, TOP, Document
from separatrix.study.study import SECTIONS as RECORDS
from separatrix.study.study import Material, Wear

STUDY_SHEET = "study"
"""The sheet of the keys above the sections of a TOML file: title, extends, library."""

CANDIDATES = "candidates"
OWN = ("name", "material")
PROPERTIES = ("elastic_modulus", "poisson_ratio", "density", "source")
"""Of a material in place; one with a unit has it in the first row."""

MEASURED = ("mean", "standard_deviation", "count", "source")
LISTS = (
    *("kicks", "pocket_angles", "restitution_factors", "materials", "library", "between", "samples"),
    *("across", "thicknesses"),
)
"""Keys, and last parts of dotted keys, that are lists even of one item."""

_KEY = re.compile(r"[A-Za-z0-9_]+(?:\.[A-Za-z0-9_ -]+){0,2}")
_NAMES = (STUDY_SHEET, *SECTIONS, CANDIDATES)


def document_of(path: Path) -> Document:
    """Return the document of a workbook.

    Warns
    -----
    ValidityWarning
        It has formulas: their saved values are taken.
    """
    label = label_of(path)
    document = Document(path, places=Places(label), friction_folder=path.parent, film_folder=path.parent)
    formulas: list[str] = []
    known: dict[str, str] = {}
    for sheet in sheets_of(path, label, lambda name: name.strip().casefold() in _NAMES):
        name = sheet.name.strip().casefold()
        if name not in _NAMES:
            cells = sheet.cells.items()
            second = {str(c.value).strip() for (row, _), c in cells if row == 2 and isinstance(c, Cell)}
            if {"key", "value"} <= sheet.headings().keys() or {"name", "mean"} <= second:
                raise InputError(sheet.place, "is not a section of a study", cure=nearest(sheet.name, _NAMES))
            continue
        if sheet.beyond:
            from openpyxl.utils import get_column_letter

            rule = f"is beyond row {MOST_ROWS} or column {get_column_letter(MOST_COLUMNS)}, and is not read"
            raise InputError(sheet.beyond, rule, cure="Move it, or clear it.")
        if (twin := known.setdefault(name, sheet.name)) != sheet.name:
            cure = "Delete one of them, or give it another name."
            raise InputError(sheet.place, "is a second sheet of that name", shown(twin), cure)
        if name == CANDIDATES:
            _add_candidates(document, sheet)
        else:
            _add_keys(document, sheet, name)
        formulas += sheet.formulas
    document.libraries.append((path, document.top.get("library")))
    if not document.sections:
        cure = "`separatrix new --excel PATH.xlsx` writes one to fill in."
        raise InputError(label, "has no sheet of a study with a value in it", cure=cure)
    if formulas:
        listed = ", ".join(formulas[:5]) + (", ..." if len(formulas) > 5 else "")
        what = "the cell has a formula" if len(formulas) == 1 else f"{len(formulas)} cells have formulas"
        sentence = f"{label}: {what} ({listed}); the saved values are used, nothing is recomputed."
        warnings.warn(sentence, ValidityWarning, stacklevel=4)
    return document


class _Row(NamedTuple):
    """The cells of a row with a value."""

    number: int
    key: Cell
    value: Cell
    spread: Cell | None
    unit: Cell | None


def _add_keys(document: Document, sheet: Sheet, section: str) -> None:
    """Add the keys of a section, or those above the sections, to the document."""
    columns, known = sheet.headings(), document.places.known
    if not {"key", "value"} <= columns.keys():
        cure = f"Its first row has the headings {', '.join(COLUMNS)}."
        raise InputError(sheet.place, "has no headings key and value", cure=cure)
    entries: dict[str, object] = {}
    for row in list(_rows(sheet, columns)):
        dotted, unit = row.key.text, "" if row.unit is None or row.unit.text == "-" else row.unit.text
        key, *inside = dotted.split(".")
        value: object = _written(dotted, row, unit)
        path = f"[{section}] {dotted}" if section != STUDY_SHEET else dotted
        known |= {path: row.value.place, f"{path}, after +-,": (row.spread or row.value).place}
        known.setdefault(path.removesuffix("".join(f".{part}" for part in inside)), row.value.place)
        if section == STUDY_SHEET and key not in TOP:
            cure = f"On this sheet there are only {', '.join(TOP)}."
            where = f"{row.value.place}: {path}"
            document.problems.append(InputError(where, "is not a key of this sheet", cure=cure))
            continue
        items = value if isinstance(value, list) else [value]
        bare = "" if unit else next((with_unit(item, "") for item in items if is_number(item)), "")
        due = _unit_of(section, key, inside)
        if bare and due in UNITS:
            at = sheet.at(row.number, columns["unit"]) if "unit" in columns else row.value.place
            refusal = missing_unit(bare, due, f"{at}: {path}", in_cell=True)
            if inside:
                raise refusal
            value = refusal
        if inside:
            if not _put(entries, (key, *inside), value):
                where = f"{row.key.place}: {printable(dotted)}"
                raise InputError(where, "is given as a value of its own, too")
        elif key in entries:
            raise InputError(f"{row.key.place}: {printable(key)}", "is given by rows of its parts, too")
        else:
            entries[key] = value
    if section == STUDY_SHEET:
        document.top.update(entries)
    elif entries:
        known[f"[{section}]"] = sheet.place
        document.sections.setdefault(section, {}).update(entries)


def _rows(sheet: Sheet, columns: dict[str, int]) -> Iterator[_Row]:
    """Yield the rows with a value; a key may be written once."""
    seen: dict[str, str] = {}
    for number in range(2, sheet.last_row + 1):
        key, value, spread, unit = (sheet.given(number, columns.get(name)) for name in COLUMNS[:4])
        if key is None and (stray := value or spread) is not None:
            cure = "Name the key in the same row, or clear it."
            raise InputError(stray.place, "is a value without a key", cure=cure)
        if value is None and spread is not None:
            raise InputError(spread.place, "is a width without a value")
        if key is None or value is None:
            continue
        if _KEY.fullmatch(key.text) is None:
            raise InputError(key.place, "must be the name of a key", shown(key.text))
        if key.text in seen:
            rule, cure = "is given a second time", f"It is in {seen[key.text]}, too."
            raise InputError(f"{key.place}: {key.text}", rule, cure=cure)
        seen[key.text] = key.place.rpartition(" ")[2]
        yield _Row(number, key, value, spread, unit)


def _written(key: str, row: _Row, unit: str) -> Plain | list[Plain]:
    """Return the value of a row as a TOML file has it."""
    value, spread = row.value, row.spread
    if isinstance(value.value, str) and _is_list(key, value.value):
        if spread is not None:
            raise InputError(spread.place, "is a width beside a list", cure="Clear one of them.")
        return _items(value.value, unit)
    plain: Plain = value.value
    if isinstance(plain, str) and unit:
        has_own = begins_as_number(plain) and re.search(r"[^\W\d_]|°", plain) and not is_plain(plain.strip())
        if has_own and row.unit is not None:
            rule, cure = "is a unit beside a value that brings its own", "Clear this cell."
            raise InputError(row.unit.place, rule, shown(plain), cure)
        plain = f"{plain} {unit}"
    elif is_number(plain):
        if unit and value.is_percent:
            got, cure = f"{shown(plain)} {unit}", "Format the cell as a number."
            raise InputError(value.place, "is a percentage with a unit", got, cure)
        plain = with_unit(plain, unit) if unit else plain_number(plain)
    if spread is not None:
        return f"{plain} +- {_width(spread, unit)}"
    return [plain] if _takes_list(key) and not isinstance(plain, bool) else plain


def _width(cell: Cell, unit: str) -> str:
    if is_number(cell.value):
        return percent(cell.value) if cell.is_percent else with_unit(cell.value, unit)
    text = str(cell.value).strip().removeprefix("+-").removeprefix("±").lstrip()
    return f"{text} {unit}".strip() if is_plain(text) else text


def _takes_list(key: str) -> bool:
    return key.rpartition(".")[2] in LISTS


def _is_list(key: str, text: str) -> bool:
    """Whether a text is a list: its key takes one, or there are numbers on both sides of a separator."""
    parts = [part for part in text.split(SEPARATOR) if part.strip()]
    return _takes_list(key) or (SEPARATOR in text and all(map(begins_as_number, parts)))


def _items(text: str, unit: str) -> list[Plain]:
    """Return the items of a list in one cell."""
    return [
        item if not is_plain(item) else f"{item} {unit}" if unit else plain_number(float(item))
        for item in (part.strip() for part in text.split(SEPARATOR) if part.strip())
    ]


def _unit_of(section: str, key: str, inside: list[str]) -> str:
    """Unit of a key of a section, of a property of a material or of wear; empty where it has none."""
    within = Wear if key == "wear" else Material
    record, name = RECORDS.get(section), key
    if inside and inside[-1] in numbers_of(within):
        record, name = within, inside[-1]
    if record is not None and name in {f.name for f in fields(record)}:
        return unit_of(record, name)
    return {"radial_clearance": "m", "elastic_modulus": "Pa"}.get(name, "")


def _put(table: object, keys: tuple[str, ...], value: object) -> bool:
    """Set an item of a table, itself perhaps in a table; return whether its place was free."""
    for key in keys[:-1]:
        table = table.setdefault(key, {}) if isinstance(table, dict) else None
    if not isinstance(table, dict) or keys[-1] in table:
        return False
    table[keys[-1]] = value
    return True


class _Column(NamedTuple):
    """A column of the candidates: a property, or a number of an environment."""

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


def _add_candidates(document: Document, sheet: Sheet) -> None:
    """Add the candidates as tables."""
    columns, known = list(_columns(sheet)), document.places.known
    items: list[dict[str, object]] = []
    for row in range(3, sheet.last_row + 1):
        item: dict[str, object] = {}
        at = f"[ranking] candidates[{len(items) + 1}]"
        for column in columns:
            if (cell := sheet.given(row, column.number)) is None:
                continue
            if not _put(item, column.path, _part(cell, column)):
                rule = "is a property of a material that is also named"
                cure = "Give the name of one in the library, or the properties."
                raise InputError(cell.place, rule, cure=cure)
            first, *rest = column.path
            names = [f'"{rest[0][:60]}"', *rest[1:]] if first == "friction" else rest
            known[".".join([f"{at}.{first}", *names])] = cell.place
            if column.what == "mean":
                known[".".join([f"{at}.{first}", *names[:-1]])] = cell.place
        if item and "name" not in item:
            number = next((column.number for column in columns if column.what == "name"), 1)
            rule = f"must name the candidate of row {row}"
            raise InputError(sheet.at(row, number), rule, cure="Name it, or clear the row.")
        if item:
            if isinstance(given := item.get("friction"), dict):
                alone = {name: one["mean"] if set(one) == {"mean"} else one for name, one in given.items()}
                item["friction"] = alone
            items.append(item)
            known[at] = f"{sheet.place}, row {row}"
    if items:
        known["[ranking] candidates"] = sheet.place
        document.sections.setdefault("ranking", {})[CANDIDATES] = items


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


def _part(cell: Cell, column: _Column) -> Plain | list[Plain]:
    value, is_measured = cell.value, column.what in MEASURED and column.what != "source"
    if is_measured and isinstance(value, str) and not begins_as_number(value):
        cure = "Leave the cell empty if it was not measured."
        raise InputError(cell.place, "must be a number", shown(value), cure)
    if is_number(value):
        if column.what == "standard_deviation" and cell.is_percent:
            return percent(value)
        return with_unit(value, column.unit) if column.unit else plain_number(value)
    if column.environment and isinstance(value, str) and _is_list(column.what, value):
        return _items(value, "")
    return value
