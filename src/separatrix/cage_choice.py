"""Which candidate the cage is made of, and which environment the bearing runs in: alike for every verb."""

from __future__ import annotations

from separatrix.errors import InputError
from separatrix.study import Candidate, Friction, RankingQuestion, Study
from separatrix.units import Ratio, shown

NAMELESS = "given in the study"
"""Name of a material in place that has none."""


def cage_candidate(study: Study) -> Candidate | None:
    """Candidate that [cage] material names, else the only one; None if the study does not say."""
    candidates = study.ranking.candidates if study.ranking else ()
    name = _name(study)
    if not name and len(candidates) == 1:
        return candidates[0]
    return next((candidate for candidate in candidates if candidate.name == name), None)


def reference_candidate(study: Study, question: RankingQuestion) -> Candidate:
    """Candidate whose eta and curve are the bearing's in a ranking: the cage's, else the first one."""
    return cage_candidate(study) or question.candidates[0]


def other_than_candidates(study: Study, question: RankingQuestion) -> str:
    """A sentence on a cage whose material is no candidate: the curve shown is another's; else empty."""
    given = study.cage.material if study.cage else None
    if given is None or cage_candidate(study) is not None:
        return ""
    name = "[cage] material" if given.name == NAMELESS else f"[cage] material {given.name}"
    shown_for = question.candidates[0].name
    return f"{name} is none of the candidates: the curve, and the eta beside it, are those of {shown_for}."


def environment_of(question: RankingQuestion) -> str | None:
    """Return the stated environment, else the only one; None if the study does not say."""
    alone = question.environments[0] if len(question.environments) == 1 else None
    return question.environment or alone


def required_environment(study: Study, question: RankingQuestion) -> str:
    """Return the environment of the bearing.

    Raises
    ------
    InputError
        There are several, none is stated, and none matches fluid and steel.
    """
    found = environment_of(question)
    if found is None:
        rule = (
            "is missing: no environment, or more than one, matches [operation] fluid and the bearing's steel"
        )
        names = " or ".join(f'"{name}"' for name in question.environments)
        raise InputError(f"{study.name}: [ranking] environment", rule, cure=f"Write environment = {names}.")
    return found


def known_friction(study: Study) -> Ratio | None:
    """Return f_BC of the study's own cage: the given one, or that of its material; None if not known."""
    if study.cage is not None and study.cage.ball_cage_friction is not None:
        return study.cage.ball_cage_friction
    friction = cage_friction(study)
    return None if friction is None else friction.mean


def cage_friction(study: Study) -> Friction | None:
    """Friction of the cage's candidate in the bearing's environment; None if it is not known."""
    candidate = cage_candidate(study)
    environment = environment_of(study.ranking) if study.ranking else None
    return candidate.friction.get(environment) if candidate and environment else None


def pocket_friction(study: Study) -> Ratio:
    """Return f_BC of the study's own cage.

    Raises
    ------
    InputError
        It is not known: what is missing, and what can be said instead.
    """
    friction = known_friction(study)
    if friction is not None:
        return friction
    where = f"{study.name}: [cage] ball_cage_friction"
    if study.ranking is None:
        raise InputError(where, "is missing", cure="Give it, or [ranking] with measured frictions.")
    names = ", ".join(candidate.name for candidate in study.ranking.candidates)
    cure = f"Give it, or name a candidate as [cage] material: {names}."
    candidate = cage_candidate(study)
    if candidate is None:
        name = _name(study)
        named = f"{shown(name)} is not a candidate" if name else "[cage] material does not name a candidate"
        raise InputError(where, f"is missing, and {named}", cure=cure)
    environment = required_environment(study, study.ranking)
    raise InputError(
        where, f"is missing: {candidate.name} was not measured in {environment}", cure="Give it."
    )


def reference_friction(study: Study, question: RankingQuestion) -> Ratio:
    """Return f_BC of the reference candidate's cage in a ranking; 0 where none is known."""
    known = known_friction(study)
    if known is not None:
        return known
    friction = reference_candidate(study, question).friction.get(environment_of(question) or "")
    return friction.mean if friction else 0.0


def _name(study: Study) -> str:
    """Name of the cage's material; empty without one."""
    if study.cage is None:
        return ""
    material = study.cage.material
    return study.cage.material_name or (material.name if material and material.name != NAMELESS else "")
