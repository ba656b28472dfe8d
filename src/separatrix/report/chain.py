"""Text for the stages before the cage: what was understood, ball loads, traction, restitution."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from typing import Any

from separatrix.report.tables import facts, number, quantity, section, significant, table

Document = Mapping[str, Any]


def bearing(document: Document) -> list[str]:
    """Ball loads and angles, ring displacement, and the contacts of the most loaded ball."""
    return [
        section("Inner ring", facts(_ring(document))),
        section("Balls", table(BALL_HEADERS, [_ball(ball) for ball in document["balls"]])),
        section("Contacts of the most loaded ball", contact_table(document["contacts"])),
    ]


def _ring(document: Document) -> list[tuple[str, str]]:
    return [
        ("Kinematics", document["model"]),
        ("Axial displacement", quantity(document["axial_displacement"], "m")),
        ("Radial displacement", quantity(document["radial_displacement"], "m")),
        ("Tilt", quantity(document["tilt"], "rad")),
    ]


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


def _ball(ball: Document) -> list[str]:
    return [
        str(ball["ball"]),
        number(degrees(ball["azimuth"]), 1),
        number(degrees(ball["contact_angle_inner"]), 2),
        number(degrees(ball["contact_angle_outer"]), 2),
        number(ball["load_inner"], 1),
        number(ball["load_outer"], 1),
        number(ball["orbital_speed"], 1),
        number(degrees(ball["pitch_angle"]), 2),
        number(ball["spin_roll_ratio_inner"], 4),
        number(ball["spin_roll_ratio_outer"], 4),
    ]


def contact_table(contacts: Document) -> str:
    """Return ellipse and rolling speed of both races side by side."""
    rows = [
        ("Load", "load", "N"),
        ("Semi-major axis a, across the groove", "semi_major", "m"),
        ("Semi-minor axis b, along rolling", "semi_minor", "m"),
        ("Largest pressure", "max_pressure", "Pa"),
        ("Approach", "approach", "m"),
        ("Rolling speed", "rolling_speed", "m/s"),
    ]
    cells = [
        [label, *(quantity(contacts[race][key], unit) for race in ("inner", "outer"))]
        for label, key, unit in rows
    ]
    return table(("", "inner race", "outer race"), cells)


def check(document: Document) -> list[str]:
    """Return every resolved input, a section each, with its source."""
    return [
        section(f"[{name}]", facts(_flat(part))) for name, part in document["study"].items() if isinstance(part, Mapping)
    ]


def _flat(part: Document, prefix: str = "") -> list[tuple[str, str]]:
    pairs: list[tuple[str, str]] = []
    for key, value in part.items():
        if isinstance(value, Mapping):
            pairs += _flat(value, f"{prefix}{key}.")
        else:
            pairs.append((prefix + key, significant(value) if isinstance(value, float) else str(value)))
    return pairs
