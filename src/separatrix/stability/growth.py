"""How often a cage's motion grows, counted run by run and no more often than the question needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, sqrt

from separatrix.cage import PlanarCage, RunOutcome, run_ensemble
from separatrix.restitution import damping_for
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, NewtonSecondPerMetre, Ratio

SURE = 2.576
"""Normal quantile of 99 %: a count this far from its target needs no more runs."""

FEW_RUNS = 12
"""Runs of a first look at a point."""


@dataclass(frozen=True, slots=True)
class Count:
    """So many of the runs grew."""

    grown: int
    runs: int

    @property
    def share(self) -> Ratio:
        """Estimate of P(grow)."""
        return self.grown / self.runs

    def interval(self, quantile: float = 1.96) -> tuple[Ratio, Ratio]:
        """Wilson's interval of P(grow); 95 % by default."""
        n, p, z2 = self.runs, self.share, quantile**2
        centre = (p + z2 / (2 * n)) / (1 + z2 / n)
        half = quantile * sqrt(p * (1 - p) / n + z2 / (4 * n * n)) / (1 + z2 / n)
        return max(0.0, centre - half), min(1.0, centre + half)

    def decides(self, target: Ratio) -> bool:
        """True if the target lies outside the 99 % interval."""
        low, high = self.interval(SURE)
        return not low <= target <= high


def cage_at(cage: PlanarCage, restitution_factor: Ratio, friction: Ratio) -> PlanarCage:
    """Return the same cage with the race damping of this restitution factor, and this pocket friction."""
    damping = race_damping_at(cage, restitution_factor)
    return replace(cage, race_damping=damping, ball_cage_friction=friction)


def race_damping_at(cage: PlanarCage, restitution_factor: Ratio) -> NewtonSecondPerMetre:
    """C_mu of a nominal restitution factor; infinite for 1: the races grip the balls."""
    if restitution_factor >= 1.0:
        return inf
    return damping_for(restitution_factor, cage.ball_cage_stiffness, cage.mass)


class GrowthCounter:
    """Counts growing runs at points (eta, f, kick) and remembers them.

    Run number r begins alike at every point, whatever eta, f and kick are (common random numbers), so
    neighbouring points differ by the physics and less by luck.
    """

    def __init__(self, cage: PlanarCage, settings: StabilitySettings) -> None:
        self.cage, self.settings = cage, settings
        self._counts: dict[tuple[Ratio, Ratio, MetrePerSecond], Count] = {}

    def count(
        self, restitution_factor: Ratio, friction: Ratio, kick: MetrePerSecond, *, target: Ratio | None = None
    ) -> Count:
        """Count at a point; with a target, only as many runs as tell on which side of it P lies."""
        key = (restitution_factor, friction, kick)
        known = self._counts.get(key)
        few = min(FEW_RUNS, self.settings.runs)
        if known is None and target is not None:
            known = self._run(key, few)
        enough = known is not None and (
            known.runs >= self.settings.runs or (target is not None and known.decides(target))
        )
        return known if known is not None and enough else self._run(key, self.settings.runs)

    def _run(self, key: tuple[Ratio, Ratio, MetrePerSecond], runs: int) -> Count:
        cage = cage_at(self.cage, key[0], key[1])
        outcome = run_ensemble(cage, self.settings, kicks=(key[2],), runs=runs).outcome
        count = self._counts[key] = Count(int((outcome == RunOutcome.GROWS).sum()), runs)
        return count
