"""Parameters of a study that `map` and `sweep` vary: their values, and axes of figures over them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from separatrix.ground.document import Part
from separatrix.present.blocks import Cell
from separatrix.present.figure import Axis
from separatrix.verbs.parts.telling import axis, quantity

SPACE = 1.5
"""Ratio of the last step of an axis to its first beyond which values in proportion are logarithmic."""


def parameter_axis(name: str, unit: str, values: Sequence[float], *, is_tight: bool = False) -> Axis:
    """Return the axis of a parameter; a tight one ends at its first and last value."""
    low, high = min(values), max(values)
    ends = (low, high) if is_tight and low < high else (None, None)
    return axis(name, unit, values, is_log=is_proportional(values), low=ends[0], high=ends[1])


def is_proportional(values: Sequence[float]) -> bool:
    """Whether values rise by a factor rather than by a step: their axis is logarithmic."""
    if len(values) < 3 or not values[0] > 0.0:
        return False
    factors = [b / a for a, b in pairwise(values)]
    is_spread = values[-1] - values[-2] > SPACE * (values[1] - values[0])
    return is_spread and max(factors) < 1.05 * min(factors)


def value_of(parameter: Part, name: str, value: float | None) -> Cell:
    """Return a value of a parameter of this name, in its unit."""
    return Cell(value, quantity(name), parameter.get("unit") or "-")
