"""Every stretch on which a sampled curve is at a level or above it; nothing is taken to be monotonic."""

from __future__ import annotations

import numpy as np

from separatrix.sensitivity.records import Span
from separatrix.units import Array


def spans_above(x: Array, curve: Array, level: float) -> tuple[Span, ...]:
    """Stretches of `x` on which the curve is at `level` or above.

    Parameters
    ----------
    x : ndarray
        Rising, shape (point,).
    curve : ndarray
        Shape (point,). Between two points a straight line, over the logarithm of x where both are positive.
    level : float
        The level.

    Returns
    -------
    tuple of Span
        Rising; empty if the curve is below everywhere.
    """
    inside = np.asarray(curve) >= level
    turns = np.flatnonzero(np.diff(inside.astype(int)))
    crossings = [_crossing(x[i : i + 2], curve[i : i + 2], level) for i in turns]
    ends = [float(x[0])] * bool(inside[0]) + crossings + [float(x[-1])] * bool(inside[-1])
    return tuple(
        Span(
            low=low,
            high=high,
            from_edge=bool(inside[0]) and k == 0,
            to_edge=bool(inside[-1]) and k == len(ends) // 2 - 1,
        )
        for k, (low, high) in enumerate(zip(ends[::2], ends[1::2], strict=True))
    )


def _crossing(x: Array, curve: Array, level: float) -> float:
    share = (level - float(curve[0])) / (float(curve[1]) - float(curve[0]))
    if x[0] > 0.0:
        return float(x[0] * (x[1] / x[0]) ** share)
    return float(x[0] + (x[1] - x[0]) * share)


def largest(spans: tuple[Span, ...]) -> float:
    """Upper end of the last stretch."""
    return spans[-1].high
