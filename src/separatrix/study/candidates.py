"""Candidate of the cage and environment of the bearing, the same for every verb."""

from __future__ import annotations

from separatrix.ground.errors import InputError
from separatrix.ground.units import shown
from separatrix.study.study import Candidate, RankingQuestion, Study

NAMELESS = "given in the study"
"""Name of a material in place that has none."""


def cage_candidate(study: Study) -> Candidate | None:
    """Candidate that [cage] material names, else the only one; None if the study states none."""
    candidates = study.ranking.candidates if study.ranking else ()
    name = _name(study)
    if not name and len(candidates) == 1:
        return candidates[0]
    return next((candidate for candidate in candidates if candidate.name == name), None)


def reference_candidate(study: Study, question: RankingQuestion) -> Candidate:
    """Candidate whose eta and curve are the bearing's in a ranking: the cage's, else the first one."""
    return cage_candidate(study) or question.candidates[0]


def other_than_candidates(study: Study, question: RankingQuestion) -> str:
    """Sentence on a cage whose material is not a candidate: the curve is another's; else empty."""
    given = study.cage.material if study.cage else None
    if given is None or cage_candidate(study) is not None:
        return ""
    name = "[cage] material" if given.name == NAMELESS else f"[cage] material {given.name}"
    shown_for = question.candidates[0].name
    return f"{name} is none of the candidates: the curve, and the eta beside it, are those of {shown_for}."


def environment_of(question: RankingQuestion) -> str | None:
    """Return the stated environment, else the only one; None if the study states none."""
    alone = question.environments[0] if len(question.environments) == 1 else None
    return question.environment or alone


def required_environment(study: Study, question: RankingQuestion) -> str:
    """Return the environment of the bearing."""
    found = environment_of(question)
    if found is None:
        rule = (
            "is missing: no environment, or more than one, matches [operation] fluid and the bearing's steel"
        )
        names = " or ".join(f'"{name}"' for name in question.environments)
        raise InputError(f"{study.name}: [ranking] environment", rule, cure=f"Write environment = {names}.")
    return found


def require_friction(study: Study) -> None:
    """Refuse a study whose cage has no known friction, with the missing key and its alternatives."""
    if study.cage is not None and study.cage.ball_cage_friction is not None:
        return
    where = f"{study.name}: [cage] ball_cage_friction"
    if study.ranking is None:
        raise InputError(where, "is missing", cure="Give it, or [ranking] with measured frictions.")
    candidate, named = cage_candidate(study), _name(study)
    if candidate is None:
        who = f"{shown(named)} is not a candidate" if named else "[cage] material does not name a candidate"
        names = ", ".join(one.name for one in study.ranking.candidates)
        cure = f"Give it, or name a candidate as [cage] material: {names}."
        raise InputError(where, f"is missing, and {who}", cure=cure)
    environment = required_environment(study, study.ranking)
    if candidate.friction.get(environment) is None:
        rule = f"is missing: {candidate.name} was not measured in {environment}"
        raise InputError(where, rule, cure="Give it.")


def _name(study: Study) -> str:
    """Name of the cage's material; empty without one."""
    if study.cage is None:
        return ""
    material = study.cage.material
    return study.cage.material_name or (material.name if material and material.name != NAMELESS else "")


def ranking_question(study: Study) -> RankingQuestion:
    """Return the question of [ranking], or refuse a study without candidates."""
    if study.ranking is None or not study.ranking.candidates:
        cure = 'Write friction = "pin-on-disk-77K" there, or [[ranking.candidates]].'
        raise InputError(study.name, "lacks the section [ranking] with candidate materials", cure=cure)
    return study.ranking
