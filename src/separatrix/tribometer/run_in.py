"""Where running-in ends: an excess fitted in correlated noise, cut where the error of the mean is least.

Friction is a straight line, noise whose neighbours are correlated (a first-order autoregression) and perhaps
an excess that falls: as an exponential, slower than one, straight, at once, or after a peak [1]_. Shapes,
lengths and correlations, and no excess at all, have their Akaike weights [2]_. So it is known how much of an
excess may be left in the mean behind each cut, also where noise hides it. An early cut leaves much of it, a
late one little of the test: the cut is where both together are least. What is behind it is asked again, so
that a mixture of shapes is cut in pieces.

References
----------
.. [1] P. J. Blau, "On the nature of running-in", Tribology International 38 (2005) 1007-1012: its shapes.
.. [2] K. P. Burnham and D. R. Anderson, Model Selection and Multimodel Inference, 2nd ed., Springer 2002:
   weights of models, and the error of what is averaged over them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from separatrix.units import Array, Ratio

METHOD = "falling excess in correlated noise, cut where the error of the mean is least"

CORRELATIONS = np.array([0.0, 0.2, 0.4, 0.55, 0.7, 0.8, 0.87, 0.92, 0.95, 0.97])
"""Correlations of neighbouring spans tried."""

SHAPES: tuple[tuple[Array, Callable[[Array], Array]], ...] = (
    (np.geomspace(0.003, 0.3, 96), lambda x: -np.exp(-x)),  # exponential
    (np.geomspace(0.004, 0.2, 14), lambda x: -1.0 / (1.0 + x)),  # 1/(1 + x)^2, slower than that
    (np.geomspace(0.02, 0.6, 16), lambda x: -0.5 * np.maximum(0.0, 1.0 - x) ** 2),  # straight, then none
    (np.geomspace(0.005, 0.6, 20), lambda x: np.minimum(x, 1.0)),  # level, then none
    (np.geomspace(0.004, 0.15, 14), lambda x: -(1.0 + x) * np.exp(-x)),  # x exp(-x), a peak
)
"""Falls tried: lengths as shares of what is looked at, and the integral over x, the place over the length."""

COST = 6.0
"""By how much -2 ln(likelihood) must fall for an excess to weigh as much as none: two for each of size,
length and kind, which it adds [2]_. Four can be defended too: docs/theory/friction-tests.md says how six was
chosen."""

WORTH = 0.9
"""A cut is made if it brings the error below this share of what it is without."""

LIKELY = 0.5
"""Weight of a statement from which it is more likely than not."""

LATEST = 0.75
"""Share of the test beyond which no cut is made."""

PASSES = 5
"""How often what is left is asked again, at most, the first time included."""

ROUNDING = 1e-12
"""Share of friction below which differences are those of rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunIn:
    """End of running-in, as a share of the stretch that was looked at."""

    end: Ratio
    rest: Ratio
    """What may be left of it in the mean behind the end, root mean square [-]."""
    ends: bool
    """Whether more likely than not it is less than the error by noise, and was not cut in pieces up to
    the latest place."""


def run_in(values: Array) -> RunIn:
    """Return where running-in ends.

    Parameters
    ----------
    values : ndarray
        Means over equal spans, shape (span,).
    """
    n, first = values.size, 0
    found = RunIn(end=0.0, rest=0.0, ends=True)
    if np.ptp(values) <= ROUNDING * np.abs(values).max():
        return found
    for _ in range(PASSES):
        rest, noise, chance = _errors(values[first:])
        latest = int(LATEST * n) - first
        both = np.hypot(rest, noise)[: latest + 1]
        best = int(np.argmin(both))
        cut = best if both[best] <= WORTH * both[0] else 0
        in_pieces = first > 0 and 0 < cut == latest
        first += cut
        ends = bool(chance[cut] <= LIKELY) and not in_pieces
        found = RunIn(end=first / n, rest=float(rest[cut]), ends=ends)
        if cut == 0 or not ends:
            break
    return found


def _errors(values: Array) -> tuple[Array, Array, Array]:
    """Return both parts of the error of the mean behind each span.

    Parameters
    ----------
    values : ndarray
        Means over equal spans, shape (span,).

    Returns
    -------
    tuple
        What may be left of an excess, root mean square [-]; the error by noise [-]; how likely the first is
        larger than the second; shape (span,) each. A root mean square may come from a shape of little weight
        that leaves much, so it does not tell that.
    """
    n = values.size
    falls = shapes(n)
    found = [_weighed(values, falls, rho) for rho in CORRELATIONS]
    logs = np.array([log for log, _, _ in found])
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    squares = np.array([square for _, square, _ in found])[:, 1:]
    density = float((weights * np.array([one for _, _, one in found])).sum())
    left = n - np.arange(n)
    tails = (np.cumsum(falls[:, ::-1], axis=1)[:, ::-1] / left) ** 2
    noise, weights = density / left, weights[:, 1:]
    chance = np.einsum("rs,rsc->c", weights, squares[..., None] * tails > noise)
    return np.sqrt(np.einsum("rs,rs->s", weights, squares) @ tails), np.sqrt(noise), chance


def _weighed(values: Array, falls: Array, rho: float) -> tuple[Array, Array, Array]:
    """Return no excess and each shape under one correlation.

    Returns
    -------
    tuple
        Logarithm of the weight, mean square of the size [-], and spectral density of the noise at zero
        frequency with one span as the unit of time; shape (1 + shape,) each.
    """
    n = values.size
    line = np.stack([np.ones(n), (np.arange(n) + 0.5) / n - 0.5])
    y, straight, g = (_whitened(one, rho) for one in (values, line, falls))
    basis, factor = np.linalg.qr(straight.T)
    y, g = y - basis @ (basis.T @ y), g - (g @ basis) @ basis.T
    total, power = max(float(y @ y), 1e-300), (g * g).sum(axis=-1)
    size = g @ y / power
    left = np.concatenate([[1.0], np.maximum(1.0 - size**2 * power / total, 1e-13)])
    cost = np.concatenate([[0.0], np.full(size.size, 0.5 * COST + np.log(size.size))])
    level = 0.5 * np.log1p(-(rho**2)) - np.log(np.abs(np.diag(factor))).sum() - 0.5 * (n - 2) * np.log(total)
    variance = total * left / (n - 3)
    square = np.concatenate([[0.0], size**2 + variance[1:] / power])
    return level - 0.5 * (n - 2) * np.log(left) - cost, square, variance / (1.0 - rho) ** 2


def shapes(count: int) -> Array:
    """Return the falls tried, as means over equal spans of a stretch of length one, shape (shape, span).

    Each is the slope of what stands here, x from the start over its length.
    """
    edges = np.arange(count + 1) / count
    sums = []
    for lengths, integral in SHAPES:
        x = edges / lengths[:, None]
        sums.append(lengths[:, None] * integral(x))
    return np.diff(np.concatenate(sums), axis=1) * count


def _whitened(values: Array, rho: float) -> Array:
    """Take from each value what the one before it foretells, along the last axis."""
    out = np.array(values)
    out[..., 1:] -= rho * values[..., :-1]
    out[..., 0] *= np.sqrt(1.0 - rho**2)
    return out
