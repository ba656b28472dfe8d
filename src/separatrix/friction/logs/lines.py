"""A text as lines: where each begins and ends, and in which of them the rows of tables stand."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from separatrix.friction.logs.dialect import QUOTED, Dialect
from separatrix.friction.logs.header import is_names

HEAD = 300
"""Lines in which the table's separator and decimal sign are looked for first."""

NEAR = 6
"""Rows below which a line of names makes metadata of them."""

_COMMA_IN_QUOTES = re.compile(rb'"[^"\n]*,[^"\n]*"')
_IN_QUOTES = re.compile(rb'(?m)(?:,"[^"\n]*,[^"\n]*"[ ]*(?=,|$)|^"[^"\n]*,[^"\n]*"[ ]*(?=,))')
"""A field in quotes that holds a comma, beside a comma between fields."""


@dataclass(slots=True)
class Lines:
    """A text and where its lines are."""

    text: bytes
    starts: np.ndarray[tuple[int], np.dtype[np.int64]]
    ends: np.ndarray[tuple[int], np.dtype[np.int64]]

    def __len__(self) -> int:
        return len(self.starts)

    def __getitem__(self, i: int) -> str:
        return self.text[self.starts[i] : self.ends[i]].decode()


def unquoted(text: bytes) -> bytes | None:
    """The text with a sign of our own for the commas between fields; None if no quotes hold commas."""
    if not _COMMA_IN_QUOTES.search(text) or not _IN_QUOTES.search(text):  # the first is quick
        return None
    sign = QUOTED.encode()
    return re.sub(rb'"([^"\n]*)"|,', lambda field: sign if field[1] is None else field[1], text)


def indexed(text: bytes) -> Lines:
    """The lines of a text with line feeds."""
    text = text if text.endswith(b"\n") else text + b"\n"
    ends = np.flatnonzero(np.frombuffer(text, np.uint8) == 10)
    starts = np.concatenate([[0], ends[:-1] + 1])
    return Lines(text, starts, ends)


def _separators(lines: Lines, separator: str) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """How many separators each line has; with blanks, words less one."""
    u = np.frombuffer(lines.text, np.uint8)
    if separator == " ":
        blank = (u == 32) | (u == 9) | (u == 10)
        begins = ~blank
        begins[1:] &= blank[:-1]
        return np.diff(np.searchsorted(np.flatnonzero(begins), lines.ends), prepend=0) - 1
    return np.diff(np.searchsorted(np.flatnonzero(u == ord(separator)), lines.ends), prepend=0)


def stretches(
    lines: Lines, dialect: Dialect, begin: int, heading: re.Pattern[bytes] | None = None
) -> Iterator[tuple[int, int, int]]:
    """Stretches of lines: (first, last + 1, separators) of rows, and separators -2 for other lines."""
    counts = _separators(lines, dialect.separator)
    for found in heading.finditer(lines.text) if heading else ():
        counts[slice(*np.searchsorted(lines.starts, found.span()))] = -1
    bounds = [begin, *(np.flatnonzero(np.diff(counts[begin:])) + begin + 1).tolist(), len(lines)]
    if begin:
        yield 0, begin, -2
    for start, stop in pairwise(bounds):
        n = int(counts[start])
        if n < 1:
            yield start, stop, -2
            continue
        for at, rows, end in _blocks(lines, start, stop, dialect):
            if at < rows:
                yield at, rows, -2
            if rows < end:
                yield rows, end, n


def _blocks(lines: Lines, start: int, stop: int, dialect: Dialect) -> Iterator[tuple[int, int, int]]:
    """Lines of as many fields, divided: where a block begins, where its rows begin, and where they end.

    A line of names has as many fields as the rows below it: it may stand above the first of them, below a
    row or two of numbers that are metadata, or be repeated among the rows.
    """
    first = _first_row(lines, start, stop, dialect)
    names = [i for i in range(max(start, first - 3), first) if is_names(lines[i], dialect)]
    cuts = [i for i in range(first + 1, min(stop, first + NEAR)) if is_names(lines[i], dialect)]
    for end in sorted({*cuts, *_again(lines, names, first, stop), stop}):
        yield start, _first_row(lines, start, end, dialect), end
        start = end


def _first_row(lines: Lines, start: int, stop: int, dialect: Dialect) -> int:
    """The first row of the table in these lines."""
    return next((i for i in range(start, min(stop, start + HEAD)) if dialect.is_data(lines[i])), stop)


def _again(lines: Lines, names: list[int], first: int, stop: int) -> list[int]:
    """Where lines of names are repeated among the rows below them."""
    if not names or first >= stop:
        return []
    same = b"|".join(re.escape(lines.text[lines.starts[i] : lines.ends[i]]) for i in names)
    pattern = re.compile(b"\n(?:" + same + b")(?=\n)")
    found = pattern.finditer(lines.text, int(lines.starts[first]), int(lines.ends[stop - 1]) + 1)
    return [int(i) for i in np.searchsorted(lines.starts, [match.start() + 1 for match in found])]
