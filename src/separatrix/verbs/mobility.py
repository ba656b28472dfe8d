"""`mobility`: how the races let a ball be pushed along its orbit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from separatrix.ground.plain_data import Part
from separatrix.present.blocks import Equation, Heading, Note, Page, Picture, facts
from separatrix.present.figure import BLUE, GREEN, GREY, VERMILION, Across, Figure, Mark, Panel, Trace
from separatrix.present.quantity_text import axis, cell, fact, fill, named, places_table, show
from separatrix.verbs.parts.answer_page import figure, page_of
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.chain_answers import MobilityAnswer

SMALL = (
    *("damping", "effective_mass", "damping_relaxed", "damping_locked", "groove_damping", "groove_stiffness"),
    *("pitch_angle", "pocket_friction_effect", "slip_speed_inner", "slip_speed_outer"),
)
PUSH = ("speed", "force_forward", "force_backward", "force_law")


def compute(study: Study, _options: NoOptions) -> MobilityAnswer:
    """How the races let a ball be pushed along its orbit."""
    from separatrix.chain.ball_mobility import SlipLaw, linear_mobility
    from separatrix.chain.solution import solve
    from separatrix.verbs.chain_answers import MobilityAnswer

    solution = solve(study)
    found, rigid = solution.mobility, linear_mobility(solution.rolling, SlipLaw.RIGID)
    return MobilityAnswer(mobility=found, rigid=rigid, notes=solution.notes)


def page(answer: Part) -> Page:
    """Return the page of `mobility`."""
    law = answer.traction
    spin = ", in which spin takes a part of the friction" * (law.capacity < answer.capacity)
    lead = (
        "The races resist a small push of the most loaded ball along its orbit with a damping $C_f$ of "
        "{damping}, and friction carries at most {capacity}. The law of traction, which the cage takes, is "
        f"fitted to pushes both ways{spin}, with an error of up to {{law_error}} of that: it levels off at "
    )
    return page_of(
        answer,
        Note(f"{fill(answer, lead)}{show(law, 'capacity')}.", "lead"),
        Heading("Small motion of the most loaded ball"),
        facts(*(fact(answer, name, named(name)) for name in SMALL)),
        Heading("Push along the orbit"),
        Equation(
            r"F(u) = \dfrac{C\,u}{\left(1 + (u/v)^4\right)^{1/4}}",
            "Law of traction of a ball that is pushed at a speed $u$ beyond its free orbit: slope $C$, "
            "knee $v$. The motion of the cage takes it.",
        ),
        facts(
            ("Capacity $f_BT$ ($N_I$ + $N_E$)", cell(answer, "capacity")),
            ("Law of traction: slope $C$ and knee $v$", f"{show(law, 'slope')}, {show(law, 'speed')}"),
            ("It levels off at $C$ $v$", cell(law, "capacity")),
            ("Largest error of the law", fill(answer, "{law_error} of the capacity")),
            ("Forward and backward differ by", fill(answer, "up to {asymmetry} of the capacity")),
        ),
        places_table("pushes", answer, *PUSH),
        Picture("mobility", lambda: push_figure(answer), PUSHED),
    )


PUSHED = (
    "Force of the races against the speed of a ball beyond its free orbit, by the slip fields both ways, by "
    "the law of traction and by its slope at the origin."
)


def push_figure(answer: Part) -> Figure:
    """Return F(u) of the slip fields both ways, the law, its slope and the capacity."""
    u, capacity = [0.0, *answer.speed], answer.capacity
    top, name = 1.15 * capacity, fill(answer, "$C_f$ $u$, damping {damping}")
    marks: list[Mark] = [
        Across(at=capacity, axis="y", name=fill(answer, "capacity {capacity}"), colour=GREY, line="--"),
        Trace(x=[0.0, top / answer.damping], y=[0.0, top], name=name, line=":", width=1.0),
    ]
    for way, name, colour, line in (
        ("forward", "slip fields, pushed forward", BLUE, "-"),
        ("backward", "slip fields, pushed backward", VERMILION, "--"),
        ("law", "law of traction $F(u)$", GREEN, "-."),
    ):
        force = [0.0, *getattr(answer, f"force_{way}")]
        marks.append(Trace(x=u, y=force, name=name, colour=colour, line=line))
    x = axis("speed", answer.unit("speed"), u, low=0.0, high=u[-1])
    label, most = "force of the races $F$", 1.25 * capacity
    y = axis("force_law", answer.unit("capacity"), [capacity], label=label, low=0.0, high=most)
    panel = Panel(title="Ball pushed along its orbit", x=x, y=y, marks=tuple(marks))
    return figure(answer, (panel,), height=3.2)


VERB = Verb(
    name="mobility",
    compute=compute,
    page=page,
    epilog="Dampings and effective mass of the most loaded ball, its law of traction F(u) with the capacity "
    "of the races; rates and shares of its modes are in the JSON.",
    links=("rolling", "push"),
)
