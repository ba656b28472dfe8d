"""What the chain refuses of a study, found in a second: for the verbs that need it, and for `check`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from separatrix.chain.solution import Solution
    from separatrix.study.study import Study, TractionSettings

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
    from separatrix.chain.contacts import require_rolling
    from separatrix.study.study import TractionModel

    asked = solution.study
    require_rolling(asked)
    if asked.traction.model is TractionModel.STRIPS:
        _ = solution.slopes
    else:
        _coarse(solution, asked.traction, has_idle=False)


def compared(solution: Solution) -> None:
    """Refuse a film whose own pressure an exact contact bears, but not Hertz's: `traction` compares both."""
    from separatrix.ground.errors import SeparatrixError
    from separatrix.study.study import ContactPressure, TractionModel

    asked = solution.study.traction
    if asked.pressure is not ContactPressure.COATED:
        return
    try:
        _coarse(solution, asked.by(TractionModel.EXACT))
    except SeparatrixError:
        return  # then there is nothing to compare with, and `traction` says so
    _coarse(solution, asked.by(TractionModel.EXACT, ContactPressure.HERTZ))


def _coarse(solution: Solution, by: TractionSettings, *, has_idle: bool = True) -> None:
    """Compute the contacts in a few cells: enough for what refuses them."""
    from separatrix.chain.contacts import race_tracks
    from separatrix.chain.exact import rolling_contact
    from separatrix.chain.race_curve import contact_problem

    asked = solution.study
    for track in race_tracks(asked.bearing, asked.film, solution.bearing):
        if has_idle or not track.is_idle:
            rolling_contact(contact_problem(track, by), columns=COARSE, rows=COARSE)


def impact(solution: Solution) -> None:
    """Refuse what no restitution factor is computed of: a pocket without stiffness, no running clearance."""
    _ = solution.clearances, solution.ball_cage_stiffness, solution.inertia


def push(solution: Solution) -> None:
    """Refuse what no mobility is computed of: by strips, whose slip fields are those of any contact."""
    from dataclasses import replace

    from separatrix.chain.solution import solve
    from separatrix.study.study import TractionSettings

    _ = solve(replace(solution.study, traction=TractionSettings())).mobility
