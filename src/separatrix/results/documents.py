"""The answer to each question as plain data, under the names that scripts rely on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from separatrix.results.plain import plain

if TYPE_CHECKING:
    from separatrix.study_file import ResolvedStudy

PER_BALL = (
    "azimuth",
    "contact_angle_inner",
    "contact_angle_outer",
    "load_inner",
    "load_outer",
    "orbital_speed",
    "pitch_angle",
    "yaw_angle",
    "ball_spin",
    "spin_roll_ratio_inner",
    "spin_roll_ratio_outer",
    "rolling_speed_inner",
    "rolling_speed_outer",
    "centrifugal_force",
    "gyroscopic_moment",
    "race_control",
)
"""Fields of `Equilibrium` with one entry for each ball."""


def document(verb: str, record: Any, asked: ResolvedStudy, notes: Sequence[str]) -> dict[str, Any]:
    """Return the answer as plain data: SI units, no NaN, None where something is absent.

    Parameters
    ----------
    verb : str
        The question.
    record : record
        What the chain computed for it.
    asked : ResolvedStudy
        The study with its sources.
    notes : sequence of str
        What was said about validity on the way.
    """
    from separatrix import __version__

    head = {
        "separatrix_version": __version__,
        "verb": verb,
        "name": asked.study.name,
        "title": asked.study.title,
        "study": plain(asked.inputs, "study"),
        "seed": asked.study.stability.seed,
        "warnings": list(notes),
    }
    return head | DOCUMENTS.get(verb, plain)(record)


def bearing(record: Any) -> dict[str, Any]:
    """Equilibrium: a row for each ball, and the contacts of the most loaded one."""
    return equilibrium(record.equilibrium) | {"contacts": contacts(record)}


def equilibrium(record: Any) -> dict[str, Any]:
    """Return an `Equilibrium` with its per-ball arrays turned into rows."""
    flat = plain(record, "equilibrium")
    columns = {name: flat.pop(name) for name in PER_BALL if name in flat}
    balls = [
        {"ball": ball} | {name: column[ball] for name, column in columns.items()}
        for ball in range(len(columns["load_inner"]))
    ]
    return {"balls": balls, "most_loaded": int(record.most_loaded)} | flat


def contacts(record: Any) -> dict[str, Any]:
    """Return ellipse, rolling speed and creep of both races of the most loaded ball."""
    return {race: plain(contact, f"contacts.{race}") for race, contact in record.contacts.items()}


DOCUMENTS: Mapping[str, Callable[[Any], dict[str, Any]]] = {"bearing": bearing}
