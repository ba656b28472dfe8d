"""Every resolved input of a study with its origin; what an answer keeps to be computed again."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from dataclasses import fields
from enum import Enum
from functools import cache
from importlib.metadata import version
from typing import Any

from separatrix.friction.friction_file import FrictionTest
from separatrix.ground.schema import keys_of
from separatrix.ground.units import unit_of
from separatrix.study.candidates import RankingSection, cage_candidate, environment_of
from separatrix.study.keys import DERIVED, study_numbers
from separatrix.study.reading import study_again
from separatrix.study.study import (
    ORDER,
    SECTIONS,
    CageDesign,
    Film,
    Friction,
    Material,
    RankingQuestion,
    Study,
    Wear,
)
from separatrix.study.uncertain import Distribution, described

PROPERTIES = {**DERIVED, "film.material": "body"}
"""Inputs that may follow from others, and the property that has them."""

MOST_KEPT = 64 * 1024**2
"""Characters of the files that an answer keeps."""


def resolved(study: Study) -> dict[str, Any]:
    """Resolved inputs as plain nested dicts: numbers, text, lists and None only.

    Each quantity is ``{"value": ..., "unit": ..., "origin": ...}``, in SI. The origin is the place and text
    in the study file, or ``"default"``. An uncertain one has its mean as value, and a ``"distribution"``;
    ``"uncertain_inputs"`` lists them all. Each material has its source, its confidence and its whole record
    in the library, with the checksum of the file: a later change of the library changes nothing here.
    """
    known = study_numbers(study) if study.distributions else {}
    uncertain = [
        {"name": key, "unit": known[key].unit or None, **_distribution(one, known[key].unit)}
        for key, one in study.distributions.items()
    ]
    return {
        "name": study.name,
        "title": study.title,
        **{name: _section(study, name) for name in SECTIONS},
        "ranking": None if study.ranking is None else _ranking(study, study.ranking),
        "uncertain_inputs": uncertain,
    }


def inputs_of(found: Mapping[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield section, key and entry of every input of a resolved study that has an origin."""
    for section in ORDER:
        for key, entry in (found[section] or {}).items():
            if isinstance(entry, dict) and "origin" in entry:
                yield section, key, entry


def _section(study: Study, section: str) -> dict[str, object] | None:
    record = getattr(study, section)
    if record is None:
        return None
    names = list(keys_of(type(record)))
    values: dict[str, object] = {name: _value(study, record, section, name) for name in names}
    if isinstance(record, Film):
        values["is_bare"] = record.body is None
        if record.wear is not None:
            del values["wear"]
            worn = record.wear
            values |= {f"wear.{name}": _value(study, worn, "film.wear", name) for name in keys_of(Wear)}
    if isinstance(record, CageDesign):  # whose friction the cage has, where it has not its own
        candidate = None if record.ball_cage_friction is not None else cage_candidate(study)
        values["ball_cage_friction"] = {
            **_value(study, record, section, "ball_cage_friction"),
            "candidate": candidate.name if candidate else None,
            "environment": environment_of(study.ranking) if study.ranking and candidate else None,
        }
    return values


def _value(study: Study, record: object, section: str, name: str) -> dict[str, object]:
    unit, key = unit_of(type(record), name), f"{section}.{name}"
    value = getattr(record, PROPERTIES.get(key, name))
    if isinstance(value, Material):
        inside = f"{section if section == 'film' else key}."
        own = {name.removeprefix(inside): one for name, one in study.distributions.items()}
        return _with_origin(study, key, _material(value, own))
    plain = value.value if isinstance(value, Enum) else list(value) if isinstance(value, tuple) else value
    item = {"value": plain, **({"unit": unit} if unit else {})}
    if key == "operation.fluid" and study.fluid is not None:
        item["record"] = study.fluid
    if key == "bearing.designation" and study.bearing.record is not None:
        item["record"] = study.bearing.record
    if key in study.distributions:
        item["distribution"] = _distribution(study.distributions[key], unit)
    return _with_origin(study, key, item)


def _distribution(one: Distribution, unit: str) -> dict[str, object]:
    names = ("kind", "mean", "standard_deviation", "low", "high")
    item = {name: getattr(one, name) for name in names}
    return {**item, "words": described(one, unit), "written": one.text or None}


def _with_origin(study: Study, key: str, item: Mapping[str, object]) -> dict[str, object]:
    """The item with its origin; a study without any was built in Python."""
    origin = study.origins.get(key)
    if origin is None:
        origin = "default" if study.origins else "given in Python"
        if item.get("value", 0) in (None, []):
            origin = _without(key)
            if key == "operation.tilt" and not study.operation.is_tilt_held:
                origin = "free: the inner ring tilts until the balls balance the moment"
    return {**item, "origin": origin}


def _without(key: str) -> str:
    """What the absence of a value means."""
    section, _, name = key.partition(".")
    keys = keys_of(SECTIONS.get(section, RankingSection))
    meaning = keys[name].key.without if name in keys else ""
    return meaning if meaning.startswith("not given") else f"default: {meaning}" if meaning else "not given"


def _material(material: Material, distributions: Mapping[str, Distribution]) -> dict[str, object]:
    numbers: dict[str, dict[str, object]] = {}
    for name in ("elastic_modulus", "poisson_ratio", "density", "compressive_strength", "thermal_expansion"):
        unit = unit_of(Material, name)
        numbers[name] = {"value": getattr(material, name), "unit": unit}
        if name in distributions:
            numbers[name]["distribution"] = _distribution(distributions[name], unit)
    return {
        "name": material.name,
        **numbers,
        "source": material.source,
        "confidence": material.confidence,
        "cautions": list(material.cautions),
        "record": None if material.record is None else dict(material.record),
    }


def _ranking(study: Study, question: RankingQuestion) -> dict[str, object]:
    from separatrix.friction.friction_fit import TestedFriction

    candidates = [
        {
            "name": candidate.name,
            "friction": {env: f and _friction(f) for env, f in candidate.friction.items()},
            "material": candidate.material and _material(candidate.material, {}),
        }
        for candidate in question.candidates
    ]
    laws = [f.law for one in question.candidates for f in one.friction.values() if f is not None]
    tests = next((law.tests for law in laws if isinstance(law, TestedFriction)), ())
    ranked = {candidate.name for candidate in question.candidates}
    item = {
        "environments": list(question.environments),
        "environment": _value(study, question, "ranking", "environment"),
        "candidates": candidates,
        "friction_scatter": _value(study, question, "ranking", "friction_scatter"),
        "table": study.friction_table,
        # of the materials that are not ranked: the scatter is pooled over all tests of the file
        "other_tests": [_test(test) for test in tests if test.material not in ranked],
    }
    key = "ranking.candidates" if "ranking.candidates" in study.origins else "ranking.friction"
    return _with_origin(study, key, item)


def _friction(friction: Friction) -> dict[str, object]:
    """A friction, and every test behind it if it comes from a friction file."""
    from separatrix.friction.friction_fit import TestedFriction

    names = ("mean", "standard_deviation", "count", "source", "confidence")
    item: dict[str, object] = {name: getattr(friction, name) for name in names}
    if isinstance(friction.law, TestedFriction):
        item["tests"] = [_test(test) for test in friction.law.own]
    return item


def _test(test: FrictionTest) -> dict[str, object]:
    """A friction test in SI units; pairs are the lowest and the highest value."""
    values: dict[str, object] = {}
    for name, value in ((f.name, getattr(test, f.name)) for f in fields(test)):
        if name == "run_in_end":
            values[name], values["run_in_axis"] = (value.value, value.axis) if value else (None, None)
        else:
            values[name] = list(value) if isinstance(value, tuple) else value
    return values


def provenance_of(study: Study, verb: str, question: Mapping[str, object]) -> dict[str, object]:
    """Return, as plain data, all that is needed to compute an answer of a verb again.

    That is the content of the study as its files have it, merged, with the texts of the files that it names;
    or, in its place, the reason why there is none.
    """
    return {
        "command": {"verb": verb, "question": dict(question)},
        "study": None if (reason := _not_kept(study)) else study.content,
        "reason": reason,
        "versions": versions(),
    }


def _not_kept(study: Study) -> str | None:
    """Why a study cannot be read again from its content; None if it can."""
    if study.content is None:
        return "The study was made in Python, not read from a file."
    if sum(map(len, study.content["files"].values())) > MOST_KEPT:
        return f"The files that the study names are larger than {MOST_KEPT >> 20} MB together."
    if study_again(study.content) != study:
        return "The study was changed in Python after it was read."
    return None


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages that compute, without separatrix."""
    return {"python": platform.python_version()} | {one: version(one) for one in ("numpy", "scipy", "numba")}
