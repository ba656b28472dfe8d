"""One cell of a sheet, and how cells are named."""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell that is not empty.

    `value` is a number, a text or a truth value; None where a formula was saved without a value. `error` is
    what it shows instead (``#REF!``), `formula` its formula, `format` how its number is shown: ``"date"``
    for a date or a time of day, ``"percent"``, or nothing special.
    """

    value: float | str | bool | None
    formula: str = ""
    error: str = ""
    format: str = ""


Row = tuple[int, dict[int, Cell]]
"""Number of a row, from 1, and its cells by the number of their column, from 1."""


def column_name(number: int) -> str:
    """Letters of a column by its number from 1: ``column_name(28) == "AB"``."""
    letters = ""
    while number > 0:
        number, last = divmod(number - 1, 26)
        letters = chr(65 + last) + letters
    return letters


def cell_name(row: int, column: int) -> str:
    """Name of a cell: ``cell_name(5, 3) == "C5"``."""
    return f"{column_name(column)}{row}"


def column_number(letters: str) -> int:
    """Return the number of a column from its letters: ``column_number("AB") == 28``."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - 64
    return number


def decoded(text: str) -> str:
    """Return a text of a workbook with its codes of characters resolved: ``_x000D_`` (ST_Xstring)."""
    return re.sub(r"_x([0-9A-Fa-f]{4})_", lambda code: chr(int(code[1], 16)), text)


def encoded(text: str) -> str:
    """Return a text that `decoded` gives back as it is, also where it looks like such a code."""
    return re.sub(r"_(?=x[0-9A-Fa-f]{4}_)", "_x005F_", text)


def format_kind(code: str) -> str:
    """Return what a number format shows: ``"date"`` (or a time of day), ``"percent"``, or nothing special."""
    plain = re.sub(r'"[^"]*"|\\.|_.|\*.|\[(?![hms]+\])[^\]]*\]', "", code.casefold()).replace("general", "")
    if re.search(r"[dmyhs]", plain):
        return "date"
    return "percent" if "%" in plain else ""
