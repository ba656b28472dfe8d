"""A table that holds the steps of a recipe one after the other, split where the step changes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from separatrix.tribometer.formats.layout import Layout
from separatrix.tribometer.log import RawTable


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
    return RawTable(
        name=f"{table.name}, {name}" if table.name else name,
        headers=table.headers,
        units=table.units,
        columns=[column[start:stop] for column in table.columns],
        metadata=table.metadata,
        lines=table.lines[start:stop] if table.lines is not None else None,
    )
