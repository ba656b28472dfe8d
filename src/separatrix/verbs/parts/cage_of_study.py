"""The cage that a study asks about, and what a user must know of its friction and damping."""

from __future__ import annotations

from separatrix.cage import MovingCage, moving_cage
from separatrix.chain.impact_restitution import Restitution
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import InputError
from separatrix.ground.units import MetrePerSecond, format_quantity, parse
from separatrix.study.candidates import (
    cage_candidate,
    environment_of,
    ranking_question,
    reference_candidate,
    required_environment,
)
from separatrix.study.study import LEAST_KICK, MOST_KICK, NO_KICK, Study

MOST_RUNS = 1_000_000


def cage_of(solution: Solution) -> MovingCage:
    """Cage of an answer; without friction where none is known."""
    return moving_cage(solution, solution.friction.mean if solution.friction else 0.0)


def reference(study: Study) -> tuple[Solution, MovingCage]:
    """Return chain and cage of the candidate that a ranking is computed for first."""
    asked = ranking_question(study)
    required_environment(study, asked)
    solution = solve(study, reference_candidate(study, asked))
    return solution, cage_of(solution)


def kick_speed(kick: str | MetrePerSecond) -> MetrePerSecond:
    """Speed of a kick that a study may have, from text with a unit or a number [m/s]."""
    speed = parse(kick, "m/s", "--kick") if isinstance(kick, str) else float(kick)
    if not LEAST_KICK < speed < MOST_KICK:
        rule = f"must be > {LEAST_KICK:g} and < {MOST_KICK:g} [m/s]"
        raise InputError("--kick", rule, f"{speed:g}", NO_KICK)
    return speed


def extrapolation_notes(solution: Solution) -> tuple[str, ...]:
    """A sentence where the friction of the cage comes from tests at other conditions."""
    friction, own = solution.friction, cage_candidate(solution.study)
    if friction is not None and own is not None and friction.law is not None and friction.extrapolation:
        place = environment_of(solution.study.ranking) if solution.study.ranking else ""
        return (
            f"Pocket friction {friction.mean:.3g} of {own.name} in {place}, extrapolated beyond the "
            f"tests: {'; '.join(friction.extrapolation)}. [cage] ball_cage_friction overrides it.",
        )
    return ()


def overdamped_notes(found: Restitution) -> tuple[str, ...]:
    """A sentence where the races brake a ball so much that an impact returns nothing."""
    if found.restitution_factor != 0.0:
        return ()
    damping, least = (format_quantity(c, "N s/m", 3) for c in (found.race_damping, found.least_damping))
    return (
        f"eta = 0: impacts are overdamped, because C_mu = {damping} is below the limit sqrt(k_BC M_C)/2 "
        f"= {least}; every material whose cage has this k_BC and M_C has its full threshold as margin. "
        "C_mu falls as race friction falls and as speed rises. Test experience may differ: "
        "docs/theory/restitution.md.",
    )
