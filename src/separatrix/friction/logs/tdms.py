"""Tables of numbers in a LabVIEW measurement file, TDMS, which npTDMS, an extra of ours, reads.

A group is a table, its channels are the columns, scaled as the file states. A waveform has no column of time;
it has a start and an increment, from which one is made.
"""

from __future__ import annotations

import logging
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.header import layout_of
from separatrix.friction.logs.log import RawTable
from separatrix.friction.logs.names import header_parts, ranks
from separatrix.input_files import size_of, unreadable
from separatrix.units import Array, printable, shown
from separatrix.workbook_guard import MOST_BYTES

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
"""What npTDMS raises for a file that ends early or makes no sense."""


def read_tables(path: Path) -> list[RawTable]:
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


def _tables(group: Any, content: Any, label: str, size: int) -> Iterator[RawTable]:
    """Yield the tables of a group, longest first."""
    lengths: dict[int, list[Any]] = {}
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


def _column(channel: Any) -> tuple[str, Array]:
    """Unit and scaled values of a channel; points in time become seconds since the first one."""
    values = channel[:]
    if values.dtype.kind == "M":
        return "s", np.asarray((values - values[0]) / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    found = (channel.properties.get(name) for name in ("unit_string", "NI_UnitDescription"))
    unit = next((text.strip() for text in found if isinstance(text, str) and text.strip()), "")
    return unit, np.asarray(values, dtype=np.float64)


def _waveform_time(channels: Sequence[Any], where: str) -> Array | None:
    """Time of each row, from where the waveforms start and their increment; None if they have none."""
    tracks = {
        (float(known.get("wf_start_offset", 0.0)), float(known["wf_increment"]))
        for known in (channel.properties for channel in channels)
        if "wf_increment" in known and known.get("wf_xunit_string", "s") in ("s", "", "Seconds")
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
