"""Means over whole cycles and over equal spans made of them, and oscillations that are not the cycle's.

An oscillation is the strongest line of the spectrum of the rows that exceeds its noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import percentile_filter
from scipy.signal import welch
from scipy.special import gammaincc

from separatrix.friction.logs.log import RawLog
from separatrix.friction.steady import ROUNDING
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Ratio, format_number

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


def clock(log: RawLog, along: Array) -> tuple[Array | None, float | None, tuple[str, ...]]:
    """Return the cycles of a log: by its column, or by the time of one cycle.

    That is: cycles done at each row, shape (row,), if means are over whole ones; the length of a cycle in the
    unit of the abscissa; notes. None where that is unknown.
    """
    done: Array | None = None
    if log.cycles is not None:
        done = rising(log, "cycles")
    elif log.time is not None and log.conditions.cycle_time is not None:
        time = rising(log, "time")
        done = np.asarray((time - time[0]) / log.conditions.cycle_time, dtype=float)
    if done is None or done[-1] <= done[0]:
        return None, None, ()
    cycle = float((along[-1] - along[0]) / (done[-1] - done[0]))
    rows = float(done.size / max(done[-1] - done[0], 1e-300))
    if rows < ROWS_OF_A_CYCLE:
        count = format_number(rows, 2)
        note = f"The log has {count} rows a cycle: what changes within a cycle is not averaged out."
        return None, cycle, (note,)
    return done, cycle, ()


def rising(log: RawLog, axis: str) -> Array:
    """Return an abscissa of a log, shape (row,)."""
    values = np.asarray(getattr(log, axis), dtype=float)
    where = f"{log.source}: {axis}"
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
        raise InputError(where, "must be a finite number in each row", f"none in row {row}")
    falls = np.flatnonzero(np.diff(values) < 0.0)
    if falls.size:
        i = int(falls[0])
        got = f"{values[i + 1]:g} after {values[i]:g} in row {i + 2}"
        cure = "One log holds one test; split it where it begins anew."
        raise InputError(where, "must not fall", got, cure)
    if values[-1] <= values[0]:
        raise InputError(where, "must rise", f"{values[0]:g} in every row")
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


SEGMENTS = 8  # parts of the test whose spectra are averaged, overlapping by half
LONGEST, SHORTEST = 4096, 64  # rows of a segment
CHANCE = 1e-4  # probability with which noise alone would show a line as strong somewhere in the spectrum
BESIDE = 8  # places on each side of a line from which the noise is estimated; the two next to it are left out
LOWEST = 12
"""First place of a spectrum where a line is searched: there is no noise to the left of lower ones."""

HARMONICS = 12  # multiples of the cycle that are its own


class Oscillation(NamedTuple):
    """The strongest line of the spectrum of friction; zeros if none exceeds the noise."""

    frequency: float = 0.0  # in cycles per SI unit of the abscissa
    amplitude: Ratio = 0.0  # peak to peak of the sine with its power [-]


def oscillation(along: Array, friction: Array, cycle: float | None) -> Oscillation:
    """Return the strongest oscillation of rows, shape (row,), that is not one of the cycle's.

    The length of the cycle is in the unit of the abscissa; None where it is not known.
    """
    span = float(along[-1] - along[0])
    if span <= 0.0 or along.size < SHORTEST:
        return Oscillation()
    step = span / (along.size - 1)
    even = np.interp(along[0] + step * np.arange(along.size), along, friction)
    length = int(np.clip(along.size // SEGMENTS, SHORTEST, LONGEST))
    frequencies, density = welch(even, 1.0 / step, nperseg=length, detrend="constant")
    noise = np.maximum(beside(density), 1e-300)
    other = np.where(_own(frequencies, density, cycle), np.minimum(density, noise), density)
    line = _line(other, noise, averages=2 * even.size / length - 1)
    if line is None or np.ptp(even) <= ROUNDING * np.abs(even).max():
        return Oscillation()
    reach = 3 + line // 20  # of the places next to the line that belong to it
    part = slice(max(0, line - reach), line + reach + 1)
    power = float(np.maximum(other[part] - noise[line], 0.0).sum()) * frequencies[1]
    frequency = float(np.average(frequencies[line - 1 : line + 2], weights=density[line - 1 : line + 2]))
    return Oscillation(frequency, float(np.sqrt(8.0 * power)))


def beside(density: Array) -> Array:
    """Return the noise around each place: the larger of the medians of both sides.

    A line is above both. The slope of a red spectrum is below the side of low frequency.
    """
    size = BESIDE
    middle = percentile_filter(density, 50.0, size=size, mode="nearest")
    reach = size // 2 + 2
    padded = np.pad(middle, reach, mode="edge")
    return np.asarray(np.maximum(padded[: -2 * reach], padded[2 * reach :]), dtype=float)


def _line(density: Array, noise: Array, averages: float) -> int | None:
    """Return the place of the strongest line, if noise alone is unlikely to make it.

    The limit is the density over the noise that one of all places exceeds with the probability `CHANCE`. The
    mean of n overlapping spectra is a chi-square with about 1.9 n degrees of freedom (Welch's window).
    """
    half = max(1.0, 0.95 * averages)
    ratios = np.geomspace(1.0, 60.0, 400)
    limit = float(ratios[np.argmax(density.size * gammaincc(half, half * ratios) < CHANCE)])
    ratio = density / noise
    ratio[:LOWEST] = ratio[-1] = 0.0
    strongest = int(np.argmax(density * (ratio > limit)))
    return strongest if ratio[strongest] > limit else None


def _own(frequencies: Array, density: Array, cycle: float | None) -> NDArray[np.bool_]:
    """Return where the lines of the cycle and its multiples are, with their feet.

    A strong line has feet wider than the window; they reach down to where the density stops falling. A
    multiple above half the logging rate shows itself mirrored below.
    """
    own = np.zeros(frequencies.size, dtype=bool)
    if cycle is None:
        return own
    last, spacing = frequencies.size - 1, frequencies[1]
    for order in range(1, HARMONICS + 1):
        folded = abs((order / cycle / spacing + last) % (2 * last) - last)
        left, right = max(0, int(folded) - 2), min(last, int(folded) + 3)
        peak = left + int(np.argmax(density[left : right + 1]))
        first, end = peak, peak
        while first > 0 and density[first - 1] < density[first]:
            first -= 1
        while end < last and density[end + 1] < density[end]:
            end += 1
        own[min(first, left) : max(end, right) + 1] = True
    return own
