"""What the chain refuses of a study, found in a second: for the verbs that need it, and for `check`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from separatrix.chain.solution import Solution
    from separatrix.study.study import Study

COARSE = 8
"""Cells along and across in which an exact contact is put for its refusals."""

Step = Callable[["Solution"], object]


def refused(study: Study, *steps: Step) -> Iterator[str]:
    """Yield why the first of these links of a chain that has no answer is refused.

    A link solved with strips takes milliseconds; of the exact contact only what refuses it is computed.
    """
    from separatrix.chain.solution import solve
    from separatrix.ground.errors import SeparatrixError

    solution = solve(study)
    try:
        for step in steps:
            step(solution)
    except SeparatrixError as error:
        yield str(error)


def rolling(solution: Solution) -> None:
    """Refuse what no traction is computed of: a bearing that does not roll, contacts out of their range."""
    from separatrix.chain.contacts import race_tracks, require_rolling
    from separatrix.chain.exact.rolling import rolling_contact
    from separatrix.chain.race_traction import contact_problem
    from separatrix.study.study import TractionModel

    asked = solution.study
    require_rolling(asked)
    if asked.traction.model is TractionModel.STRIPS:
        _ = solution.slopes
        return
    for track in race_tracks(asked.bearing, asked.film, solution.bearing):
        if not track.is_idle:
            rolling_contact(contact_problem(track, asked.traction), columns=COARSE, rows=COARSE)


def impact(solution: Solution) -> None:
    """Refuse what no restitution factor is computed of: a pocket without stiffness, no running clearance."""
    _ = solution.clearances, solution.ball_cage_stiffness, solution.inertia


def push(solution: Solution) -> None:
    """Refuse what no mobility is computed of."""
    _ = by_strips(solution).mobility


def cage_motion(solution: Solution) -> None:
    """Refuse what no cage is moved of: no restitution factor, no clearance, no body."""
    from separatrix.study.study import TractionModel
    from separatrix.verbs.parts.cage_of_study import cage_of

    if solution.study.traction.model is TractionModel.EXACT:
        rolling(solution)
        solution = by_strips(solution)
    cage_of(solution)


def candidate_cages(solution: Solution) -> None:
    """Refuse what no candidate is judged in: no environment of the bearing, no cage that could move."""
    from separatrix.chain.solution import solve
    from separatrix.study.candidates import ranking_question, reference_candidate, required_environment

    study = solution.study
    asked = ranking_question(study)
    required_environment(study, asked)
    for one in (reference_candidate(study, asked), *asked.candidates):
        cage_motion(solve(study, one))


def by_strips(solution: Solution) -> Solution:
    """Return the same chain with strips, which have no refusals of their own and take milliseconds."""
    from separatrix.chain.solution import solve
    from separatrix.study.study import TractionSettings

    return solve(replace(solution.study, traction=TractionSettings()), solution.candidate)
