"""Tables of numbers in a text: where each begins and ends, its names and units, and its columns as arrays."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from io import BytesIO
from itertools import pairwise

import numpy as np

from separatrix.friction.logs.column_map import TextFormat
from separatrix.friction.logs.dialect import (
    CLOCK,
    MISSING,
    NO_MOMENTS,
    QUOTED,
    SHORT_CLOCKS,
    Dialect,
    dialect_of,
    is_clock,
    is_moment,
    is_number,
    seconds,
)
from separatrix.friction.logs.header import Header, Layout, find_header, header_at, is_names, metadata_of
from separatrix.friction.logs.log import RawTable
from separatrix.friction.logs.names import header_parts
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, printable

Wanted = Callable[[Sequence[str], Sequence[str]], Sequence[int]]
"""From the headers and units of a table to the numbers of the columns to read."""

HEAD = 300  # lines in which the table's separator and decimal sign are searched first
NEAR = 6  # rows below which a line of names makes metadata of them
MOST_TABLES = 2000  # tables of one file; each keeps some 80 kB
_COMMA_IN_QUOTES = re.compile(rb'"[^"\n]*,[^"\n]*"')
_IN_QUOTES = re.compile(rb'(?m)(?:,"[^"\n]*,[^"\n]*"[ ]*(?=,|$)|^"[^"\n]*,[^"\n]*"[ ]*(?=,))')
"""A field in quotes with a comma in it, beside a comma between fields."""

_FLOAT = re.compile(
    r"[+-]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE][+-]?[0-9]++)?|[+-]?(?:nan|inf|infinity)", re.IGNORECASE
)
"""What numpy's reader takes for a number."""

_FORTRAN = re.compile(rb"[dD](?<=[0-9.][dD])(?=[+-]?[0-9])")  # the exponent of a double in Fortran
_COMMA = bytes.maketrans(b",.", b".'")
_BACK = str.maketrans(".'", ",.")
"""With decimal commas a point is not part of a number: it becomes a mark that none can have, and back."""


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
    """Every table of a text (UTF-8 with line feeds), and the dialect it is written in.

    Columns that are not wanted are left NaN. Where the column map has numbers of columns (`headless`), a
    table may lack headers.
    """
    quoted = form.separator in (None, ",") and _COMMA_IN_QUOTES.search(text) and _IN_QUOTES.search(text)
    if quoted:  # a sign of our own for the commas between fields
        sign = QUOTED.encode()
        text = re.sub(rb'"([^"\n]*)"|,', lambda found: sign if found[1] is None else found[1], text)
        form = replace(form, separator=QUOTED)
    file = _Text(text, source, form, layout)
    return [file.table(found, wanted) for found in file.found(headless=headless)], file.dialect


class _Text:
    """A text, its lines and its dialect."""

    def __init__(self, text: bytes, source: str, form: TextFormat, layout: Layout) -> None:
        self.text = text if text.endswith(b"\n") else text + b"\n"
        self.source, self.form, self.layout = source, form, layout
        self.ends = np.flatnonzero(np.frombuffer(self.text, np.uint8) == 10)
        self.starts = np.concatenate([[0], self.ends[:-1] + 1])
        if form.begin >= len(self):
            where = f"{source}: header_line = {form.header_line}"
            raise InputError(where, "must be a line above the rows", f"a file of {len(self)} lines")
        missing = MISSING | form.missing
        for count in (HEAD, 10 * HEAD):  # where the head has no rows yet, of ten times as many lines
            head = [self[i] for i in range(form.begin, min(len(self), form.begin + count))]
            try:
                self.dialect = dialect_of(
                    head, source, separator=form.separator, decimal=form.decimal, missing=missing
                )
                break
            except InputError:
                if len(head) < count or count > HEAD:
                    raise

    def __len__(self) -> int:
        return len(self.starts)

    def __getitem__(self, i: int) -> str:
        return self.text[self.starts[i] : self.ends[i]].decode()

    def found(self, *, headless: bool) -> list[_Found]:
        """The tables of two rows or more; one row under names is metadata of the next table."""
        found: list[_Found] = []
        before: list[int] = []
        for start, stop, n in self._stretches():
            if n < 1:
                known = self.layout.interruption if found else None
                others = [i for i in range(start, stop) if self[i].strip()]
                before += [i for i in others if not (known and known.match(self[i]))]
            elif found and not before:
                if n != found[-1].separators:
                    raise self._wrong_row(start, found[-1])
                found[-1].rows.append((start, stop))
            else:
                header = self._header(before, n, headless=headless and not found)
                if header is None and not found and stop - start < 2:
                    before += range(start, stop)
                    continue
                if header is None:
                    raise self._no_header(before, start, n, found)
                found.append(_Found(header, [self[i] for i in before], n, [(start, stop)]))
                if len(found) > MOST_TABLES:
                    rule = f"has more than {MOST_TABLES} tables"
                    raise InputError(self.source, rule, cure="Split the file.")
                before = []
        for i in before if found else []:  # a last row that was cut off is not a closing remark
            if all(is_number(part) for part in self.dialect.fields(self[i]) if part):
                raise self._wrong_row(i, found[-1])
        return self._worthwhile(found)

    def _worthwhile(self, found: list[_Found]) -> list[_Found]:
        if not found:
            cure = "Give it at least two rows of numbers."
            raise InputError(self.source, "has a header but no rows", cure=cure)
        if all(table.count() < 2 for table in found):
            line = found[-1].rows[0][0] + 1
            raise InputError(f"{self.source}: line {line}", "is the only row", cure="A log has at least two.")
        kept: list[_Found] = []
        before: list[str] = []
        for table in found:
            before += table.before
            again = bool(kept) and table.header == kept[-1].header and set(before) <= set(table.header.lines)
            if table.count() < 2 and not again:
                before.append(self[table.rows[0][0]])
            else:
                table.before, before = before, list(before)
                kept.append(table)
        return kept

    def _stretches(self) -> Iterator[tuple[int, int, int]]:
        """Stretches of lines: (first, last + 1, separators) of rows, and separators 0 for other lines."""
        u, separator, begin = np.frombuffer(self.text, np.uint8), self.dialect.separator, self.form.begin
        if separator == " ":  # words less one
            blank = (u == 32) | (u == 9) | (u == 10)
            signs = ~blank
            signs[1:] &= blank[:-1]
        else:
            signs = u == ord(separator)
        counts = np.diff(np.searchsorted(np.flatnonzero(signs), self.ends), prepend=0) - (separator == " ")
        for found in self.layout.heading.finditer(self.text) if self.layout.heading else ():
            counts[slice(*np.searchsorted(self.starts, found.span()))] = -1
        if begin:
            yield 0, begin, 0
        bounds = [begin, *(np.flatnonzero(np.diff(counts[begin:])) + begin + 1).tolist(), len(self)]
        for start, stop in pairwise(bounds):
            n = int(counts[start])
            if n < 1:
                yield start, stop, 0
                continue
            for at, rows, end in self._blocks(start, stop):
                if at < rows:
                    yield at, rows, 0
                if rows < end:
                    yield rows, end, n

    def _blocks(self, start: int, stop: int) -> Iterator[tuple[int, int, int]]:
        """Lines of as many fields, divided: where a block begins, where its rows begin, and where they end.

        A line of names has as many fields as the rows below it: it may be above the first of them, below a
        row or two of numbers that are metadata, or be repeated among the rows.
        """
        first = self._first_row(start, stop)
        names = [i for i in range(max(start, first - 3), first) if is_names(self[i], self.dialect)]
        cuts = [i for i in range(first + 1, min(stop, first + NEAR)) if is_names(self[i], self.dialect)]
        if names and first < stop:
            same = b"|".join(re.escape(self.text[self.starts[i] : self.ends[i]]) for i in names)
            again = re.compile(b"\n(?:" + same + b")(?=\n)")
            found = again.finditer(self.text, int(self.starts[first]), int(self.ends[stop - 1]) + 1)
            cuts += np.searchsorted(self.starts, [match.start() + 1 for match in found]).tolist()
        for end in sorted({*cuts, stop}):
            yield start, self._first_row(start, end), end
            start = end

    def _first_row(self, start: int, stop: int) -> int:
        """The first row of the table in these lines."""
        near = range(start, min(stop, start + HEAD))
        return next((i for i in near if self.dialect.is_data(self[i])), stop)

    def _header(self, before: list[int], n: int, *, headless: bool) -> Header | None:
        if self.form.header_line is not None:
            return header_at(self.__getitem__, self.form, n + 1, self.source, self.dialect)
        found = find_header([self[i] for i in before], n + 1, self.dialect)
        if found is None and headless:
            return Header(tuple(f"column {i + 1}" for i in range(n + 1)), ("",) * (n + 1))
        return found

    def _wrong_row(self, i: int, table: _Found) -> InputError:
        got, due = len(self.dialect.fields(self[i])), table.separators + 1
        rule = f"has {got} fields where the rows before it have {due}"
        where = f"{self.source}: line {i + 1}"
        return InputError(where, rule, f'"{printable(self[i])}"', "Mend or delete this line.")

    def _no_header(self, before: list[int], start: int, n: int, found: list[_Found]) -> InputError:
        if found:
            cure = "Delete it, or write a line of column names above the second table."
            where = f"{self.source}: line {before[0] + 1}"
            return InputError(where, "breaks the table", f'"{printable(self[before[0]])}"', cure)
        above = self.dialect.fields(self[before[-1]]) if before else []
        if self.dialect.separator == "," and 2 * len(above) == n + 1:
            rule = f"has {len(above)} names over {n + 1} fields: comma as separator and as decimal sign"
            return InputError(
                self.source, rule, cure="Export it with semicolons or tabs between the columns."
            )
        given = "header_line = 1, or below [columns]: friction = 2, time = 1"
        cure = f"Add to the column map, below [format]: {given}."
        rule = f"begins a table of {n + 1} columns without a line of {n + 1} column names above it"
        return InputError(f"{self.source}: line {start + 1}", rule, cure=cure)

    def table(self, found: _Found, wanted: Wanted) -> RawTable:
        """One table with the columns that are wanted."""
        header = self._with_clocks(found)
        needed = list(wanted(header.names, header.units))
        lines = np.concatenate([np.arange(start, stop) for start, stop in found.rows]) + 1
        body = b"".join(self.text[self.starts[a] : self.ends[b - 1] + 1] for a, b in found.rows)
        clocks = [i for i in needed if header.units[i] == CLOCK or header.units[i] in SHORT_CLOCKS]
        plain = [i for i in needed if i not in clocks]
        columns: list[Array] = [np.broadcast_to(np.float64(np.nan), (len(lines),))] * len(header.names)
        for column, values in zip(plain, self._numbers(body, plain, lines, header), strict=True):
            columns[column] = values
        for column in clocks:
            columns[column] = self._clock(body, column, lines, header)
        return RawTable(
            name=self.layout.table_name(found.before),
            headers=header.names,
            units=header.units,
            columns=columns,
            metadata=metadata_of(found.before, header.lines, keys_above=self.layout.keys_above),
            lines=lines,
            layout=self.layout,
        )

    def _with_clocks(self, table: _Found) -> Header:
        """The header, with a unit of its own for columns of times as text; a date alone is not a time."""
        units = list(table.header.units)
        for i, text in enumerate(self.dialect.fields(self[table.rows[0][0]])[: len(units)]):
            if not is_clock(text):
                continue
            parts = [units[i], *(unit for _, unit in header_parts(table.header.names[i]))]
            short = next((unit for part in parts if (unit := part.casefold()) in SHORT_CLOCKS), units[i])
            units[i] = CLOCK if text.count(":") > 1 else short
        return replace(table.header, units=tuple(units))

    def _clock(self, body: bytes, column: int, lines: Array, header: Header) -> Array:
        """Seconds of a column of times as text."""
        texts = [self.dialect.fields(line)[column] for line in body.decode().removesuffix("\n").split("\n")]
        texts = ["" if text.casefold() in self.dialect.missing else text for text in texts]
        wrong = next((i for i, text in enumerate(texts) if text and not is_clock(text)), None)
        if wrong is not None:
            where = f'{self.source}: line {lines[wrong]}, column "{printable(header.names[column])}"'
            raise InputError(where, "must be a time", f'"{printable(texts[wrong])}"', NO_MOMENTS)
        return seconds(texts, of_minutes=header.units[column].startswith("m"))

    def _numbers(self, body: bytes, needed: list[int], lines: Array, header: Header) -> Array:
        """Columns of the body as numbers, shape (column, row): at once, or with the missing marked."""
        if not needed:
            return np.empty((0, 0))
        if b'"' in body:
            body = body.replace(b'"', b"")
        if self.dialect.decimal == ",":
            body = body.translate(_COMMA)
        try:
            return _loaded(body, self.dialect.separator, needed)
        except ValueError:
            if b"D" in body or b"d" in body:
                body = _FORTRAN.sub(b"e", body)
            body = _with_missing(body, self.dialect)
        try:
            return _loaded(body, self.dialect.separator, needed)
        except ValueError:
            raise self._not_a_number(body, needed, lines, header.names) from None

    def _not_a_number(self, body: bytes, needed: list[int], lines: Array, names: Sequence[str]) -> InputError:
        """The first field that is not a number, found row by row."""
        for row, line in enumerate(body.decode().removesuffix("\n").split("\n")):
            parts = line.split() if self.dialect.separator == " " else line.split(self.dialect.separator)
            for column in needed:
                text = parts[column].strip(" ") if column < len(parts) else ""
                if _FLOAT.fullmatch(text):
                    continue
                text = printable(text.translate(_BACK) if self.dialect.decimal == "," else text)
                quoted = text.replace("\\", "\\\\").replace('"', '\\"')
                cure = "If that means a missing value, add below [format] in the column map: "
                cure = NO_MOMENTS if is_moment(text) else f'{cure}missing = ["{quoted}"].'
                name = names[column] or f"number {column + 1}"
                where = f'{self.source}: line {lines[row]}, column "{printable(name)}"'
                return InputError(where, "must be a number", f'"{text}"', cure)
        return InputError(f"{self.source}: line {lines[0]}", "begins rows that cannot be read as numbers")


def _loaded(body: bytes, separator: str, needed: list[int]) -> Array:
    """By numpy's own reader; from bytes it is five times as fast as from text."""
    delimiter = None if separator == " " else separator
    loaded: Array = np.loadtxt(
        BytesIO(body), delimiter=delimiter, usecols=needed, comments=None, ndmin=2, encoding="latin1"
    )
    return np.ascontiguousarray(loaded.T)


def _with_missing(body: bytes, dialect: Dialect) -> bytes:
    """The body with ``nan`` for every field that is empty or means a missing value."""
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
