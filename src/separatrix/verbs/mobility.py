"""`mobility`: how the races let a ball be pushed along its orbit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from separatrix.ground.document import Part
from separatrix.present.blocks import (
    Cell,
    Column,
    Equation,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    facts,
    text_column,
)
from separatrix.present.figure import BLACK, BLUE, GREEN, GREY, VERMILION, Across, Figure, Panel, Trace
from separatrix.verbs.parts.answer_page import figure_heading, page_of
from separatrix.verbs.parts.refused import push, refused, rolling
from separatrix.verbs.parts.telling import axis, cell, named, number_of, place_column, quantity, said, told
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.study.study import Study
    from separatrix.verbs.answer_records import MobilityAnswer

SMALL = (
    "damping",
    "effective_mass",
    "damping_relaxed",
    "damping_locked",
    "groove_damping",
    "groove_stiffness",
    "pitch_angle",
    "pocket_friction_effect",
    "slip_speed_inner",
    "slip_speed_outer",
)
SHOWN_PUSHES = 8


def compute(study: Study, _options: NoOptions) -> MobilityAnswer:
    """How the races let a ball be pushed along its orbit."""
    from separatrix.chain.ball_mobility import SlipLaw, linear_mobility
    from separatrix.chain.solution import solve
    from separatrix.verbs.answer_records import MobilityAnswer

    records = (study.bearing, study.operation, study.kinematics.model, study.film, study.traction)
    solution = solve(study)
    found, rigid = solution.mobility, linear_mobility(*records, SlipLaw.RIGID)
    return MobilityAnswer(mobility=found, rigid=rigid, notes=solution.notes)


def refusals(study: Study) -> Iterator[str]:
    """Yield why no push of a ball has an answer."""
    yield from refused(study, rolling, push)


def page(answer: Part) -> Page:
    """Return the page of `mobility`."""
    lead = (
        "The races resist a small push of the most loaded ball along its orbit with a damping $C_f$ of "
        "{damping}, and carry at most {capacity}."
    )
    law = answer.traction
    pushes = range(len(answer.speed))
    shown = tuple(pushes[:: -max(1, len(pushes) // SHOWN_PUSHES)][::-1])
    columns = tuple(
        place_column(answer, name) for name in ("speed", "force_forward", "force_backward", "force_law")
    )
    return page_of(
        answer,
        Note(said(answer, lead), "lead"),
        Heading("Small motion of the most loaded ball"),
        small_motion(answer),
        Heading("Modes"),
        modes(answer),
        Heading("Push along the orbit"),
        Equation(
            r"F(u) = \dfrac{C\,u}{\left(1 + (u/v)^4\right)^{1/4}}",
            "Law of traction of a ball that is pushed at a speed $u$ beyond its free orbit: slope $C$, "
            "knee $v$. The motion of the cage takes it.",
        ),
        facts(
            ("Capacity $f_BT$ ($N_I$ + $N_E$)", cell(answer, "capacity")),
            ("Law of traction: slope $C$ and knee $v$", f"{told(law, 'slope')}, {told(law, 'speed')}"),
            ("Largest error of the law", said(answer, "{law_error} of the capacity")),
            ("Forward and backward differ by", said(answer, "up to {asymmetry} of the capacity")),
        ),
        Table("pushes", columns, shown, level=Level.ALWAYS),
        Table("all pushes", columns, tuple(pushes), level=Level.SHEET),
        Picture(
            "mobility",
            lambda: push_figure(answer),
            "Force of the races against the speed of a ball beyond its free orbit, by the slip fields both "
            "ways, by the law of traction and by its slope at the origin.",
        ),
    )


def small_motion(answer: Part) -> Table:
    """Return the small motion by both slip laws, a quantity a row."""

    def by(part: Part) -> Column:
        return Column(part.slip_law, lambda name: cell(part, name))

    return Table("small motion", (text_column("", named), by(answer), by(answer.rigid)), SMALL)


def modes(answer: Part) -> Table:
    """Return the modes of a pushed ball, by rising rate."""
    count = len(answer.rates)
    rigid = answer.rigid.rates
    other = Column(
        "rate, rigid",
        lambda i: Cell(rigid[i] if i < len(rigid) else None, quantity("rates"), answer.rigid.unit("rates")),
    )
    columns = [text_column("mode", lambda i: str(i + 1)), place_column(answer, "rates")]
    columns += [place_column(answer, "oscillations")] if any(answer.oscillations) else []
    return Table("modes", (*columns, place_column(answer, "shares"), other), tuple(range(count)))


def push_figure(answer: Part) -> Figure:
    """Return F(u) of the slip fields both ways, the law, its slope and the capacity."""
    u = [0.0, *answer.speed]
    capacity, damping = answer.capacity, answer.damping
    look = {"forward": (BLUE, "-"), "backward": (VERMILION, "--"), "law": (GREEN, "-.")}
    words = {"forward": "slip fields, pushed forward", "backward": "slip fields, pushed backward"}
    marks = [
        Trace(
            x=u,
            y=[0.0, *getattr(answer, f"force_{way}")],
            name=words.get(way, "law of traction $F(u)$"),
            colour=colour,
            line=line,
            hover=tuple(
                f"{way}: {number_of(answer, 'speed', x)}, {number_of(answer, f'force_{way}', y)}"
                for x, y in zip(u, [0.0, *getattr(answer, f"force_{way}")], strict=True)
            ),
        )
        for way, (colour, line) in look.items()
    ]
    linear = Trace(
        x=[0.0, 1.15 * capacity / damping],
        y=[0.0, 1.15 * capacity],
        name=said(answer, "$C_f$ $u$, damping {damping}"),
        colour=BLACK,
        line=":",
        width=1.0,
    )
    bound = Across(at=capacity, axis="y", name=said(answer, "capacity {capacity}"), colour=GREY, line="--")
    panel = Panel(
        title="Ball pushed along its orbit",
        x=axis("speed", answer.unit("speed"), u, low=0.0, high=u[-1]),
        y=axis(
            "force_law",
            answer.unit("capacity"),
            [capacity],
            label="force of the races $F$",
            low=0.0,
            high=1.25 * capacity,
        ),
        marks=(bound, linear, *marks),
    )
    return Figure(
        rows=((panel,),),
        heading=figure_heading(answer),
        height=3.2,
        alt="Force against speed: it rises with the damping, then levels off at the capacity of the races.",
    )


VERB = Verb(
    name="mobility",
    epilog="Rates, dampings and effective mass of the most loaded ball, its law of traction F(u) with "
    "the capacity of the races.",
    compute=compute,
    page=page,
    refusals=refusals,
)
