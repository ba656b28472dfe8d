"""Reading raw tribometer logs: any known format, told by what the file holds and not by its name."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from separatrix.errors import InputError
from separatrix.tribometer.column_map import ColumnMap
from separatrix.tribometer.log import ColumnRead, RawLog, RawTable
from separatrix.units import printable

LARGEST = 2_000_000_000
"""Bytes that a log may have."""

_NOTHING = ColumnMap()


def read_log(path: str | Path, column_map: ColumnMap | None = None) -> tuple[RawLog, ...]:
    """Logs of one file: one for each table, sheet, channel group or step in it.

    Parameters
    ----------
    path : str or Path
        Anton Paar, Rtec, Bruker UMT or Phoenix Compend text, plain CSV or TSV, ``.xlsx`` or ``.tdms``.
    column_map : ColumnMap, optional
        What the file does not say itself, from `read_column_map`.

    Raises
    ------
    InputError
        What cannot be read or decided: file, line, and what to write in a column map. Nothing is guessed.
    """
    path = Path(path)
    name = printable(path.name, 150)
    chosen = column_map or _NOTHING
    raw = _content(path, name)
    checksum = hashlib.sha256(raw).hexdigest()
    if raw.startswith(b"PK\x03\x04"):
        return _from_workbook(path, name, checksum, chosen)
    if raw.startswith(b"TDSm"):
        return _from_tdms(path, name, checksum, chosen)
    return _from_text(raw, name, checksum, chosen)


def described(log: RawLog) -> list[str]:
    """What was read, in lines: columns with their units and reasons, rows, what is missing, conditions."""
    from separatrix.tribometer.raw import shown_conditions

    lines = [f"{log.source}: {log.format}, {log.rows} rows, sha256 {log.checksum[:12]}"]
    used = [column for column in log.columns if column.meaning]
    lines += [f"  {column.meaning}: {_column(column)}" for column in used]
    rest = [column for column in log.columns if not column.meaning and column.header]
    told = [column for column in rest if column.why != "not needed"]
    lines += [f"  not used: {_column(column)}" for column in told]
    if others := [shown_header(column) for column in rest if column.why == "not needed"]:
        lines.append(f"  not used: {', '.join(others)}")
    lines += [f"  {abscissa} from {_range(log, abscissa)}" for abscissa in log.abscissae]
    lines.append(f"  conditions: {shown_conditions(log)}")
    return lines + [f"  note: {note}" for note in log.notes]


def shown_header(column: ColumnRead) -> str:
    """Header of a column as the file writes it, in quotes."""
    return f'"{printable(column.header)}"'


def _column(column: ColumnRead) -> str:
    unit = f" in {column.unit}" if column.unit.strip("- ") else ""
    return f"column {shown_header(column)}{unit} ({column.why})"


def _range(log: RawLog, abscissa: str) -> str:
    from separatrix.tribometer.log import MEANINGS
    from separatrix.units import format_quantity

    column = getattr(log, abscissa)
    unit = MEANINGS[abscissa]
    return f"{format_quantity(float(column[0]), unit)} to {format_quantity(float(column[-1]), unit)}"


def _content(path: Path, name: str) -> bytes:
    try:
        size = path.stat().st_size
        if path.is_dir():
            raise InputError(name, "is a folder", cure="Name the files in it.")
        if size > LARGEST:
            cure = "Split it, or log at a lower rate."
            raise InputError(name, "is too large: at most 2 GB", "", f"{size / 1e9:.1f} GB", cure)
        raw = path.read_bytes()
    except OSError as problem:
        raise InputError(name, "cannot be read", "", problem.strerror or type(problem).__name__) from None
    if not raw[:65536].strip():
        raise InputError(name, "is empty")
    return raw


def _from_workbook(path: Path, name: str, checksum: str, chosen: ColumnMap) -> tuple[RawLog, ...]:
    from separatrix.tribometer import xlsx

    return _logs(xlsx.read_tables(path), name, checksum, "Excel workbook", chosen)


def _from_tdms(path: Path, name: str, checksum: str, chosen: ColumnMap) -> tuple[RawLog, ...]:
    from separatrix.tribometer import tdms

    return _logs(tdms.read_tables(path), name, checksum, "LabVIEW TDMS", chosen)


def _logs(
    tables: Sequence[RawTable], name: str, checksum: str, format_name: str, chosen: ColumnMap
) -> tuple[RawLog, ...]:
    from separatrix.tribometer.raw import raw_log

    wanted = _wanted_tables(tables, name, chosen)
    return tuple(raw_log(table, name, checksum, format_name, chosen) for table in wanted)


def _from_text(raw: bytes, name: str, checksum: str, chosen: ColumnMap) -> tuple[RawLog, ...]:
    from separatrix.tribometer.columns import understand
    from separatrix.tribometer.encoding import text_of
    from separatrix.tribometer.formats import layout_of
    from separatrix.tribometer.raw import raw_log
    from separatrix.tribometer.steps import split_by_step, step_column
    from separatrix.tribometer.text import read_tables

    text, encoding = text_of(raw, name, chosen.format.encoding)
    layout = layout_of(text[:20_000].decode(errors="ignore"))
    constant = "normal_force" in chosen.conditions(name)

    def wanted(headers: tuple[str, ...], units: tuple[str, ...]) -> list[int]:
        found = understand(headers, units, name, chosen, layout, constant_force=constant)
        used = {column.index for column in found.used.values()}
        return sorted(used | step_column(headers, layout))

    headless = any(choice.number is not None for choice in chosen.columns.values())
    tables, dialect = read_tables(text, name, chosen.format, layout, wanted, headless=headless)
    tables = [part for table in tables for part in split_by_step(table, layout)]
    format_name = f"{layout.name} ({encoding}, {dialect.words})"
    return tuple(
        raw_log(table, name, checksum, format_name, chosen, layout)
        for table in _wanted_tables(tables, name, chosen)
    )


def _wanted_tables(tables: Sequence[RawTable], name: str, chosen: ColumnMap) -> list[RawTable]:
    """Those that the column map names, or all; a name that is not there is refused."""
    if not chosen.format.tables:
        return list(tables)
    by_name = {table.name: table for table in tables}
    for wanted in chosen.format.tables:
        if wanted not in by_name:
            there = ", ".join(f'"{printable(table)}"' for table in by_name if table)
            cure = f"It has {there}." if there else "It has one table, without a name."
            raise InputError(name, f'has no table "{printable(wanted)}"', cure=cure)
    return [by_name[wanted] for wanted in chosen.format.tables]
