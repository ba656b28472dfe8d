"""Friction of one material in one environment, as a candidate of a study carries it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import TYPE_CHECKING

from separatrix.friction.fit.covariates import at_temperature
from separatrix.friction.fit.extrapolation import held, other_medium
from separatrix.friction.fit.records import FrictionTest, Prediction
from separatrix.units import Kelvin, MetrePerSecond, Pascal, Ratio

if TYPE_CHECKING:
    from separatrix.friction.fit.fit import MaterialFit


@dataclass(frozen=True, slots=True, kw_only=True)
class TestedFriction:
    """What a candidate of a study carries: all tests of its file, which of them are its own, the scatter.

    All tests, because the scatter is pooled over the materials. Nothing is fitted before `at` is called. Of
    tests at different temperatures those nearest the one asked for serve.
    """

    __test__ = False

    material: str
    environment: str
    tests: tuple[FrictionTest, ...] = field(repr=False)
    default_scatter: Ratio

    @property
    def own(self) -> tuple[FrictionTest, ...]:
        """Tests of this material in this environment."""
        mine = (self.material, self.environment)
        return tuple(test for test in self.tests if (test.material, test.environment) == mine)

    def serving(self, temperature: Kelvin | None) -> tuple[FrictionTest, ...]:
        """Those of its own tests that serve at a temperature."""
        return at_temperature(self.own, temperature)

    def fitted(self, temperature: Kelvin | None) -> MaterialFit:
        """Fit of its own tests that serve at a temperature, with the scatter pooled over all materials."""
        from separatrix.friction.fit.fit import fit_friction

        tests = at_temperature(self.tests, temperature)
        return fit_friction(tests, self.default_scatter).of(self.material, self.environment)

    def at(
        self,
        *,
        slip_speed: MetrePerSecond | None = None,
        pressure: Pascal | None = None,
        temperature: Kelvin | None = None,
        medium: str | Sequence[str] | None = None,
    ) -> Prediction:
        """Friction foretold for these conditions, as `MaterialFit.at`."""
        fitted = self.fitted(temperature)
        return fitted.at(slip_speed=slip_speed, pressure=pressure, temperature=temperature, medium=medium)


@dataclass(frozen=True, slots=True, kw_only=True)
class StatedFriction:
    """A printed mean: one number for a range of conditions, perhaps with its scatter and number of tests.

    Without a stated scatter it is that of an unrepeated test; the mean is then no better known than that.
    Outside its conditions that is said, and its scatter left as it is: nobody knows the tests behind it.
    """

    mean: Ratio
    standard_deviation: Ratio | None = None
    count: int | None = None
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    medium: str | None = None
    default_scatter: Ratio

    def at(
        self,
        *,
        slip_speed: MetrePerSecond | None = None,
        pressure: Pascal | None = None,
        temperature: Kelvin | None = None,
        medium: str | Sequence[str] | None = None,
    ) -> Prediction:
        """Friction foretold for these conditions: the printed mean, and what of them was not tested."""
        asked = {"slip_speed": slip_speed, "pressure": pressure, "temperature": temperature}
        within = held(asked, self.ranges, {})
        stated = self.standard_deviation
        scatter = self.default_scatter * self.mean if stated is None else stated
        other = () if self.medium is None else other_medium(medium, (self.medium,))
        return Prediction(
            mean=self.mean,
            standard_error=scatter if stated is None else scatter / sqrt(self.count or 1),
            standard_deviation=scatter,
            extrapolation=(*within.sentences, *other),
            assumed_scatter=stated is None,
        )
