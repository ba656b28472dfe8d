"""Names, dimensions and units of what results hold: the one table behind the dataset."""

from __future__ import annotations

import functools
import importlib
from dataclasses import dataclass

RACES = ("inner", "outer")

PROVENANCE = ("separatrix_version", "verb", "title", "name", "study", "seed", "warnings", "complete")
"""Keys of a document that become attributes of the dataset."""


@dataclass(frozen=True, slots=True)
class Group:
    """How a list of records (or one record, without dimension) becomes variables.

    `prefix` goes before the names inside; `label` is the key that names the points of the dimension.
    """

    dimension: str = ""
    prefix: str = ""
    label: str = ""


GROUPS = {
    "balls": Group("ball", label="ball"),
    "contacts": Group(prefix="contact_"),
    "by_spin_roll_ratio": Group("ratio", "ratio_"),
    "shear_strips": Group("strip", "strip_"),
    "lubrication": Group(prefix="lubrication_"),
    "chain": Group(prefix="chain_"),
    "stability": Group(),
    "curve": Group("restitution_factor", label="restitution_factor"),
    "linear_limit": Group("restitution_factor", "linear_limit_", label="restitution_factor"),
    "environments": Group("environment", label="name"),
    "materials": Group("material", "material_", label="name"),
    "overall": Group("material", "overall_", label="name"),
}
"""Key of a document: what becomes of the records under it. A key that is missing here is its own prefix."""

LISTS: dict[str, tuple[str, ...]] = {
    "ball_spin": ("axis",),
    "creep_increment": ("increment",),
    "traction_coefficient": ("increment",),
    "kicks": ("kick",),
}
"""Key of a list of numbers: its dimensions. A key that is missing here names its own."""

RENAMED = {"restitution_factor": "chain_restitution_factor"}
"""Single numbers that have the name of a dimension."""

RECORD_CLASSES = {
    "study": "BallBearing Operation Film CageDesign StabilitySettings",
    "hertz": "ContactEllipse",
    "creep": "Creep",
    "equilibrium": "Equilibrium",
    "traction": "TractionCurve",
    "restitution": "Restitution",
    "chain": "RaceContact",
    "cage": "PlanarCage Judgement",
    "stability": "CriticalFriction StabilityCurve",
    "ranking": "RankedMaterial",
}
"""Module: classes whose annotations say the unit of a name; one quantity has one name everywhere."""

OTHER_UNITS = {"creep_spin": "1/m", "creep_curvature": "1/m2"}


@functools.cache
def units() -> dict[str, str]:
    """Return the unit of each name that a record gives one."""
    from separatrix.results.plain import field_units

    known = dict(OTHER_UNITS)
    for module, names in RECORD_CLASSES.items():
        for name in names.split():
            known |= field_units(getattr(importlib.import_module(f"separatrix.{module}"), name))
    return known


PREFIXES = tuple(sorted({group.prefix for group in GROUPS.values() if group.prefix}))


def unit_of(name: str) -> str | None:
    """Return the unit of a variable, also if its name has a prefix; None for a text or a count."""
    known = units()
    if name in known:
        return known[name]
    parts = [name[len(prefix) :] for prefix in (*PREFIXES, "cage_") if name.startswith(prefix)]
    return next((unit_of(part) for part in parts), None)
