"""`stability`: critical friction against restitution factor."""

from __future__ import annotations

from separatrix.chain.solution import solve
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    cage_of,
    extrapolation_notes,
)
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.stability_curve import stability_curve


def compute(study: Study, runner: Runner) -> answers.StabilityAnswer:
    """Critical friction against restitution factor."""
    solution = solve(study)
    cage, settings = cage_of(solution), study.stability
    notes = (*solution.notes, *extrapolation_notes(solution), *cage.notes)
    return made_into(
        lambda curve: answers.StabilityAnswer(
            solution=solution, cage=cage, curve=curve, notes=(*notes, *curve.notes)
        ),
        lambda: stability_curve(cage, settings, runner=runner),
    )
