"""Touches of balls in their pockets as samples show them, and histograms of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.units import Array

BINS, DECADES = 24, 3.0
"""Bins of a histogram, and how far a logarithmic one goes down from the largest value."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Touches:
    """Every stretch of samples in which a pocket presses on its ball; arrays have shape (touch,).

    Attributes
    ----------
    start, duration : ndarray
        First sample with a force, and time over which samples have one [s].
    ball : ndarray
        Number of the ball.
    peak_force, impulse : ndarray
        Largest sample [N], and integral of the force [N s].
    angle : ndarray
        Where on the ball it is pressed at the largest sample [rad].
    """

    start: Array
    duration: Array
    ball: Array
    peak_force: Array
    impulse: Array
    angle: Array


def touches(time: Array, force: Array, angle: Array) -> Touches:
    """Touches of samples of force [N] and angle [rad], shape (time, ball); a sample stands for its step."""
    balls, count = force.shape[1], time.size
    step = np.gradient(time) if count > 1 else np.ones(count)
    pressed = np.zeros((balls, count + 2), bool)
    pressed[:, 1:-1] = force.T > 0.0
    change = np.diff(pressed.astype(np.int8), axis=1)
    ball, first = np.nonzero(change == 1)
    last = np.nonzero(change == -1)[1]
    weighted = np.concatenate([np.zeros((balls, 1)), np.cumsum(force.T * step, axis=1)], axis=1)
    passed = np.concatenate([[0.0], np.cumsum(step)])
    peaks = [a + int(np.argmax(force[a:b, j])) for j, a, b in zip(ball, first, last, strict=True)]
    peak = np.array(peaks, dtype=np.int64)
    return Touches(
        start=time[first],
        duration=passed[last] - passed[first],
        ball=ball.astype(np.float64),
        peak_force=force[peak, ball],
        impulse=weighted[ball, last] - weighted[ball, first],
        angle=angle[peak, ball],
    )


def histogram(values: Array) -> tuple[Array, Array]:
    """Edges and counts, logarithmic over `DECADES` below the largest; smaller ones in the first bin.

    Where there is no value the edges end at 1.
    """
    largest = float(values.max(initial=0.0)) or 1.0
    edges = largest * np.logspace(-DECADES, 0.0, BINS + 1)
    edges[-1] = largest
    return edges, np.histogram(np.clip(values, edges[0], largest), edges)[0].astype(np.float64)


def clock_histogram(angle: Array, impulse: Array) -> tuple[Array, Array, Array]:
    """Edges, counts and impulses around the pocket, in bins whose middles are the poles."""
    half = math.pi / BINS
    edges = np.linspace(-half, 2.0 * math.pi - half, BINS + 1)
    place = np.mod(angle + half, 2.0 * math.pi) - half
    count, weight = (np.histogram(place, edges, weights=each)[0] for each in (np.ones(angle.size), impulse))
    return edges, count, weight
