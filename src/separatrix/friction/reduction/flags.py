"""What happens in a test, and what a reader has to consider: a sentence each, with its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from separatrix.friction.file import in_words
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction.conditions import changes
from separatrix.friction.reduction.cycles import Spans
from separatrix.friction.reduction.steady import LONG
from separatrix.ground.units import format_number, format_quantity

if TYPE_CHECKING:
    from separatrix.friction.reduction import Reduction

SEIZURE = 3.0  # friction over its usual level from which, if it stays, a contact counts as seized
FORCE_LOSS = 0.5  # share of the usual normal force below which, if it stays, the load counts as lost
DRIFT_SIZE = 0.02  # change over the steady part, over the mean, from which a significant drift is reported
FEWEST_EFFECTIVE = 20.0  # independent values below which a test is reported as too short
SMOOTHED = 5  # rows of the running median: fewer in a row are not an event
LASTING = 0.1  # share of the rows through which a state must last to count as staying, if not to the end
CHUNKS = 256  # stretches from whose means the usual friction is taken
NOISE = 7.0  # standard deviations above its mean that noise does not reach
ONSET = 0.1  # share of the rise to the limit at which a seizure begins
EDGE = 0.05  # share of the steady part, or three spans, by which a rise may lie behind running-in
RISE = 2.0  # steady friction over that before a rise in running-in from which the rise is reported


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Something that happens at one row."""

    kind: str
    """``"loading"``, ``"seizure"`` or ``"force lost"``."""
    row: int  # first row of it; of ``"loading"`` the first row after it
    size: float  # largest friction, or lowest force [N]
    usual: float  # what it is compared with


def row_events(log: RawLog) -> tuple[Event, ...]:
    """Return what single rows show: loading, seizure, lost load; in the order of the rows."""
    found = [*_force_events(log), *_friction_events(log)]
    return tuple(sorted(found, key=lambda event: event.row))


def kept_rows(events: tuple[Event, ...], rows: int) -> tuple[int, int]:
    """Return the first row after loading, and the one where a seizure or a lost load ends the test."""
    start = max((event.row for event in events if event.kind == "loading"), default=0)
    ends = [event.row for event in events if event.kind in ("seizure", "force lost")]
    return start, min([row for row in ends if row > start], default=rows)


def _friction_events(log: RawLog) -> Iterator[Event]:
    # the level that a fifth of the stretches of a test stay below: no seizure can lift it
    size = max(SMOOTHED, -(-log.rows // CHUNKS))
    starts = np.arange(0, log.rows, size)
    levels = np.add.reduceat(log.friction, starts) / np.diff(np.append(starts, log.rows))
    usual = float(np.percentile(levels, 20.0))
    if usual <= 0.0 or log.rows < 4 * SMOOTHED:
        return
    smooth = median_filter(log.friction, SMOOTHED, mode="nearest")
    # what noise does not reach, from the lower fifth, which no seizure can lift: the quantiles of 2.5 % and
    # 20 % of a normal distribution are 1.96 and 0.84 standard deviations below its mean
    low, fifth = np.percentile(smooth, (2.5, 20.0))
    noise = float(fifth + (0.84 + NOISE) * (fifth - low) / (1.96 - 0.84))
    for first, last in _stretches(smooth > max(SEIZURE * usual, noise)):
        if first == 0 or last - first < SMOOTHED:
            continue
        if last >= log.rows - SMOOTHED or last - first >= LASTING * log.rows:  # it stays
            calm = np.flatnonzero(smooth[:first] <= usual * (1.0 + ONSET * (SEIZURE - 1.0)))
            row = int(calm[-1]) + 1 if calm.size else first
            yield Event(kind="seizure", row=row, size=float(smooth[first:last].max()), usual=usual)
            return


def _force_events(log: RawLog) -> Iterator[Event]:
    force = log.normal_force
    if force is None or not np.isfinite(force).any():
        return
    usual = float(np.nanmedian(np.abs(force)))
    low = np.abs(force) < FORCE_LOSS * usual
    for first, last in _stretches(low):
        least = float(np.nanmin(np.abs(force[first:last])))
        if first == 0:
            yield Event(kind="loading", row=last, size=least, usual=usual)
        elif last - first >= SMOOTHED or last == log.rows:
            yield Event(kind="force lost", row=first, size=least, usual=usual)


def _stretches(flag: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first row and row after the last of each stretch of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flag, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def run_in_rise(spans: Spans, end: float, friction: float) -> tuple[float, float] | None:
    """Return place and level before a rise in running-in to far above it; else None.

    The spans are those of the whole test, running-in ends at `end` of their ruler, and `friction` is steady
    behind it. The place is that of the rising step that explains the means best; it must be in what is cut,
    or just behind. The level is the lower of the medians of both halves before it: neither a fall that
    comes first nor a slow rise lifts it.
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


RATES = {"time": (3600.0, "per h"), "distance": (1000.0, "per km"), "cycles": (1000.0, "per 1000 cycles")}
"""Size and words of the unit of a drift, by the abscissa."""

CHANCE = 0.01  # probability without any drift below which a drift is reported
HALF = 0.5  # share of a test beyond which running-in is reported as long
FEW_ROWS = 36  # rows below which running-in cannot be judged
MOSTLY = 1.4  # standard error over that by noise from which most of it is what may be left of running-in
HIGH = 1.0  # friction above which a wrong column or unit is likelier than a contact


def flags(one: Reduction) -> Iterator[str]:
    """Yield what a reader has to consider about a test."""
    for part in (_ends, _run_in, _drift, _length, _size):
        yield from part(one)
    yield from changes(one.log, one.steady_rows)


def _ends(one: Reduction) -> Iterator[str]:
    """Report where the load comes late or is lost, and where a film fails."""
    axis = one.test.run_in_axis
    for event in one.events:
        place = in_words(float(one.along[min(event.row, one.along.size - 1)]), axis)
        usual = format_number(event.usual, 3)
        force, low = format_quantity(event.usual, "N"), format_quantity(event.size, "N")
        if event.kind == "loading":
            yield f"The normal force reaches its {force} only at {place}: what is before is left out."
        elif event.kind == "force lost":
            yield f"The normal force falls from {force} to {low} at {place}: the steady part ends before it."
        elif event.kind == "seizure":
            yield (
                f"Seizure or a failed film: friction rises from {usual} to {format_number(event.size, 3)} at "
                f"{place} and stays up; the steady part ends before it."
            )
    if (rise := run_in_rise(one.stretch.spans(), one.spans.start, one.test.friction)) is not None:
        low, high = format_number(rise[1], 3), format_number(one.test.friction, 3)
        place = in_words(one.stretch.place(rise[0]), axis)
        cut = "if running-in ends elsewhere, write run_in_end in the column map; " if one.run_in else ""
        yield (
            f"Friction rises from {low} to {high} near {place}, in or next to what is cut as running-in: a "
            f"failed film, or a genuine rise. Look at the plot; {cut}if the film failed, use the log only up "
            "to the rise."
        )


def _run_in(one: Reduction) -> Iterator[str]:
    """Report running-in that does not end, or takes most of the test."""
    test, found, start = one.test, one.run_in, float(one.stretch.along[0])
    share = (test.run_in_end - start) / (test.steady_end - start)
    end = in_words(test.run_in_end, test.run_in_axis)
    if found is not None and not found.ends:
        of_mean = 100 * found.rest / max(abs(test.friction), 1e-300)
        yield (
            f"Running-in does not end: friction still changes behind {end}, {100 * share:.0f} % of the test; "
            f"later parts differ from the mean by up to {format_number(found.rest, 2)} ({of_mean:.2g} % of "
            "it)."
        )
    elif share > HALF:
        yield f"Running-in takes {100 * share:.0f} % of the test, up to {end}."


def _drift(one: Reduction) -> Iterator[str]:
    """Report a straight drift that is significant and large enough."""
    mean, test = one.mean, one.test
    if mean.change_chance >= CHANCE or abs(mean.change) < DRIFT_SIZE * abs(mean.mean):
        return
    size, words = RATES[test.run_in_axis]
    rate, error = format_number(test.drift_rate * size, 3), format_number(test.drift_error * size, 2)
    first, last = (format_number(mean.mean + half * mean.change, 3) for half in (-0.5, 0.5))
    yield (
        f"Friction drifts by {rate} {words} (standard error {error}), from {first} to {last} over the steady "
        "part: its mean is that of this part, not of its end."
    )


def _length(one: Reduction) -> Iterator[str]:
    """Report a test too short for its correlation, where the error is not mostly that of running-in."""
    test = one.test
    if test.steady_rows < FEW_ROWS:
        yield (
            f"The steady part has {test.steady_rows} rows: too few to see running-in or correlation, and the "
            "interval assumes none."
        )
    elif one.mean.is_long and test.standard_error < MOSTLY * one.mean.standard_error:
        yield (
            f"Friction is correlated over {100 / (np.pi * LONG):.0f} % of the steady part or longer: the "
            "test is too short for its scatter, and the interval may be too narrow."
        )
    elif test.effective_count < FEWEST_EFFECTIVE:
        yield (
            f"The steady part holds {format_number(test.effective_count, 2)} independent values, fewer than "
            f"{format_number(FEWEST_EFFECTIVE)}: the test is short for its scatter."
        )


def _size(one: Reduction) -> Iterator[str]:
    """Report friction that dry contacts seldom have, in the mean or in one of a hundred rows, or no noise."""
    mean = one.test.friction
    low, high = (float(value) for value in np.percentile(one.steady_friction, (1.0, 99.0)))
    if not 0.0 < mean <= 2.0 or low < 0.0 or high > 2.0:
        numbers = (format_number(value, 3) for value in (mean, low, high))
        yield (
            "Friction is outside 0 to 2 (mean {}, 98 % of its rows from {} to {}): "
            "check zero, sign and units of the forces.".format(*numbers)
        )
    elif mean > HIGH:
        yield (
            f"Friction {format_number(mean, 3)} is above {format_number(HIGH)}, which dry sliding seldom "
            "reaches: check that its column is not a force, and the units of the forces."
        )
    if np.ptp(one.steady_friction) == 0.0:
        yield (
            f"Friction is {format_number(mean)} in every row: the log does not show its noise, "
            "and the interval holds none."
        )
