"""Oscillation of friction that stands out of its noise: stick-slip, or a cycle that nobody told of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import percentile_filter
from scipy.signal import welch
from scipy.special import gammaincc

from separatrix.units import Array, Ratio

SEGMENTS = 8
"""Parts of the test whose spectra are averaged, overlapping by half."""

LONGEST, SHORTEST = 4096, 64
"""Rows of a segment."""

CHANCE = 1e-4
"""Probability with which noise alone would show a line as strong somewhere in the spectrum."""

BESIDE = 8
"""Places on each side of a line from which the noise is told; the two next to it are left out."""

LOWEST = 12
"""First place of a spectrum where a line is looked for: below there is no noise to its left."""

HARMONICS = 12
"""Multiples of the cycle that are its own."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Oscillation:
    """The strongest line of the spectrum of friction."""

    frequency: float
    """In cycles per SI unit of the abscissa; 0 if no line stands out."""
    amplitude: Ratio
    """Peak to peak of the sine with its power [-]; 0 if no line stands out."""
    signal_to_noise: float
    """Its power over all other power."""
    frequencies: Array
    density: Array
    """Spectral density of friction at the frequencies."""


NONE = Oscillation(
    frequency=0.0, amplitude=0.0, signal_to_noise=0.0, frequencies=np.empty(0), density=np.empty(0)
)


def oscillation(along: Array, friction: Array, cycle: float | None) -> Oscillation:
    """Return the strongest oscillation that is none of the cycle's.

    Parameters
    ----------
    along, friction : ndarray
        Abscissa and friction of the steady rows, shape (row,) each.
    cycle : float or None
        Length of a cycle in the unit of the abscissa.
    """
    span = float(along[-1] - along[0])
    if span <= 0.0 or along.size < SHORTEST:
        return NONE
    step = span / (along.size - 1)
    even = np.interp(along[0] + step * np.arange(along.size), along, friction)
    length = int(np.clip(along.size // SEGMENTS, SHORTEST, LONGEST))
    frequencies, density = welch(even, 1.0 / step, nperseg=length, detrend="constant")
    found = _line(frequencies, density, cycle, averages=2 * even.size / length - 1)
    if found is None:
        return _of(0.0, 0.0, 0.0, frequencies, density)
    line, noise = found
    power = _power(density, noise, line) * frequencies[1]
    rest = max(float(density.sum() * frequencies[1]) - power, 1e-300)
    frequency = float(np.average(frequencies[line - 1 : line + 2], weights=density[line - 1 : line + 2]))
    return _of(frequency, float(np.sqrt(8.0 * power)), power / rest, frequencies, density)


def _of(frequency: float, amplitude: float, ratio: float, frequencies: Array, density: Array) -> Oscillation:
    return Oscillation(
        frequency=frequency,
        amplitude=amplitude,
        signal_to_noise=ratio,
        frequencies=np.asarray(frequencies, dtype=float),
        density=np.asarray(density, dtype=float),
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


def _line(
    frequencies: Array, density: Array, cycle: float | None, averages: float
) -> tuple[int, Array] | None:
    """Return the place of the strongest line and the noise, if noise alone would hardly make it."""
    noise = np.maximum(beside(density), 1e-300)
    ratio = np.where(_own(frequencies, cycle), 0.0, density / noise)
    place = np.arange(ratio.size)
    ratio[(place < LOWEST) | (place > ratio.size - 2)] = 0.0
    strongest = int(np.argmax(ratio * density * (ratio > _limit(ratio.size, averages))))
    return (strongest, noise) if ratio[strongest] > _limit(ratio.size, averages) else None


def _own(frequencies: Array, cycle: float | None) -> Array:
    """Return where the cycle and its multiples lie, to two places."""
    if cycle is None:
        return np.zeros(frequencies.size, dtype=bool)
    order = np.clip(np.round(frequencies * cycle), 1, HARMONICS)
    return np.asarray(np.abs(frequencies - order / cycle) <= 2.5 * frequencies[1])


def _limit(places: int, averages: float) -> float:
    """Return the density over the noise that one of so many places passes with the probability `CHANCE`.

    The mean of n overlapping spectra is a chi-square with about 1.9 n degrees of freedom (Welch's window).
    """
    half = max(1.0, 0.95 * averages)
    ratios = np.geomspace(1.0, 60.0, 400)
    return float(ratios[np.argmax(places * gammaincc(half, half * ratios) < CHANCE)])


def _power(density: Array, noise: Array, line: int) -> float:
    """Return the density above the noise of a line and of those next to it that belong to it."""
    reach = 3 + line // 20
    part = slice(max(0, line - reach), line + reach + 1)
    return float(np.maximum(density[part] - noise[line], 0.0).sum())
