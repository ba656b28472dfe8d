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


SOURCES = (
    *("pocket_friction", "race_dampers", "ball_drive", "land_friction", "land_damping"),
    *("gravity", "moving_frame", "unbalance"),
)
"""What does work on the cage."""

GROUPS = {
    "balls": Group("ball", label="ball"),
    "contacts": Group(prefix="contact_"),
    "by_spin_roll_ratio": Group("ratio", "ratio_"),
    "lubrication": Group(prefix="lubrication_"),
    "chain": Group(prefix="chain_"),
    "stopping": Group(prefix="stopping_"),
    "counts": Group(prefix="points_"),
    "inference": Group(prefix="inference_"),
    "stability": Group(),
    "curve": Group("restitution_factor", label="restitution_factor"),
    "linear_limit": Group("restitution_factor", "linear_limit_", label="restitution_factor"),
    "hard_limit": Group("restitution_factor", "hard_limit_", label="restitution_factor"),
    "here": Group(prefix="here_"),
    "own_curves": Group("material", label="name"),
    "pocket": Group(prefix="pocket_"),
    "environments": Group("environment", label="name"),
    "materials": Group("material", "material_", label="name"),
    "overall": Group("material", "overall_", label="name"),
    "by_kick": Group("kick", "by_kick_", label="kick"),
}
"""Key of a document: what becomes of the records under it. A key that is missing here is its own prefix."""

LISTS: dict[str, tuple[str, ...]] = {
    "ball_spin": ("axis",),
    "pocket_angles": ("pocket",),
    "orbital_cosines": ("harmonic",),
    "orbital_sines": ("harmonic",),
    "creep_increment": ("increment",),
    "traction_coefficient": ("increment",),
    "kicks": ("kick",),
    "own_critical_friction": ("own_eta",),
    "kick_low": ("kick",),
    "kick_critical_friction": ("kick",),
    "kick_high": ("kick",),
    "restitution_factor": ("race_friction", "film_thickness"),
    "restitution_factor_free_spin": ("race_friction", "film_thickness"),
    "across": ("strip",),
    "creep_ratio": ("strip",),
    "sweeps": ("strip",),
    "along": ("strip", "node"),
    "pressure": ("strip", "node"),
    "shear": ("strip", "node"),
    "shear_without_slip": ("strip", "node"),
    "slip": ("strip", "node"),
    "position": ("time", "axis"),
    "velocity": ("time", "axis"),
    "ball_lead": ("time", "ball"),
    "contact_force": ("time", "ball"),
    "pocket_angle": ("ball",),
    "half_play": ("ball",),
    "pocket_impact_shares": ("ball",),
} | dict.fromkeys(
    (
        *("rotation", "rotation_rate", "land_force", "kinetic_energy", "spring_energy", "land_energy"),
        *SOURCES,
    ),
    ("time",),
)
"""Key of a list of numbers: its dimensions. A key that is missing here names its own."""

JOINED = ("extrapolation",)
"""Lists of texts of which each record may have another number: in a dataset they are one text."""

RENAMED = {"restitution_factor": "chain_restitution_factor"}
"""Single numbers that have the name of a dimension."""

RECORD_CLASSES = {
    "study": "BallBearing Operation Film CageDesign StabilitySettings",
    "hertz": "ContactEllipse",
    "creep": "Creep",
    "equilibrium": "Equilibrium",
    "traction": "TractionCurve ShearField",
    "restitution": "Restitution",
    "chain": "RaceContact",
    "cage": "PlanarCage Judgement KickCount History",
    "stability": "CriticalFriction StabilityCurve",
    "stability.map_records": "MapPoint Stopping Inference",
    "ranking": "RankedMaterial Ranking OwnCurve",
    "explore.records": "UncertainMaterial UncertainStudy",
    "explore.sweep": "SweptCase",
    "pocket_contact": "PocketConditions",
}
"""Module: classes whose annotations say the unit of a name; one quantity has one name everywhere."""

OTHER_UNITS = {
    "creep_spin": "1/m",
    "creep_curvature": "1/m2",
    "azimuth": "rad",
    "load_inner": "N",
    "load_outer": "N",
    "contact_angle_inner": "rad",
    "contact_angle_outer": "rad",
    "orbital_speed": "rad/s",
    "pitch_angle": "rad",
    "yaw_angle": "rad",
    "ball_spin": "rad/s",
    "spin_roll_ratio_inner": "-",
    "spin_roll_ratio_outer": "-",
    "rolling_speed_inner": "m/s",
    "rolling_speed_outer": "m/s",
    "centrifugal_force": "N",
    "gyroscopic_moment": "N m",
    "creep_increment": "-",
    "traction_coefficient": "-",
    "film_thickness": "m",
    "film_thickness_here": "m",
    "race_friction": "-",
    "across": "m",
    "along": "m",
    "creep_ratio": "-",
    "pressure": "Pa",
    "shear": "Pa",
    "shear_without_slip": "Pa",
    "time": "s",
    "position": "m",
    "velocity": "m/s",
    "rotation": "rad",
    "rotation_rate": "rad/s",
    "ball_lead": "m",
    "contact_force": "N",
    "land_force": "N",
    "kinetic_energy": "J",
    "spring_energy": "J",
    "land_energy": "J",
    "pocket_angle": "rad",
    "pocket_impact_shares": "-",
    "kick": "m/s",
    "kicks": "m/s",
    "own_eta": "-",
    "own_critical_friction": "-",
    "drift_rate": "1/s",
    "drift_rate_law": "1/s",
    "friction": "-",
    "default_scatter": "-",
    "linear_limit": "-",
    "growth_rate": "1/s",
    "growth_rate_low": "1/s",
    "growth_rate_high": "1/s",
    "half_play": "m",
    "lead_amplitude": "m",
    "orbital_share": "-",
} | {f"work_{source}": "J" for source in SOURCES}
"""Units of arrays, whose type does not carry one."""


@functools.cache
def units() -> dict[str, str]:
    """Return the unit of each name that a record gives one."""
    from separatrix.results.plain import field_units

    known = dict(OTHER_UNITS)
    for module, names in RECORD_CLASSES.items():
        for name in names.split():
            known |= field_units(getattr(importlib.import_module(f"separatrix.{module}"), name))
    return known


PREFIXES = (*sorted({group.prefix for group in GROUPS.values() if group.prefix}), "cage_", "shear_", "work_")


def unit_of(name: str) -> str | None:
    """Return the unit of a variable, also if its name has a prefix; None for a text or a count."""
    known = units()
    if name in known:
        return known[name]
    parts = (name.removeprefix(prefix) for prefix in PREFIXES if name.startswith(prefix))
    return next((unit for part in parts if (unit := unit_of(part)) is not None), None)
