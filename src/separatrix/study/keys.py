"""The numbers of a study by the names of a study file: unit, value, and the study with other values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from separatrix.ground.errors import InputError
from separatrix.ground.schema import OneOf, keys_of
from separatrix.ground.toml import nearest
from separatrix.ground.units import format_quantity, shown
from separatrix.study.study import SECTIONS as SECTIONS
from separatrix.study.study import Material, Study, Wear, key_of
from separatrix.study.uncertain import LOG_NORMAL, NORMAL, Distribution, described, positive_alternative

WHOLE = ""
"""Unit of a whole number."""

MOST_DISTRIBUTIONS = 50
SETTINGS = ("stability.runs", "stability.seed", "stability.reference_kick")
"""Numbers of the method, not of the bearing."""

DERIVED = {"bearing.contact_angle": "free_angle", "bearing.radial_clearance": "free_clearance"}
"""Numbers that follow from others where the study does not give them, and the property that has them."""

Path = tuple[str | int, ...]
Setter = Callable[[Sequence[float]], Study]


@dataclass(frozen=True, slots=True)
class StudyNumber:
    """One number of a study: its name in a study file, its SI unit, and its path in the records."""

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


def numbers_of(record: type) -> dict[str, str]:
    """Unit of each field of a record that is one number, perhaps absent."""
    return {name: one.unit for name, one in keys_of(record).items() if one.hint in (int, float)}


def study_numbers(study: Study) -> dict[str, StudyNumber]:
    """Every number that a study has or may have, by its name.

    A section's key is ``film.thickness``; a property of a material ``bearing.ball_material.density``, of the
    film's simply ``film.elastic_modulus``, of its wear ``film.wear.width``; a friction
    ``ranking.Armalon.liquid nitrogen, 440C``. Two numbers whose names come out alike (a dot in the name of a
    candidate) are left out.
    """
    found: list[StudyNumber] = []

    def add(name: str, record: type, path: Path) -> None:
        numbers = numbers_of(record).items()
        found.extend(StudyNumber(f"{name}.{key}", unit, (*path, key)) for key, unit in numbers)

    for section, record in SECTIONS.items():
        add(section, record, (section,))
        held = getattr(study, section)
        for f in fields(record) if held is not None else ():
            inside = getattr(held, f.name)
            if isinstance(inside, Material | Wear):
                is_film = isinstance(inside, Material) and section == "film"
                add(section if is_film else f"{section}.{f.name}", type(inside), (section, f.name))
    for place, candidate in enumerate(study.ranking.candidates if study.ranking else ()):
        path: Path = ("ranking", "candidates", place)
        known = [env for env, friction in candidate.friction.items() if friction is not None]
        for env in known:
            key = f"ranking.{candidate.name}.{env}"
            found.append(StudyNumber(key, "-", (*path, "friction", env, "mean")))
        if candidate.material is not None:
            add(f"ranking.{candidate.name}.material", Material, (*path, "material"))
    if study.film.material is not None:  # whose modulus is not that of a film without a name
        found = [one for one in found if one.path not in _OF_NAMELESS_FILM]
    often = Counter(number.key for number in found)
    return {number.key: number for number in found if often[number.key] == 1}


_OF_NAMELESS_FILM = (("film", "elastic_modulus"), ("film", "poisson_ratio"))


def value_of(study: Study, number: StudyNumber) -> float | None:
    """Value of a number in the study; None where it has none."""
    if number.key in DERIVED:
        found: float = getattr(study.bearing, DERIVED[number.key])
        return found
    held: Any = study
    for step in number.path:
        if held is not None:
            is_field = isinstance(step, str) and not isinstance(held, Mapping)
            held = getattr(held, str(step)) if is_field else held[step]
    return held if isinstance(held, int | float) else None


def with_values(study: Study, values: Mapping[str, float]) -> Study:
    """Return the study with other values of some of its numbers, all at once; these become certain.

    Raises
    ------
    InputError
        A name is unknown, or the study is refused, in the words of a study file.
    """
    return setter(study, list(values))(list(values.values()))


def setter(study: Study, keys: Sequence[str]) -> Setter:
    """Return a function from values of these numbers, in SI, to the study that has them.

    What excludes one of them, as a radial clearance excludes a contact angle, is no longer given.
    """
    known = study_numbers(study)
    chosen = [_known(known, key) for key in keys]
    left = {key: one for key, one in study.distributions.items() if key not in keys}

    def with_these(values: Sequence[float]) -> Study:
        changes: dict[Path, float] = {}
        for number, value in zip(chosen, values, strict=True):
            if number.is_whole and value != int(value):
                raise InputError("A whole number", "must be set to one", f"{value:g}")
            changes[number.path] = int(value) if number.is_whole else float(value)
        try:
            changed: Study = _changed(study, "", {**changes, ("distributions",): left})
            return changed
        except InputError as error:
            first = (error.problems or (error,))[0]
            raise first.at(key_of(first.path)) from None

    return with_these


def _known(known: Mapping[str, StudyNumber], key: str) -> StudyNumber:
    if key not in known:
        rule = "is not a numeric input of this study, or is ambiguous"
        raise InputError(shown(key), rule, cure=nearest(key, known))
    return known[key]


def _changed(held: Any, name: str, changes: Mapping[Path, object]) -> Any:
    """Record, tuple or mapping with other values at the paths inside it."""
    if () in changes:
        return changes[()]
    if held is None:
        raise InputError(f"[{name}]", "is missing")
    below: dict[str | int, dict[Path, object]] = {}
    for (step, *rest), value in changes.items():
        below.setdefault(step, {})[tuple(rest)] = value
    if isinstance(held, tuple):
        return tuple(_changed(x, name, below[i]) if i in below else x for i, x in enumerate(held))
    if isinstance(held, Mapping):
        return {k: _changed(x, str(k), below[k]) if k in below else x for k, x in held.items()}
    inside = {str(key): _changed(getattr(held, str(key), None), str(key), one) for key, one in below.items()}
    for rule in getattr(held, "RULES", ()):
        if isinstance(rule, OneOf) and any(key in inside for group in rule.groups for key in group):
            others = [key for group in rule.groups if not set(group) & set(inside) for key in group]
            inside |= {key: keys_of(type(held))[key].default for key in others}
    return replace(held, **inside)


def settled_in(study: Study, key: str, distribution: Distribution) -> Distribution:
    """The distribution, or the log-normal one in its place, whose both ends the study takes."""
    number = _known(study_numbers(study), key)
    refused = _refusal(study, number, distribution)
    if refused is None:
        return distribution
    other = positive_alternative(distribution)
    if other is not None and _refusal(study, number, other) is None:
        return other
    raise refused


def _refusal(study: Study, number: StudyNumber, distribution: Distribution) -> InputError | None:
    """Why the study does not take an end of the distribution; None if it takes both.

    Of a candidate's friction only the mean is stated: the tail of its log-normal scatter is taken as it is.
    """
    if number.is_friction and distribution.kind == LOG_NORMAL:
        return None
    put = setter(study, [number.key])
    for side, end in (("lower", distribution.low), ("upper", distribution.high)):
        try:
            put([end])
        except InputError as error:
            at = f"at the {side} end, {format_quantity(end, number.unit or '-')}"
            rule = f"leaves the range that the study takes {at}: {error.path} {error.rule}"
            wide = distribution.kind in (NORMAL, LOG_NORMAL)
            cure = "Make it narrower, or write { between = [..., ...] }." if wide else "Narrow it."
            got = distribution.text or described(distribution, number.unit)
            return InputError(number.key, rule, got, cure)
    return None
