"""How a text is written, decided by rules: its characters, the separator and decimal sign of its numbers."""

from __future__ import annotations

import codecs
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

QUOTED = "\x1f"  # stands for the comma between fields, where fields in quotes hold commas
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


ENCODINGS = ("utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp1250", "cp932", "gbk")
"""What `[format] encoding` of a column map may be."""

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

    A byte order mark decides; without one, UTF-16 is known by the NUL bytes that its Latin letters have in
    every second place, UTF-8 by being valid, and what is left is Windows-1252 if no byte is undefined in it.

    Raises
    ------
    InputError
        Not a text file, or none of these encodings.
    """
    for magic, (what, cure) in _OTHERS.items() if encoding is None else ():
        if raw.startswith(magic):
            raise InputError(source, f"is {what}, not text", cure=cure)
    mark = next((mark for mark in _MARKS if raw.startswith(mark)), b"")
    body = raw.removeprefix(mark)
    chosen = encoding or (_MARKS[mark] if mark else _by_rule(body, source))
    text = _in_utf8(body, chosen, source).rstrip(_END_OF_FILE)
    if not text.isascii():
        text = text.replace(_MINUS, b"-")
    if text[:65536].translate(None, _CONTROLS) != text[:65536]:
        raise _binary(source)
    returns = text.count(b"\r")
    if returns == text.count(b"\r\n"):
        return (text.translate(None, b"\r") if returns else text), chosen
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n"), chosen


def _by_rule(raw: bytes, source: str) -> str:
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


def _in_utf8(raw: bytes, encoding: str, source: str) -> bytes:
    """Only the lines before the plain ASCII of the rows are recoded, where the encoding allows."""
    if encoding not in _ASCII_BELOW:
        return _recoded(raw, encoding, source)
    cut = raw.find(b"\n", 16384) + 1
    if cut == 0 or not raw[cut:].isascii():
        return _recoded(raw, encoding, source)
    return _recoded(raw[:cut], encoding, source) + raw[cut:]


def _recoded(raw: bytes, encoding: str, source: str) -> bytes:
    try:
        return raw.decode(encoding).encode("utf-8")
    except UnicodeError as problem:
        place = getattr(problem, "start", 0)
        line = raw.count(b"\n", 0, place) + 1
        rule = f"cannot be read as {encoding} text"
        cure = f'Add to the column map, below [format]: encoding = "..." (one of {", ".join(ENCODINGS)}).'
        raise InputError(f"{source}: line {line}", rule, f"byte {raw[place]:#04x}", cure) from None


def _binary(source: str) -> InputError:
    cure = "Export the log as text from the tribometer's program."
    return InputError(source, "is not a text file (it has NUL or control characters)", cure=cure)
