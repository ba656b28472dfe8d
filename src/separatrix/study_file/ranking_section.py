"""The section [ranking], and which of its candidates and environments are those of the study's own cage."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from separatrix.cage_choice import NAMELESS
from separatrix.distribution import Normal
from separatrix.errors import InputError, together
from separatrix.library import Library
from separatrix.measured_friction import refuse_scatter_about_zero
from separatrix.study import BallBearing, CageDesign, Candidate, Friction, Operation, RankingQuestion
from separatrix.study_file import values
from separatrix.study_file.document import Document
from separatrix.study_file.sections import Unfinished, attempt, record_of, refuse_both
from separatrix.study_file.tested_friction import (
    chosen_materials,
    of_conditions,
    question_of_tests,
    scatter_of,
    tests_file,
)
from separatrix.study_file.values import Uncertain, friction_deviation, gathered, number, unwrapped
from separatrix.toml_values import Reader, build, folded, ratio, table, text, whole
from separatrix.units import shown

MOST_CANDIDATES = 1000


def ranking(document: Document, given: dict[str, Any]) -> RankingQuestion:
    """Build the question of a ranking from the converted keys of its section."""
    for key in ("friction", "materials"):
        refuse_both(document, "ranking", "candidates", key)
    written = document.sections["ranking"]
    if any(key not in given for key in written):
        raise Unfinished
    if "candidates" in written:
        question = _in_place(document, given["candidates"])
    elif "friction" in written and (file := tests_file(document, given["friction"])) is not None:
        question = question_of_tests(file, given)
    elif "friction" in written:
        question = _from_table(given)
    else:
        raise InputError("[ranking]", "lacks: friction (or candidates)")
    if "friction_scatter" in given:
        question["friction_scatter"] = given["friction_scatter"]
    if "environment" in given:
        known = {folded(name): name for name in question["environments"]}
        question["environment"] = known.get(folded(given["environment"]), given["environment"])
    return record_of(document, RankingQuestion, question)


def _from_table(given: dict[str, Any]) -> dict[str, Any]:
    library = values.current_library()
    name = values.known_name(given["friction"], "friction table", "[ranking] friction")
    table = library.friction_table(name)
    chosen = chosen_materials(given, tuple(table.friction), name)
    temperature = values.current_temperature()
    candidates = tuple(
        of_conditions(library.candidate(table, material, temperature), table, scatter_of(given))
        for material in chosen
    )
    return {"environments": table.environments, "candidates": candidates}


def _in_place(document: Document, items: Any) -> dict[str, Any]:
    if not isinstance(items, list) or not 0 < len(items) <= MOST_CANDIDATES:
        rule = f"must be 1 to {MOST_CANDIDATES} tables, each under [[ranking.candidates]]"
        raise InputError("[ranking] candidates", rule, shown(items))
    before = len(document.problems)
    found = [attempt(document, _candidate, document, item, i) for i, item in enumerate(items)]
    candidates = [item for item in found if item is not None]
    if len(document.problems) > before:
        raise Unfinished
    environments = tuple(dict.fromkeys(env for item in candidates for env in item.friction))
    complete = (_with_gaps(candidate, environments) for candidate in candidates)
    return {"environments": environments, "candidates": tuple(complete)}


def _candidate(document: Document, item: Any, number: int) -> Candidate:
    at = f"[ranking] candidates[{number + 1}]"
    given, found = gathered(table(item, at, _CANDIDATE, ("name", "friction")))
    for key, one in found.items():
        named = f"ranking.{given['name']}.{key.removeprefix('friction.')}"
        document.distributions[named] = one
    candidate = build(Candidate, given, at)
    if candidate.material is None or candidate.material.name != NAMELESS:
        return candidate
    return replace(candidate, material=replace(candidate.material, name=candidate.name))


def _with_gaps(candidate: Candidate, environments: tuple[str, ...]) -> Candidate:
    """The candidate with None where others were measured and it was not."""
    friction = {env: candidate.friction.get(env) for env in environments}
    return Candidate(name=candidate.name, friction=friction, material=candidate.material)


def _frictions(value: Any, at: str) -> Uncertain:
    if not isinstance(value, dict) or not 0 < len(value) <= MOST_CANDIDATES:
        cure = 'Write it like { "liquid nitrogen, 440C" = 0.11 }.'
        got = f"{len(value)} of them" if isinstance(value, dict) else shown(value)
        rule = f"must be a table from environment to friction, with 1 to {MOST_CANDIDATES} entries"
        raise InputError(at, rule, got, cure)
    frictions: dict[str, Friction | Uncertain] = {}
    problems = []
    for name, item in value.items():
        try:
            environment = text(name, f"{at}, name of an environment,")
            frictions[environment] = _friction(item, f'{at}."{environment[:60]}"')
        except InputError as error:
            problems.append(error)
    if problems:
        raise together(problems)
    return Uncertain(*gathered(frictions))


def _friction(value: Any, where: str) -> Friction | Uncertain:
    """Read a friction: a number, a table with mean, standard_deviation and count, or a distribution."""
    if isinstance(value, dict) and not {"between", "samples"} & set(value):
        readers: dict[str, Reader] = {
            "mean": ratio,
            "standard_deviation": ratio,
            "count": whole,
            "source": text,
        }
        given = {**value, "standard_deviation": friction_deviation(value, where)}
        kept = {key: item for key, item in given.items() if key in value}
        stated = build(Friction, table(kept, where, readers, ("mean",)), where)
        return refuse_scatter_about_zero(stated, where)
    mean, found = unwrapped(number(ratio, "-")(value, where))
    if not found:
        return build(Friction, {"mean": mean}, where)
    deviation = found[""].standard_deviation
    known = build(Friction, {"mean": mean, "standard_deviation": deviation}, where)
    if isinstance(found[""], Normal):
        refuse_scatter_about_zero(known, where)
    return Uncertain(known, found)


_CANDIDATE: dict[str, Reader] = {
    "name": text,
    "friction": _frictions,
    "material": values.material("cage material"),
}


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
        values.known_name(name, "cage material", "[cage] material", more)


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
    """Whether two names are of the same record, or of what is in no library."""
    first, second = (library.named(kind, name.strip()) or folded(name) for name in (one, other))
    return first == second
