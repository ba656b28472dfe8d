"""Reading raw tribometer logs: any known format, told by what the file holds and not by its name."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from separatrix.errors import InputError
from separatrix.regular_file import size_of, unreadable
from separatrix.tribometer.clock import CLOCK
from separatrix.tribometer.column_map import ColumnMap
from separatrix.tribometer.formats.layout import Layout
from separatrix.tribometer.log import ABSCISSAE, ColumnRead, RawLog, RawTable, Wanted
from separatrix.units import printable, shown

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
    chosen = column_map or _NOTHING
    name = printable(path.name or str(path), 150)
    raw = _content(path, name)
    file = _File(path, name, hashlib.sha256(raw).hexdigest(), chosen, chosen.conditions(path))
    if raw.startswith(b"PK\x03\x04"):
        return _from_workbook(file)
    if raw.startswith(b"TDSm"):
        return _from_tdms(file)
    return _from_text(raw, file)


@dataclass(frozen=True, slots=True)
class _File:
    """A file that is read, and what the user says of it."""

    path: Path
    name: str
    checksum: str
    chosen: ColumnMap
    given: Mapping[str, str | float]
    """Its conditions by the column map."""


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
    unit = ", clock times," if column.unit == CLOCK else unit
    return f"column {shown_header(column)}{unit} ({column.why})"


def _range(log: RawLog, abscissa: str) -> str:
    from separatrix.tribometer.log import MEANINGS
    from separatrix.units import format_quantity

    column = getattr(log, abscissa)
    unit = MEANINGS[abscissa]
    return f"{format_quantity(float(column[0]), unit)} to {format_quantity(float(column[-1]), unit)}"


def _content(path: Path, name: str) -> bytes:
    size = size_of(path, name)
    if size > LARGEST:
        cure = "Split it, or log at a lower rate."
        raise InputError(name, "is too large: at most 2 GB", f"{size / 1e9:.1f} GB", cure)
    try:
        return path.read_bytes()
    except OSError as error:
        raise unreadable(name, error) from None


def _from_workbook(file: _File) -> tuple[RawLog, ...]:
    from separatrix.tribometer import xlsx

    form, wanted = file.chosen.format, _wanted(file)
    tables = xlsx.read_tables(file.path, form, wanted, headless=_by_number(file.chosen))
    return _logs(tables, file, "Excel workbook")


def _from_tdms(file: _File) -> tuple[RawLog, ...]:
    from separatrix.tribometer import tdms

    return _logs(tdms.read_tables(file.path), file, "LabVIEW TDMS")


def _by_number(chosen: ColumnMap) -> bool:
    """True where columns are given by their numbers, so that they need no names."""
    return any(choice.number is not None for choice in chosen.columns.values())


def _from_text(raw: bytes, file: _File) -> tuple[RawLog, ...]:
    from separatrix.tribometer.encoding import text_of
    from separatrix.tribometer.formats import layout_of
    from separatrix.tribometer.steps import joined, named
    from separatrix.tribometer.text import read_tables

    form = file.chosen.format
    text, encoding = text_of(raw, file.name, form.encoding)
    if not text[:65536].strip():
        raise InputError(file.name, "is empty")
    head = text[:20_000].decode(errors="ignore")
    layout = layout_of(head)
    wanted, headless = _wanted(file, layout), _by_number(file.chosen)
    tables, dialect = read_tables(text, file.name, form, layout, wanted, headless=headless)
    tables = named(joined(tables, _abscissae(file, layout)))
    logs = _logs(tables, file, f"{layout.name} ({encoding}, {dialect.words})", layout)
    series = layout.series(head)
    return tuple(replace(log, series=_series(log, series, layout)) for log in logs) if series else logs


def _series(log: RawLog, series: str, layout: Layout) -> str:
    """What the parts of one test share: the words of the head, and settings of the step but for the sign."""
    return " ".join([series, *(log.metadata.get(key, "").lstrip("+-") for key in layout.same)])


def _understood(
    headers: Sequence[str], units: Sequence[str], file: _File, layout: Layout
) -> tuple[dict[str, int], list[int]]:
    """Columns that are used, by their meaning, and others to be read; none of a table that is no log."""
    from separatrix.tribometer.columns import understand
    from separatrix.tribometer.sliding import motion_columns

    constant = "normal_force" in file.given
    try:
        found = understand(headers, units, file.name, file.chosen, layout, constant_force=constant)
    except InputError:
        return {}, []  # `raw_log` says why
    used = {meaning: column.index for meaning, column in found.used.items()}
    twins = [i for places in found.twins.values() for i in places]
    return used, [*twins, *motion_columns(headers, units)]


def _wanted(file: _File, layout: Layout | None = None) -> Wanted:
    """Which columns of a table are to be read; without a layout, that which the headers tell."""
    from separatrix.tribometer.steps import step_column

    def wanted(headers: Sequence[str], units: Sequence[str]) -> list[int]:
        known = layout or _layout_of(headers)
        used, others = _understood(headers, units, file, known)
        return sorted({*used.values(), *others, *step_column(headers, known)}) if used else []

    return wanted


def _layout_of(headers: Sequence[str]) -> Layout:
    """Layout of the instrument whose text was put into a workbook."""
    from separatrix.tribometer.formats import layout_of

    return layout_of("\t".join(headers))


def _abscissae(file: _File, layout: Layout) -> Wanted:
    """Which columns of a table are its time, distance and cycles."""

    def abscissae(headers: Sequence[str], units: Sequence[str]) -> list[int]:
        used, _ = _understood(headers, units, file, layout)
        return [used[meaning] for meaning in ABSCISSAE if meaning in used]

    return abscissae


def _logs(
    tables: Sequence[RawTable], file: _File, format_name: str, layout: Layout | None = None
) -> tuple[RawLog, ...]:
    """The log of each table; where only some are logs, the refusal says how to leave out the others."""
    from separatrix.tribometer.raw import raw_log
    from separatrix.tribometer.steps import split_by_step

    found: list[tuple[str, RawLog]] = []
    wrong: InputError | None = None
    parts = [p for table in tables for p in split_by_step(table, layout or _layout_of(table.headers))]
    for table in _wanted_tables(parts, file.name, file.chosen):
        source = f"{file.name}, {table.name}" if table.name else file.name
        known = layout or _layout_of(table.headers)
        try:
            log = raw_log(table, source, file.checksum, format_name, file.chosen, file.given, known)
            found.append((table.name, log))
        except InputError as error:
            wrong = wrong or error
    if wrong is None:
        return _without_copies([log for _, log in found])
    if not found:
        raise wrong
    names = ", ".join(shown(name) for name, _ in found)
    cure = f"{wrong.cure} Or leave it out, below [format]: tables = [{names}].".strip()
    raise wrong.at(wrong.path, cure=cure)


def _without_copies(logs: Sequence[RawLog]) -> tuple[RawLog, ...]:
    """The logs, but each table once: the same numbers again are no other test."""
    kept: dict[bytes, RawLog] = {}
    for log in logs:
        columns = [log.friction, *(getattr(log, name) for name in log.abscissae)]
        numbers = b"".join(column.tobytes() for column in columns)
        if numbers in kept:
            note = f"{log.source} has the same numbers and is left out"
            log = replace(kept[numbers], notes=(*kept[numbers].notes, note))
        kept[numbers] = log
    return tuple(kept.values())


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
