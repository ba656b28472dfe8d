"""How a text is written, decided by rules: its characters, its separator, its numbers and its times."""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import date

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, printable

_MISSING = (
    "x \u00d7 - -- --- \u2013 \u2014 nan +nan -nan null none n/a na n.a. k.a. #n/a #nv #value! #div/0! #num! "
    "#ref! #name? #wert! inf +inf -inf infinity -infinity 1.#inf -1.#inf 1.#qnan -1.#qnan 1.#ind -1.#ind "
    "nan(ind) -nan(ind)"
)
MISSING = frozenset({"", *_MISSING.split()})  # how files write a missing value, in small letters
SEPARATORS = {"tab": "\t", "\t": "\t", ";": ";", ",": ",", "|": "|", "blanks": " ", " ": " "}
"""What `[format] separator` of a column map may be, and the character meant."""

ENCODINGS = ("utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp1250", "cp932", "gbk")
"""What `[format] encoding` of a column map may be."""

QUOTED = "\x1f"  # replaces the comma between fields, where fields in quotes contain commas
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

    separator: str  # one character; a blank means runs of blanks and tabs
    decimal: str
    missing: frozenset[str] = MISSING

    @property
    def words(self) -> str:
        """For a user: ``"tab, decimal comma"``."""
        return f"{_NAMES[self.separator]}, decimal {_NAMES.get(self.decimal, 'point')}"

    def fields(self, line: str) -> list[str]:
        """The fields of a line, without quotes and the blanks around them."""
        parts = line.split() if self.separator == " " else line.split(self.separator)
        return [part.strip().strip('"').strip() for part in parts]

    def is_data(self, line: str) -> bool:
        """True for a row of the table: numbers or their absence, with few words or dates beside them.

        Two numbers, or one and a time, and at most twice as many words; between blanks only as many.
        """
        numbers = words = absent = clocks = 0
        for field in self.fields(line):
            if field.casefold() in self.missing:
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
        return words + (clocks if numbers > 1 else 0) <= (1 if self.separator == " " else 2) * numbers


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
    if separator is None:
        scores = dict.fromkeys(_NAMES, 0)
        for one in scores:
            dialect = Dialect(separator=one, decimal=".", missing=missing)
            near = (line for line in lines if one in line or (one == " " and "\t" in line))
            scores[one] = sum(map(dialect.is_data, near))
        separator = max(scores, key=lambda one: scores[one])
        if scores[separator] == 0:
            cure = "It needs a line of column names above at least two rows; a column map can state where."
            if any(is_moment(field) for line in lines for field in re.split(r"[\t;,| ]+", line)):
                cure = NO_MOMENTS
            raise InputError(source, "has no table of numbers with two columns or more", cure=cure)
    dialect = Dialect(separator=separator, decimal=decimal or ".", missing=missing)
    if decimal is None and separator != ",":
        rows = [dialect.fields(line) for line in lines if dialect.is_data(line)]
        dialect = replace(dialect, decimal=_decimal(rows, source))
    return dialect


def is_number(field: str) -> bool:
    """True for a number with a decimal point or comma."""
    return _NUMBER.fullmatch(field) is not None


def is_moment(field: str) -> bool:
    """True for a date or a time of day."""
    return _MOMENT.match(field) is not None


def _several_signs(field: str) -> bool:
    """True for ``1.234,5`` and its like; a date is not one."""
    return _SEVERAL.fullmatch(field) is not None and _WORD.match(field) is None


def _decimal(rows: Sequence[Sequence[str]], source: str) -> str:
    tokens = [field for row in rows for field in row if field[-1:].isdigit() and field[:1] not in '"']
    tokens = [field for field in tokens if is_number(field) or _several_signs(field)]
    commas = [field for field in tokens if "," in field]
    points = [field for field in tokens if "." in field]
    if (commas and points) or any(_several_signs(field) for field in tokens):
        shown = " and ".join(f'"{printable(found[0])}"' for found in (commas, points) if found)
        cure = "Export the file without marks between thousands, or write below [format]: decimal = ..."
        raise InputError(source, "has points and commas in its numbers", shown, cure)
    marked = commas or points
    if marked and all(_GROUPED.fullmatch(field) for field in marked):
        rule = "does not show whether its marks are decimal signs or between thousands"
        cure = f'Add to the column map, below [format]: decimal = "{"," if commas else "."}".'
        raise InputError(source, rule, f'"{printable(marked[0])}"', cure)
    return "," if commas else "."


_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
_OTHERS = {
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook", "Save it as .xlsx or as CSV."),
    b"\x1f\x8b": ("compressed (gzip)", "Unpack it first."),
    b"7z\xbc\xaf": ("compressed (7-Zip)", "Unpack it first."),
    b"%PDF": ("a PDF", "Export the log as text."),
    b"\x89PNG": ("a picture", "Export the log as text."),
    b"\x89HDF": ("an HDF5 file", "Export the log as text."),
    b"MATLAB 5": ("a MATLAB file", "Export the log as text."),
}
_ASCII_BELOW = ("utf-8", "cp1252", "latin-1", "cp1250")
_END_OF_FILE = b"\x1a"  # what DOS programs write behind the last line
_MINUS = "\u2212".encode()
_CONTROLS = bytes(c for c in range(32) if c not in b"\t\n\r\f")


def text_of(raw: bytes, source: str, encoding: str | None = None) -> tuple[bytes, str]:
    """The file as UTF-8 with line feeds only, and the encoding it had.

    A byte order mark decides; without one, UTF-16 is detected by the NUL bytes that its Latin letters have in
    every second place, UTF-8 by being valid, and what is left is Windows-1252 if no byte is undefined in it.
    """
    for magic, (what, cure) in _OTHERS.items() if encoding is None else ():
        if raw.startswith(magic):
            raise InputError(source, f"is {what}, not text", cure=cure)
    mark = next((mark for mark in _MARKS if raw.startswith(mark)), b"")
    body = raw.removeprefix(mark)
    chosen = encoding or (_MARKS[mark] if mark else _encoding_of(body, source))
    # only the lines before the plain ASCII of the rows are recoded, where the encoding allows
    cut = body.find(b"\n", 16384) + 1 if chosen in _ASCII_BELOW else 0
    if cut == 0 or not body[cut:].isascii():
        cut = len(body)
    try:
        text = body[:cut].decode(chosen).encode("utf-8") + body[cut:]
    except UnicodeError as problem:
        place = getattr(problem, "start", 0)
        line = body.count(b"\n", 0, place) + 1
        rule = f"cannot be read as {chosen} text"
        cure = f'Add to the column map, below [format]: encoding = "..." (one of {", ".join(ENCODINGS)}).'
        raise InputError(f"{source}: line {line}", rule, f"byte {body[place]:#04x}", cure) from None
    text = text.rstrip(_END_OF_FILE)
    if not text.isascii():
        text = text.replace(_MINUS, b"-")
    if text[:65536].translate(None, _CONTROLS) != text[:65536]:
        raise _binary(source)
    returns = text.count(b"\r")
    if returns == text.count(b"\r\n"):
        return (text.translate(None, b"\r") if returns else text), chosen
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n"), chosen


def _encoding_of(raw: bytes, source: str) -> str:
    if b"\0" not in raw:
        try:
            raw.decode("utf-8")
        except UnicodeDecodeError:
            return "cp1252"
        return "utf-8"
    # UTF-16, little or big endian by the side of the NUL bytes, if they are on one side and in most letters
    head = raw[: min(len(raw), 65536) // 2 * 2]
    low, high = head[0::2].count(0), head[1::2].count(0)
    most = 0.8 * len(head) / 2
    if low == 0 and high > most:
        return "utf-16-le"
    if high == 0 and low > most:
        return "utf-16-be"
    raise _binary(source)


def _binary(source: str) -> InputError:
    cure = "Export the log as text from the tribometer's program."
    return InputError(source, "is not a text file (it has NUL or control characters)", cure=cure)


CLOCK = "clock"  # unit of a column of times as text
SHORT_CLOCKS = ("hh:mm", "h:min", "mm:ss", "min:s", "m:s")  # units of times of two numbers
_DAY = 86_400.0
_MONTHS = "jan feb mar apr may jun jul aug sep oct nov dec"
_DATE = r"(?P<a>\d{1,4})(?P<sign>[-/. ])(?P<b>\d{1,2}|[A-Za-z]{3})[a-z]*(?P=sign)(?P<c>\d{1,4})"
_TIME = r"(?P<h>\d{1,4}):(?P<m>\d{1,2})(?::(?P<s>\d{1,2}(?:[.,:]\d+)?))?\s*(?P<half>[AaPp]\.?[Mm]\.?)?"
_ZONE = r"\s*(?:Z|[+-]\d{2}:?\d{2})?"
_DATE_AND_TIME = re.compile(rf"(?:{_DATE}[\sT,_]\s*)?{_TIME}{_ZONE}")


def is_clock(field: str) -> bool:
    """Return whether a field is a time of day or a duration, with or without a date before it.

    Examples
    --------
    >>> is_clock("19:54:11"), is_clock("2026-02-01T10:00:00.25Z"), is_clock("2026-02-01"), is_clock("3.5")
    (True, True, False, False)
    """
    return _DATE_AND_TIME.fullmatch(field) is not None


def seconds(fields: Sequence[str], *, of_minutes: bool = False) -> Array:
    """Return seconds since the first field, shape (row,); NaN for an empty one.

    Two numbers are hours and minutes, or minutes and seconds. A time of day that falls back by more than half
    a day has passed midnight. Of ambiguous day and month the order with the shortest test is taken.

    Examples
    --------
    >>> seconds(["23:59:58", "23:59:59.5", "00:00:01"]).tolist()
    [0.0, 1.5, 3.0]
    """
    found = [_DATE_AND_TIME.fullmatch(field) for field in fields]
    times = np.array([np.nan if one is None else _time(one, of_minutes=of_minutes) for one in found])
    if any(one is not None and one["a"] for one in found):
        orders = [np.array([_day(one, swap=swap) for one in found]) for swap in (False, True)]
        lengths = [np.inf if np.isinf(days).any() else np.nanmax(days) - np.nanmin(days) for days in orders]
        times += _DAY * orders[int(np.argmin(lengths))]
    else:
        there = np.flatnonzero(np.isfinite(times))
        times[there[1:]] += _DAY * np.cumsum(np.diff(times[there]) < -_DAY / 2.0)
    first = times[np.isfinite(times)][:1]
    return np.round(times - (first if first.size else 0.0), 9)


def _time(found: re.Match[str], *, of_minutes: bool) -> float:
    """Return the time of a field in seconds."""
    first, second, third = int(found["h"]), int(found["m"]), found["s"]
    if third is None and of_minutes:
        return 60.0 * first + second
    if found["half"]:
        first = first % 12 + (12 if found["half"][0] in "pP" else 0)
    rest = 0.0 if third is None else float(re.sub("[,:]", ".", third))
    return 3600.0 * first + 60.0 * second + rest


def _day(found: re.Match[str] | None, *, swap: bool) -> float:
    """Return the number of a day; NaN without a date, infinite where the order does not fit."""
    if found is None or found["a"] is None:
        return float("nan")
    a, b, c = found["a"], found["b"], found["c"]
    year, month, day = (a, b, c) if len(a) == 4 else (c, b, a)
    if swap and month.isdigit():
        month, day = day, month
    number = int(month) if month.isdigit() else _MONTHS.find(month.casefold()) // 4 + 1
    try:
        return float(date(int(year) + (2000 if len(year) <= 2 else 0), number, int(day)).toordinal())
    except ValueError:
        return float("inf")
