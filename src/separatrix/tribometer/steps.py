"""Which tables of a file are tests: one under repeated headers is joined, a recipe split into its steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from separatrix.tribometer.formats.layout import Layout
from separatrix.tribometer.log import RawTable, Wanted


def joined(tables: Sequence[RawTable], abscissae: Wanted) -> list[RawTable]:
    """The tables, those of one test as one: the same headers, nothing else between them, and time goes on."""
    tests: list[list[RawTable]] = []
    for table in tables:
        if tests and _goes_on(tests[-1][-1], table, abscissae):
            tests[-1].append(table)
        else:
            tests.append([table])
    return [_one(parts) for parts in tests]


def _goes_on(before: RawTable, table: RawTable, abscissae: Wanted) -> bool:
    if (before.headers, before.units) != (table.headers, table.units) or table.metadata or table.name:
        return False
    columns = abscissae(table.headers, table.units)
    return bool(columns) and all(table.columns[i][0] >= before.columns[i][-1] for i in columns)


def _one(parts: Sequence[RawTable]) -> RawTable:
    if len(parts) == 1:
        return parts[0]
    columns = [np.concatenate(pieces) for pieces in zip(*(part.columns for part in parts), strict=True)]
    lines = [part.lines for part in parts if part.lines is not None]
    return replace(parts[0], columns=columns, lines=np.concatenate(lines) if lines else None)


def named(tables: Sequence[RawTable]) -> list[RawTable]:
    """The tables, numbered where their names do not tell them apart."""
    if len({table.name for table in tables}) == len(tables):
        return list(tables)
    return [replace(table, name=f"table {i}") for i, table in enumerate(tables, 1)]


def step_column(headers: Sequence[str], layout: Layout) -> set[int]:
    """Number of the column whose change begins a new table; none where the format has no such column."""
    for name in layout.split_by:
        for i, header in enumerate(headers):
            if header.strip().casefold() == name.casefold():
                return {i}
    return set()


def split_by_step(table: RawTable, layout: Layout) -> list[RawTable]:
    """The table, or one table for each step in it; a step of a single row is left out, for it is no log."""
    found = step_column(table.headers, layout)
    if not found:
        return [table]
    steps = table.columns[found.pop()]
    bounds = [0, *(np.flatnonzero(np.diff(steps) != 0.0) + 1).tolist(), len(steps)]
    pieces = [(a, b) for a, b in pairwise(bounds) if b - a >= 2]
    if len(bounds) == 2 or not pieces:
        return [table]
    names = [f"step {steps[a]:g}" for a, _ in pieces]
    return [_piece(table, a, b, _unique(names, i)) for i, (a, b) in enumerate(pieces)]


def _unique(names: Sequence[str], i: int) -> str:
    again = names[: i + 1].count(names[i])
    return names[i] if again == 1 else f"{names[i]}, again {again}"


def _piece(table: RawTable, start: int, stop: int, name: str) -> RawTable:
    return replace(
        table,
        name=f"{table.name}, {name}" if table.name else name,
        columns=[column[start:stop] for column in table.columns],
        lines=table.lines[start:stop] if table.lines is not None else None,
    )
