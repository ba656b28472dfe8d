"""`restitution`: restitution factor from the traction slopes, and what other films would give."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING

from separatrix.ground.plain_data import Part
from separatrix.ground.units import format_number
from separatrix.present.blocks import Block, Cell, Column, Level, Note, Page, Picture, Table
from separatrix.present.figure import SEQUENCE, Figure, Mark, Panel, Trace
from separatrix.present.quantity_text import axis, fill, number_of, place_column, quantity
from separatrix.verbs.parts.answer_page import entry_words, figure, page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks, restitution_blocks
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Sequence

    from separatrix.study.study import Study
    from separatrix.verbs.chain_answers import RestitutionAnswer

ETA = "restitution_factor"
TITLE = "Restitution factor with other films: race dampings summed (Eq. 18)"


def compute(study: Study, _options: NoOptions) -> RestitutionAnswer:
    """Restitution factor from the traction slopes, and what other films would give."""
    from separatrix.cage.closed_forms import returned_share
    from separatrix.chain.solution import solve
    from separatrix.verbs.chain_answers import RestitutionAnswer
    from separatrix.verbs.parts.cage_of_study import overdamped_notes

    solution = solve(study)
    overdamped = overdamped_notes(solution.restitution)
    _ = solution.clearances  # refused, and noted
    stiffness, speed = solution.restitution.ball_cage_stiffness, solution.impact_speed
    returned = returned_share(solution.mobility.traction, solution.felt_mass, stiffness, speed)
    return RestitutionAnswer(
        solution=solution,
        impact_speed=speed,
        effective_restitution_factor=returned,
        film_thickness_here=study.film.thickness or 0.0,
        lubrication=solution.lubrication,
        notes=(*solution.notes, *overdamped),
    )


def page(answer: Part) -> Page:
    """Return the page of `restitution`."""
    lead = (
        "An impact at {impact_speed} returns {effective_restitution_factor} of its speed to the cage, with "
        "the inertia of the ball and traction that saturates. The paper's restitution factor $eta$ is "
        "{restitution_factor}, with race dampings summed (Eq. 18); with a ball that may spin in the impact "
        "it is {restitution_factor_free_spin}."
    )
    return page_of(
        answer,
        Note(fill(answer, lead), "lead"),
        *restitution_blocks(answer, Level.ALWAYS),
        *clearance_blocks(answer.clearances),
        *film_blocks(answer, answer.lubrication),
    )


def film_blocks(answer: Part, curve: Part | None) -> list[Block]:
    """Return what other films would give: a picture, and its numbers in the workbook."""
    if curve is None:
        return [Note(f"Other films are not computed. {answer.lubrication_reason}", "text", Level.LONG)]
    caption = (
        f"Restitution factor against the thickness of a film of {curve.film_material} on the races and their "
        "friction (the paper's Fig. 8), with race dampings summed (Eq. 18); the star is this bearing. "
        "Kinematics and loads are those of this bearing throughout."
    )
    tables = (films_table(curve, name) for name in (ETA, f"{ETA}_free_spin"))
    return [Picture("restitution-film", lambda: film_figure(answer, curve), caption), *tables]


def films_table(curve: Part, name: str) -> Table:
    """Return the restitution factors of other films, a thickness a row and a friction a column."""

    def at(place: int) -> Column:
        values = getattr(curve, name)[place]
        head = f"$eta$ at $f_BT$ {number_of(curve, 'race_friction', curve.race_friction[place])}"
        return Column(head, lambda row: Cell(values[row], quantity(name), curve.unit(name)))

    columns = (place_column(curve, "film_thickness"), *map(at, range(len(curve.race_friction))))
    return Table(f"films, {name}", columns, tuple(range(len(curve.film_thickness))), level=Level.SHEET)


def film_figure(answer: Part, curve: Part) -> Figure:
    """Return a curve for each race friction; bare races are apart from the films, at the left."""
    thickness: Sequence[float] = curve.film_thickness
    bare = 0.2 * min(one for one in thickness if one > 0.0)
    marks: list[Mark] = []
    looks = zip(cycle(SEQUENCE), cycle(("-", "--", "-.", ":")), strict=False)
    for friction, etas, (colour, line) in zip(curve.race_friction, getattr(curve, ETA), looks, strict=False):
        words = f"race friction $f_BT$ = {number_of(curve, 'race_friction', friction)}"
        known = [*zip(thickness, etas, strict=True)]
        x, y = zip(*((at, eta) for at, eta in known if at > 0.0), strict=True)
        marks.append(Trace(x=x, y=y, name=words, colour=colour, line=line))
        alone = [eta for at, eta in known if at == 0.0]
        marks.append(Trace(x=[bare] * len(alone), y=alone, marker="o", line="", colour=colour, size=3.5))
    own = entry_words(answer.values["study"]["film"]["race_friction"])
    words = f"this bearing, race friction $f_BT$ = {own}"
    here = answer.film_thickness_here or bare
    marks.append(Trace(x=[here], y=[getattr(answer, ETA)], name=words, marker="*", line="", size=9.0))
    along = axis("film_thickness", curve.unit("film_thickness"), [1e-6], is_log=True)
    decades = [10.0**power for power in range(-9, -3) if bare < 10.0**power <= 1.001 * max(thickness)]
    ticks = ((bare, "bare"), *((one, format_number(one / along.size)) for one in decades))
    panel = Panel(
        title=TITLE,
        x=replace(along, low=0.5 * bare, high=1.3 * max(thickness), ticks=ticks),
        y=axis(ETA, curve.unit(ETA), [1.0], low=-0.02, high=1.0),
        marks=tuple(marks),
    )
    return figure(answer, (panel,), height=3.0)


VERB = Verb(name="restitution", compute=compute, page=page, needs=("cage",), links=("rolling", "impact"))
