"""What a reader should know about a test, a plain sentence each, with its numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from separatrix.friction.reduction.cycles import Spans
from separatrix.friction.reduction.events import Event
from separatrix.friction.reduction.options import ReductionOptions
from separatrix.friction.reduction.run_in import RunIn
from separatrix.friction.reduction.steady import LONG, SteadyMean
from separatrix.friction.reduction.stick_slip import Oscillation
from separatrix.units import Array, format_number, format_quantity

RATES = {"time": (3600.0, "per h"), "distance": (1000.0, "per km"), "cycles": (1000.0, "per 1000 cycles")}
"""Size and words in which a drift is told, by the abscissa."""

CHANCE = 0.01
"""Probability without any drift below which a drift is told."""

CLEAR = 0.25
"""Power of an oscillation over that of all the rest from which it is told."""

HALF = 0.5
"""Share of a test beyond which running-in is told to be long."""

FEW_ROWS = 36
"""Rows below which nothing can be said of running-in."""

RESOLVED = 5.0
"""Rows an oscillation below which it may be the image of a faster one."""

MOSTLY = 1.4
"""Standard error over that by noise from which most of it is what may be left of running-in."""

HIGH = 1.0
"""Friction above which a wrong column or unit is likelier than a contact."""

GAP = 0.05
"""Share of the steady part without a row that is told."""


def at(value: float, axis: str) -> str:
    """Return a place along the abscissa as text: ``"12.5 min"``, ``"1.2 km"``, ``"500 cycles"``."""
    if axis == "cycles":
        return f"{format_number(value)} cycles"
    if axis == "distance":
        return f"{format_number(value / 1e3)} km" if value >= 1e4 else format_quantity(value, "m")
    for size, name in ((3600.0, "h"), (60.0, "min")):
        if value >= 3.0 * size:
            return f"{format_number(value / size)} {name}"
    return format_quantity(value, "s")


def run_in_flags(
    found: RunIn | None, mean: SteadyMean, start: float, end: float, cut: float, axis: str
) -> Iterator[str]:
    """Report running-in that is long or does not end, and a steady part that is not level."""
    share = (cut - start) / (end - start)
    rest = 0.0 if found is None else found.rest
    of_mean = f"{format_number(rest, 2)} ({100 * rest / max(abs(mean.mean), 1e-300):.2g} % of the mean)"
    if found is not None and not found.ends:
        yield (
            f"Running-in does not end: friction still changes behind {at(cut, axis)}, {100 * share:.0f} % of "
            f"the test; later parts differ from the mean by up to {of_mean}."
        )
    elif found is not None and not found.level and rest > mean.standard_error:
        yield (
            f"The steady part is not level: its later parts differ from its mean by up to {of_mean}, "
            "which is in the interval."
        )
    if share > HALF and (found is None or found.ends):
        yield f"Running-in takes {100 * share:.0f} % of the test, up to {at(cut, axis)}."


def rise_flag(rise: tuple[str, float] | None, friction: float, *, is_end_given: bool) -> Iterator[str]:
    """Tell of running-in that ends far above where it began, with its place as text and the level before."""
    if rise is None:
        return
    place, before = rise
    low, high = format_number(before, 3), format_number(friction, 3)
    cut = "" if is_end_given else "if running-in ends elsewhere, give run_in_end in the column map; "
    yield (
        f"Friction rises from {low} to {high} near {place}, in or next to what is cut as running-in: "
        f"a failed film, or a genuine rise. Look at the plot; {cut}if the film failed, "
        "give the log only up to the rise."
    )


def drift_flag(mean: SteadyMean, length: float, axis: str, options: ReductionOptions) -> Iterator[str]:
    """Tell of a straight drift that noise would hardly make and that counts."""
    if mean.change_chance >= CHANCE or abs(mean.change) < options.drift_ratio * abs(mean.mean):
        return
    size, words = RATES[axis]
    rate, error = mean.change / length * size, mean.change_error / length * size
    first, last = mean.mean - mean.change / 2, mean.mean + mean.change / 2
    yield (
        f"Friction drifts by {format_number(rate, 3)} {words} (standard error {format_number(error, 2)}), "
        f"from {format_number(first, 3)} to {format_number(last, 3)} over the steady part: "
        "its mean stands for that part, not for its end."
    )


def oscillation_flag(
    found: Oscillation,
    mean: float,
    axis: str,
    is_cycle_known: bool,
    spacing: float,
    options: ReductionOptions,
) -> Iterator[str]:
    """Report an oscillation that is large enough and stands out of the noise, of rows at a spacing."""
    small = found.amplitude < options.stick_slip_ratio * abs(mean)
    if found.amplitude <= 0.0 or small or found.signal_to_noise < CLEAR:
        return
    rate = format_number(found.frequency, 3)
    power = format_number(found.signal_to_noise, 2)
    where = {"time": f"at {rate} Hz", "distance": f"{rate} times per m", "cycles": f"{rate} times per cycle"}
    what = (
        "stick-slip" if is_cycle_known else "stick-slip, or once per turn or stroke (no cycle time is known)"
    )
    rows = 1.0 / (found.frequency * spacing)
    if rows < RESOLVED:
        what = (
            f"with only {format_number(rows, 2)} rows an oscillation it may be stick-slip, run-out or the "
            "image of something faster (aliasing); log more rows to tell them apart"
        )
    yield (
        f"Friction oscillates {where[axis]} by {format_number(found.amplitude, 2)} from peak to peak, "
        f"{100 * found.amplitude / abs(mean):.0f} % of its mean, with {power} times "
        f"the power of all the rest: {what}."
    )


def spike_flag(spikes: Sequence[Event], place: str) -> Iterator[str]:
    """Tell of friction that rises far in the steady part and comes back; the place is of the largest."""
    if spikes:
        usual, size = format_number(spikes[0].usual, 3), format_number(max(e.size for e in spikes), 3)
        often = "once" if len(spikes) == 1 else f"{len(spikes)} times, most"
        yield f"Friction spikes {often} at {place}: from {usual} to {size}, and comes back."


def event_flag(event: Event, begin: str) -> str:
    """Tell of an event that begins or ends the test, at a place along the abscissa."""
    usual = format_number(event.usual, 3)
    if event.kind == "loading":
        force = format_quantity(event.usual, "N")
        return f"The normal force reaches its {force} only at {begin}: what is before is left out."
    if event.kind == "force lost":
        low, force = format_quantity(event.size, "N"), format_quantity(event.usual, "N")
        return f"The normal force falls from {force} to {low} at {begin}: the steady part ends before it."
    size = format_number(event.size, 3)
    return (
        f"Seizure or a failed film: friction rises from {usual} to {size} at {begin} and stays up; "
        "the steady part ends before it."
    )


def step_flags(friction: tuple[str, float] | None, wear: tuple[str, float] | None) -> Iterator[str]:
    """Tell of steps in friction or wear depth, each with its place as text and its size."""
    if friction is not None:
        place, size = friction
        word = f"{'rises' if size > 0 else 'falls'} in one step by {format_number(abs(size), 2)}"
        yield f"Friction {word} at {place}: a wear event, or a new surface."
    if wear is not None:
        place, size = wear
        yield f"Wear depth jumps by {format_quantity(abs(size), 'm', 2)} at {place}: a wear event."


def length_flags(
    mean: SteadyMean, error: float, effective: float, rows: int, options: ReductionOptions
) -> Iterator[str]:
    """Report a test too short for its correlation, where the error is not mostly that of running-in."""
    if rows < FEW_ROWS:
        yield (
            f"The steady part has {rows} rows: too few to see running-in or correlation, and the interval "
            "assumes none."
        )
    elif mean.is_long and error < MOSTLY * mean.standard_error:
        yield (
            f"Friction is correlated over {100 / (np.pi * LONG):.0f} % of the steady part or longer: the "
            "test is too short for its scatter, and the interval may be too narrow."
        )
    elif effective < options.fewest_effective:
        yield (
            f"The steady part holds {format_number(effective, 2)} independent values, fewer than "
            f"{format_number(options.fewest_effective)}: the test is short for its scatter."
        )


def range_flag(mean: float, friction: Array) -> Iterator[str]:
    """Report friction that dry contacts seldom have, in the mean or in one of a hundred rows."""
    low, high = (float(value) for value in np.percentile(friction, (1.0, 99.0)))
    if not 0.0 < mean <= 2.0 or low < 0.0 or high > 2.0:
        numbers = (format_number(value, 3) for value in (mean, low, high))
        yield (
            "Friction lies outside 0 to 2 (mean {}, 98 % of its rows from {} to {}): "
            "check zero, sign and units of the forces.".format(*numbers)
        )
    elif mean > HIGH:
        yield (
            f"Friction {format_number(mean, 3)} is above {format_number(HIGH)}, which dry sliding seldom "
            "reaches: check that its column is not a force, and the units of the forces."
        )


def digit_flag(mean: SteadyMean, step: float, error: float) -> Iterator[str]:
    """Tell of friction whose noise is lost in the last digit of the log."""
    if step == 0.0:
        yield (
            f"Friction is {format_number(mean.mean)} in every row: the log does not show its noise, and the "
            "interval holds none."
        )
    elif error > mean.standard_error:
        yield (
            f"Friction is written in steps of {format_number(step, 2)}, more than its noise: that alone "
            f"makes a standard error of {format_number(error, 2)}."
        )


def gap_flag(spans: Spans) -> Iterator[str]:
    """Tell of a stretch without rows in the steady part."""
    longest = current = 0
    for count in spans.counts:
        current = current + 1 if count == 0 else 0
        longest = max(longest, current)
    share = longest / spans.counts.size
    if share > GAP:
        yield f"No row lies in {100 * share:.0f} % of the steady part in one piece: the mean bridges it."
