r"""A law of at most four saturating elements for F(u): :math:`\sum C_i u/\sqrt{1 + (u/v_i)^2}`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from separatrix.ball_traction import MOST_ELEMENTS, BallTraction
from separatrix.units import Array, Kilogram, NewtonSecondPerMetre

GRID = 48
"""Speeds v_i among which non-negative least squares choose."""

SAME, LEAST = 0.02, 1e-6
"""Difference of two speeds from which they are two, and share of the slope from which an element counts."""

ROUNDS = 12
"""Rounds that raise the weight of the largest errors."""


def fitted_law(speed: Array, force: Array, *, slope: NewtonSecondPerMetre, mass: Kilogram) -> BallTraction:
    """Law with the exact slope at rest, near to F(u) at speeds that rise from near 0.

    Where F falls again at large speeds, the law stays at the largest force before.
    """
    target = np.maximum.accumulate(force)
    guess = _chosen(speed, target, slope)
    shares, speeds = _merged(*_refined(speed, target, slope, *guess))
    return BallTraction(mass=mass, slopes=tuple(map(float, slope * shares)), speeds=tuple(map(float, speeds)))


def _merged(shares: Array, speeds: Array) -> tuple[Array, Array]:
    """Elements whose speeds differ by less than `SAME` as one, and none that is next to nothing."""
    order = np.argsort(speeds)
    shares, speeds = shares[order], speeds[order]
    groups = np.cumsum(np.append(0, np.diff(np.log(speeds)) > np.log1p(SAME)))
    sums = np.bincount(groups, shares)
    means = np.bincount(groups, shares * speeds) / np.maximum(sums, 1e-300)
    kept = sums > LEAST * sums.sum()
    return sums[kept] / sums[kept].sum(), means[kept]


def _element(speed: Array, own: Array) -> Array:
    """u/sqrt(1 + (u/v)^2), shape (speed, element)."""
    return np.asarray(speed[:, None] / np.hypot(1.0, speed[:, None] / own))


def _chosen(speed: Array, target: Array, slope: float) -> tuple[Array, Array]:
    """Shares of the slope and speeds of the elements that non-negative least squares choose on a grid."""
    from scipy.optimize import nnls  # dear to import

    knee = target.max() / slope
    own = np.geomspace(0.03 * knee, 30.0 * max(knee, speed[-1]), GRID)
    scale, heavy = slope * knee, 1e3
    rows = np.vstack((slope * _element(speed, own) / scale, np.full((1, GRID), heavy)))
    shares, _ = nnls(rows, np.append(target / scale, heavy))
    order = np.argsort(-shares)[:MOST_ELEMENTS]
    kept = np.sort(order[shares[order] > 1e-6])
    if kept.size < MOST_ELEMENTS:  # more elements, near to the strongest, for the refinement
        lead = own[order[0]] * np.geomspace(0.3, 3.0, MOST_ELEMENTS - kept.size)
        return (
            np.append(shares[kept], np.full(lead.size, 1e-2)),
            np.append(own[kept], lead),
        )
    return shares[kept], own[kept]


def _refined(speed: Array, target: Array, slope: float, shares: Array, own: Array) -> tuple[Array, Array]:
    """Least squares over shares and speeds, weighted so that the largest error falls (Lawson)."""
    n, scale = shares.size, float(target.max())
    weight = np.full(speed.size, 1.0 / speed.size)
    start = np.concatenate((np.log(shares / shares[0])[1:], np.log(own)))
    low, high = np.log(0.01 * own.min()), np.log(100.0 * own.max())

    def parts(q: Array) -> tuple[Array, Array]:
        power = np.append(0.0, np.clip(q[: n - 1], -30.0, 30.0))
        share = np.exp(power - power.max())
        return share / share.sum(), np.exp(np.clip(q[n - 1 :], low, high))

    def error(q: Array) -> Array:
        share, v = parts(q)
        return np.asarray((slope * _element(speed, v) @ share - target) / scale)

    def slopes(q: Array) -> Array:
        share, v = parts(q)
        g = _element(speed, v)
        by_share = share * (g - (g @ share)[:, None])
        return np.asarray(slope / scale * np.hstack((by_share[:, 1:], share * g**3 / v**2)))

    best, least = start, float(np.abs(error(start)).max())
    for _ in range(ROUNDS):
        start = _weighted_least(np.sqrt(weight), error, slopes, start)
        off = np.abs(error(start))
        if off.max() < least:
            best, least = start, float(off.max())
        weight = weight * (off + 0.05 * off.max())
        weight /= weight.sum()
    share, v = parts(best)
    return share, v


def _weighted_least(
    root: Array, error: Callable[[Array], Array], slopes: Callable[[Array], Array], start: Array
) -> Array:
    """Least squares of an error times the root of its weights."""
    from scipy.optimize import least_squares

    def weighted(q: Array) -> Array:
        return np.asarray(root * error(q))

    def weighted_slopes(q: Array) -> Array:
        return np.asarray(root[:, None] * slopes(q))

    return np.asarray(least_squares(weighted, start, jac=weighted_slopes, max_nfev=60).x)
