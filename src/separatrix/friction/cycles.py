"""Means over whole cycles, and over equal spans made of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.friction.logs.log import RawLog
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, format_number

MOST = 256  # spans into which a test is divided for its statistics, at most
FEWEST = 12  # spans, where no cycle is known and there are as many rows
FEWEST_ROWS = 4  # rows without which there are no statistics
FEWEST_CYCLES = 4  # whole cycles below which means are over rows instead, which is reported
ROWS_OF_A_SPAN = 3  # rows in a span, at least, where no cycle is known
ROWS_OF_A_CYCLE = 4.0  # rows in a cycle below which its mean is not a mean over the turn


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spans:
    """Means over equal spans of the abscissa, each of whole cycles where those are known."""

    start: float
    width: float
    means: Array  # shape (span,); where a span has no row, the straight line between its neighbours

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
    along: Array  # abscissa of ends and drift, shape (row,); it does not fall
    friction: Array  # shape (row,) [-]
    done: Array | None  # cycles done, shape (row,) [-]; None where means are not over whole cycles

    @property
    def ruler(self) -> Array:
        """What spans are measured in: cycles if means are over whole ones, else the abscissa."""
        return self.along if self.done is None else self.done

    def spans(self, start: float | None = None) -> Spans:
        """Return the means over equal spans from a place of the ruler on, or of everything.

        As many spans as the rows fill, up to `MOST`; of few rows, one each. Where cycles are known, the last
        span ends where they do; those that fill no span of their own are left out at the start, where a test
        is least steady. Fewer than `FEWEST` cycles are divided evenly: together they stay whole.
        """
        if self.done is None:
            begin, end = float(self.along[0]) if start is None else start, float(self.along[-1])
            low, high = np.searchsorted(self.along, begin), np.searchsorted(self.along, end, side="right")
            rows = int(high - low)
            count = min(MOST, max(rows // ROWS_OF_A_SPAN, min(rows, FEWEST)))
            if count < FEWEST_ROWS:
                rule = f"needs at least {FEWEST_ROWS} rows of steady friction"
                raise InputError(self.source, rule, str(rows), "Take a longer log, or an earlier run_in_end.")
            return means(self.along, self.friction, begin, end, count)
        first, last = self.cycles(start)
        count = last - first
        if count < FEWEST:
            return means(self.done, self.friction, float(first), float(last), count * -(-FEWEST // count))
        size = -(-count // MOST)
        begin = float(last - count // size * size)
        return means(self.done, self.friction, begin, float(last), count // size)

    def holds_cycles(self, start: float | None = None) -> bool:
        """Return whether there are enough whole cycles from a place of the ruler on."""
        first, last = self.cycles(start)
        return last - first >= FEWEST_CYCLES

    def cycles(self, start: float | None = None) -> tuple[int, int]:
        """Return the first whole cycle from a place of the ruler on, and the one after the last.

        A cycle is whole if the rows around it are no farther from its ends than one and a half times the
        usual step; a column that counts whole cycles covers all of them but those it begins and ends in.
        """
        done = self.done
        if done is None:
            return 0, 0
        step = 1.5 * (done[-1] - done[0]) / max(done.size - 1, 1)
        first, last = int(np.ceil(done[0] - step)), int(np.floor(done[-1] + step))
        if np.all(done == np.floor(done)):
            first, last = int(done[0]) + 1, int(done[-1])
        return (first if start is None else max(first, int(np.ceil(start - 1e-9)))), last

    def cycle_means(self, spans: Spans) -> Array:
        """Return the mean of each cycle in the spans, shape (cycle,); empty without cycles."""
        if self.done is None:
            return np.empty(0)
        first, last = round(spans.start), round(spans.end)
        return means(self.done, self.friction, float(first), float(last), last - first).means

    def within(self, spans: Spans) -> Array:
        """Return friction of the rows in the spans, shape (row,)."""
        first = int(np.searchsorted(self.ruler, spans.start))
        return self.friction[first : int(np.searchsorted(self.ruler, spans.end, side="right"))]

    def place(self, ruled: float) -> float:
        """Return where along the abscissa a place of the ruler is."""
        if self.done is None:
            return ruled
        return float(self.along[min(int(np.searchsorted(self.done, ruled)), self.along.size - 1)])


def clock(log: RawLog) -> tuple[Array | None, tuple[str, ...]]:
    """Return the cycles done at each row, shape (row,), by their column or by the time of one; and notes.

    None where they are not known, or where a cycle has too few rows for means over whole ones.
    """
    done: Array | None = None
    if log.cycles is not None:
        done = rising(log, "cycles")
    elif log.time is not None and log.conditions.cycle_time is not None:
        time = rising(log, "time")
        done = np.asarray((time - time[0]) / log.conditions.cycle_time, dtype=float)
    if done is None or done[-1] <= done[0]:
        return None, ()
    rows = float(done.size / max(done[-1] - done[0], 1e-300))
    if rows < ROWS_OF_A_CYCLE:
        count = format_number(rows, 2)
        return None, (f"The log has {count} rows a cycle: what changes within a cycle is not averaged out.",)
    return done, ()


def rising(log: RawLog, axis: str) -> Array:
    """Return an abscissa of a log, shape (row,); the reading of the log refuses one that falls."""
    values = np.asarray(getattr(log, axis), dtype=float)
    if values[-1] <= values[0]:
        raise InputError(f"{log.source}: {axis}", "must rise", f"{values[0]:g} in every row")
    return values


def means(abscissa: Array, values: Array, start: float, end: float, count: int) -> Spans:
    """Return the means over `count` equal spans from `start` to `end`; the abscissa, shape (row,), rises.

    A row at `end` itself belongs to the last span only if it is the last row.
    """
    first, last = np.searchsorted(abscissa, (start, end), side="left")
    if abscissa[-1] == end:
        last = abscissa.size
    width = (end - start) / count
    place = np.clip(((abscissa[first:last] - start) / width).astype(np.int64), 0, count - 1)
    held = np.asarray(np.bincount(place, minlength=count), dtype=np.float64)
    sums = np.asarray(np.bincount(place, weights=values[first:last], minlength=count), dtype=np.float64)
    full = held > 0
    found = np.divide(sums, held, out=np.zeros_like(sums), where=full)
    if full.any():  # a span without a row is bridged
        spans = np.arange(count)
        found = np.asarray(np.interp(spans, spans[full], found[full]), dtype=float)
    return Spans(start=start, width=width, means=found)
