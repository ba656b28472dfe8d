"""`restitution`: restitution factor from the traction slopes, and what other films would give."""

from __future__ import annotations

from separatrix.chain.solution import solve
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    overdamped_notes,
)


def compute(study: Study) -> answers.RestitutionAnswer:
    """Restitution factor from the traction slopes, and what other films would give."""
    solution = solve(study)
    overdamped = overdamped_notes(solution.restitution)
    _ = solution.clearances  # refused, and noted
    thickness = study.film.thickness or 0.0
    return answers.RestitutionAnswer(
        solution=solution,
        film_thickness=thickness,
        lubrication=solution.lubrication,
        notes=(*solution.notes, *overdamped),
    )
