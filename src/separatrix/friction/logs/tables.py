"""Tables of a file: of its text, or of the sheets of a workbook.

A sheet is a text with tabs whose row n is line n: it is read by its used cells, wherever the last one is.
Formulas have the value saved with them, or none; dates and times of day are written as such. Nothing here
knows what a column means: a table begins at the line with the names that a column map needs, and a line that
is not a row of it is refused.
"""

from __future__ import annotations

import codecs
import datetime
import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from separatrix.friction.logs.column_map import SEPARATORS, ColumnMap, TextFormat
from separatrix.friction.logs.names import MISSING, REMARKS, UNIT_WORDS, header_parts, ranks
from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.sheet import SAVE_AGAIN, by_sheet
from separatrix.ground.toml import as_toml
from separatrix.ground.units import printable

LARGEST = 2_000_000_000  # bytes that a log may have
MOST_TABLES = 2000
HEAD = 3000  # lines in which the first table is searched
_NUMBER = re.compile(r"[+-]?(?:[0-9]++[.,]?[0-9]*+|[.,][0-9]++)(?:[eEdD][+-]?[0-9]{1,3})?")
_SEVERAL = re.compile(r"[+-]?[0-9]++(?:[.,][0-9]++){2,}+")
_MOMENT = re.compile(r"[0-9]{1,4}[-/.:][0-9]{1,2}[-/.:][0-9]{1,4}|[0-9]{1,2}:[0-9]{2}")
_CLOCK = re.compile(
    r"(?:\d{1,4}(?P<sign>[-/. ])(?:\d{1,2}|[A-Za-z]{3})(?P=sign)\d{1,4}[\sT,_]\s*)?\d{1,4}:\d{1,2}"
    r"(?::\d{1,2}(?:[.,:]\d+)?)?\s*(?:[AaPp]\.?[Mm]\.?)?\s*(?:Z|[+-]\d{2}:?\d{2})?"
)
_WORD = re.compile(rf"[^\W\d_]|{_MOMENT.pattern}")
_NUMBERED = re.compile(r"\s*(Run|Step)\s*(?:#|No\.?)?\s*(\d+)\s*(?:$|started)", re.IGNORECASE)
SEPARATED = {"\t": "tab", ";": "semicolon", ",": "comma", "|": "bar", " ": "blanks"}

Needed = Sequence[tuple[str, ...]]  # columns that a table must have, each by one of its names
STARTS = frozenset("0123456789+-.")

BOUND = "\x04"  # in place of a separator in quotes
PERCENT = "\x01"
"""Sign in the text of a sheet, behind a fraction that is shown as a percentage."""


@dataclass(slots=True)
class Block:
    """One table: its names, the units below them, its rows, the lines above it."""

    source: str  # name of the file, and of the sheet
    name: str  # of the step or the run; empty where the file does not number it
    heads: list[str]
    below: list[str]  # units, as many as names; empty texts where there are none
    above: list[str]
    rows: list[str] = field(default_factory=list)
    lines: Sequence[int] = field(default_factory=list)  # of the file, from 1
    separator: str = "\t"
    word: str = "line"
    notes: list[str] = field(default_factory=list)

    def at(self, row: int, column: int | None = None) -> str:
        """Place of a row, or of a cell, for a refusal."""
        name = "" if column is None else printable(self.heads[column].strip()) or f"number {column + 1}"
        return f"{self.source}: {self.word} {self.lines[row]}" + (f', column "{name}"' if name else "")


@dataclass(frozen=True, slots=True)
class Part:
    """A text, or the text of a sheet."""

    source: str
    sheet: str
    lines: list[str]
    word: str = "line"


@dataclass(frozen=True, slots=True)
class Content:
    """What a file holds, read once."""

    path: Path
    name: str
    checksum: str
    parts: list[Part]
    words: str  # encoding, or kind of the file

    @property
    def beginning(self) -> str:
        """The first 20 000 characters of each text, by which a layout is recognised."""
        return "\n".join("\n".join(part.lines[:2000])[:20_000] for part in self.parts)


def content_of(path: Path, form: TextFormat) -> Content:
    """Content of a file; its first bytes show what it is."""
    name = printable(path.name or str(path), 150)
    size = size_of(path, name)
    if size > LARGEST:
        cure = "Split it, or log at a lower rate."
        raise InputError(name, "is too large: at most 2 GB", f"{size / 1e9:.1f} GB", cure)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise unreadable(name, error) from None
    if raw.startswith(b"PK\x03\x04"):
        sheets = sheets_as_lines(path, name).items()
        parts = [Part(f"{name}, sheet {printable(sheet)}", sheet, one, "row") for sheet, one in sheets]
        words = "Excel workbook"
    else:
        lines, words = text_lines(raw, name, form.encoding)
        parts = [Part(name, "", lines)]
    return Content(path, name, hashlib.sha256(raw).hexdigest(), parts, words)


# --- workbooks ------------------------------------------------------------------------------------
MOST_CELLS = 20_000_000  # of a workbook
MOST_COLUMNS = 1000  # of a sheet: a stray cell beyond them is not of a table
MOST_ROWS = 1_048_576  # that a sheet can have
_LITERAL = re.compile(r'"[^"]*"|\\.')
"""Part of a number format that is shown as it is: a % in it does not make a percentage."""

_BLANKS = str.maketrans("\t\r\n\x01\x04", "     ")


def sheets_as_lines(path: Path, label: str) -> dict[str, list[str]]:
    """Return the lines of each sheet with a number in it, by its name."""
    found = by_sheet(path, label, lambda sheet: _lines(sheet, label))
    found = {title: lines for title, lines in found.items() if any(re.search(r"\d", one) for one in lines)}
    if not found:
        cure = "Put the names of the columns in one row, and the numbers (not as text) below."
        raise InputError(label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return found


def _lines(sheet: Any, label: str) -> list[str]:
    """Lines of a sheet, of equal length where there is a number in them; empty where no cell is used."""
    from openpyxl.cell.read_only import EmptyCell

    rows: dict[int, dict[int, str]] = {}
    count = 0
    for number, row in enumerate(sheet.iter_rows(), 1):
        cells = [(i, one) for i, one in enumerate(row[:MOST_COLUMNS]) if not isinstance(one, EmptyCell)]
        count += len(cells)
        if number > MOST_ROWS:
            rule = f"has a row beyond {MOST_ROWS}, the last that a sheet can have"
            raise InputError(label, rule, cure=SAVE_AGAIN)
        if count > MOST_CELLS:
            raise InputError(label, f"has more than {MOST_CELLS} cells", cure="Save it as CSV.")
        if used := {i: text for i, one in cells if (text := _written(one))}:
            rows[number] = used
    table = [used for used in rows.values() if sum(text[0].isdigit() for text in used.values()) > 1]
    width = max((max(used) for used in table), default=0)
    lines = [""] * max(rows, default=0)
    for number, used in rows.items():
        has_numbers = any(text[:1] in "0123456789-.#" for text in used.values())
        last = max(width, *used) if has_numbers or len(used) > 1 else max(used)
        lines[number - 1] = "\t".join(used.get(i, "") for i in range(last + 1))
    return lines


def _written(cell: Any) -> str:
    """Text of a cell, with a sign where it differs from its value."""
    value = cell.value
    if value is None:
        return ""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        is_percentage = "%" in _LITERAL.sub("", cell.number_format)
        return repr(float(str(value))) + (PERCENT if is_percentage else "")
    if isinstance(value, datetime.timedelta):
        hours, rest = divmod(value.total_seconds(), 3600.0)
        return f"{hours:.0f}:{rest // 60:02.0f}:{rest % 60:09.6f}"
    return str(value).translate(_BLANKS)


# --- text -----------------------------------------------------------------------------------------
_MARKS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
_OTHERS = {
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook", "Save it as .xlsx or as CSV."),
    b"\x1f\x8b": ("compressed (gzip)", "Unpack it first."),
    b"7z\xbc\xaf": ("compressed (7-Zip)", "Unpack it first."),
    b"%PDF": ("a PDF", "Export the log as text."),
    b"\x89PNG": ("a picture", "Export the log as text."),
    b"\x89HDF": ("an HDF5 file", "Export the log as text."),
    b"MATLAB 5": ("a MATLAB file", "Export the log as text."),
}
_CONTROLS = re.compile("[\x00-\x08\x0b\x0e-\x1f]")


def text_lines(raw: bytes, name: str, encoding: str | None = None) -> tuple[list[str], str]:
    """Lines of a text, and its encoding: by its mark, as UTF-8, else Windows-1252."""
    for magic, (what, cure) in _OTHERS.items() if encoding is None else ():
        if raw.startswith(magic):
            raise InputError(name, f"is {what}, not text", cure=cure)
    mark = next((mark for mark in _MARKS if raw.startswith(mark)), b"")
    body = raw.removeprefix(mark)
    chosen = encoding or (_MARKS[mark] if mark else _encoding_of(body))
    try:
        text = body.decode(chosen)
    except UnicodeError as problem:
        place = getattr(problem, "start", 0)
        line = body.count(b"\n", 0, place) + 1
        cure = 'Add to a column map, below [format]: encoding = "...", for instance "utf-16" or "cp1250".'
        rule = f"cannot be read as {chosen} text"
        raise InputError(f"{name}: line {line}", rule, f"byte {body[place]:#04x}", cure) from None
    text = text.rstrip("\x1a").replace("\u2212", "-").replace("\f", "\n").lstrip("\ufeff")
    if _CONTROLS.search(text):
        cure = "Export the log as text from the tribometer's program, or state its encoding in a column map."
        raise InputError(name, "is not a text file (it has NUL or control characters)", cure=cure)
    if not text[:65536].strip():
        raise InputError(name, "is empty")
    return re.split("\r\n|\r|\n", text), chosen


def _encoding_of(raw: bytes) -> str:
    if b"\0" in raw:
        return "latin-1"  # it is refused for its NUL
    try:
        raw.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def fields_of(line: str, separator: str) -> list[str]:
    """Fields of a line, without quotes and the blanks around them; what is in quotes is not divided."""
    if '"' in line:
        bound = re.sub(r'"[^"]*"', lambda found: found[0].replace(separator, BOUND), line)
        parts = bound.split() if separator == " " else bound.split(separator)
        return [part.replace(BOUND, separator).strip().strip('"').strip() for part in parts]
    return line.split() if separator == " " else [part.strip() for part in line.split(separator)]


def names_of(line: str, separator: str) -> list[list[str]]:
    """The ways to read a line as names: blanks may be in names, and a sign of a remark before them."""
    bare = re.sub(r"^\s*[#%]+\s*", "", line)
    if separator != " ":
        return [fields_of(bare, separator)]
    bound = re.sub(r"\s+(?=[\[(])", "\x00", bare)
    ways = [fields_of(bare, " ")]
    ways += [[part.replace("\x00", " ") for part in fields_of(bound, " ")]]
    return [*ways, [part.strip() for part in re.split(r"\t| {2,}", bare.strip())]]


def is_number(text: str) -> bool:
    """True for a number with a decimal point or comma, or with marks between thousands."""
    text = text.rstrip(PERCENT)
    return _NUMBER.fullmatch(text) is not None or (
        _SEVERAL.fullmatch(text) is not None and _WORD.match(text) is None
    )


def is_clock(text: str) -> bool:
    """True for a time of day or a duration, with or without a date before it."""
    return _CLOCK.fullmatch(text) is not None


def is_row(fields: Sequence[str], missing: Iterable[str] = MISSING, *, blanks: bool = False) -> bool:
    """True for numbers or their absence, with few words or dates beside them.

    Two numbers, or one and a time, and at most twice as many words; between blanks only as many.
    """
    numbers = words = absent = clocks = 0
    for one in fields:
        if one.casefold() in missing:
            absent += 1
        elif is_number(one):
            numbers += 1
        elif is_clock(one):
            clocks += 1
        elif _WORD.match(one):
            words += 1
        else:
            return False
    if numbers + clocks < 2 or not numbers:
        return numbers == 1 and absent > 0 and words == 0
    return words + (clocks if numbers > 1 else 0) <= (1 if blanks else 2) * numbers


def matching(names: Sequence[str], heads: Sequence[str]) -> list[int]:
    """Columns with one of the names: as the whole head, or as what is before its brackets."""
    wanted = {" ".join(name.split()) for name in names}
    bare = [{" ".join(one.split()) for one in (head, header_parts(head)[0][0])} for head in heads]
    return [i for i, found in enumerate(bare) if found & wanted]


def separator_of(lines: Sequence[str], missing: Iterable[str] = MISSING) -> tuple[str, list[str]]:
    """The separator with which most lines are rows, empty for none; others with more than half of them."""
    scores = {}
    for sign in SEPARATED:
        near = (line for line in lines[:HEAD] if sign in line or (sign == " " and "\t" in line))
        scores[sign] = sum(is_row(fields_of(line, sign), missing, blanks=sign == " ") for line in near)
    best = max(scores, key=lambda sign: scores[sign])
    if not scores[best]:
        return "", []
    others = [sign for sign, count in scores.items() if sign != best and 2 * count > scores[best]]
    fields = (one for line in lines[:HEAD] if "," in line for one in fields_of(line, best))
    if "," in others and any("," in one and is_number(one) for one in fields):
        others.remove(",")  # it is in numbers between another separator
    return best, [sign for sign in others if sign != " "]


# --- from lines to tables -------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Heads:
    """Where a table begins: the line of its names, and its first row."""

    line: int | None  # from 0; None for a table without names
    names: list[str]
    below: list[str]
    first: int


def first_table(
    lines: Sequence[str], separator: str, missing: Iterable[str] = MISSING, start: int = 0
) -> Heads | None:
    """Where the first two rows are, one below the other, and which lines above are names and units."""
    near = range(start, min(len(lines), start + HEAD))
    rows = (i for i in near if is_row(fields_of(lines[i], separator), missing, blanks=separator == " "))
    last = -2
    for i in rows:
        two = fields_of(lines[max(last, 0)], separator), fields_of(lines[i], separator)
        if i == last + 1 and len(two[0]) == len(two[1]):
            break
        last = i
    else:
        return None
    above = range(last - 1, max(0, last - 8) - 1, -1)
    ways = {i: names_of(lines[i], separator) for i in above if lines[i].strip(f"{separator} \t")}
    width = len(two[0])
    filled = max(k + 1 for row in two for k, one in enumerate(row) if one)  # rows may end with separators
    fitting: list[tuple[int, list[str]]] = []
    for count in (width, filled):
        each = ((i, [one for one in some if _fits(one, count, missing)]) for i, some in ways.items())
        fitting = fitting or [(i, some[0]) for i, some in each if some]
    if not fitting:
        return Heads(None, [f"column {i + 1}" for i in range(width)], [""] * width, last)
    line, names = fitting[0]
    if len(fitting) > 1 and is_units(names) and not is_units(fitting[1][1]):
        line, heads = fitting[1]
        return Heads(line, heads, (names + [""] * len(heads))[: len(heads)], last)
    return Heads(line, names, [""] * len(names), last)


def _fits(names: Sequence[str], width: int, missing: Iterable[str]) -> bool:
    """Whether a line has a name for each field of a row; a remark behind them does not count."""
    filled = [name for name in names if name.casefold() not in missing]
    same = len(names) == width or (len(names) == width + 1 and _is_remark(names[-1]))
    return same and bool(filled) and (len(filled) > 2 * sum(map(is_number, filled)) or is_units(names))


def _is_remark(name: str) -> bool:
    return not name or name.casefold() in REMARKS


def is_units(row: Sequence[str]) -> bool:
    """True for a row of units: one at least, and nothing that could be a name."""
    bare = [bare_unit(one).casefold() for one in row]
    if all(not one or one[0] in "[(" for one in row):
        return len(bare) > 1
    known = [unit for unit in bare if unit in UNIT_WORDS]
    names = [one for one in bare if one not in UNIT_WORDS and ranks(one)]
    return not names and any(known) and len(known) >= 0.7 * len(bare)


def bare_unit(unit: str) -> str:
    """A unit without the brackets around it."""
    return re.sub(r"^\s*[\[(]\s*(.*?)\s*[\])]\s*$", r"\1", unit).strip()


def blocks_of(content: Content, columns: ColumnMap) -> list[Block]:
    """All tables of a file that have the columns that the map needs."""
    named = set(columns.format.tables) & {part.sheet for part in content.parts} - {""}
    needed = [one.names for one in columns.columns.values() if one.names and not one.optional]
    parts = [part for part in content.parts if not named or part.sheet in named]
    found = [block for part in parts for block in blocks_of_part(part, columns.format, needed)]
    if len(found) > MOST_TABLES:
        raise InputError(content.name, f"has more than {MOST_TABLES} tables", cure="Split the file.")
    return found


def separator_in(part: Part, form: TextFormat) -> tuple[str, list[str]]:
    """The separator that is stated, or that a text shows, with others that it may be; empty for none."""
    if part.sheet or form.separator:
        return ("\t" if part.sheet else SEPARATORS[form.separator or "tab"]), []
    return separator_of(part.lines, MISSING | {one.casefold() for one in form.missing})


def blocks_of_part(part: Part, form: TextFormat, needed: Needed) -> Iterator[Block]:
    """Tables of one text that have the columns needed."""
    separator, _ = separator_in(part, form)
    found = list(heads_in(part, form, needed, separator)) if separator else []
    begin, numbered = 0, dict[str, str]()
    for i, heads in enumerate(found):
        stop = (found[i + 1].line if i + 1 < len(found) else None) or len(part.lines)
        above = part.lines[begin : heads.first if heads.line is None else heads.line]
        if part.word == "row" and not any(one.strip() for one in heads.names):
            continue
        numbered |= {match[1].casefold(): match[2] for line in above if (match := _NUMBERED.match(line))}
        words = [f"{word} {numbered[word]}" for word in ("run", "step") if word in numbered]
        name = ", ".join([*([part.sheet] if part.sheet else []), *words])
        block = Block(part.source, name, heads.names, heads.below, above, [], [], separator, part.word)
        begin = _fill(block, part.lines, heads.first, stop, form, last=stop == len(part.lines))
        if block.rows:
            yield block


def heads_in(part: Part, form: TextFormat, needed: Needed, separator: str) -> Iterator[Heads]:
    """Where tables begin: at the line that the map names, else at each line with the names needed."""
    lines = part.lines
    if form.header_line is not None:
        first = form.header_line + form.units_below
        if first >= len(lines):
            where = f"{part.source}: header_line = {form.header_line}"
            raise InputError(where, "must be a line above the rows", f"a file of {len(lines)} lines")
        names = _names_in(lines, form.header_line - 1, separator, lines[first:]) or [""]
        below = fields_of(lines[first - 1], separator) if form.units_below else []
        yield Heads(form.header_line - 1, names, (below + [""] * len(names))[: len(names)], first)
        return
    if not needed:
        missing = MISSING | {one.casefold() for one in form.missing}
        yield from [found] if (found := first_table(lines, separator, missing)) is not None else []
        return
    words = [tuple(name.split()[0] for name in names) for names in needed]
    for i, line in enumerate(lines):
        if not all(any(word in line for word in some) for some in words):
            continue
        names = _names_in(lines, i, separator, lines[i + 1 : i + 9], needed)
        if names:
            first, below = i + 1, [""] * len(names)
            if form.units_below:
                first = next((k for k in range(i + 1, len(lines)) if lines[k].strip()), i) + 1
                below = (fields_of(lines[first - 1], separator) + below)[: len(names)]
            yield Heads(i, names, below, first)


def _names_in(
    lines: Sequence[str], place: int, separator: str, below: Sequence[str], needed: Needed = ()
) -> list[str]:
    """Names in a line that has those needed, as many as the first line below has fields if it can be."""
    width = next((len(fields_of(line, separator)) for line in below if line.strip()), 0)
    ways = [one for one in names_of(lines[place], separator) if all(matching(names, one) for names in needed)]
    return next((one for one in ways if len(one) == width), ways[0] if ways else [])


def _fill(block: Block, lines: Sequence[str], first: int, stop: int, form: TextFormat, *, last: bool) -> int:
    """Add the rows of a table to it, and return where the lines begin that are not among them."""
    sign, width, numbers = block.separator, 0, list[int]()
    rows, ends, end, is_end = block.rows, form.ends, stop, False
    words = tuple(one for one in form.skip if one[:1] not in STARTS)  # others may begin a row, too
    usual = sign != " " and not any(one[:1] in STARTS for one in ends)
    for i in range(first, stop):
        line = lines[i]
        if width and usual and line[:1] in STARTS and line.count(sign) == width - 1 and '"' not in line:
            rows.append(line)
            numbers.append(i + 1)
            continue
        begin = line.strip()
        if not line.strip(f"{sign} \t") or (words and begin.startswith(words)):
            continue
        fields = fields_of(line, sign)
        while len(fields) > (width or len(block.heads)) and not fields[-1]:
            fields.pop()
        if not rows and not any(block.below) and is_units(fields):
            block.below = (fields + [""] * len(block.heads))[: len(block.heads)]
            continue
        due = (width,) if width else _widths(block.heads, sign)
        has_value = any(is_number(one) or is_clock(one) or one.casefold() in MISSING for one in fields)
        is_end = bool(ends) and begin.startswith(ends)
        if not is_end and len(fields) in due and has_value:
            width = width or len(fields)
            rows.append(line if line.count(sign) == width - 1 and '"' not in line else BOUND.join(fields))
            numbers.append(i + 1)
        elif is_end or not (begin.startswith(form.skip) or (form.header_line is not None and not rows)):
            end = i
            break
    block.lines = numbers
    if rows and not is_end:
        _check_rest(block, lines, end, stop, width, last=last)
    return end if rows else first


def _widths(heads: Sequence[str], separator: str) -> tuple[int, ...]:
    """How many fields a row may have below the names: those, or one less where the last name is a remark."""
    count = len(heads)
    while count > 1 and separator != " " and not heads[count - 1]:
        count -= 1
    bare = range(count, len(heads) + 1)
    return (*bare, count - 1) if _is_remark(heads[count - 1]) else tuple(bare)


def _check_rest(block: Block, lines: Sequence[str], end: int, stop: int, width: int, *, last: bool) -> None:
    """Refuse lines behind the rows that are like rows: the table is broken there, or a row is damaged."""
    sign = block.separator
    rest = (fields_of(lines[i], sign) for i in range(end + 1, stop))
    goes_on = any(len(one) == width and is_row(one, blanks=sign == " ") for one in rest)
    for i in range(end, stop if last and not goes_on else min(end + 1, stop)):
        fields = fields_of(lines[i], sign)
        filled = [one for one in fields if one]
        where, line = f"{block.source}: {block.word} {i + 1}", lines[i].strip()
        if filled and all(map(is_number, filled)):
            rule = f"has {len(fields)} fields where the rows before it have {width}"
            raise InputError(where, rule, f'"{printable(line)}"', "Mend or delete this line.")
        if goes_on:
            begin = as_toml([re.split(r"[\d\t]", line)[0].strip()[:30] or line[:20]])
            cure = f"Delete it, or add below [format] of a column map: skip = {begin}"
            cure += "; or ends, in place of skip, if no row behind it counts."
            raise InputError(where, "breaks the table", f'"{printable(line)}"', cure)


def cells_of(block: Block, places: Sequence[int]) -> list[list[str]]:
    """Texts of some columns."""
    found: list[list[str]] = [[] for _ in places]
    pairs = [(cells.append, place) for cells, place in zip(found, places, strict=True)]
    for row in block.rows:
        sign = BOUND if BOUND in row else block.separator
        fields = fields_of(row, sign) if sign == " " or '"' in row else row.split(sign)
        for append, place in pairs:
            append(fields[place].strip() if place < len(fields) else "")
    return found
