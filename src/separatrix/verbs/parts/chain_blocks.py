"""What several verbs report of the chain before the cage: clearances, restitution, basis of a verdict."""

from __future__ import annotations

from separatrix.ground.document import Part
from separatrix.present.blocks import Block, Cell, Column, Equation, Heading, Level, Table, facts, text_column
from separatrix.present.quantity_text import cell, fact, fill, named, show
from separatrix.verbs.parts.answer_page import bearing_facts, operation_words


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
