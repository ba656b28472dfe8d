"""`restitution`: restitution factor from the traction slopes, and what other films would give."""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.ground.document import Part
from separatrix.present.blocks import Level, Note, Page
from separatrix.verbs.parts.answer_page import page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks, restitution_blocks
from separatrix.verbs.parts.telling import said
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import RestitutionAnswer


def compute(study: Study, _options: NoOptions) -> RestitutionAnswer:
    """Restitution factor from the traction slopes, and what other films would give."""
    from separatrix.chain.solution import solve
    from separatrix.verbs.answer_records import RestitutionAnswer
    from separatrix.verbs.parts.cage_of_study import overdamped_notes

    solution = solve(study)
    overdamped = overdamped_notes(solution.restitution)
    _ = solution.clearances  # refused, and noted
    thickness = study.film.thickness or 0.0
    return RestitutionAnswer(
        solution=solution,
        film_thickness=thickness,
        lubrication=solution.lubrication,
        notes=(*solution.notes, *overdamped),
    )


def page(answer: Part) -> Page:
    """Return the page of `restitution`."""
    return page_of(
        answer,
        Note(
            said(answer, "This bearing and film have a restitution factor $eta$ of {restitution_factor}."),
            "lead",
        ),
        *restitution_blocks(answer, Level.ALWAYS),
        *clearance_blocks(answer.clearances),
    )


VERB = Verb(
    name="restitution",
    help="Restitution factor of a ball/cage impact.",
    compute=compute,
    page=page,
    needs=("cage",),
)
