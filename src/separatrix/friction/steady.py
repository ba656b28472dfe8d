"""Where running-in ends, and the mean of the steady stretch behind it with its standard error.

Values are means over equal spans of the stretch in which the contact slid under its load, of whole cycles
where these are known.

No shape of running-in is assumed: the steady part is the longest tail of a test whose mean agrees with that
of each later part of it. Let the tail begin at some span. Its mean is compared with the means of all shorter
tails. Without running-in they differ by noise alone, and the variance of the difference of two nested means
is the difference of their variances. The noise is taken from the shorter, later tail, by its lowest cosines,
so that neighbouring values may be alike and running-in is not part of it. The steady part begins at the
earliest place where no difference exceeds noise and `WORTH` together: the method of Lepski [1]_, which keeps
as much of a series as its bias allows. What the later tails still differ by goes into the error. A test that
as a whole is a straight line and noise has a drift, and no running-in.

For the standard error the means over equal spans, their straight line taken off, are projected on cosines of
1, 2, ... half turns over the stretch. Each projection has the variance of the spectral density at its
frequency, and is hardly correlated with another; the mean has that at frequency zero. So the lowest cosines
give the standard error of the mean, with as many degrees of freedom as there are of them, less one for the
line [2]_. How many are low enough is read from the spectrum that fits best by Whittle's likelihood: a level,
and above it a part with one time of correlation. What these spectra still fall over the cosines used is
corrected, each with the weight of its likelihood.

References
----------
.. [1] O. V. Lepskii, "On a problem of adaptive estimation in Gaussian white noise", Theory of Probability and
   its Applications 35 (1991) 454-466.
.. [2] E. Lazarus, D. J. Lewis, J. H. Stock and M. W. Watson, "HAR inference: recommendations for practice",
   Journal of Business & Economic Statistics 36 (2018) 541-559: the equal-weighted cosine estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import dct
from scipy.ndimage import median_filter
from scipy.special import stdtr, stdtrit

from separatrix.friction.logs.log import RawLog
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Ratio, format_number

MOST = 256  # spans into which a test is divided for its statistics, at most
FEWEST_OF_ROWS = 12  # spans, where no cycle is known and there are as many rows
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
        is least steady. Fewer than `FEWEST_OF_ROWS` cycles are divided evenly: together they stay whole.
        """
        if self.done is None:
            begin, end = float(self.along[0]) if start is None else start, float(self.along[-1])
            low, high = np.searchsorted(self.along, begin), np.searchsorted(self.along, end, side="right")
            rows = int(high - low)
            count = min(MOST, max(rows // ROWS_OF_A_SPAN, min(rows, FEWEST_OF_ROWS)))
            if count < FEWEST_ROWS:
                rule = f"needs at least {FEWEST_ROWS} rows of steady friction"
                raise InputError(self.source, rule, str(rows), "Take a longer log, or an earlier run_in_end.")
            return means(self.along, self.friction, begin, end, count)
        first, last = self.cycles(start)
        count = last - first
        if count < FEWEST_OF_ROWS:
            return means(
                self.done, self.friction, float(first), float(last), count * -(-FEWEST_OF_ROWS // count)
            )
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


CONFIDENCE = 0.95  # of the interval
CORNERS = np.geomspace(2.0, 4096.0, 34)
"""Half turns of the stretch at which the correlated part has fallen to half: from a sixth of the
stretch to none."""

FLOORS = np.array([0.0, 0.003, 0.01, 0.03, 0.1, 0.3])  # white part of the spectrum at zero frequency
FLAT = 0.75  # A cosine counts if the fitted spectrum has at least this share of its height at zero there
FEWEST_COSINES, MOST_COSINES = 6, 60
LONG = 4.5  # corner below which the correlation is too long for the stated interval: 7 % of the stretch
ROUNDING = 1e-12  # share of friction below which differences are those of rounding
MIXED = 0.2  # white part from which the correlated one is only a guess
LIKELY = 0.5  # weight of the spectra of a long correlation from which it counts as long: more likely than not


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SteadyMean:
    """Mean, standard error and drift of a stretch."""

    mean: Ratio
    standard_error: Ratio
    degrees_of_freedom: int
    change: Ratio  # of the straight line, from one end of the stretch to the other
    change_error: Ratio  # standard error of `change`
    long_chance: Ratio  # weight of all spectra whose correlation is too long for the stated interval
    density: float  # spectral density at zero frequency, in units of the squares of `cosines`

    @property
    def change_chance(self) -> float:
        """Probability of a change at least as large without any drift."""
        t = abs(self.change) / max(self.change_error, 1e-300)
        return float(2.0 * stdtr(self.degrees_of_freedom, -t))

    @property
    def is_long(self) -> bool:
        """Whether more likely than not the correlation is too long for the error to be trusted."""
        return self.long_chance > LIKELY and self.density > 0.0


def half_width(standard_error: float, degrees_of_freedom: int) -> float:
    """Return half the 95 % interval of Student's t."""
    return float(standard_error * stdtrit(degrees_of_freedom, 0.5 + CONFIDENCE / 2))


def steady_mean(values: Array) -> SteadyMean:
    """Return the mean of a stretch with its standard error, from means over equal spans, shape (span,)."""
    power = cosines(values) ** 2
    shapes, weights, best = fitted_shapes(power)
    flat = 1 + int((shapes[best] >= FLAT).sum())
    count = int(np.clip(flat, FEWEST_COSINES, min(MOST_COSINES, power.size // 2 + 1)))
    heights = power[:count].sum() / shapes[..., : count - 1].sum(axis=-1)
    density = float((weights * heights).sum())
    n, x = values.size, _places(values.size)
    return SteadyMean(
        mean=float(values.mean()),
        standard_error=float(np.sqrt(density / n)),
        degrees_of_freedom=count - 1,
        change=float(x @ values / (x @ x)),
        change_error=float(np.sqrt(density / (x @ x))),
        long_chance=float(weights[np.ix_(CORNERS < LONG, FLOORS < MIXED)].sum()),
        density=density,
    )


def cosines(values: Array) -> Array:
    """Return the projections on cosines 1, 2, ... of a stretch, straight line taken off, shape (span - 1,).

    Under white noise each has the noise's variance, save the first, of which the line takes nearly all.
    """
    x = _places(values.size)
    level = values - values.mean()
    if np.ptp(level) <= ROUNDING * np.abs(values).max():
        return np.zeros(values.size - 1)
    return np.asarray(dct(level - x * (x @ level) / (x @ x), type=2, norm="ortho")[1:], dtype=float)


def fitted_shapes(power: Array) -> tuple[Array, Array, tuple[int, int]]:
    """Return spectra that may be, one at zero frequency, how likely each is, and the place of the likeliest.

    The spectra are at cosines 2, 3, ..., for the straight line has taken the first, shape (corner, floor,
    cosine - 1). How likely is Whittle's likelihood of each, its height at its best, all together one, shape
    (corner, floor).
    """
    shapes = spectrum(np.arange(2.0, power.size + 1.0), CORNERS[:, None, None], FLOORS[:, None])
    height = np.maximum((power[1:] / shapes).mean(axis=-1), 1e-300)
    loss = np.log(height) * (power.size - 1) + np.log(shapes).sum(axis=-1)
    weights = np.exp(-0.5 * (loss - loss.min()))
    corner, floor = np.unravel_index(int(np.argmin(loss)), loss.shape)
    return shapes, np.asarray(weights / weights.sum(), dtype=float), (int(corner), int(floor))


def spectrum(cosine: Array, corner: Array | float, floor: Array | float) -> Array:
    """Return the spectrum of a corner and a floor at some cosines, one at zero; the shapes are broadcast."""
    return np.asarray(floor + (1.0 - floor) * (1.0 / (1.0 + (cosine / corner) ** 2)), dtype=float)


def last_digit(rows: Array) -> Ratio:
    """Return the error that the steps in which a log writes friction leave in a mean.

    A value represents all within half a step of it: a standard error of the step over root 12 [1]_. Noise
    that reaches several steps averages that away: what is left is the characteristic function of a normal
    distribution at one turn in a step [2]_. It is zero where all rows are the same.

    References
    ----------
    .. [1] JCGM 100:2008, Guide to the expression of uncertainty in measurement, F.2.2.1.
    .. [2] B. Widrow and I. Kollar, Quantization Noise, Cambridge University Press 2008: the variance of what
       is rounded, less a twelfth of the step's square, is that of the noise.
    """
    values = np.unique(rows)
    if values.size < 2:
        return 0.0
    step, scatter = float(np.diff(values).min()), float(rows.std())
    if scatter > 10.0 * step:
        return 0.0  # to the last bit
    noise = max(0.0, (scatter / step) ** 2 - 1.0 / 12.0)
    return float(step / np.sqrt(12.0) * np.exp(-2.0 * np.pi**2 * noise))


def _places(count: int) -> Array:
    """Return the middles of equal spans of a stretch of length one around zero."""
    return np.asarray((np.arange(count) + 0.5) / count - 0.5, dtype=float)


METHOD = "longest tail whose mean agrees with that of each later part"
PLACES = 96  # places where the steady part may begin, at most
LATEST = 0.75  # share of the test beyond which no steady part begins
COSINES = 8  # cosines from which the noise of a tail is estimated
CHANCE = 1e-3
"""Probability with which the difference of two tails exceeds noise on one side without running-in."""

WORTH = 0.0075  # change of the mean, as a share of it, for which nothing is cut
SEEN = 0.05
"""Deviation of the first part of a tail, as a share of friction, that is cut however short that part is."""

STRETCH = 1.3  # factor by which the place found may move up to where the differences are noise alone
NOISE = 2.0  # squares of standard errors that are noise in a difference: the rest of it is what may be left
UNEVEN = 0.02  # drift of a tail, as a share of its mean, from which running-in goes on
OUTLIER = 6.0
"""Standard deviations from its neighbours at which a single span is a spike, which is not running-in."""

DRIFT = 0.01  # probability without a drift below which a tail still drifts
EVEN = 3.0
"""Ratio of the power at the lowest cosines to that at the next from which friction wanders or bends."""

FEWEST_TO_SEARCH = 12  # below which running-in is not searched


@dataclass(frozen=True, slots=True, kw_only=True)
class RunIn:
    """End of running-in, as a share of the stretch."""

    end: Ratio
    rest: Ratio
    """Largest difference between the mean behind the end and that of a later part, less its noise [-]."""
    ends: bool
    """Whether an earlier place than the latest will do, and friction does not go on changing behind it."""


def run_in(values: Array) -> RunIn:
    """Return where running-in ends, from means over equal spans, shape (span,)."""
    n = values.size
    if n < FEWEST_TO_SEARCH or np.ptp(values) <= ROUNDING * np.abs(values).max():
        return RunIn(end=0.0, rest=0.0, ends=True)
    # spikes of one or two spans are replaced by the median of their neighbours
    middle = median_filter(values, 5, mode="nearest")
    excess = np.abs(values - middle)
    scatter = 1.4826 * float(np.median(excess))
    values = np.where(excess > OUTLIER * scatter, middle, values) if scatter > 0.0 else values
    line = _without_line(values)
    power = dct(line, type=2, norm="ortho")[1:] ** 2
    even = power[:COSINES].mean() <= EVEN * power[COSINES : 4 * COSINES].mean()  # no slow wander, no curve
    straight = _Tails(line, _without_line)
    if even and straight.first(straight.noise) == 0:
        return straight.from_place(0)
    tails = _Tails(values, lambda tail: tail - tail.mean())
    # differences for which nothing is cut, shape (place, later place)
    part = 1.0 - tails.left[None, :] / tails.left[:, None]
    worth = np.minimum(WORTH, SEEN * part) * np.abs(tails.means)
    first = tails.first(tails.noise + worth)
    if first:
        reach = int(np.searchsorted(tails.starts, STRETCH * tails.starts[first] + 1, side="right")) - 1
        first = max(first, min(tails.first(tails.noise), reach))
    found = tails.from_place(first)
    return replace(found, ends=False) if first and _goes_on(values, int(tails.starts[first])) else found


def _goes_on(values: Array, start: int) -> bool:
    """Return whether the tail still drifts away from what was before it, beyond noise and `UNEVEN`."""
    tail = steady_mean(values[start:])
    away = tail.change * (tail.mean - float(values[:start].mean())) > 0.0
    return away and tail.change_chance < DRIFT and abs(tail.change) > UNEVEN * abs(tail.mean)


class _Tails:
    """The means of all tails of a series, their differences, and what noise makes of those."""

    def __init__(self, values: Array, without: Callable[[Array], Array]) -> None:
        n = values.size
        self.starts = np.unique(np.linspace(0.0, min(LATEST * n, n - COSINES), PLACES + 1).astype(int))
        self.left = (n - self.starts).astype(float)
        self.share = self.starts / n
        self.means = np.cumsum(values[::-1])[::-1][self.starts] / self.left
        self.difference = np.abs(self.means[:, None] - self.means[None, :])
        shorter = np.maximum(1.0 / self.left[None, :] - 1.0 / self.left[:, None], 0.0)
        tails = (dct(without(values[start:]), type=2, norm="ortho") for start in self.starts.tolist())
        densities = np.array([float((tail[1 : COSINES + 1] ** 2).mean()) for tail in tails])
        self.variance = shorter * densities
        self.noise = float(stdtrit(min(COSINES, n - 1), 1.0 - CHANCE)) * np.sqrt(self.variance)

    def first(self, limit: Array) -> int:
        """Return the first tail that agrees with all later ones within a limit; the last always does."""
        earlier = np.tril(np.ones_like(limit, dtype=bool))
        return int(np.argmax((earlier | (self.difference <= limit)).all(axis=1)))

    def from_place(self, place: int) -> RunIn:
        """Return the end of running-in at a place."""
        square = (self.difference[place] ** 2 - NOISE * self.variance[place])[place:]
        rest = float(np.sqrt(max(0.0, float(square.max()))))
        return RunIn(end=float(self.share[place]), rest=rest, ends=place < self.starts.size - 1)


def _without_line(values: Array) -> Array:
    x = np.arange(values.size) - (values.size - 1) / 2.0
    return np.asarray(values - values.mean() - x * (x @ values) / (x @ x))
