"""Mean friction of a candidate in one environment or over all of them, with its standard error."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import hypot, sqrt

from separatrix.chain.pocket_friction import standard_error, with_scatter
from separatrix.study import Friction
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True)
class MeanFriction:
    """Mean friction, its standard error (None if no scatter is known), and what is to be said of it.

    The error holds what was not tested: outside the tests the mean is known less well. `deviation` is the
    standard deviation of a new sample; `assumed` tells a scatter that nobody measured.
    """

    mean: Ratio
    error: Ratio | None = None
    deviation: Ratio | None = None
    assumed: bool = False
    extrapolation: tuple[str, ...] = ()

    def interval(self) -> tuple[Ratio, Ratio]:
        """95 % interval of the mean; the mean twice if its scatter is not known."""
        half = 1.96 * (self.error or 0.0)
        return max(0.0, self.mean - half), self.mean + half


def measured(friction: Friction) -> MeanFriction:
    """Mean and standard error of one measurement, with the widening for what was not tested."""
    error = standard_error(friction)
    return MeanFriction(
        friction.mean,
        None if error is None else hypot(error, friction.widening),
        friction.standard_deviation,
        friction.assumed_scatter,
        friction.extrapolation,
    )


def overall(frictions: Iterable[Friction | None]) -> MeanFriction | None:
    """Mean over the measured environments, each counting once; None if there is none."""
    found = [measured(friction) for friction in frictions if friction is not None]
    if not found:
        return None
    mean = sum(one.mean for one in found) / len(found)
    errors = [one.error for one in found if one.error is not None]
    return MeanFriction(
        mean,
        sqrt(sum(e * e for e in errors)) / len(found) if errors else None,
        assumed=any(one.assumed for one in found),
        extrapolation=tuple(dict.fromkeys(text for one in found for text in one.extrapolation)),
    )


def errors_of(frictions: Mapping[str, Friction | None], scatter: Ratio) -> dict[str, MeanFriction]:
    """Mean and standard error of those that were measured; without any scatter that of an unrepeated test."""
    return {name: measured(with_scatter(f, scatter)) for name, f in frictions.items() if f is not None}
