"""Friction of one material in one environment, fitted when it is first asked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, log

from separatrix.friction_fit.records import FrictionTest, Prediction
from separatrix.units import Kelvin, MetrePerSecond, Pascal, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class TestedFriction:
    """What a candidate of a study carries: all tests of its file, which of them are its own, the scatter.

    All tests, because the scatter is pooled over the materials. Nothing is fitted before `at` is called.
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

    @property
    def middle(self) -> Ratio:
        """Geometric mean of its own tests [-]."""
        own = self.own
        return exp(sum(log(test.friction) for test in own) / len(own))

    def at(
        self,
        *,
        slip_speed: MetrePerSecond | None = None,
        pressure: Pascal | None = None,
        temperature: Kelvin | None = None,
        medium: str | None = None,
    ) -> Prediction:
        """Friction foretold for these conditions, as `MaterialFit.at`."""
        from separatrix.friction_fit.fit import fit_friction

        fitted = fit_friction(self.tests, self.default_scatter).of(self.material, self.environment)
        return fitted.at(slip_speed=slip_speed, pressure=pressure, temperature=temperature, medium=medium)
