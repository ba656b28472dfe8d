"""Tables of numbers in a LabVIEW measurement file, TDMS.

A group is a table, its channels are the columns, scaled as the file says. A waveform has no column of time;
it has a start and an increment, from which one is made. The reading itself is npTDMS's, an extra of ours.
"""

from __future__ import annotations

import logging
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, BinaryIO

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import RawTable
from separatrix.friction.logs.names import header_parts, ranks
from separatrix.regular_file import size_of, unreadable
from separatrix.units import Array, printable, shown
from separatrix.workbook_guard import MOST_BYTES

MAGIC = b"TDSm"
UNIT_PROPERTIES = ("unit_string", "NI_UnitDescription")
MOST_CHANNELS = 1000
MOST_SEGMENTS = 1_000_000
MOST_SCALES = 100
LONGEST_PROPERTY = 200
_LEAD_IN = struct.Struct("<4sIIQQ")
_EXPORT = "Export it again, or as text."
_DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, OverflowError, RuntimeError),
    *(EOFError, struct.error, MemoryError),
)
"""What npTDMS raises for a file that is cut short or makes no sense."""


def read_tables(path: Path) -> list[RawTable]:
    """Return the tables of a file: one for each group, or for each length of channel in a group.

    Raises
    ------
    InputError
        npTDMS is not installed, the file is damaged, or has no channel of numbers.
    """
    label = printable(path.name)
    tdms = _library(label)
    size = size_of(path, label)
    try:
        with path.open("rb") as file:
            _check_segments(file, size, label)
            with tdms.TdmsFile.open(file) as content:
                _check_scales(content, label)
                groups = content.groups()
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


def _library(label: str) -> ModuleType:
    """Return npTDMS.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        import nptdms
    except ImportError:
        cure = "pip install 'separatrix[tdms]', or export the file as text."
        raise InputError(label, "is a TDMS file, which needs the package npTDMS", cure=cure) from None
    logging.getLogger("nptdms").setLevel(logging.CRITICAL)  # what is wrong is said in our own words
    library: ModuleType = nptdms
    return library


def _check_segments(file: BinaryIO, size: int, label: str) -> None:
    """Refuse a file whose segments do not follow one another up to its end."""
    at, count = 0, 0
    while at < size:
        file.seek(at)
        head = file.read(_LEAD_IN.size)
        if not head.startswith(MAGIC):
            raise InputError(label, "is a damaged TDMS file" if at else "is not a TDMS file")
        length = _LEAD_IN.unpack(head)[3] if len(head) == _LEAD_IN.size else size
        at, count = at + _LEAD_IN.size + length, count + 1
        if count > MOST_SEGMENTS:
            raise InputError(label, f"has more than {MOST_SEGMENTS} segments", cure="Defragment it.")
    if at != size:
        raise InputError(label, "is cut short: its last segment is not whole", cure=_EXPORT)
    file.seek(0)


def _check_scales(content: Any, label: str) -> None:
    """Refuse a number of scalings that only a damaged file has, before anyone counts up to it."""
    groups = content.groups()
    for holder in (content, *groups, *(channel for group in groups for channel in group.channels())):
        number = holder.properties.get("NI_Number_Of_Scales", 0)
        if not isinstance(number, int | np.integer) or not 0 <= number <= MOST_SCALES:
            raise InputError(label, f"must have at most {MOST_SCALES} scalings a channel", shown(number))


def _tables(group: Any, content: Any, label: str, size: int) -> Iterator[RawTable]:
    """Yield the tables of a group, longest first."""
    lengths: dict[int, list[Any]] = {}
    for channel in group.channels():
        if len(channel) and _is_numeric(channel):
            lengths.setdefault(len(channel), []).append(channel)
    several = len(lengths) > 1
    for length, channels in sorted(lengths.items(), reverse=True):
        _check_size(length, channels, label, size)
        name = f"{group.name}, {length} rows" if several else group.name
        where = f"{label}, group {printable(group.name)}"
        yield _table(printable(name), channels, _metadata(content, group), where)


def _is_numeric(channel: Any) -> bool:
    return channel.dtype is not None and np.dtype(channel.dtype).kind in "fiubM"


def _is_moment(channel: Any) -> bool:
    return channel.dtype is not None and np.dtype(channel.dtype).kind == "M"


def _check_size(length: int, channels: list[Any], label: str, size: int) -> None:
    """Refuse channels that declare more values than the file has bytes, before any is read."""
    if len(channels) > MOST_CHANNELS:
        raise InputError(label, f"has more than {MOST_CHANNELS} channels in a group", str(len(channels)))
    if length > size:
        raise InputError(label, "declares more values than it can hold", f"{length} in {size} bytes")
    if 8 * length * len(channels) > MOST_BYTES:
        rule = f"would need more than {MOST_BYTES // 1024**2} MB"
        raise InputError(label, rule, cure="Export fewer channels or rows.")


def _table(name: str, channels: list[Any], metadata: dict[str, str], where: str) -> RawTable:
    headers = [channel.name.strip() for channel in channels]
    units = ["s" if _is_moment(channel) else _unit(channel) for channel in channels]
    columns = [_numbers(channel) for channel in channels]
    if not any(_may_be_time(header) for header in headers):
        time = _waveform_time(channels, where)
        if time is not None:
            headers, units, columns = ["time of the waveform", *headers], ["s", *units], [time, *columns]
    return RawTable(name=name, headers=tuple(headers), units=tuple(units), columns=columns, metadata=metadata)


def _may_be_time(header: str) -> bool:
    """True for the name of a channel of time; an increment of 1 that nobody set then says nothing."""
    return any("time" in ranks(name) for name, _ in header_parts(header))


def _numbers(channel: Any) -> Array:
    """Scaled values of a channel; points in time become seconds since the first one."""
    values = channel[:]
    if values.dtype.kind == "M":
        return np.asarray((values - values[0]) / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    return np.asarray(values, dtype=np.float64)


def _unit(channel: Any) -> str:
    found = (channel.properties.get(name) for name in UNIT_PROPERTIES)
    return next((text.strip() for text in found if isinstance(text, str) and text.strip()), "")


def _waveform_time(channels: list[Any], where: str) -> Array | None:
    """Time of each row, from where the waveforms start and their increment; None if they have none."""
    tracks = {track for channel in channels if (track := _track(channel.properties)) is not None}
    if not tracks:
        return None
    if len(tracks) > 1:
        cure = "Export one of them, or give the channels one rate."
        raise InputError(where, "has waveforms of one length but of different times", cure=cure)
    start, increment = tracks.pop()
    if not (np.isfinite(start) and np.isfinite(increment) and increment > 0.0):
        raise InputError(where, "needs an increment of time above 0 [s]", f"{increment:g}")
    return start + increment * np.arange(len(channels[0]), dtype=np.float64)


def _track(properties: Mapping[str, Any]) -> tuple[float, float] | None:
    """Start and increment of a waveform over time."""
    if "wf_increment" not in properties or properties.get("wf_xunit_string", "s") not in ("s", "", "Seconds"):
        return None
    return float(properties.get("wf_start_offset", 0.0)), float(properties["wf_increment"])


def _metadata(content: Any, group: Any) -> dict[str, str]:
    """Properties of the file and of the group as text; the group's win."""
    found = {**content.properties, **group.properties}
    return {
        printable(str(key)): printable(str(value), LONGEST_PROPERTY)
        for key, value in found.items()
        if str(value).strip()
    }
