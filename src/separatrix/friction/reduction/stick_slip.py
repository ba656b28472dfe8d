"""Oscillation of friction that exceeds its noise: stick-slip, or a cycle of unknown length."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
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
"""Places on each side of a line from which the noise is estimated; the two next to it are left out."""

LOWEST = 12
"""First place of a spectrum where a line is looked for: there is no noise to the left of lower ones."""

ROUNDING = 1e-12
"""Share of friction below which differences are those of rounding."""

HARMONICS = 12
"""Multiples of the cycle that are its own."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Oscillation:
    """The strongest line of the spectrum of friction."""

    frequency: float
    """In cycles per SI unit of the abscissa; 0 if no line exceeds the noise."""
    amplitude: Ratio
    """Peak to peak of the sine with its power [-]; 0 if no line exceeds the noise."""
    signal_to_noise: float
    """Its power over all other power but the cycle's."""
    frequencies: Array
    density: Array
    """Spectral density of friction at the frequencies."""


NONE = Oscillation(
    frequency=0.0, amplitude=0.0, signal_to_noise=0.0, frequencies=np.empty(0), density=np.empty(0)
)


def oscillation(along: Array, friction: Array, cycle: float | None) -> Oscillation:
    """Return the strongest oscillation that is not one of the cycle's.

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
