"""Where running-in ends: a fall fitted in correlated noise, cut where what is left of it does not count.

A straight line and an excess that falls, A exp(-x/L) or A (1 - x/L), are fitted by generalised least squares
with noise whose neighbours are correlated (a first-order autoregression) [1]_, [2]_. The excess is believed
if it fits better and if the start lies farther from the line than any later stretch as long. The test is then
cut where what stays of it in the mean is 15 % of the standard error of that mean; what is left is asked
again, so that a peak or another fall is cut in pieces. All shapes and correlations count with their weight.

References
----------
.. [1] P. J. Blau, "On the nature of running-in", Tribology International 38 (2005) 1007-1012: its shapes.
.. [2] D. Cochrane and G. H. Orcutt, "Application of least squares regression to relationships containing
   auto-correlated error terms", Journal of the American Statistical Association 44 (1949) 32-61.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.units import Array, Ratio

METHOD = "falling excess in correlated noise, cut where its rest no longer counts"

LENGTHS = np.geomspace(0.002, 0.3, 26)
"""Lengths in which the excess of friction falls to 1/e, tried as shares of what is looked at."""

RAMPS = np.geomspace(0.02, 0.6, 16)
"""Lengths of straight falls that then stop, tried as shares of what is looked at."""

CORRELATIONS = np.array([0.0, 0.2, 0.4, 0.55, 0.7, 0.8, 0.87, 0.92, 0.95, 0.97])
"""Correlations of neighbouring spans tried."""

GAIN = 9.0
"""Fall of -2 ln(likelihood) from which an excess is believed: 1 % for a free size and length."""

SHARE = 0.15
"""Of the standard error of the mean; a smaller rest of the excess does not count."""

LATEST = 0.75
"""Share of the test beyond which no cut is made."""

PASSES = 4
"""Falls that may follow on one another."""


_SHAPES = np.concatenate([LENGTHS, RAMPS])


ROUNDING = 1e-12
"""Share of friction below which differences are those of rounding."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RunIn:
    """End of running-in, as a share of the stretch that was looked at."""

    end: Ratio
    amplitude: Ratio
    """Of the last excess that was believed, at its start [-]; 0 if none was."""
    length: Ratio
    """In which it falls to 1/e, or to nothing if straight, as a share of the whole stretch."""
    rest: Ratio
    """What is left of it in the mean behind the end [-]."""
    ends: bool
    """Whether the rest is small before `LATEST`."""


def run_in(values: Array) -> RunIn:
    """Return where running-in ends.

    Parameters
    ----------
    values : ndarray
        Means over equal spans, shape (span,).
    """
    n, first = values.size, 0
    found = RunIn(end=0.0, amplitude=0.0, length=0.0, rest=0.0, ends=True)
    latest = int(LATEST * n)
    if np.ptp(values) <= ROUNDING * np.abs(values).max():
        return found
    for _ in range(PASSES):
        falls = _falls(values[first:])
        if falls is None:
            break
        left = n - first
        cut, rest, ends = _cut(falls, left, latest - first)
        first += cut
        amplitude, length = falls.best
        share = length * left / n
        found = RunIn(end=first / n, amplitude=amplitude, length=share, rest=rest, ends=ends)
        if not ends:
            break
    return found


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Falls:
    """Falls that may be, one for each correlation and shape tried."""

    weights: Array
    """How likely each is, all together one, shape (correlation, fall)."""
    amplitudes: Array
    """Shape (correlation, fall) [-]."""
    density: float
    """Spectral density of the noise at zero frequency, one span being the unit of time."""

    def rest(self, share: Array) -> Array:
        """Return the root mean square of what they add to the mean behind each cut, shape (cut,)."""
        length, ramp = LENGTHS[:, None], RAMPS[:, None]
        exponential = length * (np.exp(-share / length) - np.exp(-1.0 / length))
        straight = np.maximum(0.0, ramp - share) ** 2 / (2.0 * ramp)
        tail = np.concatenate([exponential, straight]) / (1.0 - share)
        return np.asarray(np.sqrt((self.weights * self.amplitudes**2).sum(axis=0) @ tail**2), dtype=float)

    @property
    def best(self) -> tuple[float, float]:
        """Amplitude and length of the most likely one."""
        row, column = np.unravel_index(int(np.argmax(self.weights)), self.weights.shape)
        return float(self.amplitudes[row, column]), float(_SHAPES[column])


def _falls(values: Array) -> _Falls | None:
    """Return the falls that may be, if the best fits better than none."""
    n = values.size
    x = (np.arange(n) + 0.5) / n
    straight, falls = np.stack([np.ones(n), x - 0.5]), _shapes(x)
    designs = np.concatenate([np.broadcast_to(straight, (len(falls), 2, n)), falls[:, None]], axis=1)
    without, _, _ = _fits(straight[None], values)
    deviance, coefficients, variances = _fits(designs, values)
    if without.min() - deviance.min() < GAIN:
        return None
    weights = np.exp(-0.5 * (deviance - deviance.min()))
    weights /= weights.sum()
    row, column = np.unravel_index(int(np.argmax(weights)), weights.shape)
    if not _stands_out(values - coefficients[row, column, :2] @ straight, float(_SHAPES[column])):
        return None
    density = float((weights * variances / (1.0 - CORRELATIONS[:, None]) ** 2).sum())
    return _Falls(weights=weights, amplitudes=coefficients[..., -1], density=density)


def _shapes(x: Array) -> Array:
    """Return the falls tried, one at the start, as means over spans around x, shape (fall, span)."""
    half = 0.5 / x.size / LENGTHS[:, None]
    exponential = np.exp(-x / LENGTHS[:, None]) * np.sinh(half) / half
    ramp, edge = RAMPS[:, None], np.arange(x.size + 1) / x.size
    straight = -np.diff(np.maximum(0.0, ramp - edge) ** 2) * x.size / (2.0 * ramp)
    return np.concatenate([exponential, straight])


def _stands_out(residual: Array, length: float) -> bool:
    """Return whether the start lies farther from the straight line than any later stretch as long.

    A slow oscillation has a fall at its start too, and others like it later on.
    """
    size = int(np.clip(round(length * residual.size), 1, residual.size // 3))
    count = residual.size // size
    means = np.abs(residual[: size * count].reshape(count, size).mean(axis=1))
    return bool(means[0] > means[1:].max())


def _fits(designs: Array, values: Array) -> tuple[Array, Array, Array]:
    """Return -2 ln(likelihood), coefficients and variance for each correlation and design."""
    deviance, coefficients, variances = [], [], []
    n = values.size
    for rho in CORRELATIONS:
        X, y = _whitened(designs, rho), _whitened(values, rho)
        beta = np.linalg.solve(X @ X.swapaxes(-1, -2), (X @ y)[..., None])[..., 0]
        residual = y - (beta[:, None] @ X)[:, 0]
        variance = np.maximum((residual**2).mean(axis=-1), 1e-300)
        deviance.append(n * np.log(variance) - np.log1p(-(rho**2)))
        coefficients.append(beta)
        variances.append(variance)
    return np.array(deviance), np.array(coefficients), np.array(variances)


def _whitened(values: Array, rho: float) -> Array:
    """Take from each value what the one before it foretells, along the last axis."""
    out = np.array(values)
    out[..., 1:] -= rho * values[..., :-1]
    out[..., 0] *= np.sqrt(1.0 - rho**2)
    return out


def _cut(falls: _Falls, count: int, latest: int) -> tuple[int, float, bool]:
    """Return the first span after which the rest does not count, that rest, and whether it is so."""
    cuts = np.arange(1, max(latest, 1) + 1)
    rest = falls.rest(cuts / count)
    small = rest <= SHARE * np.sqrt(falls.density / (count - cuts))
    place = int(np.argmax(small)) if small.any() else cuts.size - 1
    return int(cuts[place]), float(rest[place]), bool(small.any())
