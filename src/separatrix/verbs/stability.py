"""`stability`: critical friction against restitution factor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.ground.document import Part
from separatrix.present.blocks import Heading, Level, Note, Page, Picture
from separatrix.present.figure import Figure
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.curve_blocks import curve_blocks, curve_panel, drift_words, own_lead, own_point
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import StabilityAnswer
    from separatrix.verdict.long_jobs import Runner


def compute(study: Study, options: NoOptions, runner: Runner) -> StabilityAnswer:  # noqa: ARG001
    """Critical friction against restitution factor."""
    from separatrix.chain.solution import solve
    from separatrix.verbs.answer_records import StabilityAnswer
    from separatrix.verbs.parts.cage_of_study import cage_of, extrapolation_notes
    from separatrix.verdict.long_jobs import made_into
    from separatrix.verdict.stability_curve import stability_curve

    solution = solve(study)
    cage, settings = cage_of(solution), study.stability
    notes = (*solution.notes, *extrapolation_notes(solution), *cage.notes)
    return made_into(
        lambda curve: StabilityAnswer(
            solution=solution, cage=cage, curve=curve, notes=(*notes, *curve.notes)
        ),
        lambda: stability_curve(cage, settings, runner=runner),
    )


def page(answer: Part) -> Page:
    """Return the page of `stability`."""
    drift = drift_words(answer)
    return page_of(
        answer,
        Note(own_lead(answer), "lead"),
        *([Note(drift, "lead")] if drift else []),
        *([curve_picture(answer)] if answer.curve else []),
        *own_point(answer),
        Heading("Stability curve"),
        *curve_blocks(answer),
    )


def curve_picture(answer: Part) -> Picture:
    return Picture("stability-curve", lambda: curve_figure(answer), "Critical friction.", Level.REPORT)


def curve_figure(answer: Part) -> Figure:
    return Figure(
        rows=((curve_panel(answer, answer),),), heading=figure_heading(answer), alt="Curve.", height=3.6
    )


VERB = Verb(
    name="stability",
    help="Critical friction against restitution factor.",
    compute=compute,
    page=page,
    needs=("cage",),
    moves_a_cage=True,
    epilog="Beside the curve: its sub-critical band, the curve of each initial disturbance, the linear limit, "
    "and the critical friction at the bearing's own restitution factor.",
    keeps_runs=True,
)
