"""One log to friction with its standard error, and everything that was found on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from separatrix.friction.file import in_words
from separatrix.friction.logs.log import Conditions, RawLog
from separatrix.friction.reduction import cycles, steady
from separatrix.friction.reduction.conditions import steady_conditions
from separatrix.friction.reduction.flags import Event, flags, kept_rows, row_events
from separatrix.friction.reduction.steady import METHOD, RunIn, run_in
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Ratio, format_number

GIVEN = "given"  # how the end of running-in was found, if a user gave it
PREFERRED = ("distance", "time", "cycles")  # the abscissa of ends and drift is the first that a log has
FEWEST_TESTS = 4  # tests from which an outlier can be detected
OUTLIER = 1.5  # friction over the median of the others, or the reverse, from which a test may be an outlier
FAR = 5.0  # distance from that median over the usual one, in standard deviations
RUN_IN_END = "run_in"
"""Where a given end of running-in is refused."""

Cut = tuple[str, float]
"""A given end of running-in: its abscissa, and the place there in SI units, as from `friction.file.place`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TestFriction:
    """Friction of one test, with its error and flags."""

    __test__ = False

    source: str  # name of the file, and of the part of it
    checksum: str  # SHA-256 of the file
    conditions: Conditions  # under which it was run; measured ones over the steady part
    friction: Ratio  # mean over the steady part
    standard_error: Ratio
    """Of that mean: neighbouring values are alike, some running-in may be left, digits are few."""
    degrees_of_freedom: int  # of Student's t for its interval
    standard_deviation: Ratio
    """Of the means of whole cycles in the steady part; of its rows where no cycle is known."""
    effective_count: float  # independent values that would have the same standard error
    run_in_end: float  # in the SI unit of `run_in_axis`; the steady part begins here
    run_in_axis: str  # ``"time"``, ``"distance"`` or ``"cycles"``
    run_in_method: str  # how the end of running-in was found
    steady_end: float  # where the steady part ends, in the SI unit of `run_in_axis`
    rows: int  # of the log
    steady_rows: int  # of them in the steady part
    cycles: int  # whole cycles averaged; 0 where none are
    drift_rate: float  # change of friction per SI unit of `run_in_axis`, over the steady part
    drift_error: float  # standard error of `drift_rate`
    stick_slip_amplitude: Ratio
    """Peak to peak, of the strongest oscillation that is not the cycle's; 0 if none exceeds the noise."""
    stick_slip_frequency: float
    """Of that oscillation, per SI unit of `run_in_axis`; 0 if none exceeds the noise."""
    flags: tuple[str, ...] = ()  # what a reader has to consider, a sentence each

    @property
    def half_width(self) -> Ratio:
        """Half the 95 % interval of `friction`."""
        return steady.half_width(self.standard_error, self.degrees_of_freedom)

    @property
    def interval(self) -> tuple[Ratio, Ratio]:
        """Lower and upper end of the 95 % interval of `friction`."""
        return self.friction - self.half_width, self.friction + self.half_width


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reduction:
    """A log, its friction, and the series from which its page of plots is drawn."""

    log: RawLog
    test: TestFriction
    rows: slice  # rows between loading and the end of the test
    steady_rows: slice  # rows of the steady part
    along: Array  # abscissa of every row of the log, shape (row,)
    stretch: cycles.Stretch  # rows in which the contact slid under its load
    run_in: RunIn | None  # how the end of running-in was found; None where it was given
    spans: cycles.Spans
    """Means of the steady part from which its error comes; in cycles where those are known."""
    mean: steady.SteadyMean
    steady_friction: Array  # friction of the rows of the steady part, shape (row,)
    cycle_means: Array
    """Means of whole cycles of the steady part, shape (cycle,); empty where no cycle is known."""
    oscillation: cycles.Oscillation
    events: tuple[Event, ...] = ()


def reduce_log(log: RawLog, cut: Cut | None = None) -> TestFriction:
    """Return the friction of a log with its error; `reduction` returns also what it was made from."""
    return reduction(log, cut).test


def reduction(log: RawLog, cut: Cut | None = None) -> Reduction:
    """Return the friction of a log, its error, flags and series; without a cut running-in is looked for.

    Raises
    ------
    InputError
        The log runs backwards along its abscissa, lacks the abscissa of the cut, or is too short.
    """
    if cut is not None and cut[0] not in log.abscissae:
        cure = f"Give it in another; the log has {' and '.join(log.abscissae)}."
        raise InputError(log.source, f"needs a column of {cut[0]}", "none", cure)
    axis = cut[0] if cut else next(name for name in PREFERRED if name in log.abscissae)
    along = cycles.rising(log, axis)
    bad = np.flatnonzero(~np.isfinite(log.friction))
    if bad.size:
        where = f"{log.source}: friction"
        raise InputError(where, "must be a finite number in each row", f"none in row {bad[0] + 1}")
    events = row_events(log)
    kept = slice(*kept_rows(events, log.rows))
    done, cycle, notes = cycles.clock(log, along)
    rows = cycles.Stretch(
        source=log.source,
        along=along[kept],
        friction=log.friction[kept],
        done=None if done is None else done[kept],
    )
    stretch, start, found, more = _steady(log, rows, kept, cut)
    spans = stretch.spans(start)
    mean = steady.steady_mean(spans.means)
    friction, first = stretch.within(spans), int(np.searchsorted(stretch.ruler, spans.start))
    steady_rows = slice(kept.start + first, kept.start + first + friction.size)
    strongest = cycles.oscillation(stretch.along[first : first + friction.size], friction, cycle)
    one = Reduction(
        log=log,
        test=_test(log, steady_conditions(log, steady_rows), axis, stretch, spans, mean, found, strongest),
        rows=kept,
        steady_rows=steady_rows,
        along=along,
        stretch=stretch,
        run_in=found,
        spans=spans,
        mean=mean,
        steady_friction=friction,
        cycle_means=stretch.cycle_means(spans),
        oscillation=strongest,
        events=events,
    )
    return replace(one, test=replace(one.test, flags=(*flags(one), *notes, *more)))


def _test(
    log: RawLog,
    conditions: Conditions,
    axis: str,
    stretch: cycles.Stretch,
    spans: cycles.Spans,
    mean: steady.SteadyMean,
    found: RunIn | None,
    oscillation: cycles.Oscillation,
) -> TestFriction:
    """Return the numbers of a test, without its flags."""
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
        conditions=conditions,
        friction=mean.mean,
        standard_error=float(np.linalg.norm((error, rest, steady.last_digit(friction)))),
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
        stick_slip_amplitude=oscillation.amplitude,
        stick_slip_frequency=oscillation.frequency,
    )


def _steady(
    log: RawLog, stretch: cycles.Stretch, kept: slice, given: Cut | None
) -> tuple[cycles.Stretch, float | None, RunIn | None, tuple[str, ...]]:
    """Return the rows, where on their ruler the steady part begins, how that was found, and notes.

    Without a beginning it is that of the rows. If too few whole cycles are left, means are over rows.
    """
    notes: tuple[str, ...] = ()
    if stretch.done is not None and not stretch.holds_cycles():
        notes = (_few(*stretch.cycles()),)
        stretch = replace(stretch, done=None)
        if given is None:  # within a cycle friction may change as it likes
            return stretch, None, RunIn(end=0.0, rest=0.0, ends=True), notes
    cut: float | None = None
    found: RunIn | None = None
    if given is None:
        spans = stretch.spans()
        found = run_in(spans.means)
        cut = spans.start + found.end * (spans.end - spans.start) if found.end else None
    else:
        axis, value = given
        column = cycles.rising(log, axis)[kept]
        if value >= column[-1]:
            rule = f"must lie before the end of the test, {in_words(float(column[-1]), axis)}"
            raise InputError(RUN_IN_END, rule, in_words(value, axis))
        cut = float(stretch.ruler[int(np.searchsorted(column, value))])
    if stretch.done is not None and not stretch.holds_cycles(cut):
        notes = (_few(*stretch.cycles(cut)),)
        cut, stretch = None if cut is None else stretch.place(cut), replace(stretch, done=None)
    return stretch, cut, found, notes


def _few(first: int, last: int) -> str:
    return (
        f"The steady part holds {max(0, last - first)} whole cycles, too few for means over whole ones: "
        "its mean is over rows, and what changes within a cycle may shift it."
    )


def with_outliers(reductions: Sequence[Reduction]) -> list[Reduction]:
    """Return the reductions, with a flag on each test far from the others: a wrong column, or a failed film.

    The others are those of its material and environment, or those of all materials of its environment where
    there are too few of its own.
    """
    found = list(reductions)
    for i, one in enumerate(reductions):
        own, whose = one.test.conditions, ""
        near = [two.test for k, two in enumerate(reductions) if k != i]
        near = [test for test in near if test.conditions.environment == own.environment]
        others = [test.friction for test in near if test.conditions.material == own.material]
        if len(others) + 1 < FEWEST_TESTS:
            others, whose = [test.friction for test in near], " of all materials"
        if len(others) + 1 < FEWEST_TESTS or min(one.test.friction, *others) <= 0.0:
            continue
        logs = np.log(others)
        middle = float(np.median(logs))
        scatter = 1.4826 * float(np.median(np.abs(logs - middle)))
        if abs(float(np.log(one.test.friction)) - middle) <= max(np.log(OUTLIER), FAR * scatter):
            continue
        usual = float(np.exp(middle))
        flag = (
            f"Friction {format_number(one.test.friction, 3)} is "
            f"{format_number(one.test.friction / usual, 2)} times the median of the other {len(others)} "
            f"tests{whose}, {format_number(usual, 3)}: check its material, its column and its plot."
        )
        found[i] = replace(one, test=replace(one.test, flags=(*one.test.flags, flag)))
    return found
