"""Forms to fill in: keys and remarks of the commented template, names to choose from, and the workbook."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from separatrix.ground.errors import DataError, InputError
from separatrix.ground.input_files import place
from separatrix.ground.sheet import (
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
from separatrix.ground.units import NUMBER, UNITS
from separatrix.study.library import Library
from separatrix.study.reading.cells import COLUMNS, SEPARATOR, with_unit
from separatrix.study.reading.document import SECTIONS, TEMPLATE, Document, library_of, load
from separatrix.study.reading.values import options_of, required_fields
from separatrix.study.reading.workbook import CANDIDATES, MEASURED, OWN, STUDY_SHEET
from separatrix.study.study import SECTIONS as RECORDS

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
"""Yellow rows for candidates."""

TEXTS = frozenset({"title", "extends", "fluid"})
"""Keys that are words even if they look like a quantity."""

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
ENTRY = Look(fill=INPUT)


@dataclass(frozen=True, slots=True)
class TemplateKey:
    """One key of the template: its section (empty above the first), an example, and its meaning."""

    section: str
    key: str
    example: object
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
    """Return the remark of the template on each section as a whole."""
    found = (_HEADER.fullmatch(line) for line in TEMPLATE.read_text(encoding="utf-8").splitlines())
    return {match[2]: match[3] for match in found if match and match[3] and not match[1]}


def cells_of(key: str, value: object) -> Iterator[tuple[str, object, str]]:
    """Yield key, value and unit of the rows of a value of the template; a table has a row for each part."""
    if isinstance(value, dict):
        for part, item in value.items():
            yield from cells_of(f"{key}.{part}", item)
    elif isinstance(value, list):
        found = [quantity_of(item) for item in value]
        texts = [
            str(item) if number is None else with_unit(float(number), "")
            for item, (number, _) in zip(value, found, strict=True)
        ]
        yield key, f"{SEPARATOR} ".join(texts), found[0][1]
    else:
        number, unit = (None, "") if key in TEXTS else quantity_of(value)
        yield key, float(number) if number and unit else value, unit


def quantity_of(value: object) -> tuple[str | None, str]:
    """Return number and unit of a value of a study file as texts; None for one that is not a quantity."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return str(value), ""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None or not match[2] or not units_like(match[2]):
        return None, ""
    return match[1], match[2]


def units_like(unit: str) -> tuple[str, ...]:
    """Return the spellings of the units of the same kind; empty for one that is not known."""
    return next((tuple(known) for known in UNITS.values() if unit and unit in known), ())


def choices_of(section: str, key: str) -> tuple[tuple[str, ...], bool]:
    """Return the choices of a key, none if it has no list, and whether another name is allowed too."""
    if (options := options_of(section, key)) is not None:
        return tuple(str(one.value) for one in options), False
    kind = _NAMES.get(f"{section}.{key}")
    return (Library().names(kind) if kind else ()), True


def is_name(section: str, key: str) -> bool:
    """Whether the value of a key is a name, which is text even if it looks like a number: steel 52100."""
    return key in TEXTS or bool(choices_of(section, key)[0])


def template_workbook() -> bytes:
    """Return the workbook that ``separatrix new --excel`` writes; valid as it is."""
    document, book, choices = load(TEMPLATE), new_workbook(), _Choices()
    sheet = add_sheet(book, "instructions")
    headings(sheet, ("How to fill this in",))
    for number, line in enumerate(INSTRUCTIONS, 2):
        put(sheet, number, 1, line, WRAPPED)
    widths(sheet, 110)
    _section(add_sheet(book, STUDY_SHEET), "", document.top, choices)
    for name in SECTIONS:
        _section(add_sheet(book, name), name, document.sections[name], choices)
    _candidates(add_sheet(book, CANDIDATES), choices)
    choices.write(book)
    return workbook_bytes(book)


def _section(sheet: Worksheet, section: str, values: Mapping[str, object], choices: _Choices) -> None:
    """Write the keys of a section, those without a value too."""
    headings(sheet, COLUMNS, keep_columns=1)
    row = 1
    for one in (one for one in template_keys() if one.section == section):
        for name, value, unit in cells_of(one.key, one.example):
            row += 1
            put(sheet, row, 1, name, Look(bold=one.is_required), exact=True)
            for column, shown in enumerate((value if one.key in values else None, None, unit), 2):
                put(sheet, row, column, shown, ENTRY, exact=True)
            put(sheet, row, 5, one.meaning if name == one.key else "", SMALL)
            choices.add(sheet, row, f"{section}.{name}", unit)
    if remark := section_remarks().get(section):
        put(sheet, row + 1, 5, remark, SMALL)
    widths(sheet, 30, 24, 10, 10, 90)


def _candidates(sheet: Worksheet, choices: _Choices) -> None:
    """Write the headings of the candidates, with room for some."""
    examples = {(one.section, one.key): one.example for one in template_keys()}
    columns = [("", "name"), ("", "material"), ("GPa", "elastic_modulus"), ("", "poisson_ratio")]
    frictions = examples["ranking.candidates", "friction"]
    for environment in frictions if isinstance(frictions, dict) else ():
        columns += [(environment, part) for part in MEASURED if part != "source"]
    for number, (above, below) in enumerate(columns, 1):
        put(sheet, 1, number, above, HEADING, exact=True)
        put(sheet, 2, number, below, HEADING, exact=True)
        for row in range(3, 3 + EMPTY_ROWS):
            put(sheet, row, number, None, ENTRY, exact=True)
    for row in range(3, 3 + EMPTY_ROWS):
        choices.add(sheet, row, "cage.material", "")
    sheet.freeze_panes = "B3"
    widths(sheet, *(26.0 if below in OWN else 20.0 for _, below in columns))


class _Choices:
    """Drop-down lists, whose items are in a hidden sheet."""

    def __init__(self) -> None:
        self._lists: dict[tuple[str, ...], int] = {}
        self._cells: list[tuple[Worksheet, str, tuple[str, ...], bool]] = []

    def add(self, sheet: Worksheet, row: int, key: str, unit: str) -> None:
        """Add the lists for value and unit of a row."""
        items, is_open = choices_of(*key.split(".", 1))
        if items:
            self._cells.append((sheet, f"B{row}", items, not is_open))
        if spellings := units_like(unit):
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


def tested_materials(document: Document) -> tuple[str, ...]:
    """Return the materials of the table or file in [ranking] friction; none if it cannot be read."""
    name = document.sections.get("ranking", {}).get("friction")
    if not isinstance(name, str):
        return ()
    try:
        if not name.endswith(".toml"):
            library = library_of(document)
            table = library.friction_table(library.named("friction table", name) or name)
            return tuple(table.content.friction)
        from separatrix.friction.file import read_friction

        tests = read_friction(place(document.friction_folder, name))
        return tuple(dict.fromkeys(test.material for test in tests))
    except (DataError, InputError):  # refused where the study is read
        return ()
