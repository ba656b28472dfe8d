"""What a stability map can vary: every numeric key of a study, and what no study file holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from separatrix.errors import InputError
from separatrix.study import Film, Study, Wear
from separatrix.study_numbers import RADIAL_CLEARANCE, SECTIONS, SETTINGS, WHOLE, numbers_of, with_values

RESTITUTION, FRICTION, KICK = "restitution_factor", "ball_cage_friction", "kick"

RACE_FRICTION = "film.race_friction"
THICKNESS = "film.thickness"
"""Of a film; a map may begin at 0, where the races are bare."""

SHORT = {"cage.ball_cage_friction": FRICTION}
"""A key that goes by a name of its own, so that one parameter has one name."""

LONG = {name: key for key, name in SHORT.items()}

_MADE = {RADIAL_CLEARANCE: "m", "film.elastic_modulus": "Pa", "film.poisson_ratio": "-"}
"""Keys of a study file that its records hold under another name, and their units."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that a map varies: its name in a study file, and the SI unit it is written in."""

    name: str  # as in a study file
    unit: str  # in which values are written, SI

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers only."""
        return self.unit == WHOLE


def parameters() -> dict[str, Parameter]:
    """Every parameter a map can vary, by name."""
    names = {RESTITUTION: "-", FRICTION: "-", KICK: "m/s"} | _MADE
    for section, record in SECTIONS.items():
        names |= {f"{section}.{key}": unit for key, unit in numbers_of(record).items()}
    names |= {f"film.wear.{key}": unit for key, unit in numbers_of(Wear).items()}
    left = {name: unit for name, unit in names.items() if name not in (*SETTINGS, *SHORT)}
    return {name: Parameter(name, unit) for name, unit in left.items()}


def other_keys() -> list[str]:
    """Keys of a study that no map can vary: texts, lists, and how the ensemble is drawn."""
    known = parameters()
    keys = [f"{section}.{f.name}" for section, record in SECTIONS.items() for f in fields(record)]
    return [key for key in keys if key not in known and key not in SHORT] + ["kinematics.model"]


def varied(study: Study, values: Mapping[str, float]) -> Study:
    """Return the study with other values of some parameters, all at once.

    Restitution factor and kick are no keys of a study; the map gives them to the cage and to its runs. A film
    of no thickness is bare races.

    Raises
    ------
    InputError
        The study is refused, in the words of a study file.
    """
    keys = {LONG.get(name, name): value for name, value in values.items() if name not in (RESTITUTION, KICK)}
    for key in keys:
        section = key.partition(".")[0]
        if section == "film" and key in _MADE and study.film.material is None:
            raise InputError("[film]", "has no material whose properties could vary")
        if key.startswith("film.wear.") and study.film.wear is None:
            raise InputError("[film]", "has no wear that could vary")
        if getattr(study, section, study) is None:
            raise InputError(f"[{section}]", "is missing")
    if keys.get(THICKNESS) == 0.0:
        keys = {
            key: value for key, value in keys.items() if not key.startswith("film.") or key == RACE_FRICTION
        }
        study = replace(study, film=Film(race_friction=study.film.race_friction))
    return with_values(study, keys) if keys else study


def value_in(study: Study, name: str) -> float | None:
    """Value of a key in the study; None where it has none, or is not one of its keys."""
    value: object = study
    for step in name.split("."):
        value = getattr(value, step, None)
    return value if isinstance(value, int | float) else None
