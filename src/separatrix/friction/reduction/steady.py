"""Mean of a steady stretch and its standard error, when neighbouring values are alike and drift.

The means over equal spans, their straight line taken off, are projected on cosines of 1, 2, ... half turns
over the stretch. Each projection has the variance of the spectral density at its frequency, and is hardly
correlated with another; the mean has that at frequency zero. So the lowest cosines give the standard error of
the mean, with as many degrees of freedom as there are of them, less one for the line [1]_. How many are low
enough is read from the spectrum that fits best by Whittle's likelihood: a level, and above it a part with one
time of correlation. What these spectra still fall over the cosines used is corrected, each with the weight of
its likelihood.

An oscillation is the strongest line of the spectrum of the rows that exceeds its noise.

References
----------
.. [1] E. Lazarus, D. J. Lewis, J. H. Stock and M. W. Watson, "HAR inference: recommendations for practice",
   Journal of Business & Economic Statistics 36 (2018) 541-559: the equal-weighted cosine estimate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct
from scipy.ndimage import percentile_filter
from scipy.signal import welch
from scipy.special import gammaincc, stdtr, stdtrit

from separatrix.units import Array, Ratio

LEVEL = 0.95  # of the interval
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
    corner: float
    """Half turns of the stretch at which the correlated part of the spectrum has fallen to half [-]."""
    floor: Ratio  # white part of the spectrum at zero frequency
    long_chance: Ratio  # weight of all spectra whose correlation is too long for the stated interval
    power: Array  # squares of the projections on cosines 1, 2, ..., shape (cosine,) [-]
    density: float  # spectral density at zero frequency, in units of `power`

    @property
    def change_chance(self) -> float:
        """Probability of a change at least as large without any drift."""
        t = abs(self.change) / max(self.change_error, 1e-300)
        return float(2.0 * stdtr(self.degrees_of_freedom, -t))

    @property
    def correlation(self) -> Ratio:
        """Time of correlation, as a share of the stretch: that of the correlated part."""
        return 1.0 / (np.pi * self.corner)

    @property
    def is_long(self) -> bool:
        """Whether more likely than not the correlation is too long for the error to be trusted."""
        return self.long_chance > LIKELY and self.density > 0.0


def half_width(standard_error: float, degrees_of_freedom: int) -> float:
    """Return half the 95 % interval of Student's t."""
    return float(standard_error * stdtrit(degrees_of_freedom, 0.5 + LEVEL / 2))


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
        corner=float(CORNERS[best[0]]),
        floor=float(FLOORS[best[1]]),
        long_chance=float(weights[np.ix_(CORNERS < LONG, FLOORS < MIXED)].sum()),
        power=power,
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
    """Return spectra that may be, one at zero frequency, how likely each is, and the most likely one's place.

    The first cosine is left out, for the straight line has taken it.

    Returns
    -------
    tuple
        Spectra at cosines 2, 3, ..., shape (corner, floor, cosine - 1); Whittle's likelihood of each, its
        height at its best, all together one, shape (corner, floor); place of the largest.
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


def last_digit(rows: Array) -> tuple[Ratio, Ratio]:
    """Return the step in which a log writes friction, and the error that it leaves in a mean.

    A value represents all within half a step of it: a standard error of the step over root 12 [1]_. Noise
    that reaches several steps averages that away: what is left is the characteristic function of a normal
    distribution at one turn in a step [2]_. Both are zero where all rows are the same.

    References
    ----------
    .. [1] JCGM 100:2008, Guide to the expression of uncertainty in measurement, F.2.2.1.
    .. [2] B. Widrow and I. Kollar, Quantization Noise, Cambridge University Press 2008: the variance of what
       is rounded, less a twelfth of the step's square, is that of the noise.
    """
    values = np.unique(rows)
    if values.size < 2:
        return 0.0, 0.0
    step, scatter = float(np.diff(values).min()), float(rows.std())
    if scatter > 10.0 * step:
        return step, 0.0  # to the last bit
    noise = max(0.0, (scatter / step) ** 2 - 1.0 / 12.0)
    return step, float(step / np.sqrt(12.0) * np.exp(-2.0 * np.pi**2 * noise))


def _places(count: int) -> Array:
    """Return the middles of equal spans of a stretch of length one around zero."""
    return np.asarray((np.arange(count) + 0.5) / count - 0.5, dtype=float)


SEGMENTS = 8  # parts of the test whose spectra are averaged, overlapping by half
LONGEST, SHORTEST = 4096, 64  # rows of a segment
CHANCE = 1e-4  # probability with which noise alone would show a line as strong somewhere in the spectrum
BESIDE = 8  # places on each side of a line from which the noise is estimated; the two next to it are left out
LOWEST = 12
"""First place of a spectrum where a line is looked for: there is no noise to the left of lower ones."""

HARMONICS = 12  # multiples of the cycle that are its own


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Oscillation:
    """The strongest line of the spectrum of friction."""

    frequency: float  # in cycles per SI unit of the abscissa; 0 if no line exceeds the noise
    amplitude: Ratio  # peak to peak of the sine with its power [-]; 0 if no line exceeds the noise
    signal_to_noise: float  # its power over all other power but the cycle's
    frequencies: Array
    density: Array  # spectral density of friction at the frequencies


NONE = Oscillation(
    frequency=0.0, amplitude=0.0, signal_to_noise=0.0, frequencies=np.empty(0), density=np.empty(0)
)


def oscillation(along: Array, friction: Array, cycle: float | None) -> Oscillation:
    """Return the strongest oscillation of rows, shape (row,), that is not one of the cycle's.

    The length of the cycle is in the unit of the abscissa; None where it is not known.
    """
    span = float(along[-1] - along[0])
    if span <= 0.0 or along.size < SHORTEST:
        return NONE
    step = span / (along.size - 1)
    even = np.interp(along[0] + step * np.arange(along.size), along, friction)
    length = int(np.clip(along.size // SEGMENTS, SHORTEST, LONGEST))
    frequencies, density = welch(even, 1.0 / step, nperseg=length, detrend="constant")
    noise = np.maximum(beside(density), 1e-300)
    other = np.where(_own(frequencies, density, cycle), np.minimum(density, noise), density)
    line = _line(other, noise, averages=2 * even.size / length - 1)
    if line is None or np.ptp(even) <= ROUNDING * np.abs(even).max():
        return replace(NONE, frequencies=frequencies, density=density)
    reach = 3 + line // 20  # of the places next to the line that belong to it
    part = slice(max(0, line - reach), line + reach + 1)
    power = float(np.maximum(other[part] - noise[line], 0.0).sum()) * frequencies[1]
    rest = max(float(other.sum() * frequencies[1]) - power, 1e-300)
    frequency = float(np.average(frequencies[line - 1 : line + 2], weights=density[line - 1 : line + 2]))
    return Oscillation(
        frequency=frequency,
        amplitude=float(np.sqrt(8.0 * power)),
        signal_to_noise=power / rest,
        frequencies=frequencies,
        density=density,
    )


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
