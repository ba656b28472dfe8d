"""What happens once in a test: seizure, a spike, a lost load, a step in friction or in wear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction.cycles import FEWEST, Spans
from separatrix.units import Ratio

SMOOTHED = 5  # rows of the running median: fewer in a row are not an event
LASTING = 0.1  # share of the rows through which a state must last to count as staying, if not to the end
CHUNKS = 256  # stretches from whose means the usual friction is taken
NOISE = 7.0  # standard deviations above its mean that noise does not reach
ONSET = 0.1  # share of the rise to the limit at which a seizure begins
STEP_GAIN, STEP_SIZE = 0.4, 0.1
"""A step leaves less than this share of the scatter around a straight line, and is larger than this share
of the mean."""

EDGE = 0.05  # share of the steady part at its ends, or three spans, within which no step is reported
RISE = 2.0  # steady friction over that before a rise in running-in from which the rise is reported
JUMP = 10.0
"""A jump of wear over the usual scatter of its increments over two spans; it is also a fifth of all wear."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Something that happens at one row."""

    kind: str
    """``"loading"``, ``"seizure"``, ``"force lost"``, ``"spike"``, ``"friction step"`` or ``"wear step"``."""
    row: int  # first row of it; of ``"loading"`` the first row after it
    until: int  # row after its last one
    size: float  # largest friction, lowest force [N], or the step: friction or depth [m]
    usual: float  # what it is compared with


def row_events(log: RawLog, seizure_ratio: Ratio, force_loss: Ratio) -> tuple[Event, ...]:
    """Return what single rows show: loading, seizure, spikes, lost load; in the order of the rows."""
    found = [*_force_events(log, force_loss), *_friction_events(log, seizure_ratio)]
    return tuple(sorted(found, key=lambda event: event.row))


def kept_rows(events: tuple[Event, ...], rows: int) -> tuple[int, int]:
    """Return the first row after loading, and the one where a seizure or a lost load ends the test."""
    start = max((event.row for event in events if event.kind == "loading"), default=0)
    ends = [event.row for event in events if event.kind in ("seizure", "force lost")]
    return start, min([row for row in ends if row > start], default=rows)


def _friction_events(log: RawLog, seizure_ratio: Ratio) -> Iterator[Event]:
    # the level that a fifth of the stretches of a test stay below: no seizure can lift it
    size = max(SMOOTHED, -(-log.rows // CHUNKS))
    starts = np.arange(0, log.rows, size)
    means = np.add.reduceat(log.friction, starts) / np.diff(np.append(starts, log.rows))
    usual = float(np.percentile(means, 20.0))
    if usual <= 0.0 or log.rows < 4 * SMOOTHED:
        return
    smooth = median_filter(log.friction, SMOOTHED, mode="nearest")
    # what noise does not reach, from the lower fifth, which no seizure can lift: the quantiles of 2.5 % and
    # 20 % of a normal distribution are 1.96 and 0.84 standard deviations below its mean
    low, fifth = np.percentile(smooth, (2.5, 20.0))
    noise = float(fifth + (0.84 + NOISE) * (fifth - low) / (1.96 - 0.84))
    for first, last in _stretches(smooth > max(seizure_ratio * usual, noise)):
        if first == 0 or last - first < SMOOTHED:
            continue
        stays = last >= log.rows - SMOOTHED or last - first >= LASTING * log.rows
        row = first
        if stays:
            calm = np.flatnonzero(smooth[:first] <= usual * (1.0 + ONSET * (seizure_ratio - 1.0)))
            row = int(calm[-1]) + 1 if calm.size else first
        kind = "seizure" if stays else "spike"
        yield Event(kind=kind, row=row, until=last, size=float(smooth[first:last].max()), usual=usual)
        if stays:
            return


def _force_events(log: RawLog, force_loss: Ratio) -> Iterator[Event]:
    force = log.normal_force
    if force is None or not np.isfinite(force).any():
        return
    usual = float(np.nanmedian(np.abs(force)))
    low = np.abs(force) < force_loss * usual
    for first, last in _stretches(low):
        least = float(np.nanmin(np.abs(force[first:last])))
        if first == 0:
            yield Event(kind="loading", row=last, until=last, size=least, usual=usual)
        elif last - first >= SMOOTHED or last == log.rows:
            yield Event(kind="force lost", row=first, until=last, size=least, usual=usual)


def _stretches(flag: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first row and row after the last of each stretch of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flag, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def friction_step(spans: Spans) -> tuple[float, float] | None:
    """Return place and size of a step that explains the means far better than a straight line; else None."""
    y, n = spans.means, spans.means.size
    if n < FEWEST:
        return None
    x = np.arange(n) - (n - 1) / 2
    level = y - y.mean()
    straight = float(level @ level - (x @ level) ** 2 / (x @ x))
    edge = max(3, int(EDGE * n))
    split = np.arange(edge, n - edge)
    left = np.cumsum(level)[split - 1]
    gain = left**2 * n / (split * (n - split))
    best = int(np.argmax(gain))
    k = int(split[best])
    size = float(y[k:].mean() - y[:k].mean())
    small = abs(size) < STEP_SIZE * abs(float(y.mean()))
    if small or level @ level - gain[best] > STEP_GAIN * straight:
        return None
    return spans.start + spans.width * k, size


def run_in_rise(spans: Spans, end: float, friction: float) -> tuple[float, float] | None:
    """Return place and level before a rise in running-in to far above it; else None.

    The place is that of the rising step that explains the means best; it must be in what is cut, or so
    near behind that `friction_step` does not look there. The level is the lower of the medians of both
    halves before it: neither a fall that comes first nor a slow rise lifts it.

    Parameters
    ----------
    spans : Spans
        Of the whole test.
    end : float
        Where running-in ends, on the ruler of the spans.
    friction : float
        Of the steady part.
    """
    y, n = spans.means, spans.means.size
    split = np.arange(1, n)
    below = -np.cumsum(y - y.mean())[:-1]
    k = int(split[int(np.argmax(below / np.sqrt(split * (n - split))))])
    place = spans.start + spans.width * k
    before = float(min(np.median(y[: (k + 1) // 2]), np.median(y[k // 2 : k])))
    reach = end + max(3.0 * spans.width, EDGE * (spans.end - end))
    is_cut = spans.start < end and place <= reach
    return (place, before) if is_cut and friction > max(0.0, RISE * before) else None


def wear_step(spans: Spans) -> tuple[float, float] | None:
    """Return place and size of a sudden change of wear depth; else None."""
    if spans.means.size < FEWEST:
        return None
    increments = spans.means[2:] - spans.means[:-2]  # over the span in which it may be
    excess = increments - np.median(increments)
    scatter = 1.4826 * float(np.median(np.abs(excess)))
    k = int(np.argmax(np.abs(excess)))
    if abs(excess[k]) <= JUMP * scatter or abs(excess[k]) < 0.2 * float(np.ptp(spans.means)):
        return None
    return spans.start + spans.width * (k + 1.5), float(excess[k])
