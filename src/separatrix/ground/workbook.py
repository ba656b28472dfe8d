"""A workbook as the document of a schema: a sheet for each section, a row for each key.

A row gives a key, its value, perhaps its uncertainty, and its unit; they become the value of a TOML file,
``"25 g"`` or ``"0.5 um +- 20 %"``. A dotted key is a table in place, a number in it counts the items of a
list: ``candidates.1.name``. Nothing is evaluated: a formula has the value that was saved with it.
"""

from __future__ import annotations

import datetime
import re
import typing
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.reader import Document
from separatrix.ground.schema import Described, is_number, is_record, keys_of, without_none, without_unit
from separatrix.ground.sheet import by_sheet
from separatrix.ground.toml import KeyPath, label_of, nearest
from separatrix.ground.units import NUMBER, printable, shown

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a sheet; key and value are required, others may be left out, in any order."""

TOP = "study"
"""Sheet of the keys above the sections."""

SEPARATOR = ";"
MOST_COLUMNS = 50
Plain = float | int | str | bool

_PLAIN = re.compile(NUMBER)
_PART = re.compile(r'"([^"]+)"|([\w -]+)', re.ASCII)
_KEY = re.compile(rf"\w+(?:\.(?:{_PART.pattern})){{0,5}}", re.ASCII)


class Cell(NamedTuple):
    """A cell with a value: its file, sheet and name, and what it is shown as."""

    value: Plain
    place: str
    is_percent: bool
    is_formula: bool


def read_sheets(schema: Any, path: Path) -> Document:
    """Document of a workbook; sheets of its own that have not the headings of a section are not read."""
    made = _Making(schema, label_of(path))
    by_sheet(path, made.label, made.add_sheet)
    if made.problems:
        raise together(made.problems)
    if not made.data:
        cure = "`separatrix new PATH.xlsx` writes one to fill in."
        raise InputError(made.label, f"has no sheet of {schema.FILE.noun} with a value", cure=cure)
    listed = ", ".join(made.formulas[:5]) + (", ..." if len(made.formulas) > 5 else "")
    note = f"{made.label}: the saved values of formulas are used, nothing is recomputed: {listed}."
    return Document(made.label, made.data, made.places, notes=(note,) if listed else ())


@dataclass(slots=True)
class _Making:
    """A document as it is made, sheet by sheet."""

    schema: Any
    label: str
    data: dict[str, Any] = field(default_factory=dict)
    places: dict[KeyPath, str] = field(default_factory=dict)
    formulas: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)

    def add_sheet(self, title: str, saved: Any, formulas: Any) -> None:
        """Add the keys of a section, or those above the sections, from values and formulas of a sheet."""
        name, place = title.strip().casefold(), f"{self.label}, sheet {printable(title)}"
        rows = (one.iter_rows(max_col=MOST_COLUMNS) for one in (saved, formulas))
        with noted(self.problems):
            for number, cells in enumerate(zip(*rows, strict=True)):
                if number == 0:
                    columns = self._columns([str(cell.value) for cell in cells[0]], title, place)
                with noted(self.problems):
                    row = {head: _cell(cells[0][i], cells[1][i], place) for head, i in columns.items()}
                    if number > 0:
                        self._add({head: cell for head, cell in row.items() if cell}, name, place)

    def _columns(self, heads: Sequence[str], title: str, place: str) -> dict[str, int]:
        """Place of each column by its heading; empty where the sheet is not read."""
        top = keys_of(self.schema).items()
        homes = [TOP, *(name for name, one in top if is_record(one.key.form or one.hint))]
        known = [(head.strip().casefold().replace("±", "+-"), i) for i, head in enumerate(heads)]
        columns = {head: i for head, i in reversed(known) if head in COLUMNS}
        is_of_keys = {"key", "value"} <= columns.keys()
        if title.strip().casefold() not in homes:
            if is_of_keys:
                rule = f"is not a section of {self.schema.FILE.noun}"
                raise InputError(place, rule, cure=nearest(title, homes))
            return {}
        if not is_of_keys:
            cure = f"Its first row has the headings {', '.join(COLUMNS)}."
            raise InputError(place, "has no headings key and value", cure=cure)
        if twice := [head for head, _ in known if head in columns and sum(head == h for h, _ in known) > 1]:
            raise InputError(place, "has two columns of one heading", shown(twice[0]))
        return {head: columns[head] for head in COLUMNS[:4] if head in columns}

    def _add(self, row: Mapping[str, Cell], name: str, place: str) -> None:
        """Add the key of a row, if it has a value."""
        section: KeyPath = () if name == TOP else (name,)
        if "key" not in row and (stray := row.get("value", row.get("+-"))):
            raise InputError(stray.place, "is a value without a key", cure="Name the key in the same row.")
        if "value" not in row and "+-" in row:
            raise InputError(row["+-"].place, "is a width without a value")
        if not {"key", "value"} <= row.keys():
            return
        key, value = row["key"], row["value"]
        if _KEY.fullmatch(str(key.value)) is None:
            raise InputError(key.place, "must be the name of a key", shown(key.value))
        parts = tuple(a or b for a, b in _PART.findall(str(key.value)))
        path, hint, is_name = self._typed((*section, *parts))
        if section:
            self.places.setdefault(section, place)
        at = f"{key.place}: {printable(str(key.value))}"
        self._put(path, _value(hint, is_name, value, row.get("+-"), row.get("unit")), value.place, at)
        cells = (cell.place.rpartition(" ")[2] for cell in row.values() if cell.is_formula)
        self.formulas += [f"{name}!{cell}" for cell in cells]

    def _typed(self, path: KeyPath) -> tuple[KeyPath, Any, bool]:
        """Path of a key with its items counted from 0, its type, and whether it is a name of the library.

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
                part = int(part) - 1 if str(part).isdigit() else part
                owner = _item_of(owner)
            elif owner is not None:
                is_names = typing.get_origin(owner) is Mapping
                owner = without_none(typing.get_args(owner)[1])[0] if is_names else float
            found = (*found, part)
        return found, owner, one is not None and bool(one.key.named) and is_record(owner)

    def _put(self, path: KeyPath, value: object, place: str, at: str) -> None:
        """Set the value of a path, in tables and lists that are made."""
        table: Any = self.data
        for part, after in pairwise(path):
            if isinstance(table, list) and isinstance(part, int):
                if not 0 <= part <= len(table):
                    raise InputError(at, "must count items from 1, without a gap", str(part + 1))
                table += [{}] * (part == len(table))
                table = table[part]
            elif isinstance(table, dict):
                table = table.setdefault(part, [] if isinstance(after, int) else {})
        if isinstance(path[-1], int) or not isinstance(table, dict) or path[-1] in table:
            cure = f"It is in {self.places[path].rpartition(' ')[2]}, too." if path in self.places else ""
            raise InputError(at, "is given a second time, or as a whole and by its parts", cure=cure)
        table[path[-1]] = value
        for length in range(2, len(path)):
            self.places.setdefault(path[:length], place)
        self.places[path] = place


def _cell(saved: Any, formula: Any, place: str) -> Cell | None:
    """A cell with its value; None of an empty one."""
    value, is_formula = saved.value, formula.data_type == "f"
    if isinstance(value, str):
        value = value.strip().replace(
            "_x005F_", "_"
        )  # an underscore that would begin the code of a character
    if value in (None, "") and not is_formula:
        return None
    where = f"{place}, cell {saved.coordinate}"
    if value in (None, ""):
        cure = "Open the workbook in a spreadsheet program and save it, or enter the value."
        raise InputError(where, "has a formula without a saved value", shown(formula.value), cure)
    if saved.data_type == "e":
        raise InputError(where, "shows an error instead of a value", str(value))
    if isinstance(value, datetime.date | datetime.time | datetime.timedelta):
        cure = "Format the cell as a number, and enter the value again."
        raise InputError(where, "has a date or a time of day", cure=cure)
    return Cell(value, where, "%" in saved.number_format, is_formula)


def _item_of(hint: Any) -> Any:
    """Type of the items of a list; None of what is none."""
    return without_unit(typing.get_args(hint)[0])[0] if typing.get_origin(hint) is tuple else None


def _value(
    hint: Any, is_name: bool, value: Cell, spread: Cell | None, unit_cell: Cell | None
) -> Plain | list[Plain]:
    """Value of a row as a TOML file has it."""
    item = _item_of(hint)
    is_text = is_name or (item or hint) is str or (isinstance(hint, type) and issubclass(hint, Enum))
    unit = "" if unit_cell is None or unit_cell.value == "-" else str(unit_cell.value)
    plain: Plain = value.value
    if isinstance(plain, str):
        plain = plain if is_text else plain.strip('"')  # as a refusal writes it
        if item or (not is_text and SEPARATOR in plain):
            if spread is not None:
                raise InputError(spread.place, "is a width beside a list", cure="Clear one of them.")
            parts = [part.strip() for part in plain.split(SEPARATOR) if part.strip()]
            return [part if is_text else _with_unit(part, unit) for part in parts]
        plain = plain if is_text else _with_unit(plain, unit)
    elif is_number(plain):
        if unit and value.is_percent:
            rule, got = "is a percentage with a unit", f"{shown(plain)} {unit}"
            raise InputError(value.place, rule, got, "Format the cell as a number.")
        plain = str(_with_unit(plain, "")) if is_text else _with_unit(plain, unit)
    if spread is not None:
        return f"{plain} +- {_width(spread, unit)}"
    return [plain] if item else plain


def _width(cell: Cell, unit: str) -> str:
    """Width of a value as text: a percentage, or a number with the unit of the value."""
    if is_number(cell.value) and cell.is_percent:
        return f"{100.0 * cell.value:.12g} %"  # without the digits of rounding
    width = cell.value
    if isinstance(width, str):
        width = width.removeprefix("+-").removeprefix("±").strip()
        unit = unit if _PLAIN.fullmatch(width) else ""
    return str(_with_unit(width, unit))


def _with_unit(value: Plain, unit: str) -> Plain:
    """A number without loss, an integer if it is one, as a text with its unit if it has one."""
    if isinstance(value, str) and _PLAIN.fullmatch(value) and not unit:
        value = float(value)
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        value = int(value)
    return f"{value} {unit}" if unit else value
