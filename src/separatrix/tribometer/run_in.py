"""Where running-in ends: a fall fitted in correlated noise, cut where what is left of it does not count.

A straight line and an exponential excess, A exp(-x/L), are fitted by generalised least squares with noise
whose neighbours are correlated (a first-order autoregression) [1]_, [2]_. If the excess is believed, the test is
cut where the part of it that stays in the mean is a tenth of the standard error of that mean. What is left
is asked again, so that a peak or a fall that is no exponential is cut in pieces.

References
----------
.. [1] P. J. Blau, "On the nature of running-in", Tribology International 38 (2005) 1007-1012: shapes of running-in.
.. [2] D. Cochrane and G. H. Orcutt, "Application of least squares regression to relationships containing
   auto-correlated error terms", Journal of the American Statistical Association 44 (1949) 32-61.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.units import Array, Ratio

METHOD = "exponential excess in correlated noise, cut where its rest is a tenth of the standard error"

LENGTHS = np.geomspace(0.002, 0.3, 26)
"""Lengths in which the excess of friction falls to 1/e, tried as shares of what is looked at."""

CORRELATIONS = np.array([0.0, 0.2, 0.4, 0.55, 0.7, 0.8, 0.87, 0.92, 0.95, 0.97])
"""Correlations of neighbouring spans tried."""

GAIN = 9.0
"""Fall of -2 ln(likelihood) from which an excess is believed: 1 % for a free size and length."""

SHARE = 0.1
"""Of the standard error of the mean; a smaller rest of the excess does not count."""

LATEST = 0.75
"""Share of the test beyond which no cut is made."""

PASSES = 4
"""Falls that may follow on one another."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RunIn:
    """End of running-in, as a share of the stretch that was looked at."""

    end: Ratio
    amplitude: Ratio
    """Of the last excess that was believed, at its start [-]; 0 if none was."""
    length: Ratio
    """In which it falls to 1/e, as a share of the whole stretch."""
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
    for _ in range(PASSES):
        fall = _fall(values[first:])
        if fall is None:
            break
        left = n - first
        cut, ends = _cut(fall, left, latest - first)
        first += cut
        found = RunIn(
            end=first / n,
            amplitude=fall.amplitude,
            length=fall.length * left / n,
            rest=float(_rest(fall, cut / left)),
            ends=ends,
        )
        if not ends:
            break
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fall:
    amplitude: float
    length: float
    density: float
    """Spectral density of the noise at zero frequency, one span being the unit of time."""


def _fall(values: Array) -> _Fall | None:
    """Return the fall that fits best, if it fits better than none."""
    n = values.size
    x = (np.arange(n) + 0.5) / n
    half = 0.5 / n / LENGTHS[:, None]
    falls = np.exp(-x / LENGTHS[:, None]) * np.sinh(half) / half
    straight = np.stack([np.ones(n), x - 0.5])
    designs = np.concatenate([np.broadcast_to(straight, (LENGTHS.size, 2, n)), falls[:, None]], axis=1)
    without = _fits(straight[None], values)
    with_it = _fits(designs, values)
    if without[0].min() - with_it[0].min() < GAIN:
        return None
    row, column = np.unravel_index(int(np.argmin(with_it[0])), with_it[0].shape)
    rho = CORRELATIONS[row]
    density = with_it[2][row, column] / (1.0 - rho) ** 2
    return _Fall(
        amplitude=float(with_it[1][row, column, -1]), length=float(LENGTHS[column]), density=float(density)
    )


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


def _rest(fall: _Fall, share: Array | float) -> Array:
    """Return what the fall adds to the mean behind each cut."""
    tail = np.exp(-np.asarray(share) / fall.length) - np.exp(-1.0 / fall.length)
    return np.asarray(fall.amplitude * fall.length * tail / (1.0 - share))


def _cut(fall: _Fall, count: int, latest: int) -> tuple[int, bool]:
    """Return the first span after which the rest of the fall does not count, and whether there is one."""
    cuts = np.arange(1, max(latest, 1) + 1)
    error = np.sqrt(fall.density / (count - cuts))
    small = np.abs(_rest(fall, cuts / count)) <= SHARE * error
    return (int(cuts[np.argmax(small)]), True) if small.any() else (int(cuts[-1]), False)
