"""The cage's own candidate and environment: the one that [cage] names, the column that fits the bearing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from separatrix.library import Library
from separatrix.study import BallBearing, CageDesign, Operation, RankingQuestion
from separatrix.study_file import values
from separatrix.study_file.document import Document
from separatrix.study_file.records import where
from separatrix.toml_values import folded

FROM_BEARING = "that of [operation] fluid and of [bearing] ball_material or ring_material"


def name_cage(document: Document, parts: dict[str, Any]) -> None:
    """Give the cage the candidate of its name.

    Raises
    ------
    InputError
        Neither the library nor a candidate has that name.
    """
    cage: CageDesign | None = parts.get("cage")
    question: RankingQuestion | None = parts.get("ranking")
    entry = document.sections.get("cage", {}).get("material")
    if cage is None or entry is None or (question is None and "ranking" in document.sections):
        return
    name = entry.value if isinstance(entry.value, str) else cage.material.name if cage.material else ""
    known = {folded(candidate.name): candidate for candidate in question.candidates} if question else {}
    candidate = known.get(folded(name))
    if candidate is not None:
        of_candidate = candidate.material if isinstance(entry.value, str) else None
        material = of_candidate or cage.material
        parts["cage"] = replace(cage, material=material, material_name=candidate.name)
    elif cage.material is None:
        names = ", ".join(candidate.name for candidate in known.values())
        more = f" Candidates are {names}." if names else ""
        values.known_name(name, "cage material", where(document, "cage", "material"), more)


def name_environment(parts: dict[str, Any]) -> bool:
    """Give the ranking the one environment that fits the bearing; whether it was wanted and is found."""
    question, operation, bearing = (parts.get(name) for name in ("ranking", "operation", "bearing"))
    if question is None or operation is None or bearing is None or question.environment is not None:
        return False
    found = matching_environment(question, operation, bearing, values.current_library())
    parts["ranking"] = replace(question, environment=found)
    return found is not None


def matching_environment(
    question: RankingQuestion, operation: Operation, bearing: BallBearing, library: Library
) -> str | None:
    """Return the environment of the bearing's fluid and balls, else of fluid and rings; None if none is."""
    if len(question.environments) == 1 or operation.fluid is None:
        return None
    fluid = operation.fluid
    for surface in (bearing.ball_material.name, bearing.ring_material.name):
        found = [name for name in question.environments if _is(name, fluid, surface, library)]
        if len(found) == 1:
            return found[0]
    return None


def _is(environment: str, fluid: str, surface: str, library: Library) -> bool:
    """Whether an environment, "medium, counterface", is this fluid and, if it names one, this counterface."""
    medium, comma, counterface = environment.partition(",")
    alike = not comma or _alike(counterface, surface, "bearing material", library)
    return alike and _alike(medium, fluid, "fluid", library)


def _alike(one: str, other: str, kind: str, library: Library) -> bool:
    """Whether two names are of the same record, or of what no library knows."""
    first, second = (library.named(kind, name.strip()) or folded(name) for name in (one, other))
    return first == second
