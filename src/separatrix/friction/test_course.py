"""Series of one friction test for its plots: friction along it, and what its log has beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from separatrix.friction.reduction import Reduction
from separatrix.ground.units import Array

COLUMNS = 600
"""Columns into which the rows of a log are gathered."""

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
    temperature: Annotated[list[float | None] | None, "K"]  # mean of a column
    wear_depth: Annotated[list[float | None] | None, "m"]  # mean of a column
    slip_speed: Annotated[list[float | None] | None, "m/s"]
    span_along: Array  # centres of the spans of the steady part from whose means its error comes
    span_mean: Shares  # those means


def course(one: Reduction) -> TestCourse:
    """Return the series of a test."""
    log, spans = one.log, one.spans
    starts = np.linspace(0, log.rows, min(COLUMNS, log.rows) + 1).astype(np.int64)[:-1]
    along = np.asarray(getattr(log, one.test.run_in_axis), dtype=float)

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
    )


def _means(values: Array, starts: NDArray[np.int64]) -> list[float | None]:
    """Return the mean of each column that begins at these rows; None where all its values are absent."""
    there = np.isfinite(values)
    counts = np.add.reduceat(there.astype(float), starts)
    sums = np.add.reduceat(np.where(there, values, 0.0), starts)
    return [float(total / count) if count else None for total, count in zip(sums, counts, strict=True)]
