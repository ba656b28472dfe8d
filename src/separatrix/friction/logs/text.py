"""Tables of numbers in a text file: where each stands, its headers and units, and its columns as arrays."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from io import BytesIO

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.clock import CLOCK, SHORT_CLOCKS, is_clock, seconds
from separatrix.friction.logs.column_map import TextFormat
from separatrix.friction.logs.dialect import (
    NO_MOMENTS,
    QUOTED,
    Dialect,
    dialect_of,
    fields,
    is_moment,
    is_number,
)
from separatrix.friction.logs.formats import Layout
from separatrix.friction.logs.header import Header, find_header, header_at
from separatrix.friction.logs.lines import HEAD, Lines, indexed, stretches, unquoted
from separatrix.friction.logs.log import RawTable, Wanted
from separatrix.friction.logs.metadata import metadata_of
from separatrix.friction.logs.names import header_parts
from separatrix.units import Array, printable

_FLOAT = re.compile(
    r"[+-]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE][+-]?[0-9]++)?|[+-]?(?:nan|inf|infinity)", re.IGNORECASE
)
"""What numpy's reader takes for a number."""

_FORTRAN = re.compile(rb"[dD](?<=[0-9.][dD])(?=[+-]?[0-9])")
"""The exponent of a double in Fortran."""

_COMMA = bytes.maketrans(b",.", b".'")
_BACK = str.maketrans(".'", ",.")
"""With decimal commas a point is no part of a number: it becomes a mark that none can have, and back."""


MOST_TABLES = 2000
"""Tables of one file; each keeps some 80 kB."""


@dataclass(slots=True)
class _Found:
    """One table: its header, the lines before it, and the stretches of lines that are its rows."""

    header: Header
    before: list[str]
    separators: int
    rows: list[tuple[int, int]] = field(default_factory=list)

    def count(self) -> int:
        """Rows of the table."""
        return sum(stop - start for start, stop in self.rows)


def read_tables(
    text: bytes, source: str, form: TextFormat, layout: Layout, wanted: Wanted, *, headless: bool = False
) -> tuple[list[RawTable], Dialect]:
    """Every table of a text, and the dialect it is written in.

    Parameters
    ----------
    text : bytes
        UTF-8 with line feeds.
    source : str
        Names the file in a refusal.
    form : TextFormat
        What the column map says of the text.
    layout : Layout
        What is known of the instrument's format.
    wanted : callable
        From headers and units to the numbers of the columns to read; the others are left NaN.
    headless : bool
        The columns are known by their numbers, so that a table may lack headers.

    Raises
    ------
    InputError
        No table, a row of another length, text in a column of numbers: file, line and cure.
    """
    divided = unquoted(text) if form.separator in (None, ",") else None
    lines = indexed(text if divided is None else divided)
    dialect = _dialect(lines, source, form if divided is None else replace(form, separator=QUOTED))
    found = _tables(lines, source, dialect, form, layout, headless)
    tables = [_read(table, lines, source, dialect, layout, wanted) for table in found]
    return tables, dialect


def _dialect(lines: Lines, source: str, form: TextFormat) -> Dialect:
    """Dialect of the head; where that holds no rows yet, of ten times as many lines."""
    if form.begin >= len(lines):
        where, shown = f"{source}: header_line = {form.header_line}", f"a file of {len(lines)} lines"
        raise InputError(where, "must be a line above the rows", shown)
    for most in (HEAD, 10 * HEAD):
        head = [lines[i] for i in range(form.begin, min(len(lines), form.begin + most))]
        try:
            return dialect_of(
                head, source, separator=form.separator, decimal=form.decimal, missing=form.missing
            )
        except InputError:
            if len(lines) <= form.begin + most or most > HEAD:
                raise
    raise InputError(source, "has no table")


def _tables(
    lines: Lines, source: str, dialect: Dialect, form: TextFormat, layout: Layout, headless: bool
) -> list[_Found]:
    found: list[_Found] = []
    before: list[int] = []
    for start, stop, n in stretches(lines, dialect, form.begin, layout.heading):
        if n == -2:
            before += _other_lines(lines, start, stop, layout, bool(found))
        elif found and not before:
            if n != found[-1].separators:
                raise _wrong_row(lines, start, found[-1], source, dialect)
            found[-1].rows.append((start, stop))
        else:
            header = _header(lines, before, n, source, dialect, form, headless and not found)
            if header is None and not found and stop - start < 2:
                before += range(start, stop)
                continue
            if header is None:
                raise _no_header(lines, before, start, n, source, dialect, found)
            found.append(_Found(header, [lines[i] for i in before], n, [(start, stop)]))
            if len(found) > MOST_TABLES:
                raise InputError(source, f"has more than {MOST_TABLES} tables", cure="Split the file.")
            before = []
    _check_end(lines, before, found, source, dialect)
    return _worthwhile(found, source, lines)


def _other_lines(lines: Lines, start: int, stop: int, layout: Layout, inside: bool) -> list[int]:
    """Lines that are neither empty nor known to stand between rows."""
    kept = []
    for i in range(start, stop):
        line = lines[i]
        known = inside and layout.interruption is not None and layout.interruption.match(line)
        if line.strip() and not known:
            kept.append(i)
    return kept


def _header(
    lines: Lines,
    before: list[int],
    n: int,
    source: str,
    dialect: Dialect,
    form: TextFormat,
    headless: bool,
) -> Header | None:
    if form.header_line is not None:
        return header_at(lines.__getitem__, form, n + 1, source, dialect)
    found = find_header([lines[i] for i in before], n + 1, dialect)
    if found is None and headless:
        return Header(tuple(f"column {i + 1}" for i in range(n + 1)), ("",) * (n + 1))
    return found


def _wrong_row(lines: Lines, i: int, table: _Found, source: str, dialect: Dialect) -> InputError:
    got, due = len(dialect.fields(lines[i])), table.separators + 1
    return InputError(
        f"{source}: line {i + 1}",
        f"has {got} fields where the rows before it have {due}",
        f'"{printable(lines[i])}"',
        "Mend or delete this line.",
    )


def _no_header(
    lines: Lines,
    before: list[int],
    start: int,
    n: int,
    source: str,
    dialect: Dialect,
    found: list[_Found],
) -> InputError:
    if found:
        cure = "Delete it, or give the second table a line of column names."
        where = f"{source}: line {before[0] + 1}"
        return InputError(where, "breaks the table", f'"{printable(lines[before[0]])}"', cure)
    above = fields(lines[before[-1]], dialect.separator) if before else []
    if dialect.separator == "," and 2 * len(above) == n + 1:
        rule = f"has {len(above)} names over {n + 1} fields: comma as separator and as decimal sign"
        return InputError(source, rule, cure="Export it with semicolons or tabs between the columns.")
    where = f"{source}: line {start + 1}"
    cure = (
        "Add to the column map, below [format]: header_line = 1, or below [columns]: friction = 2, time = 1."
    )
    rule = f"begins a table of {n + 1} columns without a line of {n + 1} column names above it"
    return InputError(where, rule, cure=cure)


def _check_end(lines: Lines, after: list[int], found: list[_Found], source: str, dialect: Dialect) -> None:
    """A last row that was cut off is not taken for a closing remark."""
    for i in after if found else []:
        row = [part for part in dialect.fields(lines[i]) if part]
        if all(is_number(part) for part in row):
            raise _wrong_row(lines, i, found[-1], source, dialect)


def _worthwhile(found: list[_Found], source: str, lines: Lines) -> list[_Found]:
    """Tables of two rows or more; one row under names is metadata of the next table."""
    if not found:
        raise InputError(source, "has a header but no rows", cure="Give it at least two rows of numbers.")
    if all(table.count() < 2 for table in found):
        line = found[-1].rows[0][0] + 1
        raise InputError(f"{source}: line {line}", "is the only row", cure="A log has at least two.")
    kept: list[_Found] = []
    before: list[str] = []
    for table in found:
        before += table.before
        again = bool(kept) and table.header == kept[-1].header and set(before) <= set(table.header.lines)
        if table.count() < 2 and not again:
            before.append(lines[table.rows[0][0]])
        else:
            table.before, before = before, list(before)
            kept.append(table)
    return kept


def _read(
    table: _Found, lines: Lines, source: str, dialect: Dialect, layout: Layout, wanted: Wanted
) -> RawTable:
    header = _with_clocks(table, lines, dialect)
    needed = list(wanted(header.names, header.units))
    numbers = np.concatenate([np.arange(start, stop) for start, stop in table.rows]) + 1
    pieces = [lines.text[lines.starts[a] : lines.ends[b - 1] + 1] for a, b in table.rows]
    body = pieces[0] if len(pieces) == 1 else b"".join(pieces)
    clocks = [i for i in needed if header.units[i] == CLOCK or header.units[i] in SHORT_CLOCKS]
    plain = [i for i in needed if i not in clocks]

    def where(row: int) -> str:
        return f"{source}: line {numbers[row]}"

    values = _numbers(body, dialect, plain, where, header.names)
    nothing = np.broadcast_to(np.float64(np.nan), (len(numbers),))
    columns: list[Array] = [nothing] * len(header.names)
    for place, column in enumerate(plain):
        columns[column] = values[place]
    for column in clocks:
        columns[column] = _clock(body, column, header, dialect, where)
    return RawTable(
        name=layout.table_name(table.before),
        headers=header.names,
        units=header.units,
        columns=columns,
        metadata=metadata_of(table.before, header.lines, keys_above=layout.keys_above),
        lines=numbers,
        layout=layout,
    )


def _with_clocks(table: _Found, lines: Lines, dialect: Dialect) -> Header:
    """The header, with a unit of its own for columns of times as text; a date alone is none."""
    units = list(table.header.units)
    for i, text in enumerate(dialect.fields(lines[table.rows[0][0]])[: len(units)]):
        written = [units[i].casefold(), *(unit.casefold() for _, unit in header_parts(table.header.names[i]))]
        if is_clock(text) and text.count(":") > 1:
            units[i] = CLOCK
        elif is_clock(text):
            units[i] = next((unit for unit in written if unit in SHORT_CLOCKS), units[i])
    return replace(table.header, units=tuple(units))


def _clock(body: bytes, column: int, header: Header, dialect: Dialect, where: Callable[[int], str]) -> Array:
    """Seconds of a column of times as text."""
    fields_of = [dialect.fields(line)[column] for line in body.decode().removesuffix("\n").split("\n")]
    texts = ["" if text.casefold() in dialect.missing else text for text in fields_of]
    wrong = next((i for i, text in enumerate(texts) if text and not is_clock(text)), None)
    if wrong is not None:
        place = f'{where(wrong)}, column "{printable(header.names[column])}"'
        raise InputError(place, "must be a time", f'"{printable(texts[wrong])}"', NO_MOMENTS)
    return seconds(texts, of_minutes=header.units[column].startswith("m"))


def _numbers(
    body: bytes, dialect: Dialect, needed: list[int], where: Callable[[int], str], names: tuple[str, ...]
) -> Array:
    """Columns of the body as numbers, shape (column, row): at once, or with the missing marked as such."""
    if not needed:
        return np.empty((0, 0))
    if b'"' in body:
        body = body.replace(b'"', b"")
    if dialect.decimal == ",":
        body = body.translate(_COMMA)
    try:
        return _loaded(body, dialect.separator, needed)
    except ValueError:
        if b"D" in body or b"d" in body:
            body = _FORTRAN.sub(b"e", body)
        marked = _with_missing(body, dialect)
    try:
        return _loaded(marked, dialect.separator, needed)
    except ValueError:
        raise _no_number(marked, dialect, needed, where, names) from None


def _loaded(body: bytes, separator: str, needed: list[int]) -> Array:
    """By numpy's own reader; from bytes it is five times as fast as from text."""
    delimiter = None if separator == " " else separator
    loaded: Array = np.loadtxt(
        BytesIO(body), delimiter=delimiter, usecols=needed, comments=None, ndmin=2, encoding="latin1"
    )
    return np.ascontiguousarray(loaded.T)


def _with_missing(body: bytes, dialect: Dialect) -> bytes:
    """The body with ``nan`` for every field that is empty or means that there is no value."""
    words = sorted((word for word in dialect.missing if word and not is_number(word)), key=len, reverse=True)
    words = [word for word in words if "#" not in word or b"#" in body]
    marks = b"|".join(re.escape(word.encode()) for word in words)
    if dialect.separator == " ":
        return re.sub(rb"(?i)(?<!\S)(?:" + marks + rb")(?!\S)", b"nan", body)
    separator = re.escape(dialect.separator.encode())
    if b" " in body:
        body = re.sub(rb" *([" + separator + rb"\n]) *", rb"\1", body)
    quick = b"" if any(word[0].isdigit() for word in words) else rb"(?![0-9.])"
    pattern = rb"(?i)([" + separator + rb"\n])" + quick + rb"(?:" + marks + rb")?(?=[" + separator + rb"\n])"
    return re.sub(pattern, rb"\1nan", b"\n" + body)[1:]


def _no_number(
    body: bytes, dialect: Dialect, needed: list[int], where: Callable[[int], str], names: tuple[str, ...]
) -> InputError:
    """The first field that is no number, found row by row."""
    for row, line in enumerate(body.decode().removesuffix("\n").split("\n")):
        parts = line.split() if dialect.separator == " " else line.split(dialect.separator)
        for column in needed:
            text = parts[column].strip(" ") if column < len(parts) else ""
            if not _FLOAT.fullmatch(text):
                text = text.translate(_BACK) if dialect.decimal == "," else text
                return _not_a_number(where(row), names[column] or f"number {column + 1}", text)
    return InputError(where(0), "begins rows that cannot be read as numbers")


def _not_a_number(line: str, column: str, text: str) -> InputError:
    cure = f"If that means a missing value, add below [format] in the column map: missing = [{_toml(text)}]."
    cure = NO_MOMENTS if is_moment(text) else cure
    where = f'{line}, column "{printable(column)}"'
    return InputError(where, "must be a number", f'"{printable(text)}"', cure)


def _toml(text: str) -> str:
    plain = printable(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{plain}"'
