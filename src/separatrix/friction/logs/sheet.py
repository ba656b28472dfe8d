"""Sheets of an .xlsx workbook as tab separated text, which the reader of text takes from there.

Row n of the sheet is line n of the text. Formulas have the value saved with them. Dates and times of day are
written as such. An error has no value, like an empty cell.
"""

from __future__ import annotations

import datetime
import warnings
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import RawTable
from separatrix.units import printable
from separatrix.workbook_guard import SAVE_AGAIN, refuse_unsafe

MOST_ROWS_ABOVE = 2000
"""Rows in which the first rows of numbers are looked for."""

_NUMBERS = (float, datetime.datetime, datetime.date, datetime.time, datetime.timedelta)
_FIRST_DAY = datetime.datetime(1900, 1, 1)
_BLANKS = str.maketrans("\t\r\n", "   ")


def sheets_as_text(path: Path, label: str) -> dict[str, bytes]:
    """Return the text of each sheet that holds a table of numbers, by its name.

    Raises
    ------
    InputError
        It is not a workbook that can be read safely, or no sheet has two rows of numbers.
    """
    import python_calamine

    refuse_unsafe(path, label)
    try:
        with python_calamine.CalamineWorkbook.from_path(path) as workbook:
            sheets = {name: workbook.get_sheet_by_name(name) for name in workbook.sheet_names}
            texts = {name: "\n".join(_lines(one.to_python(False))) for name, one in sheets.items()}
    except (python_calamine.CalamineError, OSError, ValueError) as error:
        raise _unreadable(label, error) from None
    found = {name: text.encode() for name, text in texts.items() if text}
    if not found:
        cure = "Put the names of the columns in one row, and the numbers (not as text) below."
        raise InputError(label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return found


def _lines(rows: Sequence[Sequence[object]]) -> Iterator[str]:
    """Yield a line for each row; none for a sheet without two rows of numbers, one below the other.

    From the second such row on, a row of words alone is a remark, which ends where its words do.
    """
    counts = [sum(isinstance(cell, _NUMBERS) for cell in row) for row in rows[:MOST_ROWS_ABOVE]]
    begin = next((i for i in range(1, len(counts)) if counts[i - 1] and counts[i]), None)
    for i, row in enumerate(rows if begin else ()):
        kinds = set(map(type, row))
        if kinds == {float}:
            yield "\t".join(map(repr, row))
            continue
        line = "\t".join(map(_written, row))
        has_numbers = not kinds.isdisjoint(_NUMBERS)
        yield line if has_numbers or (begin and i < begin and line.strip()) else line.rstrip()


def _written(cell: object) -> str:
    if isinstance(cell, str):
        return cell.translate(_BLANKS)
    if isinstance(cell, float):
        return repr(cell)
    return str(_FIRST_DAY + cell if isinstance(cell, datetime.timedelta) else cell)


def with_formats(table: RawTable, path: Path, sheet: str, label: str, read: Collection[int]) -> RawTable:
    """Return a table of a sheet; fractions in cells that are shown as percentages become percent.

    Raises
    ------
    InputError
        In a column that is read, the first row holds a formula that was never computed.
    """
    import openpyxl

    warnings.filterwarnings("ignore", category=UserWarning, module="openpyxl")  # of styles that it lacks
    units, columns = list(table.units), list(table.columns)
    row = 1 if table.lines is None else int(table.lines[0])
    try:
        workbook = openpyxl.load_workbook(path, read_only=True)
        (cells,) = workbook[sheet].iter_rows(row, row, max_col=len(columns))
        workbook.close()
    except (OSError, LookupError, ValueError) as error:
        raise _unreadable(label, error) from None
    for i in read:
        if cells[i].data_type == "f" and np.isnan(columns[i][0]):
            where = f"{label}, sheet {printable(sheet)}, cell {cells[i].coordinate}"
            cure = "Open the workbook in a spreadsheet program and save it."
            raise InputError(where, "holds a formula without a saved value", cure=cure)
        if "%" in (cells[i].number_format or ""):
            units[i], columns[i] = "%", columns[i] * 100.0
    return replace(table, units=tuple(units), columns=columns)


def _unreadable(label: str, error: Exception) -> InputError:
    return InputError(label, f"is not a readable workbook: {printable(str(error), 100)}", cure=SAVE_AGAIN)
