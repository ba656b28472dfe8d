"""Measured pocket friction of a candidate, in one environment or over all of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import sqrt

from separatrix.study import Friction
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True)
class MeanFriction:
    """Mean friction and its standard error, None if no scatter was measured."""

    mean: Ratio
    error: Ratio | None = None

    def interval(self) -> tuple[Ratio, Ratio]:
        """95 % interval of the mean; the mean twice if its scatter is not known."""
        half = 1.96 * (self.error or 0.0)
        return max(0.0, self.mean - half), self.mean + half


def measured(friction: Friction) -> MeanFriction:
    """Mean and standard error of one measurement; without a count the scatter is taken as it is."""
    if friction.standard_deviation is None:
        return MeanFriction(friction.mean)
    return MeanFriction(friction.mean, friction.standard_deviation / sqrt(friction.count or 1))


def overall(frictions: Iterable[Friction | None]) -> MeanFriction | None:
    """Mean over the measured environments, each counting once; None if there is none."""
    found = [measured(friction) for friction in frictions if friction is not None]
    if not found:
        return None
    mean = sum(one.mean for one in found) / len(found)
    errors = [one.error for one in found if one.error is not None]
    return MeanFriction(mean, sqrt(sum(e * e for e in errors)) / len(found) if errors else None)
