"""A log of a tribometer, whatever format it came from, and the parts of one test joined to one log."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from separatrix import _check
from separatrix.errors import InputError
from separatrix.friction.logs.formats import PLAIN, Layout
from separatrix.units import (
    Array,
    Kelvin,
    MetrePerSecond,
    Newton,
    Pascal,
    Second,
    format_number,
    format_quantity,
    printable,
    unit_of,
)

MEANINGS = {
    "friction": "-",
    "tangential_force": "N",
    "normal_force": "N",
    "time": "s",
    "distance": "m",
    "cycles": "-",
    "temperature": "K",
    "wear_depth": "m",
    "slip_speed": "m/s",
    "rotational_speed": "rad/s",
}
"""What a column may mean, and the SI unit it is kept in. A rotational speed serves the conditions only."""

ABSCISSAE = ("time", "distance", "cycles")  # the columns of which a log has at least one


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditions:
    """Under which one test was run; None where that is not known."""

    material: str | None = None
    counterface: str | None = None
    medium: str | None = None
    sample: str | None = None
    test: str | None = None
    temperature: Kelvin | None = None
    slip_speed: MetrePerSecond | None = None
    pressure: Pascal | None = None
    """Mean contact pressure."""
    normal_force: Newton | None = None
    cycle_time: Second | None = None
    """Of one revolution or of one stroke there and back."""

    def __post_init__(self) -> None:
        texts = ("material", "counterface", "medium", "sample", "test")
        _check.settle(
            *(_check.printable_text(self, name) for name in texts),
            _check.positive(self, "temperature", 0.1, 3000.0),
            _check.positive(self, "slip_speed", 1e-9, 1e3),
            _check.positive(self, "pressure", 1e-3, 1e12),
            _check.positive(self, "normal_force", 1e-9, 1e7),
            _check.positive(self, "cycle_time", 1e-6, 1e7),
        )

    @property
    def environment(self) -> str | None:
        """Medium and counterface as friction tables name them: ``"liquid nitrogen, 440C"``."""
        if self.medium is None or self.counterface is None:
            return None
        return f"{self.medium}, {self.counterface}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnRead:
    """How one column of a file was understood."""

    header: str
    meaning: str | None
    """A key of `MEANINGS`; None where the column is not used."""
    unit: str
    """As the file or the column map writes it; empty where there is none."""
    why: str
    """For instance ``"its name"`` or ``"column map"``."""

    def __post_init__(self) -> None:
        if self.meaning is not None and self.meaning not in MEANINGS:
            rule = f"must be one of {', '.join(MEANINGS)}"
            raise InputError("ColumnRead.meaning", rule, f'"{self.meaning}"')


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RawTable:
    """One table as a file holds it, before its columns have a meaning."""

    name: str
    """Of the sheet, channel group or section; empty where the file has one table only."""
    headers: tuple[str, ...]
    units: tuple[str, ...]
    """As written; empty where the table has none."""
    columns: list[Array]
    """One per header, shape (row,) each, in the units written; NaN where the file has nothing."""
    metadata: Mapping[str, str] = field(default_factory=dict)
    lines: Sequence[int] | Array | None = None
    """Line of the file (from 1) of each row, for messages; None where it has no lines."""
    layout: Layout = PLAIN

    def __post_init__(self) -> None:
        if not len(self.headers) == len(self.units) == len(self.columns):
            counts = f"{len(self.headers)}, {len(self.units)} and {len(self.columns)}"
            raise InputError("RawTable", "needs one unit and one column for each header", counts)
        if len({column.shape for column in self.columns}) > 1:
            raise InputError("RawTable.columns", "must have the same number of rows")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RawLog:
    """Friction of one test as it was logged, in SI units, with where it comes from."""

    source: str
    """Name of the file, and of the sheet, channel group or section in it."""
    checksum: str
    """SHA-256 of the file."""
    format: str
    friction: Array
    """Magnitude, shape (row,) [-]."""
    time: Array | None = None
    distance: Array | None = None
    cycles: Array | None = None
    normal_force: Array | None = None
    tangential_force: Array | None = None
    """With the sign that was logged, shape (row,) [N]."""
    temperature: Array | None = None
    wear_depth: Array | None = None
    slip_speed: Array | None = None
    missing: int = 0
    """Rows left out because friction or its abscissa was not there."""
    columns: tuple[ColumnRead, ...] = ()
    metadata: Mapping[str, str] = field(default_factory=dict)
    conditions: Conditions = field(default_factory=Conditions)
    series: str = ""
    """What the header states about the test that this is a part of; empty if nothing."""
    notes: tuple[str, ...] = ()
    """What the reading did that a user should know, a sentence each."""

    def __post_init__(self) -> None:
        problems = []
        if not self.abscissae:
            problems.append(InputError(self.source, f"needs one of {', '.join(ABSCISSAE)}"))
        if len(self.friction) < 2:
            got = str(len(self.friction))
            problems.append(InputError(self.source, "needs at least two rows with a friction", got))
        for name in sorted(MEANINGS.keys() & {f.name for f in fields(self)}):
            column = getattr(self, name)
            if column is not None and len(column) != len(self.friction):
                got = str(len(column))
                problems.append(InputError(f"RawLog.{name}", "must have as many rows as friction", got))
        _check.settle(problems)

    @property
    def rows(self) -> int:
        """Rows that are kept."""
        return len(self.friction)

    @property
    def abscissae(self) -> tuple[str, ...]:
        """Which of time, distance and cycles the log has."""
        return tuple(name for name in ABSCISSAE if getattr(self, name) is not None)


ALIKE = 0.1  # share by which measured conditions of parts may differ; beyond it they are of different tests
LISTED = 12  # parts whose friction is listed


def in_order(name: str) -> list[tuple[int, str]]:
    """Key that sorts ``part 2`` before ``part 10``."""
    return [(int(part or 0), "") if part.isdigit() else (0, part) for part in re.split(r"(\d+)", name)]


def by_series(logs: Sequence[RawLog]) -> list[list[RawLog]]:
    """Return the logs, those of one series in several files together, at the place of the first of them."""
    groups: dict[tuple[str, int], list[RawLog]] = {}
    for i, log in enumerate(logs):
        groups.setdefault((log.series, 0 if log.series else i), []).append(log)
    found: list[list[RawLog]] = []
    for parts in groups.values():
        found += [parts] if len({part.checksum for part in parts}) > 1 else [[part] for part in parts]
    return found


def joined(parts: Sequence[RawLog]) -> RawLog:
    """Return one log of the parts of a test, one after the other; time goes on from one to the next.

    Raises
    ------
    InputError
        The parts have no abscissa in common, or were run under different conditions.
    """
    if len(parts) == 1:
        return parts[0]
    parts = sorted(parts, key=lambda part: in_order(part.source))
    source = f"{parts[0].source} and {len(parts) - 1} more"
    columns: dict[str, Any] = {}
    for name in (f.name for f in fields(RawLog) if f.name in MEANINGS):
        pieces = [getattr(part, name) for part in parts]
        if any(piece is None for piece in pieces):
            columns[name] = None
            continue
        for i in range(1, len(pieces) if name in ABSCISSAE else 0):  # one that begins anew goes on
            last, piece = pieces[i - 1][-1], pieces[i]
            if piece[0] < last:
                pieces[i] = piece + (last - piece[0] + float(np.median(np.diff(piece))))
        columns[name] = np.concatenate(pieces)
    if all(columns[name] is None for name in ABSCISSAE):
        raise InputError(source, "have no column of time, distance or cycles in common to be joined by")
    if len({part.series for part in parts}) == 1 and parts[0].series and columns["cycles"] is None:
        # a cycle is a stroke there and the one back
        strokes = [(k + np.arange(part.rows) / part.rows) / 2.0 for k, part in enumerate(parts)]
        columns["cycles"] = np.concatenate(strokes)
    means = [format_number(float(part.friction.mean()), 3) for part in parts]
    more = "" if len(means) <= LISTED else f" and {len(means) - LISTED} more"
    note = (
        f"{len(parts)} parts of one test are joined, {parts[0].source} to {parts[-1].source}; "
        f"their frictions: {', '.join(means[:LISTED])}{more}"
    )
    return replace(
        parts[0],
        source=source,
        checksum=hashlib.sha256("".join(part.checksum for part in parts).encode()).hexdigest(),
        missing=sum(part.missing for part in parts),
        conditions=_conditions(parts, source),
        notes=(note, *parts[0].notes),
        series="",
        **columns,
    )


def _conditions(parts: Sequence[RawLog], source: str) -> Conditions:
    """Conditions of all parts: words that agree, and the middle of measured values that are alike."""
    found: dict[str, object] = {}
    for f in fields(Conditions):
        values = [value for part in parts if (value := getattr(part.conditions, f.name)) is not None]
        numbers = [value for value in values if isinstance(value, float)]
        if numbers:
            found[f.name] = float(np.median(numbers))
            differs = max(numbers) - min(numbers) > ALIKE * float(np.median(numbers))
        else:
            found[f.name] = values[0] if values else None
            differs = len(set(values)) > 1
        if differs:
            unit = unit_of(Conditions, f.name)
            ends = (min(values), max(values))
            texts = [format_quantity(v, unit) if unit else printable(str(v)) for v in ends]
            rule = f"cannot be one test: their {f.name.replace('_', ' ')} differs"
            raise InputError(source, rule, " and ".join(texts), "Name the parts of one test only.")
    return Conditions(**found)  # type: ignore[arg-type]
