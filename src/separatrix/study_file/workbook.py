"""A study in a workbook: one sheet for each section, one row for each key (docs/spreadsheets.md).

A row gives a key, its value, perhaps how uncertain it is, and its unit. It becomes what a TOML file would
say, ``"25 g"`` or ``"0.5 um +- 20 %"``, and is read by the same readers; a dotted key is a table in place.
The sheet `candidates` has one row for each cage material and its frictions by environment.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, ValidityWarning
from separatrix.spreadsheet import Workbook, column_name, open_workbook
from separatrix.study_file.candidates_sheet import CANDIDATES, candidates, has_their_headings
from separatrix.study_file.document import SECTIONS, TOP, Document, Entry, LibraryPlace
from separatrix.study_file.sheet_cells import (
    COLUMNS,
    MOST_COLUMNS,
    MOST_ROWS,
    Field,
    SheetText,
    fields_of,
    sheet_text,
)
from separatrix.study_file.sheet_values import written_value
from separatrix.toml_text import label_of
from separatrix.toml_values import nearest
from separatrix.units import printable, shown

STUDY_SHEET = "study"
"""The sheet of what stands above the sections: title, extends, library."""

_KEY = re.compile(r"[A-Za-z0-9_]+(?:\.[A-Za-z0-9_ -]+){0,2}")


def document_of(path: Path) -> Document:
    """Return the document of a workbook.

    Raises
    ------
    InputError
        It is no workbook that can be read safely, or is not laid out as a study.

    Warns
    -----
    ValidityWarning
        It holds formulas: their saved values are taken.
    """
    workbook = open_workbook(path)
    document = Document(label_of(path), folder=path.parent)
    formulas: list[str] = []
    known: dict[str, str] = {}
    for name in workbook.sheets:
        text = _sheet(workbook, name)
        if text is not None:
            if (twin := known.setdefault(name.strip().casefold(), name)) != name:
                cure = "Delete one of them, or give it another name."
                raise InputError(text.place, "is a second sheet of that name", shown(twin), cure)
            _add(document, text)
            formulas += text.formulas
    document.libraries.append(LibraryPlace(path, document.top.get("library")))
    if not document.sections:
        cure = "`separatrix new --excel PATH.xlsx` writes one to fill in."
        raise InputError(document.label, "has no sheet of a study with a value in it", cure=cure)
    if formulas:
        _say_formulas(document.label, formulas)
    return document


def _say_formulas(label: str, cells: list[str]) -> None:
    listed = ", ".join(cells[:5]) + (", ..." if len(cells) > 5 else "")
    what = "the cell holds a formula" if len(cells) == 1 else f"{len(cells)} cells hold formulas"
    sentence = f"{label}: {what} ({listed}); values are those saved with them, nothing was computed again."
    warnings.warn(sentence, ValidityWarning, stacklevel=4)


def _sheet(workbook: Workbook, name: str) -> SheetText | None:
    """The texts and numbers of a sheet that belongs to a study; None for any other."""
    folded = name.strip().casefold()
    text = sheet_text(workbook, name)
    if folded in (*SECTIONS, STUDY_SHEET, CANDIDATES):
        if text.beyond:
            rule = f"lies beyond row {MOST_ROWS} or column {column_name(MOST_COLUMNS)}, and is not read"
            raise InputError(text.beyond, rule, cure="Move it, or clear it.")
        return text
    if text.has_headings or has_their_headings(text):
        cure = nearest(name, (STUDY_SHEET, *SECTIONS, CANDIDATES))
        raise InputError(text.place, "is no section of a study", cure=cure)
    return None


def _add(document: Document, sheet: SheetText) -> None:
    """Add what a sheet says to the document."""
    folded = sheet.name.strip().casefold()
    if folded == CANDIDATES:
        found = candidates(sheet, document)
        if found is not None:
            document.sections.setdefault("ranking", {})["candidates"] = found
        return
    if not sheet.has_headings:
        cure = f"Its first row has the headings {', '.join(COLUMNS)}."
        raise InputError(sheet.place, "has no headings key and value", cure=cure)
    entries = _entries(document, folded, sheet)
    if folded == STUDY_SHEET:
        document.top.update(_top(document, entries))
    elif entries:
        document.sections.setdefault(folded, {}).update(entries)


def _top(document: Document, entries: dict[str, Entry]) -> dict[str, Entry]:
    for key, entry in entries.items():
        if key not in TOP:
            cure = f"On this sheet there are only {', '.join(TOP)}."
            document.problems.append(
                InputError(f"{entry.place}: {key}", "is no key of this sheet", cure=cure)
            )
    return {key: entry for key, entry in entries.items() if key in TOP}


def _entries(document: Document, section: str, sheet: SheetText) -> dict[str, Entry]:
    """Entry of each key that has a value; dotted keys become tables."""
    entries: dict[str, Entry] = {}
    for field in _known_once(sheet):
        document.cells[f"[{section}] {field.key}"] = field.value_place
        document.cells[f"[{section}] {field.key} unit"] = field.unit_place
        document.cells[f"[{section}] {field.key}, after +-,"] = field.spread_place
        key, *inside = field.key.split(".")
        value = written_value(field)
        if inside:
            table = entries.setdefault(key, Entry({}, field.value_place, folder=document.folder)).value
            _set_in(table, inside, value, field)
        elif key in entries:
            raise InputError(f"{field.key_place}: {printable(key)}", "is given by rows of its parts, too")
        else:
            entries[key] = Entry(value, field.value_place, folder=document.folder)
    return entries


def _set_in(table: Any, keys: list[str], value: Any, field: Field) -> None:
    """Set an item of a table in place, itself perhaps in a table."""
    for key in keys[:-1]:
        table = table.setdefault(key, {}) if isinstance(table, dict) else None
    if not isinstance(table, dict) or keys[-1] in table:
        raise InputError(f"{field.key_place}: {printable(field.key)}", "is given as a value of its own, too")
    table[keys[-1]] = value


def _known_once(sheet: SheetText) -> Iterator[Field]:
    """Yield the rows that have a value; a key is written once, and as keys are."""
    seen: dict[str, str] = {}
    for field in fields_of(sheet):
        if _KEY.fullmatch(field.key) is None:
            raise InputError(field.key_place, "must be the name of a key", shown(field.key))
        if field.key in seen:
            cure = f"It stands in {seen[field.key]}, too."
            raise InputError(f"{field.key_place}: {field.key}", "is given a second time", cure=cure)
        seen[field.key] = field.cell
        yield field


_IN_CELLS = {
    "Write it without quotes.": "Enter it as a number, not as text.",
    "Write a decimal point, without quotes.": "Enter it as a number, not as text.",
    " in quotes": "",
    ", or a table with its properties in {braces}": ", or its properties in rows of their own",
    "must be a list in [brackets]": "must be a list with ; between its items",
}
"""Words of refusals that fit a text file, and those that fit cells."""


def in_cells(document: Document, error: InputError) -> InputError:
    """Return a refusal with the cell of each problem, and with words that fit a workbook."""
    from separatrix.errors import together

    return together([_in_cell(document, problem) for problem in error.problems or (error,)])


def _in_cell(document: Document, problem: InputError) -> InputError:
    place, _, name = problem.path.partition(": ")
    if ", sheet " not in place:
        return problem
    key = name.partition(", item")[0].strip()
    found = name if name in document.cells else next((k for k in _shorter(key) if k in document.cells), None)
    where, rule, cure = problem.path, problem.rule, problem.cure
    if found is not None:
        where = f"{document.cells[found]}: {name}"
    for said, better in _IN_CELLS.items():
        rule, cure = rule.replace(said, better), cure.replace(said, better)
    unit = re.fullmatch(r'Write "\S+ (.+)"\.', cure)
    is_bare = rule.startswith("needs a unit") and re.fullmatch(r"[-+.0-9eE]+", problem.got) is not None
    if found is not None and unit and is_bare and f"{found} unit" in document.cells:
        where, cure = f"{document.cells[f'{found} unit']}: {name}", f"Write {unit[1]} there."
    return InputError(where, rule, problem.got, cure)


def _shorter(name: str) -> Iterator[str]:
    """Yield a dotted name and, one after the other, what is left of it without its last part."""
    while name:
        yield name
        name = name.rpartition(".")[0]
