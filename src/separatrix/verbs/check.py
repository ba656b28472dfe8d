"""`check`: the bearing at standstill, for its contact pressures."""

from __future__ import annotations

from dataclasses import replace

from separatrix.chain.solution import solve
from separatrix.friction.friction_fit import TestedFriction
from separatrix.ground.errors import SeparatrixError
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verdict.drawn_frictions import frictions_to_draw
from separatrix.verdict.draws import uncertain_inputs


def compute(study: Study) -> answers.CheckAnswer:
    """The bearing at standstill, for its contact pressures."""
    refused = _refused_by_sensitivity(study)
    at_rest = replace(study.operation, inner_speed=0.0, outer_speed=0.0)
    try:
        static = solve(replace(study, operation=at_rest)).bearing
        found = answers.CheckAnswer(static=static, notes=(*refused, *static.notes))
    except SeparatrixError as error:
        found = answers.CheckAnswer(static=None, static_reason=str(error), notes=refused)
    try:
        clearances = solve(study).clearances
    except SeparatrixError as error:
        return replace(found, clearances_reason=str(error))
    notes = clearances.notes if clearances else ()
    return replace(found, clearances=clearances, notes=(*found.notes, *notes))


def _refused_by_sensitivity(study: Study) -> tuple[str, ...]:
    """A sentence where a friction that tests predict cannot be drawn."""
    candidates = study.ranking.candidates if study.ranking and study.cage else ()
    if not any(isinstance(one.law, TestedFriction) for c in candidates for one in c.friction.values() if one):
        return ()
    try:
        uncertain_inputs(study, frictions_to_draw(study))
    except SeparatrixError as error:
        return (f"`sensitivity` refuses this study: {error}",)
    return ()
