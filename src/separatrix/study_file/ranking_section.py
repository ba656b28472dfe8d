"""The section [ranking]: a friction table of the library, or candidates in place."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from separatrix.cage_choice import NAMELESS
from separatrix.errors import InputError, together
from separatrix.study import Candidate, Friction, RankingQuestion
from separatrix.study_file import values
from separatrix.study_file.distributions import Uncertain, gathered
from separatrix.study_file.document import Document
from separatrix.study_file.records import Unfinished, attempt, record_of, refuse_both, where
from separatrix.study_file.tested_friction import (
    chosen_materials,
    of_conditions,
    question_of_tests,
    scatter_of,
    tests_file,
)
from separatrix.study_file.values import Reader
from separatrix.toml_values import folded
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
        question = question_of_tests(document, file, given)
    elif "friction" in written:
        question = _from_table(document, given)
    else:
        raise InputError(f"{document.label}: [ranking]", "lacks: friction (or candidates)")
    if "friction_scatter" in given:
        question["friction_scatter"] = given["friction_scatter"]
    if "environment" in given:
        known = {folded(name): name for name in question["environments"]}
        question["environment"] = known.get(folded(given["environment"]), given["environment"])
    return record_of(document, RankingQuestion, question)


def _from_table(document: Document, given: dict[str, Any]) -> dict[str, Any]:
    library = values.current_library()
    name = values.known_name(given["friction"], "friction table", where(document, "ranking", "friction"))
    table = library.friction_table(name)
    chosen = chosen_materials(document, given, tuple(table.friction), name)
    temperature = values.current_temperature()
    candidates = tuple(
        of_conditions(library.candidate(table, material, temperature), table, scatter_of(given))
        for material in chosen
    )
    return {"environments": table.environments, "candidates": candidates}


def _in_place(document: Document, items: Any) -> dict[str, Any]:
    place = where(document, "ranking", "candidates")
    if not isinstance(items, list) or not 0 < len(items) <= MOST_CANDIDATES:
        rule = f"must be 1 to {MOST_CANDIDATES} tables, each under [[ranking.candidates]]"
        raise InputError(place, rule, shown(items))
    before = len(document.problems)
    found = [attempt(document, _candidate, document, item, i) for i, item in enumerate(items)]
    candidates = [item for item in found if item is not None]
    if len(document.problems) > before:
        raise Unfinished
    environments = tuple(dict.fromkeys(env for item in candidates for env in item.friction))
    complete = (_with_gaps(candidate, environments) for candidate in candidates)
    return {"environments": environments, "candidates": tuple(complete)}


def _candidate(document: Document, item: Any, number: int) -> Candidate:
    place = document.sections["ranking"]["candidates"].item_places[number]
    at = f"{place}: [ranking] candidates[{number + 1}]"
    given, found = gathered(values.table(item, at, _CANDIDATE, ("name", "friction")))
    for key, one in found.items():
        named = f"ranking.{given['name']}.{key.removeprefix('friction.')}"
        document.distributions[named] = one
    candidate = values.build(Candidate, given, at)
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
            environment = values.text(name, f"{at}, name of an environment,")
            frictions[environment] = values.friction(item, f'{at}."{environment[:60]}"')
        except InputError as error:
            problems.append(error)
    if problems:
        raise together(problems)
    return Uncertain(*gathered(frictions))


_CANDIDATE: dict[str, Reader] = {
    "name": values.text,
    "friction": _frictions,
    "material": values.material("cage material"),
}
