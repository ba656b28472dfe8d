"""How often a cage's motion grows, counted run by run and no more often than the question needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from separatrix.cage import PlanarCage, RunOutcome, run_ensemble, wilson_interval
from separatrix.restitution import damping_for
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, NewtonSecondPerMetre, Ratio

LOOKS = (8, 24)
"""Runs after which a count is looked at: far from the target few are enough."""


@dataclass(frozen=True, slots=True)
class Count:
    """So many of the runs grew."""

    grown: int
    runs: int

    @property
    def share(self) -> Ratio:
        """Estimate of P(grow)."""
        return self.grown / self.runs

    def interval(self) -> tuple[Ratio, Ratio]:
        """Wilson's 95 % interval of P(grow)."""
        return wilson_interval(self.grown, self.runs)

    @property
    def unanimous(self) -> bool:
        """True if all of many runs agree: more would tell nothing."""
        return self.runs >= LOOKS[-1] and self.grown in (0, self.runs)

    def decides(self, target: Ratio) -> bool:
        """True if the target lies outside the 95 % interval, or all of many runs agree."""
        low, high = self.interval()
        return not low <= target <= high or self.unanimous


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
        self,
        restitution_factor: Ratio,
        friction: Ratio,
        kick: MetrePerSecond,
        *,
        target: Ratio | None = None,
        most: int | None = None,
    ) -> Count:
        """Count at a point; with a target, only as many runs as tell on which side of it P lies.

        `most` runs at the most, by default those of the settings; 24 that agree are enough.
        """
        key = (restitution_factor, friction, kick)
        most = self.settings.runs if most is None else most
        known = self._counts.get(key, Count(0, 0))
        for runs in (*LOOKS, most):
            told = known.decides(target) if known.runs and target is not None else known.unanimous
            if known.runs >= most or told:
                break
            known = self._extend(key, known, min(runs, most))
        return known

    def _extend(self, key: tuple[Ratio, Ratio, MetrePerSecond], known: Count, runs: int) -> Count:
        more = runs - known.runs
        if more > 0:
            cage = cage_at(self.cage, key[0], key[1])
            found = run_ensemble(
                cage, self.settings, kicks=(key[2],), runs=more, first_run=known.runs, growth_only=True
            )
            known = Count(known.grown + int(found.count(RunOutcome.GROWS)[0]), runs)
            self._counts[key] = known
        return known
