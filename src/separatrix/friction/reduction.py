"""One log to friction with its standard error, events of the test, and what a reader has to consider."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from separatrix.friction import steady
from separatrix.friction.friction_file import Place, in_words
from separatrix.friction.logs.column_map import Conditions, of_log
from separatrix.friction.logs.log import RawLog
from separatrix.friction.logs.names import MEANINGS
from separatrix.friction.steady import LONG, METHOD, RunIn, run_in
from separatrix.friction.wear import NO_WEAR, SampleWear, sample_wear, why_none
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Ratio, format_number, format_quantity

GIVEN = "given"  # how the end of running-in was found, if a user gave it
PREFERRED = ("distance", "time", "cycles")  # the abscissa of ends and drift is the first that a log has
FEWEST_TESTS = 4  # tests from which an outlier can be detected
OUTLIER = 1.5  # friction over the median of the others, or the reverse, from which a test may be an outlier
FAR = 5.0  # distance from that median over the usual one, in standard deviations
RUN_IN_END = "run_in"
"""Where a given end of running-in is refused."""


# --- events and conditions ----------------------------------------------------------------------
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


class Event(NamedTuple):
    """Something that single rows show: a late loading, a lost load, a seizure."""

    row: int  # first row of it; of a loading the first row after it
    is_end: bool  # whether the test ends there
    sentence: str


def _events(log: RawLog, along: Array, axis: str) -> list[Event]:
    """Events of a log in the order of its rows; the abscissa has the shape (row,)."""

    def at(row: int) -> str:
        return in_words(float(along[min(row, along.size - 1)]), axis)

    return sorted([*_force_events(log, at), *_friction_events(log, at)], key=lambda event: event.row)


def _friction_events(log: RawLog, at: Callable[[int], str]) -> Iterator[Event]:
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
            low, high = (format_number(size, 3) for size in (usual, float(smooth[first:last].max())))
            sentence = (
                f"Seizure or a failed film: friction rises from {low} to {high} at {at(row)} and stays up"
            )
            yield Event(row, True, f"{sentence}; the steady part ends before it.")
            return


def _force_events(log: RawLog, at: Callable[[int], str]) -> Iterator[Event]:
    force = log.normal_force
    if force is None or not np.isfinite(force).any():
        return
    usual = float(np.nanmedian(np.abs(force)))
    low = np.abs(force) < FORCE_LOSS * usual
    for first, last in _stretches(low):
        high, least = (format_quantity(x, "N") for x in (usual, float(np.nanmin(np.abs(force[first:last])))))
        if first == 0:
            sentence = f"The normal force reaches its {high} only at {at(last)}: what is before is left out."
            yield Event(last, False, sentence)
        elif last - first >= SMOOTHED or last == log.rows:
            sentence = f"The normal force falls from {high} to {least} at {at(first)}"
            yield Event(first, True, f"{sentence}: the steady part ends before it.")


def _stretches(flag: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first row and row after the last of each stretch of true ones."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flag, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def run_in_rise(spans: steady.Spans, end: float, friction: float) -> tuple[float, float] | None:
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


WATCHED = ("slip_speed", "normal_force", "temperature")  # columns that are conditions
PARTS_COMPARED = 12  # parts of the steady part whose medians are compared
ROWS_OF_A_PART = 20  # rows of a part, at least, but for two parts
CHANGE = 0.1  # share of the median by which a condition may change
WARMER = 20.0  # K by which the temperature may change
NOISE_OF_MEDIANS = 4.0  # standard errors of a median by which noise alone may make two of them differ


def steady_conditions(log: RawLog, rows: slice) -> Conditions:
    """Conditions of a log; those that a column shows are its median over these rows."""
    found: dict[str, Any] = {}
    for name in WATCHED:
        values = _measured(log, name, rows)
        if name in log.measured and values.size:
            found[name] = float(np.median(values))
    before, pressure = log.conditions.normal_force, log.conditions.pressure
    if "pressure" in log.measured and "normal_force" in found and before and pressure:
        found["pressure"] = pressure * found["normal_force"] / before
    try:
        return replace(log.conditions, **found)
    except InputError as error:
        raise of_log(error, log.source) from None


def changes(log: RawLog, rows: slice) -> Iterator[str]:
    """Yield a sentence on each condition that changes within these rows by more than noise and its limit.

    The medians of equal parts are compared, which the speed within a stroke or a single row does not move.
    """
    for name in WATCHED:
        values = _measured(log, name, rows)
        count = int(np.clip(values.size // ROWS_OF_A_PART, 2, PARTS_COMPARED))
        if values.size < 2 * count:
            continue
        parts = np.array_split(values, count)
        middles = np.array([np.median(part) for part in parts])
        scatter = np.median([np.median(np.abs(part - np.median(part))) for part in parts])
        error = 1.25 * 1.4826 * scatter / np.sqrt(values.size / count)
        low, high, usual = float(middles.min()), float(middles.max()), float(np.median(values))
        limit = WARMER if name == "temperature" else CHANGE * usual
        if high - low > limit + NOISE_OF_MEDIANS * error:
            words, unit = name.replace("_", " "), MEANINGS[name]
            texts = [format_quantity(value, unit, 3) for value in (low, high, usual)]
            yield (
                f"The {words} changes between {texts[0]} and {texts[1]} within the steady part: its friction "
                f"is a mean over both, and {texts[2]} is their median. Split the log where the {words} "
                "changes, or set run_in_end behind it."
            )


def _measured(log: RawLog, name: str, rows: slice) -> Array:
    """Finite values of a column in these rows; forces and speeds as magnitudes."""
    column = getattr(log, name)
    if column is None:
        return np.empty(0)
    values = column[rows] if name == "temperature" else np.abs(column[rows])
    return np.asarray(values[np.isfinite(values)])


# --- from a log to its friction -----------------------------------------------------------------
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
    wear: SampleWear = NO_WEAR  # of the sample, by the wear depth that was logged
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
    steady_rows: slice  # rows of the steady part
    stretch: steady.Stretch  # rows in which the contact slid under its load
    run_in: RunIn | None  # how the end of running-in was found; None where it was given
    spans: steady.Spans
    """Means of the steady part from which its error comes; in cycles where those are known."""
    mean: steady.SteadyMean


def reduce_log(log: RawLog, cut: Place | None = None) -> TestFriction:
    """Return the friction of a log with its error; `reduction` returns also what it was made from."""
    return reduction(log, cut).test


def reduction(log: RawLog, cut: Place | None = None) -> Reduction:
    """Return the friction of a log, its error, flags and series; without a cut running-in is looked for.

    Raises
    ------
    InputError
        The log stands still along its abscissa, lacks the abscissa of the cut, or is too short.
    """
    if cut is not None and cut.axis not in log.abscissae:
        cure = f"Give it in another; the log has {' and '.join(log.abscissae)}."
        raise InputError(log.source, f"needs a column of {cut.axis}", "none", cure)
    axis = cut.axis if cut else next(name for name in PREFERRED if name in log.abscissae)
    along = steady.rising(log, axis)
    events = _events(log, along, axis)
    loaded = max((one.row for one in events if not one.is_end), default=0)
    kept = slice(loaded, min((e.row for e in events if e.is_end and e.row > loaded), default=log.rows))
    done, notes = steady.clock(log)
    rows = steady.Stretch(
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
    one = Reduction(
        log=log,
        test=_test(log, steady_conditions(log, steady_rows), axis, stretch, spans, mean, found),
        steady_rows=steady_rows,
        stretch=stretch,
        run_in=found,
        spans=spans,
        mean=mean,
    )
    worn = sample_wear(log, one.test.conditions, steady_rows)
    has_none = log.wear_depth is not None and not worn.wear_coefficient
    sentences = (
        *(event.sentence for event in events),
        *flags(one),
        *notes,
        *more,
        *([why_none(log, one.test.conditions, steady_rows)] if has_none else []),
    )
    return replace(one, test=replace(one.test, flags=sentences, wear=worn))


def _test(
    log: RawLog,
    conditions: Conditions,
    axis: str,
    stretch: steady.Stretch,
    spans: steady.Spans,
    mean: steady.SteadyMean,
    found: RunIn | None,
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
    )


def _steady(
    log: RawLog, stretch: steady.Stretch, kept: slice, given: Place | None
) -> tuple[steady.Stretch, float | None, RunIn | None, tuple[str, ...]]:
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
        column = steady.rising(log, axis)[kept]
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


# --- flags --------------------------------------------------------------------------------------
RATES = {"time": (3600.0, "per h"), "distance": (1000.0, "per km"), "cycles": (1000.0, "per 1000 cycles")}
"""Size and words of the unit of a drift, by the abscissa."""

CHANCE = 0.01  # probability without any drift below which a drift is reported
HALF = 0.5  # share of a test beyond which running-in is reported as long
FEW_ROWS = 36  # rows below which running-in cannot be judged
MOSTLY = 1.4  # standard error over that by noise from which most of it is what may be left of running-in
HIGH = 1.0  # friction above which a wrong column or unit is likelier than a contact


def flags(one: Reduction) -> Iterator[str]:
    """Yield what a reader has to consider about a test."""
    for part in (_rise, _run_in, _drift, _length, _size):
        yield from part(one)
    yield from changes(one.log, one.steady_rows)


def _rise(one: Reduction) -> Iterator[str]:
    """Report where a film fails in running-in."""
    if (rise := run_in_rise(one.stretch.spans(), one.spans.start, one.test.friction)) is not None:
        low, high = format_number(rise[1], 3), format_number(one.test.friction, 3)
        place = in_words(one.stretch.place(rise[0]), one.test.run_in_axis)
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
    mean, rows = one.test.friction, one.log.friction[one.steady_rows]
    low, high = (float(value) for value in np.percentile(rows, (1.0, 99.0)))
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
    if np.ptp(rows) == 0.0:
        yield (
            f"Friction is {format_number(mean)} in every row: the log does not show its noise, "
            "and the interval holds none."
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


# --- the series of a test for its plots ----------------------------------------------------------
COLUMNS = 600
"""Columns into which the rows of a log are gathered."""

Shares = Annotated[Array, "-"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TestCourse:
    """Friction along a test, with what the log has beside it; small, whatever the length of the log.

    Places along the test are in the SI unit of its abscissa. A column of rows has their mean; None where all
    its values are absent.
    """

    __test__ = False

    along: Array  # where each column of rows begins
    low: Shares  # least friction of the rows of a column
    mean: Shares  # their mean
    high: Shares  # largest friction of these rows
    normal_force: Annotated[list[float | None] | None, "N"]  # null where the log has none, as below
    temperature: Annotated[list[float | None] | None, "K"]  # mean of a column
    wear_depth: Annotated[list[float | None] | None, "m"]  # mean of a column
    slip_speed: Annotated[list[float | None] | None, "m/s"]
    span_along: Array  # centres of the spans of the steady part from whose means its error comes
    span_mean: Shares  # those means


def course(one: Reduction) -> TestCourse:
    """Return the series of a test."""
    log, spans = one.log, one.spans
    starts = np.linspace(0, log.rows, min(COLUMNS, log.rows) + 1).astype(np.int64)[:-1]
    along = np.asarray(getattr(log, one.test.run_in_axis), dtype=float)

    def beside(name: str) -> list[float | None] | None:
        column = getattr(log, name)
        return None if column is None else _means(np.asarray(column, dtype=float), starts)

    return TestCourse(
        along=along[starts],
        low=np.minimum.reduceat(log.friction, starts),
        mean=np.add.reduceat(log.friction, starts) / np.diff(np.append(starts, log.rows)),
        high=np.maximum.reduceat(log.friction, starts),
        normal_force=beside("normal_force"),
        temperature=beside("temperature"),
        wear_depth=beside("wear_depth"),
        slip_speed=beside("slip_speed"),
        span_along=np.array([one.stretch.place(float(centre)) for centre in spans.centres]),
        span_mean=spans.means,
    )


def _means(values: Array, starts: NDArray[np.int64]) -> list[float | None]:
    """Return the mean of each column that begins at these rows; None where all its values are absent."""
    there = np.isfinite(values)
    counts = np.add.reduceat(there.astype(float), starts)
    sums = np.add.reduceat(np.where(there, values, 0.0), starts)
    return [float(total / count) if count else None for total, count in zip(sums, counts, strict=True)]
