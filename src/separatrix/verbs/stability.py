"""`stability`: critical friction against restitution factor."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from separatrix.ground.plain_data import Part
from separatrix.present.blocks import Heading, Level, Note, Page, Picture, facts
from separatrix.present.figure import Figure, Mark, Trace
from separatrix.present.quantity_text import begun, fill
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.parts.chain_blocks import basis_facts
from separatrix.verbs.parts.verdict_blocks import curve_blocks, curve_panel, pocket_friction
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Iterator

    from separatrix.study.study import Study
    from separatrix.verbs.cage_answers import StabilityAnswer
    from separatrix.verdict.long_jobs import Runner


def compute(study: Study, _: NoOptions, runner: Runner) -> StabilityAnswer:
    """Critical friction against restitution factor."""
    from separatrix.chain.solution import solve
    from separatrix.verbs.cage_answers import StabilityAnswer
    from separatrix.verbs.parts.cage_of_study import answer_of_cage, cage_of, extrapolation_notes
    from separatrix.verdict.stability_curve import stability_curve

    solution = solve(study)
    cage, notes = cage_of(solution), extrapolation_notes(solution)
    curve = partial(stability_curve, cage, study.stability, runner=runner)
    return answer_of_cage(StabilityAnswer, "curve", solution, curve, *notes)


def page(answer: Part) -> Page:
    """Return the page of `stability`."""
    below = "runs settle or roll" + ", but the cage drifts" * answer.drifts
    caption = f"Critical friction against restitution factor: below the band {below}, above it they whirl."
    friction = ("Pocket friction", pocket_friction(answer) or "not stated")
    return page_of(
        answer,
        Note(" ".join([*own_words(answer), *friction_words(answer), *drift_words(answer)]), "lead"),
        *([Picture("stability-curve", lambda: curve_figure(answer), caption)] if answer.curve else []),
        Heading("Stability curve"),
        *curve_blocks(answer),
        Heading("Basis of this answer", Level.LONG),
        facts(*basis_facts(answer), friction, level=Level.LONG),
    )


def own_words(answer: Part) -> Iterator[str]:
    """Yield the critical friction at the bearing's own restitution factor, and its band."""
    here = answer.get("here")
    if here is None:
        yield "The critical friction at the bearing's own restitution factor was not finished."
        return
    at = fill(here, "At this bearing's restitution factor of {restitution_factor} ")
    if here.restitution_factor == 0.0:
        at += "(overdamped: its race damping is below that of the curve at 0) "
    if "critical_friction" in here:
        yield fill(here, at + "half of the runs whirl at a pocket friction of {critical_friction}.")
    else:
        yield f"{at}no critical friction was found: {here.reason}."
    words = {"low": "settle or roll below", "high": "whirl above"}
    names = {f"critical_friction_{end}": one for end, one in words.items()}
    ends = [fill(here, f"{one} {{{name}}}") for name, one in names.items() if name in here]
    if ends:
        yield f"From every disturbance runs {', and '.join(ends)}."
    if "critical_friction" in here and "reason" in here:
        yield f"{begun(here.reason)}."


def friction_words(answer: Part) -> Iterator[str]:
    """Yield on which side of the band the cage's own friction is, if both are known."""
    here, friction = answer.get("here"), answer.cage.ball_cage_friction
    words = pocket_friction(answer)
    if not words or here is None:
        return
    if "critical_friction" not in here:
        most = "fewer than half" if here.side == "BELOW" else "more than half"
        yield f"At the cage's friction, {words}, as at any other, the pockets whirl {most} of the runs."
        return
    low, high = here.get("critical_friction_low"), here.get("critical_friction_high")
    side = "within the band, in which the disturbance decides"
    if low is not None and friction < low:
        side = "below the band" + ", but the cage drifts and is not stable" * answer.drifts
    elif high is not None and friction > high:
        side = "above the band"
    yield f"The cage's friction, {words}, is {side}."


def drift_words(answer: Part) -> Iterator[str]:
    """Yield that a cage without a land is stable nowhere, and how fast it drifts."""
    if answer.drifts:
        pace = fill(answer, ", by the linear law at {drift_rate_law}") if answer.get("drift_rate_law") else ""
        yield f"The cage has no land and drifts at any friction{pace}: no verdict below the curve is STABLE."


def curve_figure(answer: Part) -> Figure:
    """Return the curve with the bearing's own point, and the friction of its cage."""
    friction, words = answer.cage.ball_cage_friction, pocket_friction(answer)
    own: list[Mark] = []
    if words:
        name = fill(answer.cage, "the cage's friction, {ball_cage_friction}")
        look: dict[str, Any] = {"line": "", "marker": "s", "size": 4.5, "name": name}
        own = [Trace(x=[answer.chain.restitution_factor], y=[friction], **look)]
    panel = curve_panel(answer, answer, more=own, frictions=[friction] if words else [])
    return figure(answer, (panel,), height=3.6)


VERB = Verb(
    name="stability",
    compute=compute,
    page=page,
    needs=("cage",),
    moves_a_cage=True,
    epilog="Beside the curve: its band, the linear limit, and the critical friction at the bearing's own "
    "restitution factor.",
    keeps_runs=True,
    links=("cage_motion",),
)
