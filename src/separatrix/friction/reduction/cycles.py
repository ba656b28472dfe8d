"""Means over whole cycles, and over equal spans made of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction.records import ReductionOptions
from separatrix.friction.reduction.stick_slip import oscillation
from separatrix.units import Array, format_number

MOST = 256
"""Spans into which a test is divided for its statistics, at most."""

FEWEST = 12
"""Spans, where no cycle is known and there are as many rows."""

FEWEST_ROWS = 4
"""Rows without which there are no statistics."""

FEWEST_CYCLES = 4
"""Whole cycles below which means are over rows instead, which is told."""

ROWS_OF_A_SPAN = 3
"""Rows in a span, at least, where no cycle is known."""

ROWS_OF_A_CYCLE = 4.0
"""Rows in a cycle below which its mean is no mean over the turn."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spans:
    """Means over equal spans of the abscissa, each of whole cycles where those are known."""

    start: float
    width: float
    means: Array
    """Shape (span,); where a span holds no row, the straight line between its neighbours."""
    counts: Array
    """Rows in each span, shape (span,)."""

    @property
    def centres(self) -> Array:
        """Middle of each span, shape (span,)."""
        return np.asarray(self.start + self.width * (np.arange(self.means.size) + 0.5), dtype=float)

    @property
    def end(self) -> float:
        """Where the last span ends."""
        return self.start + self.width * self.means.size


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stretch:
    """Rows of a log in which the contact slid under its load, with what their means are taken over."""

    source: str
    along: Array
    """Abscissa in which ends are told, shape (row,); it does not fall."""
    friction: Array
    """Shape (row,) [-]."""
    done: Array | None
    """Cycles done, shape (row,) [-]; None where means are not over whole cycles."""

    @property
    def ruler(self) -> Array:
        """What spans are measured in: cycles if means are over whole ones, else the abscissa."""
        return self.along if self.done is None else self.done

    def spans(self, start: float | None = None) -> Spans:
        """Return the means over equal spans from a place of the ruler on, or of everything.

        Raises
        ------
        InputError
            There are too few rows.
        """
        if self.done is None:
            first = float(self.along[0]) if start is None else start
            return even_spans(self.along, self.friction, first, float(self.along[-1]), self.source)
        first, last = self.cycles(start)
        return cycle_spans(self.done, self.friction, first, last)

    def holds_cycles(self, start: float | None = None) -> bool:
        """Return whether there are enough whole cycles from a place of the ruler on."""
        first, last = self.cycles(start)
        return self.done is not None and last - first >= FEWEST_CYCLES

    def of_rows(self) -> Stretch:
        """Return the same rows, with means over rows and not over whole cycles."""
        return replace(self, done=None)

    def cycles(self, start: float | None = None) -> tuple[int, int]:
        """Return the first whole cycle from a place of the ruler on, and the one after the last."""
        if self.done is None:
            return 0, 0
        first, last = whole_cycles(self.done)
        return (first if start is None else max(first, int(np.ceil(start - 1e-9)))), last

    def cycle_means(self, spans: Spans) -> Array:
        """Return the mean of each cycle that the spans hold, shape (cycle,); empty without cycles."""
        if self.done is None:
            return np.empty(0)
        first, last = round(spans.start), round(spans.end)
        return means(self.done, self.friction, float(first), float(last), last - first).means

    def within(self, spans: Spans) -> Array:
        """Return friction of the rows that the spans hold, shape (row,)."""
        first = int(np.searchsorted(self.ruler, spans.start))
        return self.friction[first : int(np.searchsorted(self.ruler, spans.end, side="right"))]

    def place(self, ruled: float) -> float:
        """Return where along the abscissa a place of the ruler is."""
        if self.done is None:
            return ruled
        return float(self.along[min(int(np.searchsorted(self.done, ruled)), self.along.size - 1)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clock:
    """What is known of the cycle of a test."""

    done: Array | None
    """Cycles done at each row, shape (row,), if means are over whole ones."""
    cycle: float | None
    """Length of a cycle in the unit of the abscissa."""
    notes: tuple[str, ...] = ()

    def stretch(self, log: RawLog, along: Array, rows: slice) -> Stretch:
        """Return some rows of the log with this clock."""
        done = None if self.done is None else self.done[rows]
        return Stretch(source=log.source, along=along[rows], friction=log.friction[rows], done=done)


_SILENT: tuple[str, ...] = ()


def clock(log: RawLog, along: Array, options: ReductionOptions) -> Clock:
    """Return the cycle of a log, given or, if the options ask, found in its spectrum."""
    done, notes = turns(log), _SILENT
    if done is None and options.find_cycle:
        done, notes = _found(along, log.friction)
    if done is None or done[-1] <= done[0]:
        return Clock(done=None, cycle=None, notes=notes)
    cycle = float((along[-1] - along[0]) / (done[-1] - done[0]))
    if not options.whole_cycles:
        return Clock(done=None, cycle=cycle, notes=notes)
    rows = rows_of_a_cycle(done)
    if rows < ROWS_OF_A_CYCLE:
        count = format_number(rows, 2)
        note = f"The log has {count} rows a cycle: what changes within a cycle is not averaged out."
        return Clock(done=None, cycle=cycle, notes=(*notes, note))
    return Clock(done=done, cycle=cycle, notes=notes)


def _found(along: Array, friction: Array) -> tuple[Array | None, tuple[str, ...]]:
    """Return the cycles of the strongest line in the second half of a test, and what to say of it."""
    half = along.size // 2
    found = oscillation(along[half:], friction[half:], None)
    if found.frequency <= 0.0:
        return None, ("No line stands out of the spectrum: no cycle was found, and none is averaged over.",)
    rate = format_number(1.0 / found.frequency)
    note = f"The cycle was found in the spectrum, as asked: one in {rate} of the abscissa's SI unit."
    return np.asarray((along - along[0]) * found.frequency, dtype=float), (note,)


def turns(log: RawLog) -> Array | None:
    """Return how many cycles were done at each row, shape (row,) [-]; None where that is not known.

    From the column of cycles, or else from the time and the time of one cycle.

    Raises
    ------
    InputError
        The column of cycles falls.
    """
    if log.cycles is not None:
        return rising(log, "cycles")
    if log.time is not None and log.conditions.cycle_time is not None:
        time = rising(log, "time")
        return np.asarray((time - time[0]) / log.conditions.cycle_time, dtype=float)
    return None


def rising(log: RawLog, axis: str) -> Array:
    """Return an abscissa of a log, shape (row,).

    Raises
    ------
    InputError
        It falls, is not finite, or does not move.
    """
    values = np.asarray(getattr(log, axis), dtype=float)
    where = f"{log.source}: {axis}"
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
        raise InputError(where, "must be a finite number in each row", f"none in row {row}")
    falls = np.flatnonzero(np.diff(values) < 0.0)
    if falls.size:
        i = int(falls[0])
        cure = "One log holds one test; split it where it begins anew."
        raise InputError(
            where, "must not fall", f"{values[i + 1]:g} after {values[i]:g} in row {i + 2}", cure
        )
    if values[-1] <= values[0]:
        raise InputError(where, "must rise", f"{values[0]:g} in every row")
    return values


def rows_of_a_cycle(done: Array) -> float:
    """Return how many rows a cycle has on average [-]."""
    return float(done.size / max(done[-1] - done[0], 1e-300))


def whole_cycles(done: Array) -> tuple[int, int]:
    """Return the first cycle and the one after the last that the rows cover from end to end.

    A cycle is covered if the rows around it are no farther from its ends than one and a half times the
    usual step; a column that counts whole cycles covers all of them but those it begins and ends in.
    """
    step = 1.5 * (done[-1] - done[0]) / max(done.size - 1, 1)
    counted = bool(np.all(done == np.floor(done)))
    if counted:
        return int(done[0]) + 1, int(done[-1])
    return int(np.ceil(done[0] - step)), int(np.floor(done[-1] + step))


def means(abscissa: Array, values: Array, start: float, end: float, count: int) -> Spans:
    """Return the means over `count` equal spans from `start` to `end`.

    Parameters
    ----------
    abscissa, values : ndarray
        Shape (row,) each; the abscissa rises.
    start, end : float
        Limits; a row at `end` itself belongs to the last span only if it is the last row.
    count : int
        Spans.
    """
    first, last = np.searchsorted(abscissa, (start, end), side="left")
    if abscissa[-1] == end:
        last = abscissa.size
    width = (end - start) / count
    place = np.clip(((abscissa[first:last] - start) / width).astype(np.int64), 0, count - 1)
    held = np.asarray(np.bincount(place, minlength=count), dtype=np.float64)
    sums = np.asarray(np.bincount(place, weights=values[first:last], minlength=count), dtype=np.float64)
    return Spans(start=start, width=width, means=_bridged(sums, held), counts=held)


def _bridged(sums: Array, counts: Array) -> Array:
    """Return the means; the straight line between neighbours where a span holds no row."""
    held = counts > 0
    if not held.any():
        return np.zeros_like(sums)
    means = np.divide(sums, counts, out=np.zeros_like(sums), where=held)
    place = np.arange(sums.size)
    return np.asarray(np.interp(place, place[held], means[held]), dtype=float)


def even_spans(abscissa: Array, values: Array, start: float, end: float, source: str) -> Spans:
    """Return as many equal spans as the rows from `start` to `end` fill, up to `MOST`; of few rows, one each.

    Raises
    ------
    InputError
        There are too few rows.
    """
    first, last = np.searchsorted(abscissa, start), np.searchsorted(abscissa, end, side="right")
    rows = int(last - first)
    count = min(MOST, max(rows // ROWS_OF_A_SPAN, min(rows, FEWEST)))
    if count < FEWEST_ROWS:
        rule = f"needs at least {FEWEST_ROWS} rows of steady friction"
        raise InputError(source, rule, str(rows), "Take a longer log, or an earlier run_in_end.")
    return means(abscissa, values, start, end, count)


def cycle_spans(done: Array, values: Array, first: int, last: int) -> Spans:
    """Return equal spans of whole cycles, from cycle `first` up to, but without, cycle `last`.

    The last span ends where the cycles do; those that fill no span of their own are left out at the start,
    where a test is least steady. Fewer than `FEWEST` cycles are divided evenly: together they stay whole.
    """
    count = last - first
    if count < FEWEST:
        return means(done, values, float(first), float(last), count * -(-FEWEST // count))
    size = -(-count // MOST)
    return means(done, values, float(last - count // size * size), float(last), count // size)
