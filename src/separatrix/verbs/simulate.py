"""`simulate`: follow one run of the ensemble, by default the first from the reference kick."""

from __future__ import annotations

import re
from math import isfinite, nan

from separatrix.cage import analyse, settings_for
from separatrix.cage import simulate as follow
from separatrix.chain.solution import solve
from separatrix.ground.errors import InputError
from separatrix.ground.units import NUMBER, MetrePerSecond, Ratio, printable
from separatrix.study.candidates import (
    cage_candidate,
    require_friction,
)
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    MOST_RUNS,
    cage_of,
    extrapolation_notes,
    kick_speed,
)
from separatrix.verdict.beyond_models import Moved, beyond_motion
from separatrix.verdict.reasons import force_limit
from separatrix.verdict.response import cage_at
from separatrix.verdict.which_ball import transmitted_force

MOST_SHOWN = 20_000
"""Samples of a simulated run, at most: every step of a short one."""


def compute(
    study: Study,
    *,
    kick: str | MetrePerSecond | None = None,
    run: int = 0,
    restitution_factor: str | Ratio | None = None,
) -> answers.SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference kick.

    Parameters
    ----------
    kick : str or float, optional
        Initial disturbance, text with a unit or [m/s].
    run : int
        Which run of the ensemble.
    restitution_factor : str or float, optional
        Damp the races so that eta is this, as at a point of a map; by default that of the study.
    """
    if not 0 <= run <= MOST_RUNS:
        raise InputError("--run", f"must lie between 0 and {MOST_RUNS}", got=str(run))
    given = None if kick is None else kick_speed(kick)
    solution = solve(study)
    require_friction(study)
    cage = cage_of(solution)
    settings = settings_for(study.stability, cage)
    if restitution_factor is not None:
        text = str(restitution_factor).strip()
        eta = float(text) if re.fullmatch(NUMBER, text) else nan
        if not 0.0 <= eta <= 1.0:
            rule = "must be a number from 0 to 1"
            raise InputError("--restitution-factor", rule, printable(str(restitution_factor)))
        cage = cage_at(cage, eta, cage.ball_cage_friction)
    speed = settings.middle_kick if given is None else given
    history = follow(
        cage,
        kick=speed,
        run=run,
        seed=settings.seed,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        samples=MOST_SHOWN,
    )
    made_of = cage_candidate(study)
    name = made_of.name if made_of else "The cage"
    moved = [Moved(name, history.largest_contact_force, history.largest_offset)]
    limit = force_limit(cage, transmitted_force(solution))
    return answers.SimulationAnswer(
        solution=solution,
        cage=cage,
        history=history,
        analysis=analyse(cage, history),
        kick=speed,
        run=run,
        force_limit=limit if isfinite(limit) else None,
        notes=(
            *solution.notes,
            *cage.notes,
            *extrapolation_notes(solution),
            *beyond_motion(solution, moved),
        ),
    )
