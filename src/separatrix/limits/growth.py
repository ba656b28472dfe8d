"""How often a cage whirls, counted run by run."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from separatrix.cage import Cause, PlanarCage, RunOutcome, settings_for, wilson_interval
from separatrix.chain.restitution import damping_for
from separatrix.errors import ValidityWarning
from separatrix.runner import Runner
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, NewtonSecondPerMetre, Ratio

UNRESOLVED = (
    "Curve: {} of {} runs from {:g} m/s at friction {:.3g} are unresolved; they count as not whirling."
)

ALIKE: Ratio = 0.08
"""Chance by which runs that all agree may hide a share at the target: 8 runs for one half (0.4 %), 24 for a
tenth."""


@dataclass(frozen=True, slots=True)
class Count:
    """Number of whirling runs among the runs made."""

    whirling: int
    runs: int

    @property
    def share(self) -> Ratio:
        """Estimate of P(whirl)."""
        return self.whirling / self.runs

    def interval(self) -> tuple[Ratio, Ratio]:
        """Wilson's 95 % interval of P(whirl)."""
        return wilson_interval(self.whirling, self.runs)

    def unanimous(self, target: Ratio) -> bool:
        """Whether all runs agree, more than would do so by chance where P is at a target."""
        agree = self.runs > 0 and self.whirling in (0, self.runs)
        return agree and max(target, 1.0 - target) ** self.runs < ALIKE

    def __add__(self, other: Count) -> Count:
        return Count(self.whirling + other.whirling, self.runs + other.runs)


def cage_at(cage: PlanarCage, restitution_factor: Ratio, friction: Ratio) -> PlanarCage:
    """Return the same cage with the race damping of this restitution factor, and this pocket friction.

    Balls with traction yield faster or slower by the same ratio, with the capacity of their own races; at eta
    = 1 their races grip them.
    """
    damping = race_damping_at(cage, restitution_factor)
    law = cage.traction
    if law is not None:
        law = law.stiffened(damping / cage.race_damping) if damping < inf else None
    return replace(cage, race_damping=damping, ball_cage_friction=friction, traction=law)


def race_damping_at(cage: PlanarCage, restitution_factor: Ratio) -> NewtonSecondPerMetre:
    """C_mu of a nominal restitution factor; infinite for 1: the races grip the balls."""
    if restitution_factor >= 1.0:
        return inf
    return damping_for(restitution_factor, cage.ball_cage_stiffness, cage.mass)


class GrowthCounter:
    """Counts whirling runs at points (eta, f, kick).

    Run number r begins alike at every point, whatever eta, f and kick are (common random numbers).
    """

    def __init__(self, cage: PlanarCage, settings: StabilitySettings, runner: Runner | None = None) -> None:
        self.cage, self.settings, self.runner = cage, settings_for(settings, cage), runner or Runner()

    def cage_at(self, restitution_factor: Ratio | None, friction: Ratio) -> PlanarCage:
        """Return the cage with this pocket friction, and the race damping of an eta, or its own for None."""
        if restitution_factor is None:
            return replace(self.cage, ball_cage_friction=friction)
        return cage_at(self.cage, restitution_factor, friction)

    def count(
        self,
        restitution_factor: Ratio | None,
        friction: Ratio,
        kick: MetrePerSecond,
        *,
        first_run: int,
        runs: int,
    ) -> Count:
        """Count the whirling runs among those numbered from `first_run`.

        Raises
        ------
        Interrupted
            The work was interrupted.
        """
        cage = self.cage_at(restitution_factor, friction)
        found = self.runner.ensemble(cage, self.settings, kicks=(kick,), runs=runs, first_run=first_run)
        unresolved = found.outcome == RunOutcome.UNRESOLVED
        open_ends = int(np.count_nonzero(unresolved & (found.cause != Cause.FALLING)))
        if open_ends:  # a motion that still falls does not whirl
            note = UNRESOLVED.format(open_ends, runs, kick, friction)
            warnings.warn(note, ValidityWarning, stacklevel=2)
        return Count(int(found.count(RunOutcome.WHIRLS)[0]), runs)
