"""Tables of numbers in Excel workbooks and in LabVIEW measurement files (TDMS).

A sheet becomes tab separated text, which the reader of text takes from there: row n is line n. Formulas have
the value saved with them; dates and times of day are written as such. TDMS is read by npTDMS, an extra of
this package: a group is a table, its channels are the columns, scaled as the file states. A waveform has no
column of time; its start and increment make one.
"""

from __future__ import annotations

import datetime
import logging
import posixpath
import re
import struct
import zipfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, BinaryIO

import numpy as np

from separatrix.friction.logs.column_map import TextFormat
from separatrix.friction.logs.header import layout_of
from separatrix.friction.logs.log import RawTable
from separatrix.friction.logs.names import header_parts, ranks
from separatrix.ground.errors import InputError
from separatrix.ground.input_files import size_of, unreadable
from separatrix.ground.sheet import MOST_BYTES, SAVE_AGAIN, refuse_unsafe
from separatrix.ground.units import Array, printable, shown

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    import nptdms

MOST_ROWS_ABOVE = 2000  # rows in which the first rows of numbers are searched
_NUMBERS = (float, datetime.datetime, datetime.date, datetime.time, datetime.timedelta)
_FIRST_DAY = datetime.datetime(1900, 1, 1)
_PIECE = 4 * 1024**2
_LITERAL = re.compile(r'"[^"]*"|\\.')
"""Part of a number format that is shown as it is: a % in it does not make a percentage."""

_ATTRIBUTE, _PLACE = re.compile(r'(\w+)="([^"]*)"'), re.compile("([A-Z]{1,3})([0-9]{1,7})")
_PREFIX = re.compile(rb"<(\w+:|)worksheet\b")
_BLANKS = str.maketrans("\t\r\n", "   ")


def sheets_as_text(path: Path, label: str) -> dict[str, bytes]:
    """Return the text of each sheet with a table of numbers, by its name."""
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


@dataclass(frozen=True, slots=True)
class OddCells:
    """Cells of a sheet that differ from their value, by column from 0 and row from 1."""

    percentages: dict[int, list[int]] = field(default_factory=dict)
    """Rows of the cells that are shown as percentages, by column. Their values are fractions."""
    valueless: list[tuple[int, int, str]] = field(default_factory=list)
    """Column, row and error of each error cell; no error for a formula that was never computed."""


def odd_cells(path: Path, sheet: str, label: str) -> OddCells:
    """Return the percentages, the errors and the formulas without a value of a sheet.

    calamine returns neither formats nor errors, and openpyxl takes a minute for a million rows: the XML is
    searched for such cells.
    """
    found = OddCells()
    try:
        with zipfile.ZipFile(path) as archive:
            target, percent = _part_and_percentages(archive, sheet)
            with archive.open(target) as part:
                _search(part, percent, found)
    except (OSError, LookupError, ValueError, SyntaxError) as error:  # SyntaxError: of XML
        raise _unreadable(label, error) from None
    return found


def _part_and_percentages(archive: zipfile.ZipFile, sheet: str) -> tuple[str, set[str]]:
    """Return the part of a sheet, and the numbers of the cell styles that show percentages."""
    from openpyxl.xml.functions import fromstring

    names = {name.casefold(): name for name in archive.namelist()}

    def read(part: str) -> Element:
        return fromstring(archive.read(names[part.casefold()]))

    def related(part: str) -> tuple[dict[str, str], dict[str, str]]:
        """Return the parts that a part names, by their identifiers and by their kinds."""
        folder, _, name = part.rpartition("/")
        by_id, by_kind = {}, {}
        for one in read(f"{folder}/_rels/{name}.rels".lstrip("/")):
            path = posixpath.normpath(posixpath.join("/", folder, one.attrib["Target"]))[1:]
            by_id[one.attrib["Id"]] = by_kind[one.attrib["Type"].rpartition("/")[2]] = path
        return by_id, by_kind

    book = related("")[1]["officeDocument"]
    paths, kinds = related(book)
    sheets = {one.attrib["name"]: one.attrib for one in read(book).iterfind("{*}sheets/{*}sheet")}
    target = names[
        paths[next(value for key, value in sheets[sheet].items() if key.endswith("}id"))].casefold()
    ]
    if "styles" not in kinds:
        return target, set()
    styles = read(kinds["styles"])
    formats = {"9": "0%", "10": "0.00%"}  # those that every workbook has
    for one in styles.iterfind("{*}numFmts/{*}numFmt"):
        formats[one.attrib["numFmtId"]] = one.attrib["formatCode"]
    used = [formats.get(one.get("numFmtId", ""), "") for one in styles.iterfind("{*}cellXfs/{*}xf")]
    return target, {str(i) for i, text in enumerate(used) if "%" in _LITERAL.sub("", text)}


def _search(part: IO[bytes], percent: Collection[str], found: OddCells) -> None:
    """Note the odd cells of a sheet's XML, which is read in pieces that end with a row."""
    from openpyxl.utils import column_index_from_string

    left = part.read(_PIECE)
    prefix = _PREFIX.search(left)
    x = prefix[1].decode() if prefix else ""
    marks = "|".join(['t="e"', *(f's="{style}"' for style in sorted(percent))])
    formula = rf"<{x}f\b(?:[^<>]*/>|[^<>]*>[^<]*</{x}f>)\s*(?:<{x}v\s*(?:/>|></{x}v>)\s*)?</{x}c>"
    cells = re.compile(rf"<{x}c (?:[^<>]*?\b(?:{marks})|[^<>]*>\s*{formula})".encode())
    value = re.compile(rf"<{x}v>([^<]*)<".encode())
    while left:
        end = left.rfind(b"row>") + 4
        for cell in cells.finditer(left, 0, end) if end >= 4 else ():
            close = left.index(b">", cell.start())
            known = dict(_ATTRIBUTE.findall(left[cell.start() : close].decode()))
            place = _PLACE.fullmatch(known.get("r", ""))
            if place is None:
                raise ValueError("its cells do not state where they are")
            column, row = column_index_from_string(place[1]) - 1, int(place[2])
            if known.get("t") == "e":
                error = value.search(left, close)
                found.valueless.append((column, row, error[1].decode() if error else "#"))
            elif known.get("s") in percent:
                found.percentages.setdefault(column, []).append(row)
            elif known.get("t") != "str":  # a formula whose value is an empty text has one
                found.valueless.append((column, row, ""))
        piece = part.read(_PIECE)
        left = left[max(end, 0) :] + piece if piece else b""


def checked(
    table: RawTable, odd: OddCells, where: str, read: Sequence[int], percent: Sequence[int], form: TextFormat
) -> RawTable:
    """Return a table of a sheet, its columns of percent in percent where their cells are fractions.

    `where` names the workbook and the sheet in a refusal, `percent` the columns that are in percent by their
    name or the column map. An error that `form` names means a missing value.
    """
    from openpyxl.utils import get_column_letter

    units, columns, lines = list(table.units), list(table.columns), np.asarray(table.lines)
    inside = set(lines.tolist()) if odd.valueless else set()
    for column, row, error in odd.valueless:
        if column not in read or row not in inside or error.casefold() in form.missing:
            continue
        place = f"{where}, cell {get_column_letter(column + 1)}{row}"
        if not error:
            cure = "Open the workbook in a spreadsheet program and save it."
            raise InputError(place, "holds a formula without a saved value", cure=cure)
        cure = f'If that means a missing value, add below [format] in the column map: missing = ["{error}"].'
        raise InputError(place, "holds an error", error, cure)
    for i in read:
        there = np.isfinite(columns[i])
        shown = np.isin(lines, odd.percentages.get(i, ())) & there
        if not shown.any():
            continue
        if not np.array_equal(shown, there):
            first = shown[there][0]
            row = int(np.flatnonzero(there & (shown != first))[0])
            rule = (
                "is a percentage among plain numbers" if not first else "is a plain number among percentages"
            )
            got = f"{columns[i][row]:g}" if first else f"{100.0 * columns[i][row]:g} %"
            place = f"{where}, cell {get_column_letter(i + 1)}{lines[row]}"
            raise InputError(place, rule, got, "Format all cells of the column alike.")
        if i in percent:
            units[i], columns[i] = "%", columns[i] * 100.0
    return replace(table, units=tuple(units), columns=columns)


def _unreadable(label: str, error: Exception) -> InputError:
    return InputError(label, f"is not a readable workbook: {printable(str(error), 100)}", cure=SAVE_AGAIN)


MOST_CHANNELS = 1000
MOST_SEGMENTS = 1_000_000
MOST_SCALES = 100
LONGEST_PROPERTY = 200
_LEAD_IN = struct.Struct("<4sIIQQ")
_EXPORT = "Export it again, or as text."
# what npTDMS raises for a file that ends early or makes no sense
_DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, OverflowError, RuntimeError),
    *(EOFError, struct.error, MemoryError),
)


def tdms_tables(path: Path) -> list[RawTable]:
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
                for holder in (content, *groups, *(one for group in groups for one in group.channels())):
                    number = holder.properties.get("NI_Number_Of_Scales", 0)
                    if not isinstance(number, int | np.integer) or not 0 <= number <= MOST_SCALES:
                        # what only a damaged file has, before npTDMS counts up to it
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
    at = count = 0
    while at < size:
        file.seek(at)
        head = file.read(_LEAD_IN.size)
        if not head.startswith(b"TDSm"):
            raise InputError(label, "is a damaged TDMS file" if at else "is not a TDMS file")
        length = _LEAD_IN.unpack(head)[3] if len(head) == _LEAD_IN.size else size
        at, count = at + _LEAD_IN.size + length, count + 1
        if count > MOST_SEGMENTS:
            raise InputError(label, f"has more than {MOST_SEGMENTS} segments", cure="Defragment it.")
    if at != size:
        raise InputError(label, "ends within its last segment", cure=_EXPORT)
    file.seek(0)


def _tables(group: nptdms.TdmsGroup, content: nptdms.TdmsFile, label: str, size: int) -> Iterator[RawTable]:
    """Yield the tables of a group, longest first."""
    lengths: dict[int, list[nptdms.TdmsChannel]] = {}
    for channel in group.channels():
        if len(channel) and channel.dtype is not None and np.dtype(channel.dtype).kind in "fiubM":
            lengths.setdefault(len(channel), []).append(channel)
    metadata = {
        printable(str(key)): printable(str(value), LONGEST_PROPERTY)
        for key, value in {**content.properties, **group.properties}.items()
        if str(value).strip()
    }
    for length, channels in sorted(lengths.items(), reverse=True):
        if len(channels) > MOST_CHANNELS:
            raise InputError(label, f"has more than {MOST_CHANNELS} channels in a group", str(len(channels)))
        if length > size:
            raise InputError(label, "declares more values than it can hold", f"{length} in {size} bytes")
        if 8 * length * len(channels) > MOST_BYTES:
            rule = f"would need more than {MOST_BYTES // 1024**2} MB"
            raise InputError(label, rule, cure="Export fewer channels or rows.")
        headers = [channel.name.strip() for channel in channels]
        units, columns = map(list, zip(*map(_column, channels), strict=True))
        if not any("time" in ranks(name) for header in headers for name, _ in header_parts(header)):
            time = _waveform_time(channels, f"{label}, group {printable(group.name)}")
            if time is not None:
                headers, units, columns = ["time of the waveform", *headers], ["s", *units], [time, *columns]
        yield RawTable(
            name=printable(f"{group.name}, {length} rows" if len(lengths) > 1 else group.name),
            headers=tuple(headers),
            units=tuple(units),
            columns=columns,
            metadata=metadata,
            layout=layout_of("\t".join(headers)),
        )


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
