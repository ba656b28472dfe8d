"""Which rows of a table are steady sliding: free of standstill, reversals of a stroke and ramps of the speed.

A column of speed shows it, in whatever unit; else the slope of a column of position; else, where friction
changes its sign with the stroke or begins near zero, friction itself: it passes through zero at a reversal,
and does not fluctuate where nothing slides.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from separatrix.ground.units import Array, format_number

Rows = NDArray[np.bool_]
STILL = 0.1  # share of the usual speed below which nothing slides
SLOW = 0.5  # share of the usual speed below which a stroke reverses
TURNING = 0.8  # share of the usual friction below which it still turns, from where its sign changes
RAMP = 0.9  # share of the speed behind a ramp at which the ramp ends
BEHIND = 0.05  # share of the rows, 20 at least, behind which as many show to which speed a ramp leads
LONGEST_RAMP = 0.2  # share of the rows that a ramp has at most
REST = 0.2  # share of the usual friction below which a log begins at rest
STROKE = 4  # rows of a stroke, on average, below which a position does not show where it reverses
STRETCH = 8  # rows of one direction, in the middle, from which strokes can be detected
SMOOTH = 0.3  # step between rows, over the usual one, below which friction does not fluctuate: nothing slides
WINDOW = 7  # rows of the running median of such steps
FASTEST = 1e100  # slope of a position, in its unit a second, from which it is not a speed: squares overflow
FEWEST = 0.2  # share of the rows that must slide, or the column does not show it


@dataclass(frozen=True, slots=True)
class Signal:
    """A column that may show which rows slide, in any unit."""

    kind: str  # speed, position or force
    name: str
    values: Array  # shape (row,)


def sliding_rows(
    signals: Sequence[Signal], friction: Array, time: Array | None, kept: Rows
) -> tuple[Rows, str]:
    """Rows of steady sliding of those kept, and a sentence on the others; empty where all rows slide.

    Friction has its sign if the log has one, shape (row,); time is in s, shape (row,).
    """
    rows, words = next(_shown(signals, friction, time, kept), (None, ""))
    if rows is None:
        return kept, _coarse(signals, kept)
    out = int(kept.sum() - (kept & rows).sum())
    if not out:
        return kept, ""
    share = f"{out} of {int(kept.sum())} rows"
    return kept & rows, f"{share} are left out: standstill, reversals or ramps by {words}"


def _shown(
    signals: Sequence[Signal], friction: Array, time: Array | None, kept: Rows
) -> Iterator[tuple[Rows, str]]:
    """Yield which rows slide, and by what; the most reliable first."""
    for wanted in ("speed", "position"):
        for one in signals:
            if one.kind != wanted or not np.isfinite(one.values[kept]).all() or not kept.any():
                continue
            speed = one.values if wanted == "speed" else _slope(one.values, time, kept)
            if speed is not None and (rows := _by_speed(speed, kept)) is not None:
                yield rows, f'the {wanted} in column "{one.name}"'
    for column in (friction, *(one.values for one in signals if one.kind == "force")):
        if (rows := _by_force(column, np.abs(friction), kept)) is not None:
            yield rows, "the sign and the fluctuation of the friction"


def _coarse(signals: Sequence[Signal], kept: Rows) -> str:
    """Sentence on a position that reverses too often for its rows; empty where there is none."""
    for one in signals:
        if one.kind != "position":
            continue
        steps = np.diff(one.values[kept])
        turns = int((np.diff(np.sign(steps[steps != 0.0])) != 0.0).sum())
        if turns * STROKE > steps.size:
            rows = format_number(steps.size / turns, 2)
            return (
                f'the position in column "{one.name}" reverses once in {rows} rows, fewer '
                f"than {STROKE}: reversals cannot be found, and none are left out"
            )
    return ""


def _slope(position: Array, time: Array | None, kept: Rows) -> Array | None:
    """Speed along a position, with its sign; None where it does not move, or too fast for the rows to follow.

    It is the mean of the slopes on both sides of a row, so that it is near zero in the row of a reversal
    however few rows a stroke has. The running median leaves out where an angle begins anew.
    """
    along = position[kept]
    steps = np.diff(along)
    spans = np.ones(steps.size) if time is None else np.diff(time[kept])
    slopes = np.divide(steps, spans, out=np.zeros(steps.size), where=spans > np.abs(steps) / FASTEST)
    slopes = median_filter(slopes, 3, mode="nearest")
    moving = np.abs(steps) > 1e-9 * max(float(np.ptp(along)), 1e-300)
    turns = int((np.diff(np.sign(slopes[moving])) != 0).sum())
    if not moving.any() or turns * STROKE > along.size:
        return None
    speed = np.full(position.size, np.nan)
    speed[kept] = 0.5 * (np.append(slopes[0], slopes) + np.append(slopes, slopes[-1]))
    return speed


def _by_speed(speed: Array, kept: Rows) -> Rows | None:
    """Rows that slide, by a speed in any unit; None where it does not show it."""
    signed = speed[kept]
    v = np.abs(signed)
    fastest = float(v.max(initial=0.0))
    if fastest <= 0.0:
        return None
    usual = float(np.median(v[v > STILL * fastest]))
    moves = v >= STILL * usual
    stops = int((np.diff(moves.astype(np.int8)) == -1).sum())
    turns = int((np.diff(np.sign(signed[moves])) != 0.0).sum())
    rows = v >= SLOW * usual if max(stops, turns) > 3 else moves
    for one in (slice(None), slice(None, None, -1)):
        rows[one][: _ramp(v[one], rows[one])] = False
    if rows.sum() < FEWEST * rows.size:
        return None
    found = np.zeros(kept.size, dtype=bool)
    found[kept] = rows
    return found


def _ramp(speed: Array, slides: Rows) -> int:
    """Rows at the start in which the speed has not reached that behind them."""
    first = int(np.argmax(slides))
    reach = max(20, int(BEHIND * speed.size))
    behind = float(np.median(speed[first + reach : first + 2 * reach])) if speed.size > first + reach else 0.0
    end = first + int(np.argmax(speed[first:] >= RAMP * behind))
    return end if end <= first + LONGEST_RAMP * speed.size else first


def _by_force(signed: Array, friction: Array, kept: Rows) -> Rows | None:
    """Rows that slide in a log of strokes, by its friction alone; None where it is not one."""
    f, size = signed[kept], friction[kept]
    if f.size < 4 * STRETCH or not np.isfinite(f).all():
        return None
    usual, usual_size = float(np.median(np.abs(f))), float(np.median(size))
    clear = np.sign(np.where(np.abs(f) > STILL * usual, f, 0.0))
    turns = np.flatnonzero(np.diff(clear[clear != 0.0]) != 0.0)
    lengths = np.diff(np.concatenate([[0], turns + 1, [int((clear != 0.0).sum())]]))
    strokes = turns.size > 0 and np.median(lengths) >= STRETCH
    if not strokes and size[:3].max() >= REST * usual_size:
        return None
    crossings = np.flatnonzero(np.diff(np.sign(f)) != 0.0) if strokes or turns.size == 0 else turns
    rows = ~_around(np.abs(f) < TURNING * usual, np.append(crossings, 0))
    for one in (slice(None), slice(None, None, -1)):
        rows[one][: _still_rows(size[one])] = False
    found = np.zeros(kept.size, dtype=bool)
    found[kept] = rows
    return found if rows.sum() >= FEWEST * rows.size else None


def _around(low: Rows, places: NDArray[np.int64]) -> Rows:
    """Rows of the stretches of low friction with one of the places in them."""
    stretch = np.cumsum(np.diff(low, prepend=not low[0]))
    held = np.zeros(stretch[-1] + 1, dtype=bool)
    held[stretch[places]] = True
    return np.asarray(low & held[stretch])


def _still_rows(friction: Array) -> int:
    """Rows at the start in which friction does not fluctuate as it does while sliding."""
    steps = np.abs(np.diff(friction))
    usual = float(np.percentile(steps, 60.0))
    smooth = median_filter(steps, WINDOW, mode="nearest") < SMOOTH * usual
    end = int(np.argmin(smooth)) if not smooth.all() else 0
    return end + WINDOW // 2 if end >= WINDOW // 2 and usual > 0.0 else 0
