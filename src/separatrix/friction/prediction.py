"""Measured friction of ball on cage: its mean, its scatter, and the law over the conditions behind it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Protocol

from separatrix.ground.schema import between, key, not_negative, record
from separatrix.ground.units import Kelvin, MetrePerSecond, Pascal, Ratio

FRICTION_LIMIT = 2.0
LEAST_FRICTION = 1e-5
"""The least that is a measurement: of frictions that scatter the logarithm is taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Prediction:
    """Friction that tests predict for stated conditions: log-normal about `mean`."""

    mean: Ratio  # the material's friction, its median
    standard_error: Ratio  # how well that mean is known from the tests
    standard_deviation: Ratio  # of a new sample about it, widened where the conditions were not tested
    extrapolation: tuple[str, ...] = ()  # in what respect the conditions were not tested, in words
    widening: Ratio = 0.0  # what these add to the standard deviation, in quadrature
    assumed_scatter: bool = False  # whether no repeated test shows the scatter


class FrictionLaw(Protocol):
    """Friction as a function of the conditions, from tests, as `friction_fit.TestedFriction`."""

    def at(
        self,
        *,
        slip_speed: MetrePerSecond | None,
        pressure: Pascal | None,
        temperature: Kelvin | None,
        medium: str | Sequence[str] | None,
    ) -> Prediction:
        """Friction for these conditions; one that is None is not known. The medium by all its names."""


@record
class Friction:
    """A measured ball/cage friction: its mean and, if known, its scatter.

    `standard_deviation` is that of single tests or samples; `standard_error` that of the mean, where it is
    not the former over the root of `count`. `law` is what knows more: friction over the conditions.
    `extrapolation` says in words in what respect a friction was asked for where nothing was tested;
    `widening` is the part of the standard deviation that stands for it.
    """

    SHORT: ClassVar = "mean"

    mean: Ratio = key(between(0.0, FRICTION_LIMIT), certain=True, example="0.12")
    standard_deviation: Ratio | None = key(not_negative(FRICTION_LIMIT), default=None, certain=True)
    count: int | None = key(between(1, 1e9), default=None, certain=True)
    source: str = key(default="given in the study", letters=(1, 2000))
    standard_error: Ratio | None = None
    assumed_scatter: bool = False
    extrapolation: tuple[str, ...] = ()
    widening: Ratio = 0.0
    law: FrictionLaw | None = field(default=None, compare=False, repr=False)
    confidence: str = "given in the study"


SCATTER_RULE = f"must be >= {LEAST_FRICTION:g} where there is a standard deviation [-]"
SCATTER_CURE = "A friction of 0 that scatters is no measurement: give its mean, or { between = [..., ...] }."
