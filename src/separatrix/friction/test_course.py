"""Series of one friction test for its plots: friction along it, its distribution, its correlation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from separatrix.friction.reduction import Reduction
from separatrix.ground.units import Array, Ratio

COLUMNS, BINS = 600, 60
"""Columns into which the rows of a log are gathered, and bins of a histogram at most."""

Shares = Annotated[Array, "-"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TestCourse:
    """Friction along a test, with what the log has beside it; small, whatever the length of the log.

    Places along the test are in the SI unit of its abscissa. A column of rows has their mean; None where all
    its values are absent.
    """

    __test__ = False

    along: Array  # where each column of rows begins
    low: Shares  # least friction of the rows of a column
    mean: Shares  # their mean
    high: Shares  # largest friction of these rows
    normal_force: Annotated[list[float | None] | None, "N"]  # null where the log has none, as below
    temperature: Annotated[list[float | None] | None, "K"]
    wear_depth: Annotated[list[float | None] | None, "m"]
    slip_speed: Annotated[list[float | None] | None, "m/s"]
    span_along: Array  # centres of the spans of the steady part from whose means its error comes
    span_mean: Shares  # those means
    span_cycles: float  # whole cycles of a span; 0 where none are known
    edges: Shares  # frictions between which rows and cycles are counted
    row_share: Shares  # share of the rows of the steady part in each bin
    cycle_share: Annotated[Array | None, "-"]  # the same of means of whole cycles; null without cycles
    lag: Array  # distance of two spans along the test
    correlation: Shares  # of spans at that distance, about their straight line
    correlation_length: float  # from the spectrum of the spans
    noise_correlation: Ratio  # 95 % of the correlations of white noise are below this, in magnitude


def course(one: Reduction) -> TestCourse:
    """Return the series of a test."""
    log, spans, test = one.log, one.spans, one.test
    starts = np.linspace(0, log.rows, min(COLUMNS, log.rows) + 1).astype(np.int64)[:-1]
    along = np.asarray(getattr(log, test.run_in_axis), dtype=float)
    edges = np.histogram_bin_edges(one.steady_friction, min(BINS, max(8, int(one.steady_friction.size**0.5))))
    lag, correlation = autocorrelation(spans.means)
    length, whole = test.steady_end - test.run_in_end, one.cycle_means

    def beside(name: str) -> list[float | None] | None:
        column = getattr(log, name)
        return None if column is None else _means(np.asarray(column, dtype=float), starts)

    return TestCourse(
        along=along[starts],
        low=np.minimum.reduceat(log.friction, starts),
        mean=np.add.reduceat(log.friction, starts) / np.diff(np.append(starts, log.rows)),
        high=np.maximum.reduceat(log.friction, starts),
        normal_force=beside("normal_force"),
        temperature=beside("temperature"),
        wear_depth=beside("wear_depth"),
        slip_speed=beside("slip_speed"),
        span_along=np.array([one.stretch.place(float(centre)) for centre in spans.centres]),
        span_mean=spans.means,
        span_cycles=float(spans.width) if whole.size else 0.0,
        edges=edges,
        row_share=np.histogram(one.steady_friction, edges)[0] / one.steady_friction.size,
        cycle_share=np.histogram(whole, edges)[0] / whole.size if whole.size else None,
        lag=lag * (length / spans.means.size),
        correlation=correlation,
        correlation_length=one.mean.correlation * length,
        noise_correlation=2.0 / float(spans.means.size) ** 0.5,
    )


def autocorrelation(values: Array) -> tuple[Array, Array]:
    """Return lags and autocorrelation of a series around its straight line, up to a quarter of its length."""
    n = values.size
    x = np.arange(n) - (n - 1) / 2
    level = values - values.mean()
    level = level - x * (x @ level) / (x @ x)
    level[np.abs(level) < 1e-12 * np.abs(values).max()] = 0.0  # rounding is no noise
    lags = np.arange(max(2, n // 4))
    total = float(level @ level) or 1.0
    found = [float(level[: n - lag] @ level[lag:]) / total for lag in lags.tolist()]
    return np.asarray(lags, dtype=float), np.array(found)


def _means(values: Array, starts: NDArray[np.int64]) -> list[float | None]:
    """Return the mean of each column that begins at these rows; None where all its values are absent."""
    there = np.isfinite(values)
    counts = np.add.reduceat(there.astype(float), starts)
    sums = np.add.reduceat(np.where(there, values, 0.0), starts)
    return [float(total / count) if count else None for total, count in zip(sums, counts, strict=True)]
