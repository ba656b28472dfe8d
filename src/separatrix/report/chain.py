"""Text for the stages before the cage: what was understood, ball loads, traction, restitution."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any

from separatrix.report.tables import facts, number, quantity, section, significant, table

Document = Mapping[str, Any]
ENDS = ("", "_free_spin")


def bearing(document: Document) -> list[str]:
    """Ball loads and angles, ring displacement, and the contacts of the most loaded ball."""
    return [
        section("Inner ring", facts(_ring(document))),
        section("Balls", table(BALL_HEADERS, _balls(document["balls"]))),
        section("Contacts of the most loaded ball", by_race(document["contacts"], CONTACT_ROWS)),
    ]


def _ring(document: Document) -> list[tuple[str, str]]:
    return [
        ("Kinematics", document["model"]),
        ("Axial displacement", quantity(document["axial_displacement"], "m")),
        ("Radial displacement", quantity(document["radial_displacement"], "m")),
        ("Tilt", f"{quantity(document['tilt'], 'rad')} ({_tilt_is(document)})"),
        ("Moment of the balls", quantity(document["moment"], "N m")),
    ]


def _tilt_is(document: Document) -> str:
    if not document["is_tilt_held"]:
        return "free: the inner ring tilts until the balls balance the moment"
    return "the rings are held parallel" if document["tilt"] == 0.0 else "the rings are held at this angle"


CONTACT_ROWS = (
    ("Load", "load", "N"),
    ("Semi-major axis a, across the groove", "semi_major", "m"),
    ("Semi-minor axis b, along rolling", "semi_minor", "m"),
    ("Maximum Hertz pressure", "max_pressure", "Pa"),
    ("Mutual approach", "approach", "m"),
    ("Rolling speed", "rolling_speed", "m/s"),
)

BALL_HEADERS = (
    "ball",
    "azimuth\ndeg",
    "angle in\ndeg",
    "angle out\ndeg",
    "load in\nN",
    "load out\nN",
    "orbit\nrad/s",
    "pitch\ndeg",
    "spin/roll\ninner",
    "spin/roll\nouter",
)


def _balls(balls: Sequence[Document]) -> list[list[str]]:
    """Return a row for each ball, numbered from 1, or a single one if all are alike."""
    rows = [[str(ball["ball"] + 1), number(degrees(ball["azimuth"]), 1), *_ball(ball)] for ball in balls]
    alike = all(row[2:] == rows[0][2:] for row in rows)
    return [[f"all {len(rows)} balls", "-", *rows[0][2:]]] if alike else rows


def _ball(ball: Document) -> list[str]:
    return [
        *(_angle(ball, race) for race in ("inner", "outer")),
        number(ball["load_inner"], 1),
        number(ball["load_outer"], 1),
        number(ball["orbital_speed"], 1),
        number(degrees(ball["pitch_angle"]), 2),
        number(ball["spin_roll_ratio_inner"], 4),
        number(ball["spin_roll_ratio_outer"], 4),
    ]


def _angle(ball: Document, race: str) -> str:
    """Return the contact angle, or a dash where the ball does not touch this race."""
    return number(degrees(ball[f"contact_angle_{race}"]) if ball[f"{race}_contact"] else None, 2)


def traction(document: Document) -> list[str]:
    """Slopes of the traction curves, and how they change with the pivoting-to-rolling ratio."""
    rows = [
        ("Load", "load", "N"),
        ("Contact angle", "contact_angle", "rad"),
        ("Pivoting to rolling ratio", "spin_roll_ratio", "-"),
        ("Rolling speed", "rolling_speed", "m/s"),
        ("Slope alpha at the origin", "slope", "-"),
        ("Error of the slope", "slope_error", "-"),
        ("Free-rolling offset of the creep", "free_rolling_offset", "-"),
    ]
    others = zip(
        document["inner"]["by_spin_roll_ratio"], document["outer"]["by_spin_roll_ratio"], strict=True
    )
    ratios = [
        [f"{inner['spin_roll_ratio']:.2g}", significant(inner["slope"]), significant(outer["slope"])]
        for inner, outer in others
    ]
    return [
        section("Contacts of the most loaded ball", by_race(document, rows)),
        section(
            "Slope at other pivoting-to-rolling ratios",
            table(("ratio", "inner race", "outer race"), ratios),
        ),
    ]


def by_race(document: Document, rows: Sequence[tuple[str, str, str]]) -> str:
    """Return a table of quantities, inner and outer race side by side; a row is (label, key, unit)."""
    cells = [
        [label, *(quantity(document[race][key], unit) for race in ("inner", "outer"))]
        for label, key, unit in rows
    ]
    return table(("", "inner race", "outer race"), cells)


def restitution(document: Document) -> list[str]:
    """Both restitution factors and what they are made of."""
    rows = [
        ("Race damping C_mu", "race_damping", "N s/m"),
        ("Damping ratio zeta", "damping_ratio", "-"),
        ("Restitution factor eta", "restitution_factor", "-"),
    ]
    cells = [[label, *(quantity(document[f"{key}{end}"], unit) for end in ENDS)] for label, key, unit in rows]
    parts = [
        ("Load", "load", "N"),
        ("Slope alpha", "slope", "-"),
        ("Rolling speed", "rolling_speed", "m/s"),
    ]
    stiffness = f"{quantity(document['ball_cage_stiffness'], 'N/m')} ({document['stiffness_source']})"
    hertz = quantity(document["restitution_factor_hertz"], "-")
    pocket = [
        ("Ball/cage stiffness", stiffness),
        ("Cage mass", quantity(document["cage_mass"], "kg")),
        ("eta of a Hertzian pocket", f"{hertz} in an impact at the impact speed, less in a harder one"),
    ]
    return [
        section("Restitution factor", table(("", "dampings summed (Eq. 18)", "if the ball may spin"), cells)),
        section("From the contacts of the most loaded ball", by_race(document, parts)),
        section("And the pocket", facts(pocket)),
    ]
