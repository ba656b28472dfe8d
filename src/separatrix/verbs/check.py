"""`check`: the bearing at standstill, for its contact pressures."""

from __future__ import annotations

import warnings
from dataclasses import replace

from separatrix.chain.solution import solve
from separatrix.friction.friction_fit import TestedFriction
from separatrix.ground.errors import SeparatrixError, ValidityWarning
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verdict.drawn_frictions import frictions_to_draw
from separatrix.verdict.draws import uncertain_inputs


def compute(study: Study) -> answers.CheckAnswer:
    """The bearing at standstill, for its contact pressures."""
    _try_predicted_friction(study)
    at_rest = replace(study.operation, inner_speed=0.0, outer_speed=0.0)
    try:
        found = answers.CheckAnswer(static=solve(replace(study, operation=at_rest)).bearing)
    except SeparatrixError as error:
        found = answers.CheckAnswer(static=None, static_reason=str(error))
    try:
        with warnings.catch_warnings():
            # `check` does not report the chain
            warnings.filterwarnings("ignore", "(?!Clearances)", ValidityWarning)
            return replace(found, clearances=solve(study).clearances)
    except SeparatrixError as error:
        return replace(found, clearances_reason=str(error))


def _try_predicted_friction(study: Study) -> None:
    candidates = study.ranking.candidates if study.ranking and study.cage else ()
    if not any(isinstance(one.law, TestedFriction) for c in candidates for one in c.friction.values() if one):
        return
    try:
        # `check` does not report the chain
        with warnings.catch_warnings(action="ignore", category=ValidityWarning):
            uncertain_inputs(study, frictions_to_draw(study))
    except SeparatrixError as error:
        warnings.warn(f"`sensitivity` refuses this study: {error}", ValidityWarning, stacklevel=2)
