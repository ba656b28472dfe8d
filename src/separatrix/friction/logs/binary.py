"""Workbooks as lines of text, and LabVIEW measurement files (TDMS) as blocks of numbers.

A sheet is read by its used cells, wherever the last one is: row n is line n, with tabs between the columns.
Formulas have the value saved with them; dates and times of day are written as such. TDMS is read by npTDMS,
an extra of this package: a group is a table, its channels are the columns, scaled as the file states. A
waveform has no column of time; its start and increment make one.
"""

from __future__ import annotations

import datetime
import logging
import re
import struct
import warnings
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from separatrix.friction.logs.log_tables import ERROR, PERCENT, UNCOMPUTED, Block
from separatrix.friction.logs.names import header_parts, ranks
from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.sheet import MOST_BYTES, SAVE_AGAIN, refuse_unsafe
from separatrix.ground.units import Array, printable, shown

if TYPE_CHECKING:
    import nptdms

MOST_CELLS = 20_000_000  # of a workbook
MOST_COLUMNS = 1000  # of a sheet: a stray cell beyond them is not of a table
MOST_ROWS = 1_048_576  # that a sheet can have
_LITERAL = re.compile(r'"[^"]*"|\\.')
"""Part of a number format that is shown as it is: a % in it does not make a percentage."""

_BLANKS = str.maketrans("\t\r\n\x01\x02\x03\x04", "       ")
# what openpyxl raises for a workbook that is damaged or makes no sense
_DAMAGED_BOOK = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, SyntaxError, OSError, EOFError),
    *(zipfile.BadZipFile, zlib.error, NotImplementedError, RecursionError, AssertionError),
)


def sheets_as_lines(path: Path, label: str) -> dict[str, list[str]]:
    """Return the lines of each sheet with a number in it, by its name."""
    import openpyxl
    from openpyxl.utils.exceptions import InvalidFileException

    refuse_unsafe(path, label)
    try:
        with warnings.catch_warnings(), path.open("rb") as file:
            warnings.simplefilter("ignore")
            book = openpyxl.load_workbook(file, read_only=True, data_only=True, keep_links=False)
            formulas = openpyxl.load_workbook(file, read_only=True, keep_links=False)
            found = {one.title: _lines(one, formulas[one.title], label) for one in book.worksheets}
    except InputError:
        raise
    except (*_DAMAGED_BOOK, InvalidFileException) as error:
        rule = f"is not a readable workbook: {printable(str(error), 100)}"
        raise InputError(label, rule, cure=SAVE_AGAIN) from None
    found = {title: lines for title, lines in found.items() if any(re.search(r"\d", one) for one in lines)}
    if not found:
        cure = "Put the names of the columns in one row, and the numbers (not as text) below."
        raise InputError(label, "has no sheet with rows of numbers under a row of names", cure=cure)
    return found


def _lines(sheet: Any, formulas: Any, label: str) -> list[str]:
    """Lines of a sheet, of equal length where there is a number in them; empty where no cell is used."""
    rows: dict[int, dict[int, str]] = {}
    empty: set[tuple[int, int]] = set()  # cells that are there, without a value
    count = 0
    for number, cells in _used(sheet):
        rows[number] = {place: text for place, cell in cells if (text := _written(cell))}
        empty |= {(number, place) for place, cell in cells if cell.value is None and cell.data_type == "n"}
        count += len(cells)
        if count > MOST_CELLS:
            raise InputError(label, f"has more than {MOST_CELLS} cells", cure="Save it as CSV.")
    for number, cells in _used(formulas) if empty else ():
        known = [place for place, cell in cells if cell.data_type == "f" and (number, place) in empty]
        rows[number] |= dict.fromkeys(known, UNCOMPUTED)
    table = [used for used in rows.values() if sum(text[0].isdigit() for text in used.values()) > 1]
    width = max((max(used) for used in table), default=0)
    lines = [""] * max((number for number, used in rows.items() if used), default=0)
    for number, used in rows.items():
        has_numbers = any(text[:1] in f"0123456789-.{ERROR}{UNCOMPUTED}" for text in used.values())
        last = max(width, *used) if has_numbers or len(used) > 1 else max(used, default=0)
        if used:
            lines[number - 1] = "\t".join(used.get(i, "") for i in range(1, last + 1))
    return lines


def _used(sheet: Any) -> Iterator[tuple[int, list[tuple[int, Any]]]]:
    """Rows of a sheet with a cell in them: their numbers, and the columns and cells."""
    from openpyxl.cell.read_only import EmptyCell

    sheet.reset_dimensions()  # else each row is filled up to the last column that the sheet declares
    for number, row in enumerate(sheet.iter_rows(), 1):
        if number > MOST_ROWS:
            raise ValueError(f"row {number}")
        cells = [(i, cell) for i, cell in enumerate(row[:MOST_COLUMNS], 1) if not isinstance(cell, EmptyCell)]
        if cells:
            yield number, cells


def _written(cell: Any) -> str:
    """Text of a cell, with a sign where it differs from its value."""
    value = cell.value
    if value is None:
        return ""
    if cell.data_type == "e":
        return f"{ERROR}{value}"
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        is_percentage = "%" in _LITERAL.sub("", cell.number_format)
        return repr(float(value)) + (PERCENT if is_percentage else "")
    if isinstance(value, datetime.timedelta):
        hours, rest = divmod(value.total_seconds(), 3600.0)
        return f"{hours:.0f}:{rest // 60:02.0f}:{rest % 60:09.6f}"
    return str(value).translate(_BLANKS)


MOST_CHANNELS = 1000
MOST_SCALES = 100
LONGEST_PROPERTY = 200
_LEAD_IN = struct.Struct("<4sIIQQ")
_EXPORT = "Export it again, or as text."
# what npTDMS raises for a file that ends early or makes no sense
_DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, OverflowError, RuntimeError),
    *(EOFError, struct.error, MemoryError),
)


def tdms_groups(path: Path) -> list[Block]:
    """Return the tables of a file: one for each group, or for each length of channel in a group."""
    label = printable(path.name)
    try:
        import nptdms
    except ImportError:
        cure = "pip install 'separatrix[tdms]', or export the file as text."
        raise InputError(label, "is a TDMS file, which needs the package npTDMS", cure=cure) from None
    logging.getLogger("nptdms").setLevel(logging.CRITICAL)  # a refusal of ours reports what is wrong
    size = size_of(path, label)
    try:
        with path.open("rb") as file:
            _check_segments(file, size, label)
            with nptdms.TdmsFile.open(file) as content:
                groups = content.groups()
                holders = (content, *groups, *(one for group in groups for one in group.channels()))
                number = max(int(one.properties.get("NI_Number_Of_Scales", 0)) for one in holders)
                if number > MOST_SCALES:  # npTDMS would count up to it
                    rule = f"must have at most {MOST_SCALES} scalings a channel"
                    raise InputError(label, rule, shown(number))
                tables = [table for group in groups for table in _tables(group, content, label, size)]
    except OSError as error:
        raise unreadable(label, error) from None
    except InputError:
        raise
    except _DAMAGED as error:
        raise InputError(label, "is a damaged TDMS file", cure=_EXPORT) from error
    if not tables:
        raise InputError(label, "has no channel of numbers")
    return tables


def _check_segments(file: BinaryIO, size: int, label: str) -> None:
    """Refuse a file whose segments do not follow one another up to its end."""
    at = 0
    while at < size:
        file.seek(at)
        head = file.read(_LEAD_IN.size)
        if not head.startswith(b"TDSm"):
            raise InputError(label, "is a damaged TDMS file", cure=_EXPORT)
        at += _LEAD_IN.size + (_LEAD_IN.unpack(head)[3] if len(head) == _LEAD_IN.size else size)
    if at != size:
        raise InputError(label, "ends within its last segment", cure=_EXPORT)
    file.seek(0)


def _tables(group: nptdms.TdmsGroup, content: nptdms.TdmsFile, label: str, size: int) -> Iterator[Block]:
    """Yield the tables of a group, longest first."""
    lengths: dict[int, list[nptdms.TdmsChannel]] = {}
    for channel in group.channels():
        if len(channel) and channel.dtype is not None and np.dtype(channel.dtype).kind in "fiubM":
            lengths.setdefault(len(channel), []).append(channel)
    pairs = {str(key): str(value) for key, value in {**content.properties, **group.properties}.items()}
    keys = {key: printable(key).replace(":", " ") for key, value in pairs.items() if value.strip()}
    above = [f"{name}: {printable(pairs[key], LONGEST_PROPERTY)}" for key, name in keys.items()]
    for length, channels in sorted(lengths.items(), reverse=True):
        if len(channels) > MOST_CHANNELS or 8 * length * len(channels) > MOST_BYTES or length > size:
            rule = f"must have at most {MOST_CHANNELS} channels in a group, of {MOST_BYTES // 1024**2} MB"
            raise InputError(label, rule, f"{len(channels)} of {length} values in {size} bytes")
        heads = [channel.name.strip() for channel in channels]
        units, columns = map(list, zip(*map(_column, channels), strict=True))
        where = f"{label}, group {printable(group.name)}"
        is_timed = any("time" in ranks(name) for head in heads for name, _ in header_parts(head))
        if not is_timed and (time := _waveform_time(channels, where)) is not None:
            heads, units, columns = ["time of the waveform", *heads], ["s", *units], [time, *columns]
        name = printable(f"{group.name}, {length} rows" if len(lengths) > 1 else group.name)
        lines = range(1, length + 1)
        yield Block(where, name, heads, units, above, lines=lines, word="row", columns=columns)


def _column(channel: nptdms.TdmsChannel) -> tuple[str, Array]:
    """Unit and scaled values of a channel; points in time become seconds since the first one."""
    values = channel[:]
    if values.dtype.kind == "M":
        return "s", np.asarray((values - values[0]) / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    found = (channel.properties.get(name) for name in ("unit_string", "NI_UnitDescription"))
    unit = next((text.strip() for text in found if isinstance(text, str) and text.strip()), "")
    return unit, np.asarray(values, dtype=np.float64)


def _waveform_time(channels: Sequence[nptdms.TdmsChannel], where: str) -> Array | None:
    """Time of each row, from where the waveforms start and their increment; None if they have none."""
    tracks = {
        (float(properties.get("wf_start_offset", 0.0)), float(properties["wf_increment"]))
        for properties in (channel.properties for channel in channels)
        if "wf_increment" in properties and properties.get("wf_xunit_string", "s") in ("s", "", "Seconds")
    }
    if not tracks:
        return None
    if len(tracks) > 1:
        cure = "Export one of them, or log the channels at one rate."
        raise InputError(where, "has waveforms of one length but of different times", cure=cure)
    start, increment = tracks.pop()
    if not (np.isfinite(start) and np.isfinite(increment) and increment > 0.0):
        raise InputError(where, "needs an increment of time above 0 [s]", f"{increment:g}")
    return start + increment * np.arange(len(channels[0]), dtype=np.float64)
