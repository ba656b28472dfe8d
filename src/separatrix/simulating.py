"""The verb `simulate`: one run of the ensemble, followed from its disturbance to its end."""

from __future__ import annotations

import re
import warnings
from math import nan
from typing import Any

from separatrix.answers import SimulationAnswer, SpaceSimulationAnswer
from separatrix.cage import analyse, linear_whirl_frequency, simulate_in_space
from separatrix.cage import simulate as follow
from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.chain.solution import Solution, solve
from separatrix.errors import InputError, ValidityWarning
from separatrix.limits.response import cage_at
from separatrix.ranking.reason import Moved, beyond_motion, transmitted_force
from separatrix.study import LEAST_KICK, MOST_KICK, NO_KICK, Study
from separatrix.units import NUMBER, Metre, MetrePerSecond, Newton, Ratio, parse, printable

SAMPLES_A_WHIRL = 15
"""Samples of a simulated run in a period of the linear whirl."""

MOST_SHOWN = 20_000
FEWEST_SHOWN = (1000, 4000)
"""Samples of a simulated run; the fewest in the plane, and in space, where axial impacts are shorter."""

LAST_RUN = 1_000_000


def kick_speed(kick: str | MetrePerSecond) -> MetrePerSecond:
    """Speed of a kick that a study may have, from text with a unit or a number [m/s]."""
    speed = parse(kick, "m/s", "--kick") if isinstance(kick, str) else float(kick)
    if not LEAST_KICK < speed < MOST_KICK:
        rule = f"must be > {LEAST_KICK:g} and < {MOST_KICK:g} [m/s]"
        raise InputError("--kick", rule, f"{speed:g}", NO_KICK)
    return speed


def warn_of_extrapolation(solution: Solution) -> None:
    """Warn where the friction of the cage comes from tests at other conditions."""
    friction, own = solution.friction, cage_candidate(solution.study)
    if friction is not None and own is not None and friction.law is not None and friction.extrapolation:
        place = environment_of(solution.study.ranking) if solution.study.ranking else ""
        warnings.warn(
            f"Pocket friction {friction.mean:.3g} of {own.name} in {place}, extrapolated beyond the "
            f"tests: {'; '.join(friction.extrapolation)}. [cage] ball_cage_friction overrides it.",
            ValidityWarning,
            stacklevel=3,
        )


def simulate(
    study: Study,
    *,
    kick: str | MetrePerSecond | None = None,
    run: int = 0,
    restitution_factor: str | Ratio | None = None,
) -> SimulationAnswer | SpaceSimulationAnswer:
    """Follow one run of the ensemble in plane or space, by default the first from the reference kick.

    Parameters
    ----------
    kick : str or float, optional
        Initial disturbance, text with a unit or [m/s].
    run : int
        Which run of the ensemble.
    restitution_factor : str or float, optional
        Damp the races so that eta is this, as at a point of a map; by default that of the study.
    """
    if not 0 <= run <= LAST_RUN:
        raise InputError("--run", f"must lie between 0 and {LAST_RUN}", got=str(run))
    given = None if kick is None else kick_speed(kick)
    solution = solve(study)
    cage, settings = solution.cage, solution.stability
    if restitution_factor is not None:
        text = str(restitution_factor).strip()
        eta = float(text) if re.fullmatch(NUMBER, text) else nan
        if not 0.0 <= eta <= 1.0:
            rule = "must be a number from 0 to 1"
            raise InputError("--restitution-factor", rule, printable(str(restitution_factor)))
        cage = cage_at(cage, eta, cage.ball_cage_friction)
    warn_of_extrapolation(solution)
    speed = settings.middle_kick if given is None else given
    samples = SAMPLES_A_WHIRL * linear_whirl_frequency(cage) * settings.duration
    asked: dict[str, Any] = {
        "kick": speed,
        "run": run,
        "seed": settings.seed,
        "duration": settings.duration,
        "ball_scatter": settings.ball_scatter,
        "samples": int(min(max(samples, FEWEST_SHOWN[cage.space is not None]), MOST_SHOWN)),
    }
    if cage.space is not None:
        course = simulate_in_space(cage, **asked)
        found = analyse(cage, course, capacity=transmitted_force(solution))
        _warn_of_motion(solution, course.largest_contact_force, found.largest_offset)
        return SpaceSimulationAnswer(
            solution=solution, cage=cage, history=course, analysis=found, kick=speed, run=run
        )
    history = follow(cage, **asked)
    force, offset = abs(history.contact_force).max(), (history.position**2).sum(axis=1).max() ** 0.5
    _warn_of_motion(solution, float(force), float(offset))
    return SimulationAnswer(solution=solution, cage=cage, history=history, kick=speed, run=run)


def _warn_of_motion(solution: Solution, force: Newton, offset: Metre) -> None:
    made_of = cage_candidate(solution.study)
    moved = Moved(made_of.name if made_of else "The cage", force, offset)
    for note in beyond_motion(solution, [moved]):
        warnings.warn(note, ValidityWarning, stacklevel=3)
