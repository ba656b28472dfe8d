"""The sheet of candidates: a row for each cage material, columns for its frictions in each environment.

The first row names the environments, the second what stands below: mean, standard_deviation, count or source
under an environment; name, material and perhaps its elastic properties before them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from separatrix.errors import InputError
from separatrix.spreadsheet import Cell
from separatrix.study_file.document import Document, Entry
from separatrix.study_file.sheet_cells import SheetText
from separatrix.study_file.sheet_values import begins_as_number, is_list, list_of, number_text, plain_number
from separatrix.toml_values import nearest
from separatrix.units import shown

CANDIDATES = "candidates"
FIRST_ROW = 3
OWN = ("name", "material")
PROPERTIES = ("elastic_modulus", "poisson_ratio", "density", "source")
"""Of a material in place; one with a unit has it in the first row."""

MEASURED = ("mean", "standard_deviation", "count", "source")


@dataclass(frozen=True, slots=True)
class _Column:
    """What a column holds."""

    number: int
    what: str
    environment: str = ""
    unit: str = ""


def candidates(sheet: SheetText, document: Document) -> Entry | None:
    """Return the candidates as tables; None if the sheet has none.

    Raises
    ------
    InputError
        The headings are not those of candidates, or a row has frictions but no name.
    """
    columns = list(_columns(sheet))
    items: list[dict[str, Any]] = []
    places: list[str] = []
    for row in range(FIRST_ROW, sheet.last_row + 1):
        item = _candidate(sheet, document, row, columns, len(items) + 1)
        if item:
            items.append(item)
            places.append(f"{sheet.place}, row {row}")
    return Entry(items, f"{sheet.place}", tuple(places), document.folder) if items else None


def has_their_headings(sheet: SheetText) -> bool:
    """Whether the second row has the headings of candidates and their frictions."""
    headings = {str(cell.value).strip() for (row, _), cell in sheet.cells.items() if row == FIRST_ROW - 1}
    return {"name", "mean"} <= headings


def _columns(sheet: SheetText) -> Iterator[_Column]:
    """Yield the columns with headings; an environment holds for those to its right, up to the next one."""
    environment, seen = "", set()
    for number in range(1, max((column for _, column in sheet.cells), default=0) + 1):
        above, below = _heading(sheet, 1, number), _heading(sheet, 2, number)
        if not below:
            if above or any(sheet.given(row, number) for row in range(FIRST_ROW, sheet.last_row + 1)):
                where = sheet.at(2, number)
                raise InputError(
                    where, "must say what the column holds", cure=f"One of {', '.join(MEASURED)}."
                )
            continue
        column = _column(sheet, number, above, below, environment)
        environment = column.environment
        if (column.what, environment) in seen:
            raise InputError(sheet.at(2, number), "is a second column of that heading", shown(below))
        seen.add((column.what, environment))
        yield column


def _column(sheet: SheetText, number: int, above: str, below: str, environment: str) -> _Column:
    if not environment and (below in OWN or below in PROPERTIES) and not (below == "source" and above):
        return _Column(number, below, unit="" if above == "-" else above)
    if below not in MEASURED:
        known = MEASURED if environment or above else (*OWN, *PROPERTIES, *MEASURED)
        raise InputError(
            sheet.at(2, number), "is no heading of candidates", shown(below), nearest(below, known)
        )
    if not above and not environment:
        cure = 'Write it like "liquid nitrogen, 440C".'
        raise InputError(sheet.at(1, number), f"must name the environment of this {below}", cure=cure)
    return _Column(number, below, above or environment)


def _heading(sheet: SheetText, row: int, column: int) -> str:
    cell = sheet.given(row, column)
    if cell is None:
        return ""
    if not isinstance(cell.value, str):
        raise InputError(sheet.at(row, column), "must be text", shown(cell.value))
    return cell.value.strip()


def _candidate(
    sheet: SheetText, document: Document, row: int, columns: list[_Column], number: int
) -> dict[str, Any]:
    """Return one candidate as a table, and note the cells of its parts."""
    item: dict[str, Any] = {}
    for column in columns:
        cell = sheet.given(row, column.number)
        if cell is None:
            continue
        where = sheet.at(row, column.number)
        path = _path(column)
        _set(item, path, _value(cell, column, where), where)
        document.cells[f"[ranking] candidates[{number}].{_dotted(path)}"] = where
        if column.what == "mean":
            document.cells[f"[ranking] candidates[{number}].{_dotted(path[:-1])}"] = where
    if item and "name" not in item:
        at = next((column.number for column in columns if column.what == "name"), 1)
        rule = f"must name the candidate of row {row}"
        raise InputError(sheet.at(row, at), rule, cure="Name it, or clear the row.")
    return {key: _frictions(part) if key == "friction" else part for key, part in item.items()}


def _frictions(by_environment: dict[str, Any]) -> dict[str, Any]:
    """Return frictions with a mean alone as that: a number, or what is known of an uncertain one."""
    return {name: one["mean"] if set(one) == {"mean"} else one for name, one in by_environment.items()}


def _path(column: _Column) -> tuple[str, ...]:
    if column.environment:
        return ("friction", column.environment, column.what)
    return ("material", column.what) if column.what in PROPERTIES else (column.what,)


def _dotted(path: tuple[str, ...]) -> str:
    """Return a path as refusals spell it."""
    return ".".join((path[0], f'"{path[1][:60]}"', *path[2:]) if path[0] == "friction" else path)


def _set(item: dict[str, Any], path: tuple[str, ...], value: Any, where: str) -> None:
    for key in path[:-1]:
        item = item.setdefault(key, {})
        if not isinstance(item, dict):
            rule = "is a property of a material that is also named"
            raise InputError(where, rule, cure="Give the name of one in the library, or the properties.")
    item[path[-1]] = value


def _value(cell: Cell, column: _Column, where: str) -> Any:
    is_number = column.what in MEASURED and column.what != "source"
    if is_number and isinstance(cell.value, str) and not begins_as_number(cell.value):
        cure = "Leave the cell empty if it was not measured."
        raise InputError(where, "must be a number", shown(cell.value), cure)
    if isinstance(cell.value, float):
        if column.what == "standard_deviation" and cell.format == "percent":
            return f"{number_text(float(f'{100.0 * cell.value:.12g}'))} %"
        return f"{number_text(cell.value)} {column.unit}" if column.unit else plain_number(cell.value)
    if isinstance(cell.value, str) and column.environment and is_list(column.what, cell.value):
        return list_of(cell.value, "")
    return cell.value
