"""A study as a workbook to fill in: keys and remarks of the commented template, units in a column."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

from separatrix import library
from separatrix.errors import InputError
from separatrix.spreadsheet.cells import column_name
from separatrix.spreadsheet.writing import (
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
from separatrix.study import Guidance, KinematicModel, PocketContact, PocketShape
from separatrix.study_file.candidates_sheet import CANDIDATES, MEASURED
from separatrix.study_file.cells_of_values import Written, rows_of
from separatrix.study_file.document import SECTIONS, Document, load
from separatrix.study_file.sheet_cells import COLUMNS
from separatrix.study_file.shipped import template_path
from separatrix.study_file.template_rows import (
    TemplateKey,
    is_required,
    meaning,
    section_remarks,
    template_keys,
)
from separatrix.study_file.workbook import STUDY_SHEET
from separatrix.units import UNITS

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

LISTS_SHEET = "lists"
INSTRUCTIONS = (
    "A study for separatrix: one bearing, its operating point, the film on its races, its cage, candidates.",
    "Fill in the yellow cells of each sheet; the names of the sheets and the headings stay as they are.",
    "A key in bold is required. A key without a value has its default, which stands in its meaning.",
    "A value is a number; its unit stands beside it, from the list or spelled like it. Ratios have no unit.",
    "Under +- stands how uncertain a value is: 20 %, or a number in the same unit (two standard deviations).",
    "Several values stand in one cell with ; between them: 0.1; 0.5; 2.",
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

MOST_FRICTIONS = ("mean", "standard_deviation", "count")
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
ENTRY = Look(fill=INPUT)
REQUIRED = Look(bold=True)


def template_workbook() -> bytes:
    """Return the workbook that ``separatrix new --excel`` writes; valid as it stands."""
    return study_workbook(load(template_path()))


def study_workbook(document: Document) -> bytes:
    """Return a study as a workbook which reads back as the same study.

    Raises
    ------
    InputError
        A friction is given in a form that has no columns: bounds, or samples.
    """
    book = new_workbook()
    choices = _Choices()
    _instructions(add_sheet(book, "instructions"))
    _section(add_sheet(book, STUDY_SHEET), "", {k: e.value for k, e in document.top.items()}, choices)
    for name in SECTIONS:
        values = {key: entry.value for key, entry in document.sections.get(name, {}).items()}
        values.pop(CANDIDATES, None)
        _section(add_sheet(book, name), name, values, choices)
    given = document.sections.get("ranking", {}).get(CANDIDATES)
    _candidates(add_sheet(book, CANDIDATES), given.value if given else [], choices)
    choices.write(book)
    return workbook_bytes(book)


def _instructions(sheet: Worksheet) -> None:
    headings(sheet, ("How to fill this in",))
    for number, line in enumerate(INSTRUCTIONS, 2):
        put(sheet, number, 1, line, WRAPPED)
    widths(sheet, 110)


def _section(sheet: Worksheet, section: str, values: Mapping[str, Any], choices: _Choices) -> None:
    """Write the keys of a section, those without a value too."""
    headings(sheet, COLUMNS, keep_columns=1)
    row = 1
    for key, written, said, required in _keys(section, values):
        row += 1
        put(sheet, row, 1, key, REQUIRED if required else Look(), exact=True)
        cells = (written.value, written.spread, written.unit)
        for column, value in enumerate(cells, 2):
            put(sheet, row, column, value, ENTRY, exact=True)
        put(sheet, row, 5, said, SMALL)
        choices.add(sheet, row, f"{section}.{key}", written.unit)
    if remark := section_remarks().get(section):
        put(sheet, row + 1, 5, remark, SMALL)
    widths(sheet, 30, 24, 10, 10, 90)


def _keys(section: str, values: Mapping[str, Any]) -> Iterator[tuple[str, Written, str, bool]]:
    """Yield the rows of a section: key, cells, meaning, and whether it is required."""
    known = [one for one in template_keys() if one.section == section]
    for one in known:
        yield from _rows(one, values)
    others = [key for key in values if key not in {one.key for one in known}]
    for key in others:
        yield from ((name, written, "", False) for name, written in rows_of(key, values[key]))


def _rows(one: TemplateKey, values: Mapping[str, Any]) -> Iterator[tuple[str, Written, str, bool]]:
    is_given = one.key in values
    required = is_required(one)
    for name, written in rows_of(one.key, values[one.key] if is_given else one.example):
        shown = written if is_given else Written(unit=written.unit)
        yield name, shown, meaning(one) if name == one.key else "", required


def _candidates(sheet: Worksheet, items: Sequence[Mapping[str, Any]], choices: _Choices) -> None:
    """Write the candidates: their frictions by environment, with room for more of them."""
    for item in items:
        _check_columns(item)
    columns = list(_candidate_columns(items))
    for number, column in enumerate(columns, 1):
        put(sheet, 1, number, column.above, HEADING, exact=True)
        put(sheet, 2, number, column.below, HEADING, exact=True)
    for row in range(3, 3 + len(items) + EMPTY_ROWS):
        item = items[row - 3] if row - 3 < len(items) else {}
        for number, column in enumerate(columns, 1):
            value = column.of(item)
            put(sheet, row, number, value, ENTRY, exact=True)
        choices.add(sheet, row, "cage.material", "")
    sheet.freeze_panes = "B3"
    widths(sheet, *(26.0 if column.below in ("name", "material") else 20.0 for column in columns))


def _check_columns(item: Mapping[str, Any]) -> None:
    """Refuse a friction in a form that has no columns."""
    for environment, friction in item["friction"].items():
        if isinstance(friction, Mapping) and not set(friction) <= set(MEASURED):
            where, forms = f"{item['name']}, {environment}", ", ".join(friction)
            cure = 'Write it like "0.12 +- 20 %".'
            raise InputError(where, f"has no column in a workbook for {forms}", cure=cure)


@dataclass(frozen=True, slots=True)
class _CandidateColumn:
    """One column of the sheet of candidates, and what it shows of a candidate."""

    above: str
    below: str
    keys: tuple[str, ...]

    def of(self, item: Mapping[str, Any]) -> Any:
        """Return what a candidate has there; None if nothing."""
        value: Any = item
        for key in self.keys:
            value = value.get(key) if isinstance(value, Mapping) else None
        if self.below == "mean" and value is None:
            value = item.get("friction", {}).get(self.above)
        if value is None or isinstance(value, Mapping):
            return None
        written = next(iter(rows_of(self.below, value)))[1]
        return written.value if written.unit in ("", self.above) and not written.spread else value


def _candidate_columns(items: Sequence[Mapping[str, Any]]) -> Iterator[_CandidateColumn]:
    yield _CandidateColumn("", "name", ("name",))
    yield _CandidateColumn("", "material", ("material",))
    yield _CandidateColumn("GPa", "elastic_modulus", ("material", "elastic_modulus"))
    yield _CandidateColumn("", "poisson_ratio", ("material", "poisson_ratio"))
    for environment in _environments(items):
        for part in _parts(items, environment):
            yield _CandidateColumn(environment, part, ("friction", environment, part))


def _environments(items: Sequence[Mapping[str, Any]]) -> Iterable[str]:
    if items:
        return dict.fromkeys(name for item in items for name in item["friction"])
    example = next(
        one.example
        for one in template_keys()
        if one.section == "ranking.candidates" and one.key == "friction"
    )
    return list(example)


def _parts(items: Sequence[Mapping[str, Any]], environment: str) -> Iterator[str]:
    frictions = [item["friction"].get(environment) for item in items]
    given = {key for one in frictions if isinstance(one, Mapping) for key in one}
    return (part for part in MEASURED if part in MOST_FRICTIONS or part in given)


class _Choices:
    """Drop-down lists, whose items stand in a hidden sheet."""

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
        from openpyxl.worksheet.datavalidation import DataValidation

        hidden = add_sheet(book, LISTS_SHEET)
        hidden.sheet_state = "hidden"
        for sheet, cell, items, is_strict in self._cells:
            validation = DataValidation(type="list", formula1=self._range(hidden, items), allow_blank=True)
            validation.showErrorMessage = is_strict
            validation.error = "Choose one of the list."
            sheet.add_data_validation(validation)
            validation.add(cell)

    def _range(self, hidden: Worksheet, items: tuple[str, ...]) -> str:
        if items not in self._lists:
            self._lists[items] = len(self._lists) + 1
            for row, item in enumerate(items, 1):
                put(hidden, row, self._lists[items], item, exact=True)
        letters = column_name(self._lists[items])
        return f"={LISTS_SHEET}!${letters}$1:${letters}${len(items)}"
