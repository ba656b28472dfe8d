"""Text for the stages before the cage: ball loads, traction, restitution, mobility of a ball, summary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees

import numpy as np

from separatrix.chain.ball_mobility import Mobility
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState
from separatrix.chain.equilibrium import Equilibrium
from separatrix.ground.plain_data import Leaf, Node, field_units, fields_of, plain
from separatrix.study.study import PressureSlip, Study, Worn
from separatrix.told.sentences import strain_facts
from separatrix.told.tables import (
    facts,
    number,
    paragraph,
    quantity,
    section,
    significant,
    stated,
    table,
)
from separatrix.verbs.answer_records import MobilityAnswer, OfCage, RestitutionAnswer, TractionAnswer
from separatrix.verbs.shapes import shape

BALL_HEADERS = (
    *("ball", "azimuth\ndeg", "angle in\ndeg", "angle out\ndeg", "load in\nN", "load out\nN"),
    *("orbit\nrad/s", "pitch\ndeg", "spin/roll\ninner", "spin/roll\nouter"),
)
CONTACT = {
    "load": "Load",
    "semi_major": "Semi-major axis a, across the groove",
    "semi_minor": "Semi-minor axis b, along rolling",
    "max_pressure": "Maximum Hertz pressure",
    "approach": "Mutual approach",
    "rolling_speed": "Rolling speed",
}
TRACTION = {
    "load": "Load",
    "contact_angle": "Contact angle",
    "spin_roll_ratio": "Pivoting to rolling ratio",
    "rolling_speed": "Rolling speed",
    "slope": "Slope alpha at the origin",
    "slope_error": "Error of the slope",
    "free_rolling_offset": "Free-rolling offset of the creep",
}
DAMPING = {"load": "Load", "slope": "Slope alpha", "rolling_speed": "Rolling speed"}
FACTORS = {
    "race_damping": "Race damping C_mu",
    "damping_ratio": "Damping ratio zeta",
    "restitution_factor": "Restitution factor eta",
}


def bearing(found: BearingState, study: Study) -> list[str]:  # noqa: ARG001
    """Ball loads and angles, ring displacement, and the contacts of the most loaded ball."""
    balls = found.equilibrium
    held = "the rings are held parallel" if balls.tilt == 0.0 else "the rings are held at this angle"
    free = "free: the inner ring tilts until the balls balance the moment"
    ring = [
        ("Kinematics", balls.model.value),
        ("Axial displacement", stated(balls, "axial_displacement")),
        ("Radial displacement", stated(balls, "radial_displacement")),
        ("Tilt", f"{stated(balls, 'tilt')} ({held if balls.is_tilt_held else free})"),
        ("Moment of the balls", stated(balls, "moment")),
    ]
    contacts = _by_race(shape(found.inner), shape(found.outer), CONTACT)
    return [
        section("Inner ring", facts(ring)),
        section("Balls", table(BALL_HEADERS, _balls(balls))),
        section("Contacts of the most loaded ball", contacts),
        *_clearances(found.clearances),
    ]


def _clearances(found: Clearances | None) -> list[str]:
    rows = running_clearances(found)
    return [section("Clearances of the cage", facts(rows))] if rows else []


def _balls(found: Equilibrium) -> list[list[str]]:
    """Return a row for each ball, numbered from 1, or a single one if all are alike.

    A contact angle is a dash where the ball does not touch this race.
    """
    angles = (
        (found.contact_angle_inner, found.inner_contact),
        (found.contact_angle_outer, found.outer_contact),
    )
    rows = [
        [
            *(str(j + 1), number(degrees(azimuth), 1)),
            *(number(degrees(angle[j]) if touches[j] else None, 2) for angle, touches in angles),
            *(number(one[j], 1) for one in (found.load_inner, found.load_outer, found.orbital_speed)),
            number(degrees(found.pitch_angle[j]), 2),
            *(number(one[j], 4) for one in (found.spin_roll_ratio_inner, found.spin_roll_ratio_outer)),
        ]
        for j, azimuth in enumerate(found.azimuth)
    ]
    alike = all(row[2:] == rows[0][2:] for row in rows)
    return [[f"all {len(rows)} balls", "-", *rows[0][2:]]] if alike else rows


def _by_race(inner: Node, outer: Node, words: Mapping[str, str]) -> str:
    """Return a table of quantities, inner and outer race side by side, each in the unit of its field."""
    leaves = {name: [one for node in (inner, outer) if isinstance(one := node[name], Leaf)] for name in words}
    cells = [
        [words[name], *(quantity(one.number, one.unit or "-") for one in pair)]
        for name, pair in leaves.items()
    ]
    return table(("", "inner race", "outer race"), cells)


def traction(found: TractionAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Slopes of the traction curves, how they change with the spin, and where strips leave their range."""
    at = found.bearing
    nodes = shape(at.inner) | fields_of(found.inner), shape(at.outer) | fields_of(found.outer)
    others = zip(found.inner_others, found.outer_others, strict=True)
    ratios = [[f"{i.spin_roll_ratio:.2g}", significant(i.slope), significant(o.slope)] for i, o in others]
    slopes = table(("ratio", "inner race", "outer race"), ratios)
    range_of_strips = [section("Range of the strips", *map(paragraph, found.outside))]
    return [
        section("Contacts of the most loaded ball", _by_race(*nodes, TRACTION)),
        section("Slope at other pivoting-to-rolling ratios, by strips", slopes),
        *(range_of_strips if found.outside else []),
    ]


def restitution(answer: RestitutionAnswer, study: Study) -> list[str]:
    """Both restitution factors and what they are made of."""
    solution, found = answer.solution, answer.solution.restitution
    contacts, curves = solution.bearing, solution.slopes
    cells = [
        [words, *(stated(found, name + end) for end in ("", "_free_spin"))] for name, words in FACTORS.items()
    ]
    inner, outer = (
        shape(at) | fields_of(curve, "slope")
        for at, curve in ((contacts.inner, curves.inner), (contacts.outer, curves.outer))
    )
    hertz = stated(found, "restitution_factor_hertz")
    pocket = [
        ("Contacts", contact_words(study)),
        ("Ball/cage stiffness", f"{stated(found, 'ball_cage_stiffness')} ({solution.stiffness_source})"),
        ("Cage mass", stated(found, "cage_mass")),
        ("eta of a Hertzian pocket", f"{hertz} in an impact at the impact speed, less in a harder one"),
    ]
    return [
        section("Restitution factor", table(("", "dampings summed (Eq. 18)", "if the ball may spin"), cells)),
        section("From the contacts of the most loaded ball", _by_race(inner, outer, DAMPING)),
        section("And the rest", facts(pocket)),
        *_clearances(solution.clearances),
    ]


def contact_words(study: Study) -> str:
    """Return how the contacts were computed, and what of the film is worn."""
    asked, wear = study.traction, study.film.wear
    model = {"strips": "strips", "exact": "exact contact"}[asked.model.value]
    pressure = {"hertz": "Hertz's pressure", "coated": "pressure of the coated bodies"}[asked.pressure.value]
    words = f"{model}, {pressure}"
    if asked.pressure_slip is PressureSlip.INCLUDED:
        words += ", slip by the pressure included"
    if wear is None:
        return words
    where = "" if wear.races is Worn.BOTH else f" of the {wear.races.value} race"
    if not wear.is_band:
        return f"{words}; film{where} worn by a measured profile of {len(wear.places.across)} places"
    band = quantity(wear.width, "m") if wear.width is not None else f"{wear.share:.3g} of the contact's width"
    left = f"{quantity(wear.thickness, 'm')} left" if wear.thickness else f"bare, friction {wear.friction:g}"
    return f"{words}; film{where} worn over {band}, {left}"


def basis(study: Study, answer: OfCage) -> list[tuple[str, str]]:
    """Return the basis of a cage's answer: bearing, operation, film, and the numbers of the chain."""
    at, operation, film, solution = study.bearing, study.operation, study.film, answer.solution
    loads = (("axial", "axial_load"), ("radial", "radial_load"), ("moment", "moment"))
    rings = [("inner", "inner_speed")] + [("outer", "outer_speed")] * bool(operation.outer_speed)
    turning = [f"{words} ring {stated(operation, key)}" for words, key in rings]
    loaded = [f"{stated(operation, key)} {words}" for words, key in loads if getattr(operation, key)]
    coat = "none"
    if film.body is not None:
        modulus = quantity(film.body.elastic_modulus, "Pa")
        coat = f"{film.body.name}, {quantity(film.thickness, 'm')}, modulus {modulus}"
    balls = f"{at.ball_count} balls of {quantity(at.ball_diameter, 'm')}"
    found, slopes = solution.restitution, solution.slopes
    inner, outer = solution.bearing.inner, solution.bearing.outer
    free = found.restitution_factor_free_spin
    spins = f"{number(free)}{' (overdamped)' if free == 0.0 else ''} if the ball may spin"
    hertz = f"{number(found.restitution_factor_hertz)} with a Hertzian pocket"
    summed = f"{number(found.restitution_factor)} with race dampings summed (Eq. 18)"

    def both(one: object, other: object, name: str) -> str:
        return f"{stated(one, name)} inner, {stated(other, name)} outer"

    facts = [
        ("Bearing", f"{balls}, pitch diameter {quantity(at.pitch_diameter, 'm')}"),
        ("Operation", ", ".join([*turning, *loaded])),
        ("Film on the races", f"{coat}; friction {quantity(film.race_friction, '-')}"),
        ("Traction", contact_words(study)),
        ("Contact angles", both(inner, outer, "contact_angle")),
        ("Loads of the ball", both(inner, outer, "load")),
        ("Traction slopes", both(slopes.inner, slopes.outer, "slope")),
        ("Race damping C_mu", stated(found, "race_damping")),
        ("Restitution factor", f"{summed}; {spins}; {hertz}"),
        ("Ball/cage stiffness", f"{stated(found, 'ball_cage_stiffness')}, {solution.stiffness_source}"),
    ]
    facts += running_clearances(solution.clearances)
    if solution.orbital_share is not None:  # of a bearing whose balls do not run alike
        lead, clearance = (quantity(one, "m") for one in (answer.cage.lead_amplitude, answer.cage.half_play))
        share = f"the harmonics used contain {100 * solution.orbital_share:.4g} % of the speed variance"
        facts.append(("Free balls lead and lag", f"up to {lead} (pockets {clearance} each way); {share}"))
    return facts


def running_clearances(found: Clearances | None) -> list[tuple[str, str]]:
    """Return each clearance at rest and as it runs, with its strains; empty if the study states it."""
    if found is None:
        return []
    at = f"at {quantity(found.temperature, 'K')} and a cage speed of {quantity(found.cage_speed, 'rad/s')}"
    rows = []
    for words, rest, runs in (
        ("Running pocket clearance", found.pocket_at_rest, found.pocket),
        ("Along the axis", found.pocket_axial_at_rest, found.pocket_axial),
        ("Running land clearance", found.land_at_rest, found.land),
    ):
        if rest is not None and runs is not None:
            rows.append((words, f"{quantity(runs, 'm')} {at}, {quantity(rest, 'm')} at 293 K at rest"))
    return [*rows, *strain_facts(plain(found), quantity)]


SMALL = {
    "damping": "Damping C_f, attitude of the spin held",
    "effective_mass": "Effective mass m_e",
    "damping_relaxed": "Damping C_eff of a slow push",
    "damping_locked": "Damping with all spin held",
    "groove_damping": "Damping across the orbit, c_g",
    "groove_stiffness": "Stiffness across the orbit, k_g",
    "pitch_angle": "Pitch of the spin axis",
    "pocket_friction_effect": "Effect k of pocket friction, 1 +- k f",
    "slip_speed_inner": "Slip speed, inner race",
    "slip_speed_outer": "Slip speed, outer race",
}
MODE_HEADERS = ("mode", "rate\n1/s", "time", "share of 1/C_eff\n%", "rate, rigid\n1/s")
PUSH_HEADERS = ("speed\nm/s", "F forward\nN", "F backward\nN", "law\nN")
SHOWN_PUSHES = 8


def mobility(answer: MobilityAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Small motion by both slip laws, and the law of traction."""
    found, rigid = answer.mobility, answer.rigid
    linear, units = found.linear, field_units(type(found.linear))
    cells = [
        [words, *(quantity(getattr(one, name), units[name], 5) for one in (linear, rigid))]
        for name, words in SMALL.items()
    ]
    rates = np.column_stack([linear.rates, linear.shares, rigid.rates]).tolist()
    modes = [
        [
            str(i),
            significant(of, 5),
            quantity(1.0 / of, "s", 3),
            f"{100.0 * share:.2f}",
            significant(other, 5),
        ]
        for i, (of, share, other) in enumerate(rates, 1)
    ]
    forces = found.force_forward, found.force_backward, found.force_law
    step = max(1, found.speed.size // SHOWN_PUSHES)
    shown = np.column_stack([found.speed, *forces])[::-step][::-1].tolist()
    pushes = [[significant(speed, 3), *map(significant, each)] for speed, *each in shown]
    return [
        section("Small motion of the most loaded ball", table(("", "elastic creep", "rigid"), cells)),
        section("Modes", table(MODE_HEADERS, modes)),
        section("Push along the orbit", facts(_law(found)), table(PUSH_HEADERS, pushes, left=0)),
    ]


def _law(found: Mobility) -> Sequence[tuple[str, str]]:
    """Return what the races carry at most, the law, and how near it is to the slip fields."""
    law = found.traction
    both = f"{quantity(law.slope, 'N s/m', 4)}, {quantity(law.speed, 'm/s', 3)}"
    largest = max(found.force_forward.max(), found.force_backward.max())
    return [
        ("Capacity f_BT (N_I + N_E)", stated(found, "capacity")),
        ("Largest force of the slip fields", quantity(float(largest), "N", 4)),
        ("Law of traction: slope C, knee v", both),
        ("Largest error of the law", f"{100 * found.law_error:.2g} % of the capacity"),
        ("Forward and backward differ by", f"+-{100 * found.asymmetry:.2g} % of the capacity at most"),
    ]
