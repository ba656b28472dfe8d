"""Separator and decimal sign of a table of numbers, from its first rows."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from separatrix.errors import InputError
from separatrix.friction.logs.clock import is_clock
from separatrix.units import printable

MISSING = frozenset(
    {
        "",
        "x",
        "\u00d7",
        "-",
        "--",
        "---",
        "\u2013",
        "\u2014",
        "nan",
        "+nan",
        "-nan",
        "null",
        "none",
        "n/a",
        "na",
    }
    | {"n.a.", "k.a.", "#n/a", "#nv", "#value!", "#div/0!", "#num!", "#ref!", "#name?", "#wert!"}
    | {"inf", "+inf", "-inf", "infinity", "-infinity", "1.#inf", "-1.#inf"}
    | {"1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind", "nan(ind)", "-nan(ind)"}
)
"""How files write a missing value, in small letters."""

SEPARATORS = {"tab": "\t", "\t": "\t", ";": ";", ",": ",", "|": "|", "blanks": " ", " ": " "}
"""What `[format] separator` of a column map may be, and the character meant."""

QUOTED = "\x1f"
"""Stands for the comma between fields, where fields in quotes hold commas."""

_NAMES = {
    "\t": "tab",
    ";": "semicolon",
    QUOTED: "comma between quotes",
    ",": "comma",
    "|": "bar",
    " ": "blanks",
}
_NUMBER = re.compile(r"[+-]?(?:[0-9]++[.,]?[0-9]*+|[.,][0-9]++)(?:[eEdD][+-]?[0-9]{1,3})?")
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:[.,][0-9]{3})+")
_SEVERAL = re.compile(r"[+-]?[0-9]++(?:[.,][0-9]++){2,}+")
_MOMENT = re.compile(r"[0-9]{1,4}[-/.:][0-9]{1,2}[-/.:][0-9]{1,4}|[0-9]{1,2}:[0-9]{2}")
_WORD = re.compile(rf"[^\W\d_]|{_MOMENT.pattern}")

NO_MOMENTS = (
    'Write times like "10:00:01.5" or "2026-02-01 10:00:01" in each row; above times of two numbers, '
    'name the column "Time [mm:ss]" or "Time [hh:mm]".'
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Dialect:
    """How a file writes a row of numbers."""

    separator: str
    """One character; a blank means runs of blanks and tabs."""
    decimal: str
    missing: frozenset[str] = MISSING

    @property
    def words(self) -> str:
        """For a user: ``"tab, decimal comma"``."""
        return f"{_NAMES[self.separator]}, decimal {_NAMES.get(self.decimal, 'point')}"

    def fields(self, line: str) -> list[str]:
        """The fields of a line, without the blanks around them."""
        return fields(line, self.separator)

    def is_data(self, line: str) -> bool:
        """True for a row of the table: numbers or their absence, with few words or dates beside them."""
        return _is_data(self.fields(line), self.missing, self.separator)


def fields(line: str, separator: str) -> list[str]:
    """The fields of a line, without quotes and the blanks around them."""
    parts = line.split() if separator == " " else line.split(separator)
    return [part.strip().strip('"').strip() for part in parts]


def dialect_of(
    lines: Sequence[str],
    source: str,
    *,
    separator: str | None = None,
    decimal: str | None = None,
    missing: frozenset[str] = MISSING,
) -> Dialect:
    """Dialect of the first lines of a file; what is given is kept.

    The separator is the one with which most lines are rows of numbers; of equals, tab before semicolon
    before comma before blanks. The decimal sign is the one found in the numbers; where all of them
    might as well be groups of thousands, the column map must state it.
    """
    chosen = separator or _separator(lines, missing, source)
    rows = [row for row in (fields(line, chosen) for line in lines) if _is_data(row, missing, chosen)]
    if decimal is None:
        decimal = "." if chosen == "," else _decimal(rows, source)
    return Dialect(separator=chosen, decimal=decimal, missing=missing)


def is_number(field: str) -> bool:
    """True for a number with a decimal point or comma."""
    return _NUMBER.fullmatch(field) is not None


def _separator(lines: Sequence[str], missing: frozenset[str], source: str) -> str:
    scores = dict.fromkeys(_NAMES, 0)
    for line in lines:
        for candidate in scores:
            if candidate in line or (candidate == " " and "\t" in line):
                scores[candidate] += _is_data(fields(line, candidate), missing, candidate)
    best = max(scores, key=lambda candidate: scores[candidate])
    if scores[best] == 0:
        cure = "It needs a line of column names above at least two rows; a column map can state where."
        if any(is_moment(field) for line in lines for field in re.split(r"[\t;,| ]+", line)):
            cure = NO_MOMENTS
        raise InputError(source, "has no table of numbers with two columns or more", cure=cure)
    return best


def _is_data(row: Sequence[str], missing: frozenset[str], separator: str) -> bool:
    """Two numbers, or one and a time, and at most twice as many words; between blanks only as many."""
    numbers = words = absent = clocks = 0
    for field in row:
        if field.casefold() in missing:
            absent += 1
        elif is_number(field) or _several_signs(field):
            numbers += 1
        elif is_clock(field):
            clocks += 1
        elif _WORD.match(field):
            words += 1
        else:
            return False
    if numbers + clocks < 2 or not numbers:
        return numbers == 1 and absent > 0 and words == 0
    return words + (clocks if numbers > 1 else 0) <= (1 if separator == " " else 2) * numbers


def is_moment(field: str) -> bool:
    """True for a date or a time of day."""
    return _MOMENT.match(field) is not None


def _several_signs(field: str) -> bool:
    """True for ``1.234,5`` and its like; a date is none."""
    several = _SEVERAL.fullmatch(field) is not None
    return several and _WORD.match(field) is None


def _decimal(rows: Sequence[Sequence[str]], source: str) -> str:
    tokens = [field for row in rows for field in row if field[-1:].isdigit() and field[:1] not in '"']
    tokens = [field for field in tokens if is_number(field) or _several_signs(field)]
    commas = [field for field in tokens if "," in field]
    points = [field for field in tokens if "." in field]
    both = commas and points
    if both or any(_several_signs(field) for field in tokens):
        shown = " and ".join(f'"{printable(found[0])}"' for found in (commas, points) if found)
        cure = "Export the file without marks between thousands, or write below [format]: decimal = ..."
        raise InputError(source, "has points and commas in its numbers", shown, cure)
    marked = commas or points
    if marked and all(_GROUPED.fullmatch(field) for field in marked):
        cure = f'Add to the column map, below [format]: decimal = "{"," if commas else "."}".'
        value = f'"{printable(marked[0])}"'
        raise InputError(
            source, "does not show whether its marks are decimal signs or between thousands", value, cure
        )
    return "," if commas else "."
