"""`restitution`: restitution factor from the traction slopes, and what other films would give."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING

from separatrix.ground.document import Part
from separatrix.ground.units import format_number
from separatrix.present.blocks import Block, Cell, Column, Level, Note, Page, Picture, Table
from separatrix.present.figure import SEQUENCE, Figure, Mark, Panel, Trace
from separatrix.verbs.parts.answer_page import entry_words, figure, page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks, restitution_blocks
from separatrix.verbs.parts.quantity_text import axis, fill, number_of, place_column, quantity
from separatrix.verbs.parts.refused import impact, refused, rolling
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from separatrix.study.study import Study
    from separatrix.verbs.chain_answers import RestitutionAnswer


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
    return RestitutionAnswer(
        solution=solution,
        impact_speed=speed,
        effective_restitution_factor=returned_share(
            solution.mobility.traction, solution.felt_mass, stiffness, speed
        ),
        film_thickness_here=study.film.thickness or 0.0,
        lubrication=solution.lubrication,
        notes=(*solution.notes, *overdamped),
    )


def refusals(study: Study) -> Iterator[str]:
    """Yield why there is no restitution factor."""
    yield from refused(study, rolling, impact)


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
        "friction (the paper's Fig. 8); the star is this bearing. Kinematics and loads are those of this "
        "bearing throughout."
    )
    tables = (films_table(curve, name) for name in ("restitution_factor", "restitution_factor_free_spin"))
    return [Picture("restitution-film", lambda: film_figure(answer, curve), caption), *tables]


def films_table(curve: Part, name: str) -> Table:
    """Return the restitution factors of other films, a thickness a row and a friction a column."""

    def at(place: int) -> Column:
        values = getattr(curve, name)[place]
        head = f"$eta$ at $f_BT$ {number_of(curve, 'race_friction', curve.race_friction[place])}"
        return Column(head, lambda row: Cell(values[row], quantity(name), curve.unit(name)))

    frictions = map(at, range(len(curve.race_friction)))
    columns = (place_column(curve, "film_thickness"), *frictions)
    rows = tuple(range(len(curve.film_thickness)))
    return Table(f"films, {name}", columns, rows, level=Level.SHEET)


def film_figure(answer: Part, curve: Part) -> Figure:
    """Return eta against thickness for each race friction: dampings summed, and the ball free to spin."""
    summed = films_panel(answer, curve, "restitution_factor", "a  Race dampings summed (Eq. 18)")
    free = films_panel(answer, curve, "restitution_factor_free_spin", "b  Ball free to spin in the impact")
    alt = "Two panels: restitution factor against thickness of the film, a curve for each friction."
    return figure(answer, (summed, free), alt=alt, height=3.0)


def films_panel(answer: Part, curve: Part, name: str, title: str) -> Panel:
    """Return a curve for each race friction; bare races are apart from the films, at the left."""
    thickness: Sequence[float] = curve.film_thickness
    films = [place for place, one in enumerate(thickness) if one > 0.0]
    bare = 0.2 * min(thickness[place] for place in films)
    marks: list[Mark] = []
    looks = zip(cycle(SEQUENCE), cycle(("-", "--", "-.", ":")), strict=False)
    for friction, eta, (colour, line) in zip(curve.race_friction, getattr(curve, name), looks, strict=False):
        words = f"race friction $f_BT$ = {number_of(curve, 'race_friction', friction)}"
        x, y = [thickness[i] for i in films], [eta[i] for i in films]
        marks.append(Trace(x=x, y=y, name=words, colour=colour, line=line))
        at = [one for i, one in enumerate(eta) if i not in films]
        marks.append(Trace(x=[bare] * len(at), y=at, marker="o", line="", colour=colour, size=3.5))
    own = entry_words(answer.values["study"]["film"]["race_friction"])
    words = f"this bearing, race friction $f_BT$ = {own}"
    here = answer.film_thickness_here or bare
    marks.append(Trace(x=[here], y=[getattr(answer, name)], name=words, marker="*", line="", size=9.0))
    along = axis("film_thickness", curve.unit("film_thickness"), [1e-6], is_log=True)
    decades = [10.0**power for power in range(-9, -3) if bare < 10.0**power <= 1.001 * max(thickness)]
    ticks = ((bare, "bare"), *((one, format_number(one / along.size)) for one in decades))
    return Panel(
        title=title,
        x=replace(along, low=0.5 * bare, high=1.3 * max(thickness), ticks=ticks),
        y=axis("restitution_factor", curve.unit(name), [1.0], low=-0.02, high=1.0),
        marks=tuple(marks),
    )


VERB = Verb(name="restitution", compute=compute, page=page, needs=("cage",), refusals=refusals)
