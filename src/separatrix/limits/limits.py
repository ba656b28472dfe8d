"""The limits that are drawn beside a stability curve: without clearance, and in hard impacts."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from separatrix.cage import PlanarCage, RunOutcome, linear_critical_friction, run_hard_ensemble, settings_for
from separatrix.limits.growth import Count, cage_at
from separatrix.limits.response import LADDER, Crossing, Response
from separatrix.study import Guidance, StabilitySettings
from separatrix.units import Ratio

CROSSINGS, ANY_KICK = 3000, 1.0
"""Length of a run of hard impacts, in times that the kick takes to cross a pocket's play: no other time is in
them, so that any kick [m/s] gives the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearLimit:
    """Critical friction without clearance in a ball set at rest, in closed form."""

    restitution_factor: Ratio  # at which the limit is taken
    critical_friction: Ratio  # above which every disturbance grows


@dataclass(frozen=True, slots=True, kw_only=True)
class HardLimit:
    """Friction at which half the runs whirl in hard impacts; None if less than half whirl anywhere.

    Pockets are walls at even places, the ball set is at rest, the cage has no land and does not turn, so
    that every impact returns just the restitution factor. What it is the limit of: kicks so weak that the
    pocket's spring gives by far less than the clearance.
    """

    restitution_factor: Ratio  # of every impact
    critical_friction: Ratio | None  # at which half the runs whirl; null if less than half do


def linear_limit(cage: PlanarCage, restitution_factor: Ratio) -> LinearLimit:
    """Critical friction of the linear law, 2 zeta sqrt(2/Z), at one restitution factor."""
    critical = linear_critical_friction(cage_at(cage, restitution_factor, 0.0))
    return LinearLimit(restitution_factor=restitution_factor, critical_friction=critical)


def closed_hard_limit(ball_count: int) -> Ratio | None:
    """Friction from which dead hard impacts whirl: tan(pi/2Z) for odd Z, tan(pi/Z) for even; None below 3."""
    if ball_count < 3:
        return None
    return math.tan(math.pi / (2 * ball_count if ball_count % 2 else ball_count))


def hard_limit(cage: PlanarCage, restitution_factor: Ratio, settings: StabilitySettings) -> HardLimit | None:
    """Critical friction in hard impacts at one restitution factor; None for a cage without clearance."""
    if cage.pocket_clearance == 0.0:
        return None
    if restitution_factor >= 1.0:
        return HardLimit(restitution_factor=restitution_factor, critical_friction=0.0)
    settings = settings_for(settings, cage)
    lasting = CROSSINGS * cage.pocket_clearance / ANY_KICK
    still, even = hard_cage(cage), replace(settings, ball_scatter=0.0, duration=lasting)

    def look(friction: Ratio, first_run: int, runs: int) -> Count:
        rubbing = cage_at(still, restitution_factor, friction)
        found = run_hard_ensemble(
            rubbing, even, kicks=(ANY_KICK,), runs=runs, first_run=first_run, may_turn=False,
            restitution=restitution_factor,
        )  # fmt: skip
        return Count(int(found.count(RunOutcome.WHIRLS)[0]), runs)

    found = Response(look, settings.runs).crossing(0.5, settings.runs, LADDER[-24])
    return HardLimit(
        restitution_factor=restitution_factor,
        critical_friction=found.value if isinstance(found, Crossing) else None,
    )


def hard_cage(cage: PlanarCage) -> PlanarCage:
    """Return the cage at rest, without land, gravity, unbalance or anything uneven."""
    return PlanarCage(
        mass=cage.mass,
        moment_of_inertia=cage.moment_of_inertia,
        ball_count=cage.ball_count,
        pitch_radius=cage.pitch_radius,
        cage_speed=0.0,
        inner_speed=cage.inner_speed,
        outer_speed=cage.outer_speed,
        pocket_clearance=cage.pocket_clearance,
        ball_cage_stiffness=cage.ball_cage_stiffness,
        race_damping=cage.race_damping,
        ball_cage_friction=0.0,
        guidance=Guidance.BALL,
    )
