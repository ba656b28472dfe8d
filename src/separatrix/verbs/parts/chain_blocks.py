"""What several verbs report of the chain before the cage: clearances, restitution, basis of a verdict.

And the bearing to scale: a section through its axis, with ball, races, cage, pocket and land. What the study
does not state is drawn in dashes, at the proportions of a common bearing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from separatrix.ground.plain_data import Part
from separatrix.ground.units import Array, Metre, Radian
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Equation,
    Heading,
    Level,
    Picture,
    Table,
    facts,
    text_column,
)
from separatrix.present.figure import GREY, VERMILION, Axis, Mark, Panel, Trace
from separatrix.present.quantity_text import cell, fact, fill, named, show
from separatrix.verbs.parts.answer_page import bearing_facts, entry_words, figure, operation_words, stated


def clearance_blocks(found: Part | None) -> list[Block]:
    """Return the clearances of the cage under their heading; none if they are stated."""
    return [] if found is None else [Heading("Clearances of the cage"), facts(*clearance_facts(found))]


def clearance_facts(found: Part | None) -> list[tuple[str, str]]:
    """Return each clearance of the cage at rest and as it runs, with its strains; none if they are stated."""
    if found is None:
        return []
    rows: list[tuple[str, str]] = []
    for words, rest, runs in (
        ("Running pocket clearance", "pocket_at_rest", "pocket"),
        ("Along the axis", "pocket_axial_at_rest", "pocket_axial"),
        ("Running land clearance", "land_at_rest", "land"),
    ):
        if rest in found and runs in found:
            text = f"{{{runs}}} at {{temperature}} and a cage speed of {{cage_speed}}, "
            rows.append((words, fill(found, f"{text}{{{rest}}} at 293 K at rest")))
    parts = [one for one in ("cage", "ball", "ring") if f"{one}_strain" in found]
    known = [f"{one}{'s' * (one != 'cage')} {show(found, f'{one}_strain')}" for one in parts]
    grown = [fill(found, "cage {hoop_strain} at its pitch radius")]
    lands = (("its land", "cage_land_growth"), ("the ring's land", "ring_land_growth"))
    grown += [fill(found, f"{part} {{{key}}} in radius") for part, key in lands if found.get(key)]
    return [*rows, ("Thermal strain", ", ".join(known)), ("Growth by rotation", ", ".join(grown))]


FACTORS = ("race_damping", "damping_ratio", "restitution_factor")
OVERDAMPED = " (overdamped)"


def restitution_blocks(chain: Part, level: Level = Level.LONG) -> list[Block]:
    """Return both restitution factors, and what they are made of, with the equations."""

    def factor(end: str) -> Column:
        head = "if the ball may spin" if end else "dampings summed (Eq. 18)"
        mark = OVERDAMPED if chain.get(f"restitution_factor{end}") == 0.0 else ""
        return Column(head, lambda name: cell(chain, name + end, mark * name.startswith("rest")))

    columns, stiffness = (text_column("", named), factor(""), factor("_free_spin")), "ball_cage_stiffness"
    hertz = "{restitution_factor_hertz} in an impact at the impact speed, less in a harder one"
    return [
        Heading("Restitution", level),
        Equation(
            r"C_\mu = \dfrac{\alpha_i\,Q_i}{V_i} + \dfrac{\alpha_o\,Q_o}{V_o}",
            "Race damping $C_mu$ [18]: slopes $alpha$, loads $Q$ and rolling speeds $V$ of both contacts.",
            level & Level.REPORT,
        ),
        Equation(
            r"\zeta = \dfrac{\sqrt{k_{BC}\,M_C}}{2\,C_\mu}, \qquad "
            r"\eta = \exp\left(-\dfrac{\pi\,\zeta}{\sqrt{1-\zeta^2}}\right)",
            "Restitution factor $eta$ of an impact [17, derived anew]: pocket stiffness $k_BC$, cage mass "
            "$M_C$.",
            level & Level.REPORT,
        ),
        Table("restitution", columns, FACTORS, level=level),
        facts(
            ("Damping of each race", fill(chain, "{inner_damping} inner, {outer_damping} outer")),
            (named(stiffness), f"{show(chain, stiffness)} ({chain.stiffness_source})"),
            fact(chain, "cage_mass", named("cage_mass")),
            ("$eta$ of a Hertzian pocket", fill(chain, hertz)),
            level=level,
        ),
    ]


def heat_blocks(heat: Part | None) -> list[Block]:
    """Return torque, drag and temperatures of a bearing in its fluid; nothing without [cooling]."""
    if heat is None:
        return []
    held = ", {drag_share} of what the races hold" if "drag_share" in heat else ""
    sense = " (below 0: the fluid drives it)" if heat.ball_drag < 0.0 else ""
    drag = f"{{ball_drag}} on each ball{sense}{held}; {{ball_drag_power}} in all"
    faces = "{cage_drag_power}" if "cage_drag_power" in heat else "needs its three sizes in [cage]"
    boils = "; {boiling_limit} dries it" if "boiling_limit" in heat else ""
    warm = "inner ring {inner_ring_temperature}, balls {ball_temperature}, outer ring "
    warm += "{outer_ring_temperature}" + ", cage {cage_temperature}" * ("cage_temperature" in heat)
    warm += "; the coolant leaves at {coolant_out_temperature}"
    flash = "{flash_inner} inner, {flash_outer} outer race, most loaded ball"
    alone = "" if heat.cage_power else ", without friction of the cage"
    return [
        Heading("Torque and heat with the fluid"),
        facts(
            fact(heat, "shaft_torque", "Torque of the shaft" + alone),
            fact(heat, "shaft_power", "Power of the shaft" + alone),
            ("Drag of the balls", fill(heat, drag)),
            ("Fluid on their spin", fill(heat, "{spin_power}")),
            ("Fluid on the faces of the cage", fill(heat, faces)),
            ("Friction of the cage", fill(heat, "{cage_power}") if heat.cage_power else None),
            ("Temperatures", fill(heat, warm) if "ball_temperature" in heat else None),
            ("Flash, rise in a contact", fill(heat, flash) if "flash_inner" in heat else None),
            ("Heat into the hotter track", fill(heat, "{track_heat}" + boils)),
        ),
    ]


def pair_blocks(answer: Part) -> list[Block]:
    """Return the loads of a preloaded pair, and where it gaps; nothing of a single bearing."""
    pair = answer.pair
    if pair is None:
        return []
    gap = "no external load: balls leave their grooves first"
    if pair.preload_kind == "spring":
        gap = "no external load this way: the spring follows; against the spring, at the preload"
    elif "gap_load" in pair:
        gap = fill(pair, "an external axial load of {gap_load} at rest")
    external = answer.values["study"]["operation"]["axial_load"]["value"]
    pressed = ": the external load presses it" if external else ""
    return [
        Heading("Preloaded pair"),
        facts(
            ("Preload", pair.preload_kind),
            ("Operation", operation_words(answer.values["study"])),
            ("This bearing", fill(pair, "axial load {own_axial_load}" + pressed)),
            ("The other bearing", fill(pair, "axial load {other_axial_load}")),
            ("Offset by the preload", fill(pair, "{ring_offset} of each inner ring at rest")),
            ("The pair gaps at", gap),
        ),
    ]


def basis_facts(answer: Part) -> list[tuple[str, str | Cell]]:
    """Return the basis of a verdict: bearing, operation, film, and the numbers of the chain."""
    chain = answer.chain

    def both(name: str) -> str:
        return f"{show(chain.inner, name)} inner, {show(chain.outer, name)} outer"

    over = OVERDAMPED if chain.restitution_factor_free_spin == 0.0 else ""
    eta = "{restitution_factor} with race dampings summed (Eq. 18); {restitution_factor_free_spin}"
    eta += f"{over} if the ball may spin; {{restitution_factor_hertz}} with a Hertzian pocket"
    rows: list[tuple[str, str | Cell]] = [
        *bearing_facts(answer),
        ("Contact angles under load", both("contact_angle")),
        ("Loads of the ball", both("load")),
        ("Traction slopes", both("slope")),
        fact(chain, "race_damping", named("race_damping")),
        (named("restitution_factor"), fill(chain, eta)),
        ("Stiffness of ball and pocket", f"{show(chain, 'ball_cage_stiffness')}, {chain.stiffness_source}"),
    ]
    lead = "up to {lead_amplitude} (pockets {half_play} each way); the harmonics used contain "
    lead = fill(chain, lead + "{orbital_share} of the speed variance") if "orbital_share" in chain else ""
    return [*rows, *clearance_facts(chain.clearances), ("Free balls lead and lag", lead)]


STEEL_COLOUR, BALL_COLOUR, CAGE_COLOUR = "#c9ced6", "#eef1f5", "#e8c27a"
SHOULDER, WALL, WIDTH, CAGE_WIDTH = 0.3, 0.22, 1.5, 1.36
"""Height of a land above the groove, thickness of a cage, width of a ring and of a cage over the ball's
diameter, where the study states none."""

RINGS = "inner", "outer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """What is drawn; pairs are of the inner and the outer ring."""

    ball: Metre  # radius
    centre: Metre  # radius of the pitch circle
    grooves: tuple[Metre, Metre]  # radii of curvature
    lands: tuple[Metre, Metre]  # radii
    rims: tuple[Metre, Metre]  # radii of bore and outside
    cage: tuple[Metre, Metre, Metre] | None  # inner and outer radius, half the width
    hole: Metre  # half the size of a pocket along the axis
    is_cage_stated: bool  # whether the study has all sizes of the cage


def section_of(study: Mapping[str, Any]) -> Section:
    """Return the section of a resolved study."""

    def known(section: str, key: str) -> Any:
        return ((study.get(section) or {}).get(key) or {}).get("value")

    def half(section: str, key: str) -> Metre | None:
        size = known(section, key)
        return None if size is None else size / 2

    diameter, gap = known("bearing", "ball_diameter"), half("cage", "land_clearance") or 0.0
    r, centre, guidance = diameter / 2, known("bearing", "pitch_diameter") / 2, known("cage", "guidance")
    inner_land, outer_land = centre - r + SHOULDER * diameter, centre + r - SHOULDER * diameter
    cage, sizes = None, [half("cage", key) for key in ("inner_diameter", "outer_diameter", "width")]
    if study.get("cage"):
        inner, outer, width = sizes
        wall = WALL * diameter
        usual = {"inner": inner_land + gap, "outer": outer_land - gap - wall}
        if inner is None:
            inner = usual.get(guidance, centre - wall / 2) if outer is None else outer - wall
        cage = inner, inner + wall if outer is None else outer, width or CAGE_WIDTH * r
        inner_land = cage[0] - gap if guidance == "inner" else inner_land
        outer_land = cage[1] + gap if guidance == "outer" else outer_land
    bore = half("bearing", "bore") or centre - diameter
    play = known("cage", "pocket_axial_clearance") or known("cage", "pocket_clearance") or 0.0
    inner_groove, outer_groove = (diameter * known("bearing", f"{ring}_conformity") for ring in RINGS)
    return Section(
        ball=r,
        centre=centre,
        grooves=(inner_groove, outer_groove),
        lands=(inner_land, outer_land),
        rims=(bore, 2 * centre - bore),
        cage=cage,
        hole=r + play / 2,
        is_cage_stated=None not in sizes,
    )


def bearing_picture(answer: Part, contacts: Part | None) -> Picture:
    """Return the bearing of an answer's study to scale; `contacts` have the angles under load, if known."""
    study = answer.values["study"]
    of, nominal = section_of(study), study["bearing"]["contact_angle"]
    angles, words = [nominal["value"]] * 2, f"{entry_words(nominal)} without load"
    if contacts is not None:
        both = contacts.inner, contacts.outer
        angles = [one.contact_angle for one in both]
        words = " inner, ".join(show(one, "contact_angle") for one in both) + " outer"
    sizes = [f"contact angle {words}"]
    for name in ("bearing.ball_diameter", "cage.pocket_clearance", "cage.land_clearance"):
        section, _, key = name.partition(".")
        text = stated(study, section, key)
        sizes += [f"{key.replace('_', ' ')} {text}"] if text else []
    dashed = "Dashed: at common proportions, where the study states no size"
    caption = f"Section through the axis, to scale: {', '.join(sizes)}. {dashed}."
    return Picture("bearing", lambda: figure(answer, (section_panel(of, angles),), height=3.4), caption)


def section_panel(of: Section, angles: Sequence[Radian]) -> Panel:
    """Return the section with the lines of contact."""
    r, half = of.ball, max(WIDTH * of.ball, 1.1 * of.cage[2] if of.cage else 0.0)
    marks: list[Mark] = []
    for side, alpha, groove, land, rim in zip((-1, 1), angles, of.grooves, of.lands, of.rims, strict=True):
        away, x = groove - r, np.linspace(-half, half, 401)
        middle = of.centre - side * away * np.cos(alpha)
        depth = np.sqrt(np.maximum(groove**2 - (x + side * away * np.sin(alpha)) ** 2, 0.0))
        surface = side * np.maximum(side * land, side * middle + depth)
        marks.append(_area([-half, *x, half], [rim, *surface, rim], STEEL_COLOUR, "--"))
        in_groove = side * surface > side * land
        marks.append(Trace(x=x[in_groove].tolist(), y=surface[in_groove].tolist(), width=0.8))
    turns = np.linspace(0.0, 2 * np.pi, 121)
    marks.append(_area(r * np.sin(turns), of.centre + r * np.cos(turns), BALL_COLOUR))
    if of.cage is not None:
        low, high, width = of.cage
        rim = max(width, 1.06 * of.hole)
        for side in (-1, 1):
            across = [side * of.hole, side * rim, side * rim, side * of.hole]
            outline = "-" if of.is_cage_stated else "--"
            marks.append(_area(across, [low, low, high, high], CAGE_COLOUR, outline))
    for side, alpha in zip((-1, 1), angles, strict=True):
        ends = [0.0, side * r * np.sin(alpha)], [of.centre, of.centre + side * r * np.cos(alpha)]
        marks.append(Trace(x=ends[0], y=ends[1], colour=VERMILION, marker="o", size=2.5))
    marks.append(Trace(x=[-half, half], y=[of.centre] * 2, colour=GREY, line="-.", width=0.5))
    return Panel(
        title="Section",
        x=Axis(label="along the axis [mm]", size=1e-3, low=-1.1 * half, high=1.1 * half),
        y=Axis(label="radius [mm]", size=1e-3, low=of.rims[0] - 0.4 * r, high=of.rims[1] + 0.4 * r),
        marks=tuple(marks),
        is_to_scale=True,
    )


def _area(x: Array | list[Metre], y: Array | list[Metre], face: str, line: str = "-") -> Trace:
    """Return a closed outline with a colour inside."""
    return Trace(x=[*x, x[0]], y=[*y, y[0]], face=face, line=line, width=0.8)
