"""A workbook as the text of a TOML file: a sheet for each section, a row for each key.

A row gives a key, its value, perhaps its uncertainty, and its unit; it becomes a line such as
``mass = "25 g +- 10 %"``. A row ``[[candidates]]`` begins an item of a list, of which the rows below are.
Nothing is evaluated: a formula has the value that was saved with it.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.reader import Document
from separatrix.ground.schema import is_number, is_record, keys_of
from separatrix.ground.sheet import by_sheet
from separatrix.ground.toml import DOTTED, as_toml, label_of, nearest, parsed
from separatrix.ground.units import NUMBER, printable, shown

COLUMNS = ("key", "value", "+-", "unit", "meaning")
"""Headings of a sheet; key and value are required, others may be left out, in any order."""

TOP = "study"
"""Sheet of the keys above the sections."""

SEPARATOR = ";"
MOST_COLUMNS = 50

_PLAIN = re.compile(NUMBER)
_NUMBERED = re.compile(r"\s*[+-]?\.?[0-9]")
_ITEM = re.compile(r"\[\[(\w+)\]\]", re.ASCII)


class Cell(NamedTuple):
    """A cell with a value: its file, sheet and name, and what it is shown as."""

    value: float | int | str | bool
    place: str
    is_percent: bool
    is_formula: bool


def read_sheets(schema: Any, path: Path) -> Document:
    """Document of a workbook; sheets of its own that have not the headings of a section are not read."""
    made = _Making(schema, label_of(path))
    by_sheet(path, made.label, made.add_sheet)
    if made.problems:
        raise together(made.problems)
    lines = [*made.top, *made.below]
    if not lines:
        cure = "`separatrix new PATH.xlsx` writes one to fill in."
        raise InputError(made.label, f"has no sheet of {schema.FILE.noun} with a value", cure=cure)
    try:
        data, numbers = parsed("".join(f"{text}\n" for text, _ in lines), made.label, schema.FILE)
    except InputError as error:
        raise error.at(lines[error.line - 1][1] if error.line else made.label) from None
    places = {key: lines[number - 1][1] for key, number in numbers.items()}
    listed = ", ".join(made.formulas[:5]) + (", ..." if len(made.formulas) > 5 else "")
    note = f"{made.label}: the saved values of formulas are used, nothing is recomputed: {listed}."
    return Document(made.label, data, places, notes=(note,) if listed else ())


@dataclass(slots=True)
class _Making:
    """Lines of the text with the place of each, as they are made, sheet by sheet."""

    schema: Any
    label: str
    top: list[tuple[str, str]] = field(default_factory=list)
    below: list[tuple[str, str]] = field(default_factory=list)
    formulas: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)

    def add_sheet(self, title: str, saved: Any, formulas: Any) -> None:
        """Add the keys of a section, or those above the sections, from values and formulas of a sheet."""
        name, place = title.strip().casefold(), f"{self.label}, sheet {printable(title)}"
        rows = (one.iter_rows(max_col=MOST_COLUMNS) for one in (saved, formulas))
        made: list[tuple[str, str]] = []
        with noted(self.problems):
            for number, cells in enumerate(zip(*rows, strict=True)):
                if number == 0:
                    columns = self._columns([str(cell.value) for cell in cells[0]], title, place)
                with noted(self.problems):
                    row = {head: _cell(cells[0][i], cells[1][i], place) for head, i in columns.items()}
                    given = {head: cell for head, cell in row.items() if cell and number > 0}
                    made += _lines(given, name)
                    used = (cell.place.rpartition(" ")[2] for cell in given.values() if cell.is_formula)
                    self.formulas += [f"{name}!{cell}" for cell in used]
        if made and name == TOP:
            self.top += made
        elif made:
            self.below += [(f"[{name}]", place), *made]

    def _columns(self, heads: Sequence[str], title: str, place: str) -> dict[str, int]:
        """Place of each column by its heading; empty where the sheet is not read."""
        top = keys_of(self.schema).items()
        homes = [TOP, *(name for name, one in top if is_record(one.key.form or one.hint))]
        known = [head.strip().casefold().replace("±", "+-") for head in heads]
        columns = {head: known.index(head) for head in COLUMNS if head in known}
        is_of_keys = {"key", "value"} <= columns.keys()
        if title.strip().casefold() not in homes:
            if is_of_keys:
                rule = f"is not a section of {self.schema.FILE.noun}"
                raise InputError(place, rule, cure=nearest(title, homes))
            return {}
        if not is_of_keys:
            cure = f"Its first row has the headings {', '.join(COLUMNS)}."
            raise InputError(place, "has no headings key and value", cure=cure)
        if twice := [head for head in columns if known.count(head) > 1]:
            raise InputError(place, "has two columns of one heading", shown(twice[0]))
        return {head: i for head, i in columns.items() if head != "meaning"}


def _lines(row: Mapping[str, Cell], section: str) -> Iterator[tuple[str, str]]:
    """The line of a row with its place, if it has a value."""
    key, value, spread = (row.get(name) for name in COLUMNS[:3])
    if key is None and (stray := value or spread):
        raise InputError(stray.place, "is a value without a key", cure="Name the key in the same row.")
    if key is None:
        return
    if item := _ITEM.fullmatch(str(key.value)):
        yield f"[[{section}.{item[1]}]]", key.place
    elif value is None and spread is not None:
        raise InputError(spread.place, "is a width without a value")
    elif value is not None:
        if re.fullmatch(DOTTED, str(key.value)) is None:
            raise InputError(key.place, "must be the name of a key", shown(key.value))
        yield f"{key.value} = {_value(value, spread, row.get('unit'))}", value.place


def _cell(saved: Any, formula: Any, place: str) -> Cell | None:
    """A cell with its value; None of an empty one."""
    value, is_formula = saved.value, formula.data_type == "f"
    if isinstance(value, str):
        value = value.strip().replace("_x005F_", "_")  # it would begin the code of a character
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


def _value(value: Cell, spread: Cell | None, unit_cell: Cell | None) -> str:
    """Value of a row in TOML: as it is where it has brackets, a list where it has numbers between ``;``."""
    unit = "" if unit_cell is None or unit_cell.value == "-" else str(unit_cell.value)
    plain = value.value
    if value.is_percent and unit and is_number(plain):
        rule, got = "is a percentage with a unit", f"{shown(plain)} {unit}"
        raise InputError(value.place, rule, got, "Format the cell as a number.")
    if isinstance(plain, str):
        plain = plain.strip('"')  # as a refusal writes it
        parts = [part.strip() for part in plain.split(SEPARATOR) if part.strip()]
        is_list = SEPARATOR in plain and all(map(_NUMBERED.match, parts))
        if spread is not None and (is_list or plain[:1] in ("[", "{")):
            raise InputError(spread.place, "is a width beside a list", cure="Clear one of them.")
        if is_list:
            numbers = (float(part) if _PLAIN.fullmatch(part) else part for part in parts)
            return as_toml([_with_unit(one, unit) for one in numbers])
        if plain[:1] in ("[", "{"):
            parsed(f"value = {plain}", value.place)  # alone, so that no bracket reaches into the next row
            return plain
    if spread is not None:
        return as_toml(f"{_with_unit(plain, unit)} +- {_width(spread, unit)}")
    return as_toml(_with_unit(plain, unit))


def _width(cell: Cell, unit: str) -> str:
    """Width of a value as text: a percentage, or a number with the unit of the value."""
    if is_number(cell.value) and cell.is_percent:
        return f"{100.0 * cell.value:.12g} %"  # without the digits of rounding
    width = str(cell.value).removeprefix("+-").removeprefix("±").strip()
    return f"{width} {unit}".strip() if _PLAIN.fullmatch(width) else width


def _with_unit(value: float | int | str | bool, unit: str) -> float | int | str | bool:
    """A number without loss, an integer if it is one, as a text with its unit if it has one."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        value = int(value)
    return f"{value} {unit}" if unit else value
