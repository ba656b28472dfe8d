"""The numbers of a study by the names of a study file: unit, value, and the study with other values."""

from __future__ import annotations

import math
import types
import typing
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any

from separatrix.distribution import Distribution, LogNormal, Normal, described, positive_alternative
from separatrix.errors import InputError
from separatrix.study import SECTIONS as SECTIONS
from separatrix.study import BallBearing, Candidate, Material, Study, key_of
from separatrix.toml_values import nearest
from separatrix.units import Metre, Radian, format_quantity, shown

WHOLE = ""
"""Unit of a whole number."""

RADIAL_CLEARANCE = "bearing.radial_clearance"
MOST_DISTRIBUTIONS = 50
SETTINGS = ("stability.runs", "stability.seed", "stability.reference_kick")
"""Numbers that say how an answer is made, not what it is of."""


ANGLE_FROM = ("ball_diameter", "inner_conformity", "outer_conformity")
"""What the contact angle depends on where the clearance is held."""

Path = tuple[str | int, ...]
Setter = Callable[[Sequence[float]], Study]


@dataclass(frozen=True, slots=True)
class StudyNumber:
    """One number of a study: its name in a study file, its SI unit, and where its records hold it."""

    key: str
    unit: str
    path: Path

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers only."""
        return self.unit == WHOLE

    @property
    def is_friction(self) -> bool:
        """Whether it is the mean friction of a candidate."""
        return self.path[-1] == "mean"


@cache
def numbers_of(record: type) -> dict[str, str]:
    """Unit of each field of a record that is one number."""
    hints = typing.get_type_hints(record, include_extras=True)
    units = {f.name: _unit(hints[f.name]) for f in fields(record)}
    return {name: unit for name, unit in units.items() if unit is not None}


def study_numbers(study: Study) -> dict[str, StudyNumber]:
    """Every number that a study has or may have, by its name.

    A section's key is ``film.thickness``; a property of a material ``bearing.ball_material.density``, of the
    film's simply ``film.elastic_modulus``; a friction ``ranking.Armalon.liquid nitrogen, 440C``. Two numbers
    whose names come out alike (a dot in the name of a candidate) are left out.
    """
    found = [StudyNumber(RADIAL_CLEARANCE, "m", ("bearing", "radial_clearance"))]
    for section, record in SECTIONS.items():
        found += [StudyNumber(f"{section}.{key}", unit, (section, key)) for key, unit in _units(record)]
        found += _materials(section, getattr(study, section))
    for place, candidate in enumerate(study.ranking.candidates if study.ranking else ()):
        found += _of_candidate(candidate, ("ranking", "candidates", place))
    often = Counter(number.key for number in found)
    return {number.key: number for number in found if often[number.key] == 1}


def _units(record: type) -> list[tuple[str, str]]:
    return list(numbers_of(record).items())


def _materials(section: str, record: object) -> list[StudyNumber]:
    """Numbers of the materials that a section holds."""
    found = []
    for name in [f.name for f in fields(record)] if is_dataclass(record) else []:
        if isinstance(getattr(record, name), Material):
            prefix = section if section == "film" else f"{section}.{name}"
            path = (section, name)
            found += [StudyNumber(f"{prefix}.{key}", u, (*path, key)) for key, u in _units(Material)]
    return found


def _of_candidate(candidate: Candidate, path: Path) -> list[StudyNumber]:
    name = f"ranking.{candidate.name}"
    known = [env for env, friction in candidate.friction.items() if friction is not None]
    found = [StudyNumber(f"{name}.{env}", "-", (*path, "friction", env, "mean")) for env in known]
    if candidate.material is not None:
        at = (*path, "material")
        found += [StudyNumber(f"{name}.material.{key}", u, (*at, key)) for key, u in _units(Material)]
    return found


def value_of(study: Study, number: StudyNumber) -> float | None:
    """Value of a number in the study; None where it has none."""
    if number.key == RADIAL_CLEARANCE:
        return radial_clearance(study.bearing)
    held: Any = study
    for step in number.path:
        held = None if held is None else _inside(held, step)
    return held if isinstance(held, int | float) else None


def _inside(held: Any, step: Any) -> Any:
    return held[step] if isinstance(held, Mapping | tuple) else getattr(held, step)


def with_values(study: Study, values: Mapping[str, float]) -> Study:
    """Return the study with other values of some of its numbers, by their names, all at once.

    A number that is set is certain: its distribution is dropped.

    Raises
    ------
    InputError
        A name is unknown, or the study is refused, in the words of a study file.
    """
    return setter(study, list(values))(list(values.values()))


def setter(study: Study, keys: Sequence[str]) -> Setter:
    """Return a function from values of these numbers, in SI, to the study that has them.

    Where the study was given its radial clearance, the clearance stays and the contact angle follows.
    """
    known = study_numbers(study)
    chosen = [_known(known, key) for key in keys]
    paths = [number.path for number in chosen]
    left = {key: one for key, one in study.distributions.items() if key not in keys}
    held = _held_clearance(study, keys)

    def with_these(values: Sequence[float]) -> Study:
        changes: dict[Any, Any] = {} if held is None else {"bearing": {"radial_clearance": held}}
        for number, path, value in zip(chosen, paths, values, strict=True):
            _put(changes, path, _whole(value) if number.is_whole else float(value))
        try:
            parts = {name: _changed(getattr(study, name), name, part) for name, part in changes.items()}
            return replace(study, **parts, distributions=left)
        except InputError as error:
            first = (error.problems or (error,))[0]
            raise first.at(key_of(first.path)) from None

    return with_these


def _known(known: Mapping[str, StudyNumber], key: str) -> StudyNumber:
    if key not in known:
        raise InputError(
            shown(key), "is not a numeric input of this study, or is ambiguous", cure=nearest(key, known)
        )
    return known[key]


def _whole(value: float) -> int:
    if value != int(value):
        raise InputError("A whole number", "must be set to one", f"{value:g}")
    return int(value)


def _put(changes: dict[Any, Any], path: Path, value: float) -> None:
    for step in path[:-1]:
        changes = changes.setdefault(step, {})
    changes[path[-1]] = value


def _changed(held: Any, name: str, changes: dict[Any, Any]) -> Any:
    """Record, tuple or mapping with other values inside."""
    if held is None:
        raise InputError(f"[{name}]", "is missing")
    if isinstance(held, tuple):
        return tuple(_changed(x, name, changes[i]) if i in changes else x for i, x in enumerate(held))
    if isinstance(held, Mapping):
        return {k: _changed(x, str(k), changes[k]) if k in changes else x for k, x in held.items()}
    inside = {
        key: _changed(getattr(held, key), key, value) if isinstance(value, dict) else value
        for key, value in changes.items()
    }
    if isinstance(held, BallBearing) and "radial_clearance" in inside:
        inside["contact_angle"] = _angle(held, inside)
    return replace(held, **inside)


def _angle(bearing: BallBearing, changes: dict[str, Any]) -> Radian:
    clearance = changes.pop("radial_clearance")
    diameter, inner, outer = (changes.get(key, getattr(bearing, key)) for key in ANGLE_FROM)
    return contact_angle_of(clearance, diameter, inner, outer)


def contact_angle_of(radial_clearance: Metre, diameter: Metre, inner: float, outer: float) -> Radian:
    """Contact angle without load: cos(angle) = 1 - P_d / (2 (f_i + f_o - 1) D).

    Raises
    ------
    InputError
        The clearance is negative or leaves no angle.
    """
    room = 2.0 * (inner + outer - 1.0) * diameter
    if not 0.0 <= radial_clearance < room:
        rule = f"must be >= 0 and < {format_quantity(room, 'm')}, where the free contact angle reaches 90 deg"
        raise InputError("[bearing] radial_clearance", rule, format_quantity(radial_clearance, "m"))
    return 2.0 * math.asin(math.sqrt(0.5 * radial_clearance / room))


def radial_clearance(bearing: BallBearing) -> Metre:
    """Diametral play of the bearing without load, P_d = 2 (f_i + f_o - 1) D (1 - cos(angle))."""
    room = 2.0 * (bearing.inner_conformity + bearing.outer_conformity - 1.0) * bearing.ball_diameter
    return 2.0 * room * math.sin(0.5 * bearing.contact_angle) ** 2


def _held_clearance(study: Study, keys: Sequence[str]) -> Metre | None:
    """Clearance to keep, where the study gave it and what makes an angle of it changes; else None."""
    if RADIAL_CLEARANCE in keys or "bearing.contact_angle" in keys or RADIAL_CLEARANCE not in study.origins:
        return None
    moved = any(f"bearing.{key}" in keys for key in ANGLE_FROM)
    return radial_clearance(study.bearing) if moved else None


def with_distributions(study: Study, given: Mapping[str, Distribution]) -> Study:
    """Return the study with these numbers uncertain; it holds the mean of each.

    A normal distribution becomes log-normal where the study takes no number down to its low end.

    Raises
    ------
    InputError
        A name is unknown, a distribution leaves the range that the study takes, or there are too many.
    """
    central = with_values(study, {key: one.mean for key, one in given.items()})
    settled = {**central.distributions, **{key: settled_in(central, key, one) for key, one in given.items()}}
    if len(settled) > MOST_DISTRIBUTIONS:
        rule = f"has more uncertain numbers than {MOST_DISTRIBUTIONS}"
        raise InputError(study.name, rule, str(len(settled)), "Make those certain that matter least.")
    return replace(central, distributions=settled)


def settled_in(study: Study, key: str, distribution: Distribution) -> Distribution:
    """The distribution, or the log-normal one in its place, whose both ends the study takes.

    Raises
    ------
    InputError
        It takes neither: which end, and why.
    """
    number = _known(study_numbers(study), key)
    other = positive_alternative(distribution)
    refused = _refusal(study, number, distribution)
    if refused is None:
        return distribution
    if other is not None and _refusal(study, number, other) is None:
        return other
    raise refused


def _refusal(study: Study, number: StudyNumber, distribution: Distribution) -> InputError | None:
    """Why the study does not take an end of the distribution; None if it takes both.

    Of a candidate's friction only the mean is stated: the tail of its log-normal scatter is taken as it is.
    """
    if number.is_friction and isinstance(distribution, LogNormal):
        return None
    key, unit, put = number.key, number.unit, setter(study, [number.key])
    for side, end in (("lower", distribution.low), ("upper", distribution.high)):
        try:
            put([end])
        except InputError as error:
            where = f"at the {side} end, {format_quantity(end, unit or '-')}: {error.path} {error.rule}"
            rule = f"leaves the range that the study takes {where}"
            wide = isinstance(distribution, Normal | LogNormal)
            cure = "Make it narrower, or write { between = [..., ...] }." if wide else "Narrow it."
            return InputError(key, rule, distribution.text or described(distribution, unit), cure)
    return None


def _unit(hint: Any) -> str | None:
    """Unit of an annotation of one number, perhaps absent; None for anything else."""
    if isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union:
        parts = [part for part in typing.get_args(hint) if part is not types.NoneType]
        return _unit(parts[0]) if len(parts) == 1 else None
    if hint is int:
        return WHOLE
    unit = getattr(hint, "__metadata__", (None,))[0]
    return unit if isinstance(unit, str) else None
