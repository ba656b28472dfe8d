"""What a study resolved to: every value in SI with its unit and origin, every record with its source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from enum import Enum
from typing import Any

from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.distribution import Distribution, described
from separatrix.friction.file import FrictionTest
from separatrix.study import SECTIONS, CageDesign, Film, Friction, Material, RankingQuestion, Study, Wear
from separatrix.study_numbers import study_numbers
from separatrix.units import unit_of

_SCALED = "2.5 x cage speed x half the pocket clearance, at least 0.05 m/s"

_WITHOUT = {
    "bearing.bore": "not given; only the DN figure needs it",
    "operation.moment": "not given: the rings are held and carry any moment",
    "operation.tilt": "default: the rings are held parallel",
    "operation.temperature": "not given",
    "operation.fluid": "not given",
    "film.material": "default: bare races",
    "film.thickness": "default: bare races",
    "film.wear": "default: not worn",
    "film.wear.width": "not given",
    "film.wear.share": "not given",
    "film.wear.across": "not given",
    "film.wear.thicknesses": "not given",
    "cage.material": "not given",
    "cage.ball_cage_stiffness": "default: Hertz, ball in pocket, at the impact speed",
    "cage.impact_speed": f"default: {_SCALED}",
    "cage.ball_cage_friction": "default: that of its material in [ranking] environment",
    "cage.pocket_axial_clearance": "not given: that of the shape",
    "cage.pocket_angles": "default: evenly spaced",
    "cage.land_clearance": "not given: no land",
    "ranking.environment": "not given, and none fits the bearing",
    "stability.kicks": "default: 0.2, 1 and 4 times the reference kick",
    "stability.reference_kick": f"default: {_SCALED}",
    "stability.restitution_factors": "default: chosen where the curve bends",
    "cage.mass": "not given: that of the ring's shape",
    "cage.inner_diameter": "not given",
    "cage.outer_diameter": "not given",
    "cage.width": "not given",
    "cage.moment_of_inertia": "default: of the ring's shape, or a thin ring at the pitch diameter",
    "cage.transverse_inertia": "default: of the ring's shape, or half that about the axis",
    "cage.land_spacing": "not given",
    "cage.land_diameter": "default: of the ring's shape, or the pitch diameter",
}
"""What the absence of a value means."""


def resolved(study: Study) -> dict[str, Any]:
    """Resolved inputs as plain nested dicts: numbers, text, lists and None only.

    Each quantity is ``{"value": ..., "unit": ..., "origin": ...}``, in SI. The origin is the place and text
    in the study file, or ``"default"``. An uncertain one has its mean as value, and a ``"distribution"``;
    all of these are in ``"uncertain_inputs"`` too. Each material has its source and confidence, and the whole
    record of the library behind it, with the checksum of its file: a later change of the library changes
    nothing here.
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
        "kinematics": {"model": _origin(study, "kinematics.model", {"value": study.kinematics.value})},
        "ranking": None if study.ranking is None else _ranking(study, study.ranking),
        "uncertain_inputs": uncertain,
    }


def _section(study: Study, section: str) -> dict[str, Any] | None:
    record = getattr(study, section)
    if record is None:
        return None
    names = [f.name for f in fields(record) if f.name != "material_name"]
    values: dict[str, Any] = {name: _value(study, record, section, name) for name in names}
    if isinstance(record, Film):
        values["is_bare"] = record.material is None
        if record.wear is not None:
            del values["wear"]
            names = [f.name for f in fields(Wear)]
            values |= {f"wear.{name}": _value(study, record.wear, "film.wear", name) for name in names}
    if isinstance(record, CageDesign):  # whose friction the cage has, where it has not its own
        candidate = None if record.ball_cage_friction is not None else cage_candidate(study)
        environment = environment_of(study.ranking) if study.ranking and candidate else None
        whose = {"candidate": candidate.name if candidate else None, "environment": environment}
        values["ball_cage_friction"] |= whose
    return values


def _value(study: Study, record: object, section: str, name: str) -> dict[str, Any]:
    value, unit, key = getattr(record, name), unit_of(type(record), name), f"{section}.{name}"
    if isinstance(value, Material):
        item = _material(value)
        for number in ("elastic_modulus", "poisson_ratio", "density", "thermal_expansion"):
            one = study.distributions.get(f"{section if section == 'film' else key}.{number}")
            if one is not None:
                item[number]["distribution"] = _distribution(one, item[number]["unit"])
        return _origin(study, key, item)
    plain = value.value if isinstance(value, Enum) else list(value) if isinstance(value, tuple) else value
    item = {"value": plain, **({"unit": unit} if unit else {})}
    if key in study.records:
        item["record"] = study.records[key]
    if key in study.distributions:
        item["distribution"] = _distribution(study.distributions[key], unit)
    return _origin(study, key, item)


def _distribution(one: Distribution, unit: str) -> dict[str, Any]:
    names = ("kind", "mean", "standard_deviation", "low", "high")
    item = {name: getattr(one, name) for name in names}
    return {**item, "words": described(one, unit), "written": one.text or None}


def _origin(study: Study, key: str, item: Mapping[str, Any]) -> dict[str, Any]:
    """The item with where it was given; without any origins the study was built in Python."""
    origin = study.origins.get(key)
    if origin is None:
        origin = "default" if study.origins else "given in Python"
        if item.get("value", 0) in (None, []):
            origin = _WITHOUT.get(key, origin)
            if key == "operation.tilt" and not study.operation.is_tilt_held:
                origin = "free: the inner ring tilts until the balls balance the moment"
    return {**item, "origin": origin}


def _material(material: Material) -> dict[str, Any]:
    numbers = ("elastic_modulus", "poisson_ratio", "density", "compressive_strength", "thermal_expansion")
    return {
        "name": material.name,
        **{key: {"value": getattr(material, key), "unit": unit_of(Material, key)} for key in numbers},
        "source": material.source,
        "confidence": material.confidence,
        "cautions": list(material.cautions),
        "record": None if material.record is None else dict(material.record),
    }


def _ranking(study: Study, question: RankingQuestion) -> dict[str, Any]:
    from separatrix.friction.fit import TestedFriction

    candidates = [
        {
            "name": candidate.name,
            "friction": {env: f and _friction(f) for env, f in candidate.friction.items()},
            "material": candidate.material and _material(candidate.material),
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
        "table": study.records.get("ranking.friction"),
        # of the materials that are not ranked: the scatter is pooled over all tests of the file
        "other_tests": [_test(test) for test in tests if test.material not in ranked],
    }
    key = "ranking.candidates" if "ranking.candidates" in study.origins else "ranking.friction"
    return _origin(study, key, item)


def _friction(friction: Friction) -> dict[str, Any]:
    """A friction, and every test behind it if it comes from a friction file."""
    from separatrix.friction.fit import TestedFriction

    names = ("mean", "standard_deviation", "count", "source", "confidence")
    item: dict[str, Any] = {name: getattr(friction, name) for name in names}
    if isinstance(friction.law, TestedFriction):
        item["tests"] = [_test(test) for test in friction.law.own]
    return item


def _test(test: FrictionTest) -> dict[str, Any]:
    """A friction test in SI units; pairs are the lowest and the highest value."""
    values = {f.name: getattr(test, f.name) for f in fields(test)}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}
