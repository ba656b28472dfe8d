"""`bearing`: ball equilibrium, and the contacts of the most loaded ball."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from separatrix.ground.plain_data import Part
from separatrix.present.blocks import Equation, Heading, Page, Table, facts, text_column
from separatrix.present.quantity_text import by_race, column, fact, fill, show
from separatrix.verbs.parts.answer_page import page_of
from separatrix.verbs.parts.chain_blocks import clearance_blocks, heat_blocks, pair_blocks
from separatrix.verbs.verb import NoOptions, Verb

if TYPE_CHECKING:
    from separatrix.chain.contacts import BearingState
    from separatrix.study.study import Study

CONTACT = (
    *("load", "contact_angle", "semi_major", "semi_minor", "max_pressure", "approach", "rolling_speed"),
    *("spin_roll_ratio", "creep_spin", "creep_curvature"),
)


def compute(study: Study, options: NoOptions) -> BearingState:  # noqa: ARG001
    """Ball equilibrium and the contacts of the most loaded ball."""
    from separatrix.chain.heat_balance import heat_balance
    from separatrix.chain.solution import solve

    solution = solve(study)
    found, clearances = solution.bearing, solution.clearances
    heat = heat_balance(study, found)
    notes = (*(heat.notes if heat else ()), *solution.notes)  # on a screen only the first are shown
    return replace(found, clearances=clearances, heat=heat, pair=solution.pair, notes=notes)


def page(answer: Part) -> Page:
    """Return the page of `bearing`."""
    contacts, most = (answer.contacts.inner, answer.contacts.outer), answer.balls[answer.most_loaded]
    held = "the rings are held parallel" if answer.tilt == 0.0 else "the rings are held at this angle"
    tilt = held if answer.is_tilt_held else "free: the inner ring tilts until the balls balance the moment"
    return page_of(
        answer,
        Heading("Inner ring"),
        Equation(
            r"Q_o\,\cos\,\alpha_o - T_o\,\sin\,\alpha_o = Q_i\,\cos\,\alpha_i - T_i\,\sin\,\alpha_i + F_c, "
            r"\qquad T_i + T_o = \dfrac{2 M_g}{D}",
            "Balance of a ball: centrifugal force $F_c$ and gyroscopic moment $M_g$.",
        ),
        facts(
            ("Kinematics", answer.model),
            fact(answer, "axial_displacement"),
            fact(answer, "radial_displacement"),
            ("Tilt", f"{show(answer, 'tilt')} ({tilt})"),
            fact(answer, "moment"),
            fact(answer, "friction_torque"),
            ("Heat of friction", fill(most, "{heat_inner} inner, {heat_outer} outer race, most loaded ball")),
        ),
        *pair_blocks(answer),
        *heat_blocks(answer.heat),
        Heading("Balls"),
        balls(answer),
        Heading("Contacts of the most loaded ball"),
        by_race("contacts", *contacts, *CONTACT),
        Equation(
            r"\xi(y) = \delta + s\,y + q\,y^2 + \delta\xi",
            "Creep across the groove [14, 16]: free-rolling offset, spin $s$, curvature $q$ (Heathcote), and "
            "the increment $dxi$ that an impact of the cage adds.",
        ),
        *clearance_blocks(answer.clearances),
    )


def balls(answer: Part) -> Table:
    """Return a row for each ball, numbered from 1, or one where all are alike to the digits shown.

    A contact angle is absent where the ball does not touch this race.
    """

    def touching(race: str) -> Callable[[Part], Part | None]:
        return lambda ball: ball if getattr(ball, f"{race}_contact") else None

    carried = ("load_inner", "load_outer", "contact_angle_inner", "contact_angle_outer", "orbital_speed")
    alike = len({tuple(show(ball, name) for name in carried) for ball in answer.balls}) == 1
    number = text_column("ball", lambda ball: f"all {len(answer.balls)}" if alike else str(ball.ball + 1))
    angles = [column(f"contact_angle_{race}", of=touching(race)) for race in ("inner", "outer")]
    ratios = ("spin_roll_ratio_inner", "spin_roll_ratio_outer")
    names = ("load_inner", "load_outer", "orbital_speed", "pitch_angle", *ratios)
    place = [] if alike else [column("azimuth")]
    columns = (number, *place, *angles, *map(column, names))
    return Table("balls", columns, tuple(answer.balls[:1] if alike else answer.balls))


VERB = Verb(name="bearing", compute=compute, page=page, links=("coolant",))
