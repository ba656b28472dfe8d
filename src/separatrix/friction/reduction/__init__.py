"""One log to friction with its standard error, and everything that was found on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import RawLog
from separatrix.friction.records import in_words
from separatrix.friction.reduction import cycles, steady
from separatrix.friction.reduction.events import Event, kept_rows, row_events
from separatrix.friction.reduction.flags import flags
from separatrix.friction.reduction.records import ReductionOptions, TestFriction
from separatrix.friction.reduction.run_in import METHOD, RunIn, run_in
from separatrix.friction.reduction.steady import Oscillation, oscillation
from separatrix.units import Array, format_number

__all__ = ["Reduction", "ReductionOptions", "TestFriction", "reduce_log", "reduction", "with_outliers"]

GIVEN = "given"  # how the end of running-in was found, if a user gave it
PREFERRED = ("distance", "time", "cycles")  # abscissae in the order in which one is chosen for ends and drift
FEWEST_TESTS = 4  # tests from which an outlier can be detected
OUTLIER = 1.5  # friction over the median of the others, or the reverse, from which a test may be an outlier
FAR = 5.0  # distance from that median over the usual one, in standard deviations


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reduction:
    """A log, its friction, and the series from which its page of plots is drawn."""

    log: RawLog
    test: TestFriction
    options: ReductionOptions
    rows: slice
    """Rows between loading and the end of the test."""
    along: Array
    """Abscissa of every row of the log, shape (row,)."""
    stretch: cycles.Stretch
    """Rows in which the contact slid under its load."""
    cycle: float | None
    """Length of a cycle in the unit of the abscissa; None where it is not known."""
    run_in: RunIn | None
    """How the end of running-in was found; None where it was given."""
    spans: cycles.Spans
    """Means of the steady part from which its error comes; in cycles where those are known."""
    mean: steady.SteadyMean
    steady_friction: Array
    """Friction of the rows of the steady part, shape (row,)."""
    last_digit: tuple[float, float]
    """Step in which friction is written, and the standard error that it causes."""
    cycle_means: Array
    """Means of whole cycles of the steady part, shape (cycle,); empty where no cycle is known."""
    oscillation: Oscillation
    events: tuple[Event, ...] = ()


def reduce_log(log: RawLog, options: ReductionOptions | None = None) -> TestFriction:
    """Return the friction of a log with its error; `reduction` returns also what it was made from."""
    return reduction(log, options).test


def reduction(log: RawLog, options: ReductionOptions | None = None) -> Reduction:
    """Return the friction of a log, its error, flags and series.

    Parameters
    ----------
    log : RawLog
        From `read_log`.
    options : ReductionOptions, optional
        How to reduce it.

    Raises
    ------
    InputError
        The log runs backwards along its abscissa, lacks the abscissa of the options, or is too short.
    """
    options = options or ReductionOptions()
    axis = _axis(log, options)
    along = cycles.rising(log, axis)
    bad = np.flatnonzero(~np.isfinite(log.friction))
    if bad.size:
        where = f"{log.source}: friction"
        raise InputError(where, "must be a finite number in each row", f"none in row {bad[0] + 1}")
    events = row_events(log, options)
    kept = slice(*kept_rows(events, log.rows))
    clock = cycles.clock(log, along, options)
    rows = cycles.Stretch(
        source=log.source,
        along=along[kept],
        friction=log.friction[kept],
        done=None if clock.done is None else clock.done[kept],
    )
    stretch, cut, found, notes = _steady(log, rows, kept, options)
    spans = stretch.spans(cut)
    mean = steady.steady_mean(spans.means)
    friction = stretch.within(spans)
    first = int(np.searchsorted(stretch.ruler, spans.start))
    one = Reduction(
        log=log,
        test=_test(log, axis, stretch, spans, mean, found),
        options=options,
        rows=kept,
        along=along,
        stretch=stretch,
        cycle=clock.cycle,
        run_in=found,
        spans=spans,
        mean=mean,
        steady_friction=friction,
        last_digit=steady.last_digit(friction),
        cycle_means=stretch.cycle_means(spans),
        oscillation=oscillation(stretch.along[first : first + friction.size], friction, clock.cycle),
        events=events,
    )
    test = replace(
        one.test,
        stick_slip_amplitude=one.oscillation.amplitude,
        stick_slip_frequency=one.oscillation.frequency,
    )
    one = replace(one, test=test)
    return replace(one, test=replace(test, flags=(*flags(one), *clock.notes, *notes)))


def _test(
    log: RawLog,
    axis: str,
    stretch: cycles.Stretch,
    spans: cycles.Spans,
    mean: steady.SteadyMean,
    found: RunIn | None,
) -> TestFriction:
    """Return the numbers of a test, without its oscillation and its flags."""
    friction, whole = stretch.within(spans), stretch.cycle_means(spans)
    low, high = stretch.place(spans.start), stretch.place(spans.end)
    values = whole if whole.size else friction
    # independent values that would have the same standard error of a straight line's mean
    around = max(0.0, float(values.var(ddof=1)) - mean.change**2 / 12.0)
    error = mean.standard_error
    effective = float(np.clip(around / error**2, 1.0, values.size)) if error > 0.0 else float(values.size)
    rest = 0.0 if found is None else found.rest
    return TestFriction(
        source=log.source,
        checksum=log.checksum,
        conditions=log.conditions,
        friction=mean.mean,
        standard_error=float(np.linalg.norm((error, rest, steady.last_digit(friction)[1]))),
        degrees_of_freedom=mean.degrees_of_freedom,
        standard_deviation=float(values.std(ddof=1)),
        effective_count=effective,
        run_in_end=low,
        run_in_axis=axis,
        run_in_method=GIVEN if found is None else METHOD,
        steady_end=high,
        rows=log.rows,
        steady_rows=friction.size,
        cycles=whole.size,
        drift_rate=mean.change / (high - low),
        drift_error=mean.change_error / (high - low),
        stick_slip_amplitude=0.0,
        stick_slip_frequency=0.0,
    )


def _axis(log: RawLog, options: ReductionOptions) -> str:
    """Return the abscissa of ends and drift."""
    wanted = options.axis or (options.cut[0] if options.cut else None)
    if wanted is None:
        return next(name for name in PREFERRED if name in log.abscissae)
    if wanted not in log.abscissae:
        raise _no_column(log, log.source, wanted)
    return wanted


def _no_column(log: RawLog, where: str, axis: str) -> InputError:
    cure = f"Give it in another; the log has {' and '.join(log.abscissae)}."
    return InputError(where, f"needs a column of {axis}", "none", cure)


def _steady(
    log: RawLog, stretch: cycles.Stretch, kept: slice, options: ReductionOptions
) -> tuple[cycles.Stretch, float | None, RunIn | None, tuple[str, ...]]:
    """Return the rows, where on their ruler the steady part begins, how that was found, and notes.

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
    if options.cut is None:
        spans = stretch.spans()
        found = run_in(spans.means)
        return (spans.start + found.end * (spans.end - spans.start) if found.end else None), found
    axis, value = options.cut
    where = "ReductionOptions.run_in_end"
    if axis not in log.abscissae:
        raise _no_column(log, where, axis)
    column = cycles.rising(log, axis)[kept]
    if value >= column[-1]:
        rule = f"must lie before the end of the test, {in_words(float(column[-1]), axis)}"
        raise InputError(where, rule, in_words(value, axis))
    return float(stretch.ruler[int(np.searchsorted(column, value))]), None


def with_outliers(reductions: Sequence[Reduction]) -> list[Reduction]:
    """Return the reductions, with a flag on each test far from the others: a wrong column, or a failed film.

    The others are those of its material and environment, or those of all materials of its environment where
    there are too few of its own.
    """
    found = list(reductions)
    for i, one in enumerate(reductions):
        own = one.test.conditions
        others = [
            other.test
            for k, other in enumerate(reductions)
            if k != i and other.test.conditions.environment == own.environment
        ]
        same = [test.friction for test in others if test.conditions.material == own.material]
        few = len(same) + 1 < FEWEST_TESTS
        flag = _outlier(
            one.test.friction,
            [test.friction for test in others] if few else same,
            " of all materials" if few else "",
        )
        if flag:
            found[i] = replace(one, test=replace(one.test, flags=(*one.test.flags, flag)))
    return found


def _outlier(friction: float, others: Sequence[float], whose: str) -> str:
    """Return a sentence on a friction far from the others; empty for one among them."""
    if len(others) + 1 < FEWEST_TESTS or friction <= 0.0 or min(others) <= 0.0:
        return ""
    logs = np.log(others)
    middle = float(np.median(logs))
    scatter = 1.4826 * float(np.median(np.abs(logs - middle)))
    if abs(float(np.log(friction)) - middle) <= max(np.log(OUTLIER), FAR * scatter):
        return ""
    usual = float(np.exp(middle))
    return (
        f"Friction {format_number(friction, 3)} is {format_number(friction / usual, 2)} times the median of "
        f"the other {len(others)} tests{whose}, {format_number(usual, 3)}: check its material, its column "
        "and its plot."
    )
