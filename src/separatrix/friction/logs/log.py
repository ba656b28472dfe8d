"""A log of a tribometer, whatever format it came from: friction, its abscissa, its conditions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields

from separatrix import _check
from separatrix.errors import InputError
from separatrix.friction.logs.formats import PLAIN, Layout
from separatrix.units import Array, Kelvin, MetrePerSecond, Newton, Pascal, Second

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

ABSCISSAE = ("time", "distance", "cycles")
"""The columns of which a log has at least one."""


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
