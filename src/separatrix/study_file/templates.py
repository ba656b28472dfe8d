"""A study as a workbook to fill in: keys and remarks of the commented template, units in a column."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from separatrix import library
from separatrix.errors import InputError
from separatrix.study import SECTIONS as RECORDS
from separatrix.study import Guidance, KinematicModel, PocketContact, PocketShape
from separatrix.study_file.cells import COLUMNS, SEPARATOR, with_unit
from separatrix.study_file.document import SECTIONS, TEMPLATE, Document, load
from separatrix.study_file.sections import required_fields
from separatrix.study_file.workbook import CANDIDATES, MEASURED, STUDY_SHEET
from separatrix.units import NUMBER, UNITS
from separatrix.workbook_looks import (
    HEADING,
    INPUT,
    SMALL,
    WRAPPED,
    Look,
    add_sheet,
    headings,
    new_workbook,
    put,
    widths,
    workbook_bytes,
)

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

LISTS_SHEET = "lists"
INSTRUCTIONS = (
    "A study for separatrix: one bearing, its operating point, the film on its races, its cage, candidates.",
    "Fill in the yellow cells of each sheet; the names of the sheets and the headings stay as they are.",
    "A key in bold is required. A key without a value has its default, which its meaning states.",
    "A value is a number; its unit is beside it, from the list or spelled like it. Ratios have no unit.",
    "Under +- is the uncertainty of a value: 20 %, or a number in the same unit (two standard deviations).",
    "Several values are in one cell with ; between them: 0.1; 0.5; 2.",
    "A material is a name of the library, or has rows of its own: ball_material.elastic_modulus, ...",
    "Candidates: a row for each cage material, columns for its friction in each environment. Or name a table "
    "of the library on the sheet ranking; not both.",
    "Formulas may be used; the value saved with them is read. Workbooks with macros are refused, and "
    "so are formulas in one that takes values from other files.",
    "Sheets of your own are not read, unless they have the headings of a section or of candidates.",
    "Then: separatrix check THIS_FILE (is it right?)",
    "and: separatrix rank THIS_FILE (which cage material runs stably?)",
)
EMPTY_ROWS = 12
"""Yellow rows for candidates beyond those that are given."""

TEXTS = frozenset({"title", "extends", "library", "fluid", "name", "source", "confidence"})
"""Keys, and last parts of dotted keys, that are words even if they look like a quantity."""

_CHOICES: dict[str, type[Enum]] = {
    "kinematics.model": KinematicModel,
    "cage.guidance": Guidance,
    "cage.pocket_shape": PocketShape,
    "cage.pocket_contact": PocketContact,
}
_NAMES = {
    "bearing.ball_material": "bearing material",
    "bearing.ring_material": "bearing material",
    "film.material": "film",
    "cage.material": "cage material",
    "ranking.friction": "friction table",
}
_HEADER = re.compile(r"(# )?\[\[?([a-z_.]+)\]\]?\s*(?:#\s*(.*))?")
_KEY = re.compile(r"(# )?([a-z_]+) = (.*)")
_QUANTITY = re.compile(rf"\s*({NUMBER}) ?([^0-9\s].*?)?\s*")
_SPREAD = re.compile(r"(.+?)\s*\+-\s*(.+)")
ENTRY = Look(fill=INPUT)


@dataclass(frozen=True, slots=True)
class TemplateKey:
    """One key of the template: its section (empty above the first), an example, and its meaning."""

    section: str
    key: str
    example: Any
    meaning: str

    @property
    def is_required(self) -> bool:
        """Whether a section must have the key."""
        record = RECORDS.get(self.section)
        return record is not None and self.key in required_fields(record)


@cache
def template_keys() -> tuple[TemplateKey, ...]:
    """Return the keys of the template in its order."""
    found, section, above = [], "", ""
    for line in TEMPLATE.read_text(encoding="utf-8").splitlines():
        header, key = _HEADER.fullmatch(line), _KEY.fullmatch(line)
        if header:
            section, above = header[2], ""
        elif key:
            value, _, comment = key[3].partition(" #")
            meaning = " ".join(part for part in (above.rstrip(":"), comment.strip(" #")) if part)
            found.append(TemplateKey(section, key[2], tomllib.loads(f"value = {value}")["value"], meaning))
            above = ""
        elif section and line.startswith("# "):
            above = f"{above} {line[2:].strip()}".strip()
    return tuple(found)


@cache
def section_remarks() -> dict[str, str]:
    """Return what the template states of a section as a whole."""
    found = (_HEADER.fullmatch(line) for line in TEMPLATE.read_text(encoding="utf-8").splitlines())
    return {match[2]: match[3] for match in found if match and match[3] and not match[1]}


class Written(NamedTuple):
    """The cells of a row."""

    value: Any = None
    spread: Any = None
    unit: str = ""


def cells_of(key: str, value: Any) -> Iterator[tuple[str, Written]]:
    """Yield the keys and cells of a value of a TOML file; a table has a row for each of its parts."""
    if isinstance(value, dict):
        for part, item in value.items():
            yield from cells_of(f"{key}.{part}", item)
    elif isinstance(value, list):
        found = [_quantity(item) if isinstance(item, str) else (item, "") for item in value]
        numbers = [float(number) for number, _ in found if isinstance(number, int | float)]
        units = {unit for _, unit in found}
        same = len(units) == 1 and len(numbers) == len(value)
        items = (with_unit(number, "") for number in numbers) if same else map(str, value)
        yield key, Written(f"{SEPARATOR} ".join(items), unit=units.pop() if same else "")
    elif not isinstance(value, str) or key.rpartition(".")[2] in TEXTS:
        yield key, Written(value)
    elif (spread := _SPREAD.fullmatch(value)) is not None:
        number, unit = _quantity(spread[1])
        half, half_unit = _quantity(spread[2])
        if number is not None and half is not None and half_unit == unit:
            yield key, Written(number, half, unit)
        elif number is not None and spread[2].endswith("%"):
            yield key, Written(number, spread[2], unit)
        else:  # parts of different units
            yield key, Written(value)
    else:
        number, unit = _quantity(value)
        yield key, Written(value if number is None else number, unit=unit)


def _quantity(text: str) -> tuple[float | None, str]:
    """Return number and unit of a text, if a cell holds the number without loss; else None."""
    match = _QUANTITY.fullmatch(text)
    unit = match[2] or "" if match else ""
    if match is None or not any(unit in known for known in UNITS.values()):
        return None, ""
    number = float(match[1])
    return (number, unit) if Fraction(with_unit(number, "")) == Fraction(match[1]) else (None, "")


def template_workbook() -> bytes:
    """Return the workbook that ``separatrix new --excel`` writes; valid as it is."""
    return study_workbook(load(TEMPLATE))


def study_workbook(document: Document) -> bytes:
    """Return a study as a workbook which reads back as the same study.

    Raises
    ------
    InputError
        A friction is given in a form that has no columns: bounds, or samples.
    """
    book = new_workbook()
    choices = _Choices()
    sheet = add_sheet(book, "instructions")
    headings(sheet, ("How to fill this in",))
    for number, line in enumerate(INSTRUCTIONS, 2):
        put(sheet, number, 1, line, WRAPPED)
    widths(sheet, 110)
    _section(add_sheet(book, STUDY_SHEET), "", document.top, choices)
    for name in SECTIONS:
        values = {k: v for k, v in document.sections.get(name, {}).items() if k != CANDIDATES}
        _section(add_sheet(book, name), name, values, choices)
    given = document.sections.get("ranking", {}).get(CANDIDATES, [])
    _candidates(add_sheet(book, CANDIDATES), given, choices)
    choices.write(book)
    return workbook_bytes(book)


def _section(sheet: Worksheet, section: str, values: Mapping[str, Any], choices: _Choices) -> None:
    """Write the keys of a section, those without a value too."""
    headings(sheet, COLUMNS, keep_columns=1)
    row = 1
    for one, key in _keys(section, values):
        for name, written in cells_of(key, values[key] if key in values or one is None else one.example):
            row += 1
            put(sheet, row, 1, name, Look(bold=one is not None and one.is_required), exact=True)
            shown = written if key in values else Written(unit=written.unit)
            for column, value in enumerate(shown, 2):
                put(sheet, row, column, value, ENTRY, exact=True)
            put(sheet, row, 5, one.meaning if one is not None and name == key else "", SMALL)
            choices.add(sheet, row, f"{section}.{name}", written.unit)
    if remark := section_remarks().get(section):
        put(sheet, row + 1, 5, remark, SMALL)
    widths(sheet, 30, 24, 10, 10, 90)


def _keys(section: str, values: Mapping[str, Any]) -> Iterator[tuple[TemplateKey | None, str]]:
    """Yield the keys of a section: those of the template, then others that are given."""
    known = {one.key: one for one in template_keys() if one.section == section}
    yield from ((one, key) for key, one in known.items())
    yield from ((None, key) for key in values if key not in known)


def _candidates(sheet: Worksheet, items: Sequence[Mapping[str, Any]], choices: _Choices) -> None:
    """Write the candidates: their frictions by environment, with room for more of them.

    Raises
    ------
    InputError
        A friction is in a form that has no column.
    """
    for item in items:
        for environment, friction in item["friction"].items():
            if isinstance(friction, Mapping) and not set(friction) <= set(MEASURED):
                where, forms = f"{item['name']}, {environment}", ", ".join(friction)
                rule = f"has no column in a workbook for {forms}"
                raise InputError(where, rule, cure='Write it like "0.12 +- 20 %".')
    columns = list(_candidate_columns(items))
    for number, (above, keys) in enumerate(columns, 1):
        put(sheet, 1, number, above, HEADING, exact=True)
        put(sheet, 2, number, keys[-1], HEADING, exact=True)
    for row in range(3, 3 + len(items) + EMPTY_ROWS):
        item = items[row - 3] if row - 3 < len(items) else {}
        for number, (above, keys) in enumerate(columns, 1):
            put(sheet, row, number, _in_column(item, above, keys), ENTRY, exact=True)
        choices.add(sheet, row, "cage.material", "")
    sheet.freeze_panes = "B3"
    widths(sheet, *(26.0 if keys[-1] in ("name", "material") else 20.0 for _, keys in columns))


def _candidate_columns(items: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the first heading of each column, and the keys of its value in a candidate."""
    yield from (("", ("name",)), ("", ("material",)), ("GPa", ("material", "elastic_modulus")))
    yield "", ("material", "poisson_ratio")
    example = next(
        one.example for one in template_keys() if (one.section, one.key) == ("ranking.candidates", "friction")
    )
    given = [item["friction"] for item in items] or [dict.fromkeys(example)]
    for environment in dict.fromkeys(name for frictions in given for name in frictions):
        frictions = [one.get(environment) for one in given]
        parts = {key for one in frictions if isinstance(one, Mapping) for key in one}
        for part in MEASURED:
            if part != "source" or part in parts:
                yield environment, ("friction", environment, part)


def _in_column(item: Mapping[str, Any], above: str, keys: tuple[str, ...]) -> Any:
    """Return what a candidate has in a column; None if nothing."""
    value: Any = item
    for key in keys:
        value = value.get(key) if isinstance(value, Mapping) else None
    if keys[-1] == "mean" and value is None:
        value = item.get("friction", {}).get(above)
    if value is None or isinstance(value, Mapping):
        return None
    written = next(iter(cells_of(keys[-1], value)))[1]
    return written.value if written.unit in ("", above) and not written.spread else value


class _Choices:
    """Drop-down lists, whose items are in a hidden sheet."""

    def __init__(self) -> None:
        self._lists: dict[tuple[str, ...], int] = {}
        self._cells: list[tuple[Worksheet, str, tuple[str, ...], bool]] = []

    def add(self, sheet: Worksheet, row: int, key: str, unit: str) -> None:
        """Give a row the lists for its value and its unit."""
        if key in _CHOICES:
            self._cells.append((sheet, f"B{row}", tuple(str(one.value) for one in _CHOICES[key]), True))
        elif key in _NAMES:
            self._cells.append((sheet, f"B{row}", library.names(_NAMES[key]), False))
        spellings = next((tuple(known) for known in UNITS.values() if unit and unit in known), ())
        if spellings:
            self._cells.append((sheet, f"D{row}", spellings, False))

    def write(self, book: Workbook) -> None:
        """Write the lists, and point the cells to them."""
        from openpyxl.utils import get_column_letter
        from openpyxl.worksheet.datavalidation import DataValidation

        hidden = add_sheet(book, LISTS_SHEET)
        hidden.sheet_state = "hidden"
        for sheet, cell, items, is_strict in self._cells:
            if items not in self._lists:
                self._lists[items] = len(self._lists) + 1
                for row, item in enumerate(items, 1):
                    put(hidden, row, self._lists[items], item, exact=True)
            letters = get_column_letter(self._lists[items])
            where = f"={LISTS_SHEET}!${letters}$1:${letters}${len(items)}"
            validation = DataValidation(type="list", formula1=where, allow_blank=True)
            validation.showErrorMessage = is_strict
            validation.error = "Choose one of the list."
            sheet.add_data_validation(validation)
            validation.add(cell)
