"""Names, dimensions and units of what results hold: the one table behind the dataset."""

from __future__ import annotations

import functools
import importlib

RACES = ("inner", "outer")

PROVENANCE = ("separatrix_version", "verb", "title", "name", "study", "seed", "warnings", "complete")
"""Keys of a document that become attributes of the dataset."""

COORDINATES = frozenset(
    {"ball", "race", "environment", "material", "kick", "run", "time", "restitution_factor", "increment"}
)
"""Variables that name the points of a dimension."""

RECORDS: dict[str, tuple[str, str]] = {
    # key of a list of records (or a record): its dimension, and what goes before the names inside
    "balls": ("ball", ""),
    "contacts": ("", "contact_"),
}

LISTS: dict[str, tuple[str, ...]] = {
    # key of a list of numbers: its dimensions; a key that is missing here names its own
    "ball_spin": ("axis",),
}

RECORD_CLASSES = (("separatrix.study", "BallBearing Operation Film CageDesign StabilitySettings"),)
"""Classes whose annotations say the unit of a name; one quantity has one name everywhere."""


@functools.cache
def units() -> dict[str, str]:
    """Return the unit of each name that a record gives one."""
    from separatrix.results.plain import field_units

    known: dict[str, str] = {}
    for module, names in RECORD_CLASSES:
        for name in names.split():
            known |= field_units(getattr(importlib.import_module(module), name))
    return known


def unit_of(name: str) -> str | None:
    """Return the unit of a variable, also if its name has one of the prefixes; None for a text or a count."""
    known = units()
    if name in known:
        return known[name]
    endings = (name[len(prefix) :] for _, prefix in RECORDS.values() if prefix and name.startswith(prefix))
    return next((known[ending] for ending in endings if ending in known), None)
