"""Text for the stages before the cage: ball loads, traction, restitution, and their summary."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from typing import TYPE_CHECKING

from separatrix.present.text.tables import facts, number, quantity, section, significant, table

if TYPE_CHECKING:
    from separatrix.answers import OfCage, RestitutionAnswer, TractionAnswer
    from separatrix.chain.contacts import BearingState
    from separatrix.chain.equilibrium import Equilibrium
    from separatrix.chain.solution import Solution
    from separatrix.study import Study

BALL_HEADERS = (
    *("ball", "azimuth\ndeg", "angle in\ndeg", "angle out\ndeg", "load in\nN", "load out\nN"),
    *("orbit\nrad/s", "pitch\ndeg", "spin/roll\ninner", "spin/roll\nouter"),
)


def bearing(found: BearingState, study: Study) -> list[str]:  # noqa: ARG001
    """Ball loads and angles, ring displacement, and the contacts of the most loaded ball."""
    balls, inner, outer = found.equilibrium, found.inner, found.outer
    held = "the rings are held parallel" if balls.tilt == 0.0 else "the rings are held at this angle"
    free = "free: the inner ring tilts until the balls balance the moment"
    ring = [
        ("Kinematics", balls.model.value),
        ("Axial displacement", quantity(balls.axial_displacement, "m")),
        ("Radial displacement", quantity(balls.radial_displacement, "m")),
        ("Tilt", f"{quantity(balls.tilt, 'rad')} ({held if balls.is_tilt_held else free})"),
        ("Moment of the balls", quantity(balls.moment, "N m")),
    ]
    i, o = inner.ellipse, outer.ellipse
    contacts = [
        ("Load", inner.load, outer.load, "N"),
        ("Semi-major axis a, across the groove", i.semi_major, o.semi_major, "m"),
        ("Semi-minor axis b, along rolling", i.semi_minor, o.semi_minor, "m"),
        ("Maximum Hertz pressure", i.max_pressure, o.max_pressure, "Pa"),
        ("Mutual approach", i.approach, o.approach, "m"),
        ("Rolling speed", inner.rolling_speed, outer.rolling_speed, "m/s"),
    ]
    return [
        section("Inner ring", facts(ring)),
        section("Balls", table(BALL_HEADERS, _balls(balls))),
        section("Contacts of the most loaded ball", _by_race(contacts)),
    ]


def _balls(found: Equilibrium) -> list[list[str]]:
    """Return a row for each ball, numbered from 1, or a single one if all are alike.

    A contact angle is a dash where the ball does not touch this race.
    """
    rows = []
    for j, azimuth in enumerate(found.azimuth):
        angles = (
            number(degrees(angle[j]) if touches[j] else None, 2)
            for angle, touches in (
                (found.contact_angle_inner, found.inner_contact),
                (found.contact_angle_outer, found.outer_contact),
            )
        )
        loads = (found.load_inner, found.load_outer, found.orbital_speed)
        ratios = (found.spin_roll_ratio_inner, found.spin_roll_ratio_outer)
        row = [str(j + 1), number(degrees(azimuth), 1), *angles, *(number(one[j], 1) for one in loads)]
        rows.append([*row, number(degrees(found.pitch_angle[j]), 2), *(number(r[j], 4) for r in ratios)])
    alike = all(row[2:] == rows[0][2:] for row in rows)
    return [[f"all {len(rows)} balls", "-", *rows[0][2:]]] if alike else rows


def _by_race(rows: Sequence[tuple[str, float, float, str]]) -> str:
    """Return a table of quantities, inner and outer race side by side; a row ends with its unit."""
    cells = [[label, quantity(inner, unit), quantity(outer, unit)] for label, inner, outer, unit in rows]
    return table(("", "inner race", "outer race"), cells)


def traction(found: TractionAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Slopes of the traction curves, and how they change with the pivoting-to-rolling ratio."""
    inner, outer, i, o = found.bearing.inner, found.bearing.outer, found.inner, found.outer
    rows = [
        ("Load", inner.load, outer.load, "N"),
        ("Contact angle", inner.contact_angle, outer.contact_angle, "rad"),
        ("Pivoting to rolling ratio", i.spin_roll_ratio, o.spin_roll_ratio, "-"),
        ("Rolling speed", inner.rolling_speed, outer.rolling_speed, "m/s"),
        ("Slope alpha at the origin", i.slope, o.slope, "-"),
        ("Error of the slope", i.slope_error, o.slope_error, "-"),
        ("Free-rolling offset of the creep", i.free_rolling_offset, o.free_rolling_offset, "-"),
    ]
    others = zip(found.inner_others, found.outer_others, strict=True)
    ratios = [[f"{i.spin_roll_ratio:.2g}", significant(i.slope), significant(o.slope)] for i, o in others]
    slopes = table(("ratio", "inner race", "outer race"), ratios)
    return [
        section("Contacts of the most loaded ball", _by_race(rows)),
        section("Slope at other pivoting-to-rolling ratios", slopes),
    ]


def restitution(answer: RestitutionAnswer, study: Study) -> list[str]:  # noqa: ARG001
    """Both restitution factors and what they are made of."""
    solution, found = answer.solution, answer.solution.restitution
    inner, outer, slopes = solution.bearing.inner, solution.bearing.outer, solution.traction
    rows = (
        ("Race damping C_mu", found.race_damping, found.race_damping_free_spin, "N s/m"),
        ("Damping ratio zeta", found.damping_ratio, found.damping_ratio_free_spin, "-"),
        ("Restitution factor eta", found.restitution_factor, found.restitution_factor_free_spin, "-"),
    )
    cells = [[label, quantity(printed, unit), quantity(free, unit)] for label, printed, free, unit in rows]
    parts = [
        ("Load", inner.load, outer.load, "N"),
        ("Slope alpha", slopes.inner.slope, slopes.outer.slope, "-"),
        ("Rolling speed", inner.rolling_speed, outer.rolling_speed, "m/s"),
    ]
    hertz = quantity(found.restitution_factor_hertz, "-")
    stiffness = f"{quantity(found.ball_cage_stiffness, 'N/m')} ({solution.stiffness_source})"
    pocket = [
        ("Ball/cage stiffness", stiffness),
        ("Cage mass", quantity(found.cage_mass, "kg")),
        ("eta of a Hertzian pocket", f"{hertz} in an impact at the impact speed, less in a harder one"),
    ]
    return [
        section("Restitution factor", table(("", "dampings summed (Eq. 18)", "if the ball may spin"), cells)),
        section("From the contacts of the most loaded ball", _by_race(parts)),
        section("And the pocket", facts(pocket)),
    ]


def basis(study: Study, answer: OfCage) -> list[tuple[str, str]]:
    """Return what a cage's answer is based on: bearing, operation, film, and the numbers of the chain."""
    return [*study_facts(study), *chain_facts(answer.solution), *_lead_and_lag(answer)]


def study_facts(study: Study) -> list[tuple[str, str]]:
    """Return the bearing, its operating point and the film on a line each."""
    bearing, operation, film = study.bearing, study.operation, study.film
    loads = [
        f"{quantity(load, 'N')} {name}"
        for name, load in (("axial", operation.axial_load), ("radial", operation.radial_load))
        if load
    ]
    coat = "none"
    if film.material is not None:
        modulus = quantity(film.material.elastic_modulus, "Pa")
        coat = f"{film.material.name}, {quantity(film.thickness, 'm')}, modulus {modulus}"
    balls = f"{bearing.ball_count} balls of {quantity(bearing.ball_diameter, 'm')}"
    return [
        ("Bearing", f"{balls}, pitch diameter {quantity(bearing.pitch_diameter, 'm')}"),
        ("Operation", ", ".join([f"inner ring {quantity(operation.inner_speed, 'rad/s')}", *loads])),
        ("Film on the races", f"{coat}; friction {quantity(film.race_friction, '-')}"),
    ]


def chain_facts(solution: Solution) -> list[tuple[str, str]]:
    """Return the chain's numbers on a few lines: angles, loads, slopes, damping, both restitution factors."""
    slopes, found = solution.traction, solution.restitution
    inner, outer = solution.bearing.inner, solution.bearing.outer

    def both(one: float, other: float, unit: str) -> str:
        return f"{quantity(one, unit)} inner, {quantity(other, unit)} outer"

    free = found.restitution_factor_free_spin
    spins = f"{number(free)}{' (overdamped)' if free == 0.0 else ''} if the ball may spin"
    hertz = f"{number(found.restitution_factor_hertz)} with a Hertzian pocket"
    stiffness = f"{quantity(found.ball_cage_stiffness, 'N/m')}, {solution.stiffness_source}"
    summed = f"{number(found.restitution_factor)} with race dampings summed (Eq. 18)"
    return [
        ("Contact angles", both(inner.contact_angle, outer.contact_angle, "rad")),
        ("Loads of the ball", both(inner.load, outer.load, "N")),
        ("Traction slopes", both(slopes.inner.slope, slopes.outer.slope, "-")),
        ("Race damping C_mu", quantity(found.race_damping, "N s/m")),
        ("Restitution factor", f"{summed}; {spins}; {hertz}"),
        ("Ball/cage stiffness", stiffness),
    ]


def _lead_and_lag(answer: OfCage) -> list[tuple[str, str]]:
    """Return how far balls run ahead and behind in a bearing whose balls do not run alike."""
    held = answer.solution.orbital_share
    if held is None:
        return []
    lead, clearance = (quantity(one, "m") for one in (answer.cage.lead_amplitude, answer.cage.half_play))
    share = f"{100 * held:.4g} %"
    words = (
        f"up to {lead} (pockets {clearance} each way); the harmonics used hold {share} of the speed variance"
    )
    return [("Free balls lead and lag", words)]
