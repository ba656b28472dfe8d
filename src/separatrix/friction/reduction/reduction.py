"""One raw log to friction with its standard error, and everything that was found on the way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction import cycles, flags, steady
from separatrix.friction.reduction.events import (
    Event,
    friction_step,
    kept_rows,
    row_events,
    run_in_rise,
    wear_step,
)
from separatrix.friction.reduction.friction_test import TestFriction
from separatrix.friction.reduction.options import ReductionOptions
from separatrix.friction.reduction.run_in import METHOD, RunIn, run_in
from separatrix.friction.reduction.stick_slip import Oscillation, oscillation
from separatrix.units import Array

__all__ = ["Reduction", "ReductionOptions", "TestFriction", "reduce_log", "reduction"]

GIVEN = "given"
"""How the end of running-in was found, if a user gave it."""

PREFERRED = ("distance", "time", "cycles")
"""Abscissae in the order in which one is chosen to tell ends and drift in."""

DEFAULTS = ReductionOptions()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reduction:
    """A log, its friction, and the series from which its page of plots is drawn."""

    log: RawLog
    test: TestFriction
    rows: slice
    """Rows between loading and the end of the test."""
    stretch: cycles.Stretch
    """What they hold."""
    spans: cycles.Spans
    """Means of the steady part from which its error comes; in cycles where those are known."""
    mean: steady.SteadyMean
    cycle_means: Array
    """Means of whole cycles of the steady part, shape (cycle,); empty where no cycle is known."""
    oscillation: Oscillation
    events: tuple[Event, ...] = ()

    @property
    def steady_friction(self) -> Array:
        """Friction of the rows of the steady part, shape (row,)."""
        return self.stretch.within(self.spans)


def reduce_log(log: RawLog, options: ReductionOptions = DEFAULTS) -> TestFriction:
    """Return the friction of a log with its error; `reduction` gives also what it was made from."""
    return reduction(log, options).test


def reduction(log: RawLog, options: ReductionOptions = DEFAULTS) -> Reduction:
    """Return the friction of a log, its error, flags and series.

    Parameters
    ----------
    log : RawLog
        From `read_log`.
    options : ReductionOptions
        How to reduce it.

    Raises
    ------
    InputError
        The log falls back along its abscissa, lacks the abscissa asked for, or is too short.
    """
    axis = _axis(log, options)
    along = cycles.rising(log, axis)
    _finite(log)
    events = row_events(log, options)
    kept = slice(*kept_rows(events, log.rows))
    clock = cycles.clock(log, along, options)
    stretch, cut, found, notes = _steady(log, clock.stretch(log, along, kept), kept, options)
    parts = _Parts(
        log=log,
        options=options,
        axis=axis,
        along=along,
        events=events,
        clock=clock,
        kept=kept,
        stretch=stretch,
        run_in=found,
        spans=stretch.spans(cut),
        notes=(*clock.notes, *notes),
    )
    return parts.reduction()


def _axis(log: RawLog, options: ReductionOptions) -> str:
    """Return the abscissa in which ends are told."""
    wanted = options.axis if options.cut is None else options.cut[0]
    if options.axis is not None and options.cut is not None and wanted != options.axis:
        wanted = options.axis
    if wanted is None:
        return next(name for name in PREFERRED if name in log.abscissae)
    if wanted not in log.abscissae:
        cure = f"Give it in another; the log has {' and '.join(log.abscissae)}."
        raise InputError(log.source, f"needs a column of {wanted}", "none", cure)
    return wanted


def _finite(log: RawLog) -> None:
    """Refuse friction that is no number; a reader leaves such rows out."""
    bad = np.flatnonzero(~np.isfinite(log.friction))
    if bad.size:
        where = f"{log.source}: friction"
        raise InputError(where, "must be a finite number in each row", f"none in row {bad[0] + 1}")


def _steady(
    log: RawLog, stretch: cycles.Stretch, kept: slice, options: ReductionOptions
) -> tuple[cycles.Stretch, float | None, RunIn | None, tuple[str, ...]]:
    """Return the rows, where on their ruler the steady part begins, how that was found, and what to say.

    If that leaves too few whole cycles, means are over rows.
    """
    notes: tuple[str, ...] = ()
    if stretch.done is not None and not stretch.holds_cycles():
        notes = (_few(*stretch.cycles()),)
        stretch = stretch.of_rows()
        if options.cut is None:  # within a cycle friction may change as it likes
            return stretch, None, RunIn(end=0.0, rest=0.0, ends=True, level=True), notes
    cut, found = _cut(log, stretch, kept, options)
    if stretch.done is not None and not stretch.holds_cycles(cut):
        notes = (_few(*stretch.cycles(cut)),)
        cut, stretch = None if cut is None else stretch.place(cut), stretch.of_rows()
    return stretch, cut, found, notes


def _few(first: int, last: int) -> str:
    return (
        f"The steady part holds {max(0, last - first)} whole cycles, too few for means over whole ones: "
        "its mean is over rows, and what changes within a cycle may shift it."
    )


def _cut(
    log: RawLog, stretch: cycles.Stretch, kept: slice, options: ReductionOptions
) -> tuple[float | None, RunIn | None]:
    """Return where on the ruler the steady part begins (None for the start), and how that was found."""
    if options.cut is not None:
        return _given(log, stretch, kept, *options.cut), None
    spans = stretch.spans()
    found = run_in(spans.means)
    if found.end == 0.0:
        return None, found
    return spans.start + found.end * (spans.end - spans.start), found


def _given(log: RawLog, stretch: cycles.Stretch, kept: slice, axis: str, value: float) -> float:
    """Return the place on the ruler of an end of running-in that a user gave.

    Raises
    ------
    InputError
        The log does not have that abscissa, or ends before it.
    """
    if axis not in log.abscissae:
        cure = f"Give it in another; the log has {' and '.join(log.abscissae)}."
        raise InputError("ReductionOptions.run_in_end", f"needs a column of {axis}", "none", cure)
    column = cycles.rising(log, axis)[kept]
    if value >= column[-1]:
        rule = f"must lie before the end of the test, {flags.at(float(column[-1]), axis)}"
        raise InputError("ReductionOptions.run_in_end", rule, flags.at(value, axis))
    return float(stretch.ruler[int(np.searchsorted(column, value))])


@dataclass(frozen=True, kw_only=True, eq=False)
class _Parts:
    """What the sentences and the numbers of a test are made from."""

    log: RawLog
    options: ReductionOptions
    axis: str
    along: Array
    events: tuple[Event, ...]
    clock: cycles.Clock
    kept: slice
    stretch: cycles.Stretch
    run_in: RunIn | None
    spans: cycles.Spans
    notes: tuple[str, ...]

    def reduction(self) -> Reduction:
        """Return everything together."""
        return Reduction(
            log=self.log,
            test=self.test(),
            rows=self.kept,
            stretch=self.stretch,
            spans=self.spans,
            mean=self.mean,
            cycle_means=self.cycle_means,
            oscillation=self.oscillation,
            events=self.events,
        )

    def test(self) -> TestFriction:
        """Return the numbers of the test."""
        low, high = self.ends
        found = self.oscillation
        return TestFriction(
            source=self.log.source,
            checksum=self.log.checksum,
            conditions=self.log.conditions,
            friction=self.mean.mean,
            standard_error=self.error,
            degrees_of_freedom=self.mean.degrees_of_freedom,
            standard_deviation=float(self.values.std(ddof=1)),
            effective_count=self.effective,
            run_in_end=low,
            run_in_axis=self.axis,
            run_in_method=GIVEN if self.run_in is None else METHOD,
            steady_end=high,
            rows=self.log.rows,
            steady_rows=self.friction.size,
            cycles=self.cycle_means.size,
            drift_rate=self.mean.change / (high - low),
            drift_error=self.mean.change_error / (high - low),
            stick_slip_amplitude=found.amplitude,
            stick_slip_frequency=found.frequency,
            flags=tuple(self.flags()),
        )

    def flags(self) -> Iterator[str]:
        """Yield what a reader should know."""
        low, high = self.ends
        for event in self.events:
            if event.kind != "spike":
                yield flags.event_flag(event, self.told_row(event.row))
        start = float(self.stretch.along[0])
        yield from flags.run_in_flags(self.run_in, self.mean, start, high, low, self.axis)
        rise = run_in_rise(self.stretch.spans(), self.spans.start, self.mean.mean)
        yield from flags.rise_flag(self.told(rise), self.mean.mean, is_end_given=self.run_in is None)
        yield from flags.drift_flag(self.mean, high - low, self.axis, self.options)
        known = self.clock.cycle is not None
        spacing = (high - low) / max(self.friction.size - 1, 1)
        yield from flags.oscillation_flag(
            self.oscillation, self.mean.mean, self.axis, known, spacing, self.options
        )
        spikes = [e for e in self.events if e.kind == "spike" and low <= self.along[e.row] <= high]
        largest = max(spikes, key=lambda event: event.size, default=None)
        yield from flags.spike_flag(spikes, "" if largest is None else self.told_row(largest.row))
        yield from flags.step_flags(self.told(friction_step(self.spans)), self.told(self.wear()))
        yield from flags.length_flags(self.mean, self.error, self.effective, self.friction.size, self.options)
        yield from flags.range_flag(self.mean.mean, self.friction)
        yield from flags.digit_flag(self.mean, *self.last_digit)
        yield from flags.gap_flag(self.spans)
        yield from self.notes

    def told(self, step: tuple[float, float] | None) -> tuple[str, float] | None:
        """Return a step with its place in words."""
        return None if step is None else (flags.at(self.stretch.place(step[0]), self.axis), step[1])

    def told_row(self, row: int) -> str:
        """Return where a row lies, in words."""
        return flags.at(float(self.along[min(row, self.along.size - 1)]), self.axis)

    def wear(self) -> tuple[float, float] | None:
        """Return the place on the ruler and size of a jump of the wear depth in the steady part."""
        depth = self.log.wear_depth
        if depth is None or not np.isfinite(depth).all():
            return None
        spans, ruler = self.spans, self.stretch.ruler
        return wear_step(cycles.means(ruler, depth[self.kept], spans.start, spans.end, spans.means.size))

    @cached_property
    def mean(self) -> steady.SteadyMean:
        """Mean of the steady part."""
        return steady.steady_mean(self.spans.means)

    @cached_property
    def error(self) -> float:
        """Standard error with what may be left of running-in, and that of the last digit."""
        rest = 0.0 if self.run_in is None else self.run_in.rest
        return float(np.linalg.norm((self.mean.standard_error, rest, self.last_digit[1])))

    @cached_property
    def last_digit(self) -> tuple[float, float]:
        """Step in which friction is written, and the error by it."""
        return steady.last_digit(self.friction)

    @cached_property
    def friction(self) -> Array:
        """Friction of the rows of the steady part, shape (row,)."""
        return self.stretch.within(self.spans)

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Both ends of the steady part along the abscissa."""
        return self.stretch.place(self.spans.start), self.stretch.place(self.spans.end)

    @cached_property
    def cycle_means(self) -> Array:
        """Means of the whole cycles of the steady part, shape (cycle,)."""
        return self.stretch.cycle_means(self.spans)

    @property
    def values(self) -> Array:
        """What scatters around the mean: cycles, or rows where none are known."""
        return self.cycle_means if self.cycle_means.size else self.friction

    @cached_property
    def effective(self) -> float:
        """Independent values that would give the same standard error of a straight line's mean."""
        values, error = self.values, self.mean.standard_error
        around = max(0.0, float(values.var(ddof=1)) - self.mean.change**2 / 12.0)
        return float(np.clip(around / error**2, 1.0, values.size)) if error > 0.0 else float(values.size)

    @cached_property
    def oscillation(self) -> Oscillation:
        """Strongest oscillation of the rows of the steady part."""
        first = int(np.searchsorted(self.stretch.ruler, self.spans.start))
        return oscillation(
            self.stretch.along[first : first + self.friction.size], self.friction, self.clock.cycle
        )
