"""What a stability map can vary: every numeric key of a study, and what no study file holds."""

from __future__ import annotations

import math
import types
import typing
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

from separatrix.errors import InputError
from separatrix.study import BallBearing, CageDesign, Film, Material, Operation, StabilitySettings, Study
from separatrix.units import Metre, Pascal, Radian, Ratio, format_quantity

SECTIONS: dict[str, type] = {
    "bearing": BallBearing,
    "operation": Operation,
    "film": Film,
    "cage": CageDesign,
    "stability": StabilitySettings,
}
NOT_VARIED = ("stability.runs", "stability.seed")
"""Numbers that say how the map is made, not what it is of."""

RESTITUTION, FRICTION, KICK = "restitution_factor", "ball_cage_friction", "kick"
WHOLE = ""
"""Unit of a whole number."""

SHORT = {"cage.ball_cage_friction": FRICTION}
"""A key that goes by a name of its own, so that one parameter has one name."""

LONG = {name: key for key, name in SHORT.items()}

Setter = Callable[[Study, Any], Study]


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that a map varies: its name in a study file, and the SI unit it is written in."""

    name: str
    unit: str

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers only."""
        return self.unit == WHOLE


def parameters() -> dict[str, Parameter]:
    """Every parameter a map can vary, by name."""
    names = {RESTITUTION: "-", FRICTION: "-", KICK: "m/s"} | {name: unit for name, (unit, _) in _MADE.items()}
    for section, record in SECTIONS.items():
        names |= {f"{section}.{key}": unit for key, unit in _numbers(record).items()}
    left = {name: unit for name, unit in names.items() if name not in (*NOT_VARIED, *SHORT)}
    return {name: Parameter(name, unit) for name, unit in left.items()}


def other_keys() -> list[str]:
    """Keys of a study that no map can vary: texts, lists, and how the ensemble is drawn."""
    known = parameters()
    keys = [f"{section}.{f.name}" for section, record in SECTIONS.items() for f in fields(record)]
    return [key for key in keys if key not in known and key not in SHORT] + ["kinematics.model"]


def varied(study: Study, name: str, value: float) -> Study:
    """Return the study with another value of one parameter.

    Restitution factor and kick are no keys of a study; the map gives them to the cage and to its runs.

    Raises
    ------
    InputError
        The study is refused, in the words of a study file.
    """
    if name in (RESTITUTION, KICK):
        return study
    if name in _MADE:
        return _MADE[name][1](study, value)
    section, _, key = LONG.get(name, name).partition(".")
    record = getattr(study, section)
    if record is None:
        raise InputError(f"[{section}]", "is missing")
    try:
        return replace(study, **{section: replace(record, **{key: value})})
    except InputError as error:
        raise _in_the_words_of_a_file(error) from None


def changes_traction(name: str) -> bool:
    """Whether the traction on the races depends on a parameter."""
    return name.startswith(("bearing.", "operation.", "film."))


def value_in(study: Study, name: str) -> float | None:
    """Value of a key in the study; None where it has none, or is not one of its keys."""
    section, _, key = name.partition(".")
    value = getattr(getattr(study, section, None), key, None)
    return value if isinstance(value, int | float) else None


def _numbers(record: type) -> dict[str, str]:
    """Unit of each field of a record that is one number."""
    hints = typing.get_type_hints(record, include_extras=True)
    units = {f.name: _unit(hints[f.name]) for f in fields(record)}
    return {name: unit for name, unit in units.items() if unit is not None}


def _unit(hint: Any) -> str | None:
    """Unit of an annotation of one number, perhaps absent; None for anything else."""
    if isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union:
        parts = [part for part in typing.get_args(hint) if part is not types.NoneType]
        return _unit(parts[0]) if len(parts) == 1 else None
    if hint is int:
        return WHOLE
    unit = getattr(hint, "__metadata__", (None,))[0]
    return unit if isinstance(unit, str) else None


def _in_the_words_of_a_file(error: InputError) -> InputError:
    """Name the key as a study file does: ``[cage] pocket_clearance``."""
    sections = {record.__name__: section for section, record in SECTIONS.items()}
    problem = (error.problems or (error,))[0]
    record, _, key = problem.where.partition(".")
    where = f"[{sections[record]}] {key}" if record in sections else problem.where
    return InputError(where, problem.rule, problem.unit, problem.value, problem.cure)


def _film_material(study: Study) -> Material:
    if study.film.material is None:
        raise InputError("[film]", "has no material whose properties could vary")
    return study.film.material


def _film_modulus(study: Study, value: Pascal) -> Study:
    material = replace(_film_material(study), elastic_modulus=value)
    return replace(study, film=replace(study.film, material=material))


def _film_poisson(study: Study, value: Ratio) -> Study:
    material = replace(_film_material(study), poisson_ratio=value)
    return replace(study, film=replace(study.film, material=material))


def _clearance(study: Study, value: Metre) -> Study:
    angle = free_contact_angle(study.bearing, value)
    return replace(study, bearing=replace(study.bearing, contact_angle=angle))


def free_contact_angle(bearing: BallBearing, radial_clearance: Metre) -> Radian:
    """Contact angle without load: cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D).

    Raises
    ------
    InputError
        The clearance is negative or leaves no angle.
    """
    room = 2.0 * (bearing.inner_conformity + bearing.outer_conformity - 1.0) * bearing.ball_diameter
    if not 0.0 <= radial_clearance < room:
        rule = f"must be >= 0 and < {format_quantity(room, 'm')}, where the free contact angle reaches 90 deg"
        raise InputError("[bearing] radial_clearance", rule, "", format_quantity(radial_clearance, "m"))
    return 2.0 * math.asin(math.sqrt(0.5 * radial_clearance / room))


_MADE: dict[str, tuple[str, Setter]] = {
    "bearing.radial_clearance": ("m", _clearance),
    "film.elastic_modulus": ("Pa", _film_modulus),
    "film.poisson_ratio": ("-", _film_poisson),
}
"""Keys of a study file that its records hold under another name: unit, and how they are set."""
