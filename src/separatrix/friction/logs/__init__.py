"""Reading tribometer logs: the format is detected from its content, not from its name."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from separatrix.friction.logs.column_map import ColumnMap, column_map, read_column_map
from separatrix.friction.logs.columns import Understood, understand
from separatrix.friction.logs.dialect import CLOCK, text_of
from separatrix.friction.logs.header import Layout, layout_of
from separatrix.friction.logs.log import ColumnRead, RawLog, RawTable
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS
from separatrix.friction.logs.raw import raw_log
from separatrix.friction.logs.sliding import motion_columns
from separatrix.ground.errors import InputError
from separatrix.ground.input_files import size_of, unreadable
from separatrix.ground.units import format_quantity, printable, shown, unit_of

__all__ = ["column_map", "described", "read_column_map", "read_log"]
LARGEST = 2_000_000_000  # bytes that a log may have


def read_log(path: str | Path, column_map: ColumnMap | None = None) -> tuple[RawLog, ...]:
    """Logs of one file: one for each table, sheet, channel group or step in it.

    Parameters
    ----------
    path : str or Path
        Anton Paar, Rtec, Bruker UMT, PCS, LabVIEW or Phoenix Compend text, plain CSV or TSV, ``.xlsx`` or
        ``.tdms``.
    column_map : ColumnMap, optional
        What the file does not state itself, from `read_column_map`.

    Raises
    ------
    InputError
        What cannot be read or decided: file, line, and what to write in a column map. Nothing is guessed.
    """
    path = Path(path)
    name = printable(path.name or str(path), 150)
    size = size_of(path, name)
    if size > LARGEST:
        cure = "Split it, or log at a lower rate."
        raise InputError(name, "is too large: at most 2 GB", f"{size / 1e9:.1f} GB", cure)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise unreadable(name, error) from None
    chosen = column_map or ColumnMap()
    file = _File(path, name, hashlib.sha256(raw).hexdigest(), chosen, chosen.conditions(path))
    if raw.startswith(b"PK\x03\x04"):
        return _logs(_tables_of_workbook(file), file, "Excel workbook")
    if raw.startswith(b"TDSm"):
        from separatrix.friction.logs.binary import tdms_tables

        return _logs(tdms_tables(path), file, "LabVIEW TDMS")
    text, encoding = text_of(raw, name, chosen.format.encoding)
    if not text[:65536].strip():
        raise InputError(name, "is empty")
    tables, words = _tables_of_text(text, file)
    layout = tables[0].layout
    logs = _logs(tables, file, f"{layout.name} ({encoding}, {words})")
    series = layout.series(_head(text))
    if not series:
        return logs
    # parts of one test share the words of the head, and settings of the step but for the sign
    same = [" ".join([series, *(log.metadata.get(k, "").lstrip("+-") for k in layout.same)]) for log in logs]
    return tuple(replace(log, series=one) for log, one in zip(logs, same, strict=True))


@dataclass(frozen=True, slots=True)
class _File:
    """A file that is read, and what the user states about it."""

    path: Path
    name: str
    checksum: str
    chosen: ColumnMap
    given: Mapping[str, str | float]  # its conditions by the column map

    def understood(self, headers: Sequence[str], units: Sequence[str], layout: Layout) -> Understood | None:
        """What the columns mean; None for a table that is not a log, which `raw_log` refuses."""
        radius = self.given.get("track_radius")
        try:
            return understand(
                *(headers, units, self.name, self.chosen, layout),
                constant_force="normal_force" in self.given,
                track_radius=radius if isinstance(radius, float) else None,
            )
        except InputError:
            return None

    def wanted(self, headers: Sequence[str], units: Sequence[str], layout: Layout) -> list[int]:
        """Numbers of the columns of a table that are to be read."""
        found = self.understood(headers, units, layout)
        if found is None:
            return []
        used = {column.index for column in found.used.values()}
        twins = {i for places in found.twins.values() for i in places}
        return sorted({*used, *twins, *motion_columns(headers, units), *_step_column(headers, layout)})


def _head(text: bytes) -> str:
    return text[:20_000].decode(errors="ignore")


def _tables_of_text(text: bytes, file: _File, sheet: str = "") -> tuple[list[RawTable], str]:
    """Tables of a text, those of one test as one, and the words for how it is written."""
    from separatrix.friction.logs.text import read_tables

    layout, form = layout_of(_head(text)), file.chosen.format
    source = f"{file.name}, sheet {printable(sheet)}" if sheet else file.name
    if sheet:
        form = replace(form, separator="\t", decimal=".")
    headless = any(choice.number is not None for choice in file.chosen.columns.values())
    tables, dialect = read_tables(
        text, source, form, layout, lambda h, u: file.wanted(h, u, layout), headless=headless
    )
    tests: list[list[RawTable]] = []
    for table in tables:
        if tests and _goes_on(tests[-1][-1], table, file):
            tests[-1].append(table)
        else:
            tests.append([table])
    found = []
    for parts in tests:
        if len(parts) > 1:
            columns = [np.concatenate(same) for same in zip(*(part.columns for part in parts), strict=True)]
            lines = np.concatenate([np.asarray(part.lines) for part in parts])
            parts[0] = replace(parts[0], columns=columns, lines=lines)
        found.append(parts[0])
    if len({table.name for table in found}) < len(found):
        found = [replace(table, name=f"table {i}") for i, table in enumerate(found, 1)]
    return found, dialect.words


def _goes_on(before: RawTable, table: RawTable, file: _File) -> bool:
    """Whether a table under repeated headers goes on where the one before it ends: one test."""
    if (before.headers, before.units) != (table.headers, table.units) or table.metadata or table.name:
        return False
    found = file.understood(table.headers, table.units, table.layout)
    columns = [found.used[name].index for name in ABSCISSAE if name in found.used] if found else []
    return bool(columns) and all(table.columns[i][0] >= before.columns[i][-1] for i in columns)


def _tables_of_workbook(file: _File) -> list[RawTable]:
    """Tables of all sheets, or of those that the column map names."""
    from separatrix.friction.logs.binary import checked, odd_cells, sheets_as_text

    texts, form = sheets_as_text(file.path, file.name), file.chosen.format
    given = "".join(choice.unit or "" for choice in file.chosen.columns.values())
    found = []
    for sheet, text in texts.items():
        if form.tables and set(form.tables) <= texts.keys() and sheet not in form.tables:
            continue
        try:
            tables, _ = _tables_of_text(text, file, sheet)
        except InputError as error:
            raise error.at(error.path.replace(": line ", ": row ", 1)) from None
        odd = None
        for table in tables:
            if read := file.wanted(table.headers, table.units, table.layout):
                odd = odd or odd_cells(file.path, sheet, file.name)
                percent = [i for i in read if "%" in f"{given}{table.headers[i]}{table.units[i]}"]
                where = f"{file.name}, sheet {printable(sheet)}"
                table = checked(table, odd, where, read, percent, form)
            found.append(replace(table, name=f"{sheet}, {table.name}" if table.name else sheet))
    return found


def _step_column(headers: Sequence[str], layout: Layout) -> list[int]:
    """Number of the column whose change begins a new test; none where the format has no such column."""
    names = [header.strip().casefold() for header in headers]
    return [names.index(name.casefold()) for name in layout.split_by if name.casefold() in names][:1]


def _by_step(table: RawTable) -> Iterator[RawTable]:
    """The table, or one for each step in it; a step of a single row is left out, for it is not a log."""
    found = _step_column(table.headers, table.layout)
    steps = table.columns[found[0]] if found else np.zeros(1)
    bounds = [0, *(np.flatnonzero(np.diff(steps) != 0.0) + 1).tolist(), len(steps)]
    pieces = [slice(a, b) for a, b in pairwise(bounds) if b - a >= 2]
    if len(bounds) == 2 or not pieces:
        yield table
        return
    names: list[str] = []
    for piece in pieces:
        names.append(f"step {steps[piece.start]:g}")
        again = names.count(names[-1])
        name = names[-1] if again == 1 else f"{names[-1]}, again {again}"
        yield replace(
            table,
            name=f"{table.name}, {name}" if table.name else name,
            columns=[column[piece] for column in table.columns],
            lines=table.lines[piece] if table.lines is not None else None,
        )


def _logs(tables: Sequence[RawTable], file: _File, format_name: str) -> tuple[RawLog, ...]:
    """The log of each table that the column map names, or of all; the same numbers again are not a test.

    Where only some are logs, the refusal states how to leave out the others.
    """
    parts = [part for whole in tables for part in _by_step(whole)]
    by_name = {part.name: part for part in parts}
    for name in file.chosen.format.tables:
        if name not in by_name:
            there = ", ".join(f'"{printable(table)}"' for table in by_name if table)
            cure = f"It has {there}." if there else "It has one table, without a name."
            raise InputError(file.name, f'has no table "{printable(name)}"', cure=cure)
    found: list[tuple[str, RawLog]] = []
    wrong: InputError | None = None
    for part in [by_name[name] for name in file.chosen.format.tables] or parts:
        source = f"{file.name}, {part.name}" if part.name else file.name
        try:
            log = raw_log(part, source, file.checksum, format_name, file.chosen, file.given)
            found.append((part.name, log))
        except InputError as error:
            wrong = wrong or error
    if wrong is not None and found:
        names = ", ".join(shown(name) for name, _ in found)
        cure = f"{wrong.cure} Or leave it out, below [format]: tables = [{names}].".strip()
        raise wrong.at(wrong.path, cure=cure)
    if wrong is not None:
        raise wrong
    kept: dict[bytes, RawLog] = {}
    for _, log in found:
        columns = [log.friction, *(getattr(log, name) for name in log.abscissae)]
        numbers = b"".join(column.tobytes() for column in columns)
        if numbers in kept:
            note = f"{log.source} has the same numbers and is left out"
            log = replace(kept[numbers], notes=(*kept[numbers].notes, note))
        kept[numbers] = log
    return tuple(kept.values())


def described(log: RawLog) -> list[str]:
    """What was read, in lines: columns with their units and reasons, rows, what is missing, conditions."""
    lines = [f"{log.source}: {log.format}, {log.rows} rows, sha256 {log.checksum[:12]}"]
    lines += [f"  {column.meaning}: {_column(column)}" for column in log.columns if column.meaning]
    rest = [column for column in log.columns if not column.meaning and column.header]
    lines += [f"  not used: {_column(column)}" for column in rest if column.why != "not needed"]
    if others := [f'"{printable(column.header)}"' for column in rest if column.why == "not needed"]:
        lines.append(f"  not used: {', '.join(others)}")
    for name in log.abscissae:
        ends = [format_quantity(float(getattr(log, name)[i]), MEANINGS[name]) for i in (0, -1)]
        lines.append(f"  {name} from {' to '.join(ends)}")
    known = []
    for f in fields(log.conditions):
        value, unit = getattr(log.conditions, f.name), unit_of(type(log.conditions), f.name)
        if value is not None:
            text = format_quantity(value, unit) if unit else printable(value, 200)
            known.append(f"{f.name.replace('_', ' ')} {text}")
    lines.append(f"  conditions: {'; '.join(known) or 'none known'}")
    return lines + [f"  note: {note}" for note in log.notes]


def _column(column: ColumnRead) -> str:
    unit = f" in {column.unit}" if column.unit.strip("- ") else ""
    unit = ", clock times," if column.unit == CLOCK else unit
    return f'column "{printable(column.header)}"{unit} ({column.why})'
